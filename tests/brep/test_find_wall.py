# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls found on generated shapes of every kind equal the curves that generated them."""

import math

import FreeCAD
import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am.brep.files.read import read_shape
from freecad_am.brep.revolution.wall import find_wall

ORIGIN, Z = Vector(), Vector(0, 0, 1)
BALL = Part.makeSphere(45, ORIGIN, Z, 0, 90, 360)


def revolve(edges, angle=360):
    return Part.Wire(edges).revolve(ORIGIN, Z, angle)


def polyline(*points):
    corners = [Vector(r, 0, h) for r, h in points]
    return [Part.makeLine(a, b) for a, b in zip(corners[:-1], corners[1:], strict=True)]


def freeform():
    curve = Part.BSplineCurve()
    curve.interpolate([Vector(40, 0, 0), Vector(46, 0, 12), Vector(33, 0, 21), Vector(30, 0, 34)])
    return curve


def half_ellipse(sign=1):
    ellipse = Part.Ellipse(ORIGIN, 60, 40)
    ellipse.Axis = Vector(0, -1, 0)
    return Part.ArcOfEllipse(ellipse, *sorted((0, sign * math.pi / 2))).toShape()


def thick_dome(outer=45, inner=43):
    return Part.makeSphere(outer, ORIGIN, Z, 0, 90, 360).cut(Part.makeSphere(inner))


def dome_on_cylinder(angle=360):
    # lids with a kink: a cylinder, and a cap that is not tangent to it
    arc = Part.Arc(Vector(40, 0, 20), Vector(25, 0, 35), Vector(0, 0, 42)).toShape()
    return revolve([*polyline((40, 0), (40, 20)), arc], angle)


def assert_on_wall(wall, shape, tolerance=1e-6):
    """Assert that points of the wall are on the shape, and build directions along its surface."""
    random = np.random.default_rng(7)
    s = random.uniform(0.0, wall.meridian.length, 60)
    azimuth = random.uniform(wall.start, wall.end, 60)
    radius, height, tangent = wall.meridian.at(s)
    points = wall.points(radius, height, azimuth)
    along = wall.directions(np.stack([tangent[:, 0], 0.0 * s, tangent[:, 1]], axis=1), azimuth)
    for point, direction in zip(points, along, strict=True):
        assert shape.distToShape(Part.Vertex(*point))[0] < tolerance
        ahead = Part.Vertex(*(point + 1e-3 * direction))
        if wall.meridian.length - s.max() > 1e-2 and len(wall.meridian.kinks) == 0:
            assert shape.distToShape(ahead)[0] < 1e-5


def same_meridian(meridian, expected, tolerance=1e-6):
    assert expected.meridian.length == pytest.approx(meridian.meridian.length, abs=tolerance)
    s = np.linspace(0.0, meridian.meridian.length, 301)
    for have, want in zip(expected.meridian.at(s)[:2], meridian.meridian.at(s)[:2], strict=True):
        assert have == pytest.approx(want, abs=tolerance)


SHAPES = {
    "hemisphere": BALL,
    "dome on a cylinder": dome_on_cylinder(),
    "cone": Part.makeCone(20, 10, 30),
    "pointed cone": Part.makeCone(20, 0, 30),
    "cylinder": Part.makeCylinder(10, 30),
    "torus": Part.makeTorus(50, 10),
    "whole sphere": Part.makeSphere(20),
    "freeform": revolve([freeform().toShape()]),
    "thick dome": thick_dome(),
    "polyline": revolve(polyline((10, 0), (10, 5), (5, 9), (7, 20))),
    "partial": dome_on_cylinder(200),
    "partial solid": Part.makeCylinder(10, 30, ORIGIN, Z, 120),
    "stepped": revolve(polyline((30, 0), (30, 10), (20, 10), (20, 25))),
    "elliptic dome": revolve([half_ellipse()]),
    "elliptic bowl": revolve([half_ellipse(-1)]),
    "elliptic tank": Part.Face(
        Part.Wire([half_ellipse(), *polyline((0, 40), (0, -15), (60, -15), (60, 0))])
    ).revolve(ORIGIN, Z, 360),
    "partial sphere": Part.makeSphere(45, ORIGIN, Z, 0, 90, 100),
    "extruded circle": Part.makeCircle(12).extrude(Vector(0, 0, 25)),
}
LENGTHS = {
    "hemisphere": 22.5 * math.pi,
    "cone": math.hypot(10, 30),
    "pointed cone": math.hypot(20, 30),
    "cylinder": 30.0,
    "torus": 10.0 * math.pi,
    "whole sphere": 20.0 * math.pi,
    "thick dome": 22.5 * math.pi,
    "polyline": 5.0 + math.hypot(5, 4) + math.hypot(2, 11),
    "partial solid": 30.0,
    "stepped": 35.0,
    "partial sphere": 22.5 * math.pi,
    "extruded circle": 25.0,
}
TURNS = {"partial": 200.0, "partial solid": 120.0, "partial sphere": 100.0}


