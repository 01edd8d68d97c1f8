# SPDX-License-Identifier: LGPL-2.1-or-later
"""An angle bracket for plane layers: a plate with four holes, a wall with a bore, two ribs between them."""

from __future__ import annotations

from typing import Any

import step_files  # noqa: F401  (finds FreeCAD)
from FreeCAD import Vector

import Part  # isort: skip  (after FreeCAD, it crashes before)

LENGTH, DEPTH, HEIGHT, THICK = 150.0, 90.0, 100.0, 20.0  # mm
CORNER, HOLE, BORE = 16.0, 7.0, 22.0  # radii, mm
RIB, REACH = 14.0, 55.0  # thickness of a rib, and how far it runs along plate and wall, mm
UP, ACROSS = Vector(0, 0, 1), Vector(0, 1, 0)


def bracket() -> Any:
    """The bracket, its plate on the plane z = 0, its wall along the edge y = 0."""
    plate = Part.makeBox(LENGTH, DEPTH, THICK)
    plate = plate.makeFillet(
        CORNER, [edge for edge in _short(plate) if edge.CenterOfMass.y > 0.5 * DEPTH]
    )
    wall = Part.makeBox(LENGTH, THICK, HEIGHT)
    wall = wall.makeFillet(
        2.0 * CORNER, [edge for edge in _short(wall) if edge.CenterOfMass.z > 0.5 * HEIGHT]
    )
    whole = plate.fuse([wall, *(_rib(x) for x in (30.0, LENGTH - 30.0 - RIB))])
    holes = [
        Part.makeCylinder(HOLE, THICK, Vector(x, y, 0), UP)
        for x in (16.0, LENGTH - 16.0)
        for y in (38.0, 72.0)
    ]
    bore = Part.makeCylinder(BORE, THICK, Vector(0.5 * LENGTH, 0, 62.0), ACROSS)
    return whole.cut([*holes, bore]).removeSplitter().Solids[0]


def _short(box: Any) -> list[Any]:
    return [edge for edge in box.Edges if abs(edge.Length - THICK) < 1e-6]


def _rib(x: float) -> Any:
    points = [
        Vector(x, THICK, THICK),
        Vector(x, THICK + REACH, THICK),
        Vector(x, THICK, THICK + REACH),
    ]
    return Part.Face(Part.makePolygon([*points, points[0]])).extrude(Vector(RIB, 0, 0))
