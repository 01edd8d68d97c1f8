# SPDX-License-Identifier: LGPL-2.1-or-later
"""A selected hemisphere becomes a program by clicks."""

from dataclasses import replace

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.kinematics.proposed_cell import cell_of
from freecad_am.gui import program_window, registry


def test_from_a_selected_shape_to_a_program_by_clicks(person, hemisphere):
    sphere, doc = hemisphere, hemisphere.Document

    person.click("RoboticAM_Cell")
    panel = person.panel("RoboticAM_Cell")
    person.type(panel, "Limits", "paper")
    person.screenshot("panel_cell")
    person.press("Ok")
    person.panel_closed()
    assert [(obj.Label, obj.Limits, obj.Status) for obj in api.stages_of(doc)] == [
        ("Cell", "paper", "up to date")
    ]
    assert api.result(doc.Cell) == replace(
        cell_of(""), limits="paper"
    )  # the panel keeps every digit

    person.select(sphere)
    person.click("RoboticAM_Feature")
    panel = person.panel("RoboticAM_RevolutionFeature")
    assert person.field(panel, "Source").text() == sphere.Label
    person.type(panel, "LayerHeight", "0.5 cm")
    person.screenshot("panel_feature")
    person.press("Ok")
    person.panel_closed()
    assert doc.Feature.LayerHeight.Value == 5.0

    person.click("RoboticAM_Toolpath")
    person.screenshot("panel_toolpath")
    person.press("Ok")
    person.panel_closed()
    assert doc.Toolpath.Layers == 15
    assert not sphere.ViewObject.Visibility  # the path is in its surface
    person.path_is_seen()
    person.screenshot("toolpath")

    person.click("RoboticAM_JointPath")
    person.screenshot("panel_joint_path")
    person.press("Ok")
    person.panel_closed()
    assert doc.JointPath.Status == "up to date"

    person.click("RoboticAM_Program")
    panel = person.panel("RoboticAM_Program")
    person.type(panel, "ProgramName", "CUP")
    person.press("Ok")
    person.panel_closed()
    assert doc.Program.Status == "up to date"
    assert "CUP.LS" in doc.Program.Files
    person.look()
    person.screenshot("program_made")

    person.double_click(doc.Program)
    panel = person.panel("RoboticAM_ProgramText")
    text = person.field(panel, "text").toPlainText()
    assert text.startswith("/PROG") and text.encode("latin-1") in api.result(doc.Program).files[
        "CUP.LS"
    ].replace(b"\r", b"")
    person.screenshot("program_text")
    person.field(panel, "close").click()
    assert np.isfinite(api.result(doc.JointPath).motion.joints).all()


def test_new_job_makes_all_stages_in_one_step_of_undo(person, hemisphere, coarse):
    doc = hemisphere.Document
    person.select(hemisphere, "Face1")
    person.click("RoboticAM_NewJob")
    person.screenshot("panel_new_job")
    person.as_revolution()
    person.press("Ok")
    person.panel_closed()
    assert [obj.Status for obj in api.stages_of(doc)] == ["up to date"] * 5
    assert doc.Feature.Source[1] == []  # a clicked face selects the whole part
    person.look()
    person.screenshot("new_job")
    undo = doc.UndoCount
    person.gui.runCommand("Std_Undo")
    assert api.stages_of(doc) == [] and doc.UndoCount == undo - 1
    person.gui.runCommand("Std_Redo")
    person.idle()
    assert [obj.Status for obj in api.stages_of(doc)] == ["up to date"] * 5
    assert min(person.path_pixels()) > 100


def test_without_a_selection_the_panel_says_what_to_do(person, hemisphere):
    doc = hemisphere.Document
    person.gui.Selection.clearSelection()
    person.click("RoboticAM_Feature")
    panel = person.panel("RoboticAM_RevolutionFeature")
    state = person.field(panel, "preview")
    person.until(lambda: "Select the shape" in state.text(), "what to do", 5)
    person.press("Ok")
    assert "Source is missing" in person.panel_error(panel) and doc.UndoCount == 0
    person.select(hemisphere)
    person.field(panel, "UseSource").click()
    person.press("Ok")
    person.panel_closed()
    assert doc.Feature.Status == "up to date"


