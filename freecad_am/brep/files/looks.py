# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shape files as triangles for display."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np

from freecad_am.core.types import Array, Integers

from ...core.geometry.located import locate
from ...core.geometry.mesh.file_unit import MESHES
from .apart import read_apart
from .read import read_mesh, read_shape

# how far triangles may be off a shape's surface, as a share of its size
FINENESS = 2e-3


def triangles(path: Path) -> tuple[Array, Integers]:
    """Points (n, 3) in the file's units and triangles (m, 3) of their indices, of a mesh or a shape; read-only.

    A file is read again only where it has changed. Raises InputError 'NO_FILE', 'EMPTY_FILE', 'UNSUPPORTED_FILE' or
    'BAD_FILE' naming the file.
    """
    path = locate(path)
    try:
        now = path.stat()
    except OSError:
        return _triangles(path)  # raises the reason
    return _known(path, now.st_mtime_ns, now.st_size)


@lru_cache(maxsize=64)
def _known(path: Path, changed: int, size: int) -> tuple[Array, Integers]:
    arrays = read_apart(_triangles, path)
    for array in arrays:
        array.flags.writeable = False
    return arrays


def _triangles(path: Path) -> tuple[Array, Integers]:
    if path.suffix.lower() in MESHES:
        points, corners = read_mesh(path).Topology
    else:
        shape = read_shape(path)
        points, corners = shape.tessellate(max(FINENESS * shape.BoundBox.DiagonalLength, 1e-3))
    return np.array([(p.x, p.y, p.z) for p in points], dtype=float), np.array(
        corners, dtype=np.int64
    ).reshape(-1, 3)
