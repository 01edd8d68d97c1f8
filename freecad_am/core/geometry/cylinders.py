# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders: round straight bodies with flat ends that hold everything of a shape, and perhaps a little more."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..types import Array, Integers, Mask
from .columns import lengths

PIECES = 8  # a shape is cut into at most so many
LEAST_LENGTH = 0.5  # pieces are no shorter than this share of the shape's width
_ROUNDING = 1e-6  # mm


@dataclass(frozen=True, eq=False)
class Cylinder:
    """A cylinder: the middles of its flat ends `start` and `end` (3,), its `radius`; mm."""

    start: Array
    end: Array
    radius: float

    @property
    def length(self) -> float:
        """From end to end, mm."""
        return float(np.linalg.norm(self.end - self.start))

    def holds(self, points: Array) -> Mask:
        """(n,) whether points (n, 3) are in it, or on it."""
        axis = (self.end - self.start) / self.length
        offset = points - self.start
        along = offset @ axis
        away = lengths(offset - along[:, None] * axis)
        held: Mask = (
            (along >= -_ROUNDING)
            & (along <= self.length + _ROUNDING)
            & (away <= self.radius + _ROUNDING)
        )
        return held


def about(points: Array) -> Cylinder:
    """The cylinder about points (n, 3): of those along their three main directions the one with the least volume."""
    middle = points.mean(axis=0)
    offset = points - middle
    directions = np.linalg.eigh(offset.T @ offset)[1].T
    found: list[tuple[float, Cylinder]] = []
    for k, axis in enumerate(directions):
        along = offset @ axis
        low, high = float(along.min()) - _ROUNDING, float(along.max()) + _ROUNDING
        across = np.stack([directions[k - 1], directions[k - 2]])
        flat = offset @ across.T
        centre = 0.5 * (flat.min(axis=0) + flat.max(axis=0))
        radius = float(lengths(flat - centre).max())
        foot = middle + centre @ across
        found.append(
            ((high - low) * radius**2, Cylinder(foot + low * axis, foot + high * axis, radius))
        )
    return min(found, key=lambda one: one[0])[1]


def row(points: Array, triangles: Integers) -> list[Cylinder]:
    """Cylinders in a row that together hold a shape of triangles (m, 3) of points (n, 3): its pieces along its longest
    direction, each with its cylinder."""
    used = points[np.unique(triangles)]
    whole = about(used)
    offset = used - used.mean(axis=0)
    axis = np.linalg.eigh(offset.T @ offset)[1][:, -1]
    height = points @ axis
    low, high = float((used @ axis).min()), float((used @ axis).max())
    across = float(np.linalg.norm(offset - (offset @ axis)[:, None] * axis, axis=1).max())
    count = int(np.clip((high - low) / max(LEAST_LENGTH * across, _ROUNDING), 1, PIECES))
    cuts = np.linspace(low, high, count + 1)
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    start, end = height[edges[:, 0]], height[edges[:, 1]]
    # corners of the pieces are those of the shape, and where its edges cross the planes between
    crossings = []
    for cut in cuts[1:-1]:
        over = (start - cut) * (end - cut) < 0.0
        share = ((cut - start[over]) / (end[over] - start[over]))[:, None]
        crossings.append(points[edges[over, 0]] * (1.0 - share) + points[edges[over, 1]] * share)
    found = []
    for k in range(count):
        inside = used[(used @ axis >= cuts[k]) & (used @ axis <= cuts[k + 1])]
        borders = [crossings[j] for j in (k - 1, k) if 0 <= j < len(crossings)]
        piece = np.concatenate([inside, *borders])
        if len(piece):
            found.append(about(piece))
    volume = sum(cylinder.length * cylinder.radius**2 for cylinder in found)
    return found if volume < whole.length * whole.radius**2 else [whole]


def needed(cylinders: Sequence[Cylinder], points: Sequence[Array]) -> list[Cylinder]:
    """The cylinders about points (each (n, 3)) but those whose points are all in another cylinder that stays."""
    order = sorted(
        range(len(cylinders)), key=lambda k: cylinders[k].length * cylinders[k].radius ** 2
    )
    left = set(order)
    for k in order:
        if any(cylinders[j].holds(points[k]).all() for j in left - {k}):
            left.remove(k)
    return [cylinders[k] for k in sorted(left)]
