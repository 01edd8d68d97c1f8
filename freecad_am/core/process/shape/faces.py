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
SPACINGS = 1.0  # of the sampling distance, between places of the same face
OUTSIDE, BOTH = "outside", "both"


@dataclass(frozen=True, eq=False)
class Faces:
    """Sampled faces of a part. points: (n, 3) mm. normals: (n, 3) outward unit vectors. areas: (n,) mm2 that each represents. open:
    (n,) faces that enclose nothing: both sides count, and the side with less.
    """

    points: Array
    normals: Array
    areas: Array
    open: Mask

    def __len__(self) -> int:
        return len(self.points)

    def rows(self, mask: Mask) -> Faces:
        """The rows of a mask."""
        return Faces(self.points[mask], self.normals[mask], self.areas[mask], self.open[mask])


def faces(vertices: Array, triangles: Index, side: str = OUTSIDE) -> Faces:
    """Places evenly spread over triangles (m, 3) of vertices (k, 3) mm, which are counter-clockwise seen from outside; with
    BOTH they enclose nothing."""
    corners = vertices[triangles]
    vectors = doubled_areas(corners)
    twice = np.linalg.norm(vectors, axis=1)
    is_proper = twice > 1e-12 * max(float(twice.max(initial=0.0)), 1e-300)
    corners, vectors, twice = corners[is_proper], vectors[is_proper], twice[is_proper]
    points, triangle = divide_triangles(
        corners, float(np.sqrt(2.0 * twice.sum() / PLACES))
    )  # halves of squares
    areas = 0.5 * twice[triangle] / np.bincount(triangle, minlength=len(corners))[triangle]
    return Faces(
        points, vectors[triangle] / twice[triangle, None], areas, np.full(len(points), side == BOTH)
    )


def thin_faces(dense: Faces) -> Faces:
    """Reduce faces with many more places than PLACES to places of about equal area. Slivers, whose normals are unreliable,
    disappear.
    """
    if len(dense) <= LEAF_SIZE:
        return dense
    ends = np.cumsum(dense.areas)
    sample = np.unique(np.searchsorted(ends, (np.arange(PLACES) + 0.5) / PLACES * ends[-1]))
    areas = np.diff(ends[sample], prepend=0.0)
    areas[-1] += ends[-1] - ends[sample[-1]]
    return Faces(dense.points[sample], dense.normals[sample], areas, dense.open[sample])


def uncovered_faces(parts: Sequence[Faces]) -> Faces:
    """Faces of several parts as one, without contact areas between parts, where nothing is machined. A place is covered if the
    nearest place of another part is in the same plane, faces the other way, and is no farther than the sampling distance.
    """
    free_faces = []
    for k, part in enumerate(parts):
        free = ~part.open
        for other_part in (*parts[:k], *parts[k + 1 :]):
            distance, nearest = cKDTree(other_part.points).query(part.points)
            out = np.abs(dots(part.points - other_part.points[nearest], part.normals))
            facing = dots(part.normals, other_part.normals[nearest]) < -FACING
            free &= ~(
                (distance < SPACINGS * np.sqrt(other_part.areas[nearest]))
                & (out < CONTACT)
                & facing
                & ~other_part.open[nearest]
            )
        free_faces.append(part.rows(free | part.open))
    return join_faces(free_faces)


def join_faces(parts: Sequence[Faces]) -> Faces:
    """Faces of several parts as one."""
    return Faces(
        *(
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("points", "normals", "areas", "open")
        )
    )
