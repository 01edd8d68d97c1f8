# SPDX-License-Identifier: LGPL-2.1-or-later
"""The meaning of a selection: bodies in assemblies and links, faces by their own names, and which
of two objects is the wall."""

import FreeCAD as App
import pytest

from freecad_am.gui import picking
from freecad_am.gui.picking import Pick
from freecad_am.objects.shapes import nested
from freecad_am.objects.shapes.bodies import global_shape


@pytest.fixture
def assembly():
    """Return a body of two features in a moved part, a link to each, a separate body, and two plain
    objects."""
    document = App.newDocument("Assembly")
    container = document.addObject("App::Part", "Part")
    container.Placement = App.Placement(App.Vector(30, 0, 0), App.Rotation(App.Vector(0, 0, 1), 40))
    body = document.addObject("PartDesign::Body", "Body")
    container.addObject(body)
    box = document.addObject("PartDesign::AdditiveBox", "Pad")
    bore = document.addObject("PartDesign::SubtractiveCylinder", "Bore")
    for feature in (box, bore):
        body.addObject(feature)
    box.Length = box.Width = box.Height = 10
    bore.Radius, bore.Height = 3, 10
    loose = document.addObject("PartDesign::Body", "Loose")
    loose.Placement.Base = App.Vector(0, 0, 70)
    loose.addObject(document.addObject("PartDesign::AdditiveCylinder", "Hull"))
    links = [document.addObject("App::Link", name) for name in ("BodyLink", "PartLink")]
    for link, target, move in zip(links, (body, container), (50, 90), strict=True):
        link.LinkedObject = target
        link.Placement.Base = App.Vector(0, move, 0)
    document.addObject("Part::Box", "Block")
    document.addObject("Part::Sphere", "Ball")
    document.recompute()
    return document


def same_place(shape, expected):
    return (shape.CenterOfMass - expected.CenterOfMass).Length < 1e-9 and abs(
        shape.Area - expected.Area
    ) < 1e-9


@pytest.mark.parametrize(
    ("top", "path", "name"),
    [
        ("Part", "Body.Bore.Face{}", "Body"),
        ("Part", "Body.Pad.Face{}", "Pad"),
        ("Loose", "Hull.Face{}", "Loose"),
        ("BodyLink", "Bore.Face{}", "BodyLink"),
        ("PartLink", "Body.Bore.Face{}", "PartLink"),
        ("Block", "Face{}", "Block"),
    ],
)
def test_a_face_is_the_same_face_of_the_object_it_belongs_to(person, assembly, top, path, name):
    """The face with the returned name in the owner is at the click, under whatever name the
    selection has it."""
    obj = assembly.getObject(top)
    own_count = len(global_shape(assembly.getObject(name)).Faces)
    for number in range(1, own_count + 1):
        full = path.format(number)
        picked, own_name = nested.owner_of(obj, full)
        assert picked.Name == name
        assert same_place(global_shape(picked).getElement(own_name), obj.getSubObject(full)), full


def test_a_selection_in_an_assembly(person, assembly):
    person.gui.Selection.clearSelection()
    person.gui.Selection.addSelection("Assembly", "Part", "Body.Bore.Face1")
    person.gui.Selection.addSelection("Assembly", "Part", "Body.Bore.Face2")
    person.gui.Selection.addSelection("Assembly", "Ball")
    wall, substrate, unclear = picking.proposal(picking.selected(assembly))
    assert (wall.obj, len(wall.names), substrate, unclear) == (
        assembly.Body,
        2,
        Pick(assembly.Ball),
        "",
    )


def test_which_is_the_wall(person, assembly):
    block, ball = assembly.Block, assembly.Ball
    scan = assembly.addObject("Mesh::Feature", "Scan")
    faced = Pick(block, ("Face1",))
    assert picking.proposal([]) == (None, None, "")
    assert picking.proposal([Pick(ball)]) == (Pick(ball), None, "")
    assert picking.proposal([Pick(scan)]) == (Pick(scan), None, "")
    assert picking.proposal([Pick(ball), faced]) == (faced, Pick(ball), "")
    assert picking.proposal([Pick(ball), Pick(block)]) == (Pick(ball), Pick(block), "")
    assert picking.proposal([Pick(scan), Pick(ball)]) == (Pick(ball), Pick(scan), "")
    assert picking.proposal([Pick(block, ("Edge1",)), Pick(ball)]) == (Pick(block), Pick(ball), "")
    wall, substrate, unclear = picking.proposal([Pick(ball), faced, Pick(scan)])
    assert (wall, substrate) == (faced, None) and "3 objects" in unclear
