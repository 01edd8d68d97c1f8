# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances of deposit from its part equal closed forms, and shifted toolpaths are rejected."""

import dataclasses

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am import api
from freecad_am.brep.shapes import off_part
from freecad_am.brep.shapes.off_part import off_edges, off_faces, off_mesh, off_solids
from freecad_am.objects import toolpath as stage
from freecad_am.objects.planned import in_sequence

pytestmark = pytest.mark.any_version


@pytest.fixture
def rng():
    return np.random.default_rng(2)


def ring(rng, radius, low, high, count=400):
    angle, height = rng.uniform(0.0, 2.0 * np.pi, count), rng.uniform(low, high, count)
    radius = np.broadcast_to(radius, count)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)


def test_distances_from_chosen_faces(rng):
    shape = Part.makeCylinder(30.0, 50.0)
    round_ = [
        f"Face{k}"
        for k, face in enumerate(shape.Faces, start=1)
        if face.Surface.TypeId == "Part::GeomCylinder"
    ]
    radius = 30.0 + rng.uniform(-3.0, 3.0, 150)
    points = ring(rng, radius, 5.0, 45.0, 150)
    assert off_faces(shape, round_, points, 0.03) == pytest.approx(np.abs(radius - 30.0), abs=0.101)
    assert off_faces(shape, round_, ring(rng, 30.0, 5.0, 45.0), 0.03).max() < 0.001
    past = off_faces(shape, round_, ring(rng, 30.0, 55.0, 60.0, 50), 0.03)
    assert past.min() >= 5.0 - 1e-6 and past.max() <= 10.0 + 1e-6
    assert np.isnan(off_faces(Part.makeLine(Vector(), Vector(0, 0, 1)), (), points, 0.03)).all()


def test_a_shape_of_which_the_kernel_makes_no_triangles(rng, monkeypatch):
    """Some points get the shape's own distances and the others none; this once was an internal
    error."""
    monkeypatch.setattr(
        off_part, "triangles_of", lambda *_: (np.zeros((0,)), np.zeros((0,), dtype=int))
    )
    radius = 30.0 + rng.uniform(-3.0, 3.0, 150)
    points = ring(rng, radius, 5.0, 45.0, 150)
    shape = Part.makeCylinder(30.0, 50.0)
    for distances, true in (
        (off_faces(shape, ["Face1"], points, 0.03), np.abs(radius - 30.0)),
        (off_solids(shape, points, 0.03), np.maximum(radius - 30.0, 0.0)),
    ):
        is_known = np.isfinite(distances)
        assert 0 < is_known.sum() < 150 and distances[is_known] == pytest.approx(
            true[is_known], abs=1e-6
        )


def test_distances_outside_of_solids(rng):
    """Two boxes touch: no point between them is outside, and beyond them the nearer one counts."""
    solids = Part.makeCompound(
        [Part.makeBox(10, 10, 10), Part.makeBox(10, 10, 10, Vector(10, 0, 0))]
    )
    inside = rng.uniform([0.5, 0.5, 0.5], [19.5, 9.5, 9.5], (300, 3))
    assert off_solids(solids, inside, 0.5).max() == 0.0
    above = rng.uniform([0.5, 0.5, 11.0], [19.5, 9.5, 14.0], (100, 3))
    assert off_solids(solids, above, 0.5) == pytest.approx(above[:, 2] - 10.0, abs=1e-6)
    box = Part.makeBox(10, 10, 10)
    points, triangles = box.tessellate(1.0)
    vertices = np.array([tuple(point) for point in points])
    assert off_mesh(
        vertices, np.array(triangles), np.array([[5.0, 5, 5], [5, 5, 13]])
    ) == pytest.approx([0.0, 3.0])


