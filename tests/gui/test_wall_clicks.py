# SPDX-License-Identifier: LGPL-2.1-or-later
"""A bend on a pipe by mouse: selected in the 3D view and the tree, previewed, created, undone,
saved in its file."""

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.gui import worker
from freecad_am.gui.views import preview

ORANGE = (245, 120, 0)  # the colour of first layers
PANEL = "RoboticAM_SurfaceFeature"


@pytest.fixture
def bend(person, root):
    """Return a document with a bend and its pipe, with both in view."""
    document = App.newDocument("Bend")
    pipe = document.addObject("Part::Cylinder", "Pipe")
    pipe.Radius, pipe.Height = 32, 160
    pipe.Placement = App.Placement(App.Vector(0, -80, 0), App.Rotation(App.Vector(1, 0, 0), -90))
    document.recompute()
    wall_and_pipe = [
        api.open_part(document, str(root / "resources" / "examples" / "tube-on-pipe.step")),
        pipe,
    ]
    for obj, label in zip(wall_and_pipe, ("Bend on it", "Old pipe"), strict=True):
        obj.Label = label
    for dock in person.present(person.widgets.QDockWidget):
        if dock.objectName() in ("Combo View", "Model", "Tree view"):
            dock.show()
    person.idle(0.4)
    person.look()
    person.gui.Selection.clearSelection()
    return wall_and_pipe


def outside(pipe):
    areas = [face.Area for face in pipe.Shape.Faces]
    return f"Face{areas.index(max(areas)) + 1}"


def preview_count(person):
    """Return how many previews are in the scene."""
    scene = person.gui.activeDocument().activeView().getSceneGraph()
    return sum(
        str(scene.getChild(index).getName()) == preview.NAME
        for index in range(scene.getNumChildren())
    )


def previewed(person, panel):
    def text():
        note = person.field(panel, "preview")
        return note.text() if note.isVisible() and note.text().startswith("First layer: ") else ""

    return person.until(text, "the preview", 60)


def press_button(person, hand, name="Ok"):
    button_kind = getattr(person.widgets.QDialogButtonBox, name)
    boxes = [box for box in person.present(person.widgets.QDialogButtonBox) if box.isVisible()]
    hand.click(
        next(box.button(button_kind) for box in boxes if box.button(button_kind) is not None)
    )
    person.panel_closed()


def test_a_wall_by_the_mouse(person, hand, bend, tmp_path):
    wall, pipe = bend
    document, steps = wall.Document, wall.Document.UndoCount
    console = person.window.findChild(person.widgets.QPlainTextEdit, "Python console")
    earlier_calls = console.toPlainText().count("make_surface_feature")  # calls of earlier tests
    assert person.screen_pixels(ORANGE) == 0
    hand.click_face(wall, "Face1")
    assert [
        (entry.Object, entry.SubElementNames) for entry in person.gui.Selection.getSelectionEx()
    ] == [(wall, ("Face1",))]
    hand.click_tree("Old pipe", "ctrl")
    hand.click(person.button("RoboticAM_WallOnPart"))
    panel = person.panel(PANEL)
    assert [person.field(panel, name).text() for name in ("Source", "Substrate")] == [
        "Bend on it Face1",
        "Old pipe",
    ]
    assert "closed, 97.4 mm" in previewed(person, panel)
    assert person.screen_pixels(ORANGE) > 150
    assert (set(document.Objects), document.UndoCount, preview_count(person)) == (
        set(bend),
        steps,
        1,
    )  # nothing exists yet
    hand.enter(panel, "LayerHeight", "5 mm")
    previewed(person, panel)
    person.screenshot("panel_wall_on_part")
    console_text = console.toPlainText()
    press_button(person, hand)
    assert preview_count(person) == 0
    feature = document.getObject("Feature")
    assert (feature.LayerHeight.Value, feature.Status, document.UndoCount) == (
        5.0,
        "up to date",
        steps + 1,
    )
    assert (feature.Source, feature.Substrate) == ((wall, ["Face1"]), pipe)
    assert person.screen_pixels(ORANGE) > 150  # the finished feature draws its own first layer
    person.screenshot("wall_on_part")

    key = feature.Key
    person.gui.getMainWindow().activateWindow()
    hand.undo()
    assert set(document.Objects) == set(bend) and person.screen_pixels(ORANGE) == 0
    console = console.toPlainText()
    assert console_text.count("make_surface_feature") == earlier_calls
    hand.redo()
    assert document.Feature.Key == key and person.screen_pixels(ORANGE) > 150
    call = (
        console[console.rindex("am.make_surface_feature(") :].split("\n>>>")[0].replace("\n", " ")
    )
    again = eval(call, {"App": App, "am": api})
    assert again.Key == key  # the recorded call gives the same

    document.removeObject(again.Name)
    document.saveAs(str(tmp_path / "bend.FCStd"))
    App.closeDocument(document.Name)
    opened = App.openDocument(str(tmp_path / "bend.FCStd"))
    person.idle(0.4)
    assert opened.Feature.Key == key and opened.Feature.Status == "up to date"
    person.look()
    assert person.screen_pixels(ORANGE) > 150
    assert opened.Feature.ViewObject.Proxy.wall.faces.triangles.coordIndex.getNum() > 100