def test_a_tool_without_its_input_is_greyed_and_says_what_to_make_first(person, hemisphere):
    for command, words in (
        ("Toolpath", "First make a feature"),
        ("JointPath", "First make a feature"),
        ("Path", "First make a toolpath"),
        ("Simulate", "First make a joint path"),
        ("Program", "First make a joint path"),
    ):
        button = person.button(f"RoboticAM_{command}")
        person.until(
            lambda button=button, words=words: not button.isEnabled() and words in button.toolTip(),
            f"{command} to say {words}",
            5,
        )
        person.gui.runCommand(
            f"RoboticAM_{command}"
        )  # a shortcut or macro gives the same message and opens nothing
        assert not person.gui.Control.activeDialog()
    assert api.stages_of(hemisphere.Document) == []


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("LayerHeight", "-1 mm", "more than 0 mm"),
        ("LayerHeight", "rubbish", "'rubbish' is not understood"),
        ("LayerHeight", "3 deg", "not understood"),
        ("LayerHeight", "500 mm", "500 mm exceeds the length of the wall"),
    ],
)
def test_what_is_wrong_is_told_in_the_panel_and_nothing_is_made(
    person, hemisphere, name, text, message
):
    doc = hemisphere.Document
    person.select(hemisphere)
    person.click("RoboticAM_Feature")
    panel = person.panel("RoboticAM_RevolutionFeature")
    person.type(panel, name, text)
    person.press("Ok")
    if text == "500 mm":  # only the planner of the layers knows the limit
        person.panel_closed()
        person.click("RoboticAM_Toolpath")
        panel = person.panel("RoboticAM_Toolpath")
        person.press("Ok")
        assert doc.getObject("Toolpath") is None
    else:
        assert doc.getObject("Feature") is None and doc.UndoCount == 0
    assert message in person.panel_error(panel)
    person.screenshot("panel_error")
    person.press("Cancel")
    person.panel_closed()


def test_a_double_click_changes_parameters_in_one_step_of_undo(person, hemisphere):
    doc = hemisphere.Document
    cell = api.make_cell(doc)
    feature = api.make_feature(doc, hemisphere, layer_height=5)
    toolpath = api.make_toolpath(doc, feature, cell)
    keys = [obj.Key for obj in (feature, toolpath)]
    person.double_click(feature)
    panel = person.panel("RoboticAM_RevolutionFeature")
    person.type(panel, "LayerHeight", "10 mm")
    person.choose(panel, "Spacing", "iso-height")
    person.press("Ok")
    person.panel_closed()
    assert (feature.LayerHeight.Value, feature.Spacing, toolpath.Status) == (
        10.0,
        "iso-height",
        "up to date",
    )
    layer_count = toolpath.Layers
    assert layer_count < 10 and len(api.result(toolpath).layers) == layer_count
    person.gui.runCommand("Std_Undo")
    assert (feature.LayerHeight.Value, feature.Spacing, toolpath.Layers) == (5.0, "arc-length", 15)
    assert [obj.Key for obj in (feature, toolpath)] == keys and toolpath.Status == "up to date"
    assert len(api.result(toolpath).layers) == 15
    person.gui.runCommand("Std_Redo")
    assert (toolpath.Layers, toolpath.Status) == (layer_count, "up to date")


def test_the_panel_of_every_stage_opens_and_ok_without_a_change_does_nothing(
    person, hemisphere, coarse
):
    doc = hemisphere.Document
    stages = api.make_all(doc, hemisphere)
    steps, keys = doc.UndoCount, [obj.Key for obj in stages]
    for obj in stages:
        registry.edit(obj)
        panel = person.panel(f"RoboticAM_{type(obj.Proxy).__name__}")
        assert "up to date" in person.field(panel, "findings").text()
        for fold in panel.findChildren(person.widgets.QToolButton):
            if fold.objectName().startswith("Fold"):
                fold.setChecked(True)
        person.screenshot(f"edit_{obj.Name}")
        person.press("Ok")
        person.panel_closed()
    assert doc.UndoCount == steps and [obj.Key for obj in stages] == keys


