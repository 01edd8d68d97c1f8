# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles of a mesh that pass through one another (Moller 1997), as where a solid cuts itself."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...types import Array, Index, Mask
from ..walls.surface import dot
from .facets import doubled_areas
from .near_triangles import near_pairs


class Crossings(NamedTuple):
    """Pairs (k, 2) of triangles that cross, the lengths (k,) mm of the crossings and their
    approximate positions (k, 3) mm.
    """

    pairs: Index
    length: Array
    positions: Array


def find_crossings(vertices: Array, triangles: Index, min_length: float) -> Crossings:
    """Find where triangles (m, 3) of vertices (n, 3) cross by more than `min_length` mm.

    Each triangle of a pair must reach both sides of the other, and overlap it along their
    line of intersection, by more than that. Triangles that only touch, such as neighbours
    along an edge, and coplanar faces do not cross. A shared vertex is in both triangles,
    whatever rounding says.
    """
    corners = vertices[triangles]
    planes = _planes(corners)
    blocks = [
        _cross_pairs(corners, triangles, planes, pairs, min_length)
        for pairs in near_pairs(corners, planes[:, :3], min_length)
    ]
    if not blocks:
        return Crossings(np.zeros((0, 2), dtype=np.intp), np.zeros(0), np.zeros((0, 3)))
    return Crossings(*(np.concatenate(column) for column in zip(*blocks)))


def _planes(corners: Array) -> Array:
    """Unit normals and distances from the origin (m, 4) of the planes of triangles (m, 3, 3), nothing for those without an
    area."""
    normals = doubled_areas(corners)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    units = np.where(length > 1e-12, normals / np.maximum(length, 1e-300), 0.0)
    planes: Array = np.c_[units, dot(units, corners[:, 0])]
    return planes


def _cross_pairs(
    corners: Array, triangles: Index, planes: Array, pairs: Index, min_length: float
) -> Crossings:
    """Return which of the pairs (k, 2) cross."""
    pairs = pairs[_both_sides(_plane_distances(corners, planes, *pairs.T), min_length)]
    pairs = pairs[_both_sides(_plane_distances(corners, planes, *pairs.T[::-1]), min_length)]
    a, b = pairs.T
    same = triangles[a][:, :, None] == triangles[b][:, None, :]
    along = np.cross(planes[a, :3], planes[b, :3])
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-300)
    start, end = _triangle_span(
        corners[a],
        np.where(same.any(axis=2), 0.0, _plane_distances(corners, planes, b, a)),
        along,
    )
    distance = np.where(same.any(axis=1), 0.0, _plane_distances(corners, planes, a, b))
    low, high = _triangle_span(corners[b], distance, along)
    overlap_start = np.maximum(dot(start, along), dot(low, along))
    overlap_end = np.minimum(dot(end, along), dot(high, along))
    keep = overlap_end - overlap_start > min_length
    middle = start + (0.5 * (overlap_start + overlap_end) - dot(start, along))[:, None] * along
    return Crossings(pairs[keep], (overlap_end - overlap_start)[keep], middle[keep])


def _plane_distances(corners: Array, planes: Array, a: Index, b: Index) -> Array:
    """Return the heights (k, 3) mm of the corners of triangles `b` above the planes of triangles
    `a`.
    """
    height: Array = (corners[b] * planes[a, None, :3]).sum(axis=2) - planes[a, 3, None]
    return height


def _both_sides(height: Array, min_length: float) -> Mask:
    crosses_plane: Mask = (height.max(axis=1) > min_length) & (height.min(axis=1) < -min_length)
    return crosses_plane


def _triangle_span(corners: Array, height: Array, along: Array) -> tuple[Array, Array]:
    """Return the start and end (k, 3) of triangles (k, 3, 3) in a plane that their corners are
    `height` (k, 3) above.
    """
    ahead, up = np.roll(corners, -1, axis=1), np.roll(height, -1, axis=1)
    passed = height * up < 0.0
    share = np.where(passed, height / np.where(passed, height - up, 1.0), 0.0)
    candidates = np.concatenate([corners + share[:, :, None] * (ahead - corners), corners], axis=1)
    position = np.einsum("kcx,kx->kc", candidates, along)
    in_plane = np.concatenate([passed, height == 0.0], axis=1)
    row = np.arange(len(candidates))
    return (
        candidates[row, np.argmin(np.where(in_plane, position, np.inf), axis=1)],
        candidates[row, np.argmax(np.where(in_plane, position, -np.inf), axis=1)],
    )
