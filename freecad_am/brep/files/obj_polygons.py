# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces of an OBJ file with more than four corners, which FreeCAD leaves out without a word."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from freecad_am.core.types import Array

from ...core.geometry.mesh.polygon import triangulated

VERTEX = re.compile(rb"^[ \t]*v[ \t]+(\S+)[ \t]+(\S+)[ \t]+(\S+)", re.MULTILINE)
FACE = re.compile(rb"^[ \t]*f((?:[ \t]+-?\d\S*){3,})", re.MULTILINE)
CONTINUED = re.compile(rb"\\\r?\n")  # a line that goes on in the next one
READ = 4  # corners of the largest faces that FreeCAD reads


def left_out(file: Path, read: int) -> Array:
    """Corners (m, 3, 3), in units of the file, of the triangles that its faces with more than four corners are made of,
    where FreeCAD has `read` no more triangles than the others have. ValueError, IndexError for corners there are not."""
    text = CONTINUED.sub(b" ", file.read_bytes())
    faces = [(face.start(), face.group(1).split()) for face in FACE.finditer(text)]
    large = [(start, corners) for start, corners in faces if len(corners) > READ]
    if not large or read > sum(len(corners) - 2 for _, corners in faces if len(corners) <= READ):
        return np.zeros((0, 3, 3))
    lines = list(VERTEX.finditer(text))
    vertices = np.array([line.groups() for line in lines]).astype(np.float64)
    begins = [line.start() for line in lines]
    found = []
    for start, corners in large:
        known = int(np.searchsorted(begins, start))  # what negative numbers count back from
        numbers = [int(corner.split(b"/")[0]) for corner in corners]
        points = vertices[[number - 1 if number > 0 else known + number for number in numbers]]
        found.append(points[triangulated(points)])
    return np.concatenate(found)
