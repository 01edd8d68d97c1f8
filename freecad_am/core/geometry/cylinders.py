# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders that enclose shapes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..types import Array, Integers, Mask
from .columns import lengths

MAX_PIECES = 8  # maximum number of pieces of a shape
MIN_LENGTH_RATIO = 0.5  # minimum ratio of piece length to shape width
_ROUNDING = 1e-6  # mm


@dataclass(frozen=True, eq=False)
class Cylinder:
    """A cylinder with the centres `start` and `end` (3,) of its flat ends, and its `radius`; mm."""

    start: Array
    end: Array
    radius: float

    @property
    def length(self) -> float:
        """Length from end to end, mm."""
        return float(np.linalg.norm(self.end - self.start))

    def holds(self, points: Array) -> Mask:
        """Return whether points (n, 3) are inside the cylinder or on its surface, (n,)."""
        axis = (self.end - self.start) / self.length
        offset = points - self.start
        along = offset @ axis
        axis_distance = lengths(offset - along[:, None] * axis)
        is_inside: Mask = (
            (along >= -_ROUNDING)
            & (along <= self.length + _ROUNDING)
            & (axis_distance <= self.radius + _ROUNDING)
        )
        return is_inside


def enclosing_cylinder(points: Array) -> Cylinder:
    """Return the smallest of three enclosing cylinders along the principal axes of points.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.

    Returns
    -------
    Cylinder
        Cylinder in the frame of the points.
    """
    middle = points.mean(axis=0)
    offset = points - middle
    directions = np.linalg.eigh(offset.T @ offset)[1].T
    candidates: list[tuple[float, Cylinder]] = []
    for k, axis in enumerate(directions):
        along = offset @ axis
        low, high = float(along.min()) - _ROUNDING, float(along.max()) + _ROUNDING
        across = np.stack([directions[k - 1], directions[k - 2]])
        flat = offset @ across.T
        centre = 0.5 * (flat.min(axis=0) + flat.max(axis=0))
        radius = float(lengths(flat - centre).max())
        foot = middle + centre @ across
        candidates.append(
            ((high - low) * radius**2, Cylinder(foot + low * axis, foot + high * axis, radius))
        )
    return min(candidates, key=lambda candidate: candidate[0])[1]


def enclosing_row(points: Array, triangles: Integers) -> list[Cylinder]:
    """Return a row of cylinders that together enclose a triangulated shape.

    The shape is cut into pieces along its longest direction, and a cylinder encloses each piece.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.
    triangles : (m, 3) array of int
        Point indices of the corners.

    Returns
    -------
    list of Cylinder
        Cylinders in the frame of the points; a single cylinder unless a row has less volume.
    """
    used = points[np.unique(triangles)]
    whole_cylinder = enclosing_cylinder(used)
    offset = used - used.mean(axis=0)
    axis = np.linalg.eigh(offset.T @ offset)[1][:, -1]
    height = points @ axis
    low, high = float((used @ axis).min()), float((used @ axis).max())
    across = float(np.linalg.norm(offset - (offset @ axis)[:, None] * axis, axis=1).max())
    count = int(np.clip((high - low) / max(MIN_LENGTH_RATIO * across, _ROUNDING), 1, MAX_PIECES))
    cuts = np.linspace(low, high, count + 1)
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    start, end = height[edges[:, 0]], height[edges[:, 1]]
    # a piece has corners of the shape, and crossings of the edges with the cutting planes
    crossings = []
    for cut in cuts[1:-1]:
        over = (start - cut) * (end - cut) < 0.0
        share = ((cut - start[over]) / (end[over] - start[over]))[:, None]
        crossings.append(points[edges[over, 0]] * (1.0 - share) + points[edges[over, 1]] * share)
    cylinders = []
    for k in range(count):
        inside = used[(used @ axis >= cuts[k]) & (used @ axis <= cuts[k + 1])]
        borders = [crossings[j] for j in (k - 1, k) if 0 <= j < len(crossings)]
        piece_points = np.concatenate([inside, *borders])
        if len(piece_points):
            cylinders.append(enclosing_cylinder(piece_points))
    volume = sum(cylinder.length * cylinder.radius**2 for cylinder in cylinders)
    return (
        cylinders if volume < whole_cylinder.length * whole_cylinder.radius**2 else [whole_cylinder]
    )


def drop_redundant(cylinders: Sequence[Cylinder], points: Sequence[Array]) -> list[Cylinder]:
    """Drop each cylinder whose points are all inside another remaining cylinder.

    Parameters
    ----------
    cylinders : sequence of Cylinder
        The cylinders.
    points : sequence of (n, 3) array
        Points that each cylinder encloses, mm.

    Returns
    -------
    list of Cylinder
        Remaining cylinders in the given order.
    """
    order = sorted(
        range(len(cylinders)), key=lambda k: cylinders[k].length * cylinders[k].radius ** 2
    )
    remaining = set(order)
    for k in order:
        if any(cylinders[j].holds(points[k]).all() for j in remaining - {k}):
            remaining.remove(k)
    return [cylinders[k] for k in sorted(remaining)]
