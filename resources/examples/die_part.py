# SPDX-License-Identifier: LGPL-2.1-or-later
"""A worn die to be clad: a block whose top is bent both ways, with a bore through it."""

from __future__ import annotations

import math
from typing import Any

import step_files  # noqa: F401  (finds FreeCAD)
from FreeCAD import Vector

import Part  # isort: skip  (after FreeCAD, it crashes before)

LENGTH, DEPTH, HEIGHT, BORE = 110.0, 80.0, 30.0, 11.0  # mm; the last a radius
RISE, WAVES, BESIDE = (
    5.0,
    (35.0, 45.0),
    20.0,
)  # mm: of the top, along x and y, and how far its surface goes beyond the block
STEP = 10.0  # mm between the points that it is interpolated from


def die() -> Any:
    """The die, standing on the plane z = 0; its worn face is the one bent both ways."""
    ways = [
        [STEP * k - BESIDE for k in range(int((side + 2.0 * BESIDE) / STEP) + 1)]
        for side in (LENGTH, DEPTH)
    ]
    top = Part.BSplineSurface()
    top.interpolate(
        [
            [
                Vector(x, y, HEIGHT + RISE * math.cos(x / WAVES[0]) * math.cos(y / WAVES[1]))
                for y in ways[1]
            ]
            for x in ways[0]
        ]
    )
    above = top.toShape().extrude(Vector(0, 0, 2.0 * HEIGHT))
    block = Part.makeBox(LENGTH, DEPTH, 2.0 * HEIGHT)
    bore = Part.makeCylinder(BORE, 3.0 * HEIGHT, Vector(0.6 * LENGTH, 0.5 * DEPTH, -0.5 * HEIGHT))
    return block.cut([above, bore]).removeSplitter().Solids[0]