def test_solids_that_differ_by_their_place_are_divided_once(rng, monkeypatch):
    """Bars around an axis: distances are those in the frame of each, also if each is a separate
    shape."""
    bar, calls = Part.makeBox(20, 6, 10, Vector(30, -3, 0)), []
    shared = [Part.Shape(bar) for _ in range(6)]
    for number, solid in enumerate(shared):
        solid.rotate(Vector(), Vector(0, 0, 1), 60.0 * number)
        solid.translate(Vector(0, 0, number))
    points = ring(rng, rng.uniform(20.0, 60.0, 150), -10.0, 20.0, 150)
    off = []
    for number in range(6):
        c, s = np.cos(np.radians(60.0 * number)), np.sin(np.radians(60.0 * number))
        local = points @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) - [40.0, 0, 5.0 + number]
        off.append(np.linalg.norm(np.maximum(np.abs(local) - [10.0, 3.0, 5.0], 0.0), axis=1))
    divide = off_part.triangles_of
    monkeypatch.setattr(
        off_part, "triangles_of", lambda *arguments: calls.append(arguments) or divide(*arguments)
    )
    for solids, count in ((shared, 1), ([solid.copy() for solid in shared], 6)):
        calls.clear()
        distances = off_solids(Part.makeCompound(solids), points, 0.5)
        assert len(calls) == count
        assert distances == pytest.approx(np.min(off, axis=0), abs=1e-6 + off_part.DEFLECTION)
        assert distances.max() == pytest.approx(np.min(off, axis=0).max(), abs=1e-6)


def test_distances_outside_of_a_mesh_that_cuts_itself(rng):
    """A rod sticks in a block: near its triangles inside the block the nearest triangle shows its
    outside, up to 8 mm away."""
    vertices, triangles = [], []
    for solid in (Part.makeBox(40, 40, 40), Part.makeBox(40, 4, 4, Vector(20, 18, 18))):
        points, corners = solid.tessellate(1.0)
        triangles += (np.array(corners) + len(vertices)).tolist()
        vertices += [tuple(point) for point in points]
    points = np.vstack(
        [
            rng.uniform(0.5, 39.5, (300, 3)),
            rng.uniform([40.5, 18.5, 18.5], [59.5, 21.5, 21.5], (50, 3)),
        ]
    )
    assert off_mesh(np.array(vertices), np.array(triangles), points).max() == 0.0
    aside = rng.uniform([45.0, 23.0, 18.0], [60.0, 26.0, 22.0], (50, 3))
    assert off_mesh(np.array(vertices), np.array(triangles), aside) == pytest.approx(
        aside[:, 1] - 22.0, abs=1e-9
    )


def shift_toolpath(toolpath, offset):
    layers = tuple(
        dataclasses.replace(
            layer,
            beads=tuple(
                dataclasses.replace(bead, points=bead.points + offset) for bead in layer.beads
            ),
        )
        for layer in toolpath.layers
    )
    return dataclasses.replace(toolpath, layers=layers)


def revolved(doc):
    sphere = doc.addObject("Part::Sphere", "Sphere")
    sphere.Radius, sphere.Angle1, sphere.Angle2 = 45, 0, 90
    doc.recompute()
    return api.make_feature(doc, sphere, layer_height=9, chord_error=0.1)


def hub_toolpath(doc):
    rod, box = doc.addObject("Part::Feature", "Rod"), doc.addObject("Part::Feature", "Block")
    rod.Shape = Part.makeCylinder(20.0, 100.0)
    box.Shape = Part.makeBox(24.0, 24.0, 40.0, Vector(15.0, -12.0, 30.0)).cut(rod.Shape)
    return api.make_developable_feature(
        doc, box, rod, layer_height=4.0, bead_spacing=6.0, chord_error=0.1
    )


def wall(doc):
    tube, plate = doc.addObject("Part::Feature", "Tube"), doc.addObject("Part::Feature", "Plate")
    tube.Shape = Part.makeCylinder(20.0, 30.0).Faces[0]
    plate.Shape = Part.makeBox(80.0, 80.0, 10.0, Vector(-40.0, -40.0, -5.0))
    return api.make_surface_feature(doc, tube, ("Face1",), plate, layer_height=5.0, chord_error=0.1)


def in_planes(doc):
    box = doc.addObject("Part::Feature", "Block")
    box.Shape = Part.makeBox(40.0, 30.0, 12.0)
    return api.make_solid_feature(doc, box, layer_height=4.0, bead_spacing=6.0, chord_error=0.1)


def clad(doc):
    cone = doc.addObject("Part::Feature", "Cone")
    cone.Shape = Part.makeCone(30, 18, 40)
    return api.make_cladding_feature(
        doc, cone, ["Face1"], layers=2, layer_height=2.0, bead_spacing=6.0, chord_error=0.1
    )


