# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fine triangles of large round faces: as near as asked for, closed, and in seconds."""

import time

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am.brep import fine_mesh
from freecad_am.brep.tessellate import tessellated
from freecad_am.core.geometry.mesh.refined import Edges

CHORD = 0.0015


def off_torus(points):
    return np.abs(np.hypot(np.hypot(points[:, 0], points[:, 1]) - 40.0, points[:, 2]) - 16.0)


def off_ball_with_bore(points):
    ball, bore = np.abs(np.linalg.norm(points, axis=1) - 60.0), np.abs(np.hypot(points[:, 0], points[:, 1]) - 12.0)
    return np.minimum(ball, bore)


@pytest.mark.parametrize(("shape", "off"), [
    (Part.makeTorus(40, 16), off_torus),
    (Part.makeSphere(60).cut(Part.makeCylinder(12, 200, Vector(0, 0, -100))), off_ball_with_bore),
], ids=["torus", "ball with a bore"])
def test_a_mesh_of_hundreds_of_thousands_of_triangles(shape, off):
    """The kernel takes minutes for them."""
    began = time.process_time()
    vertices, triangles, owner, _ = fine_mesh.fine(shape.copy(), CHORD)
    assert time.process_time() - began < 8.0
    assert len(triangles) > fine_mesh.SLOW and len(owner) == len(triangles)
    assert (Edges(triangles).count == 2).all()
    assert off(vertices).max() < 1e-6
    some = vertices[triangles[::97]]
    assert max(off(some.mean(axis=1)).max(), *(off(some[:, [k, k - 1]].mean(axis=1)).max() for k in range(3))) < CHORD
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    assert (np.cross(a, b) * c).sum() / 6.0 == pytest.approx(shape.Volume, rel=2e-4)


def test_others_are_as_the_kernel_makes_them():
    shape = Part.makeTorus(40, 16)
    ours, kernels = fine_mesh.fine(shape.copy(), 0.1), tessellated(shape.copy(), 0.1)
    assert np.array_equal(ours.vertices, kernels.vertices) and np.array_equal(ours.triangles, kernels.triangles)
