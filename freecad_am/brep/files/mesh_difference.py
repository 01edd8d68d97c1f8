# SPDX-License-Identifier: LGPL-2.1-or-later
"""One small mesh less another, cut by the geometry kernel as solids with flat faces.

FreeCAD's own difference of meshes is unusable here: for a box less a cylinder it returns wrong
volumes without a message.
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
    """Points (n, 3) and corners (m, 3) of a closed mesh less a closed tool; no triangles where the
    tool removes the whole mesh.

    None if the kernel finds a solid unsound (it may then return too small a common part and a
    matching difference), if its result is not closed, or if the volumes of difference and common
    part do not add up to the volume of the mesh.
    """
    try:
        solid, tool = _solid(points, corners), _solid(tool_points, tool_corners)
        if solid.Volume <= 0.0 or tool.Volume <= 0.0 or not (solid.isValid() and tool.isValid()):
            return None
        remainder, common = solid.cut(tool), solid.common(tool)
        volume = SolidMesh(points, corners).volume
        if abs(remainder.Volume + common.Volume - volume) > EXACT * volume:
            return None
        if remainder.Volume <= EXACT * volume:
            return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.intp)
        if not remainder.isValid():
            return None
        return _triangles(remainder, volume)
    except (RuntimeError, ValueError, Part.OCCError):
        return None


def _solid(points: Array, corners: Index) -> Any:
    shape = Part.Shape()
    facets = [tuple(row) for row in corners.tolist()]
    shape.makeShapeFromMesh(([FreeCAD.Vector(*point) for point in points.tolist()], facets), SEWN)
    return Part.makeSolid(shape)


def _triangles(shape: Any, full_volume: float) -> tuple[Array, Index] | None:
    """Triangles of the solids of a shape with flat faces; or None if they do not close or enclose
    another volume.
    """
    points: list[Array] = []
    corners: list[Index] = []
    count = 0
    for solid in shape.Solids:
        vertices, faces = solid.tessellate(1.0)
        vertex_array, face_array = (
            np.array([tuple(v) for v in vertices]),
            np.array(faces, dtype=np.intp),
        )
        if (Edges(face_array).count != 2).any():
            return None
        if abs(SolidMesh(vertex_array, face_array).volume - solid.Volume) > EXACT * full_volume:
            return None
        points.append(vertex_array)
        corners.append(face_array + count)
        count += len(vertex_array)
    return np.vstack(points), np.vstack(corners)
