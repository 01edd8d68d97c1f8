# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shape and axis of a part of revolution by clicks: bodies, features, links and nested objects, in
the tree and the view."""

import FreeCAD as App
import Mesh
import Part
import pytest

from freecad_am import api
from tests.gui.nested_cone import nested_cone

V = App.Vector
PANEL = "RoboticAM_RevolutionFeature"


@pytest.fixture
def scene(person):
    """Return a cone of PartDesign in a moved and rotated part, with a link to it, a mesh, a profile
    and a box."""
    doc = App.newDocument("Inputs")
    _, body = nested_cone(doc, V(60, -20, 5), 30)
    link = doc.addObject("App::Link", "Link")
    link.LinkedObject = body
    link.Placement = App.Placement(V(0, 90, 0), App.Rotation(V(0, 1, 0), 20))
    mesh = doc.addObject("Mesh::Feature", "Scan")
    mesh.Mesh = Mesh.createSphere(5.0, 20)
    profile = doc.addObject("Sketcher::SketchObject", "Profile")
    profile.addGeometry(Part.LineSegment(V(20, 0, 0), V(30, 20, 0)))
    profile.Placement.Rotation = App.Rotation(V(1, 0, 0), 90)  # upright
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 20, 30, 40
    box.Placement.Base = V(-20, 0, -50)  # one of its edges is on the z axis
    doc.recompute()
    mesh.Placement.Base = V(-60, 60, 0)
    for dock in person.present(person.widgets.QDockWidget):
        if dock.objectName() in ("Combo View", "Model", "Tree view"):
            dock.show()
            dock.raise_()
    person.idle(0.4)
    person.look()
    person.gui.Selection.clearSelection()
    return doc


def pixel_of(person, hand, is_wanted, room=0):
    """Return a position on the screen where the 3D view reports the wanted element, and also around
    it within `room`, from a grid search."""
    view = person.gui.activeDocument().activeView()
    width, height = view.getSize()
    for step in (16, 7, 3):
        for y in range(8, height - 8, step):
            for x in range(8, width - 8, step):
                around = ((0, 0), (room, 0), (-room, 0), (0, room), (0, -room))[: 5 if room else 1]
                infos = (view.getObjectInfo((x + dx, y + dy)) for dx, dy in around)
                if all(info and is_wanted(info) for info in infos):
                    where = hand.corner(view) + person.core.QPoint(x, height - 1 - y)
                    if view.graphicsView().isAncestorOf(
                        person.widgets.QApplication.widgetAt(where)
                    ):
                        return where.x(), where.y()
    raise AssertionError("it is not to be seen")


def use(person, hand, panel, name):
    hand.click(person.field(panel, name))
    person.idle(0.2)


def turn_to(person, hand, title):
    """Click a tab next to the 3D view: FreeCAD shows the tree or the panel."""
    for bar in person.present(person.widgets.QTabBar):
        for k in range(bar.count() if bar.isVisible() else 0):
            if bar.tabText(k) == title:
                where = bar.mapToGlobal(bar.tabRect(k).center())
                hand.at((where.x(), where.y()))
                return


def click_tree(person, hand, label, *keys):
    """Click in the tree while the panel stays open, and return to the panel."""
    turn_to(person, hand, "Model")
    hand.click_tree(label, *keys)
    turn_to(person, hand, "Tasks")


def open_panel(person, hand):
    person.click("RoboticAM_Feature")
    panel = person.panel(PANEL)
    person.idle(0.6)  # until the view has made room for it
    return panel


def press_ok(person, hand):
    person.press("Ok")
    person.until(lambda: not person.gui.Control.activeDialog(), "the feature to be made", 30)


def test_a_face_clicked_in_an_assembly_is_a_face_of_its_body(person, hand, scene):
    panel = open_panel(person, hand)
    scene.Link.ViewObject.hide()
    scene.Box.ViewObject.hide()

    def is_on_body(info):
        return info["Object"] in ("Body", "Cone") and info["Component"].startswith("Face")

    for _ in range(3):  # if the view was still moving, as when a panel opens, a person clicks again
        hand.at(pixel_of(person, hand, is_on_body, 6))
        person.idle(0.5)
        if person.gui.Selection.getSelectionEx(scene.Name, 0):
            break
    picked = person.gui.Selection.getSelectionEx(scene.Name, 0)[0]
    assert picked.Object.Name == "Outer"
    use(person, hand, panel, "UseSource")
    assert person.field(panel, "Source").text().startswith("Body Face")
    press_ok(person, hand)
    owner, names = scene.Feature.Source
    assert owner == scene.Body and len(names) == 1
    path = picked.SubElementNames[0]
    global_face = picked.Object.getSubObject(path)
    own_face = scene.Body.Shape.getElement(names[0])
    assert abs(own_face.Area - global_face.Area) < 1e-9


def test_a_link_clicked_in_the_tree_is_deposited_where_it_stands(person, hand, scene):
    panel = open_panel(person, hand)
    click_tree(person, hand, "Link")
    use(person, hand, panel, "UseSource")
    assert person.field(panel, "Source").text() == "Link"
    press_ok(person, hand)
    wall = api.result(scene.Feature)
    axis = scene.Link.Placement.Rotation.multVec(V(0, 0, 1))
    assert scene.Feature.Source[0] == scene.Link and (V(*wall.frame[:3, 2]) - axis).Length < 1e-7


def test_an_edge_clicked_in_the_view_is_the_axis(person, hand, scene):
    person.select(scene.Profile)
    panel = open_panel(person, hand)
    assert person.field(panel, "Source").text() == "Profile"
    names = [
        f"Edge{k}"
        for k, edge in enumerate(scene.Box.Shape.Edges, 1)
        if edge.BoundBox.DiagonalLength == 40.0
    ]
    (edge,) = [
        name for name in names if scene.Box.Shape.getElement(name).BoundBox.Center == V(0, 0, -30)
    ]

    def in_its_middle(info):
        position = V(info["x"], info["y"], info["z"])  # far from vertices, which have priority
        return (info["Object"], info["Component"]) == ("Box", edge) and (
            position - V(0, 0, -30)
        ).Length < 8.0

    for _ in range(3):
        person.gui.Selection.clearSelection()
        # next to the edge, the click would select the face
        hand.at(pixel_of(person, hand, in_its_middle, room=2))
        person.idle(0.5)
        if [selected.SubElementNames for selected in person.gui.Selection.getSelectionEx()] == [
            (edge,)
        ]:
            break
    use(person, hand, panel, "UseAxis")
    assert person.field(panel, "Axis").text() == f"Box {edge}"
    press_ok(person, hand)
    assert scene.Feature.Axis == (scene.Box, [edge]) and scene.Feature.Status == "up to date"
    wall = api.result(scene.Feature)
    assert abs(abs(wall.frame[2, 2]) - 1.0) < 1e-9 and V(*wall.frame[:2, 3], 0).Length < 1e-9


def test_the_line_of_an_origin_deep_in_the_tree_is_the_axis(person, hand, scene):
    origin = next(obj for obj in scene.Body.Origin.OutList if obj.Role == "Z_Axis")
    person.select(scene.Profile)
    panel = open_panel(person, hand)
    person.gui.Selection.clearSelection()
    path = f"Body.{scene.Body.Origin.Name}.{origin.Name}."
    person.gui.Selection.addSelection(scene.Name, "Outer", path)  # as a click in the tree does
    use(person, hand, panel, "UseAxis")
    assert person.field(panel, "Axis").text() == origin.Label
    person.field(panel, "ClearAxis").click()
    assert person.field(panel, "Axis").text() == ""
    person.press("Cancel")
    person.panel_closed()


def test_an_axis_is_taken_away_again(person, hand, scene):
    sketch = scene.Profile
    feature = api.make_feature(scene, sketch, axis=(sketch, "H_Axis"))
    person.double_click(feature)
    panel = person.panel(PANEL)
    hand.click(
        next(
            button
            for button in panel.findChildren(person.widgets.QToolButton)
            if button.text() == "Inputs"
        )
    )
    assert person.field(panel, "Axis").text() == "Profile H_Axis"
    person.field(panel, "ClearAxis").click()
    press_ok(person, hand)
    assert not feature.Axis and feature.Status == "up to date"
    scene.undo()
    assert feature.Axis[0] == sketch


def test_what_cannot_be_taken_is_told_and_what_was_taken_stays(person, hand, scene):
    cell = api.make_cell(scene)
    table = scene.addObject("App::FeaturePython", "Table")  # a double click opens nothing
    person.select(scene.Body)
    panel = open_panel(person, hand)
    assert person.field(panel, "Source").text() == "Body"
    for obj, words in (
        (cell, "belongs to a job"),
        (table, "has no shape"),
        (scene.Scan, "is a mesh"),
    ):
        click_tree(person, hand, obj.Label)
        use(person, hand, panel, "UseSource")
        assert words in person.panel_error(panel) and person.field(panel, "Source").text() == "Body"
    person.gui.Selection.clearSelection()
    # with nothing selected, the panel takes the next click
    person.field(panel, "UseSource").click()
    assert person.field(panel, "UseSource").isChecked()
    click_tree(person, hand, "Link")
    person.idle(0.2)
    assert not person.field(panel, "UseSource").isChecked()
    assert person.panel_error(panel) == "" and person.field(panel, "Source").text() == "Link"
    click_tree(person, hand, "Scan")
    click_tree(person, hand, "Box", "ctrl")
    use(person, hand, panel, "UseFixtures")
    assert person.field(panel, "Fixtures").text() == "Scan, Box"
    click_tree(person, hand, cell.Label)
    use(person, hand, panel, "UseFixtures")
    assert "belongs to a job" in person.panel_error(panel)
    person.press("Cancel")
    person.panel_closed()
