# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls on substrates: the first layer is on both surfaces by their equations, at any location."""

import numpy as np
import Part
import pytest
from FreeCAD import Placement, Rotation, Vector

from freecad_am.brep.walls.wall_on import find_wall
from freecad_am.core.issues import InputError

BEND, TUBE, PIPE = 60.0, 15.0, 32.0
PLACES = [Placement(), Placement(Vector(10, -20, 30), Rotation(Vector(1, 2, 3), 50))]


def bend(axis=(0, -1, 0), low=0.0, high=90.0):
    torus = Part.Toroid()
    torus.MajorRadius, torus.MinorRadius = BEND, TUBE
    torus.Center, torus.Axis = Vector(-BEND, 0, 0), Vector(*axis)
    sign = 1.0 if axis[1] < 0 else -1.0
    ends = sorted((sign * np.radians(low), sign * np.radians(high)))
    return torus.toShape(*ends, 0.0, 2.0 * np.pi)


def pipe(bore=0.0):
    outer = Part.makeCylinder(PIPE, 200, Vector(0, -100, 0), Vector(0, 1, 0))
    return (
        outer.cut(Part.makeCylinder(bore, 200, Vector(0, -100, 0), Vector(0, 1, 0)))
        if bore
        else outer
    )


def place_shape(shape, placement_):
    shape = shape.copy()
    shape.Placement = placement_.multiply(shape.Placement)
    return shape


def back(points, placement_):
    return np.array([tuple(placement_.inverse().multVec(Vector(*point))) for point in points])


@pytest.mark.parametrize("place", PLACES, ids=["as modelled", "anywhere"])
@pytest.mark.parametrize("axis", [(0, -1, 0), (0, 1, 0)], ids=["axis down", "axis up"])
@pytest.mark.parametrize("cut", [False, True], ids=["reaching in", "cut off at the pipe"])
def test_bend_on_pipe(place, axis, cut):
    face = bend(axis)
    if cut:
        face = face.cut(pipe()).Faces[0]
    wall = find_wall(place_shape(face, place), (), place_shape(pipe(), place))
    x, y, z = back(wall.first, place).T
    assert np.hypot(x, z) == pytest.approx(PIPE, abs=1e-9)
    assert np.hypot(np.hypot(x + BEND, z) - BEND, y) == pytest.approx(TUBE, abs=1e-9)
    assert (z > 0.0).all()
    surface = wall.surface()
    top = back(surface.point(np.full(50, wall.end), np.linspace(0, 6, 50)), place)
    assert top[:, 0] == pytest.approx(-BEND, abs=1e-9)
    assert (surface.inverse(wall.first)[0] < wall.end).all()
    v = np.unwrap(surface.inverse(wall.first)[1])
    assert abs(v[-1] - v[0]) == pytest.approx(2.0 * np.pi, abs=0.1)
    u, w = np.full(9, 0.3), np.linspace(-3, 3, 9)
    first_parameter, second_parameter = surface.inverse(surface.point(u, w))
    assert first_parameter == pytest.approx(u, abs=1e-9) and second_parameter == pytest.approx(
        w, abs=1e-9
    )


def test_upper_loop_of_a_hollow_pipe():
    wall = find_wall(bend(), (), pipe(29.0))
    assert np.hypot(wall.first[:, 0], wall.first[:, 2]) == pytest.approx(PIPE, abs=1e-9)
    assert "SEVERAL_LOOPS" in {issue.code for issue in wall.issues}


def test_a_tube_that_goes_through_starts_on_one_side_and_says_so():
    wall = find_wall(Part.makeCylinder(5, 120, Vector(0, 0, -60)), ("Face1",), pipe())
    z = wall.first[:, 2]
    assert (z > 0.0).all() or (z < 0.0).all()
    assert "SEVERAL_LOOPS" in {issue.code for issue in wall.issues}


@pytest.mark.parametrize("cone", [False, True])
def test_leaning_branch_on_pipe_from_either_end_of_its_surface(cone):
    for start, direction in (
        (Vector(3, 5, 0), Vector(0.3, 0.2, 1)),
        (Vector(3, 5, 0) + Vector(0.3, 0.2, 1) * 70, None),
    ):
        direction = direction or Vector(-0.3, -0.2, -1)
        length = direction.Length * 70
        radii = (10.0, 14.0) if direction.z > 0 else (14.0, 10.0)
        shape = Part.makeCylinder(10.0, length, start, direction)
        if cone:
            shape = Part.makeCone(*radii, length, start, direction)
        wall = find_wall(shape, ("Face1",), pipe())
        assert np.hypot(wall.first[:, 0], wall.first[:, 2]) == pytest.approx(PIPE, abs=1e-9)
        axis = np.array([0.3, 0.2, 1.0]) / np.linalg.norm([0.3, 0.2, 1.0])
        local = wall.first - [3.0, 5.0, 0.0]
        along = local @ axis
        radius = 10.0 + (4.0 * along / length if cone else 0.0)
        assert np.linalg.norm(local - along[:, None] * axis, axis=1) == pytest.approx(
            radius, abs=1e-9
        )
        assert wall.end == pytest.approx(np.hypot(length, 4.0) if cone else length, abs=1e-9)
        top = wall.surface().point(np.full(7, wall.end), np.linspace(0, 6, 7))
        assert (top - [3.0, 5.0, 0.0]) @ axis == pytest.approx(length, abs=1e-9)