def test_deleting_an_input_is_told_by_what_follows(person, hemisphere, coarse):
    doc = hemisphere.Document
    api.make_all(doc, hemisphere)
    person.select(doc.Toolpath)
    questions = person.will_answer("Yes")
    person.gui.runCommand("Std_Delete")
    person.idle()
    assert len(questions) == 1 and "Joint path" in questions[0]  # FreeCAD's own question
    assert doc.getObject("Toolpath") is None
    assert doc.JointPath.Status == "failed" and "Toolpath is missing" in doc.JointPath.Message
    doc.recompute()
    assert (doc.JointPath.Status, doc.Program.Status) == ("failed", "failed")
    person.gui.runCommand("Std_Undo")
    doc.recompute()
    assert [obj.Status for obj in api.stages_of(doc)] == ["up to date"] * 5


def test_inputs_and_the_name_can_be_changed_in_the_panel(person, hemisphere, coarse):
    doc = hemisphere.Document
    _, feature, toolpath, _, program = api.make_all(doc, hemisphere, name="CUP")
    other_cell = api.make_cell(doc, "Other cell", platform_diameter=100)
    registry.edit(toolpath)
    person.choose(person.panel("RoboticAM_Toolpath"), "InputCell", "Other cell")
    person.press("Ok")
    person.panel_closed()
    assert toolpath.Cell == other_cell and toolpath.Feature == feature
    registry.edit(program)
    panel = person.panel("RoboticAM_Program")
    person.type(panel, "ProgramName", "not a name")
    person.press("Ok")
    assert (
        "cannot be a program's name" in person.panel_error(panel) and program.ProgramName == "CUP"
    )
    person.type(panel, "ProgramName", "MUG")
    person.press("Ok")
    person.panel_closed()
    assert "MUG.LS" in program.Files and program.Status == "up to date"


def test_a_line_turned_about_an_axis_by_clicks(person):
    doc = App.newDocument("Line")
    wall, axis = doc.addObject("Part::Line", "Wall"), doc.addObject("Part::Line", "AxisLine")
    wall.X1, wall.Z1, wall.X2, wall.Z2 = 30, 0, 40, 50
    axis.X1, axis.Z1, axis.X2, axis.Z2 = 0, 0, 0, 50
    doc.recompute()
    person.select(wall)
    person.click("RoboticAM_Feature")
    panel = person.panel("RoboticAM_RevolutionFeature")
    person.press("Ok")
    assert person.panel_error(panel)  # a line has no axis
    person.select(axis, "Edge1")
    person.field(panel, "UseAxis").click()
    person.press("Ok")
    person.panel_closed()
    assert doc.Feature.Status == "up to date" and doc.Feature.Axis == (axis, ["Edge1"])


def test_errors_of_a_recompute_are_one_line_each_in_the_report_view(person, hemisphere):
    doc = hemisphere.Document
    feature = api.make_feature(doc, hemisphere, layer_height=10)
    api.make_toolpath(doc, feature)
    feature.LayerHeight = 0
    person.gui.runCommand("Std_Refresh")
    person.idle()
    assert [obj.Status for obj in api.stages_of(doc)] == ["failed", "failed"]
    lines = [
        line
        for line in person.console().splitlines()
        if "error[BAD_VALUE] Feature.LayerHeight" in line
    ]
    assert len(lines) == 1
    feature.LayerHeight = 20
    person.gui.runCommand("Std_Refresh")
    assert [obj.Status for obj in api.stages_of(doc)] == ["up to date", "up to date"]


def test_the_program_is_exported_from_its_window(person, hemisphere, coarse, tmp_path, monkeypatch):
    doc = hemisphere.Document
    program = api.make_all(doc, hemisphere, name="CUP")[-1]
    api.change(program, max_points=100)
    assert len(program.Files) > 3
    folder = tmp_path / "Dossier d'été"
    monkeypatch.setattr(person.widgets.QFileDialog, "getExistingDirectory", lambda *_: str(folder))
    person.double_click(program)
    window = person.panel("RoboticAM_ProgramText")
    for name in sorted(program.Files):
        person.choose(window, "file", name)
        assert (
            person.field(window, "text")
            .toPlainText()
            .startswith("/PROG  " + name.removesuffix(".LS"))
        )
    assert person.field(window, "text").isReadOnly()
    person.field(window, "export").click()
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == api.result(program).files
    assert str(folder) in person.field(window, "state").text()
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(
        person.widgets.QFileDialog, "getExistingDirectory", lambda *_: str(tmp_path / "file")
    )
    person.field(window, "export").click()
    assert "choose a writable folder" in person.field(window, "state").text()
    App.closeDocument(doc.Name)
    person.field(window, "export").click()
    assert "document is closed" in person.field(window, "state").text()
    person.field(window, "close").click()


