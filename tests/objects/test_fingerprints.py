# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cached fingerprints equal new ones, and every change that counts makes a new one."""

import FreeCAD as App
import Mesh
import Part
import pytest

from freecad_am import api
from freecad_am.objects.results import fingerprints
from freecad_am.objects.results.fingerprints import fingerprint


@pytest.fixture
def made(monkeypatch):
    """Record the shapes and meshes that are hashed, starting with an empty cache."""
    monkeypatch.setattr(fingerprints, "_shapes", [])
    monkeypatch.setattr(fingerprints, "_meshes", {})
    hashed = []
    for name in ("_shape_text", "body_of"):
        original = getattr(fingerprints, name)
        monkeypatch.setattr(
            fingerprints,
            name,
            lambda source, original=original: (hashed.append(source), original(source))[1],
        )
    return hashed


@pytest.fixture
def doc():
    document = App.newDocument("Fingerprints")
    yield document
    App.closeDocument(document.Name)


def anew(obj):
    """Return its fingerprint without the cache."""
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
    fingerprints_ = [fingerprint(box), fingerprint(mesh)]
    assert len(made) == 2
    assert [fingerprint(box), fingerprint(mesh)] == fingerprints_ and len(made) == 2
    doc.recompute(None, True)  # the box is rebuilt with the same numbers
    assert [fingerprint(box), fingerprint(mesh)] == fingerprints_ and [
        anew(box),
        anew(mesh),
    ] == fingerprints_


def move(obj):
    obj.Placement.Base.z += 1


def edited(mesh):
    mesh_copy = mesh.Mesh.copy()
    mesh_copy.setPoint(0, mesh_copy.Points[0].Vector + App.Vector(0.5, 0, 0))
    mesh.Mesh = mesh_copy


@pytest.mark.parametrize(
    ("change", "of_box", "of_mesh"),
    [
        (lambda box, mesh, group: setattr(box, "Length", 11), True, False),
        (lambda box, mesh, group: move(box), True, False),
        (lambda box, mesh, group: move(mesh), False, True),
        (lambda box, mesh, group: edited(mesh), False, True),
        (lambda box, mesh, group: move(group), True, True),
        (
            lambda box, mesh, group: group.removeObject(box),
            False,
            False,
        ),  # the group is at the document's origin
    ],
)
def test_every_change_counts(doc, made, change, of_box, of_mesh):
    box, mesh, group = nested(doc)
    old_fingerprints = fingerprint(box), fingerprint(mesh)
    change(box, mesh, group)
    doc.recompute()
    new_fingerprints = fingerprint(box), fingerprint(mesh)
    assert [old != new for old, new in zip(old_fingerprints, new_fingerprints, strict=True)] == [
        of_box,
        of_mesh,
    ]
    assert new_fingerprints == (anew(box), anew(mesh))


def test_a_shape_turned_inside_out_is_another_one(doc, made):
    feature = doc.addObject("Part::Feature", "Part")
    feature.Shape = Part.makeBox(1, 2, 3)
    original = fingerprint(feature)
    feature.Shape = feature.Shape.reversed()  # the same faces behind it
    assert fingerprint(feature) != original and fingerprint(feature) == anew(feature)


def test_a_compound_that_a_macro_adds_to_is_another_one(doc):
    """The kernel's object behind the shape stays the same."""
    compound = Part.makeCompound([Part.makeBox(1, 1, 1)])
    compound_object = doc.addObject("Part::Feature", "Compound")
    compound_object.Shape = compound
    original = fingerprint(compound_object)
    compound.add(Part.makeBox(1, 1, 1, App.Vector(5, 0, 0)))
    compound_object.Shape = compound
    assert len(compound_object.Shape.Faces) == 12 and fingerprint(compound_object) != original


def test_undo_brings_the_first_one_back(doc, made):
    doc.UndoMode = 1
    box, _, _ = nested(doc)
    original = fingerprint(box)
    doc.openTransaction("Longer")
    box.Length = 20
    doc.recompute()
    doc.commitTransaction()
    assert fingerprint(box) != original
    doc.undo()
    doc.recompute()
    assert fingerprint(box) == original == anew(box)


def test_more_than_are_kept(doc, made):
    features = []
    for k in range(fingerprints.MOST_KEPT + 5):
        features.append(doc.addObject("Part::Feature", "Part"))
        features[-1].Shape = Part.makeBox(1 + k, 1, 1)
    texts = [fingerprint(feature) for feature in features]
    assert len(fingerprints._shapes) == fingerprints.MOST_KEPT and len(set(texts)) == len(features)
    assert [fingerprint(feature) for feature in features] == texts


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
