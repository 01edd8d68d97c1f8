# SPDX-License-Identifier: LGPL-2.1-or-later
"""A planned dome of few layers, and solids on a hub with a bead model, as sources of pictures."""

import numpy as np
import pytest

from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import BetweenLayersParameters, ProcessParameters
from freecad_am.core.planning import criteria
from freecad_am.core.simulation import timeline
from freecad_am.core.simulation.achievable_feed import spread_to_deposit_rows
from freecad_am.core.toolpath import Bead, Layer, Toolpath
from freecad_am.plots.source import Source
from tests.core.planned_dome import planned_dome


@pytest.fixture(scope="session")
def dome():
    """Return the source of a dome, and the joint figures of its report."""
    process = ProcessParameters(
        lead_on=0.5, travel_speed=8.0, between_layers=BetweenLayersParameters(lift=15.0, wait=2.0)
    )
    toolpath, cell, path, motion = planned_dome(9.0, process)
    condition, threshold = (
        spread_to_deposit_rows(motion.deposit, column) for column in path.conditions(motion)
    )
    source = Source(path.toolpath(toolpath), motion, process, cell, condition, threshold, 0.1)
    return source, criteria.path_figures(path, cell, JointParameters())


@pytest.fixture
def modelled():
    """Return a toolpath with speeds, widths and heights from a bead model."""
    turn = np.linspace(0.0, 2.0 * np.pi, 61)
    up = np.tile([0.0, 0.0, 1.0], (61, 1))
    layers = []
    for level in range(4):
        points = np.c_[20.0 * np.cos(turn), 20.0 * np.sin(turn), np.full(61, 2.0 * level)]
        points[-1] = points[0]
        speed, width = 8.0 + np.sin(turn) + level, 5.0 + 0.2 * np.cos(turn)
        height = 2.0 + 0.1 * level + 0.05 * np.cos(turn)
        layers.append(
            Layer(
                (Bead(points, up, up, turn, speed, True, width=width, height=height),),
                first=level == 0,
            )
        )
    toolpath = Toolpath(tuple(layers), np.eye(4), 2.0, 0.1)
    return Source(toolpath, timeline.deposit_motion(toolpath), ProcessParameters(bead_model="csw"))
