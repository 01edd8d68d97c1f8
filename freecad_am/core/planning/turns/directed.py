# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axis values of machines that point and tool axis leave nothing free: the ways along a bead.

Two turning axes bring the tool axis to the torch, one of them where the other stands locked; what slides follows.
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
    """axis: 0 or 1, which of the turning axes stands still. angle: rad, where."""

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
    """Of all courses (n, 5) and whole turns the one within the limits that starts nearest to where the axes are."""
    lower, upper = cell.limits.lower + RESERVE, cell.limits.upper - RESERVE
    return rotary_courses.chosen(
        ways, before, lower, upper, cell.machine.max_speed, ~cell.machine.chain.sliding
    )


def _locked(arm: FiveAxis, lock: Lock, tools: Array, torch: Array) -> Array:
    """(n, 2) the turning axes, one of which stands."""
    turned = np.full((len(tools), 2), lock.angle)
    turned[:, 1 - lock.axis] = arm.locked(lock.axis, lock.angle, tools, torch).angle
    return turned
