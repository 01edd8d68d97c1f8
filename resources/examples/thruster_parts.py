# SPDX-License-Identifier: LGPL-2.1-or-later
"""A thruster like that of Dai 2020, section 5: a spindle with a cone of R = 60 and H = 200 and three groups of six blades.

What the paper tells is kept: the cone, the largest circumcircles of 466.5, 399.9 and 384.3 mm from the lowest group up, and
blades about 40 mm thick at the hub and 20 mm at the tip. The rest is made up.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import step_files  # noqa: F401  (finds FreeCAD)
from FreeCAD import Placement, Rotation, Vector

import Part  # isort: skip  (after FreeCAD, it crashes before)

UP = Vector(0, 0, 1)
CONE_RADIUS, CONE_HEIGHT, CONE_AT, CONE_LENGTH = 60.0, 200.0, 280.0, 130.0
BLADES = 6
FOOT, TIP = 40.0, 20.0  # thickness
START = 12.0  # from the axis, inside of the hub


class Blades(NamedTuple):
    """A group: height of its middle, radius of the hub there, diameter of the circumcircle; chord, stagger, twist (deg)."""

    at: float
    hub: float
    diameter: float
    chord: float
    stagger: float
    twist: float


GROUPS = (
    Blades(70.0, 75.0, 466.5, 84.0, 22.0, 0.0),
    Blades(205.0, 60.0, 399.9, 74.0, 14.0, 24.0),
    Blades(326.0, CONE_RADIUS * (1.0 - 46.0 / CONE_HEIGHT), 384.3, 66.0, 0.0, 0.0),
)


def spindle() -> Any:
    """Two cylinders and a truncated cone."""
    low, middle = (
        Part.makeCylinder(75.0, 140.0),
        Part.makeCylinder(CONE_RADIUS, 140.0, Vector(0, 0, 140)),
    )
    end = CONE_RADIUS * (1.0 - CONE_LENGTH / CONE_HEIGHT)
    cone = Part.makeCone(CONE_RADIUS, end, CONE_LENGTH, Vector(0, 0, CONE_AT))
    return low.fuse([middle, cone]).removeSplitter()


def blades() -> Any:
    """All blades, each a solid of its own that stands on the spindle."""
    hub = spindle()
    return Part.Compound([blade for group in GROUPS for blade in _group(group, hub)])


def _group(group: Blades, hub: Any) -> list[Any]:
    around = Part.makeCylinder(0.5 * group.diameter, 500.0, Vector(0, 0, -50))
    first = _bare(group).common(around).cut(hub).Solids
    outer = max(first, key=lambda solid: solid.Volume)
    made = []
    for number in range(BLADES):
        turn = Placement(Vector(), Rotation(UP, number * 360.0 / BLADES))
        made.append(
            outer.transformed(turn.toMatrix(), False)
        )  # one shape, six times: a BREP file keeps it so
    return made


def _bare(group: Blades) -> Any:
    """The blade from inside the hub to beyond its tip, about the X axis."""
    end, tip = 0.5 * group.diameter + 5.0, 0.5 * group.diameter
    slope = (TIP - FOOT) / (tip - group.hub)
    wires = []
    for x in (START, end):
        thick = FOOT + slope * (x - group.hub)
        turn = group.stagger + group.twist * (x - group.hub) / (tip - group.hub)
        outline = Part.Ellipse(Vector(), 0.5 * group.chord, 0.5 * thick).toShape()
        outline.Placement = Placement(Vector(x, 0, group.at), _upright(turn))
        wires.append(Part.Wire([outline]))
    return Part.makeLoft(wires, True, True)


def _upright(turn: float) -> Any:
    """X of a section to the part's Z, turned about the part's X by `turn` deg."""
    a = math.radians(turn)
    x, y = Vector(0, -math.sin(a), math.cos(a)), Vector(0, math.cos(a), math.sin(a))
    return Rotation(x, y, x.cross(y), "XYZ")
