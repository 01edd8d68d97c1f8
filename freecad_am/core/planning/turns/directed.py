# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axis values of five-axis machines along a bead, and their whole turns.

Two rotary axes turn the tool axis to the torch, or one if the other is locked. The prismatic axes
follow.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np

from ...geometry.frames import TURN
from ...issues import ERROR, NOTE, InputError, Issue, Text, Word
from ...kinematics.cell import Cell
from ...kinematics.inverse.five_axis import FiveAxis
from ...kinematics.inverse.rotary_pair import Turns
from ...kinematics.limits import RESERVE
from ...parameters.joints import JointParameters
from ...toolpath import Bead, Toolpath
from ...types import Array, Mask
from ..joint_path import BeadPath

# rad; a direction this close to the pole counts as on the pole, where the axis would otherwise race
AT_POLE = math.radians(0.1)


def onto_pole(directions: Array, pole: Array, within: float = AT_POLE) -> Array:
    """Move directions close to a revolute axis onto the axis.

    Parameters
    ----------
    directions : (n, 3) array
        Unit vectors.
    pole : (3,) array
        Revolute axis, unit vector.
    within : float, optional
        Maximum angle to the axis or its opposite, rad.

    Returns
    -------
    (n, 3) array
        Directions; those within the angle equal the axis or its opposite.
    """
    near = np.linalg.norm(np.cross(directions, pole), axis=1) < math.sin(within)
    return np.where(near[:, None], np.sign(directions @ pole)[:, None] * pole, directions)


def rotary_courses(found: Turns) -> list[Array]:
    """Return two courses of the rotary axes along a bead.

    Parameters
    ----------
    found : Turns
        Solutions of both rotary axes at n points.

    Returns
    -------
    list of (n, 2) array
        Angles, rad; a free axis keeps its previous angle.
    """
    turned = np.stack([found.first_turn, found.second_turn], axis=-1)
    for axis, free in enumerate((found.first_free, found.second_free)):
        turned[:, :, axis] = hold_free_angles(turned[:, :, axis], free)
    return continuous(turned)


def led_over(course: Array, free: Mask, place: Array) -> Array:
    """Interpolate free angles linearly between their neighbours along a bead.

    The axis then uses the whole distance, instead of jumping at its end.

    Parameters
    ----------
    course : (n,) array
        Angles of one axis, rad.
    free : (n,) bool array
        Points where the angle has no effect.
    place : (n,) array
        Position along the bead, mm.

    Returns
    -------
    (n,) array
        Angles, rad; free angles before the first and after the last fixed angle stay.
    """
    known = np.flatnonzero(~free)
    if not len(known):
        return course
    # linear along the path; angles before the first and after the last known angle stay
    led = np.interp(place, place[known], course[known])
    inside = free & (np.arange(len(free)) > known[0]) & (np.arange(len(free)) < known[-1])
    return np.where(inside, led, course)


def continuous(turned: Array) -> list[Array]:
    """Return two courses through the branches that pass a pole without reversing.

    Parameters
    ----------
    turned : (2, n, 2) array
        Angles of both rotary axes in two branches, rad.

    Returns
    -------
    list of (n, 2) array
        Two unwrapped courses, one starting in each branch.
    """
    step = np.diff(turned, axis=1)
    across = turned[::-1, 1:] - turned[:, :-1]
    stay, change = (
        np.abs(np.remainder(way + np.pi, TURN) - np.pi).sum(axis=(0, 2)) for way in (step, across)
    )
    swaps = np.r_[0, np.cumsum(change < stay - 1e-6)] % 2
    rows = np.arange(turned.shape[1])
    return [np.unwrap(turned[(start + swaps) % 2, rows], axis=0) for start in range(2)]


