# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles of a solid enclose its full volume, even if the kernel fails at one deflection."""

import FreeCAD
import numpy as np
import Part
import pytest

from freecad_am.brep import hub
from freecad_am.brep.shapes.tessellate import fine
from freecad_am.core.geometry.mesh.solid import SolidMesh

pytestmark = pytest.mark.any_version

TORUS = Part.makeTorus(20.0, 5.0)


def cut_short(faulty):
    """Return a tessellation in which one half of the tube is half as thick, for deflections that
    `faulty` accepts."""
    deflections = []

    def tessellate(function, shape, chord):
        assert function is fine
        deflections.append(chord)
        right = fine(shape, chord)
        if not faulty(chord):
            return right
        bent = right.vertices.copy()
        bent[bent[:, 1] > 0.0, 2] *= 0.5  # still closed, with half of the volume there
        return right._replace(vertices=bent)

    return tessellate, deflections


def test_another_deflection_is_taken_where_one_lacks_a_part(monkeypatch):
    tessellate, deflections = cut_short(lambda chord: chord > 0.009)
    monkeypatch.setattr(hub, "in_kernel_process", tessellate)
    ring = hub.bodies_of(TORUS, "ring", 0.01 / hub.SHARE, 0.1)
    body = ring.bodies[0]
    assert ring.issues == () and len(deflections) == 2
    assert SolidMesh(body.vertices, body.triangles).volume == pytest.approx(TORUS.Volume, rel=2e-3)


def test_what_no_deflection_mends_is_told_with_both_volumes(monkeypatch):
    tessellate, deflections = cut_short(lambda chord: True)
    monkeypatch.setattr(hub, "in_kernel_process", tessellate)
    ring = hub.bodies_of(TORUS, "ring", 0.01 / hub.SHARE, 0.1)
    (issue,) = ring.issues
    assert (
        issue.code == "MESH_VOLUME"
        and issue.level == "warning"
        and len(deflections) == len(hub.FINER)
    )
    assert f"{1e-3 * TORUS.Volume:.4g} cm3" in issue.message


@pytest.mark.parametrize(
    "shape",
    [
        TORUS,
        Part.makeSphere(30.0),
        Part.makeCone(1.0, 20.0, 300.0),
        Part.makeBox(0.1, 50.0, 50.0),
    ],
)
@pytest.mark.parametrize("chord", [0.5, 0.01])
@pytest.mark.always
def test_sound_solids_are_meshed_once(monkeypatch, shape, chord):
    tessellate, deflections = cut_short(lambda chord: False)
    monkeypatch.setattr(hub, "in_kernel_process", tessellate)
    assert hub.complete_mesh(shape, chord, "it")[1] == () and deflections == [chord]


def stretched(shape, *shares):
    matrix = FreeCAD.Matrix()
    matrix.scale(*shares)
    return shape.transformGeometry(matrix).Solids[0]


PIPE = Part.makeCylinder(20.0, 30.0).cut(Part.makeCylinder(12.0, 30.0))


@pytest.mark.parametrize(
    ("shape", "volume"),
    [
        (stretched(Part.makeCylinder(20.0, 30.0), 1.5, 1.0, 1.0), 18000.0 * np.pi),
        (stretched(Part.makeCylinder(20.0, 30.0), -1.0, 1.0, 1.0), 12000.0 * np.pi),
        (stretched(PIPE, 1.0, 0.7, 1.3), 0.7 * 1.3 * 30.0 * (400.0 - 144.0) * np.pi),
        (stretched(Part.makeCone(20.0, 5.0, 30.0), 1.0, 2.0, 1.0), 10500.0 * np.pi),
    ],
)
def test_no_warning_where_the_kernel_integrates_its_own_faces_wrongly(shape, volume):
    """The triangles are right, as the formula shows; the kernel's volume is off by up to 1 %."""
    chord = 0.02
    mesh, issues = hub.complete_mesh(shape, chord, "it")
    assert issues == ()
    enclosed = abs(SolidMesh(mesh.vertices, mesh.triangles).volume)
    assert enclosed == pytest.approx(volume, abs=1.5 * chord * shape.Area)
    assert abs(abs(shape.Volume) - volume) > 2e-3 * volume  # otherwise the test proves nothing


@pytest.mark.parametrize("axis", range(3))
def test_a_part_that_lacks_is_seen_where_the_kernel_is_wrong_too(monkeypatch, axis):
    """Triangles of the stretched cylinder have a dent on one side, about as large as the kernel's
    error."""
    shape = stretched(Part.makeCylinder(20.0, 30.0), 1.5, 1.0, 1.0)

    def dented(function, solid, chord):
        right = function(solid, chord)
        bent = right.vertices.copy()
        side = bent[:, axis] > bent[:, axis].max() - 1e-6 if axis == 2 else bent[:, axis] > 5.0
        bent[side, axis] -= 0.03 * np.ptp(bent[:, axis])
        return right._replace(vertices=bent)

    monkeypatch.setattr(hub, "in_kernel_process", dented)
    assert [issue.code for issue in hub.complete_mesh(shape, 0.02, "it")[1]] == ["MESH_VOLUME"]


def test_faces_and_edges_beside_solids_are_noted():
    """Such faces and edges are not deposited; a face shared by two solids is not a loose one."""
    box = Part.makeBox(10.0, 10.0, 10.0)
    plane = Part.makePlane(5.0, 5.0, FreeCAD.Vector(0.0, 0.0, 40.0))
    line = Part.makeLine(FreeCAD.Vector(0.0, 0.0, 0.0), FreeCAD.Vector(0.0, 0.0, 50.0))
    for shape, words in (
        (box, None),
        (box.Solids[0].multiFuse([Part.makeBox(5.0, 5.0, 20.0)]), None),
        (Part.makeCompound([box, plane]), "1 face(s) and 0 edge(s)"),
        (Part.makeCompound([plane, line, box]), "1 face(s) and 1 edge(s)"),
    ):
        box_bodies = hub.bodies_of(shape, "box", 0.1, 0.1)
        assert [(note.level, note.code) for note in box_bodies.issues] == (
            [("note", "FILE_CONTENT")] if words else []
        )
        assert words is None or words in str(box_bodies.issues[0].message)
