# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids that fill the same place would be deposited there twice."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...geometry.formatting import place
from ...geometry.mesh.facets import doubled_areas
from ...geometry.mesh.solid import Search, SolidMesh, divide_triangles
from ...geometry.obstacles import Body
from ...geometry.on_hub import Base, Group
from ...issues import InputError
from ...types import Array

STEP = 2.0  # mm between the places looked at on the surface of a solid
DEEP = 5.0  # times the chord error of the meshes, that solids may reach into one another: touching ones do


def refuse_overlaps(groups: Sequence[Group], chord_error: float) -> None:
    """InputError OVERLAP where solids reach into one another outside of the surfaces they stand on.

    chord_error: mm within which the triangles stand for the solids. What overlaps on less than STEP may be missed.
    """
    standing = [(group.base, body) for group in groups for body in group.bodies]
    boxes = [(body.vertices.min(axis=0), body.vertices.max(axis=0)) for _, body in standing]
    deep = DEEP * chord_error
    for k, (base, body) in enumerate(standing):
        for j in range(k + 1, len(standing)):
            box = np.maximum(boxes[k][0], boxes[j][0]), np.minimum(boxes[k][1], boxes[j][1])
            if (box[1] - box[0] <= deep).any():
                continue
            other_base, other = standing[j]
            for one, two in ((body, other), (other, body)):
                found = _deepest(one, two, box, (base, other_base), deep)
                if found is not None:
                    raise InputError(
                        "OVERLAP",
                        body.name,
                        "it and {} fill the same place, as at {}, which would be deposited twice; "
                        "fuse them into one solid, or move one",
                        other.name,
                        place(found),
                    )


def _deepest(
    one: Body, other: Body, box: tuple[Array, Array], bases: Sequence[Base], deep: float
) -> Array | None:
    """The place (3,) deepest in another solid of the surface of one, and of what is a little below it; None where none is
    in it farther than `deep`."""
    corners = one.corners()
    # faces in a side of the box count: below them may be inside of the other
    corners = corners[
        ((corners.min(axis=1) <= box[1]) & (corners.max(axis=1) >= box[0])).all(axis=1)
    ]
    points, of = divide_triangles(corners, STEP)
    normal = doubled_areas(corners)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    # surfaces that are the same tell nothing: what lies below them does
    points = np.vstack([corners.reshape(-1, 3), points, points - 2.0 * deep * normal[of]])
    points = points[((points > box[0]) & (points < box[1])).all(axis=1)]
    for base in bases:
        points = points[base.surface.distance(base.inside(points)) > deep]
    if not len(points):
        return None
    distance = _searched(other).signed(points)[0]
    points, distance = points[distance < -deep], distance[distance < -deep]
    own = _searched(one).signed(points)[0] < 0.5 * deep if len(points) else np.zeros(0, dtype=bool)
    return points[own][np.argmin(distance[own])] if own.any() else None


def _searched(body: Body) -> Search:
    return SolidMesh(body.vertices, body.triangles.astype(np.intp)).searched(STEP)