def hold_free_angles(angles: Array, free: Mask) -> Array:
    """Set free angles to the previous fixed angle, or to the next one at the start.

    Parameters
    ----------
    angles : (2, n) array
        Angles of one axis in two branches, rad.
    free : (n,) bool array
        Points where the angle has no effect.

    Returns
    -------
    (2, n) array
        Angles; unchanged if all are free.
    """
    known = np.flatnonzero(~free)
    if not len(known):
        return angles
    source = known[np.clip(np.searchsorted(known, np.arange(len(free)), side="right") - 1, 0, None)]
    return angles[:, source]


def in_turns(course: Array, before: Array, lower: Array, upper: Array) -> Array:
    """Shift a course by whole turns to start near previous values within limits.

    Parameters
    ----------
    course : (n, a) array
        Angles, rad.
    before : (a,) array
        Previous angles, rad.
    lower, upper : (a,) array
        Limits, rad; may be infinite.

    Returns
    -------
    (n, a) array
        Shifted course; an axis that cannot fit its limits is centred between them.
    """
    low, high = course.min(axis=0), course.max(axis=0)
    fewest = np.ceil((lower - low) / TURN - 1e-12)
    greatest = np.floor((upper - high) / TURN + 1e-12)
    wanted = np.round((before - course[0]) / TURN)
    with np.errstate(invalid="ignore"):
        centred = np.round(np.nan_to_num(0.5 * (lower + upper) - 0.5 * (low + high)) / TURN)
    return np.asarray(
        course + TURN * np.where(fewest <= greatest, np.clip(wanted, fewest, greatest), centred)
    )


def chosen_course(
    ways: Sequence[Array],
    before: Array,
    lower: Array,
    upper: Array,
    speed: Array,
    turning: Mask,
    least_motion: bool = False,
) -> Array:
    """Choose the course within the limits that starts nearest to previous values.

    All whole turns of the revolute axes are candidates. The distance is the time at maximum speed.

    Parameters
    ----------
    ways : sequence of (n, a) array
        The courses, rad or mm.
    before : (a,) array
        Previous values.
    lower, upper : (a,) array
        Limits; may be infinite.
    speed : (a,) array
        Maximum speeds, rad/s or mm/s.
    turning : (a,) bool array
        Axes that may move by whole turns.
    least_motion : bool, optional
        Whether the motion ranks before the distance of the start.

    Returns
    -------
    (n, a) array
        The chosen course. If no course is within the limits, the one that exceeds them least; if
        every course has NaN values, the first.
    """
    ranked = []
    for course in ways:
        moved = course.copy()
        if np.isfinite(course).all():
            moved[:, turning] = in_turns(
                course[:, turning], before[turning], lower[turning], upper[turning]
            )
        over = float(np.maximum(lower - moved, moved - upper).max())
        motion = round(float(np.abs(np.diff(moved, axis=0)).sum()), 6) if least_motion else 0.0
        start = float((np.abs(moved[0] - before) / speed).max())
        ranked.append(
            (math.inf, math.inf, math.inf, moved)
            if math.isnan(over)
            else (max(over, 0.0), motion, start, moved)
        )
    return min(ranked, key=lambda one: one[:3])[3]


@dataclasses.dataclass(frozen=True)
class Lock:
    """A locked rotary axis: its index, 0 or 1, and its angle, rad."""

    axis: int
    angle: float


def courses(cell: Cell, lock: Lock | None, bead: Bead, pole: float = AT_POLE) -> list[Array]:
    """Return all courses of a bead on a five-axis machine, up to whole turns.

    Directions close to the pole count as on the pole. If `pole` exceeds its default, the axis
    rotates evenly there.

    Parameters
    ----------
    cell : Cell
        The cell with a five-axis machine.
    lock : Lock or None
        The locked rotary axis; None without a lock.
    bead : Bead
        The bead of n points.
    pole : float, optional
        Angle to the revolute axis within which a direction counts as on the pole, rad.

    Returns
    -------
    list of (n, 5) array
        Axis values, rad or mm.
    """
    arm, torch = FiveAxis(cell.machine.chain), cell.poses.station[:3, 2]
    points, tools = cell.poses.to_flange(bead.points, bead.tool)
    if lock is not None:
        turned = _locked(arm, lock, tools, torch)
        turned[:, 1 - lock.axis] = np.unwrap(turned[:, 1 - lock.axis])
        return [arm.place_points(turned, points, cell.poses.station)]
    found = arm.turns(onto_pole(tools, arm.pole, pole), torch)
    ways = rotary_courses(found)
    if pole > AT_POLE:
        place = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(bead.points, axis=0), axis=1))]
        for axis, free in enumerate((found.first_free, found.second_free)):
            for course in ways:
                course[:, axis] = led_over(course[:, axis], free, place)
    return [arm.place_points(course, points, cell.poses.station) for course in ways]