def test_without_a_selection_the_panel_waits_for_clicks(person, hand, bend):
    wall, pipe = bend
    document, steps = wall.Document, wall.Document.UndoCount
    hand.click(person.button("RoboticAM_WallOnPart"))
    panel = person.panel(PANEL)
    assert person.field(panel, "PickSource").isChecked()
    hand.click_face(wall, "Face1")
    assert person.field(panel, "Source").text() == "Bend on it Face1"
    assert person.gui.Selection.getSelection() == []
    hand.click_face(wall, "Face1")  # a second click removes it
    assert person.field(panel, "Source").text() == ""
    hand.click_face(wall, "Face1")
    hand.click_face(pipe, outside(pipe))  # can only be the substrate
    assert person.field(panel, "Substrate").text() == "Old pipe"
    previewed(person, panel)
    hand.click(person.field(panel, "ClearSubstrate"))
    person.until(
        lambda: "Substrate is missing" in person.field(panel, "preview").text(),
        "what is missing",
        5,
    )
    assert person.screen_pixels(ORANGE) == 0
    hand.click(person.field(panel, "PickSubstrate"))
    hand.click_face(pipe, outside(pipe))
    assert (
        person.field(panel, "Substrate").text() == "Old pipe"
        and not person.field(panel, "PickSubstrate").isChecked()
    )
    previewed(person, panel)
    press_button(person, hand, "Cancel")
    assert (set(document.Objects), document.UndoCount, preview_count(person)) == (
        set(bend),
        steps,
        0,
    )
    assert person.screen_pixels(ORANGE) == 0
    person.gui.Selection.addSelection(wall)  # the panel no longer observes the selection
    person.idle()


def test_an_error_goes_with_its_entry_however_soon_the_next_is_typed(person, bend, monkeypatch):
    monkeypatch.setattr(
        worker, "WAIT", 1500
    )  # the delay before the panel checks an entry; previews start sooner
    wall, pipe = bend
    person.select(wall)
    person.gui.Selection.addSelection(pipe)
    person.click("RoboticAM_WallOnPart")
    panel = person.panel(PANEL)
    previewed(person, panel)
    note = person.field(panel, "LayerHeightNote")
    person.type(panel, "LayerHeight", "rubbish")
    person.until(lambda: note.isVisible() and "not understood" in note.text(), "the note", 5)
    person.idle(2.0)
    person.type(panel, "LayerHeight", "0.000001 mm")
    person.until(
        lambda: note.isVisible() and "use at least" in note.text(),
        "the note",
        10,
    )
    person.type(panel, "LayerHeight", "5 mm")
    previewed(person, panel)
    person.until(lambda: not note.isVisible(), "that the note goes", 5)


def test_errors_stand_under_the_field_they_belong_to(person, bend):
    wall, pipe = bend
    person.select(wall)
    person.gui.Selection.addSelection(pipe)
    person.click("RoboticAM_WallOnPart")
    panel = person.panel(PANEL)
    previewed(person, panel)
    person.type(panel, "LayerHeight", "-3 mm")
    note = person.field(panel, "LayerHeightNote")
    person.until(lambda: note.isVisible() and "more than 0 mm" in note.text(), "the note", 5)
    person.type(panel, "LayerHeight", "rubbish")
    person.until(lambda: note.isVisible() and "not understood" in note.text(), "the note", 5)
    person.screenshot("panel_wall_error")
    person.type(panel, "LayerHeight", "0.000001 mm")
    person.until(
        lambda: note.isVisible() and "use at least" in note.text(),
        "the note",
        10,
    )
    person.type(panel, "LayerHeight", "5 mm")
    previewed(person, panel)
    person.until(lambda: not note.isVisible(), "that the note goes", 10)
    block = wall.Document.addObject("Part::Box", "Far")
    block.Placement.Base = App.Vector(500, 0, 0)
    wall.Document.recompute()
    person.field(panel, "ClearSubstrate").click()
    person.field(panel, "PickSubstrate").click()
    person.gui.Selection.addSelection(block)
    person.until(
        lambda: any(
            " Far" in label.text() and label.isVisible()
            for label in panel.findChildren(person.widgets.QLabel)
        ),
        "what is wrong with the far block",
        10,
    )
    person.press("Cancel")
    person.panel_closed()


