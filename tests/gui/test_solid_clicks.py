# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids in plane layers by clicks: the panel and its preview, New Job of a bracket and of a
mesh."""

import FreeCAD as App
import MeshPart
import Part
import pytest

from freecad_am import api

pytestmark = pytest.mark.usefixtures("person")


def bracket(doc):
    shape = Part.makeBox(60, 40, 10).fuse(Part.makeBox(10, 40, 40)).removeSplitter()
    obj = doc.addObject("Part::Feature", "Bracket")
    obj.Shape = shape
    doc.recompute()
    return obj


def test_the_panel_previews_and_makes_a_feature(person):
    doc = App.newDocument("Solid")
    bracket_object = bracket(doc)
    person.select(bracket_object)
    person.click("RoboticAM_Solid")
    panel = person.panel("RoboticAM_SolidFeature")
    preview_text = person.field(panel, "preview")
    person.until(lambda: "1 solid, 40 mm high" in preview_text.text(), "the preview", 30)
    person.type(panel, "Direction", "1 0 0")
    person.until(lambda: "60 mm high" in preview_text.text(), "the preview along X", 30)
    person.screenshot("solid_panel")
    person.press("Ok")
    person.panel_closed()
    (feature,) = api.stages_of(doc, "feature")
    assert (feature.Status, feature.Height.Value, feature.Source[0]) == (
        "up to date",
        pytest.approx(60.0),
        bracket_object,
    )


def elbow(doc):
    up, over = App.Vector(0, 0, 1), App.Vector(30 * 0.5**0.5, 0, 30 - 30 * 0.5**0.5)
    bend = Part.Arc(
        App.Vector(), App.Vector(30, 0, 0) - App.Vector(over.x, 0, -over.x), App.Vector(30, 0, 30)
    ).toShape()
    spine = doc.addObject("Part::Feature", "Spine")
    spine.Shape = bend
    elbow_object = doc.addObject("Part::Feature", "Elbow")
    elbow_object.Shape = Part.Wire(bend).makePipeShell(
        [Part.Wire(Part.makeCircle(8, App.Vector(), up))], True, False
    )
    doc.recompute()
    return elbow_object, spine


def test_layers_along_a_guide_that_is_picked_or_found(person):
    doc = App.newDocument("Guided")
    elbow_object, spine = elbow(doc)
    person.select(elbow_object)
    person.click("RoboticAM_Solid")
    panel = person.panel("RoboticAM_SolidFeature")
    preview_text = person.field(panel, "preview")
    person.until(lambda: "1 solid," in preview_text.text(), "the preview", 30)
    person.type(panel, "Band", "40")
    person.choose(panel, "Layers", "along")
    person.until(lambda: "centre line, 47." in preview_text.text(), "the centre line", 30)
    person.field(panel, "PickGuide").click()
    person.select(spine)
    guide = person.field(panel, "Guide")
    person.until(
        lambda: "Spine" in guide.text() and "centre line" not in preview_text.text(),
        "the guide",
        30,
    )
    person.screenshot("solid_panel_guide")
    person.press("Ok")
    person.panel_closed()
    (feature,) = api.stages_of(doc, "feature")
    assert (feature.Status, feature.Guide[0], feature.Layers) == ("up to date", spine, "along")
    assert feature.Height.Value == pytest.approx(15.0 * 3.14159265, abs=0.01)


def test_faces_that_the_first_layer_lies_on_are_picked_and_taken_back(person):
    doc = App.newDocument("Started")
    bracket_object = bracket(doc)
    person.select(bracket_object)
    person.click("RoboticAM_Solid")
    panel = person.panel("RoboticAM_SolidFeature")
    preview_text = person.field(panel, "preview")
    person.until(lambda: "1 solid," in preview_text.text(), "the preview", 30)
    person.field(panel, "PickStartFaces").click()
    person.gui.Selection.addSelection(bracket_object, "Face1")
    face_field = person.field(panel, "StartFaces")
    person.until(lambda: "Face1" in face_field.text(), "the face", 10)
    person.until(
        lambda: "do not use start faces" in all_text(person, panel), "that planes have none", 10
    )
    person.choose(panel, "Layers", "geodesic")
    person.until(
        lambda: "do not use start faces" not in all_text(person, panel),
        "that curved layers have",
        30,
    )
    person.screenshot("solid_panel_start")
    person.press("Ok")
    person.panel_closed()
    (feature,) = api.stages_of(doc, "feature")
    assert (feature.Status, feature.StartFaces, feature.Layers) == (
        "up to date",
        (bracket_object, ["Face1"]),
        "geodesic",
    )
    person.double_click(feature)
    panel = person.panel("RoboticAM_SolidFeature")
    person.field(panel, "ClearStartFaces").click()
    person.press("Ok")
    person.panel_closed()
    assert feature.StartFaces is None and feature.Status == "up to date"


def all_text(person, panel):
    """Return the texts of the visible labels."""
    return " ".join(
        label.text() for label in panel.findChildren(person.widgets.QLabel) if label.isVisible()
    )


def test_new_job_fills_what_is_no_wall(person, coarse):
    doc = App.newDocument("Job")
    bracket_object = bracket(doc)
    person.select(bracket_object)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    reason = person.field(panel, "reason")
    person.until(lambda: "is a solid, and" in reason.text(), "the proposal", 30)
    assert person.field(panel, "Kind").currentText() == "Solids in plane layers"
    for name in ("Face1", "Face2"):
        person.gui.Selection.addSelection(doc.Name, bracket_object.Name, name)
    person.until(
        lambda: "so these faces are covered" in reason.text(),
        "faces to be proposed for cladding",
        30,
    )
    assert person.field(panel, "Kind").currentText() == "Cladding of faces"
    assert person.field(panel, "Source").text() == f"{bracket_object.Label} Face1 Face2"
    person.press("Cancel")
    person.panel_closed()


def test_a_mesh_is_proposed_to_be_filled(person):
    doc = App.newDocument("Mesh")
    scan = doc.addObject("Mesh::Feature", "Scan")
    scan.Mesh = MeshPart.meshFromShape(
        Shape=Part.makeBox(20, 20, 20), LinearDeflection=1, AngularDeflection=1
    )
    doc.recompute()
    person.select(scan)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    person.until(
        lambda: "is a mesh, to be filled" in person.field(panel, "reason").text(),
        "the proposal",
        20,
    )
    person.press("Cancel")
    person.panel_closed()


def red(person):
    return person.screen_pixels((219, 25, 31), 60)


def test_the_slider_shows_what_leans_out_before_anything_is_sliced(person):
    """A table with a foot: its top overhangs all around, with a chamfer of 30 deg below."""
    doc = App.newDocument("Overhang")
    table_object = doc.addObject("Part::Feature", "Table")
    foot = Part.makeBox(20, 20, 20, App.Vector(-10, -10, 0))
    half = 10 + 10 * 3**-0.5 * 1.0
    low, high = (
        Part.makePolygon(
            [
                App.Vector(*corner)
                for corner in ((-r, -r, z), (r, -r, z), (r, r, z), (-r, r, z), (-r, -r, z))
            ]
        )
        for r, z in ((10, 20), (half, 30))
    )
    table_object.Shape = foot.fuse(
        [Part.makeLoft([low, high], True, True), Part.makeBox(60, 60, 5, App.Vector(-30, -30, 30))]
    )
    doc.recompute()
    person.select(table_object)
    person.click("RoboticAM_Solid")
    panel = person.panel("RoboticAM_SolidFeature")
    slider, overhang_text = (
        person.field(panel, "OverhangAngle"),
        person.field(panel, "OverhangArea"),
    )
    ceiling = 60**2 - (2 * half) ** 2
    chamfer = 4 * (10 + half) * 10 / 0.75**0.5

    def area():
        return float(overhang_text.text().split(": ")[1].split(" ")[0]) * 100

    person.until(lambda: "cm²" in overhang_text.text(), "the area", 30)
    assert slider.value() == 45 and area() == pytest.approx(ceiling, rel=2e-3)
    view = person.gui.activeDocument().activeView()
    view.setCameraOrientation(App.Rotation(App.Vector(1, 0, 0), 150))  # from below
    person.gui.SendMsgToActiveView("ViewFit")
    person.idle(0.5)
    red_pixels = red(person)
    person.screenshot("overhang_view")
    slider.setValue(25)
    assert area() == pytest.approx(ceiling + chamfer, rel=2e-3)
    person.idle(0.5)
    assert red(person) > red_pixels + 500
    slider.setValue(89)
    assert area() == pytest.approx(ceiling, rel=2e-3)
    person.type(
        panel, "Direction", "0 0 -1"
    )  # upside down only the foot's underside is an overhang
    person.until(lambda: area() == 0.0, "nothing that leans out", 20)
    person.idle(0.3)
    assert red(person) < 0.2 * red_pixels  # only FreeCAD's own marks
    person.type(panel, "MaxOverhang", "60 deg")
    person.until(lambda: slider.value() == 60, "the slider to follow the field", 20)
    person.press("Cancel")
    person.panel_closed()
