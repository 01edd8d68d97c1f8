# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles of a solid enclose what it does, whatever the kernel makes at one deflection."""

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
    """What the kernel would make, for the deflections that `faulty` says with the tube half as thick in one half."""
    asked = []

    def made(function, shape, chord):
        assert function is fine
        asked.append(chord)
        right = fine(shape, chord)
        if not faulty(chord):
            return right
        bent = right.vertices.copy()
        bent[bent[:, 1] > 0.0, 2] *= 0.5  # still closed, and of half the volume there
        return right._replace(vertices=bent)

    return made, asked


def test_another_deflection_is_taken_where_one_lacks_a_part(monkeypatch):
    made, asked = cut_short(lambda chord: chord > 0.009)
    monkeypatch.setattr(hub, "in_kernel_process", made)
    found = hub.bodies_of(TORUS, "ring", 0.01 / hub.SHARE, 0.1)
    body = found.bodies[0]
    assert found.issues == () and len(asked) == 2
    assert SolidMesh(body.vertices, body.triangles).volume == pytest.approx(TORUS.Volume, rel=2e-3)


def test_what_no_deflection_mends_is_told_with_both_volumes(monkeypatch):
    made, asked = cut_short(lambda chord: True)
    monkeypatch.setattr(hub, "in_kernel_process", made)
    found = hub.bodies_of(TORUS, "ring", 0.01 / hub.SHARE, 0.1)
    (issue,) = found.issues
    assert issue.code == "MESH_VOLUME" and issue.level == "warning" and len(asked) == len(hub.FINER)
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
    made, asked = cut_short(lambda chord: False)
    monkeypatch.setattr(hub, "in_kernel_process", made)
    assert hub.complete_mesh(shape, chord, "it")[1] == () and asked == [chord]


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
    """The triangles are right, which is known from the formula; the kernel's volume is off by up to 1 %."""
    chord = 0.02
    made, issues = hub.complete_mesh(shape, chord, "it")
    assert issues == ()
    enclosed = abs(SolidMesh(made.vertices, made.triangles).volume)
    assert enclosed == pytest.approx(volume, abs=1.5 * chord * shape.Area)
    assert abs(abs(shape.Volume) - volume) > 2e-3 * volume  # else the test says nothing


@pytest.mark.parametrize("axis", range(3))
def test_a_part_that_lacks_is_seen_where_the_kernel_is_wrong_too(monkeypatch, axis):
    """Triangles of the stretched cylinder with a dent on one side, of about as much as the kernel is wrong."""
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
    """They are not deposited; a face that two solids share is no loose one."""
    box = Part.makeBox(10.0, 10.0, 10.0)
    plane = Part.makePlane(5.0, 5.0, FreeCAD.Vector(0.0, 0.0, 40.0))
    line = Part.makeLine(FreeCAD.Vector(0.0, 0.0, 0.0), FreeCAD.Vector(0.0, 0.0, 50.0))
    for shape, words in (
        (box, None),
        (box.Solids[0].multiFuse([Part.makeBox(5.0, 5.0, 20.0)]), None),
        (Part.makeCompound([box, plane]), "1 face(s) and 0 edge(s)"),
        (Part.makeCompound([plane, line, box]), "1 face(s) and 1 edge(s)"),
    ):
        found = hub.bodies_of(shape, "box", 0.1, 0.1)
        assert [(note.level, note.code) for note in found.issues] == (
            [("note", "FILE_CONTENT")] if words else []
        )
        assert words is None or words in str(found.issues[0].message)