@pytest.mark.parametrize(
    "make, way",
    [
        (revolved, [1.0, 0, 0]),
        (hub_toolpath, [0, 0, 9.0]),
        (wall, [0, 1.0, 0]),
        (in_planes, [9.0, 0, 0]),
        (clad, [0, 1.0, 0]),
        (revolved, [0.3, 0, 0]),
        (wall, [0, 0.3, 0]),
    ],
)
def test_deposit_beside_the_part_is_refused(doc, monkeypatch, make, way):
    feature = make(doc)
    sound = api.result(api.make_toolpath(doc, feature))
    count, worst, allowed = sound.checks.on_part
    assert (
        count == sound.point_count
        and worst <= allowed
        and not [issue for issue in sound.issues if issue.level == "error"]
    )
    plan = stage.planned
    monkeypatch.setattr(
        stage, "planned", lambda *arguments: shift_toolpath(plan(*arguments), np.array(way))
    )
    toolpath = api.make_toolpath(doc, feature)
    (issue,) = [candidate for candidate in api.issues(toolpath) if candidate.code == "OFF_PART"]
    assert issue.level == "error" and None not in (issue.layer, issue.bead, issue.point)
    assert api.result(toolpath).checks.on_part[1] == pytest.approx(np.abs(way).sum(), rel=0.35)


def test_of_several_features_the_one_beside_its_part_is_refused(doc, monkeypatch):
    features = []
    for name, low in (("Low", 0.0), ("High", 12.0)):
        box = doc.addObject("Part::Feature", name)
        box.Shape = Part.makeBox(40.0, 30.0, 12.0, Vector(0, 0, low))
        features.append(
            api.make_solid_feature(doc, box, layer_height=4.0, bead_spacing=6.0, chord_error=0.1)
        )
    sound = api.result(api.make_toolpath(doc, features))
    count, worst, allowed = sound.checks.on_part
    assert count == sound.point_count and worst <= allowed
    lay, numbers = in_sequence.layers_of, iter((0, 1))
    offset = np.array([0, 9.0, 0])
    monkeypatch.setattr(
        in_sequence,
        "layers_of",
        lambda arguments: shift_toolpath(lay(arguments), next(numbers) * offset),
    )
    toolpath = api.make_toolpath(doc, features)
    (issue,) = [candidate for candidate in api.issues(toolpath) if candidate.code == "OFF_PART"]
    assert issue.level == "error" and issue.layer >= 3 and None not in (issue.bead, issue.point)
    assert api.result(toolpath).checks.on_part[1] == pytest.approx(9.0, rel=0.35)


def test_triangles_of_a_large_part_are_larger_and_no_place_is_told_farther_than_it_is():
    """A ball of three metres once took half a minute at 0.05 mm, because the kernel's time grows
    faster than the number of triangles."""
    ball, directions = Part.makeSphere(1500.0), np.random.default_rng(5).normal(size=(400, 3))
    true_distances = np.linspace(-2.0, 4.0, 400)
    points = (
        (1500.0 + true_distances)[:, None]
        * directions
        / np.linalg.norm(directions, axis=1)[:, None]
    )
    distances = off_part.off_solids(ball, points, 1.0)
    assert (distances <= np.maximum(true_distances, 0.0) + 1e-6).all()
    assert distances[true_distances > 1.5] == pytest.approx(
        true_distances[true_distances > 1.5], abs=1e-6
    )  # computed by the kernel
    assert distances[true_distances > 0.0] == pytest.approx(
        true_distances[true_distances > 0.0], abs=1.1
    )


def test_points_off_edges(rng):
    """Distances from the ends of a cylinder, one of them given by name."""
    shape = Part.makeCylinder(20.0, 40.0)
    top = next(f"Edge{k}" for k, edge in enumerate(shape.Edges, 1) if edge.BoundBox.ZMin > 39.0)
    angle, radius, height = (
        rng.uniform(-3.0, 3.0, 60),
        rng.uniform(15.0, 25.0, 60),
        rng.uniform(30.0, 50.0, 60),
    )
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    assert off_edges(shape, (top,), points) == pytest.approx(
        np.hypot(radius - 20.0, height - 40.0), abs=1e-6
    )
    assert (off_edges(shape, (), points) <= off_edges(shape, (top,), points) + 1e-9).all()
    distances = off_edges(shape, (top,), np.tile(points, (50, 1)))
    assert np.isfinite(distances).sum() == 500 and np.isfinite(distances[[0, -1]]).all()


