# SPDX-License-Identifier: LGPL-2.1-or-later
"""Courses of two turning axes along a bead, from the two ways there are to turn each of its directions."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...geometry.angles import TURN
from ...kinematics.inverse.rotary_pair import Turns
from ...types import Array, Mask

# rad; a direction this near to the pole counts as on it, or the axis would race round to meet it
AT_POLE = math.radians(0.1)


def onto_pole(directions: Array, pole: Array, within: float = AT_POLE) -> Array:
    """Directions (n, 3), those within an angle (rad) of a turning axis (3,), or of its other way, brought onto it."""
    near = np.linalg.norm(np.cross(directions, pole), axis=1) < math.sin(within)
    return np.where(near[:, None], np.sign(directions @ pole)[:, None] * pole, directions)


def courses(found: Turns) -> list[Array]:
    """Two courses (n, 2) through the turns of the directions along a bead; an axis that is free stays where it was."""
    turned = np.stack([found.first_turn, found.second_turn], axis=-1)
    for axis, free in enumerate((found.first_free, found.second_free)):
        turned[:, :, axis] = hold_free_angles(turned[:, :, axis], free)
    return continuous(turned)


def led_over(course: Array, free: Mask, place: Array) -> Array:
    """Interpolate the free angles (n,) evenly between their neighbours along a bead.

    place: (n,) mm along the bead. The axis has the whole distance to turn, instead of a jump at its
    end.
    """
    known = np.flatnonzero(~free)
    if not len(known):
        return course
    # even along the path; angles before the first and after the last known one stay
    led = np.interp(place, place[known], course[known])
    inside = free & (np.arange(len(free)) > known[0]) & (np.arange(len(free)) < known[-1])
    return np.where(inside, led, course)


def continuous(turned: Array) -> list[Array]:
    """Two courses (n, 2) through the branches (2, n, 2), one begun on each, that go straight on through a pole."""
    step = np.diff(turned, axis=1)
    across = turned[::-1, 1:] - turned[:, :-1]
    stay, change = (
        np.abs(np.remainder(way + np.pi, TURN) - np.pi).sum(axis=(0, 2)) for way in (step, across)
    )
    swaps = np.r_[0, np.cumsum(change < stay - 1e-6)] % 2
    rows = np.arange(turned.shape[1])
    return [np.unwrap(turned[(start + swaps) % 2, rows], axis=0) for start in range(2)]


def hold_free_angles(angles: Array, free: Mask) -> Array:
    """Return the angles (2, n) with free ones equal to the previous fixed one, at the beginning to
    the next one.
    """
    known = np.flatnonzero(~free)
    if not len(known):
        return angles
    source = known[np.clip(np.searchsorted(known, np.arange(len(free)), side="right") - 1, 0, None)]
    return angles[:, source]


def in_turns(course: Array, before: Array, lower: Array, upper: Array) -> Array:
    """A course (n, a) moved by the whole turns that bring its start nearest to the axes before (a,) and leave it between
    lower and upper (a,); an axis without room is brought to the middle between them."""
    low, high = course.min(axis=0), course.max(axis=0)
    fewest, greatest = (
        np.ceil((lower - low) / TURN - 1e-12),
        np.floor((upper - high) / TURN + 1e-12),
    )
    wanted = np.round((before - course[0]) / TURN)
    with np.errstate(invalid="ignore"):
        centred = np.round(np.nan_to_num(0.5 * (lower + upper) - 0.5 * (low + high)) / TURN)
    return np.asarray(
        course + TURN * np.where(fewest <= greatest, np.clip(wanted, fewest, greatest), centred)
    )


def chosen(
    ways: Sequence[Array],
    before: Array,
    lower: Array,
    upper: Array,
    speed: Array,
    turning: Mask,
    least_motion: bool = False,
) -> Array:
    """Choose the course (n, a) within the limits (a,) that starts nearest to the values before
    (a,).

    All whole turns of the `turning` axes (a,) are candidates; the distance is measured as time at
    maximum speed. `least_motion` puts the least motion first. If no course is within the limits,
    the one that exceeds them least is taken; if every course has NaN values, the first.
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
