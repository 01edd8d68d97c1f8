# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls of any connected faces: meshes, first curves and rims compared with the shapes' equations;
refusals of real faulty shapes."""

import MeshPart
import numpy as np
import Part
import pytest
from FreeCAD import Placement, Rotation, Vector

from freecad_am.brep.walls.patch_wall import refuse_crossing
from freecad_am.brep.walls.sheet import sheet
from freecad_am.brep.walls.wall_on import wall_on
from freecad_am.core.geometry.mesh.refine import boundary
from freecad_am.core.geometry.walls.patch_wall import PatchWall
from freecad_am.core.geometry.walls.surface_wall import SurfaceWall
from freecad_am.core.issues import InputError

BEND, TUBE, PIPE = 60.0, 15.0, 32.0
TURN = 2.0 * np.pi


def bend(low=0.0, high=90.0, start=0.0, width=360.0):
    torus = Part.Toroid()
    torus.MajorRadius, torus.MinorRadius = BEND, TUBE
    torus.Center, torus.Axis = Vector(-BEND, 0, 0), Vector(0, -1, 0)
    return torus.toShape(*np.radians([low, high, start, start + width]).tolist())


def pipe():
    return Part.makeCylinder(PIPE, 160, Vector(0, -80, 0), Vector(0, 1, 0))


def slab(top=5.0):
    return Part.makeBox(100, 100, 10, Vector(-50, -50, top - 10))


def tube(radius=15.0, height=60.0):
    return Part.makeCylinder(radius, height).Faces[0]


def shell(*faces):
    return Part.Compound(list(faces))


def distances_from_both(points):
    x, y, z = points.T
    assert np.hypot(x, z) == pytest.approx(PIPE, abs=1e-9)
    assert np.hypot(np.hypot(x + BEND, z) - BEND, y) == pytest.approx(TUBE, abs=1e-9)


def sound(wall, shape):
    """Assert that a wall mesh is watertight except at its rims, on the faces, consistently
    oriented, with short edges."""
    ends, rim_count = boundary(wall.triangles)
    assert not rim_count.any()
    rims = sum(len(rim.points) - 1 for rim in wall.rims)
    assert rims == len(ends)
    sample_ = wall.vertices[:: max(1, len(wall.vertices) // 25)]
    assert max(shape.distToShape(Part.Vertex(Vector(*point)))[0] for point in sample_) < 1e-5
    corner = wall.vertices[wall.triangles]
    facet = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    feet, normals = wall.project(corner.mean(axis=1))
    assert (np.einsum("ij,ij->i", facet, normals) > 0.0).all()
    sample_ = feet[:: max(1, len(feet) // 25)]
    assert max(shape.distToShape(Part.Vertex(Vector(*point)))[0] for point in sample_) < 1e-4


def test_two_halves_of_a_bend_anywhere_in_space():
    placement = Placement(Vector(10, -20, 30), Rotation(Vector(1, 2, 3), 50))
    halves = shell(bend(start=20.0, width=180.0), bend(start=200.0, width=180.0))
    moved, ground = halves.copy(), pipe()
    moved.Placement, ground.Placement = placement, placement.multiply(ground.Placement)
    wall = wall_on(shell(*moved.Faces), (), ground, 5.0)
    if isinstance(wall, SurfaceWall):  # both are of one torus: exact without a mesh
        points = wall.first
    else:
        points = wall.first[0].points
    distances_from_both(
        np.array([tuple(placement.inverse().multVec(Vector(*point))) for point in points])
    )


def test_half_shell_starts_in_a_chain_from_side_to_side():
    half = bend(start=20.0, width=180.0)
    wall = wall_on(half, (), pipe(), 4.0)
    sound(wall, half)
    (curve,) = wall.first
    assert not curve.closed
    distances_from_both(curve.points[1:-1])
    x, y, z = curve.points[[0, -1]].T
    angle = np.degrees(np.arctan2(y, np.hypot(x + BEND, z) - BEND))
    assert np.sort(angle) == pytest.approx([-20.0, 160.0], abs=1e-5)
    (end,) = (rim for rim in wall.rims if rim.end)
    assert end.points[:, 0] == pytest.approx(-BEND, abs=1e-6)
    assert wall.behind[np.hypot(wall.vertices[:, 0], wall.vertices[:, 2]) < PIPE - 1e-6].all()
    assert not wall.behind[np.hypot(wall.vertices[:, 0], wall.vertices[:, 2]) > PIPE + 1e-6].any()


def test_fronts_may_be_asked_for_on_a_tube_of_one_surface():
    assert isinstance(wall_on(bend(), (), pipe(), 5.0), SurfaceWall)
    wall = wall_on(bend(), (), pipe(), 5.0, fronts=True)
    assert isinstance(wall, PatchWall) and wall.faces == ("Face1",)
    sound(wall, bend())
    (curve,) = wall.first
    assert curve.closed and [rim.closed for rim in wall.rims] == [True] * len(wall.rims)
    distances_from_both(curve.points)
    assert np.abs(wall.symmetry_normal) == pytest.approx([0.0, 1.0, 0.0], abs=1e-12)
    half = wall_on(bend(start=20.0, width=180.0), (), pipe(), 5.0)
    assert half.symmetry_normal is None  # its bend may lean out of that plane


def test_three_tangent_faces():
    foot = Part.makeCylinder(TUBE, 20, Vector(0, 0, -20)).Faces[0]
    head = Part.makeCylinder(TUBE, 30, Vector(-BEND, 0, BEND), Vector(-1, 0, 0)).Faces[0]
    elbow = shell(foot, bend(), head)
    wall = wall_on(elbow, (), slab(-10.0), 5.0)
    sound(wall, elbow)
    (curve,) = wall.first
    assert curve.closed and curve.points[:, 2] == pytest.approx(-10.0, abs=1e-9)
    assert np.hypot(*curve.points[:, :2].T) == pytest.approx(TUBE, abs=1e-9)
    assert [rim.end for rim in wall.rims if rim.points[:, 2].mean() > 0.0] == [True]
    assert np.abs(np.linalg.norm(curve.into, axis=1) - 1.0).max() < 1e-12
    assert np.abs(curve.into[:, 2]).max() < 1e-9


def test_dome_of_sphere_and_cone():
    cone = Part.makeCone(30.0, 20.0, 40.0)  # it continues from a sphere with the same slope
    slope = np.arctan2(10.0, 40.0)
    radius = 20.0 / np.cos(slope)
    middle = Vector(0, 0, 40.0 - radius * np.sin(slope))
    ball = Part.makeSphere(radius, middle, Vector(0, 0, 1), np.degrees(slope), 90.0, 360.0)
    dome = shell(cone.Faces[0], ball.Faces[0])
    wall = wall_on(dome, (), slab(), 4.0)
    sound(wall, dome)
    assert wall.first[0].closed and not any(rim.end for rim in wall.rims)  # it closes in a point
    normal = wall.project(np.array([[0.1, 0.2, 100.0]]))[1]
    assert normal[0, 2] > 0.99


def test_window_and_slanted_end():
    cutter = Part.makeBox(200, 200, 100, Vector(-100, -100, 50))
    cutter.rotate(Vector(0, 0, 50), Vector(0, 1, 0), 20)
    cut = tube().cut(Part.makeCylinder(5, 60, Vector(0, 0, 25), Vector(1, 0, 0))).cut(cutter)
    wall = wall_on(cut, (), slab(), 4.0)
    assert isinstance(wall, PatchWall)
    sound(wall, cut)
    kinds = {
        bool(rim.end): rim.points.mean(axis=0)[2]
        for rim in wall.rims
        if rim.points.mean(axis=0)[2] > 5.0
    }
    assert kinds[True] > 40.0 and kinds[False] == pytest.approx(25.0, abs=1.0)


@pytest.mark.any_version
def test_splines_loft_and_pipe():
    points = [Vector(0, 0, 0), Vector(0, 5, 40), Vector(20, 10, 80), Vector(60, 5, 110)]
    path = Part.BSplineCurve()
    path.interpolate(points, InitialTangent=Vector(0, 0, 1), FinalTangent=Vector(1, 0, 1))
    circle = Part.Wire(Part.makeCircle(8, Vector(), Vector(0, 0, 1)))
    swept = Part.Wire(path.toShape()).makePipeShell([circle], False, True)
    ellipse = Part.Ellipse(Vector(0, 16, 40), Vector(9, 0, 40), Vector(0, 0, 40)).toShape()
    loft = Part.makeLoft([Part.Wire(Part.makeCircle(10)), Part.Wire(ellipse)], False)
    for shape in (swept, loft):
        wall = wall_on(shape, ("Face1",) if len(shape.Faces) == 1 else (), slab(), 3.0)
        points = wall.first if isinstance(wall, SurfaceWall) else wall.first[0].points
        assert points[:, 2] == pytest.approx(5.0, abs=1e-6)
        assert (
            max(shape.distToShape(Part.Vertex(Vector(*point)))[0] for point in points[::10]) < 5e-5
        )


def test_corners_of_the_substrate_are_corners_of_the_curve():
    wall = wall_on(
        shell(Part.makeCylinder(15, 30, Vector(0, 0, 10), Vector(0, 0, 1), 180).Faces[0]),
        (),
        Part.makeBox(100, 15, 30, Vector(-50, -5, 0)),
        3.0,
    )
    corner = [
        k
        for curve in wall.first
        for k, (a, b) in enumerate(zip(curve.into, curve.out))
        if a @ b < 0.9
    ]
    assert corner
    points = np.vstack(
        [
            curve.points[[k for k, (a, b) in enumerate(zip(curve.into, curve.out)) if a @ b < 0.9]]
            for curve in wall.first
        ]
    )
    assert points[:, 1] == pytest.approx(10.0, abs=1e-9)
    assert points[:, 2] == pytest.approx(30.0, abs=1e-9)
    assert np.hypot(points[:, 0], points[:, 1]) == pytest.approx(15.0, abs=1e-9)


@pytest.mark.parametrize("half", [False, True])
def test_mesh_substrate(half):
    mesh = MeshPart.meshFromShape(Shape=pipe(), LinearDeflection=0.02, AngularDeflection=0.1)
    wall = wall_on(bend(start=20.0, width=180.0) if half else bend(), (), mesh, 5.0)
    assert isinstance(wall, PatchWall if half else SurfaceWall)
    points = wall.first[0].points if half else wall.first
    x, y, z = points.T
    assert np.hypot(np.hypot(x + BEND, z) - BEND, y) == pytest.approx(TUBE, abs=1e-7)
    assert np.hypot(x, z) == pytest.approx(PIPE, abs=0.03)
    assert "up to" in wall.issues[0].message


def test_chosen_edges_need_no_substrate():
    face = tube()
    low = next(f"Edge{k}" for k, edge in enumerate(face.Edges, 1) if edge.BoundBox.ZMax < 1e-6)
    wall = wall_on(face, (), None, 4.0, start_edges=(low,))
    assert wall.first[0].closed and wall.first[0].points[:, 2] == pytest.approx(0.0, abs=1e-12)
    assert wall.first[0].curve().length == pytest.approx(TURN * 15.0, abs=1e-3)
    assert not wall.behind.any() and [
        rim.points[0, 2] for rim in wall.rims if rim.end
    ] == pytest.approx([60.0])


def oval(turned=0.0):
    """Return two halves of a lofted tube that is not of revolution, and its ends as (x, y)
    semi-axes by height."""
    ends = []
    for half in (0.0, np.pi):
        for z, (a, b) in ((0.0, (30.0, 18.0)), (60.0, (22.0, 36.0))):
            long, short, ahead = (a, b, Vector(1, 0, 0)) if a > b else (b, a, Vector(0, 1, 0))
            begin = half if a > b else half - 0.5 * np.pi
            ellipse = Part.Ellipse(
                Vector(long * ahead.x, long * ahead.y, z),
                Vector(-short * ahead.y, short * ahead.x, z),
                Vector(0, 0, z),
            )
            ends.append(Part.Wire(Part.ArcOfEllipse(ellipse, begin, begin + np.pi).toShape()))
    skin = Part.Compound([Part.makeLoft(ends[:2]), Part.makeLoft(ends[2:])])
    return skin.rotated(Vector(), Vector(1, 0, 0), turned)


@pytest.mark.any_version
def test_what_stands_on_the_platform_needs_no_substrate_either():
    """The faces are not sewn, and a wall cannot start at their common edges."""
    wall = wall_on(oval(), (), None, 4.0, "Vase")
    (first_curve,), (note,) = wall.first, wall.issues
    assert first_curve.closed and first_curve.points[:, 2] == pytest.approx(0.0, abs=1e-6)
    x, y = first_curve.points[:, :2].T
    assert np.hypot(x / 30.0, y / 18.0) == pytest.approx(1.0, abs=1e-6) and abs(np.ptp(x)) > 59.0
    assert (
        note.code == "FIRST_LAYER" and "Vase" in note.message and "on the platform" in note.message
    )
    assert [rim.points[0, 2] for rim in wall.rims if rim.end] == pytest.approx([60.0])
    for names, length in (((), 60.0), (("Face1",), 30.0)):
        half = wall_on(
            Part.Compound(
                [Part.makePlane(20, 30, Vector(x, 0, 5), Vector(0, -1, 0)) for x in (0, 30)]
            ),
            names,
            None,
            4.0,
        )
        assert (
            sum(curve.curve().length for curve in half.first) == pytest.approx(length)
            and not half.first[0].closed
        )
    with pytest.raises(InputError) as caught:
        wall_on(oval(20.0), (), None, 4.0, "Vase")
    low = -18.0 * np.sin(np.radians(20.0))
    assert caught.value.code == "NO_SUBSTRATE" and f"Z = {low:.4g}"[:8] in caught.value.message


def test_several_loops_are_all_taken_and_told():
    wall = wall_on(Part.makeCylinder(5, 120, Vector(0, 0, -60)).Faces[0], (), pipe(), 3.0)
    assert len(wall.first) == 2
    (message,) = (issue.message for issue in wall.issues if issue.code == "SEVERAL_LOOPS")
    assert "2 curves" in message and "31" in message and "-31" in message


def refused(*args, **options):
    with pytest.raises(InputError) as caught:
        wall_on(*args, label="Wall", substrate_label="Pipe", **options)
    return caught.value


def open_mesh():
    mesh = MeshPart.meshFromShape(Shape=pipe(), LinearDeflection=0.5, AngularDeflection=0.5)
    mesh.removeFacets(
        [k for k, facet in enumerate(mesh.Facets) if abs(facet.Normal.x) > 0.99]
    )  # both ends
    return mesh


def reversed_solid():
    solid = pipe()
    solid.reverse()
    return solid


def move_face(face, *by):
    face = face.copy()
    face.translate(Vector(*by))
    return face


def tight_pipe():
    spine = Part.BSplineCurve()
    spine.interpolate(
        [Vector(0, 0, 0), Vector(0, 0, 40), Vector(8, 0, 45), Vector(16, 0, 40), Vector(16, 0, 0)]
    )
    return Part.Wire(spine.toShape()).makePipeShell([Part.Wire(Part.makeCircle(10))], False, True)


def test_a_sheared_tube_has_a_mesh_of_its_own_size():
    # edges across the tube were once halved without end: 341,616 triangles, and pairs of them in
    # more than 9 GB
    rings = [Part.Wire(Part.makeCircle(5, Vector(*centre))) for centre in ((0, 0, 20), (25, 0, 88))]
    loft = Part.makeLoft(rings, False, False)
    wall = sheet([("Face1", loft.Faces[0])], 2.0, "Wall")
    corner = wall.vertices[wall.triangles]
    edges = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2)
    assert edges.max() <= 2.0 + 1e-9 and edges.min() > 1e-3 and len(wall.triangles) < 20_000
    # each triangle is along the tube: a circle of radius 5 in every horizontal plane
    middle = corner.mean(axis=1)
    radius = np.hypot(middle[:, 0] - (middle[:, 2] - 20.0) * 25.0 / 68.0, middle[:, 1])
    assert radius.min() > 5.0 - 0.3 and radius.max() < 5.0 + 1e-6
    refuse_crossing(wall, "Wall")


def blade():
    around = np.linspace(0.0, TURN, 41)
    skin = Part.BSplineSurface()
    skin.interpolate(
        [
            [Vector(11 * np.cos(a), np.sin(a), z) for a in around + np.radians(0.5 * z)]
            for z in (0.0, 15.0, 30.0)
        ]
    )
    return skin.toShape()


@pytest.mark.any_version
@pytest.mark.parametrize(
    ("make", "substrate", "height", "code", "words"),
    [
        (
            lambda: bend(start=0, width=180),
            lambda: Part.makeBox(9, 9, 9, Vector(200, 0, 0)),
            5.0,
            "NO_CONTACT",
            ["mm away"],
        ),
        (
            lambda: bend(start=0, width=180),
            lambda: Part.makeSphere(300.0),
            5.0,
            "INSIDE",
            ["smallest depth"],
        ),
        (lambda: bend(start=0, width=180), reversed_solid, 5.0, "INSIDE_OUT", ["volume"]),
        (lambda: bend(), open_mesh, 5.0, "OPEN_MESH", ["mm across"]),
        (
            lambda: shell(tube(height=30), move_face(tube(height=30), 0, 0, 30.1)),
            slab,
            4.0,
            "GAP",
            ["0.1 mm", "0.01 mm"],
        ),
        (
            lambda: shell(tube(height=30), move_face(tube(height=30), 0, 0, 33)),
            slab,
            4.0,
            "GAP",
            ["separate", "3 mm"],
        ),
        (
            lambda: shell(tube(height=30), Part.makeCone(15, 25, 30, Vector(0, 0, 30)).Faces[0]),
            slab,
            4.0,
            "CREASE",
            ["18.4 deg"],
        ),
        (
            lambda: shell(tube(2.0, 30.0), move_face(tube(2.0, 30.0), 0, 0, 30)),
            slab,
            4.0,
            "LAYER_HEIGHT",
            ["2 mm"],
        ),
        (tight_pipe, slab, 2.0, "SELF_INTERSECTION", ["intersects itself"]),
        # noses of a blade have a sharp turn but no fold
        pytest.param(
            blade,
            slab,
            2.0,
            "LAYER_HEIGHT",
            ["smallest radius of curvature of the wall, 0.0"],
            marks=pytest.mark.long,
        ),
    ],
)
def test_refusals_by_real_shapes(make, substrate, height, code, words):
    error = refused(make(), (), substrate(), height)
    assert error.code == code, error.line()
    assert error.where.split()[0] in ("Wall", "Pipe")
    assert "(" in error.message
    for word in words:
        assert word in error.message


@pytest.mark.parametrize(
    ("radius", "tall", "lean", "edge"), [(10.0, 120.0, 0.9, 3.0), (15.0, 150.0, 0.5, 5.0)]
)
@pytest.mark.always("10.0-120.0-0.9-3.0")
def test_the_mesh_of_a_slanted_tube_has_no_edges_across(radius, tall, lean, edge):
    """Flipping the edges of long needles once made edges from side to side, whose halving never
    ended."""
    skin = Part.makeCircle(radius).extrude(Vector(lean * tall, 0, tall)).toNurbs()
    wall = sheet([("Face1", skin.Faces[0])], edge, "Wall")
    corner = wall.vertices[wall.triangles]
    assert np.linalg.norm(np.roll(corner, -1, axis=1) - corner, axis=2).max() <= edge
    assert len(wall.triangles) < 100 * skin.Area / edge**2
    x, y, z = wall.vertices.T
    np.testing.assert_allclose(np.hypot(x - lean * z, y), radius, atol=1e-9)


@pytest.mark.any_version
def test_the_mesh_of_a_slanted_tube_that_is_cut_has_no_edges_across():
    """Flipped edges once kept their length in each pass: the mesh was unfinished, and the search
    for self-intersections took more than a minute."""
    radius, low, tall, lean, edge = 89.16, -185.0, 580.0, 1.0627, 40.0
    circle = Part.makeCircle(radius, Vector(lean * low, 0, low))
    tube = circle.extrude(Vector(lean * (tall - low), 0, tall - low))
    skin = max(
        tube.cut(Part.makeBox(616, 616, 308, Vector(-308, -308, -308))).Faces,
        key=lambda face: face.BoundBox.ZMax,
    )
    wall = sheet([("Face1", skin)], edge, "Wall")
    corner = wall.vertices[wall.triangles]
    assert np.linalg.norm(np.roll(corner, -1, axis=1) - corner, axis=2).max() <= edge
    x, y, z = wall.vertices.T
    np.testing.assert_allclose(np.hypot(x - lean * z, y), radius, atol=1e-6)
