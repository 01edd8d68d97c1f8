# SPDX-License-Identifier: LGPL-2.1-or-later
"""A rotor for a first try, in the manner of Dai 2020 but small: three twisted blades on a truncated cone."""

from __future__ import annotations

from typing import Any

import step_files  # noqa: F401  (finds FreeCAD)
from FreeCAD import Placement, Rotation, Vector

import Part  # isort: skip  (after FreeCAD, it crashes before)

UP = Vector(0, 0, 1)
FOOT, TOP, TALL = 60.0, 40.0, 90.0  # radii and height of the hub
BLADES, MIDDLE, TIP = 3, 45.0, 76.0  # how many, their height on the hub, radius of the circumcircle
# distance from the axis, chord, thickness, stagger (deg) of the sections of a blade; the first is inside the hub
SECTIONS = ((25.0, 54.0, 30.0, 12.0), (80.0, 48.0, 18.0, 32.0))


def hub() -> Any:
    """A truncated cone."""
    return Part.makeCone(FOOT, TOP, TALL)


def blades() -> Any:
    """Three solids that stand on it."""
    around = Part.makeCylinder(TIP, 2 * TALL, Vector(0, 0, -0.5 * TALL))
    bare = (
        Part.makeLoft([_section(*section) for section in SECTIONS], True, True)
        .common(around)
        .cut(hub())
    )
    blade = max(bare.Solids, key=lambda solid: solid.Volume)
    turns = (Placement(Vector(), Rotation(UP, number * 360.0 / BLADES)) for number in range(BLADES))
    return Part.Compound([blade.transformed(turn.toMatrix(), False) for turn in turns])


def _section(x: float, chord: float, thick: float, stagger: float) -> Any:
    outline = Part.Ellipse(Vector(), 0.5 * chord, 0.5 * thick).toShape()
    lean = Rotation(Vector(1, 0, 0), stagger)
    along, across = lean.multVec(UP), lean.multVec(Vector(0, 1, 0))
    outline.Placement = Placement(
        Vector(x, 0, MIDDLE), Rotation(along, across, along.cross(across), "XYZ")
    )
    return Part.Wire([outline])
