# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids and meshes as the triangles that the nozzle is kept clear of."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.geometry.surroundings import Body
from ..core.issues import InputError
from .kernel_process import beside

Array = NDArray[np.float64]
Index = NDArray[np.int64]

DEFLECTION = 0.1  # mm, largest distance of the triangles from a curved face


def body(source: Any, name: str) -> Body:
    """The triangles of a Part.Shape with faces, or of a Mesh.Mesh, in its coordinates; InputError 'NO_FACES'."""
    mesh = hasattr(source, "Topology")
    vertices, triangles = _rows(*source.Topology) if mesh else beside(triangles_of, source, DEFLECTION)
    if not len(triangles):
        raise InputError("NO_FACES", name, "it has no faces to keep the nozzle clear of; choose a solid or a mesh")
    return Body(name, vertices, triangles)


def triangles_of(shape: Any, deflection: float) -> tuple[Array, Index]:
    """Points (n, 3) and triangles (m, 3) of a Part.Shape, within `deflection` mm."""
    return _rows(*shape.tessellate(deflection))


def _rows(points: Any, triangles: Any) -> tuple[Array, Index]:
    return np.array([tuple(point) for point in points], dtype=np.float64), np.array(triangles, dtype=np.int64)
