# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes on which the geometry kernel gives up, substrates of touching solids, layers higher than a
tube's radius of curvature."""

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am.brep.kernel import limits as kernel
from freecad_am.brep.walls import wall_on as module
from freecad_am.brep.walls.wall_on import wall_on
from freecad_am.core.geometry.walls.patch_wall import PatchWall
from freecad_am.core.geometry.walls.surface_wall import SurfaceWall
from freecad_am.core.issues import InputError


def slab(low=-50.0, width=100.0):
    return Part.makeBox(width, 100, 20, Vector(low, -50, -20))


def tube(radius=12.0, height=40.0):
    return Part.makeCylinder(radius, height + 5.0, Vector(0, 0, -5)).Faces[0]


def figure_eight():
    curve = Part.BSplineCurve()
    angle = 2.0 * np.pi * np.arange(40) / 40
    curve.interpolate(
        [Vector(20 * np.sin(a), 12 * np.sin(2 * a), -5) for a in angle], PeriodicFlag=True
    )
    return curve.toShape().extrude(Vector(0, 0, 40))


def crossing_pipe():
    points = [
        Vector(*p)
        for p in ((0, 0, -5), (0, 0, 40), (40, 0, 60), (40, 0, 20), (-20, 2, 20), (-60, 0, 40))
    ]
    spine = Part.BSplineCurve()
    spine.interpolate(points)
    profile = Part.Wire(Part.makeCircle(8, points[0], spine.tangent(0)[0]))
    return Part.Wire(spine.toShape()).makePipeShell([profile], False, True)


@pytest.mark.parametrize(("make", "is_tube"), [(figure_eight, False), (crossing_pipe, True)])
def test_walls_that_cross_themselves_are_refused(make, is_tube):
    """The message about bends of a tube does not appear for walls that are no tubes."""
    with pytest.raises(InputError) as caught:
        wall_on(make(), (), slab(), 4.0, "Wall")
    assert caught.value.code == "SELF_INTERSECTION" and caught.value.where.startswith("Wall")
    assert "(" in caught.value.message
    assert ("tube" in caught.value.message) == is_tube


def test_an_edge_that_crosses_itself_is_told_with_its_place_and_others_are_not():
    edge = figure_eight().Edges
    nothing = np.empty(0, dtype=np.intp)
    with pytest.raises(InputError) as caught:
        kernel.refuse_bare([("Face1", figure_eight().Faces[0])], nothing, "Wall")
    assert "(0, 0, " in caught.value.message and len(edge) == 3
    with pytest.raises(InputError) as caught:
        kernel.refuse_bare([("Face3", tube())], nothing, "Wall")
    assert (caught.value.code, caught.value.where) == ("BAD_SHAPE", "Wall Face3")
    kernel.refuse_bare([("Face3", tube())], np.zeros(1, dtype=np.intp), "Wall")


def fails(*_):
    Part.makeCircle(-1.0)


def test_faults_of_the_kernel_name_the_part(monkeypatch):
    monkeypatch.setattr(module, "find_wall", fails)  # then the wall counts as a sheet
    assert isinstance(wall_on(tube(), (), slab(), 4.0, "Wall", "Slab"), PatchWall)
    monkeypatch.setattr(module, "find_patch_wall", fails)
    with pytest.raises(InputError) as caught:
        wall_on(tube(), (), slab(), 4.0, "Wall", "Slab")
    assert (caught.value.code, caught.value.where) == (
        "BAD_SHAPE",
        "Wall",
    ) and "repair" in caught.value.message
    monkeypatch.setattr(module, "substrate_of", fails)
    with pytest.raises(InputError) as caught:
        wall_on(tube(), (), slab(), 4.0, "Wall", "Slab")
    assert (caught.value.code, caught.value.where) == ("BAD_SHAPE", "Slab")


@pytest.mark.parametrize("overlap", [0.0, 7.0], ids=["touching", "overlapping"])
@pytest.mark.parametrize("split", [False, True], ids=["tube", "two faces"])
def test_solids_that_touch_are_grown_on_as_one(split, overlap):
    wall = tube()
    if split:
        wall = Part.Compound(
            Part.makeCylinder(12, 20, Vector(0, 0, -5)).Faces[:1]
            + Part.makeCylinder(12, 25, Vector(0, 0, 15)).Faces[:1]
        )
    halves = Part.Compound([slab(-50.0, 50.0), slab(-overlap, 50.0 + overlap)])
    wall_found = wall_on(wall, (), halves, 4.0)
    assert isinstance(wall_found, PatchWall if split else SurfaceWall)
    assert not split or len(wall_found.first) == 1
    points = wall_found.first[0].points if split else wall_found.first
    assert np.hypot(points[:, 0], points[:, 1]) == pytest.approx(12.0, abs=1e-9)
    assert points[:, 2] == pytest.approx(0.0, abs=1e-9)
    gaps = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    assert gaps.min() > 1e-3
    assert gaps.sum() == pytest.approx(24.0 * np.pi, rel=5e-3)  # all around, once


def test_one_of_two_solids_inside_out_is_refused():
    second_solid = slab(100.0)
    second_solid.reverse()
    assert (
        slab().Volume + second_solid.Volume
        <= 0.0
        < Part.Compound([slab(), slab(), second_solid]).Volume
    )
    with pytest.raises(InputError) as caught:
        wall_on(
            tube(), (), Part.Compound([slab(), slab(60.0, 30.0), second_solid]), 4.0, "Wall", "Slab"
        )
    assert (caught.value.code, caught.value.where) == (
        "INSIDE_OUT",
        "Slab",
    ) and "150" in caught.value.message