@pytest.mark.parametrize("name", SHAPES)
def test_walls_of_all_kinds_lie_on_their_shapes(name):
    wall = find_wall(SHAPES[name])
    assert_on_wall(wall, SHAPES[name])
    if name in LENGTHS:
        assert wall.meridian.length == pytest.approx(LENGTHS[name], abs=1e-7)
    assert wall.full == (name not in TURNS)
    assert math.degrees(wall.end - wall.start) == pytest.approx(TURNS.get(name, 360.0), abs=1e-6)
    assert wall.meridian.points[0, 1] == 0.0


@pytest.mark.parametrize("name", SHAPES)
def test_a_step_file_gives_the_same_wall(name, tmp_path):
    SHAPES[name].exportStep(str(tmp_path / "part.step"))
    wall, direct = find_wall(read_shape(tmp_path / "part.step")), find_wall(SHAPES[name])
    same_meridian(direct, wall)
    assert wall.frame == pytest.approx(direct.frame, abs=1e-7)
    assert (wall.start, wall.end, wall.full) == pytest.approx(
        (direct.start, direct.end, direct.full), abs=1e-7
    )


@pytest.mark.parametrize("name", SHAPES)
def test_faces_turned_into_b_splines_give_the_same_wall(name):
    spline = SHAPES[name].toNurbs()
    wall, direct = find_wall(spline), find_wall(SHAPES[name])
    same_meridian(direct, wall)
    assert wall.frame == pytest.approx(direct.frame, abs=1e-6)
    assert wall.end - wall.start == pytest.approx(direct.end - direct.start, abs=1e-6)
    assert_on_wall(wall, SHAPES[name])


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.always
def test_placements_move_the_frame_and_nothing_else(name, seed):
    random = np.random.default_rng([seed, len(name)])
    axis = random.normal(size=3)
    placement = FreeCAD.Placement(
        Vector(*random.uniform(-200, 200, 3)),
        FreeCAD.Rotation(Vector(*axis), random.uniform(0, 80)),
    )
    upright = placement.Rotation.multVec(Z)
    if upright.z < 0.05:
        pytest.skip("the axis is nearly level, and the ends of the wall may change places")
    moved = SHAPES[name].copy()
    moved.Placement = placement.multiply(moved.Placement)
    wall, direct = find_wall(moved), find_wall(SHAPES[name])
    same_meridian(direct, wall)
    assert wall.frame[:3, 2] == pytest.approx(np.array(upright), abs=1e-9)
    origin = placement.multVec(Vector(*direct.frame[:3, 3]))
    assert wall.frame[:3, 3] == pytest.approx(np.array(origin), abs=1e-6)
    x = np.array([1.0, 0.0, 0.0]) - upright.x * np.array(upright)
    assert wall.frame[:3, 0] == pytest.approx(x / np.linalg.norm(x), abs=1e-9)
    assert np.linalg.det(wall.frame[:3, :3]) == pytest.approx(1.0)
    assert_on_wall(wall, moved)