def test_two_halves_of_a_bend_are_one_wall():
    torus = bend().Surface
    halves = [torus.toShape(0.0, 0.5 * np.pi, low, low + np.pi) for low in (0.3, 0.3 + np.pi)]
    shell = Part.makeShell(halves)
    wall = find_wall(shell, ("Face1", "Face2"), pipe())
    assert wall.faces == ("Face1", "Face2")
    assert np.hypot(wall.first[:, 0], wall.first[:, 2]) == pytest.approx(PIPE, abs=1e-9)
    with pytest.raises(InputError) as caught:
        find_wall(shell, ("Face1",), pipe())
    assert caught.value.code == "NOT_CLOSED"


def test_a_spline_tube_as_a_table():
    """A tube of a B-spline through circles of changing radius, on the pipe."""
    profiles = [
        Part.Wire(Part.makeCircle(radius, Vector(shift, 0, height), Vector(0, 0, 1)))
        for radius, shift, height in ((10, 0, 0), (11, 1, 25), (10, 4, 45), (12, 9, 70))
    ]
    face = max(Part.makeLoft(profiles, False).Faces, key=lambda face: face.Area)
    wall = find_wall(face, (), pipe())
    assert np.hypot(wall.first[:, 0], wall.first[:, 2]) == pytest.approx(PIPE, abs=1e-6)
    off = [face.distToShape(Part.Vertex(Vector(*point)))[0] for point in wall.first[::20]]
    assert max(off) < 1e-4
    u, v = np.meshgrid(np.linspace(0, wall.end, 5), np.linspace(0.1, 0.8, 5) * wall.period)
    points = wall.surface().point(u.ravel(), v.ravel())
    assert max(face.distToShape(Part.Vertex(Vector(*point)))[0] for point in points) < 1e-4
    assert points[u.ravel() == wall.end][:, 2] == pytest.approx(70.0, abs=1e-6)


@pytest.mark.parametrize(
    ("shape", "faces", "substrate", "code"),
    [
        (lambda: bend(), (), lambda: Part.makeBox(10, 10, 10, Vector(200, 0, 0)), "NO_CONTACT"),
        (lambda: bend(low=40.0), (), lambda: pipe(), "NO_CONTACT"),
        (lambda: bend(), (), lambda: Part.makeSphere(300.0), "NO_CONTACT"),
        (lambda: bend(), (), lambda: pipe().Faces[0], "NO_SOLID"),
        (lambda: bend(), ("Face7",), lambda: pipe(), "UNKNOWN_FACE"),
        (lambda: Part.makeBox(1, 1, 1), (), lambda: pipe(), "NO_WALL"),
        (lambda: Part.makeCylinder(5, 60), ("Face1", "Face2"), lambda: pipe(), "NOT_ONE_SURFACE"),
        (
            lambda: Part.makeCylinder(5, 60).cut(Part.makeCylinder(2, 60)),
            (),
            lambda: pipe(),
            "NO_WALL",
        ),
        (
            lambda: Part.makeCylinder(5, 60, Vector(), Vector(0, 0, 1), 180),
            ("Face1",),
            lambda: pipe(),
            "NOT_CLOSED",
        ),
        (lambda: Part.Shape(), (), lambda: pipe(), "NO_WALL"),
        (
            lambda: Part.makeCylinder(5, 60).cut(
                Part.makeCylinder(2, 60, Vector(-30, 0, 45), Vector(1, 0, 0))
            ),
            ("Face1",),
            lambda: pipe(),
            "WALL_EDGE",
        ),
    ],
)
def test_refusals(shape, faces, substrate, code):
    with pytest.raises(InputError) as caught:
        find_wall(shape(), faces, substrate(), "Wall", "Pipe")
    assert caught.value.code == code
    assert caught.value.where.split()[0] in ("Wall", "Pipe")


def test_turned_inside_out():
    solid = pipe().copy()
    solid.reverse()
    assert solid.Volume < 0.0
    with pytest.raises(InputError) as caught:
        find_wall(bend(), (), solid)
    assert caught.value.code == "INSIDE_OUT"