def chosen(cell: Cell, ways: Sequence[Array], before: Array) -> Array:
    """Choose the course within the limits that starts nearest to the current axis values.

    All courses and whole turns are candidates.

    Parameters
    ----------
    cell : Cell
        The cell with a five-axis machine.
    ways : sequence of (n, 5) array
        The courses, rad or mm.
    before : (5,) array
        Current axis values.

    Returns
    -------
    (n, 5) array
        The chosen course.
    """
    lower, upper = cell.limits.lower + RESERVE, cell.limits.upper - RESERVE
    return chosen_course(
        ways, before, lower, upper, cell.machine.max_speed, ~cell.machine.chain.sliding
    )


def _locked(arm: FiveAxis, lock: Lock, tools: Array, torch: Array) -> Array:
    """Return the rotary axis values (n, 2) with one axis locked."""
    turned = np.full((len(tools), 2), lock.angle)
    turned[:, 1 - lock.axis] = arm.locked(lock.axis, lock.angle, tools, torch).angle
    return turned


# ---- Four-axis motion (Dai 2020, section 5): the locked rotary axis and the resulting tool axes


def lock_of(cell: Cell, parameters: JointParameters, toolpath: Toolpath) -> Lock | None:
    """Return the locked axis and its angle.

    Parameters
    ----------
    cell : Cell
        The cell.
    parameters : JointParameters
        Joint parameters, including `lock` and `lock_at`.
    toolpath : Toolpath
        The toolpath, for the angle with the smallest maximum residual.

    Returns
    -------
    Lock or None
        The lock; None without one.

    Raises
    ------
    InputError
        NOT_FOR_SETUP for robots.
    """
    if parameters.lock == "none":
        return None
    if cell.machine.free:
        raise InputError(
            "NOT_FOR_SETUP",
            "joints.lock",
            "robots need all their axes, and only five-axis machines can work with four; use none",
        )
    axis = 0 if parameters.lock == "first" else 1
    if not isinstance(parameters.lock_at, str):
        return Lock(axis, parameters.lock_at)
    arm = FiveAxis(cell.machine.chain)
    tools = [cell.poses.to_flange(bead.points, bead.tool)[1] for _, _, bead in toolpath]
    directions: Array = np.unique(np.round(np.concatenate(tools), 5), axis=0)
    turning = arm.turning[axis]
    low = max(float(cell.limits.lower[turning]) + RESERVE, -math.pi)
    high = min(float(cell.limits.upper[turning]) - RESERVE, math.pi)
    return Lock(axis, arm.best_lock(axis, directions, cell.poses.station[:3, 2], low, high))


def as_held(
    cell: Cell, paths: Sequence[BeadPath], lock: Lock | None, allowed: float
) -> tuple[list[BeadPath], list[Issue]]:
    """Replace the requested tool axes of beads by the actual ones.

    They differ at poles and with a locked axis. Robots keep the requested tool axes.

    Parameters
    ----------
    cell : Cell
        The cell.
    paths : sequence of BeadPath
        The paths.
    lock : Lock or None
        The locked axis; None without a lock.
    allowed : float
        Residual beyond which the issue is an error, rad.

    Returns
    -------
    paths : list of BeadPath
        The paths.
    issues : list of Issue
        The worst residual, if an axis is locked.
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
        "axis {} is locked at {:.4g} deg, and the tool is up to {:.3g} deg off the requested "
        "direction",
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