@pytest.mark.parametrize(
    ("axis", "z", "x"),
    [
        (Vector(0, 0, -1), (0, 0, 1), (1, 0, 0)),
        (Vector(1, 0, 0), (1, 0, 0), (0, 1, 0)),
        (Vector(-1, 0, 0), (1, 0, 0), (0, 1, 0)),
        (Vector(0, -1, 0), (0, 1, 0), (1, 0, 0)),
        (Vector(-0.6, 0, -0.8), (0.6, 0, 0.8), (0.8, 0, -0.6)),
    ],
)
def test_the_frame_points_up_and_its_x_is_the_parts(axis, z, x):
    wall = find_wall(Part.makeCone(20, 10, 30, Vector(1, 2, 3), axis))
    assert wall.frame[:3, 2] == pytest.approx(z, abs=1e-12)
    assert wall.frame[:3, 0] == pytest.approx(x, abs=1e-12)
    # the origin is where the axis meets the plane of the lowest end, at either end of the cone
    flipped = np.dot(z, np.array(axis)) < 0
    lowest = np.array([1.0, 2.0, 3.0]) + (30.0 * np.array(axis) if flipped else 0.0)
    assert wall.frame[:3, 3] == pytest.approx(lowest, abs=1e-9)
    assert wall.meridian.points[0] == pytest.approx([10.0 if flipped else 20.0, 0.0], abs=1e-9)


@pytest.mark.parametrize(("wall", "radius"), [("outer", 45.0), ("inner", 43.0), ("middle", 44.0)])
@pytest.mark.parametrize("convert", [lambda shape: shape, lambda shape: shape.toNurbs()])
def test_hollow_solids_have_three_walls(wall, radius, convert):
    meridian = find_wall(convert(thick_dome()), wall=wall).meridian
    r, h, t = meridian.at(np.linspace(0.0, meridian.length, 1001))
    assert meridian.length == pytest.approx(0.5 * math.pi * radius, abs=1e-6)
    assert np.abs(np.hypot(r, h) - radius).max() < 1e-6
    assert np.abs(t[:, 0] * r + t[:, 1] * h).max() < 1e-6 * radius


@pytest.mark.parametrize(("wall", "radius"), [("outer", 10.0), ("inner", 8.0), ("middle", 9.0)])
def test_tubes_have_three_walls(wall, radius):
    tube = Part.makeCylinder(10, 30).cut(Part.makeCylinder(8, 30))
    meridian = find_wall(tube, wall=wall).meridian
    assert meridian.at([0.0, 15.0, 30.0])[0] == pytest.approx([radius] * 3, abs=1e-9)
    assert meridian.at([0.0, 15.0, 30.0])[1] == pytest.approx([0.0, 15.0, 30.0], abs=1e-9)


@pytest.mark.parametrize(("wall", "side"), [("outer", 1), ("inner", -1), ("middle", 0)])
def test_a_torus_has_an_outer_an_inner_and_a_middle_wall(wall, side):
    meridian = find_wall(Part.makeTorus(50, 10), wall=wall).meridian
    r, h, _ = meridian.at(np.linspace(0.0, meridian.length, 101))
    assert h[[0, -1]] == pytest.approx([0.0, 20.0], abs=1e-6)
    assert r == pytest.approx(
        50.0 + side * np.sqrt(np.maximum(100.0 - (h - 10.0) ** 2, 0.0)), abs=1e-4
    )


def test_kinks_of_a_shell_are_kept():
    wall = find_wall(dome_on_cylinder())
    assert wall.meridian.kinks == pytest.approx([20.0])
    assert wall.meridian.closed_top
    assert wall.faces == ("Face1", "Face2")


@pytest.mark.parametrize("sew", [True, False])
def test_halves_of_one_revolution_are_put_together(sew):
    wire = Part.Wire(polyline((10, 0), (10, 5), (5, 9)))
    halves = [wire.revolve(ORIGIN, Z, 180), wire.revolve(ORIGIN, Vector(0, 0, -1), 180)]
    shape = Part.makeShell(halves[0].Faces + halves[1].Faces) if sew else Part.makeCompound(halves)
    wall = find_wall(shape)
    assert wall.full
    assert wall.meridian.length == pytest.approx(5.0 + math.hypot(5, 4))
    half = find_wall(halves[0])
    assert not half.full
    assert half.end - half.start == pytest.approx(math.pi)


def test_parts_of_a_turn_that_join_are_one_part_of_a_turn():
    wire = Part.Wire(polyline((10, 0), (10, 5)))
    turn = FreeCAD.Placement(ORIGIN, FreeCAD.Rotation(Z, 60))
    second = wire.revolve(ORIGIN, Z, 50)
    second.Placement = turn
    wall = find_wall(Part.makeCompound([wire.revolve(ORIGIN, Z, 60), second]))
    assert math.degrees(wall.end - wall.start) == pytest.approx(110.0, abs=1e-6)
    assert math.degrees(wall.start) == pytest.approx(0.0, abs=1e-6)


