# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panels show words and full names for the keys in documents, and no field that the machine does
not use."""

import math

import pytest
from PySide import QtGui

from freecad_am import api
from freecad_am.core.kinematics.proposed_cell import cell_of
from freecad_am.gui.in_language import as_in_panels
from freecad_am.gui.panels import proposed_job

pytestmark = pytest.mark.gui

OF_ROBOTS = (
    "Method",
    "Degree",
    "Objective",
    "MinCondition",
    "RotationRangeLow",
    "RotationRangeHigh",
)
OF_TABLES = ("Lock", "LockAt", "MaxResidual")


@pytest.fixture
def cells(hemisphere):
    """Return a toolpath with a robot's cell, and a cell of a five-axis machine."""
    document = hemisphere.Document
    robot = api.make_cell(document)
    toolpath = api.make_toolpath(
        document, api.make_feature(document, hemisphere, layer_height=15, chord_error=0.5), robot
    )
    return toolpath, robot, api.make_cell(document, machine="table-xyzac", setup="rotary-table")


def shown_fields(person, panel, names):
    """Return those of some fields that belong to the panel, in open or closed groups."""
    return {name for name in names if not person.field(panel, name).parentWidget().isHidden()}


def test_machines_have_their_full_names(person, hemisphere):
    person.click("RoboticAM_Cell")
    panel = person.panel("RoboticAM_Cell")
    machine = person.field(panel, "Machine")
    names = {machine.itemText(row) for row in range(machine.count())}
    assert {"KUKA KR 16-2", "Yaskawa AR1440 (arc welding)"} <= names and "kuka-kr16-2" not in names
    assert machine.currentText().startswith("FANUC ARC Mate 120iC")
    person.choose(panel, "Machine", "KUKA KR 16-2")
    person.press("Ok")
    person.panel_closed()
    assert hemisphere.Document.Cell.Machine == "kuka-kr16-2"  # the name in job files and macros
    person.double_click(hemisphere.Document.Cell)
    panel = person.panel("RoboticAM_Cell")
    assert person.field(panel, "Machine").currentText() == "KUKA KR 16-2"
    person.press("Ok")
    person.panel_closed()
    assert hemisphere.Document.Cell.Machine == "kuka-kr16-2"


def test_fields_away_from_the_heading_of_their_group_name_it(person, cells):
    """Such a field needs the name of its group: two advanced fields were called 'Ramp', and 'Lead',
    'First' and 'Zero' did not say of what."""
    person.double_click(cells[0])
    panel = person.panel("RoboticAM_Toolpath")
    labels = [label.text() for label in panel.findChildren(QtGui.QLabel)]
    assert {"Start, ramp", "End, ramp", "Cooling, gain (1/°C)", "Material, source", "Weave"} <= set(
        labels
    )
    assert not {"Ramp", "Gain (1/°C)", "Zero", "Source"} & set(labels)
    person.press("Cancel")
    person.panel_closed()
    assert (
        as_in_panels("use a shorter program.trigger.lead", str) == "use a shorter “Trigger, lead”"
    )


def test_warnings_of_a_job_that_is_ready_are_pointed_to(person, hemisphere):
    document = hemisphere.Document
    feature, cell = (
        api.make_feature(document, hemisphere, layer_height=5),
        api.make_cell(document, limits="paper"),
    )
    toolpath = api.make_toolpath(document, feature, cell)
    path = api.make_joint_path(document, toolpath, cell)
    assert "are not deposited" in toolpath.Message
    proposed_job.report_next_steps([cell, feature, toolpath, path])
    assert (
        "Read the warnings first: double-click Toolpath."
        in person.window.statusBar().currentMessage()
    )


def test_any_part_of_a_machine_s_name_offers_it(person, hand, hemisphere):
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    machine = person.field(person.panel("RoboticAM_NewJob"), "Machine")
    assert (
        machine.itemText(machine.currentIndex()) == machine.currentText()
    )  # the list opens at the chosen entry
    hand.click(machine.lineEdit())
    hand.do("key", "ctrl+a")
    hand.do("type", "--delay", "20", "4600")
    offered = machine.completer().popup()
    person.until(offered.isVisible, "what is offered", 5)
    person.screenshot("machines_offered")
    rows = [str(offered.model().index(row, 0).data()) for row in range(offered.model().rowCount())]
    assert len(rows) == 3 and all(row.startswith("ABB IRB 4600-") for row in rows)
    hand.do("key", "Down", "Down", "Return")
    assert machine.currentText() == rows[1] and machine.currentData() == "abb-irb4600-40-255"
    person.press("Cancel")
    person.panel_closed()


def test_a_joint_path_has_the_fields_of_its_machine(person, cells):
    toolpath, _, table = cells
    person.select(toolpath)
    person.click("RoboticAM_JointPath")
    panel = person.panel("RoboticAM_JointPath")
    assert shown_fields(person, panel, (*OF_ROBOTS, *OF_TABLES)) == set(OF_ROBOTS)
    method = person.field(panel, "Method")
    assert [method.itemText(row) for row in range(3)] == [
        "layer by layer",
        "point by point",
        "constant",
    ]
    assert shown_fields(person, panel, ("Degree", "Rz")) == {"Degree"}
    person.choose(panel, "Method", "constant")
    assert shown_fields(person, panel, ("Degree", "Rz")) == {"Rz"}
    person.choose(panel, "InputCell", table.Label)
    assert shown_fields(person, panel, OF_TABLES) == set(OF_TABLES)
    assert shown_fields(person, panel, OF_ROBOTS) == {
        "Method"
    }  # its value differs from the default, so it stays visible
    person.press("Cancel")
    person.panel_closed()


