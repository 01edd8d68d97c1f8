# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes that are not walls of revolution are rejected with a reason."""

import math
import re

import FreeCAD
import Part
import pytest
from FreeCAD import Vector

from freecad_am.brep.revolution.wall import find_wall
from freecad_am.core.issues import InputError

ORIGIN, Z = Vector(), Vector(0, 0, 1)
TUBE = Part.makeCylinder(10, 30).cut(Part.makeCylinder(8, 30))


def refused(shape, *args, **options):
    with pytest.raises(InputError) as error_info:
        find_wall(shape, *args, **options)
    assert error_info.value.exit_status == 2
    return error_info.value


def elliptic(stretch):
    matrix = FreeCAD.Matrix()
    matrix.scale(1.0, stretch, 1.0)
    side = Part.makeCylinder(10, 30).Faces[0]
    return side.transformGeometry(matrix)


@pytest.mark.parametrize("stretch", [1.01, 1.1, 1.5])
def test_an_elliptic_cylinder_is_refused_by_face_and_deviation(stretch):
    error = refused(elliptic(stretch), label="Pipe")
    assert error.code == "NOT_REVOLUTION"
    assert error.where == "Pipe Face1"
    stated_deviation = float(re.search(r"([\d.]+) mm off", error.message).group(1))
    # radii range from 10 to 10 * stretch; the stated deviation is relative to one meridian
    assert 0.4 * 10.0 * (stretch - 1.0) < stated_deviation < 1.01 * 10.0 * (stretch - 1.0)


def test_a_stretch_within_the_tolerance_is_no_matter():
    assert find_wall(elliptic(1.00002)).meridian.length == pytest.approx(30.0, abs=1e-3)


def test_the_face_that_is_off_is_named():
    square = Part.makeBox(30, 30, 10, Vector(-15, -15, 30)).fuse(Part.makeCylinder(10, 30))
    error = refused(square)
    assert error.code == "NOT_REVOLUTION"
    assert re.search(r"Face\d+", error.where)
    assert "mm off" in error.message


def test_a_wall_with_a_window_is_refused():
    error = refused(TUBE.cut(Part.makeCylinder(2, 50, Vector(-25, 0, 15), Vector(1, 0, 0))))
    assert error.code == "NOT_REVOLUTION"
    side = (
        Part.makeCylinder(10, 30)
        .Faces[0]
        .cut(Part.makeCylinder(2, 50, Vector(-25, 0, 15), Vector(1, 0, 0)))
    )
    error = refused(side.Faces[0])
    assert error.code == "NOT_REVOLUTION"
    assert "cut out or slanted" in error.message


def test_a_slanted_end_is_refused():
    cutter = Part.makeBox(100, 100, 100, Vector(-50, -50, 20))
    cutter.rotate(Vector(0, 0, 20), Vector(0, 1, 0), 10)
    error = refused(Part.makeCylinder(10, 40).cut(cutter).Faces[0])
    assert error.code == "NOT_REVOLUTION"
    stated_deviation = float(re.search(r"([\d.]+) mm off", error.message).group(1))
    assert stated_deviation == pytest.approx(20.0 * math.tan(math.radians(10.0)), rel=0.05)


@pytest.mark.parametrize(
    ("shape", "code"),
    [
        (Part.makeBox(10, 20, 30), "NO_WALL"),
        (Part.Shape(), "NO_WALL"),
        (None, "NO_WALL"),
        (Part.Vertex(1, 2, 3), "NO_WALL"),
        (Part.makeLine(ORIGIN, Vector(1, 0, 1)), "NO_AXIS"),
        (Part.makePlane(10, 10), "NO_WALL"),
    ],
)
def test_what_has_no_wall_is_told(shape, code):
    assert refused(shape, label="Thing").code == code


def test_a_full_part_has_no_inner_wall():
    for wall in ("inner", "middle"):
        assert refused(Part.makeCylinder(10, 30), wall=wall).code == "NO_WALL"


def test_a_surface_has_no_inner_wall_and_says_so():
    wall = find_wall(Part.makeCylinder(10, 30).Faces[0], wall="inner")
    assert [issue.code for issue in wall.issues] == ["OPEN_WALL"]


def test_unknown_faces_are_named():
    error = refused(TUBE, ("Face1", "Face9"))
    assert error.code == "UNKNOWN_FACE"
    assert "Face9" in error.message


def test_faces_that_do_not_join_are_named():
    edges = [Part.makeLine(Vector(r, 0, h), Vector(r, 0, h + 5)) for r, h in ((10, 0), (3, 9))]
    separate_faces = Part.makeCompound([edge.revolve(ORIGIN, Z, 360) for edge in edges])
    error = refused(separate_faces)
    assert error.code == "NO_WALL"
    assert "Face1 and Face2" in error.message


def test_two_solids_with_a_wall_are_named():
    error = refused(
        Part.makeCompound([Part.makeCylinder(10, 30), Part.makeCylinder(10, 30, Vector(50, 0, 0))])
    )
    assert error.code == "SEVERAL_SOLIDS"
    assert "Solid1" in error.message
    assert "Solid2" in error.message


def test_faces_that_turn_differently_are_named():
    low = Part.makeLine(Vector(10, 0, 0), Vector(10, 0, 5)).revolve(ORIGIN, Z, 90)
    high = Part.makeLine(Vector(10, 0, 5), Vector(8, 0, 9)).revolve(ORIGIN, Z, 120)
    error = refused(Part.makeCompound([low, high]))
    assert error.code == "NOT_REVOLUTION"
    assert "0 to 90 deg" in error.message
    assert "0 to 120 deg" in error.message


def test_a_ring_with_two_openings_is_refused():
    line = Part.makeLine(Vector(10, 0, 0), Vector(10, 0, 5))
    second_face = line.revolve(ORIGIN, Z, 90)
    second_face.rotate(ORIGIN, Z, 180)
    assert (
        "opening" in refused(Part.makeCompound([line.revolve(ORIGIN, Z, 90), second_face])).message
    )


def test_wires_that_cross_or_leave_the_plane_of_the_axis_are_refused():
    wire = Part.makePolygon([Vector(10, 0, 0), Vector(5, 0, 9), Vector(7, 0, 20)])
    assert "crosses the axis" in refused(wire, axis=(Vector(8, 0, 0), Z)).message
    skew = Part.makePolygon([Vector(10, 0, 0), Vector(5, 3, 9)])
    assert "off the plane" in refused(skew, axis=(ORIGIN, Z)).message
    assert refused(Part.makeLine(ORIGIN, Z), axis=(ORIGIN, Z)).code == "NO_WALL"
