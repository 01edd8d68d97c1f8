# SPDX-License-Identifier: LGPL-2.1-or-later
"""Hubs whose cylinders and cones are splines, as some systems export them."""

import FreeCAD
import numpy as np
import Part
import pytest

from freecad_am.brep.hub import FITTED, seats
from freecad_am.core.issues import InputError

PLACE = FreeCAD.Placement(FreeCAD.Vector(13, -7, 31), FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 40))


def named(shape):
    return [(f"Face{k + 1}", face) for k, face in enumerate(shape.Faces)]


@pytest.mark.parametrize("solid", [
    Part.makeCylinder(60.0, 140.0), Part.makeCone(60.0, 36.0, 80.0), Part.makeCone(20.0, 60.0, 90.0),
    Part.makeCylinder(60.0, 140.0, FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 200.0),
], ids=["cylinder", "cone", "turned cone", "part of a turn"])  # fmt: skip
@pytest.mark.parametrize("placement", [FreeCAD.Placement(), PLACE], ids=["upright", "anywhere"])
def test_splines_are_what_they_were_made_of(solid, placement):
    solid = solid.copy()
    solid.Placement = placement
    (exact,), (fitted,) = seats(named(solid), False), seats(named(solid.toNurbs()), False)
    assert all(
        face.Surface.TypeId in ("Part::GeomBSplineSurface", "Part::GeomPlane")
        for face in solid.toNurbs().Faces
    )
    assert fitted.base.surface.radius == pytest.approx(exact.base.surface.radius, abs=1e-6)
    assert fitted.base.surface.height == pytest.approx(exact.base.surface.height, rel=1e-6)
    np.testing.assert_allclose(fitted.base.frame, exact.base.frame, atol=1e-6)
    np.testing.assert_allclose(fitted.faces, exact.faces, atol=1e-6)


def test_a_spline_that_is_nearly_one_is_none():
    """Elliptic cylinders within and beyond the tolerance of a round one, and a barrel."""
    for difference, is_accepted in ((0.2 * FITTED, True), (4.0 * FITTED, False)):
        wire = Part.Wire([Part.Ellipse(FreeCAD.Vector(), 60.0 + difference, 60.0).toShape()])
        seats_found = seats(
            named(Part.Face(wire).extrude(FreeCAD.Vector(0, 0, 100)).toNurbs()), False
        )
        assert [seat.base.surface.radius for seat in seats_found] == (
            [pytest.approx(60.0, abs=FITTED)] if is_accepted else []
        )
    arc = Part.Arc(
        FreeCAD.Vector(60, 0, 0), FreeCAD.Vector(61, 0, 50), FreeCAD.Vector(60, 0, 100)
    ).toShape()
    barrel = arc.revolve(FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 360).toNurbs().Faces[0]
    with pytest.raises(InputError) as refused:
        seats([("Face1", barrel)], True)
    assert refused.value.code == "NOT_DEVELOPABLE"


def test_bores_of_splines_are_bores():
    pipe = Part.makeCylinder(60.0, 50.0).cut(Part.makeCylinder(40.0, 50.0)).toNurbs()
    (seat,) = seats(named(pipe), False)
    assert seat.base.surface.radius == pytest.approx(60.0, abs=1e-6)


@pytest.mark.parametrize("degrees", [20.0, 90.0, 180.0, 200.0, 350.0, 360.0])
@pytest.mark.parametrize("start", [0.0, 77.0, 300.0])
@pytest.mark.parametrize("made", ["cylinder", "cone", "spline"])
@pytest.mark.always
def test_a_face_tells_from_where_to_where_it_goes_round(degrees, start, made):
    axis = FreeCAD.Vector(0, 0, 1)
    solid = (
        Part.makeCone(60.0, 36.0, 80.0, FreeCAD.Vector(), axis, degrees)
        if made == "cone"
        else Part.makeCylinder(60.0, 140.0, FreeCAD.Vector(), axis, degrees)
    )
    solid.rotate(FreeCAD.Vector(), axis, start)
    solid = solid.toNurbs() if made == "spline" else solid
    middle = FreeCAD.Rotation(axis, start + 0.5 * degrees).multVec(FreeCAD.Vector(1, 0, 0))
    (seat,) = seats(named(solid), False)
    (face,) = seat.faces
    assert face.span == pytest.approx(np.radians(degrees), abs=1e-6)
    along = face.start + 0.5 * face.span
    if degrees < 360.0:  # the frame's X is the part's
        np.testing.assert_allclose([np.cos(along), np.sin(along)], [middle.x, middle.y], atol=1e-6)


def test_halves_of_a_cylinder_are_one_seat_all_round():
    """Exchange files have two faces of one surface, which together are one seat."""
    cylinder = Part.makeCylinder(60.0, 140.0)
    half = Part.makeCylinder(60.0, 140.0, FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 180.0)
    half_face = next(face for face in half.Faces if face.Surface.TypeId == "Part::GeomCylinder")
    second_face = half_face.copy()
    second_face.rotate(FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 180.0)
    (seat,) = seats([("Face1", half_face), ("Face2", second_face)], False)
    (full_seat,) = seats(named(cylinder), False)
    around = np.linspace(-np.pi, np.pi, 500)
    points = np.stack([60.0 * np.cos(around), 60.0 * np.sin(around), np.full(500, 70.0)], axis=1)
    assert np.logical_or.reduce([face.near(points, 0.05) for face in seat.faces]).all()
    assert all(
        face.near(points, 0.05).mean() == pytest.approx(0.5, abs=0.01) for face in seat.faces
    )
    assert full_seat.faces[0].span == pytest.approx(2.0 * np.pi)
