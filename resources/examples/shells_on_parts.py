# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls beyond the torus: a loft on a dome, a spatial pipe on a cone, several faces, a half shell, a branching tube."""

from __future__ import annotations

import math
from typing import Any

import step_files  # noqa: F401  (finds FreeCAD)
from FreeCAD import Placement, Rotation, Vector
from tubes_on_pipes import bend

import Part  # isort: skip  (after FreeCAD, it crashes before)

TURN = 2.0 * math.pi
UP = Vector(0, 0, 1)
DOME_AT = Vector(-60, 35, 12)
ELBOW_AT, ELBOW_TURNED = Vector(-85, 140, 10), 30.0  # mm, deg
HALF_AT = Vector(150, 90, 40)
BRANCH_AT = Vector(10, -20, 100)


def flared_shell() -> Any:
    """A loft from a circle to an ellipse that leans and lies to one side."""
    low = Part.makeCircle(16.0, Vector(0, 0, 24), UP)
    middle = Part.makeCircle(17.0, Vector(0, 1, 46), Vector(0, -0.1, 1))
    high = Part.Ellipse(Vector(), 28.0, 18.0).toShape()
    high.Placement = Placement(Vector(4, 6, 74), Rotation(Vector(1, 0, 0), -15.0))
    return _moved(
        Part.makeLoft([Part.Wire([edge]) for edge in (low, middle, high)], False, False), DOME_AT
    )


def dome() -> Any:
    """The upper half of a sphere."""
    return _moved(Part.makeSphere(40.0, Vector(), UP, 0.0, 90.0, 360.0), DOME_AT)


def spatial_pipe() -> Any:
    """A tube along a B-spline that is not plane."""
    spine = Part.BSplineCurve()
    spine.interpolate(
        [
            Vector(*point)
            for point in ((14, 0, 24), (30, 0, 40), (40, 8, 62), (38, 26, 80), (24, 44, 90))
        ]
    )
    start, tangent = spine.value(spine.FirstParameter), spine.tangent(spine.FirstParameter)[0]
    profile = Part.Wire([Part.makeCircle(10.0, start, tangent)])
    return Part.Wire([spine.toShape()]).makePipeShell([profile], False, False)


def cone() -> Any:
    """The truncated cone it leaves sideways."""
    return Part.makeCone(48.0, 16.0, 64.0)


def elbow() -> Any:
    """Three tangent faces: a straight tube, a bend of 60 deg, and a straight tube."""
    radius, tube, height, angle = 40.0, 13.0, 22.0, math.radians(60.0)
    centre = Vector(-radius, 0, height)
    end = centre + Vector(radius * math.cos(angle), 0, radius * math.sin(angle))
    along = Vector(-math.sin(angle), 0, math.cos(angle))
    faces = [
        _tube(tube, Vector(0, 0, -4), UP, height + 4.0),
        bend(radius, tube, 60.0, Vector(0, 0, height)),
        _tube(tube, end, along, 15.0),
    ]
    shell = Part.makeShell(faces)
    shell.sewShape()
    return _moved(shell, ELBOW_AT, ELBOW_TURNED)


def elbow_block() -> Any:
    """The block it stands on, its top sloping."""
    corners = [
        Vector(-30, -30, -20),
        Vector(30, -30, -20),
        Vector(30, -30, 3),
        Vector(-30, -30, -3),
    ]
    return _moved(
        Part.Face(Part.makePolygon([*corners, corners[0]])).extrude(Vector(0, 60, 0)),
        ELBOW_AT,
        ELBOW_TURNED,
    )


def half_shell() -> Any:
    """The outer half of a bend: a gutter with two long free edges."""
    torus = Part.Toroid()
    torus.MajorRadius, torus.MinorRadius = 60.0, 20.0
    torus.Center, torus.Axis = HALF_AT - Vector(60, 0, 0), Vector(0, -1, 0)
    return torus.toShape(0.0, math.radians(65.0), -0.25 * TURN, 0.25 * TURN)


def half_shell_pipe() -> Any:
    """The rod it grows on, about Y."""
    return Part.makeCylinder(30.0, 100.0, HALF_AT - Vector(0, 50, 0), Vector(0, 1, 0))


def branched_tube() -> Any:
    """A tube and a branch that leaves it at 50 deg, rounded where they meet: the skin of both, without its ends."""
    angle = math.radians(50.0)
    along = Vector(math.sin(angle), 0, math.cos(angle))
    both = Part.makeCylinder(18.0, 86.0, Vector(0, 0, -4)).fuse(
        Part.makeCylinder(12.0, 84.0, Vector(0, 0, 22), along)
    )
    both = both.removeSplitter()
    meeting = [edge for edge in both.Edges if edge.Curve.TypeId == "Part::GeomBSplineCurve"]
    faces = [
        face
        for face in both.makeFillet(8.0, meeting).Faces
        if face.Surface.TypeId != "Part::GeomPlane"
    ]
    return _moved(Part.Shell(faces), BRANCH_AT)


def base_plate() -> Any:
    """The plate the branching tube stands on."""
    return _moved(Part.makeBox(70.0, 60.0, 8.0, Vector(-30, -30, -8)), BRANCH_AT)


def _tube(radius: float, start: Any, along: Any, length: float) -> Any:
    cylinder = Part.Cylinder()
    cylinder.Radius, cylinder.Center, cylinder.Axis = radius, start, along
    return cylinder.toShape(0.0, TURN, 0.0, length)


def _moved(shape: Any, to: Any, turned: float = 0.0) -> Any:
    """A shape turned about Z (deg) and moved."""
    shape.Placement = Placement(to, Rotation(UP, turned)) * shape.Placement
    return shape
