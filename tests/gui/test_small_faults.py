# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts, titles and sizes that have confused users."""

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.gui import registry
from freecad_am.gui.redundancy_map import dock as map_tool
from freecad_am.gui.simulation import wording
from freecad_am.gui.tools import commands, whats_this
from freecad_am.gui.widgets import choices, suggestions
from freecad_am.gui.widgets.fold import KEEP_MS

LABEL = "Cup & Co"


def test_one_finding_is_one():
    assert wording.count_of_findings(1) == "1 finding"
    assert wording.count_of_findings(2) == "2 findings"


def test_a_toolpath_asks_for_any_of_the_tools_that_make_features(person):
    document = App.newDocument("Empty")
    tools = [name for name in commands.GROUPS[1] if name != "Cell"]
    assert len(tools) == 6
    assert all(commands.TOOLS[name].text in whats_this.feature(document) for name in tools)


def test_the_status_bar_does_not_go_on_asking_for_what_is_there(person, hemisphere):
    bar, tool = person.window.statusBar(), commands.TOOLS["Toolpath"]
    assert not tool.IsActive()
    status_tip = person.button("RoboticAM_Toolpath").defaultAction().statusTip()
    assert "First make a feature" in status_tip
    bar.showMessage(status_tip)  # as with the pointer on it
    api.make_feature(hemisphere.Document, hemisphere, layer_height=15)
    assert tool.IsActive()
    assert bar.currentMessage() == ""
    bar.showMessage(status_tip)
    person.gui.runCommand("RoboticAM_Toolpath")
    assert bar.currentMessage() != status_tip
    person.press("Cancel")
    person.panel_closed()


def test_an_ampersand_of_a_label_marks_no_key(person, joint_path):
    document = joint_path.Document
    document.Toolpath.Label, joint_path.Label = LABEL, f"{LABEL}, planned"
    menu = person.widgets.QMenu()
    registry.fill_menu_of_stage(menu, joint_path)
    assert "Go to Cup && Co" in [action.text() for action in menu.actions()]
    person.double_click(joint_path)
    panel = person.panel("RoboticAM_JointPath")
    assert panel.windowTitle() == "Cup && Co, planned"
    person.press("Cancel")
    person.panel_closed()
    document.Label = LABEL
    person.select(joint_path)
    person.click("RoboticAM_Simulate")
    dock = person.panel("RoboticAM_Simulation")
    assert "Cup && Co, planned (Cup && Co)" in dock.windowTitle()
    dock.close()
    person.idle()


def test_the_path_of_a_file_is_read_in_the_panel_of_an_inspection(person, hemisphere):
    api.make_feature(hemisphere.Document, hemisphere, layer_height=15)
    person.click("RoboticAM_Inspect")
    panel = person.panel("RoboticAM_Inspection")
    assert person.field(panel, "FilePath").width() > 0.7 * panel.width()
    person.press("Cancel")
    person.panel_closed()


def test_the_map_has_words_for_its_fields(person, joint_path):
    person.select(joint_path)
    person.click("RoboticAM_SpinMap")
    dock = map_tool._open[0]
    labels = [label.text() for label in dock.controls.names if label.isVisible()]
    assert labels[0] == "RZ at the start" and not any(text.startswith("c") for text in labels)
    heads = [
        dock.figures.horizontalHeaderItem(column).text()
        for column in range(dock.figures.columnCount())
    ]
    assert "Criterion" in heads and not any("Eq" in text for text in heads)


@pytest.fixture
def needy():
    """A machine whose programs need the tool on the robot."""
    return next(
        name
        for name, _ in choices.machines()
        if "need the tool on the robot" in suggestions.no_post(name)
    )


def test_a_cell_with_the_tool_on_its_robot_is_not_told_to_put_it_there(person, hemisphere, needy):
    cell = api.make_cell(hemisphere.Document, machine=needy, setup="tool-on-robot")
    person.double_click(cell)
    panel = person.panel("RoboticAM_Cell")
    state = person.field(panel, "preview")
    person.until(lambda: "limit" in state.text() or "reach" in state.text(), "the preview", 20)
    assert "need the tool" not in state.text()
    person.choose(panel, "Setup", "part-on-robot")
    person.until(lambda: "need the tool" in state.text(), "that no program is written", 20)
    person.press("Cancel")
    person.panel_closed()


def test_a_note_that_has_gone_leaves_no_gap(person, hemisphere):
    person.select(hemisphere)
    person.click("RoboticAM_Feature")
    panel = person.panel("RoboticAM_RevolutionFeature")
    below = person.field(panel, "ChordError")

    def place():
        return below.mapTo(panel, person.core.QPoint(0, 0)).y()

    original_place = place()
    person.type(panel, "LayerHeight", "-1 mm")
    person.until(lambda: person.field(panel, "LayerHeightNote").isVisible(), "the note", 5)
    person.idle(0.2)
    assert place() > original_place
    person.type(panel, "LayerHeight", "2 mm")
    person.until(lambda: not person.field(panel, "LayerHeightNote").isVisible(), "its end", 5)
    assert place() > original_place  # the next click hits its target
    person.until(lambda: place() == original_place, "the gap to close", KEEP_MS / 1000.0 + 5)
    person.press("Cancel")
    person.panel_closed()


def test_the_panel_and_the_properties_of_a_program_show_what_its_post_reads(person, hemisphere):
    document = hemisphere.Document
    cell = api.make_cell(document, limits="paper")
    feature = api.make_feature(document, hemisphere, layer_height=15)
    toolpath = api.make_toolpath(document, feature, cell)
    program = api.make_program(document, api.make_joint_path(document, toolpath, cell), "CUP")
    person.idle(0.3)
    names = [name for name in program.PropertiesList if name.startswith("Nc")]
    assert len(names) == 9
    assert all(program.getEditorMode(name) == ["Hidden"] for name in names)
    program.Post = "siemens"
    person.idle(0.1)
    visible_names = {name for name in names if program.getEditorMode(name) == []}
    assert {
        "NcFeed",
        "NcCompress",
        "NcSmooth",
    } <= visible_names and "NcTolerance" not in visible_names
    program.Post = "fanuc"
    registry.edit(program)
    panel = person.panel("RoboticAM_Program")
    post = person.field(panel, "Post")
    assert person.field(panel, "NcFeed").isHidden() or not person.field(panel, "NcFeed").isVisible()
    fold = person.field(panel, "FoldNCmachines")
    assert not fold.isVisible()
    post.setEditText("siemens")
    person.idle(0.2)
    assert fold.isVisible()
    person.press("Cancel")
    person.panel_closed()


def test_rare_fields_of_long_panels_are_folded_until_they_are_changed(person):
    document = App.newDocument("Block")
    block = document.addObject("Part::Box", "Box")
    document.recompute()
    solid = api.make_solid_feature(document, block, layer_height=2)
    registry.edit(solid)
    panel = person.panel("RoboticAM_SolidFeature")
    assert not person.field(panel, "FillAngleStep").isVisible()
    assert person.field(panel, "BeadSpacing").isVisible()
    person.press("Cancel")
    person.panel_closed()
    api.change(solid, fill_angle_step=30)
    registry.edit(solid)
    assert person.field(person.panel("RoboticAM_SolidFeature"), "FillAngleStep").isVisible()
    person.press("Cancel")
    person.panel_closed()
