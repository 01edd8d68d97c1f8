# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which pairs of cylinders, round straight bodies with flat ends, are nearer to each other than they may be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.columns import dots, lengths
from ..types import Array, Index, Mask
from . import separation
from .frustum import Frustum
from .tolerances import CONVERGED

PARALLEL = 1e-9  # of the square of a sine


@dataclass(frozen=True, eq=False)
class PlacedCylinders:
    """One rod in k places: where it starts (k, 3), its unit axes (k, 3), its length and radius; mm."""

    start: Array
    axis: Array
    length: float
    radius: float

    def of(self, rows: Index) -> PlacedCylinders:
        """It in some of the places."""
        return PlacedCylinders(self.start[rows], self.axis[rows], self.length, self.radius)

    @property
    def solid(self) -> Frustum:
        """It about its axis, seen from where it starts."""
        return Frustum(self.radius, 0.0, 0.0, self.length)


@dataclass(frozen=True)
class _Pairs:
    """The second cylinders as `separation.bounds` asks for points, seen from where the first ones start."""

    cylinders: PlacedCylinders

    def __len__(self) -> int:
        return len(self.cylinders.start)

    def __getitem__(self, rows: Index) -> _Pairs:
        return _Pairs(self.cylinders.of(rows))

    def farthest(self, direction: Array) -> Array:
        """The points (k, 3) that lie farthest along directions (k, 3)."""
        points: Array = self.cylinders.start + self.cylinders.solid.farthest(
            direction, self.cylinders.axis
        )
        return points


def nearer(cylinders: PlacedCylinders, others_at: PlacedCylinders, gap: float) -> Mask:
    """(k,) whether two cylinders are nearer to each other than `gap` mm, which is more than nothing, or meet."""
    distances = axes_apart(cylinders, others_at)
    are_nearer: Mask = distances < gap  # the axes themselves are in the cylinders
    doubtful = np.flatnonzero(~are_nearer & (distances < gap + cylinders.radius + others_at.radius))
    if len(doubtful):
        first_cylinders, second_cylinders = cylinders.of(doubtful), others_at.of(doubtful)
        adjacent = _Pairs(
            PlacedCylinders(
                second_cylinders.start - first_cylinders.start,
                second_cylinders.axis,
                second_cylinders.length,
                second_cylinders.radius,
            )
        )
        middle = adjacent.cylinders.start + 0.5 * second_cylinders.length * second_cylinders.axis
        start = first_cylinders.solid.nearest(middle, first_cylinders.axis) - middle
        # where that middle is in the cylinder the way is none, and they meet
        inside = dots(start, start) <= CONVERGED**2
        are_nearer[doubtful[inside]] = True
        rows = np.flatnonzero(~inside)
        low, _ = separation.bounds(
            first_cylinders.solid, first_cylinders.axis[rows], adjacent[rows], gap, gap, start[rows]
        )
        are_nearer[doubtful[rows]] = low < gap  # what is in doubt counts
    return are_nearer


def axes_apart(cylinders: PlacedCylinders, others_at: PlacedCylinders) -> Array:
    """(k,) mm between the axes of cylinders, from end to end."""
    off = cylinders.start - others_at.start
    lean, first_offset, second_offset = (
        dots(cylinders.axis, others_at.axis),
        dots(cylinders.axis, off),
        dots(others_at.axis, off),
    )
    square = 1.0 - lean * lean
    crossing = square > PARALLEL
    along = np.where(
        crossing, (lean * second_offset - first_offset) / np.where(crossing, square, 1.0), 0.0
    )
    along = np.minimum(
        np.maximum(along, 0.0), cylinders.length
    )  # np.clip takes many times that for a few
    along_other = np.minimum(np.maximum(lean * along + second_offset, 0.0), others_at.length)
    along = np.minimum(np.maximum(lean * along_other - first_offset, 0.0), cylinders.length)
    distances: Array = lengths(
        off + along[:, None] * cylinders.axis - along_other[:, None] * others_at.axis
    )
    return distances


def nearest(cylinders: PlacedCylinders, others_at: PlacedCylinders) -> tuple[Array, Array]:
    """Return the points (k, 3) of the second cylinders nearest to the first ones, and the vectors
    (k, 3) from these points to the first cylinders; zero for pairs that meet.
    """
    adjacent = _Pairs(
        PlacedCylinders(
            others_at.start - cylinders.start, others_at.axis, others_at.length, others_at.radius
        )
    )
    middle = adjacent.cylinders.start + 0.5 * others_at.length * others_at.axis
    points, offsets = separation.shortest_vectors(cylinders.solid, cylinders.axis, adjacent, middle)
    return cylinders.start + points, offsets
