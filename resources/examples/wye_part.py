# SPDX-License-Identifier: LGPL-2.1-or-later
"""A Y for layers that need no support: a stem that forks into two arms at 45 degrees to the vertical."""

from __future__ import annotations

from typing import Any

import step_files  # noqa: F401  (finds FreeCAD)
from FreeCAD import Vector

import Part  # isort: skip  (after FreeCAD, it crashes before)

STEM, ARM = 9.0, 8.0  # radii, mm; alike they would meet along edges that touch
HEIGHT, FORK, LENGTH = (
    34.0,
    24.0,
    45.0,
)  # of the stem, where the axes of the arms begin, and how long these are, mm


def wye() -> Any:
    """The Y, standing on the plane z = 0."""
    arms = [
        Part.makeCylinder(ARM, LENGTH, Vector(0, 0, FORK), Vector(way, 0, 1)) for way in (1, -1)
    ]
    return Part.makeCylinder(STEM, HEIGHT).fuse(arms).removeSplitter().Solids[0]
