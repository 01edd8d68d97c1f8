# SPDX-License-Identifier: LGPL-2.1-or-later
"""One small mesh less another, cut by the geometry kernel as solids with flat faces.

FreeCAD's own difference of meshes is of no use here: of a box less a cylinder it returns other volumes without a message.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import numpy as np
import Part

from freecad_am.core.types import Array, Index

from ...core.geometry.mesh.refined import Edges
from ...core.geometry.mesh.solid import SolidMesh

MAX_TRIANGLES = 2000  # of both that are cut; these take about 2 s of the processor
SEWN = 1e-4  # mm; points of a file nearer to each other than this are one
EXACT = 1e-6  # of a volume


def difference(
    points: Array, corners: Index, tool_points: Array, tool_corners: Index
) -> tuple[Array, Index] | None:
    """Points (n, 3) and corners (m, 3) of a closed mesh less a closed tool; no triangles where the tool takes all of it.

    None where the kernel finds one of them unsound (it then returns too small a common part of some, and a difference that
    agrees with that), or what it returns is not closed, or its volume and that of what is common to both are not together
    that of the mesh.
    """
    try:
        part, tool = _solid(points, corners), _solid(tool_points, tool_corners)
        if part.Volume <= 0.0 or tool.Volume <= 0.0 or not (part.isValid() and tool.isValid()):
            return None
        rest, common = part.cut(tool), part.common(tool)
        whole = SolidMesh(points, corners).volume
        if abs(rest.Volume + common.Volume - whole) > EXACT * whole:
            return None
        if rest.Volume <= EXACT * whole:
            return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.intp)
        if not rest.isValid():
            return None
        return _triangles(rest, whole)
    except (RuntimeError, ValueError, Part.OCCError):
        return None


def _solid(points: Array, corners: Index) -> Any:
    shape = Part.Shape()
    facets = [tuple(row) for row in corners.tolist()]
    shape.makeShapeFromMesh(([FreeCAD.Vector(*point) for point in points.tolist()], facets), SEWN)
    return Part.makeSolid(shape)


def _triangles(shape: Any, whole: float) -> tuple[Array, Index] | None:
    """Triangles of the solids of a shape with flat faces; None where they do not close or enclose another volume."""
    points: list[Array] = []
    corners: list[Index] = []
    count = 0
    for solid in shape.Solids:
        vertices, faces = solid.tessellate(1.0)
        own, some = np.array([tuple(v) for v in vertices]), np.array(faces, dtype=np.intp)
        if (Edges(some).count != 2).any():
            return None
        if abs(SolidMesh(own, some).volume - solid.Volume) > EXACT * whole:
            return None
        points.append(own)
        corners.append(some + count)
        count += len(own)
    return np.vstack(points), np.vstack(corners)
