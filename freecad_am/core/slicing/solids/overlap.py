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

STEP = 2.0  # mm between test points on the surface of a solid
DEEP = 5.0  # times the chord error of the meshes, that solids may reach into one another: touching ones do


def refuse_overlaps(groups: Sequence[Group], chord_error: float) -> None:
    """Raise InputError OVERLAP if solids overlap outside their base surfaces.

    chord_error: mm between the triangles and the solids. Overlaps smaller than STEP may be
    missed.
    """
    standing = [(group.base, body) for group in groups for body in group.bodies]
    boxes = [(body.vertices.min(axis=0), body.vertices.max(axis=0)) for _, body in standing]
    deep = DEEP * chord_error
    for k, (base, body) in enumerate(standing):
        for j in range(k + 1, len(standing)):
            box = np.maximum(boxes[k][0], boxes[j][0]), np.minimum(boxes[k][1], boxes[j][1])
            if (box[1] - box[0] <= deep).any():
                continue
            other_base, second_body = standing[j]
            for probed, against in ((body, second_body), (second_body, body)):
                overlap = _deepest_overlap(probed, against, box, (base, other_base), deep)
                if overlap is not None:
                    raise InputError(
                        "OVERLAP",
                        body.name,
                        "it overlaps {}, as at {}, so the overlap would be deposited twice; fuse "
                        "them into one solid, or move one",
                        second_body.name,
                        place(overlap),
                    )


def _deepest_overlap(
    probed: Body, against: Body, box: tuple[Array, Array], bases: Sequence[Base], deep: float
) -> Array | None:
    """Return the point (3,), on or slightly below the surface of `probed`, deepest in `against`;
    None if none is deeper than `deep`.
    """
    corners = probed.corners()
    # faces in a side of the box count: points below them may be inside the other solid
    corners = corners[
        ((corners.min(axis=1) <= box[1]) & (corners.max(axis=1) >= box[0])).all(axis=1)
    ]
    points, triangle = divide_triangles(corners, STEP)
    normal = doubled_areas(corners)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    # coincident surfaces are ambiguous: test points below them
    points = np.vstack([corners.reshape(-1, 3), points, points - 2.0 * deep * normal[triangle]])
    points = points[((points > box[0]) & (points < box[1])).all(axis=1)]
    for base in bases:
        points = points[base.surface.distance(base.inside(points)) > deep]
    if not len(points):
        return None
    distance = _searched(against).signed(points)[0]
    points, distance = points[distance < -deep], distance[distance < -deep]
    on_surface = (
        _searched(probed).signed(points)[0] < 0.5 * deep if len(points) else np.zeros(0, dtype=bool)
    )
    return points[on_surface][np.argmin(distance[on_surface])] if on_surface.any() else None


def _searched(body: Body) -> Search:
    return SolidMesh(body.vertices, body.triangles.astype(np.intp)).searched(STEP)
