# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fingerprints that are kept are those that would be made anew, and are made anew for all that counts."""

import FreeCAD as App
import Mesh
import Part
import pytest

from freecad_am import api
from freecad_am.objects.results import fingerprints
from freecad_am.objects.results.fingerprints import fingerprint


@pytest.fixture
def made(monkeypatch):
    """The shapes and meshes that were looked through, nothing being kept from before."""
    monkeypatch.setattr(fingerprints, "_shapes", [])
    monkeypatch.setattr(fingerprints, "_meshes", {})
    found = []
    for name in ("_shape_text", "body_of"):
        own = getattr(fingerprints, name)
        monkeypatch.setattr(
            fingerprints, name, lambda source, own=own: (found.append(source), own(source))[1]
        )
    return found


@pytest.fixture
def doc():
    document = App.newDocument("Fingerprints")
    yield document
    App.closeDocument(document.Name)


def anew(obj):
    """Its fingerprint without what is kept."""
    fingerprints._shapes.clear()
    fingerprints._meshes.clear()
    return fingerprint(obj)


def nested(doc):
    box = doc.addObject("Part::Box", "Box")
    group = doc.addObject("App::Part", "Group")
    group.addObject(box)
    mesh = doc.addObject("Mesh::Feature", "Mesh")
    mesh.Mesh = Mesh.createBox(1, 2, 3)
    group.addObject(mesh)
    doc.recompute()
    return box, mesh, group


def test_what_did_not_change_is_looked_through_once(doc, made):
    box, mesh, _ = nested(doc)
    before = [fingerprint(box), fingerprint(mesh)]
    assert len(made) == 2
    assert [fingerprint(box), fingerprint(mesh)] == before and len(made) == 2
    doc.recompute(None, True)  # the box is built again, its numbers are the same
    assert [fingerprint(box), fingerprint(mesh)] == before and [anew(box), anew(mesh)] == before


def moved(obj):
    obj.Placement.Base.z += 1


def edited(mesh):
    own = mesh.Mesh.copy()
    own.setPoint(0, own.Points[0].Vector + App.Vector(0.5, 0, 0))
    mesh.Mesh = own


@pytest.mark.parametrize(
    ("change", "of_box", "of_mesh"),
    [
        (lambda box, mesh, group: setattr(box, "Length", 11), True, False),
        (lambda box, mesh, group: moved(box), True, False),
        (lambda box, mesh, group: moved(mesh), False, True),
        (lambda box, mesh, group: edited(mesh), False, True),
        (lambda box, mesh, group: moved(group), True, True),
        (
            lambda box, mesh, group: group.removeObject(box),
            False,
            False,
        ),  # the group is where the document is
    ],
)
def test_every_change_counts(doc, made, change, of_box, of_mesh):
    box, mesh, group = nested(doc)
    before = fingerprint(box), fingerprint(mesh)
    change(box, mesh, group)
    doc.recompute()
    after = fingerprint(box), fingerprint(mesh)
    assert [one != other for one, other in zip(before, after, strict=True)] == [of_box, of_mesh]
    assert after == (anew(box), anew(mesh))


def test_a_shape_turned_inside_out_is_another_one(doc, made):
    part = doc.addObject("Part::Feature", "Part")
    part.Shape = Part.makeBox(1, 2, 3)
    before = fingerprint(part)
    part.Shape = part.Shape.reversed()  # the same faces behind it
    assert fingerprint(part) != before and fingerprint(part) == anew(part)


def test_a_compound_that_a_macro_adds_to_is_another_one(doc):
    """The kernel's object behind it stays the same one."""
    compound = Part.makeCompound([Part.makeBox(1, 1, 1)])
    made = doc.addObject("Part::Feature", "Compound")
    made.Shape = compound
    before = fingerprint(made)
    compound.add(Part.makeBox(1, 1, 1, App.Vector(5, 0, 0)))
    made.Shape = compound
    assert len(made.Shape.Faces) == 12 and fingerprint(made) != before


def test_undo_brings_the_first_one_back(doc, made):
    doc.UndoMode = 1
    box, _, _ = nested(doc)
    before = fingerprint(box)
    doc.openTransaction("Longer")
    box.Length = 20
    doc.recompute()
    doc.commitTransaction()
    assert fingerprint(box) != before
    doc.undo()
    doc.recompute()
    assert fingerprint(box) == before == anew(box)


def test_more_than_are_kept(doc, made):
    parts = []
    for k in range(fingerprints.MOST_KEPT + 5):
        parts.append(doc.addObject("Part::Feature", "Part"))
        parts[-1].Shape = Part.makeBox(1 + k, 1, 1)
    texts = [fingerprint(part) for part in parts]
    assert len(fingerprints._shapes) == fingerprints.MOST_KEPT and len(set(texts)) == len(parts)
    assert [fingerprint(part) for part in parts] == texts


def test_a_stage_that_is_touched_looks_at_no_shape_again(doc, made):
    ball = doc.addObject("Part::Sphere", "Ball")
    ball.Angle1 = 0
    doc.recompute()
    feature = api.make_feature(doc, ball, layer_height=2)
    count = len(made)
    feature.touch()
    doc.recompute()
    feature.LayerHeight = 1
    doc.recompute()
    assert feature.Status == "up to date" and len(made) == count
