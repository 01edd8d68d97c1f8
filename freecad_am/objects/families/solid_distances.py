# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances of a deposit from the solids that it fills."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...brep.shapes.off_part import off_mesh, off_solids
from ...core.types import Array
from ..shapes.bodies import Taken


def distances_from_solids(sources: Sequence[Taken], points: Array, limit: float) -> Array:
    """Return the distances (n,) mm of points (n, 3) from the nearest solid, exact up to a limit."""
    distances: Array = np.min([_distances(source, points, limit) for source in sources], axis=0)
    return distances


def _distances(source: Taken, points: Array, limit: float) -> Array:
    if source.shape is not None:
        return off_solids(source.shape, points, limit)
    body = source.body()
    return off_mesh(body.vertices, body.triangles, points)
