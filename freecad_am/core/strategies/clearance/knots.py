# SPDX-License-Identifier: LGPL-2.1-or-later
"""Long beads are tilted clear at some of their points, the knots; between these their tilts are interpolated and checked.

Tilts build up over millimetres, points may be hundredths apart: a search at every point costs time, and the steps between its
candidates, several degrees, would turn the tool too fast from one point to the next.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from ...types import Array, Index, Mask
from .look import Space

MAX_POINTS = 2500  # points of a bead at which tilts are searched


def bead_knots(row: Index) -> Index:
    """The points of a bead, of its points `row` in order, at which tilts are searched: evenly many, both ends among them."""
    if len(row) <= MAX_POINTS:
        return row
    knots: Index = row[
        np.unique(np.round(np.linspace(0, len(row) - 1, MAX_POINTS)).astype(np.intp))
    ]
    return knots


def free_about(row: Index, knots: Index, free: Mask) -> Mask:
    """(k,) whether the points nearest to each knot are all free; free: (n,) over the points of the toolpath."""
    position = np.searchsorted(row, knots)
    middles = np.r_[0, (position[:-1] + position[1:] + 1) // 2]
    about: Mask = np.logical_and.reduceat(free[row], middles)
    return about


def spread_out(
    space: Space, row: Index, knots: Index, tool: Array, axes: Array
) -> tuple[Array, Index]:
    """Axes (m, 3) at all points of a bead, those (k, 3) at its knots and even between; and the points that touch there."""
    points = space.points[row]
    along = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    knot_lengths = along[np.searchsorted(row, knots)]
    lean = axes - tool[knots]
    tilted = tool[row] + np.stack(
        [np.interp(along, knot_lengths, column) for column in lean.T], axis=1
    )
    tilted /= np.linalg.norm(tilted, axis=1, keepdims=True)
    between = dataclasses.replace(space, nozzle=space.nozzle.halfway())
    between_rows = np.setdiff1d(row, knots, assume_unique=True)
    touching: Index = between_rows[
        ~between.clear(between_rows, tilted[np.searchsorted(row, between_rows)])
    ]
    return tilted, touching
