# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads along the middle of gaps between fronts."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.mesh.triangle_mesh import Mesh
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from ...types import Array, Index
from .even_line import even, rounded
from .on_wall import on_wall

STRAIGHT = 1.2  # of the height; shorter beads are
ROUND = 0.8  # of the height; standard deviation of the mean that rounds a bead
DECIMALS = 6  # decimals of mm to which vertices of the fine mesh are told apart


def middle(wall: PatchWall, borders: list[Array], height: float) -> SpaceCurve | None:
    """The line halfway between the sides of a gap with the borders (k, 3): open along one that has a single border, closed
    within a ring."""
    longest = max(borders, key=len)
    if len(borders) == 2:
        other = next(border for border in borders if border is not longest)
        return _through(wall, 0.5 * (longest + _opposite(longest, other)), height, True)
    ahead = longest - longest.mean(axis=0)
    one = int(np.argmax(np.linalg.norm(ahead, axis=1)))
    line = np.roll(longest, -one, axis=0)
    other_end = int(np.argmax(np.linalg.norm(line - line[0], axis=1)))
    if other_end < 1 or other_end > len(line) - 1:
        return None
    side, back = line[: other_end + 1], np.vstack([line[other_end:], line[:1]])
    middle = 0.5 * (side + _opposite(side, back))
    return _through(wall, np.vstack([line[:1], middle[1:-1], line[other_end : other_end + 1]]), height, False)


def _opposite(points: Array, line: Array) -> Array:
    """The nearest places (n, 3) of a polyline, sampled."""
    share = np.linspace(0.0, 1.0, 8, endpoint=False)[None, :, None]
    dense = np.vstack([((1.0 - share) * line[:-1, None] + share * line[1:, None]).reshape(-1, 3), line[-1:]])
    nearest: Array = dense[cKDTree(dense).query(points)[1]]
    return nearest


def _through(wall: PatchWall, points: Array, height: float, closed: bool) -> SpaceCurve | None:
    """A smooth curve on the wall near a chain of points."""
    if closed:
        points = np.vstack([points, points[:1]])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    points = points[np.r_[True, steps > 1e-9]]
    length = float(steps.sum())
    count = max(2 if not closed else 6, int(np.ceil(length / (0.5 * height))))
    if len(points) < 2:
        return None
    # the sides of a gap are known to the fine mesh alone, and its middle has hooks at the ends
    line = even(points, closed, 16 * count)
    wide = min(ROUND * height / (length / (16 * count)), 4.0 * count)
    means = rounded(line, closed, wide)[::16]
    if closed:
        means = np.vstack([means, means[:1]])
    elif length < STRAIGHT * height:
        means = line[0] + np.linspace(0.0, 1.0, count + 1)[:, None] * (line[-1] - line[0])
    at = np.linspace(0.0, length, count + 1)
    nodes, normal = wall.project(means)
    if closed:
        nodes[-1], normal[-1] = nodes[0], normal[0]
    slope = CubicSpline(at, nodes, bc_type="periodic" if closed else "natural")(at, 1)
    slope -= dot(slope, normal)[:, None] * normal
    return on_wall(wall, SpaceCurve(at, nodes, slope, slope, closed))


def samples(curves: list[SpaceCurve], step: float) -> Array:
    """Points all along the curves, no farther apart than about `step` mm."""
    parts = []
    for curve in curves:
        count = max(2, int(np.ceil(curve.length / step)))
        w = np.union1d(np.linspace(curve.w[0], curve.w[-1], count + 1), curve.w)
        parts.append(curve.at(w)[0])
    return np.vstack(parts)


def shares(corners: Array, longest: float) -> tuple[Array, Index]:
    """Triangles (m, 3, 3) cut evenly so that no edge is longer than `longest` mm: the corners' shares (k, 3) in the parts'
    vertices, and the vertices (l, 3) of each part."""
    edge = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max()
    n = max(1, int(np.ceil(edge / longest)))
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
    i, j = i[i + j <= n], j[i + j <= n]
    number = np.full((n + 2, n + 2), -1)
    number[i, j] = np.arange(len(i))
    up, down = i + j < n, i + j < n - 1
    parts = np.vstack([
        np.stack([number[i[up], j[up]], number[i[up] + 1, j[up]], number[i[up], j[up] + 1]], axis=1),
        np.stack([number[i[down] + 1, j[down]], number[i[down] + 1, j[down] + 1], number[i[down], j[down] + 1]], axis=1),
    ])
    return np.stack([n - i - j, i, j], axis=1) / n, parts.astype(np.intp)


def finer(vertices: Array, faces: Index, longest: float) -> Mesh:
    """The mesh of the faces (m, 3), cut evenly so that no edge is longer than `longest` mm."""
    corners = vertices[faces]
    share, parts = shares(corners, longest)
    points = np.einsum("sk,mkc->msc", share, corners).reshape(-1, 3)
    every = (np.arange(len(faces))[:, None, None] * len(share) + parts[None]).reshape(-1, 3)
    _, first, same = np.unique(np.round(points, DECIMALS) + 0.0, axis=0, return_index=True, return_inverse=True)
    return Mesh(points[first], np.ravel(same)[every].astype(np.intp))
