# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fine triangles of large round faces are within the requested deflection and closed."""

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am.brep import hub
from freecad_am.brep.shapes import tessellate
from freecad_am.brep.shapes.tessellate import tessellated
from freecad_am.core.geometry.mesh.refine import Edges
from freecad_am.core.issues import InputError

pytestmark = pytest.mark.any_version

CHORD = 0.0015


def off_torus(points):
    return np.abs(np.hypot(np.hypot(points[:, 0], points[:, 1]) - 40.0, points[:, 2]) - 16.0)


def off_ball_with_bore(points):
    ball, bore = (
        np.abs(np.linalg.norm(points, axis=1) - 60.0),
        np.abs(np.hypot(points[:, 0], points[:, 1]) - 12.0),
    )
    return np.minimum(ball, bore)


@pytest.mark.parametrize(
    ("shape", "off"),
    [
        (Part.makeTorus(40, 16), off_torus),
        (
            Part.makeSphere(60).cut(Part.makeCylinder(12, 200, Vector(0, 0, -100))),
            off_ball_with_bore,
        ),
    ],
    ids=["torus", "ball with a bore"],
)
def test_a_mesh_of_hundreds_of_thousands_of_triangles(shape, off):
    """The kernel needs minutes for that many triangles, longer than a test may take."""
    vertices, triangles, owner, _ = tessellate.fine(shape.copy(), CHORD)
    assert len(triangles) > tessellate.SLOW_TRIANGLES and len(owner) == len(triangles)
    assert (Edges(triangles).count == 2).all()
    assert off(vertices).max() < 1e-6
    sample = vertices[triangles[::97]]
    assert (
        max(
            off(sample.mean(axis=1)).max(),
            *(off(sample[:, [k, k - 1]].mean(axis=1)).max() for k in range(3)),
        )
        < CHORD
    )
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    assert (np.cross(a, b) * c).sum() / 6.0 == pytest.approx(shape.Volume, rel=2e-4)


def test_others_are_as_the_kernel_makes_them():
    shape = Part.makeTorus(40, 16)
    ours, kernels = tessellate.fine(shape.copy(), 0.1), tessellated(shape.copy(), 0.1)
    assert np.array_equal(ours.vertices, kernels.vertices) and np.array_equal(
        ours.triangles, kernels.triangles
    )


def without(face):
    """Return the kernel's tessellation without the triangles of one face, unless that face is a
    spline."""

    def tessellate_without_face(shape, chord):
        mesh = tessellated(shape, chord)
        bare = (
            mesh.owner == face
            if shape.Faces[face].Surface.TypeId != "Part::GeomBSplineSurface"
            else mesh.owner < 0
        )
        return mesh._replace(triangles=mesh.triangles[~bare], owner=mesh.owner[~bare])

    return tessellate_without_face


def test_a_face_that_the_kernel_makes_no_triangles_of_gets_those_of_splines(monkeypatch):
    """The kernel fails like this on some countersinks from STEP files, at any deflection."""
    monkeypatch.setattr(tessellate, "tessellated", without(0))
    shape = Part.makeCone(8, 5, 4)
    vertices, triangles, owner, nodes = tessellate.fine(shape, 0.02)
    assert (Edges(triangles).count == 2).all() and set(owner) == {0, 1, 2} and not nodes
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    assert (np.cross(a, b) * c).sum() / 6.0 == pytest.approx(shape.Volume, rel=5e-3)
    side = vertices[(vertices[:, 2] > 1e-6) & (vertices[:, 2] < 4.0 - 1e-6)]
    assert (
        np.abs(np.hypot(side[:, 0], side[:, 1]) - (8.0 - 0.75 * side[:, 2])).max(initial=0.0) < 1e-6
    )


def test_a_face_of_which_there_are_no_triangles_at_all_is_named(monkeypatch):
    """The error names the face even if its solid is not the first."""
    two = Part.makeCompound([Part.makeBox(5, 5, 5, Vector(20, 0, 0)), Part.makeBox(1, 2, 3)])
    monkeypatch.setattr(hub, "in_kernel_process", lambda function, *words: function(*words))

    def bare(shape, chord):
        mesh = tessellated(shape, chord)
        # a face of the smaller box
        is_kept = (mesh.owner != 4) | (np.ptp(mesh.vertices[:, 0]) > 1.5)
        return mesh._replace(triangles=mesh.triangles[is_kept], owner=mesh.owner[is_kept])

    monkeypatch.setattr(tessellate, "tessellated", bare)
    with pytest.raises(InputError) as caught:
        hub.bodies_of(two, "boxes", 0.1, 0.0)
    assert caught.value.code == "BAD_SHAPE" and caught.value.where == "boxes Face11"


def test_a_face_no_wider_than_vertices_are_made_one_needs_no_triangles():
    """Some bodies have a side drawn with a step of two millionths of a millimetre."""
    step = [(0, 0), (20, 0), (20, 6), (10, 6), (10, 6.000002), (0, 6.000002), (0, 0)]
    solid = Part.Face(Part.makePolygon([Vector(x, y, 0) for x, y in step])).extrude(Vector(0, 0, 3))
    assert min(face.Area for face in solid.Faces) == pytest.approx(6e-6, rel=1e-3)
    (body,), issues = hub.bodies_of(solid, "plate", 0.1, 0.0, True)
    assert not issues and (Edges(body.triangles).count == 2).all()
    a, b, c = body.vertices[body.triangles].transpose(1, 0, 2)
    assert (np.cross(a, b) * c).sum() / 6.0 == pytest.approx(360.0, rel=1e-6)


@pytest.fixture(scope="module")
def topless():
    """Return a solid of FreeCAD without the square of 3 by 4 mm at the top of its knob."""
    solid = Part.makeBox(20, 20, 5).fuse(Part.makeBox(3, 4, 10, Vector(5, 5, 0)))
    return Part.Solid(Part.Shell([face for face in solid.Faces if face.CenterOfMass.z < 9.9]))


@pytest.mark.parametrize("touching", [False, True])
def test_a_solid_whose_faces_do_not_meet_is_mended_as_a_mesh_is(topless, touching):
    (body,), (mended,) = hub.bodies_of(topless, "knob", 0.1, 5.0, touching)
    assert (mended.level, mended.code) == ("warning", "MENDED")
    assert mended.message == "knob: 1 holes were closed, the largest 5 mm across at (6.5, 7, 10)"
    a, b, c = body.vertices[body.triangles].transpose(1, 0, 2)
    assert (np.cross(a, b) * c).sum() / 6.0 == pytest.approx(2060.0, rel=1e-9)


def test_what_of_it_is_wider_is_told(topless):
    with pytest.raises(InputError) as caught:
        hub.bodies_of(topless, "knob", 0.1, 4.9, True)
    assert caught.value.code == "OPEN_MESH" and caught.value.where == "knob"
    assert (
        "openings up to strategy.mend = 4.9 mm are closed automatically, but the widest is 5 mm across"
        in caught.value.message
    )
