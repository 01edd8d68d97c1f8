# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axis values of machines on which point and tool axis leave no free coordinate: the courses along
a bead.

Two rotary axes turn the tool axis to the torch, or one if the other is locked; the prismatic axes
follow.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np

from ...issues import ERROR, NOTE, InputError, Issue, Text, Word
from ...kinematics.cell import Cell
from ...kinematics.inverse.five_axis import FiveAxis
from ...parameters.joints import JointParameters
from ...toolpath import Bead, Toolpath
from ...types import Array
from ..joint_path import BeadPath
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


# ---- Four-axis motion (Dai 2020, section 5): the locked rotary axis, its angle and the resulting
# tool axes


def lock_of(cell: Cell, parameters: JointParameters, toolpath: Toolpath) -> Lock | None:
    """Return the locked axis and its angle: the requested one, or the angle with the least maximum
    residual.

    None without a lock. Raises InputError NOT_FOR_SETUP for robots.
    """
    if parameters.lock == "none":
        return None
    if cell.machine.free:
        raise InputError(
            "NOT_FOR_SETUP",
            "joints.lock",
            "robots need all their axes; only five-axis machines can work with four; use none",
        )
    axis = 0 if parameters.lock == "first" else 1
    if not isinstance(parameters.lock_at, str):
        return Lock(axis, parameters.lock_at)
    arm, tools = (
        FiveAxis(cell.machine.chain),
        [cell.to_flange(bead.points, bead.tool)[1] for _, _, bead in toolpath],
    )
    directions: Array = np.unique(np.round(np.concatenate(tools), 5), axis=0)
    turning = arm.turning[axis]
    low = max(float(cell.limits.lower[turning]) + RESERVE, -math.pi)
    high = min(float(cell.limits.upper[turning]) - RESERVE, math.pi)
    return Lock(axis, arm.best_lock(axis, directions, cell.station[:3, 2], low, high))


def as_held(
    cell: Cell, paths: Sequence[BeadPath], lock: Lock | None, allowed: float
) -> tuple[list[BeadPath], list[Issue]]:
    """Return the paths with the actual tool axes of their beads, and an issue for the worst
    residual of a lock.

    Actual and requested axes differ at poles and with a locked axis. A residual beyond `allowed`
    rad is an error. Robots keep the requested axes.
    """
    if cell.machine.free:
        return list(paths), []
    done, strays = list(paths), list[tuple[float, int, int, int]]()
    for k, path in enumerate(paths):
        if path.reachable:
            tool = cell.tip_in_part(cell.machine.chain.forward(path.joints))[1]
            missed = np.arctan2(
                np.linalg.norm(np.cross(tool, path.bead.tool), axis=1),
                (tool * path.bead.tool).sum(axis=1),
            )
            strays.append((float(missed.max()), path.layer, path.index, int(missed.argmax())))
            held = dataclasses.replace(path.bead, tool=tool / np.linalg.norm(tool, axis=1)[:, None])
            done[k] = dataclasses.replace(path, bead=held)
    return done, [_missed(cell, lock, max(strays), allowed)] if lock is not None and strays else []


def _missed(cell: Cell, lock: Lock, worst: tuple[float, int, int, int], allowed: float) -> Issue:
    name, (missed, *place) = (
        cell.machine.axes[FiveAxis(cell.machine.chain).turning[lock.axis]],
        worst,
    )
    stands, off, most = (math.degrees(angle) for angle in (lock.angle, missed, allowed))
    text = Text(
        "axis {} is locked at {:.4g} deg; the tool is up to {:.3g} deg off the requested direction",
        name,
        stands,
        off,
    )
    if missed <= allowed:
        return Issue(NOTE, "FOUR_AXES", text, *place)
    return Issue(
        ERROR,
        "FOUR_AXES",
        Text(
            "{}, more than joints.max_residual allows ({:.3g} deg); lock the other axis, use "
            "another position or none",
            Word(text),
            most,
        ),
        *place,
    )
