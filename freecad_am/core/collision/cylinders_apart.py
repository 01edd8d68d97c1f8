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
        found: Array = self.cylinders.start + self.cylinders.solid.farthest(
            direction, self.cylinders.axis
        )
        return found


def nearer(one: PlacedCylinders, other: PlacedCylinders, gap: float) -> Mask:
    """(k,) whether two cylinders are nearer to each other than `gap` mm, which is more than nothing, or meet."""
    apart = axes_apart(one, other)
    found: Mask = apart < gap  # the axes themselves are in the cylinders
    left = np.flatnonzero(~found & (apart < gap + one.radius + other.radius))
    if len(left):
        first, second = one.of(left), other.of(left)
        adjacent = _Pairs(
            PlacedCylinders(second.start - first.start, second.axis, second.length, second.radius)
        )
        middle = adjacent.cylinders.start + 0.5 * second.length * second.axis
        start = first.solid.nearest(middle, first.axis) - middle
        # where that middle is in the cylinder the way is none, and they meet
        inside = dots(start, start) <= CONVERGED**2
        found[left[inside]] = True
        rows = np.flatnonzero(~inside)
        low, _ = separation.bounds(
            first.solid, first.axis[rows], adjacent[rows], gap, gap, start[rows]
        )
        found[left[rows]] = low < gap  # what is in doubt counts
    return found


def axes_apart(one: PlacedCylinders, other: PlacedCylinders) -> Array:
    """(k,) mm between the axes of cylinders, from end to end."""
    off = one.start - other.start
    lean, first, second = dots(one.axis, other.axis), dots(one.axis, off), dots(other.axis, off)
    square = 1.0 - lean * lean
    crossing = square > PARALLEL
    along = np.where(crossing, (lean * second - first) / np.where(crossing, square, 1.0), 0.0)
    along = np.minimum(
        np.maximum(along, 0.0), one.length
    )  # np.clip takes many times that for a few
    there = np.minimum(np.maximum(lean * along + second, 0.0), other.length)
    along = np.minimum(np.maximum(lean * there - first, 0.0), one.length)
    away: Array = lengths(off + along[:, None] * one.axis - there[:, None] * other.axis)
    return away


def nearest(one: PlacedCylinders, other: PlacedCylinders) -> tuple[Array, Array]:
    """The places (k, 3) where the second cylinders are nearest to the first ones, and the ways (k, 3) from there to these;
    none where the two meet."""
    adjacent = _Pairs(
        PlacedCylinders(other.start - one.start, other.axis, other.length, other.radius)
    )
    middle = adjacent.cylinders.start + 0.5 * other.length * other.axis
    there, way = separation.ways(one.solid, one.axis, adjacent, middle)
    return one.start + there, way
