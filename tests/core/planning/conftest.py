# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's parts as analytic meridians, sliced, and the paper's cell (Chalvin 2020, eqs. 20 to
22 and section 6)."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, sample_curve
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.strategies.revolution import plan as revolution

R0 = 45.0


def sphere():
    """Eq. 20."""
    return [
        sample_curve(
            lambda t: (np.c_[R0 * np.cos(t), R0 * np.sin(t)], np.c_[-np.sin(t), np.cos(t)]),
            [0, np.pi / 2],
        )
    ]


def laval_nozzle():
    """Eq. 21 with the two parabolas of ERRATA."""

    def parabola(rho, theta):
        def curve(z):
            x = np.sqrt((z - theta) * 2 * rho)
            return np.c_[x, z], np.c_[rho / x, np.ones_like(z)]

        return curve

    return [
        sample_curve(parabola(-10.0, 100.0), [0, 96.5]),
        sample_curve(parabola(3.0, 85.0), [96.5, 128.0]),
    ]


def intake_funnel():
    """Eq. 22."""

    def curve(t):
        return np.c_[2 * R0 - R0 * np.cos(t), R0 * np.sin(t)], np.c_[R0 * np.sin(t), R0 * np.cos(t)]

    return [sample_curve(curve, [0, np.pi / 2])]


PARTS = {"sphere": sphere, "laval nozzle": laval_nozzle, "intake funnel": intake_funnel}


@pytest.fixture(scope="session")
def sliced():
    """sliced(part, layer_height, **strategy) -> Toolpath."""
    toolpaths = {}

    def make(part, layer_height, frame=None, process=None, **strategy):
        key = (part, layer_height, repr(frame), process, tuple(sorted(strategy.items())))
        if key not in toolpaths:
            wall = RevolvedWall(
                Meridian.chained(PARTS[part]()), np.eye(4) if frame is None else frame
            )
            toolpaths[key] = revolution.plan(
                wall,
                RevolutionParameters(layer_height=layer_height, **strategy),
                BuildDirectionParameters(),
                process or ProcessParameters(),
                NozzleParameters(),
                113.0,
            )
        return toolpaths[key]

    return make


@pytest.fixture(scope="session")
def cell_of():
    """cell_of(toolpath, **cell parameters) -> Cell; the paper's cell and limits by default."""

    def make(toolpath, **parameters):
        return cells.resolve(CellParameters(**{"limits": "paper", **parameters}), toolpath.frame)

    return make


@pytest.fixture(scope="session")
def with_axis_6():
    """with_axis_6(cell, half) -> the cell with axis 6 limited to +-half degrees."""

    def make(cell, half):
        lower, upper = np.array(cell.limits.lower), np.array(cell.limits.upper)
        lower[5], upper[5] = -np.radians(half), np.radians(half)
        return dataclasses.replace(
            cell, limits=dataclasses.replace(cell.limits, lower=lower, upper=upper)
        )

    return make
