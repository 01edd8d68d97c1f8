# SPDX-License-Identifier: LGPL-2.1-or-later
"""The body of a substrate as scanned, an obstacle for the nozzle."""

from __future__ import annotations

import numpy as np

from ..geometry.mesh.refined import refine_mesh
from ..geometry.mesh.solid import SolidMesh
from ..geometry.obstacles import Body
from ..types import Array, Mask
from .scan_heights import Scan

PARTS = 40  # along the longest side of the body, of its triangles once they are divided
MIN_EDGE_MM = 4.0  # mm
MAX_TRIANGLES = 100_000  # triangles
FACING = 0.2  # cosine; faces that lean farther away from where layers grow are not scanned along their normals


def facing(points: Array, body: Body, directions: Array) -> Mask:
    """Which of points (n, 3) are nearest to triangles of the body that face one of the directions (m, 3)."""
    solid = SolidMesh(body.vertices, body.triangles)
    extent = float(np.ptp(body.vertices, axis=0).max())
    _, _, nearest = solid.searched(extent / PARTS).signed(points)
    sample = directions[np.unique(np.linspace(0, len(directions) - 1, 50).astype(np.intp))]
    return np.asarray((solid.units @ sample.T).max(axis=1)[nearest] > FACING)


def scanned(body: Body, scan: Scan, directions: Array) -> Body:
    """The body with its vertices moved to the scan, on faces that face one of the directions (m, 3); other faces stay."""
    longest = max(float(np.ptp(body.vertices, axis=0).max()) / PARTS, MIN_EDGE_MM)
    owner = np.zeros(len(body.triangles), dtype=np.intp)
    refinement = refine_mesh(
        body.vertices, body.triangles, owner, longest, lambda middle, *_: middle, MAX_TRIANGLES
    )
    vertices, triangles = (body.vertices, body.triangles) if refinement is None else refinement[:2]
    units = SolidMesh(vertices, triangles).units
    sample = directions[np.unique(np.linspace(0, len(directions) - 1, 50).astype(np.intp))]
    level = (units @ sample.T).max(axis=1)
    order = np.argsort(level, kind="stable")  # the triangle that faces them most is written last
    normals, best = np.zeros_like(vertices), np.full(len(vertices), -1.0)
    for corner in range(3):
        corner_vertices = triangles[order, corner]
        better = level[order] >= best[corner_vertices]
        best[corner_vertices[better]], normals[corner_vertices[better]] = (
            level[order][better],
            units[order][better],
        )
    looking = np.flatnonzero(best > FACING)
    if not len(looking):
        return body
    heights = scan.heights(vertices[looking], normals[looking])
    good = heights.covered & (np.abs(np.where(heights.covered, heights.off, np.inf)) <= scan.within)
    shifted = vertices.copy()
    shifted[looking[good]] += heights.off[good, None] * normals[looking[good]]
    return Body(body.name, shifted, triangles)
