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
    """Pairs (k, 2) of triangles that cross, how long (k,) mm and about where (k, 3) mm."""

    pairs: Index
    length: Array
    places: Array


def crossings(vertices: Array, triangles: Index, least: float) -> Crossings:
    """Where triangles (m, 3) of vertices (n, 3) cross by more than `least` mm.

    Each has to reach to both sides of the other, and along the line in which they cross, by more than that: what only
    touches, as neighbours along an edge do, and faces that lie in one plane do not cross. A vertex that two share is in
    both, whatever rounding says.
    """
    corners = vertices[triangles]
    planes = _planes(corners)
    found = [
        _crossed(corners, triangles, planes, pairs, least)
        for pairs in near_pairs(corners, planes[:, :3], least)
    ]
    if not found:
        return Crossings(np.zeros((0, 2), dtype=np.intp), np.zeros(0), np.zeros((0, 3)))
    return Crossings(*(np.concatenate(column) for column in zip(*found)))


def _planes(corners: Array) -> Array:
    """Unit normals and distances from the origin (m, 4) of the planes of triangles (m, 3, 3), nothing for those without an
    area."""
    normals = doubled_areas(corners)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    units = np.where(length > 1e-12, normals / np.maximum(length, 1e-300), 0.0)
    planes: Array = np.c_[units, dot(units, corners[:, 0])]
    return planes


def _crossed(
    corners: Array, triangles: Index, planes: Array, pairs: Index, least: float
) -> Crossings:
    """Those of the pairs (k, 2) that cross."""
    pairs = pairs[_both_sides(_plane_distances(corners, planes, *pairs.T), least)]
    pairs = pairs[_both_sides(_plane_distances(corners, planes, *pairs.T[::-1]), least)]
    one, other = pairs.T
    same = triangles[one][:, :, None] == triangles[other][:, None, :]
    along = np.cross(planes[one, :3], planes[other, :3])
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-300)
    start, end = _within(
        corners[one],
        np.where(same.any(axis=2), 0.0, _plane_distances(corners, planes, other, one)),
        along,
    )
    far = np.where(same.any(axis=1), 0.0, _plane_distances(corners, planes, one, other))
    low, high = _within(corners[other], far, along)
    first = np.maximum(dot(start, along), dot(low, along))
    last = np.minimum(dot(end, along), dot(high, along))
    keep = last - first > least
    middle = start + (0.5 * (first + last) - dot(start, along))[:, None] * along
    return Crossings(pairs[keep], (last - first)[keep], middle[keep])


def _plane_distances(corners: Array, planes: Array, one: Index, other: Index) -> Array:
    """How far (k, 3) mm the corners of `other` are above the planes of `one`."""
    height: Array = (corners[other] * planes[one, None, :3]).sum(axis=2) - planes[one, 3, None]
    return height


def _both_sides(height: Array, least: float) -> Mask:
    both: Mask = (height.max(axis=1) > least) & (height.min(axis=1) < -least)
    return both


def _within(corners: Array, height: Array, along: Array) -> tuple[Array, Array]:
    """First and last places (k, 3) of triangles (k, 3, 3) in a plane that their corners are `height` (k, 3) above."""
    ahead, up = np.roll(corners, -1, axis=1), np.roll(height, -1, axis=1)
    passed = height * up < 0.0
    share = np.where(passed, height / np.where(passed, height - up, 1.0), 0.0)
    places = np.concatenate([corners + share[:, :, None] * (ahead - corners), corners], axis=1)
    at = np.einsum("kcx,kx->kc", places, along)
    there = np.concatenate([passed, height == 0.0], axis=1)
    row = np.arange(len(places))
    return (
        places[row, np.argmin(np.where(there, at, np.inf), axis=1)],
        places[row, np.argmax(np.where(there, at, -np.inf), axis=1)],
    )
