# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles of shapes with large round faces in a time that grows with their number.

The kernel's time grows with the square of the triangles of a face: 5 s for 120,000 on a torus, six
minutes for a million. So the kernel makes few triangles, and each is then quartered on the exact
surface, which quarters its deviation each time.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...core.geometry.mesh.refined import Edges, quarter_triangles
from ...core.issues import InputError
from ..walls.sheet_places import Places
from ..walls.surface_patch import patch_of
from .tessellate import Tessellation, tessellated

SLOW_TRIANGLES, QUICK_TRIANGLES = (
    150_000,
    40_000,
)  # triangles of a face that take the kernel eight seconds, and half a second
PLACES = 7  # samples along u and along v on a face
SHARE = 0.75  # triangles of the kernel, of the area over the distance and the mean radius
NEARER = 0.7  # share of the requested chord error, as some of the few triangles are a quarter farther off


def fine(shape: Any, chord: float) -> Tessellation:
    """Triangles within `chord` mm of the shape, as `tessellated` has them; without nodes after
    quartering, or if splines replace faces on which the kernel fails, such as some countersinks.
    """
    tessellation = _fine(shape, chord)
    if len(np.unique(tessellation.owner)) == len(shape.Faces):
        return tessellation
    splines = shape.toNurbs()
    if len(splines.Faces) != len(shape.Faces):
        return tessellation
    return tessellated(splines, chord)._replace(nodes=[])


def _fine(shape: Any, chord: float) -> Tessellation:
    about = max((_about(face, chord) for face in shape.Faces), default=0.0)
    if about < SLOW_TRIANGLES:
        return tessellated(shape, chord)
    try:
        patches = [patch_of(face, "") for face in shape.Faces]
    except InputError:  # only the kernel knows this kind of face
        return tessellated(shape, chord)
    times = math.ceil(math.log(about / QUICK_TRIANGLES, 4.0))
    vertices, triangles, owner, nodes = tessellated(shape, NEARER * chord * 4.0**times)
    ends = Edges(triangles).ends
    edge = (
        float(np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1).mean())
        * 0.5**times
    )
    sheet_places = Places(shape, patches, nodes, vertices, edge)
    for _ in range(times):
        vertices, triangles, owner = quarter_triangles(
            vertices, triangles, owner, sheet_places.middles
        )
    return Tessellation(vertices, triangles, owner, [])


def _about(face: Any, chord: float) -> float:
    """Estimated number of triangles that the kernel makes of a face; 0 for one that is curved in
    one direction only.
    """
    low_u, high_u, low_v, high_v = face.ParameterRange
    if not all(map(math.isfinite, (low_u, high_u, low_v, high_v))):
        return 0.0
    share = (np.arange(PLACES) + 0.5) / PLACES
    bends = []
    for u in low_u + share * (high_u - low_u):
        for v in low_v + share * (high_v - low_v):
            try:
                bends.append(math.sqrt(abs(math.prod(face.curvatureAt(float(u), float(v))))))
            except Exception:  # a place at which the surface has no curvature
                continue
    return SHARE * float(face.Area) * float(np.mean(bends or [0.0])) / chord
