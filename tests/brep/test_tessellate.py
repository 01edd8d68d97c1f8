# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids and meshes as bodies: within the deflection of the true surface, in document
coordinates."""

from types import SimpleNamespace

import Mesh
import MeshPart
import numpy as np
import Part
import pytest
from FreeCAD import Placement, Rotation, Vector

from freecad_am.brep.shapes.tessellate import DEFLECTION, body, skin, tessellated
from freecad_am.core.issues import InputError

PLACE = Placement(Vector(10, -20, 30), Rotation(Vector(1, 2, 3), 50))


def solid():
    shape = Part.makeCylinder(32, 200)
    shape.Placement = PLACE
    return shape


def test_triangles_of_a_solid_enclose_it():
    solid_body = body(solid(), "pipe")
    corners = np.array(
        [[tuple(PLACE.inverse().multVec(Vector(*p))) for p in t] for t in solid_body.corners()]
    )
    radius = np.hypot(*corners.mean(axis=1)[:, :2].T)
    side = np.ptp(corners[:, :, 2], axis=1) > 1.0
    assert (np.abs(radius[side] - 32.0) <= DEFLECTION).all()
    volume = (
        np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0
    )
    assert volume == pytest.approx(solid().Volume, rel=2.0 * DEFLECTION / 32.0)
    assert solid_body.name == "pipe"


def test_a_mesh_is_taken_as_it_is():
    points, facets = solid().tessellate(0.5)
    mesh_body = body(Mesh.Mesh((points, facets)), "scan")
    # a mesh keeps its points in single precision
    expected = np.sort(np.array([tuple(point) for point in points]), axis=0)
    assert np.sort(mesh_body.vertices, axis=0) == pytest.approx(expected, abs=1e-4)
    assert len(mesh_body.triangles) == len(facets)


def test_an_edge_is_no_body():
    with pytest.raises(InputError) as error:
        body(Part.makeLine(Vector(), Vector(1, 0, 0)), "line")
    assert error.value.code == "NO_FACES" and error.value.where == "line"


def crossed():
    """Return a face whose edges cross, so that the kernel makes no triangles of it, between two
    other faces and a box."""
    bow = Part.makePolygon(
        [Vector(*corner) for corner in ((0, 0, 0), (9, 9, 0), (9, 0, 0), (0, 9, 0), (0, 0, 0))]
    )
    return Part.makeCompound(
        [
            Part.makeSphere(2).Faces[0],
            Part.Face(bow),
            Part.makeCylinder(1, 3).Faces[0],
            Part.makeBox(4, 5, 6, Vector(20, 0, 0)),
        ]
    )


def test_a_face_that_the_kernel_fails_on_has_no_triangles_and_the_others_theirs():
    mesh = tessellated(crossed(), 0.05)
    assert (
        set(mesh.owner) == {0, *range(2, 9)}
        and [len(nodes) > 0 for nodes in mesh.nodes].count(False) == 1
    )
    assert np.linalg.norm(mesh.vertices[mesh.triangles[mesh.owner == 0]], axis=2) == pytest.approx(
        2.0, abs=1e-6
    )
    assert mesh.vertices[mesh.triangles[mesh.owner > 2], 0].min() >= 20.0
    distance, _ = skin(crossed(), "faces").exact(np.array([[22.0, 2.0, 7.5]]))
    assert distance == pytest.approx([1.5])


def test_a_face_that_the_kernel_has_failed_on_is_not_asked_for_again(monkeypatch):
    """The face next to a countersink from a STEP file took minutes each time, or never returned."""

    def failed():
        raise RuntimeError("Face has no triangulation")

    def asked(_):
        pytest.fail("the kernel may take minutes for this")

    shape = Part.makeBox(1, 2, 3)
    faces = [SimpleNamespace(getUVNodes=failed, tessellate=asked), *shape.Faces]
    monkeypatch.setattr(
        MeshPart, "meshFromShape", lambda **words: shape.tessellate(words["LinearDeflection"])
    )
    assert set(tessellated(SimpleNamespace(Faces=faces), 0.1).owner) == set(range(1, 7))
