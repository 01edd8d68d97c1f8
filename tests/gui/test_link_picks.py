# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clicks on links, link arrays and their elements in a rotated assembly: the panel takes the
clicked object at its visible location."""

import FreeCAD as App
import Part
import pytest

from freecad_am import api
from freecad_am.gui import picking
from freecad_am.objects.shapes.bodies import global_shape

PANEL = "RoboticAM_SolidFeature"


@pytest.fixture
def assembly(person):
    """Return a box, a link to it and two link arrays of three in a rotated part; elements are
    objects or not; one is by Draft."""
    doc = App.newDocument("Arrays")
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 20, 30, 10
    asm = doc.addObject("App::Part", "Asm")
    asm.Placement = App.Placement(App.Vector(0, 7, 50), App.Rotation(App.Vector(0, 0, 1), 30))
    link = doc.addObject("App::Link", "L1")
    link.LinkedObject, link.Placement.Base = box, App.Vector(0, 50, 0)
    asm.addObject(link)
    for name in ("Shown", "Hidden"):
        array = doc.addObject("App::Link", name)
        array.LinkedObject, array.ElementCount = box, 3
        doc.recompute()
        for k, element in enumerate(array.ElementList):
            element.Placement.Base = App.Vector(100 * k, 0, 200 * len(name))
        array.ShowElement = name == "Shown"
        asm.addObject(array)
    import Draft

    row = Draft.make_ortho_array(
        box,
        App.Vector(50, 0, 0),
        App.Vector(0, 50, 0),
        App.Vector(0, 0, 50),
        3,
        1,
        1,
        use_link=True,
    )
    row.Label = "Row"
    asm.addObject(row)
    doc.recompute()
    person.idle(0.3)
    person.gui.Selection.clearSelection()
    yield doc
    App.closeDocument(doc.Name)


def draft_array(doc):
    return doc.getObjectsByLabel("Row")[0]


def select(person, doc, top, path):
    person.gui.Selection.clearSelection()
    person.gui.Selection.addSelection(doc.Name, top, path)


@pytest.mark.parametrize(
    ("path", "label"),
    [
        ("L1.Face1", "L1"),
        ("Shown.Shown_i1.Face1", "Shown_i1"),
        ("Hidden.1.Face1", "Hidden.1"),
        ("{row}.1.Face1", "Row.1"),
        ("{row}.2.", "Row.2"),
    ],
)
def test_what_is_clicked_is_taken(person, assembly, path, label):
    path = path.format(row=draft_array(assembly).Name)
    select(person, assembly, "Asm", path)
    (pick,) = picking.selected(assembly)
    assert pick.obj.Label == label
    shown_shape = Part.getShape(assembly.Asm, path, needSubElement=not path.endswith("."))
    picked_shape = global_shape(pick.obj)
    picked_shape = picked_shape.getElement(pick.names[0]) if pick.names else picked_shape
    assert picked_shape.CenterOfMass.distanceToPoint(shown_shape.CenterOfMass) < 1e-6
    assert picked_shape.Area == pytest.approx(shown_shape.Area)


@pytest.mark.parametrize("path", ["Hidden.1.Face1", "{row}.1.Face1", "Shown.Shown_i1.Face1"])
def test_a_solid_of_one_element_by_its_panel(person, assembly, path):
    """Only the element is printed, not the whole array, and its helper object belongs to the same
    undo step."""
    path = path.format(row=draft_array(assembly).Name)
    select(person, assembly, "Asm", path)
    steps, object_names = assembly.UndoCount, {obj.Name for obj in assembly.Objects}
    person.click("RoboticAM_Solid")
    person.panel(PANEL)
    expected = Part.getShape(assembly.Asm, path.removesuffix("Face1"))
    person.press("Ok")
    person.panel_closed()
    (feature,) = api.stages_of(assembly, "feature")
    assert feature.Solids == 1 and feature.Status == "up to date"
    shape = global_shape(feature.Source[0])
    assert shape.CenterOfMass.distanceToPoint(expected.CenterOfMass) < 1e-6
    assert assembly.UndoCount == steps + 1
    assembly.undo()
    assert {obj.Name for obj in assembly.Objects} == object_names


def test_one_face_for_a_wall_says_what_is_taken(person, assembly):
    """A click on a part selects one face: the panel takes the part, and says so while it is
    open."""
    select(person, assembly, "Box", "Face1")
    person.click("RoboticAM_WallOnPart")
    panel = person.panel("RoboticAM_SurfaceFeature")
    person.idle(1.0)
    labels = panel.findChildren(person.widgets.QLabel)
    text = "\n".join(label.text() for label in labels if label.isVisible())
    person.press("Cancel")
    assert "The whole of Box is used; Pick selects single faces" in text
