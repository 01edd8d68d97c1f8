# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes that documents create: Part and PartDesign revolutions, primitives, sketches."""

import math
import sys
from pathlib import Path

import FreeCAD
import Part
import pytest
from FreeCAD import Placement, Rotation, Vector

from freecad_am.brep.revolution.wall import find_wall

UPRIGHT = Placement(Vector(), Rotation(Vector(1, 0, 0), 90))


def sketch(owner, kind="Sketcher::SketchObject"):
    sketch_object = (
        owner.newObject(kind, "Profile")
        if hasattr(owner, "newObject")
        else owner.addObject(kind, "Profile")
    )
    sketch_object.Placement = UPRIGHT
    corners = [Vector(20, 0, 0), Vector(22, 0, 0), Vector(17, 30, 0), Vector(15, 30, 0)]
    for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
        sketch_object.addGeometry(Part.LineSegment(start, end), False)
    return sketch_object


def assert_slanted(wall, angle=360.0):
    assert wall.meridian.length == pytest.approx(math.hypot(5, 30), abs=1e-9)
    assert wall.meridian.points[0] == pytest.approx([22, 0], abs=1e-9)
    assert math.degrees(wall.end - wall.start) == pytest.approx(angle, abs=1e-6)


@pytest.mark.parametrize("angle", [360.0, 250.0])
def test_part_revolutions(doc, angle):
    profile = sketch(doc)
    revolve = doc.addObject("Part::Revolution", "Revolve")
    revolve.Source, revolve.Axis, revolve.Angle, revolve.Solid = (
        profile,
        Vector(0, 0, 1),
        angle,
        True,
    )
    doc.recompute()
    assert_slanted(find_wall(revolve.Shape), angle)


def test_part_design_revolutions(doc, monkeypatch):
    for folder in [Path(entry) for entry in sys.path if Path(entry).name == "PartDesign"]:
        monkeypatch.syspath_prepend(
            str(folder.parent)
        )  # PartDesign is a package in FreeCAD's folder Mod
    body = doc.addObject("PartDesign::Body", "Body")
    profile = sketch(body)
    revolve = body.newObject("PartDesign::Revolution", "Revolution")
    revolve.Profile, revolve.ReferenceAxis, revolve.Angle = profile, (profile, ["V_Axis"]), 360
    doc.recompute()
    assert_slanted(find_wall(revolve.Shape))


def test_sketches_with_an_axis(doc):
    profile = sketch(doc)
    doc.recompute()
    assert_slanted(find_wall(profile.Shape, axis=(Vector(), Vector(0, 0, 1))))


@pytest.mark.parametrize(
    ("kind", "values", "length"),
    [
        ("Part::Sphere", {"Radius": 30}, 30 * math.pi),
        ("Part::Cylinder", {"Radius": 8, "Height": 25}, 25),
        ("Part::Cone", {"Radius1": 20, "Radius2": 5, "Height": 20}, 25),
        ("Part::Torus", {"Radius1": 40, "Radius2": 5}, 5 * math.pi),
    ],
)
def test_primitives_wherever_they_stand(doc, kind, values, length):
    primitive = doc.addObject(kind, "Primitive")
    for name, value in values.items():
        setattr(primitive, name, value)
    primitive.Placement = Placement(Vector(10, -20, 30), Rotation(Vector(1, 1, 0), 35))
    doc.recompute()
    wall = find_wall(primitive.Shape)
    assert wall.meridian.length == pytest.approx(length, abs=1e-6)
    axis = primitive.Placement.Rotation.multVec(FreeCAD.Vector(0, 0, 1))
    assert wall.frame[:3, 2] == pytest.approx(list(axis), abs=1e-9)
