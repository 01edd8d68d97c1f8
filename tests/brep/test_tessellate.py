# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids and meshes as bodies: within the deflection of the true surface, in the coordinates of the document."""

import Mesh
import numpy as np
import Part
import pytest
from FreeCAD import Placement, Rotation, Vector

from freecad_am.brep.shapes.tessellate import DEFLECTION, body
from freecad_am.core.issues import InputError

PLACE = Placement(Vector(10, -20, 30), Rotation(Vector(1, 2, 3), 50))


def solid():
    shape = Part.makeCylinder(32, 200)
    shape.Placement = PLACE
    return shape


def test_triangles_of_a_solid_enclose_it():
    found = body(solid(), "pipe")
    corners = np.array([[tuple(PLACE.inverse().multVec(Vector(*p))) for p in t] for t in found.corners()])
    radius = np.hypot(*corners.mean(axis=1)[:, :2].T)
    side = np.ptp(corners[:, :, 2], axis=1) > 1.0
    assert (np.abs(radius[side] - 32.0) <= DEFLECTION).all()
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0
    assert volume == pytest.approx(solid().Volume, rel=2.0 * DEFLECTION / 32.0)
    assert found.name == "pipe"


def test_a_mesh_is_taken_as_it_is():
    points, facets = solid().tessellate(0.5)
    found = body(Mesh.Mesh((points, facets)), "scan")
    # a mesh keeps its points in single precision
    wanted = np.sort(np.array([tuple(point) for point in points]), axis=0)
    assert np.sort(found.vertices, axis=0) == pytest.approx(wanted, abs=1e-4)
    assert len(found.triangles) == len(facets)


def test_an_edge_is_no_body():
    with pytest.raises(InputError) as error:
        body(Part.makeLine(Vector(), Vector(1, 0, 0)), "line")
    assert error.value.code == "NO_FACES" and error.value.where == "line"
