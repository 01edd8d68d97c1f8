# SPDX-License-Identifier: LGPL-2.1-or-later
"""The solids of `bench infill`, and meshes of them: files for both slicers, and sections for the judge."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from FreeCAD import Vector

import MeshPart  # isort: skip  (after FreeCAD, it crashes before)
import Part  # isort: skip

BEAD, LAYER = 4.0, 2.0  # mm
PRISM = 10.0 * LAYER  # mm, the height of solids with equal sections
DEFLECTION = 0.01  # mm, of meshes
DEFLECTION_RAD = 0.1
TURNED_DEG = 17.0
BRACKET = Path(__file__).resolve().parent.parent / "resources" / "examples" / "bracket.step"
UP = Vector(0, 0, 1)


class Case(NamedTuple):
    """A solid and its fill: contours only, or zigzags within two of them."""

    name: str
    shape: Callable[[], Any]
    fill: str = "contours"


def bracket() -> Any:
    """The bracket of the examples, on its plate."""
    shape = Part.Shape()
    shape.read(str(BRACKET))
    return shape


def turned_bracket() -> Any:
    """The bracket, turned about the stacking direction."""
    shape = bracket()
    shape.rotate(Vector(), UP, TURNED_DEG)
    return shape


def walls() -> Any:
    """Straight walls with thicknesses that are no whole number of beads."""
    thicknesses = BEAD * np.array([1.3, 1.7, 2.2, 2.6, 3.1])
    places = np.cumsum(np.r_[0.0, thicknesses[:-1] + 2.0 * BEAD])
    return Part.makeCompound(
        [Part.makeBox(60.0, t, PRISM, Vector(0, y, 0)) for t, y in zip(thicknesses, places)]
    )


def thin_wall() -> Any:
    """A single short wall of 1.3 beads."""
    return Part.makeBox(20.0, 1.3 * BEAD, LAYER)


def star() -> Any:
    """A prism with five tips."""
    angle = 0.2 * math.pi * np.arange(10) + 0.1
    radius = np.where(np.arange(10) % 2, 18.0, 42.0)
    return _prism(radius, angle)


def ring_gear() -> Any:
    """A ring with 36 teeth inside."""
    teeth = 36
    flanks = np.array([0.0, 0.25, 0.5, 0.75])
    angle = 2.0 * math.pi / teeth * (np.arange(teeth)[:, None] + flanks).ravel()
    radius = np.tile([40.0, 40.0, 46.0, 46.0], teeth)
    return Part.makeCylinder(56.0, PRISM).cut(_prism(radius, angle))


def perforated_plate() -> Any:
    """A plate with 24 holes."""
    holes = [
        Part.makeCylinder(5.0, PRISM, Vector(10.0 + 20.0 * x, 10.0 + 20.0 * y, 0.0))
        for x in range(6)
        for y in range(4)
    ]
    return Part.makeBox(120.0, 80.0, PRISM).cut(Part.makeCompound(holes))


def conical_wall() -> Any:
    """A wall of 1.5 beads on a cone."""
    height, thick = 10.0 * LAYER, 1.5 * BEAD
    outer = Part.makeCone(40.0, 34.0, height)
    return outer.cut(Part.makeCone(40.0 - thick, 34.0 - thick, height))


def thickening_wall() -> Any:
    """A round wall of 1.1 beads at its foot and 3.3 at its top."""
    height = 20.0 * LAYER
    inner = Part.makeCone(40.0 - 1.1 * BEAD, 40.0 - 3.3 * BEAD, height)
    return Part.makeCylinder(40.0, height).cut(inner)


def round_islands() -> Any:
    """Pins from 0.6 to 2.5 beads in diameter."""
    diameters = BEAD * np.linspace(0.6, 2.5, 12)
    return Part.makeCompound(
        [
            Part.makeCylinder(0.5 * d, PRISM, Vector(14.0 * (k % 4), 14.0 * (k // 4), 0.0))
            for k, d in enumerate(diameters)
        ]
    )


def square_islands(side: int) -> Any:
    """Blocks of one layer, each 1.5 beads wide, in a square of `side` by `side` of them."""
    wide, pitch = 1.5 * BEAD, 3.0 * BEAD
    return Part.makeCompound(
        [
            Part.makeBox(wide, wide, LAYER, Vector(pitch * x, pitch * y, 0.0))
            for x in range(side)
            for y in range(side)
        ]
    )


def tapering_fins() -> Any:
    """A hub with three ribs that taper to an edge."""
    hub = Part.makeCylinder(13.0, PRISM)
    fins = []
    for k in range(3):
        corners = [Vector(0, -3.0, 0), Vector(70.0, 0, 0), Vector(0, 3.0, 0)]
        fin = Part.Face(Part.makePolygon([*corners, corners[0]])).extrude(PRISM * UP)
        fin.rotate(Vector(), UP, 120.0 * k + 7.0)
        fins.append(fin)
    return hub.fuse(fins).removeSplitter()


CASES = (
    Case("bracket", bracket),
    Case("bracket turned by 17 deg", turned_bracket),
    Case("bracket", bracket, "zigzag"),
    Case("bracket turned by 17 deg", turned_bracket, "zigzag"),
    Case("walls of 1.3 to 3.1 beads", walls),
    Case("star", star),
    Case("plate with 24 holes", perforated_plate),
    Case("plate with 24 holes", perforated_plate, "zigzag"),
    Case("ring gear", ring_gear),
    Case("conical wall of 1.5 beads", conical_wall),
    Case("round wall of 1.1 to 3.3 beads", thickening_wall),
    Case("pins of 0.6 to 2.5 beads", round_islands),
    Case("hub with tapering fins", tapering_fins),
)
SMALLEST_CASES = (Case("wall of 1.3 beads", thin_wall),)


class Triangles(NamedTuple):
    """A closed mesh: corners (k, 3, 3) mm of outward triangles."""

    corners: np.ndarray

    @property
    def layer_count(self) -> int:
        """Number of whole layers in the height."""
        return round(float(np.ptp(self.corners[:, :, 2])) / LAYER)

    def section(self, number: int) -> np.ndarray:
        """(k, 2, 2) mm, the border of the section in the middle of a layer: edges with the material on their left."""
        plane = self.corners[:, :, 2].min() + (number + 0.5) * LAYER
        above = self.corners[:, :, 2] > plane
        cut = above.any(axis=1) & ~above.all(axis=1)
        corners, above = self.corners[cut], above[cut]
        following, following_above = np.roll(corners, -1, axis=1), np.roll(above, -1, axis=1)
        share = (plane - corners[:, :, 2]) / np.where(
            above != following_above, following[:, :, 2] - corners[:, :, 2], np.inf
        )
        points = (corners + share[:, :, None] * (following - corners))[:, :, :2]
        down, up = (points[mask] for mask in (above & ~following_above, ~above & following_above))
        return np.stack([down, up], axis=1)


def write_mesh(shape: Any, file: Path) -> Triangles:
    """Write a mesh of a shape as STL and return its triangles as the file has them."""
    mesh = MeshPart.meshFromShape(
        Shape=shape, LinearDeflection=DEFLECTION, AngularDeflection=DEFLECTION_RAD
    )
    mesh.write(str(file))
    points = np.array([[*point] for point in mesh.Topology[0]])
    return Triangles(points[np.array(mesh.Topology[1])].astype(np.float32).astype(float))


def _prism(radius: np.ndarray, angle: np.ndarray) -> Any:
    """A prism on a polygon with corners at polar coordinates (n,), mm and rad."""
    corners = [Vector(x, y, 0.0) for x, y in zip(radius * np.cos(angle), radius * np.sin(angle))]
    return Part.Face(Part.makePolygon([*corners, corners[0]])).extrude(PRISM * UP)
