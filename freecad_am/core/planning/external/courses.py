# SPDX-License-Identifier: LGPL-2.1-or-later
"""The ways a positioner has to turn the directions along a bead upright, and which of them is taken."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...kinematics.cell import Cell
from ...kinematics.external import ExternalAxes
from ...kinematics.inverse import rotary_pair
from ...types import Array, Index
from ..reserve import RESERVE
from ..turns import rotary_courses

STEPS = 200  # of the search for the middle of directions


def directions_on_face(cell: Cell, tool: Array) -> Array:
    """Tool axes (n, 3) of the part as seen from the face that carries it."""
    turned = cell.station[:3, :3] @ cell.mount[:3, :3].T
    return np.asarray(tool @ turned.T)


def middle(directions: Array) -> Array | None:
    """The direction (3,) whose largest angle to the directions (n, 3) is least, None where they point all ways."""
    mean = directions.mean(axis=0)
    if np.linalg.norm(mean) < 1e-6:
        return None
    mean = mean / np.linalg.norm(mean)
    middle = mean
    for step in range(1, STEPS):  # Badoiu and Clarkson 2003: towards what is farthest, ever less
        farthest = directions[int((directions @ middle).argmin())]
        middle = middle + (farthest - middle) / (step + 1)
        middle /= np.linalg.norm(middle)
    nearer = float((directions @ middle).min()) > float((directions @ mean).min())
    return np.asarray(middle if nearer else mean)


def upright(external: ExternalAxes, directions: Array) -> list[Array]:
    """All ways (n, k) to turn the directions (n, 3) of the face upright, up to whole turns."""
    source = directions @ external.at_zero.T
    if len(external.turning) == 1:
        return [
            np.unwrap(rotary_pair.nearest(external.turning[0], source, external.up).angle)[:, None]
        ]
    first_axis, second_axis = external.turning
    solutions = rotary_pair.solve_turns(
        first_axis, second_axis, rotary_courses.onto_pole(source, second_axis), external.up
    )
    if not np.isfinite(
        solutions.first_turn + solutions.second_turn
    ).all():  # axes that are not at right angles reach no farther
        angle = rotary_pair.nearest(second_axis, source, external.up).angle
        return [np.unwrap(np.stack([np.zeros(len(angle)), angle], axis=-1), axis=0)]
    return rotary_courses.courses(solutions)


def chosen(cell: Cell, courses: Sequence[Array], previous: Array) -> Array:
    """Of all courses and whole turns the one within the limits that moves least, then the one that starts nearest to the
    values before (k,)."""
    rows, lower, upper = limits_of(cell)
    speed, all_axes = (
        cell.machine.max_speed[cell.robot.chain.axes + rows],
        np.ones(len(rows), dtype=bool),
    )
    best = rotary_courses.chosen(
        courses, previous[rows], lower, upper, speed, all_axes, least_motion=True
    )
    values = np.tile(previous, (len(best), 1))
    values[:, rows] = best
    return values


def limits_of(cell: Cell) -> tuple[Index, Array, Array]:
    """Which of the external values turn the part, and their limits (k,), the reserve taken off."""
    assert cell.external is not None
    rows = cell.external.turned
    axes = cell.robot.chain.axes + rows
    return rows, cell.limits.lower[axes] + RESERVE, cell.limits.upper[axes] - RESERVE