def bend(major, minor):
    torus = Part.Toroid()
    torus.MajorRadius, torus.MinorRadius = major, minor
    torus.Center, torus.Axis = Vector(-major, 0, -3), Vector(0, -1, 0)
    return torus.toShape(0.0, np.pi / 3.0, 0.0, 2.0 * np.pi)


def cone(top):
    return Part.makeCone(20, top, 30, Vector(0, 0, -10)).Faces[0]


def below_only():
    """The cone's narrow end is in the slab, where nothing is deposited."""
    return Part.makeCone(2, 26, 24, Vector(0, 0, -12)).Faces[0]


def flared():
    rings = [
        Part.Wire(Part.makeCircle(r, Vector(0, 0, z))) for r, z in ((20, -4), (9, 18), (20, 40))
    ]
    return Part.makeLoft(rings, False, False).Faces[0]


SLOPE = np.cos(np.arctan2(10.0, 30.0))


@pytest.mark.parametrize(
    ("make", "radius"),
    [
        (tube, 12.0),
        (lambda: bend(40.0, 10.0), 10.0),
        (lambda: bend(40.0, 25.0), 15.0),
        (lambda: cone(10.0), 10.0 / SLOPE),
        (below_only, 14.0 * np.sqrt(2.0)),
    ],
    ids=["cylinder", "torus", "torus inside", "cone", "cone from its wide part"],
)
def test_layers_higher_than_a_tube_is_round_are_refused(make, radius):
    """The limit is the principal radius from geometry books, for the cone that of its narrower end
    outside the substrate."""
    assert isinstance(wall_on(make(), (), slab(), 0.999 * radius), SurfaceWall)
    with pytest.raises(InputError) as caught:
        wall_on(make(), (), slab(), 1.03 * radius, "Wall")
    assert (caught.value.code, caught.value.where) == ("LAYER_HEIGHT", "Wall Face1")
    stated_radius = float(caught.value.message.split("curvature of the wall, ")[1].split(" mm")[0])
    assert (
        stated_radius == pytest.approx(radius, rel=0.02)
        and f"{1.03 * radius:g} mm" in caught.value.message
    )


def test_a_waist_of_a_loft_is_told_with_its_place():
    with pytest.raises(InputError) as caught:
        wall_on(flared(), (), slab(), 10.0, "Wall")
    assert caught.value.code == "LAYER_HEIGHT"
    height = float(caught.value.message.split("(")[1].split(")")[0].split(", ")[2])
    assert height == pytest.approx(18.0, abs=2.0)
    assert isinstance(wall_on(flared(), (), slab(), 4.0), SurfaceWall)


def rod_of_two():
    """Return a solid rod, a cylinder with a flared end, which is one wall."""
    outline = [Vector(0, 0, -5), Vector(12, 0, -5), Vector(12, 0, 20)]
    arc = Part.Arc(
        Vector(12, 0, 20),
        Vector(20 - 8 * np.cos(0.35), 0, 20 + 8 * np.sin(0.35)),
        Vector(20 - 8 * np.cos(0.7), 0, 20 + 8 * np.sin(0.7)),
    )
    top = Vector(20 - 8 * np.cos(0.7), 0, 20 + 8 * np.sin(0.7))
    back = Part.makePolygon([top, Vector(0, 0, top.z), outline[0]])
    edges = [*Part.makePolygon(outline).Edges, arc.toShape(), *back.Edges]
    return Part.makeSolid(Part.Face(Part.Wire(edges)).revolve(Vector(), Vector(0, 0, 1), 360))


def test_of_a_solid_the_faces_that_are_not_flat_are_the_wall_where_that_is_clear():
    rod = rod_of_two()
    curved = [
        f"Face{k}"
        for k, face in enumerate(rod.Faces, 1)
        if face.Surface.TypeId != "Part::GeomPlane"
    ]
    assert rod.isValid() and rod.Solids and len(curved) == 2
    assert [name for name, _ in module.named_faces(rod, (), "Rod")] == curved
    wall_found = wall_on(rod, (), slab(), 3.0)
    assert isinstance(wall_found, PatchWall) and sorted(wall_found.faces) == curved


def rounded_box():
    box = Part.makeBox(60, 40, 30, Vector(-30, -20, -5))
    return box.makeFillet(9, [edge for edge in box.Edges if abs(edge.tangentAt(0).z) > 0.99])


def rounded_on_top():
    box = Part.makeBox(60, 40, 30, Vector(-30, -20, -5))
    return box.makeFillet(
        5, [edge for edge in box.Edges if min(vertex.Z for vertex in edge.Vertexes) > 24.0]
    )


def hollow():
    return Part.makeCylinder(15, 30).cut(Part.makeCylinder(10, 30))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (rounded_box, ["do not form one wall", "Face"]),
        (hollow, ["do not form one wall", "Face"]),
        (rounded_on_top, ["are tangent to Face"]),
        (lambda: Part.makeBox(9, 9, 9), ["none"]),
    ],
)
def test_of_a_solid_where_it_is_not_clear_it_is_told_how_to_name_them(make, words):
    with pytest.raises(InputError) as caught:
        wall_on(make(), (), slab(), 3.0, "Part")
    assert (caught.value.code, caught.value.where) == ("NO_WALL", "Part")
    for word in [*words, "part.faces"]:
        assert word in caught.value.message
