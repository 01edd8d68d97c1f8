# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls of any faces: refusals with their position, and substrates of triangles from files and of
any size."""

import Mesh
import MeshPart
import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am.brep.files.read import read_mesh
from freecad_am.brep.walls import sheet
from freecad_am.brep.walls.sheet import mesh_solid, substrate_of
from freecad_am.brep.walls.wall_on import wall_on
from freecad_am.core.geometry.walls.patch_wall import PatchWall
from freecad_am.core.issues import InputError
from freecad_am.objects.results.store import pack, unpack

RADIUS = 32.0


def pipe(bore=0.0):
    outer = Part.makeCylinder(RADIUS, 160, Vector(0, -80, 0), Vector(0, 1, 0))
    return (
        outer.cut(Part.makeCylinder(bore, 160, Vector(0, -80, 0), Vector(0, 1, 0)))
        if bore
        else outer
    )


def slab():
    return Part.makeBox(100, 100, 10, Vector(-50, -50, -5))


def half_tube(radius=15.0, height=60.0):
    return Part.makeCylinder(radius, height, Vector(0, 0, 0), Vector(0, 0, 1), 180).Faces[0]


def tube(x=0.0, height=60.0):
    return Part.makeCylinder(15.0, height, Vector(x, 0, 0)).Faces[0]


def fan():
    faces = [Part.makePlane(20, 20, Vector(), Vector(0, 0, 1)) for _ in range(3)]
    for turn, face in enumerate(faces):
        face.rotate(Vector(), Vector(1, 0, 0), 120 * turn)
    return Part.Compound(faces)


def twisted_band(count):
    """Return a band with half a twist, of `count` ruled faces."""

    def point(angle, side):
        reach = 30.0 + side * np.cos(0.5 * angle)
        return Vector(reach * np.cos(angle), reach * np.sin(angle), side * np.sin(0.5 * angle))

    faces = []
    for k in range(count):
        angles = 2.0 * np.pi * np.linspace(k, k + 1, 9) / count
        curves = []
        for side in (-8.0, 8.0):
            slopes = [
                (point(a + 1e-5, side) - point(a - 1e-5, side)) * 5e4 for a in angles[[0, -1]]
            ]
            curve = Part.BSplineCurve()
            points = [point(a, side) for a in angles]
            curve.interpolate(
                points, Parameters=angles.tolist(), InitialTangent=slopes[0], FinalTangent=slopes[1]
            )
            curves.append(curve)
        # not Part.makeRuledSurface, which since FreeCAD 1.0 reverses an edge if that brings ends
        # together
        poles = [list(pair) for pair in zip(*(curve.getPoles() for curve in curves), strict=True)]
        knots, mults = curves[0].getKnots(), curves[0].getMultiplicities()
        surface = Part.BSplineSurface()
        surface.buildFromPolesMultsKnots(
            poles, mults, [2, 2], knots, [0.0, 1.0], False, False, curves[0].Degree, 1
        )
        faces.append(surface.toShape())
    return Part.Compound(faces)


def kinked():
    surface = Part.BSplineSurface()
    poles = [
        [Vector(x, y, z) for y in (-20, 20)]
        for x, z in ((0, 0), (0, 20), (0, 40), (10, 60), (20, 80))
    ]
    surface.buildFromPolesMultsKnots(
        poles, [2, 1, 1, 1, 2], [2, 2], [0, 1, 2, 3, 4], [0, 1], False, False, 1, 1
    )
    return surface.toShape()


@pytest.mark.parametrize(
    ("make", "substrate", "height", "edges", "code", "where", "words"),
    [
        (fan, slab, 2.0, (), "BRANCHING_FACES", "Wall", ["more than two faces", "0, 0)"]),
        (
            lambda: twisted_band(1),
            slab,
            3.0,
            (),
            "NOT_ORIENTABLE",
            "Wall",
            ["Face1 has no consistent side"],
        ),
        (
            lambda: twisted_band(2),
            slab,
            3.0,
            (),
            "NOT_ORIENTABLE",
            "Wall",
            ["Face1", "Face2", "twisted"],
        ),
        (
            lambda: Part.makePlane(1e4, 1e4, Vector(), Vector(1, 0, 0)),
            slab,
            1.0,
            (),
            "TOO_FINE",
            "strategy.layer_height",
            ["1 mm", "about 230,000,000 triangles", "above 13 mm"],
        ),
        (
            lambda: Part.makePlane(780, 780, Vector(), Vector(1, 0, 0)),
            slab,
            1.0,
            (),
            "TOO_FINE",
            "Wall",
            ["1 mm", "larger"],
        ),
        (
            tube,
            slab,
            1e-6,
            ("Edge1",),
            "TOO_FINE",
            "strategy.layer_height",
            ["0.000001 mm", "above 0.0"],
        ),
        (kinked, slab, 4.0, (), "ROUGH_WALL", "Wall Face1", ["26.6 deg", "40)"]),
        (
            lambda: Part.Compound([tube(), tube(100.0)]),
            lambda: None,
            4.0,
            ("Edge6",),
            "NO_START",
            "Wall Edge6",
            ["100 mm off"],
        ),
        (
            tube,
            lambda: None,
            4.0,
            ("Edge99",),
            "UNKNOWN_EDGE",
            "Wall",
            ["Edge99", "Edge1 to Edge3"],
        ),
        (
            lambda: tube().rotated(Vector(), Vector(1, 0, 0), 30.0),
            lambda: None,
            4.0,
            (),
            "NO_SUBSTRATE",
            "Wall",
            ["choose a substrate"],
        ),
    ],
    ids=[
        "fan",
        "twisted",
        "twisted in two",
        "huge",
        "large",
        "fine",
        "kinked",
        "edge elsewhere",
        "no such edge",
        "nothing",
    ],
)
def test_refusals(make, substrate, height, edges, code, where, words):
    faces = ("Face1",) if code == "NO_START" else ()
    with pytest.raises(InputError) as caught:
        wall_on(make(), faces, substrate(), height, "Wall", "Slab", edges)
    error = caught.value
    assert (error.code, error.where) == (code, where), error.line()
    for word in words:
        assert word in error.message


BOX = Mesh.createBox(20.0, 20.0, 20.0).Topology


def box(shift=(0.0, 0.0, 0.0)):
    points, corners = BOX
    return np.array([tuple(point) for point in points]) + shift, np.array(corners)


def test_unsound_meshes_are_refused_with_a_place():
    points, corners = box()
    flat = points[:, 2] == points[:, 2].max()
    cases = [
        (
            points,
            corners[~flat[corners].all(axis=1)],
            "OPEN_MESH",
            "4 edges, 28.28 mm across, at (0, 0, 10)",
        ),
        (points, corners[:0], "NO_SOLID", "no triangles"),
        (np.where(points > 0.0, np.nan, points), corners, "BAD_FILE", "invalid coordinates"),
    ]
    for vertices, triangles, code, words in cases:
        with pytest.raises(InputError) as caught:
            mesh_solid(vertices, triangles, "Scan")
        assert (caught.value.code, caught.value.where) == (
            code,
            "Scan",
        ) and words in caught.value.message, code


def test_meshes_that_can_be_mended_are():
    points, corners = box()
    beside, _ = box((20.0, 20.0, 0.0))  # meets the first box in one edge
    cases = [
        (
            np.vstack([points, beside]),
            np.vstack([corners, corners + len(points)]),
            16000.0,
            "MENDED",
            "(10, 10, 0)",
        ),
        (points, corners[1:], 8000.0, "MESH_REPAIRED", "1 missing triangles"),
        (points, corners[:, ::-1], 8000.0, "MESH_REPAIRED", "inside-out"),
        (
            points,
            np.vstack([corners[:1, ::-1], corners[1:]]),
            8000.0,
            "MESH_REPAIRED",
            "1 triangles were flipped",
        ),
    ]
    for vertices, triangles, volume, code, words in cases:
        solid, issues = mesh_solid(vertices, triangles, "Scan")
        assert solid.volume == pytest.approx(volume)
        assert [issue.code for issue in issues] == [code] and words in issues[0].message, issues
        inside = solid.searched(5.0).signed(np.array([[1.0, 2.0, 3.0], [1.0, 2.0, 11.0]]))[0]
        assert inside == pytest.approx([-7.0, 1.0])


def test_doubled_points_and_triangles_without_area_do_no_harm():
    points, corners = box()
    loose = points[corners].reshape(-1, 3)  # each triangle has points of its own, as in STL files
    triangles = np.arange(len(loose)).reshape(-1, 3)
    thin = np.array([[0, 0, 1], [2, 2, 2]])
    solid, issues = mesh_solid(loose, np.vstack([triangles, thin]), "Scan")
    assert not issues
    assert len(solid.vertices) == len(points) and len(solid.triangles) == len(corners)
    assert solid.volume == pytest.approx(8000.0)


def test_mesh_files_bring_the_same_solid(tmp_path):
    mesh = MeshPart.meshFromShape(Shape=pipe(), LinearDeflection=0.2, AngularDeflection=0.3)
    for suffix, kind in (("stl", "STL"), ("stl", "AST"), ("obj", "OBJ"), ("3mf", "3MF")):
        file = tmp_path / f"{kind}.{suffix}"
        mesh.write(Filename=str(file), Format=kind)
        if kind == "AST":
            assert file.read_bytes().startswith(b"solid")
        solid = substrate_of(read_mesh(file), "Scan").solid
        assert len(solid.triangles) == mesh.CountFacets, kind
        assert solid.volume == pytest.approx(mesh.Volume, rel=1e-5), kind


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("none.stl", None, "NO_FILE"),
        ("empty.stl", b"", "EMPTY_FILE"),
        ("odd.obj", b"nothing here\n", "BAD_FILE"),
    ],
)
def test_bad_mesh_files(tmp_path, name, content, code):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_mesh(tmp_path / name)
    assert (caught.value.code, caught.value.where) == (code, name)


@pytest.mark.parametrize("angle", [0.05, 0.1, 0.2])
def test_first_layers_on_meshes_are_as_good_as_the_facets(angle):
    """A chord of a round pipe deviates by its sagitta, and the curve by hardly more."""
    mesh = MeshPart.meshFromShape(Shape=pipe(), LinearDeflection=1.0, AngularDeflection=angle)
    points, corners = mesh.Topology
    points = np.array([tuple(point) for point in points])
    middles = points[np.array(corners)][:, [0, 1, 2]].mean(axis=1)
    round_ = np.abs(middles[:, 1]) < 79.0
    edges = 0.5 * (
        points[np.array(corners)[round_]] + points[np.roll(np.array(corners)[round_], 1, axis=1)]
    )
    sagitta = RADIUS - np.hypot(edges[..., 0], edges[..., 2]).min()
    wall = wall_on(half_tube(), (), mesh, 5.0)
    curve = wall.first[0].curve()
    x, y, z = curve.at(curve.refined(5))[0].T
    assert np.hypot(x, y) == pytest.approx(15.0, abs=2e-5)
    assert np.abs(np.hypot(x, z) - RADIUS).max() < 1.3 * sagitta + 1e-4
    assert "about the error of the mesh" in wall.issues[0].message


@pytest.mark.any_version
def test_a_large_mesh():
    ball = Mesh.createSphere(40.0, 330)
    assert ball.CountFacets > 200000
    wall = wall_on(half_tube(height=80.0), (), ball, 4.0)
    assert np.linalg.norm(wall.first[0].points, axis=1) == pytest.approx(40.0, abs=0.01)


def test_stored_and_read_back_equal():
    wall = wall_on(half_tube(), (), pipe(), 5.0)
    again = unpack(*pack(wall, "key"), "key", "Wall")
    assert isinstance(again, PatchWall)
    for name in ("vertices", "triangles", "patch", "uv", "behind"):
        assert (getattr(again, name) == getattr(wall, name)).all(), name
    assert again.issues == wall.issues and again.faces == wall.faces
    assert [rim.end for rim in again.rims] == [rim.end for rim in wall.rims]
    assert (again.first[0].points == wall.first[0].points).all()
    queries = wall.vertices[::7] + 0.01
    assert all(
        (reread == original).all()
        for reread, original in zip(again.project(queries), wall.project(queries))
    )


def test_a_branch_that_comes_out_on_both_sides_grows_on_both_and_one_from_the_bore_on_one():
    through = Part.makeCylinder(5, 120, Vector(0, 0, -60)).Faces[0]
    wall = wall_on(through, (), pipe(29.0), 3.0)
    assert sorted(np.sign(curve.points[:, 2].mean()) for curve in wall.first) == [-1.0, 1.0]
    assert all(
        np.hypot(curve.points[:, 0], curve.points[:, 2]) == pytest.approx(RADIUS, abs=1e-9)
        for curve in wall.first
    )
    branch = wall_on(Part.makeCylinder(5, 60).Faces[0], (), pipe(29.0), 3.0)
    assert not isinstance(branch, PatchWall)
    assert np.hypot(branch.first[:, 0], branch.first[:, 2]) == pytest.approx(RADIUS, abs=1e-9)


def test_a_mesh_that_comes_to_no_end_is_not_said_to_have_too_many_triangles(monkeypatch):
    monkeypatch.setattr(sheet, "refine_mesh", lambda *args, **options: None)
    with pytest.raises(InputError) as caught:
        wall_on(half_tube(), (), slab(), 4.0, "Wall", "Slab")
    assert caught.value.code == "TOO_FINE"
    assert (
        "does not converge, though about" in caught.value.message
        and "larger layer height" not in caught.value.message
    )