def test_a_cell_has_the_fields_of_its_set_up(person, cells):
    """A tool on the robot has a pose on it and external axes; a platform on the robot or positioner
    has its own pose."""
    _, robot, table = cells
    names = ("NozzleTool", "External", "Platform")
    person.double_click(robot)
    panel = person.panel("RoboticAM_Cell")
    assert shown_fields(person, panel, names) == {"Platform"}
    person.choose(panel, "Setup", "tool on robot")
    assert shown_fields(person, panel, names) == {"NozzleTool", "External"}
    person.type(panel, "External", "motoman-motopos-d500 at 1500 0 0 0 0 0 carries part")
    person.until(
        lambda: shown_fields(person, panel, names) == set(names),
        "the platform of the positioner",
        5,
    )
    person.press("Cancel")
    person.panel_closed()
    person.double_click(table)
    assert shown_fields(person, person.panel("RoboticAM_Cell"), names) == {"Platform"}
    person.press("Cancel")
    person.panel_closed()


def test_keys_are_words_and_short_lengths_show_the_unit_that_is_typed(person, hemisphere):
    document = hemisphere.Document
    feature = api.make_feature(document, hemisphere, spacing="iso-height", layer_height=15)
    person.double_click(feature)
    panel = person.panel("RoboticAM_RevolutionFeature")
    spacing = person.field(panel, "Spacing")
    assert spacing.currentText() == "along the axis" and spacing.itemText(0) == "along the wall"
    person.press("Cancel")
    person.panel_closed()
    from freecad_am.core.parameters.strategy import SurfaceParameters
    from freecad_am.gui.widgets import fields
    from freecad_am.objects.fields.rows import rows

    tolerance = next(row for row in rows(SurfaceParameters) if row.key == "tolerance")
    field = fields.make(tolerance, tolerance.default)
    assert field.widget.text() == "100 nm" and field.value == 1e-4 and not field.changed
    field.widget.lineEdit().setText("250")  # without a unit, the number has the unit shown before
    assert math.isclose(field.value, 2.5e-4, rel_tol=1e-12) and field.changed


def test_the_first_entry_of_a_program_s_menu_reads_it(person, hemisphere, coarse):
    """FreeCAD prints the first entry bold, because a double click does the same."""
    api.make_all(hemisphere.Document, hemisphere)
    program = hemisphere.Document.Program
    menu = person.widgets.QMenu()
    program.ViewObject.Proxy.setupContextMenu(program.ViewObject, menu)
    menu.actions()[0].trigger()
    person.idle(0.2)
    text = person.panel("RoboticAM_ProgramText")
    assert "/PROG" in person.field(text, "text").toPlainText()
    text.close()


def test_a_machine_without_a_post_is_told_as_it_is_chosen(person, hemisphere):
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    post_note = person.field(panel, "no_post")
    assert not post_note.isVisible()
    person.choose(panel, "Machine", "kuka-kr16-2")
    setup = person.field(panel, "Setup")
    assert (
        setup.currentData() == "tool-on-robot" and not post_note.isVisible()
    )  # the machine of its programs
    person.choose(panel, "Setup", "part-on-robot")
    assert post_note.isVisible() and "no program is written" in post_note.text()
    person.choose(panel, "Machine", "table-xyzac")
    assert not post_note.isVisible()
    person.press("Cancel")
    person.panel_closed()


def test_what_may_be_chosen_is_read_whole_in_a_narrow_panel(person, cells):
    toolpath, robot, _ = cells
    for stage, panel_name, names in (
        (toolpath, "RoboticAM_Toolpath", ("Direction",)),
        (robot, "RoboticAM_Cell", ("Setup", "Branch")),
    ):
        person.double_click(stage)
        panel = person.panel(panel_name)
        for name in names:
            box = person.field(panel, name)
            style, option = box.style(), person.widgets.QStyleOptionComboBox()
            box.initStyleOption(option)
            room = style.subControlRect(
                style.CC_ComboBox, option, style.SC_ComboBoxEditField, box
            ).width()
            widest = max((box.itemText(row) for row in range(box.count())), key=len)
            assert (
                box.fontMetrics().boundingRect(widest).width() < room or "positioner" in widest
            ), (name, widest, room)
        person.screenshot(f"choices-{panel_name}")
        person.press("Cancel")
        person.panel_closed()


def test_a_machine_without_a_post_gets_none_proposed(person, hemisphere, no_remedies):
    document = hemisphere.Document
    feature = api.make_feature(document, hemisphere, layer_height=15, chord_error=0.5)
    for machine, setup, post, motion in (
        ("kuka-kr16-2", "part-on-robot", "none", "joint"),
        ("kuka-kr16-2", "tool-on-robot", "kuka", "cartesian"),
        ("staubli-tx2-60l", "part-on-robot", "staubli", "joint"),
        ("fanuc-arcmate120ic", "part-on-robot", "fanuc", "joint"),
    ):
        cell = api.make_cell(document, parameters=cell_of(machine, (), setup))
        toolpath = api.make_toolpath(document, feature, cell)
        person.select(api.make_joint_path(document, toolpath, cell))
        person.click("RoboticAM_Program")
        panel = person.panel("RoboticAM_Program")
        assert person.field(panel, "Post").currentText() == post
        assert person.field(panel, "Motion").currentData() == motion
        person.press("Cancel")
        person.panel_closed()
