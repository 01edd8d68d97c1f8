# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fixtures: a short planned motion with its program, and random motions."""

import numpy as np
import pytest

from freecad_am.core.motion import Motion
from freecad_am.core.parameters.process import BetweenLayersParameters, ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from tests.core.planned_dome import planned_dome
from tests.programs import build


@pytest.fixture(scope="session")
def blocks_of():
    """Motion, program, process and waits of a hemisphere of few layers, with leads and waits."""
    process = ProcessParameters(
        lead_on=0.5,
        lead_off=0.25,
        travel_speed=8.0,
        between_layers=BetweenLayersParameters(lift=15.0, wait=2.0),
    )
    toolpath, cell, _, motion = planned_dome(15.0, process)
    waits = [3.0 * k for k in range(len(toolpath.layers))]
    return motion, build(motion, cell, process, ProgramParameters(), "DOME", waits), process, waits


@pytest.fixture(scope="session")
def a_motion():
    """Random beads joined by rapids as in `planning.motion`; all values differ."""

    def make(seed, layers=4, beads=2, points=7, rapids=3, axes=6):
        random = np.random.default_rng(seed)
        rows = []
        for layer in range(layers):
            for bead in range(beads):
                count = 2 if not rows else rapids
                rows += [(False, layer, bead, k) for k in range(count)] + [
                    (True, layer, bead, k) for k in range(points)
                ]
        rows.append((False, layers - 1, beads - 1, 0))
        deposit, layer, bead, point = map(np.array, zip(*rows))
        n = len(rows)
        position, joints = random.uniform(-50, 50, (n, 3)), random.uniform(-3, 3, (n, axes))
        duration = random.uniform(0.05, 2.0, n)
        starts = np.flatnonzero(deposit & (point == 0))
        for column in (position, joints):
            column[starts] = column[starts - 1]
        duration[starts] = duration[0] = 0.0
        axis = np.tile([0.0, 0.0, 1.0], (n, 1))
        length = np.linalg.norm(np.diff(position, axis=0, prepend=position[:1]), axis=1)
        speed = length / np.where(duration > 0, duration, 1.0)
        return Motion(
            deposit=deposit,
            layer=layer,
            bead=bead,
            point=point,
            position=position,
            build=axis,
            tool=axis,
            speed=speed,
            width=np.full(n, np.nan),
            joints=joints,
            duration=duration,
        )

    return make
