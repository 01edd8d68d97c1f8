# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a program shows its first lines and totals, and what the controller rejects while
the user types."""

import dataclasses
import re
import threading
from types import SimpleNamespace

import pytest

from freecad_am import api
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.gui import registry
from freecad_am.gui.panels.program import SHOWN_LINES
from freecad_am.gui.widgets import suggestions

PANEL = "RoboticAM_Program"


@pytest.fixture
def joint_path(person, hemisphere):
    """Return a feasible joint path."""
    document = hemisphere.Document
    cell = api.make_cell(document)
    toolpath = api.make_toolpath(
        document, api.make_feature(document, hemisphere, layer_height=10), cell
    )
    path = api.make_joint_path(document, toolpath, cell)
    person.idle()
    return path


def wait_for_message(person, panel, words, seconds=20):
    state = person.field(panel, "preview")
    person.until(lambda: state.isVisible() and words in state.text(), words, seconds)
    return state.text()


def lines(person, panel):
    return person.field(panel, "FirstLines").toPlainText().splitlines()


def test_the_first_lines_are_those_that_are_written(person, hand, joint_path):
    document, steps = joint_path.Document, joint_path.Document.UndoCount
    person.select(joint_path)
    person.click("RoboticAM_Program")
    panel = person.panel(PANEL)
    hand.enter(panel, "ProgramName", "cup")
    text = wait_for_message(person, panel, "Begins with CUP.LS.")
    first_lines = lines(person, panel)
    assert person.field(panel, "FirstLines").isVisible()
    person.screenshot("program_preview")
    hand.enter(panel, "MaxPoints", "300")
    person.until(
        lambda: any("CALL CUP01" in line for line in lines(person, panel)), "calls of parts", 20
    )
    message = wait_for_message(person, panel, "Begins with CUP.LS.")
    assert document.UndoCount == steps and document.getObject("Program") is None
    begins = lines(person, panel)
    person.press("Ok")
    person.panel_closed()
    files = api.result(document.Program).files
    assert len(files) > 2 and document.UndoCount == steps + 1
    assert begins == files["CUP.LS"].decode().splitlines()[:SHOWN_LINES]
    count = sum(len(content.splitlines()) for content in files.values())
    assert f"Lines: {count}, files: {len(files)}" in message
    api.change(document.Program, max_points=2000)
    written = api.result(document.Program).files["CUP.LS"].decode().splitlines()
    assert len(first_lines) == SHOWN_LINES and first_lines == written[:SHOWN_LINES]
    minutes, seconds = divmod(document.JointPath.TotalTime, 60.0)
    assert f"Lines: {len(written)}, files: 1" in text
    assert (
        f"Time: {int(minutes)}:{int(seconds * 10) / 10:04.1f}" in text
        or f"Time: {int(minutes)}:{seconds:04.1f}" in text
    )
    assert f"mass: {document.JointPath.DepositMass:.1f} g" in text


def test_what_the_controller_refuses_is_told_beside_its_field_as_it_is_typed(
    person, hand, joint_path
):
    document = joint_path.Document
    program = api.make_program(document, joint_path, name="CUP", post="fanuc")
    key = program.Key
    person.gui.runCommand("Std_Refresh")
    registry.edit(program)
    panel = person.panel(PANEL)
    wait_for_message(person, panel, "Begins with CUP.LS.")
    for fold in ("FoldInputs", "FoldStartat"):
        hand.click(person.field(panel, fold))
    for name, text, words in (
        ("ProgramName", "1CUP", "a name must start with a letter"),
        ("Post", "siemens", "does not read siemens"),
        ("StartAtLayer", "99", "there is no bead 0 in a layer 99"),
    ):
        field = person.field(panel, name)
        was = field.currentText() if hasattr(field, "currentText") else field.text()
        hand.enter(panel, name, text)
        note = person.field(panel, f"{name}Note")
        person.until(
            lambda note=note, words=words: note.isVisible() and words in note.text(), words, 10
        )
        wait_for_message(person, panel, "see the marked field")
        assert (
            lines(person, panel) == [] and person.field(panel, "FirstLines").isVisible()
        )  # no field moves
        if name == "ProgramName":
            person.screenshot("program_name_refused")
        hand.enter(panel, name, was)
        wait_for_message(person, panel, "Begins with CUP.LS.")
        assert not note.isVisible()
    hand.enter(panel, "Post", "none")
    wait_for_message(person, panel, "Without a post no file is written.")
    person.press("Cancel")
    person.panel_closed()
    assert (program.Key, program.Status, program.ProgramName, program.Post) == (
        key,
        "up to date",
        "CUP",
        "fanuc",
    )
    person.until(
        lambda: not [thread for thread in threading.enumerate() if thread.name == "Robotic AM"],
        "the threads to end",
        10,
    )


def test_a_dry_run_deposits_nothing_and_a_later_start_is_shorter(person, joint_path):
    person.select(joint_path)
    person.click("RoboticAM_Program")
    panel = person.panel(PANEL)
    full_text = wait_for_message(person, panel, "mass: ")
    person.type(panel, "StartAtLayer", "5")
    person.until(lambda: wait_for_message(person, panel, "mass: ") != full_text, "less", 10)
    person.field(panel, "DryRun").setChecked(True)
    wait_for_message(person, panel, "dry run without deposit")
    person.press("Cancel")
    person.panel_closed()


def test_what_is_made_anew_beside_the_panel_is_seen_and_what_is_deleted_is_told(person, joint_path):
    document = joint_path.Document
    person.select(joint_path)
    person.click("RoboticAM_Program")
    panel = person.panel(PANEL)
    original_text = wait_for_message(person, panel, "Begins with")
    state = person.field(panel, "preview")
    document.Feature.LayerHeight = "15 mm"
    wait_for_message(
        person, panel, "Joint path is out of date; the preview shows its earlier state."
    )
    document.recompute()
    person.until(
        lambda: "Begins with" in state.text() and "out of date" not in state.text(),
        "what it is now",
        30,
    )
    assert state.text() != original_text
    document.removeObject(joint_path.Name)
    wait_for_message(person, panel, "No preview: see the marked field.")
    note = person.field(panel, "InputJointPathNote")
    assert (
        note.isVisible()
        and "JointPath is missing" in note.text()
        and "Error" not in state.text() + note.text()
    )
    person.press("Cancel")
    person.panel_closed()


def test_the_preflight_says_what_was_not_checked_and_a_click_goes_to_the_place(
    person, hand, joint_path
):
    document = joint_path.Document
    program = api.make_program(document, joint_path, name="CUP", post="fanuc")
    registry.edit(program)
    panel = person.panel(PANEL)
    wait_for_message(person, panel, "Preflight: ")
    promises = person.field(panel, "Preflight")
    lines = [promises.item(row) for row in range(promises.count())]
    marks = [line.text()[0] for line in lines]
    passed, broken, unchecked = map(marks.count, "✓✗?")
    assert passed + broken + unchecked == len(marks)
    assert wait_for_message(
        person, panel, f"Preflight: {passed} passed, {broken} failed, {unchecked} not checked"
    )
    text = next(line for line in lines if "The program moves the tool" in line.text())
    assert text.text().startswith("✓") and "mm" in text.text()
    speed = next(line for line in lines if "maximum speed" in line.text())
    layer = int(re.search(r"layer (\d+)", speed.text()).group(1))
    person.until(lambda: promises.isVisible(), "the preflight")
    hand.reveal(promises)
    promises.scrollToItem(speed)
    person.idle()
    centre = promises.viewport().mapToGlobal(promises.visualItemRect(speed).center())
    hand.at((centre.x(), centre.y()))
    person.until(lambda: joint_path.ViewObject.Proxy.shown is not None, "the path up to the place")
    assert joint_path.ViewObject.Proxy.shown[1] == layer
    person.screenshot("preflight")
    # a program with these new values has no read-back yet
    hand.enter(panel, "MaxPoints", "300")
    person.until(
        lambda: any(
            promises.item(row).text().startswith("? The program moves the tool")
            for row in range(promises.count())
        ),
        "a text that was not read back",
        20,
    )


@pytest.mark.parametrize(
    ("machine", "setup", "preferred", "shown"),
    [
        ("kuka-kr16-2", "tool-on-robot", "kuka", ("kuka", "cartesian")),
        ("kuka-kr16-2", "tool-on-robot", "", ("kuka", "cartesian")),
        ("kuka-kr16-2", "part-on-robot", "kuka", ("", "")),
        ("kuka-kr16-2", "part-on-robot", "", ("none", "")),
        ("abb-irb2400-12-155", "tool-on-robot", "abb", ("", "")),
        ("abb-irb2400-12-155", "tool-on-robot", "", ("abb", "joint")),
        ("fanuc-crx10ia", "part-on-robot", "", ("", "")),
        ("no-such-machine", "tool-on-robot", "kuka", ("", "")),
    ],
)
def test_a_new_program_is_shown_with_the_motion_that_its_controller_has(
    monkeypatch, machine, setup, preferred, shown
):
    """The program has joint moves like New Job's, because joint moves of KRL cannot keep a
    speed."""
    monkeypatch.setattr(suggestions.preferences, "post", lambda: preferred)
    settings = dataclasses.replace(CellParameters(), machine=machine, setup=setup)
    proxy = SimpleNamespace(parameters=lambda cell, kind: settings)
    assert suggestions.post_for(SimpleNamespace(Cell=SimpleNamespace(Proxy=proxy))) == shown
    assert (
        suggestions.post_for(None) == suggestions.post_for(SimpleNamespace(Cell=None)) == ("", "")
    )
