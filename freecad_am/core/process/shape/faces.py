# SPDX-License-Identifier: LGPL-2.1-or-later
"""Places all over the faces of a part, to look from them where a deposit ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.columns import dots
from ...geometry.mesh.facets import doubled_areas
from ...geometry.mesh.solid import divide_triangles
from ...types import Array, Index, Mask

PLACES = 20_000  # about
LEAF_SIZE = 2 * PLACES
FACING = 0.99  # cosine between faces that touch
CONTACT = 0.05  # mm that such faces are apart at most
SPACINGS = 1.0  # of places, between those that stand for the same face
OUTSIDE, BOTH = "outside", "both"


@dataclass(frozen=True, eq=False)
class Faces:
    """points: (n, 3) mm on the faces of a part. normals: (n, 3) unit vectors out of it. areas: (n,) mm2 that each stands
    for. open: (n,) of faces that enclose nothing: both sides of them count, and the side with less."""

    points: Array
    normals: Array
    areas: Array
    open: Mask

    def __len__(self) -> int:
        return len(self.points)

    def rows(self, some: Mask) -> Faces:
        """Some of them."""
        return Faces(self.points[some], self.normals[some], self.areas[some], self.open[some])


def faces(vertices: Array, triangles: Index, side: str = OUTSIDE) -> Faces:
    """Places evenly spread over triangles (m, 3) of vertices (k, 3) mm, which are counter-clockwise seen from outside; with
    BOTH they enclose nothing."""
    corners = vertices[triangles]
    vectors = doubled_areas(corners)
    twice = np.linalg.norm(vectors, axis=1)
    kept = twice > 1e-12 * max(float(twice.max(initial=0.0)), 1e-300)
    corners, vectors, twice = corners[kept], vectors[kept], twice[kept]
    points, of = divide_triangles(
        corners, float(np.sqrt(2.0 * twice.sum() / PLACES))
    )  # halves of squares
    areas = 0.5 * twice[of] / np.bincount(of, minlength=len(corners))[of]
    return Faces(points, vectors[of] / twice[of, None], areas, np.full(len(points), side == BOTH))


def thinned(some: Faces) -> Faces:
    """Of faces with many more places than PLACES as many as stand for about equal areas: slivers go with their normals, of
    which nobody can be sure."""
    if len(some) <= LEAF_SIZE:
        return some
    ends = np.cumsum(some.areas)
    chosen = np.unique(np.searchsorted(ends, (np.arange(PLACES) + 0.5) / PLACES * ends[-1]))
    areas = np.diff(ends[chosen], prepend=0.0)
    areas[-1] += ends[-1] - ends[chosen[-1]]
    return Faces(some.points[chosen], some.normals[chosen], areas, some.open[chosen])


def uncovered(some: Sequence[Faces]) -> Faces:
    """Faces of several parts as one, without the places where one part stands on another: nothing is machined there. A place
    is covered where the nearest one of another part is in the same plane, looks the other way, and is no farther than places
    lie apart."""
    kept = []
    for k, one in enumerate(some):
        free = ~one.open
        for other in (*some[:k], *some[k + 1 :]):
            away, near = cKDTree(other.points).query(one.points)
            out = np.abs(dots(one.points - other.points[near], one.normals))
            facing = dots(one.normals, other.normals[near]) < -FACING
            free &= ~(
                (away < SPACINGS * np.sqrt(other.areas[near]))
                & (out < CONTACT)
                & facing
                & ~other.open[near]
            )
        kept.append(one.rows(free | one.open))
    return together(kept)


def together(some: Sequence[Faces]) -> Faces:
    """Faces of several parts as one."""
    return Faces(
        *(
            np.concatenate([getattr(one, name) for one in some])
            for name in ("points", "normals", "areas", "open")
        )
    )
