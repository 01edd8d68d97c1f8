# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids and meshes as the triangles that the nozzle is kept clear of."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.geometry.surroundings import Body
from ..core.issues import InputError

DEFLECTION = 0.1  # mm, largest distance of the triangles from a curved face


def body(source: Any, name: str) -> Body:
    """The triangles of a Part.Shape with faces, or of a Mesh.Mesh, in its coordinates; InputError 'NO_FACES'."""
    points, facets = source.Topology if hasattr(source, "Topology") else source.tessellate(DEFLECTION)
    if not len(facets):
        raise InputError("NO_FACES", name, "it has no faces to keep the nozzle clear of; choose a solid or a mesh")
    vertices = np.array([tuple(point) for point in points], dtype=np.float64)
    return Body(name, vertices, np.array(facets, dtype=np.int64))