def test_an_existing_wall_is_changed_with_a_preview_and_cancelled_without_a_trace(person, bend):
    wall, pipe = bend
    feature = api.make_surface_feature(wall.Document, wall, ["Face1"], pipe, layer_height=5)
    key, steps = feature.Key, wall.Document.UndoCount
    person.double_click(feature)
    panel = person.panel(PANEL)
    assert person.field(panel, "Substrate").text() == "Old pipe"
    previewed(person, panel)
    person.type(panel, "LayerHeight", "2 mm")
    person.press("Cancel")
    person.panel_closed()
    assert (feature.Key, wall.Document.UndoCount, preview_count(person)) == (key, steps, 0)
    person.double_click(feature)
    person.type(person.panel(PANEL), "LayerHeight", "2 mm")
    person.press("Ok")
    person.panel_closed()
    assert feature.LayerHeight.Value == 2.0 and wall.Document.UndoCount == steps + 1
    person.double_click(feature)
    previewed(person, person.panel(PANEL))
    App.closeDocument(wall.Document.Name)  # the panel outlives its document
    person.idle(0.6)
    if person.gui.Control.activeDialog():
        person.press("Cancel")


def test_a_panel_goes_with_its_document_whatever_is_clicked_then(person, bend):
    wall, _ = bend
    other_document = App.newDocument("Other")
    ball = other_document.addObject("Part::Sphere", "Ball")
    other_document.recompute()
    App.setActiveDocument(wall.Document.Name)
    person.gui.Selection.clearSelection()
    person.click("RoboticAM_WallOnPart")
    person.panel(PANEL)
    App.closeDocument(wall.Document.Name)
    person.gui.Selection.addSelection(ball)  # a traceback in the report view would fail the test
    person.panel_closed()


def test_a_disabled_tool_says_what_is_missing(person, bend):
    person.click("RoboticAM_WallOnPart")
    person.until(
        lambda: "First close the task panel" in person.button("RoboticAM_WallOnPart").toolTip(),
        "the tooltip",
        5,
    )
    person.press("Cancel")
    person.panel_closed()
    person.until(
        lambda: "First" not in person.button("RoboticAM_WallOnPart").toolTip(), "the tooltip", 5
    )
    for name in list(App.listDocuments()):
        App.closeDocument(name)
    person.until(
        lambda: "First open a part" in person.button("RoboticAM_WallOnPart").toolTip(),
        "the tooltip",
        5,
    )


def test_a_preview_that_lacks_memory_says_what_to_do(person, bend, monkeypatch):
    from freecad_am.objects import surface_feature

    def too_much(*_):
        raise MemoryError("Unable to allocate 444. PiB")

    wall_on = surface_feature.wall_on
    monkeypatch.setattr(surface_feature, "wall_on", too_much)
    wall, pipe = bend
    person.select(wall, "Face1")
    person.gui.Selection.addSelection(pipe)
    person.click("RoboticAM_WallOnPart")
    panel = person.panel(PANEL)
    note = person.field(panel, "preview")
    person.until(
        lambda: "use larger steps" in note.text(),
        "the advice",
        10,
    )
    assert "MemoryError" not in note.text()
    monkeypatch.setattr(surface_feature, "wall_on", wall_on)
    person.type(panel, "LayerHeight", "4 mm")
    previewed(person, panel)
    person.press("Cancel")
    person.panel_closed()


def test_a_scan_is_a_substrate_and_a_mesh_alone_a_wall(person, bend):
    import Mesh

    solid_wall, _ = bend
    scan = solid_wall.Document.addObject("Mesh::Feature", "Scan")
    scan.Mesh = Mesh.createBox(10.0, 10.0, 10.0)
    person.select(scan)
    person.gui.Selection.addSelection(solid_wall)
    person.click("RoboticAM_WallOnPart")
    panel = person.panel(PANEL)
    assert [person.field(panel, name).text() for name in ("Source", "Substrate")] == [
        "Bend on it",
        "Scan",
    ]
    person.field(panel, "ClearSource").click()
    person.field(panel, "PickSource").click()
    person.gui.Selection.addSelection(scan)
    person.idle()
    assert person.field(panel, "Source").text() == "Scan"
    person.press("Cancel")
    person.panel_closed()
    tube = solid_wall.Document.addObject("Mesh::Feature", "Vase")
    tube.Mesh = Mesh.createCylinder(10.0, 30.0, 0, 5.0, 30)
    person.select(tube)
    person.click("RoboticAM_WallOnPart")
    panel = person.panel(PANEL)
    assert [person.field(panel, name).text() for name in ("Source", "Substrate")] == ["Vase", ""]
    previewed(person, panel)
    person.press("Ok")
    person.panel_closed()
    wall = solid_wall.Document.ActiveObject
    assert wall.WallKind == "mesh" and wall.Source[0] == tube