@pytest.mark.parametrize("inverted", [(), (0,), (1,), (0, 1)])
def test_distances_outside_of_boxes_that_cross_whichever_way_they_are_turned(rng, inverted):
    """Points inside either box are inside, according to the equations of both."""
    sizes, corners = (
        np.array([[40.0, 30, 20], [40.0, 30, 20]]),
        np.array([[0.0, 0, 0], [7.0, 11, 5]]),
    )
    vertices, triangles = [], []
    for k in range(2):
        points, faces = Part.makeBox(*sizes[k], Vector(*corners[k])).tessellate(1.0)
        faces = np.array(faces)[:, ::-1] if k in inverted else np.array(faces)
        triangles += (faces + len(vertices)).tolist()
        vertices += [tuple(point) for point in points]
    points_ = rng.uniform([-8.0, -8, -8], [55.0, 49, 33], (600, 3))
    off = [
        np.linalg.norm(np.maximum(np.abs(points_ - corner - 0.5 * size) - 0.5 * size, 0.0), axis=1)
        for size, corner in zip(sizes, corners)
    ]
    distances = off_mesh(np.array(vertices), np.array(triangles), points_)
    true = np.minimum(*off)
    assert distances[true > 0.0] == pytest.approx(true[true > 0.0], abs=1e-9)
    assert (
        distances[true == 0.0].max() <= off_part.DEFLECTION and (np.maximum(*off) == 0.0).sum() > 20
    )


def test_distances_in_a_hollow_of_a_mesh(rng):
    """The inner box faces inwards: points in it are outside, at least as far as from its sides."""
    vertices, triangles = [], []
    for size, corner, orientation in ((40.0, 0.0, 1), (20.0, 10.0, -1)):
        points, faces = Part.makeBox(size, size, size, Vector(corner, corner, corner)).tessellate(
            1.0
        )
        triangles += (np.array(faces)[:, ::orientation] + len(vertices)).tolist()
        vertices += [tuple(point) for point in points]
    points_ = rng.uniform(11.0, 29.0, (200, 3))
    distances = off_mesh(np.array(vertices), np.array(triangles), points_)
    assert (distances > (10.0 - np.abs(points_ - 20.0)).min(axis=1) - 1e-9).all()


def touching_boxes(inside_out=()):
    """Return 27 touching boxes of 40 mm; those numbered in `inside_out` have inward faces."""
    boxes = [
        Part.makeBox(40, 40, 40, Vector(40 * i, 40 * j, 40 * k))
        for i in range(3)
        for j in range(3)
        for k in range(3)
    ]
    return Part.makeCompound(
        [box.reversed() if n in inside_out else box for n, box in enumerate(boxes)]
    )


@pytest.mark.parametrize("inside_out", [(), (13,), (0, 13, 26)])
def test_touching_solids_that_are_inside_out(rng, inside_out):
    """An assembly is a cube of 120 mm, whichever of its solids are inside out."""
    points = rng.uniform(-30.0, 150.0, (300, 3))
    outside = np.linalg.norm(np.maximum(np.maximum(-points, points - 120.0), 0.0), axis=1)
    distances = off_solids(touching_boxes(inside_out), points, 7.6)
    over = outside > 7.7
    assert distances[over] == pytest.approx(outside[over], abs=0.11)
    assert (distances[outside == 0.0] == 0.0).all()


def test_a_kernel_that_is_wrong_about_the_inside(rng, monkeypatch):
    """The winding of the triangles around a point is a second opinion; points outside stay
    outside."""
    points = np.vstack([rng.uniform(45.0, 75.0, (8, 3)), [[60.0, 60.0, 140.0]]])
    monkeypatch.setattr(off_part, "_by_kernel", lambda *_: 20.0)
    assert off_solids(touching_boxes(), points, 7.6).tolist() == [0.0] * 8 + [20.0]