def test_a_program_that_failed_asks_for_no_folder(person, hemisphere, coarse, monkeypatch):
    questions, doc = [], hemisphere.Document
    monkeypatch.setattr(
        person.widgets.QFileDialog, "getExistingDirectory", lambda *_: questions.append(1) or ""
    )
    program = api.make_all(doc, hemisphere, name="CUP")[-1]
    person.double_click(program)
    button = person.field(person.panel("RoboticAM_ProgramText"), "export")
    assert (
        button.isEnabled() and button.toolTip() == "Writes all files of the program into a folder"
    )
    api.change(doc.Feature, layer_height=1e9)
    assert program.Status == "failed"
    person.until(lambda: not button.isEnabled(), "the button to be grey", 5)
    assert (
        "no program matches its inputs" in button.toolTip()
        and "exceeds the length of the wall" in button.toolTip()
    )
    console_length = len(person.console())
    # from the context menu
    assert "no program matches its inputs" in program_window.export(program)
    person.until(
        lambda: "no program matches its inputs" in person.console()[console_length:],
        "why, in the report view",
        5,
    )
    assert not questions
    api.change(doc.Feature, layer_height=15)
    person.until(button.isEnabled, "the button to be lit", 5)
    program_window.export(program)
    assert questions == [1]
    person.field(button.window(), "close").click()


def test_the_open_window_of_a_program_follows_it(person, hemisphere, coarse):
    doc = hemisphere.Document
    program = api.make_all(doc, hemisphere, name="CUP")[-1]
    person.double_click(program)
    window = person.panel("RoboticAM_ProgramText")
    assert person.field(window, "text").toPlainText().startswith("/PROG  CUP")
    api.change(program, name="MUG")
    assert person.field(window, "text").toPlainText().startswith("/PROG  MUG")
    doc.Feature.LayerHeight = 2
    assert "do not run it. Status: stale" in person.field(window, "state").text()
    person.double_click(program)
    windows = person.present(person.widgets.QDialog, "RoboticAM_ProgramText")
    assert len([window for window in windows if window.isVisible()]) == 1
    person.gui.runCommand("Std_Undo")
    person.idle()
    assert person.field(window, "text").toPlainText().startswith("/PROG  CUP")
    person.field(window, "close").click()
    person.double_click(program)
    window = person.panel("RoboticAM_ProgramText")
    person.field(window, "close").click()


def test_a_new_job_that_cannot_be_carried_out_says_so_once(person, hemisphere, no_remedies):
    ring = hemisphere.Document.addObject("Part::Cylinder", "Ring")
    ring.Radius, ring.Height = 6000.0, 2.0
    hemisphere.Document.recompute()
    person.select(ring)
    person.click("RoboticAM_NewJob")
    person.as_revolution()
    console_length = len(person.console())
    person.press("Ok")
    person.panel_closed()
    joint_path = hemisphere.Document.JointPath
    assert joint_path.Status == "infeasible"
    # a value above the maximum would be rejected
    assert hemisphere.Document.Cell.PlatformDiameter.Value == 10_000.0
    lines = [
        line
        for line in person.console()[console_length:].splitlines()
        if joint_path.Message.rstrip(".") in line
    ]
    assert len(lines) == 1 and lines[0].endswith(f"Joint path is infeasible: {joint_path.Message}")
    assert (
        person.console()
        .rstrip()
        .endswith("Joint path is infeasible. Double-click a stage in the tree to change it.")
    )


def test_what_a_change_makes_impossible_is_told_in_the_report_view(
    person, hemisphere, coarse, no_remedies
):
    doc = hemisphere.Document
    api.make_all(doc, hemisphere)
    person.double_click(doc.Cell)
    panel = person.panel("RoboticAM_Cell")
    console_length = len(person.console())
    person.type(panel, "DepositionPointX", "3 m")
    person.press("Ok")
    person.panel_closed()
    assert (doc.Cell.Status, doc.JointPath.Status, doc.Program.Status) == (
        "up to date",
        "infeasible",
        "infeasible",
    )
    lines = [
        line
        for line in person.console()[console_length:].splitlines()
        if " is infeasible: " in line
    ]
    assert (
        len(lines) == 1
        and "Joint path is infeasible: layer 0" in lines[0]
        and "out of reach" in lines[0]
    )