def test_a_body_in_an_assembly_carries_a_linked_wall_beside_fixtures(person):
    document = App.newDocument("Assembly")
    assembly = document.addObject("App::Part", "Assembly")
    assembly.Placement = App.Placement(App.Vector(5, 0, 0), App.Rotation(App.Vector(0, 1, 0), 90))
    body, pipe = (
        document.addObject("PartDesign::Body", "Body"),
        document.addObject("PartDesign::AdditiveCylinder", "Pipe"),
    )
    assembly.addObject(body)
    body.addObject(pipe)
    pipe.Radius, pipe.Height = 30, 100
    branch, link = (
        document.addObject("Part::Cylinder", "Branch"),
        document.addObject("App::Link", "Link"),
    )
    branch.Radius, branch.Height = 12, 60
    link.LinkedObject = branch
    link.Placement.Base = App.Vector(50, 0, 0)
    clamps = [document.addObject("Part::Box", name) for name in ("Clamp", "Other")]
    for clamp in clamps:
        clamp.Placement.Base = App.Vector(200, 0, 0)
    document.recompute()
    person.gui.Selection.addSelection(document.Name, link.Name, "Face1")
    person.gui.Selection.addSelection(document.Name, assembly.Name, "Body.Pipe.Face1")
    person.click("RoboticAM_WallOnPart")
    panel = person.panel(PANEL)
    assert [person.field(panel, name).text() for name in ("Source", "Substrate")] == [
        "Link",
        "Body",
    ]
    person.field(panel, "PickFixtures").click()
    for clamp in clamps:
        person.gui.Selection.addSelection(clamp)
        person.idle()
    assert person.field(panel, "Fixtures").text() == "Clamp, Other"
    person.gui.Selection.addSelection(clamps[0])  # removes it
    person.idle()
    previewed(person, panel)
    person.press("Ok")
    person.panel_closed()
    feature = document.Feature
    assert (feature.Status, feature.Substrate, feature.Fixtures) == (
        "up to date",
        body,
        [clamps[1]],
    )
    first_curves = api.result(feature).first
    on_pipe = np.hypot(first_curves[:, 1], first_curves[:, 2])
    assert (
        np.abs(np.hypot(first_curves[:, 0] - 50, first_curves[:, 1]) - 12).max() < 1e-6
        and np.abs(on_pipe - 30).max() < 1e-6
    )
    console_length = len(person.console())
    document.recompute()
    assert "scope" not in person.console()[console_length:]


def test_a_wall_that_starts_at_an_edge_needs_no_substrate(person):
    document = App.newDocument("Edge")
    tube = document.addObject("Part::Cylinder", "Tube")
    tube.Radius, tube.Height = 15, 40
    document.recompute()
    low, high = (
        next(
            f"Edge{number}"
            for number, edge in enumerate(tube.Shape.Edges, start=1)
            if edge.Closed and abs(edge.CenterOfMass.z - height) < 1e-6
        )
        for height in (0, 40)
    )
    person.select(tube, "Face1", low)
    person.click("RoboticAM_WallOnPart")
    panel = person.panel(PANEL)
    texts = [person.field(panel, name).text() for name in ("Source", "Substrate", "StartEdges")]
    assert texts == ["Tube", "", f"Tube {low}"]
    person.type(panel, "LayerHeight", "5 mm")
    assert "closed, 94." in previewed(person, panel)
    person.press("Ok")
    person.panel_closed()
    feature = document.Feature
    assert np.abs(api.result(feature).first[0].points[:, 2]).max() < 1e-9
    person.double_click(feature)
    panel = person.panel(PANEL)
    person.field(panel, "ClearStartEdges").click()
    person.field(panel, "PickStartEdges").click()
    person.gui.Selection.addSelection(document.Name, tube.Name, high)
    person.idle()
    person.press("Ok")
    person.panel_closed()
    assert (
        feature.StartEdges == (tube, [high])
        and np.abs(api.result(feature).first[0].points[:, 2] - 40).max() < 1e-9
    )