def test_faces_chosen_are_the_wall_in_any_order():
    shape = revolve(polyline((10, 0), (10, 5), (5, 9), (7, 20)))
    wall = find_wall(shape, ("Face3", "Face2"))
    assert wall.meridian.length == pytest.approx(math.hypot(5, 4) + math.hypot(2, 11))
    assert wall.faces == ("Face2", "Face3")
    assert wall.frame[:3, 3] == pytest.approx([0, 0, 5])


def test_a_flat_face_is_wall_when_chosen():
    cylinder = Part.makeCylinder(10, 30)
    top = next(f"Face{i}" for i, face in enumerate(cylinder.Faces, 1) if face.CenterOfMass.z > 29.9)
    side = next(f"Face{i}" for i, face in enumerate(cylinder.Faces, 1) if face.Area > 1000)
    wall = find_wall(cylinder, (side, top))
    assert wall.meridian.length == pytest.approx(40.0)
    assert wall.meridian.closed_top
    assert wall.meridian.kinks == pytest.approx([30.0])


def test_flanges_with_holes_do_not_matter_where_the_wall_is_chosen():
    drilled = (
        Part.makeCylinder(30, 5)
        .fuse(Part.makeCylinder(10, 40))
        .cut(Part.makeCylinder(3, 5, Vector(20, 0, 0)))
    )
    side = next(
        f"Face{i}"
        for i, face in enumerate(drilled.Faces, 1)
        if face.Surface.TypeId.endswith("Cylinder") and abs(face.Surface.Radius - 10) < 1e-9
    )
    assert find_wall(drilled, (side,)).meridian.length == pytest.approx(35.0)


@pytest.mark.parametrize("closed", [False, True])
def test_a_wire_with_an_axis(closed):
    edges = (
        polyline((10, 0), (10, 20), (8, 20), (8, 0), (10, 0)) if closed else [freeform().toShape()]
    )
    wall = find_wall(Part.Wire(edges), axis=(ORIGIN, Z))
    assert wall.full
    truth = find_wall(revolve(edges))
    same_meridian(truth, wall)


def test_the_one_solid_of_revolution_is_found_among_others():
    compound = Part.makeCompound(
        [Part.makeBox(5, 5, 5, Vector(50, 0, 0)), Part.makeCylinder(10, 30)]
    )
    wall = find_wall(compound)
    assert wall.meridian.length == pytest.approx(30.0)
    assert wall.faces == ("Face7",)


def test_a_sphere_cut_across_its_own_poles_is_found():
    half = Part.makeSphere(45).common(Part.makeBox(100, 100, 100, Vector(0, -50, -50)))
    for shape in (half, half.toNurbs()):
        wall = find_wall(shape)
        assert wall.frame[:3, 2] == pytest.approx([1, 0, 0], abs=1e-6)
        assert wall.meridian.length == pytest.approx(22.5 * math.pi, abs=1e-6)
        assert_on_wall(wall, half)


def test_an_offset_shell_runs_beside_the_original():
    shell = revolve([freeform().toShape()])
    offset = shell.makeOffsetShape(2, 1e-5)
    wall, original = find_wall(offset), find_wall(shell)
    assert_on_wall(wall, offset)
    s = np.linspace(0.0, original.meridian.length, 101)
    r, h, _ = original.meridian.at(s)
    height = h + original.frame[2, 3] - wall.frame[2, 3]
    samples = wall.meridian.at(np.linspace(0.0, wall.meridian.length, 20001))
    distances = np.hypot(r[:, None] - samples[0][None], height[:, None] - samples[1][None]).min(
        axis=1
    )
    assert distances == pytest.approx(np.full(101, 2.0), abs=1e-5)


def test_a_gap_is_bridged_and_said():
    shape = Part.makeCompound(
        [revolve(polyline((10, 0), (10, 5))), revolve(polyline((9.94, 5), (9.94, 8)))]
    )
    wall = find_wall(shape)
    assert wall.meridian.length == pytest.approx(8.06)
    assert [issue.code for issue in wall.issues] == ["GAP"]


def test_slivers_are_passed_over():
    shape = revolve(polyline((10, 0), (10, 5), (10.0002, 5.0002), (10.0002, 8)))
    wall = find_wall(shape)
    assert wall.meridian.length == pytest.approx(8.0, abs=1e-3)
    assert wall.faces == ("Face1", "Face3")
