# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axis values of machines on which point and tool axis leave no free coordinate: the courses along
a bead.

Two rotary axes turn the tool axis to the torch, or one if the other is locked; the prismatic axes
follow.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from ...kinematics.cell import Cell
from ...kinematics.inverse.five_axis import FiveAxis
from ...toolpath import Bead
from ...types import Array
from ..reserve import RESERVE
from . import rotary_courses


@dataclasses.dataclass(frozen=True)
class Lock:
    """A locked rotary axis. axis: 0 or 1, its index. angle: rad."""

    axis: int
    angle: float


def courses(
    cell: Cell, lock: Lock | None, bead: Bead, pole: float = rotary_courses.AT_POLE
) -> list[Array]:
    """All ways (n, 5) to run a bead, up to whole turns. Directions within `pole` rad of the turning axis count as along it;
    where that is more than usual, the axis turns there as it has to be afterwards."""
    arm, torch = FiveAxis(cell.machine.chain), cell.station[:3, 2]
    points, tools = cell.to_flange(bead.points, bead.tool)
    if lock is not None:
        turned = _locked(arm, lock, tools, torch)
        turned[:, 1 - lock.axis] = np.unwrap(turned[:, 1 - lock.axis])
        return [arm.place_points(turned, points, cell.station)]
    found = arm.turns(rotary_courses.onto_pole(tools, arm.pole, pole), torch)
    ways = rotary_courses.courses(found)
    if pole > rotary_courses.AT_POLE:
        place = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(bead.points, axis=0), axis=1))]
        for axis, free in enumerate((found.first_free, found.second_free)):
            for course in ways:
                course[:, axis] = rotary_courses.led_over(course[:, axis], free, place)
    return [arm.place_points(course, points, cell.station) for course in ways]


def chosen(cell: Cell, ways: Sequence[Array], before: Array) -> Array:
    """Choose the course (n, 5) within the limits that starts nearest to the current axis values.

    All courses and whole turns are candidates.
    """
    lower, upper = cell.limits.lower + RESERVE, cell.limits.upper - RESERVE
    return rotary_courses.chosen(
        ways, before, lower, upper, cell.machine.max_speed, ~cell.machine.chain.sliding
    )


def _locked(arm: FiveAxis, lock: Lock, tools: Array, torch: Array) -> Array:
    """Return the values (n, 2) of the rotary axes, with one of the axes locked."""
    turned = np.full((len(tools), 2), lock.angle)
    turned[:, 1 - lock.axis] = arm.locked(lock.axis, lock.angle, tools, torch).angle
    return turned
