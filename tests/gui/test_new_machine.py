# SPDX-License-Identifier: LGPL-2.1-or-later
"""The wizard of a new machine, by mouse and keys: every source, poses from a pendant, their errors,
the file."""

import json
import os

import FreeCAD as App
import numpy as np
import pytest

from freecad_am.core.kinematics import external
from freecad_am.core.kinematics.machines import draft, machine, pendant
from freecad_am.core.kinematics.urdf import text as urdf_text
from freecad_am.kdl import KdlArm
from freecad_am.objects import user_machines
from freecad_am.objects.fields import preferences
from tests.core.kinematics import urdf_cells
from tests.core.kinematics.arms import mount_on_track

NAME = "RoboticAM_NewMachine"


@pytest.fixture
def wizard(person):
    from freecad_am.gui.machine_wizard import wizard as module

    person.click("RoboticAM_NewMachine")
    dialog = person.panel(NAME)
    yield dialog
    for path in (
        os.path.join(folder, name)
        for folder in user_machines.folders()
        for name in os.listdir(folder)
    ):
        os.remove(path)
    for open_wizard in list(module._open):
        open_wizard._confirm_discard = lambda: True
        open_wizard.close()
    person.idle()


@pytest.fixture
def broken(tmp_path):
    """Return a folder of the preferences with a file that is not a machine."""
    (tmp_path / "broken.json").write_text('{"id": "broken", ', encoding="utf-8")
    group = App.ParamGet(preferences.GROUP)
    group.SetString("MachineFolder", str(tmp_path))
    yield
    group.RemString("MachineFolder")


def page(wizard):
    return wizard.currentPage().objectName()


def go_on(person, hand, wizard, expected):
    hand.click(wizard.button(person.widgets.QWizard.NextButton))
    error = person.field(wizard.currentPage(), "error")
    assert page(wizard) == expected, error.text()


def refused(person, hand, wizard, button="NextButton"):
    original_page = page(wizard)
    hand.click(wizard.button(getattr(person.widgets.QWizard, button)))
    assert page(wizard) == original_page
    error = person.field(wizard.currentPage(), "error")
    assert error.isVisible()
    return error.text()


def type_row(person, hand, table, row, values, column=0):
    """Click the first cell, type, and continue with Tab."""
    table.scrollTo(table.model().index(row, column))
    cell_centre = table.visualRect(table.model().index(row, column)).center()
    where = table.viewport().mapToGlobal(cell_centre)
    hand.at((where.x(), where.y()))
    for value in values:
        hand.do("type", "--delay", "8", "--", f"{value:.10g}")
        hand.do("key", "Tab")


def fill(table, values, column=0, row=0):
    """Paste numbers, as from a spreadsheet."""
    from PySide import QtGui

    QtGui.QApplication.clipboard().setText(
        "\n".join("\t".join(f"{value:.10g}" for value in line) for line in values)
    )
    table.setCurrentCell(row, column)
    table.paste()


def pendant_poses(name="fanuc-arcmate120ic", count=4, convention=draft.FANUC):
    """Return joints and poses as the pendant shows them, rounded like its display."""
    arm = machine.load(name)
    joint_values = np.random.default_rng(5).uniform(-70, 70, (count, 6)).round(2)
    joint_values[0] = np.degrees(arm.controller_offset)
    poses = np.linalg.inv(arm.base) @ arm.chain.forward(
        arm.from_controller(np.radians(joint_values))
    )
    return np.column_stack((joint_values, draft.figures_of(convention, poses).round(3)))


def test_a_fanuc_from_its_urdf_checked_by_its_pendant(person, hand, wizard, tmp_path):
    arm = machine.load("fanuc-arcmate120ic")
    path = tmp_path / "arm.urdf"
    path.write_text(urdf_text.text(arm), encoding="utf-8")
    assert page(wizard) == "SourcePage"
    assert "choose a URDF file" in refused(person, hand, wizard)
    hand.enter(wizard, "file", str(path))
    assert person.field(wizard, "tipLink").currentText() == "tool0"
    person.screenshot("machine_1_source")
    go_on(person, hand, wizard, "LimitsPage")
    table = person.field(wizard, "limits")
    assert [table.item(0, column).text() for column in range(5)] == ["-170", "170", "195", "", ""]
    type_row(person, hand, table, 1, [-95.0])
    person.screenshot("machine_2_limits")
    go_on(person, hand, wizard, "FramesPage")
    assert person.field(wizard, "frames").item(0, 2).text() == "525"
    person.screenshot("machine_3_frames")
    go_on(person, hand, wizard, "PosesPage")
    assert "needs at least 3" in refused(person, hand, wizard)
    poses = person.field(wizard, "poses")
    figures = pendant_poses()
    type_row(person, hand, poses, 0, figures[0])
    for row in (1, 2, 3):
        fill(poses, figures[row : row + 1], row=row)
    verdict = person.field(wizard, "verdict")
    person.until(lambda: "Possible causes:" in verdict.text(), "the verdict")
    assert "does not reproduce the poses" in refused(person, hand, wizard)
    offer = person.field(wizard, "suspect0")
    assert offer.text() == "Axis 3 is shown relative to the horizontal"
    person.screenshot("machine_4_poses_wrong")
    hand.click(offer)
    person.until(
        lambda: "reproduces all 4 poses" in verdict.text(), "the machine to give its poses"
    )
    person.screenshot("machine_5_poses_right")
    go_on(person, hand, wizard, "NamePage")
    person.type(wizard, "machineTitle", "")
    assert refused(person, hand, wizard, "FinishButton").startswith(
        "Manufacturer and model: the field is empty"
    )
    hand.enter(wizard, "machineTitle", "FANUC of hall 3")
    assert person.field(wizard, "machineName").text() == "fanuc-of-hall-3"
    assert "only as reliable as its check poses" in refused(person, hand, wizard, "FinishButton")
    hand.enter(wizard, "poseSource", "pendant")
    hand.click(person.field(wizard, "post_fanuc"))
    person.screenshot("machine_6_name")
    hand.click(wizard.button(person.widgets.QWizard.FinishButton))
    person.until(
        lambda: user_machines.folders() and os.listdir(user_machines.folders()[0]), "the file"
    )
    new_machine = machine.load("fanuc-of-hall-3", user_machines.folders())
    q = np.random.default_rng(1).uniform(-2, 2, (20, 6))
    np.testing.assert_allclose(new_machine.chain.forward(q), arm.chain.forward(q), atol=1e-9)
    np.testing.assert_allclose(new_machine.to_controller(q), arm.to_controller(q), atol=1e-12)
    np.testing.assert_allclose(new_machine.base, arm.base)
    assert new_machine.posts == ("fanuc",) and np.degrees(
        new_machine.limits("maker").lower[1]
    ) == pytest.approx(-95.0)
    # the machine is available at once
    App.newDocument("Cell")
    person.click("RoboticAM_Cell")
    panel = person.panel("RoboticAM_Cell")
    person.choose(panel, "Machine", "fanuc-of-hall-3")
    person.press("Ok")
    person.panel_closed()
    assert App.ActiveDocument.Cell.MachineTitle == "FANUC of hall 3"


def test_a_file_that_is_no_machine_hinders_no_cell(person, broken):
    App.newDocument("Cell")
    person.click("RoboticAM_Cell")
    panel = person.panel("RoboticAM_Cell")
    person.choose(panel, "Machine", "broken")
    person.until(
        lambda: "cannot be read as a machine file" in person.panel_error(panel), "what is wrong", 5
    )
    person.choose(panel, "Machine", "kuka-kr16-2")
    person.press("Ok")
    person.panel_closed()
    assert App.ActiveDocument.Cell.Machine == "kuka-kr16-2"


def test_a_file_that_is_no_machine_hinders_no_copy(person, hand, broken, wizard):
    person.choose(wizard, "source", "A copy of another machine")
    box = person.field(wizard, "original")
    box.setCurrentIndex(box.findData("broken"))
    assert "cannot be read as a machine file" in refused(person, hand, wizard)
    box.setCurrentIndex(box.findData("kuka-kr16-2"))
    go_on(person, hand, wizard, "LimitsPage")


def test_a_copy_keeps_its_poses_and_a_name_that_is_taken_is_refused(person, hand, wizard):
    person.choose(wizard, "source", "A copy of another machine")
    box = person.field(wizard, "original")
    box.setCurrentIndex(box.findData("kuka-kr16-2"))
    for expected in ("LimitsPage", "FramesPage", "PosesPage"):
        go_on(person, hand, wizard, expected)
    assert "reproduces all" in person.field(wizard, "verdict").text()
    go_on(person, hand, wizard, "NamePage")
    hand.enter(wizard, "machineName", "kuka-kr16-2")
    assert "a machine 'kuka-kr16-2' already exists" in refused(person, hand, wizard, "FinishButton")
    hand.enter(wizard, "machineName", "Große Kuka")
    assert refused(person, hand, wizard, "FinishButton").startswith(
        "Name in jobs: 'Große Kuka' cannot be the name"
    )
    hand.enter(wizard, "machineName", "big-kuka")
    hand.click(wizard.button(person.widgets.QWizard.FinishButton))
    new_machine = machine.load("big-kuka", user_machines.folders())
    assert (
        new_machine.opw == machine.load("kuka-kr16-2").opw
        or new_machine.opw.c2 == machine.load("kuka-kr16-2").opw.c2
    )
    file = os.path.join(user_machines.folders()[0], "big-kuka.json")
    with open(file, encoding="utf-8") as text:
        assert json.load(text)["sources"][0] == "copy of kuka-kr16-2"


def test_figures_with_a_wrong_sign_are_found_out(person, hand, wizard):
    arm = machine.load("staubli-tx60")
    person.choose(wizard, "source", "Dimensions of an arm with a spherical wrist (OPW)")
    lengths = [getattr(arm.opw, name) for name in ("a1", "a2", "b", "c1", "c2", "c3", "c4")]
    type_row(person, hand, person.field(wizard, "opwLengths"), 0, lengths)
    signs = np.array(arm.opw.signs) * [1, 1, 1, 1, -1, 1]
    fill(person.field(wizard, "opwTurns"), [np.degrees(arm.opw.offsets), signs])
    for expected in ("LimitsPage", "FramesPage", "PosesPage"):
        go_on(person, hand, wizard, expected)
    person.choose(
        wizard,
        "convention",
        next(f"{figures}   {who}" for figures, who in [draft.CONVENTIONS[draft.STAUBLI]]),
    )
    figures = pendant_poses("staubli-tx60", convention=draft.STAUBLI)
    fill(person.field(wizard, "poses"), figures)
    verdict = person.field(wizard, "verdict")
    person.until(lambda: "Possible causes:" in verdict.text(), "the verdict")
    offer = "J5: reversed sign, and the base frame is offset by 0, 0, 375 mm and rotated by 0 deg"
    assert person.field(wizard, "suspect0").text() == offer
    hand.click(person.field(wizard, "suspect0"))
    person.until(
        lambda: "reproduces all 4 poses" in verdict.text(), "the machine to give its poses"
    )
    hand.click(wizard.button(person.widgets.QWizard.BackButton))
    assert page(wizard) == "FramesPage" and person.field(wizard, "axes").item(0, 4).text() == "-1"
    hand.click(wizard.button(person.widgets.QWizard.NextButton))
    assert "reproduces all 4 poses" in verdict.text()  # the poses stay


def test_tables_are_read_and_what_is_no_arm_is_refused_with_the_reason(person, hand, wizard):
    from freecad_am.core.kinematics.machines import denavit_hartenberg as dh

    person.choose(wizard, "source", "A table of Denavit and Hartenberg")
    table = dh.table_of(machine.load("kuka-kr6-r900-2").chain)
    rows = np.array(
        [[np.degrees(row.theta), row.d, row.a, np.degrees(row.alpha), 1] for row in table.rows]
    )
    offset = rows.copy()
    # axes 4 and 5 no longer meet, and the package has no inverse kinematics for that
    offset[3, 2] += 30.0
    fill(person.field(wizard, "dhTable"), offset)
    ends = person.field(wizard, "dhEnds")
    from freecad_am.core.geometry import frames

    fill(
        ends,
        [
            [*pose[:3, 3], *np.degrees(-frames.to_bryant(pose[:3, :3].T))]
            for pose in (table.before, table.after)
        ],
    )
    assert "the wrist is not spherical, and axes 4 and 5 do not meet" in refused(
        person, hand, wizard
    )
    type_row(person, hand, person.field(wizard, "dhTable"), 3, [rows[3, 2]], column=2)
    person.screenshot("machine_1_table")
    go_on(person, hand, wizard, "LimitsPage")
    type_row(person, hand, person.field(wizard, "limits"), 0, [10.0, -10.0])
    assert "10 is not below -10" in refused(person, hand, wizard)
    # Escape closes it after a question, and nothing is left
    questions = person.will_answer("Discard")
    hand.do("key", "Escape")
    hand.do("key", "Escape")
    from freecad_am.gui.machine_wizard import wizard as module

    person.until(lambda: not module._open, "the wizard to close")
    assert len(questions) == 1
    assert not user_machines.folders() or not os.listdir(user_machines.folders()[0])


def test_a_machine_tool_from_its_table(person, hand, wizard):
    from freecad_am.core.geometry import frames
    from freecad_am.core.kinematics.machines import denavit_hartenberg as dh

    person.choose(wizard, "source", "A table of Denavit and Hartenberg")
    tool = machine.load("table-xyzac")
    table = dh.table_of(tool.chain)
    rows = [
        [np.degrees(row.theta), row.d, row.a, np.degrees(row.alpha), row.sign, row.sliding]
        for row in table.rows
    ]
    table_widget = person.field(wizard, "dhTable")
    fill(table_widget, rows)
    for column in range(6):  # a machine tool has five axes
        table_widget.item(5, column).setText("")
    ends = [
        [*pose[:3, 3], *np.degrees(-frames.to_bryant(pose[:3, :3].T))]
        for pose in (table.before, table.after)
    ]
    fill(person.field(wizard, "dhEnds"), ends)
    go_on(person, hand, wizard, "LimitsPage")
    limits = person.field(wizard, "limits")
    assert limits.rowCount() == 5 and limits.verticalHeaderItem(0).text() == "joint_1 (mm)"
    assert "a prismatic axis needs a range" in refused(person, hand, wizard)
    fill(
        limits,
        [
            [-500, 500, 200],
            [-500, 500, 200],
            [-300, 700, 200, 900, 8000],
            [-120, 120, 90, 400, 5000],
        ],
    )
    go_on(person, hand, wizard, "FramesPage")
    go_on(person, hand, wizard, "PosesPage")
    values = np.array(
        [[0, 0, 0, 0, 0], [10, 20, 30, 40, 50], [-15, 25, -35, 45, -55], [100, -90, 80, -70, 60]],
        float,
    )
    poses = tool.chain.forward(values * tool.unit_values)
    fill(
        person.field(wizard, "poses"),
        np.column_stack((values, draft.figures_of(draft.FANUC, poses))),
    )
    verdict = person.field(wizard, "verdict")
    person.until(
        lambda: "reproduces all 4 poses" in verdict.text(), "the machine to give its poses"
    )
    go_on(person, hand, wizard, "NamePage")
    hand.enter(wizard, "machineTitle", "Trunnion")
    hand.enter(wizard, "poseSource", "controller")
    hand.click(wizard.button(person.widgets.QWizard.FinishButton))
    new_machine = machine.load("trunnion", user_machines.folders())
    assert (
        not new_machine.free
        and new_machine.opw is None
        and np.isinf(new_machine.limits("maker").upper[4])
    )
    np.testing.assert_allclose(
        new_machine.max_acceleration, [np.inf, np.inf, 900, np.radians(400), np.inf]
    )
    np.testing.assert_allclose(
        new_machine.max_jerk, [np.inf, np.inf, 8000, np.radians(5000), np.inf]
    )
    np.testing.assert_allclose(
        new_machine.chain.forward(values), tool.chain.forward(values), atol=1e-6
    )


def test_what_a_pendant_shows_is_what_the_wizard_reads():
    arm = machine.load("fanuc-arcmate120ic")
    convention = pendant.Shown((1,) * 6, (0.0,) * 6, pendant.HORIZONTAL)
    figures = pendant_poses(count=6)
    poses = draft.flange_poses(draft.FANUC, figures[:, 6:], arm.base, np.eye(4))
    assert pendant.fits(pendant.deviations(arm.chain, convention, figures[:, :6], poses))


def test_what_was_entered_is_not_lost_without_a_question(person, hand, wizard):
    hand.do("key", "Escape")
    person.until(lambda: not person.present(person.widgets.QWizard), "the empty wizard to close")
    person.click("RoboticAM_NewMachine")
    wizard = person.panel(NAME)
    hand.click(person.field(wizard, "source"))
    hand.do("key", "End", "Return")
    questions = person.will_answer("Cancel")
    hand.do("key", "Escape")
    person.until(lambda: questions, "the question")
    assert "lost" in questions[0] and wizard.isVisible() and page(wizard) == "SourcePage"
    go_on(person, hand, wizard, "LimitsPage")
    questions = person.will_answer("Cancel")
    hand.click(wizard.button(person.widgets.QWizard.CancelButton))
    person.until(lambda: questions, "the question")
    assert wizard.isVisible() and page(wizard) == "LimitsPage"
    questions = person.will_answer("Discard")
    hand.click(wizard.button(person.widgets.QWizard.CancelButton))
    person.until(lambda: not person.present(person.widgets.QWizard), "the wizard to close")
    assert len(questions) == 1


def test_a_robot_on_its_track_begins_with_the_robot(person, hand, wizard, tmp_path):
    path = tmp_path / "rail.urdf"
    path.write_text(mount_on_track(urdf_text.text(machine.load("abb-irb140"))), encoding="utf-8")
    hand.enter(wizard, "file", str(path))
    base = person.field(wizard, "baseLink")
    assert base.currentText() == "carriage"  # proposed
    person.choose(wizard, "baseLink", "base_link")
    assert "the first axis is prismatic and carries the six revolute axes, like a track" in refused(
        person, hand, wizard
    )
    person.choose(wizard, "baseLink", "carriage")
    go_on(person, hand, wizard, "LimitsPage")
    assert person.field(wizard, "limits").rowCount() == 6


def test_a_defective_urdf_is_called_by_its_name_and_quaternions_are_seen_whole(
    person, hand, wizard, tmp_path
):
    path = tmp_path / "arm.urdf"
    path.write_text(
        urdf_text.text(machine.load("abb-irb140")).replace("</joint>", "</jonit>", 1),
        encoding="utf-8",
    )
    hand.enter(wizard, "file", str(path))
    assert person.field(wizard.currentPage(), "error").text().startswith("arm.urdf: line ")
    path.write_text(urdf_text.text(machine.load("abb-irb140")), encoding="utf-8")
    hand.enter(wizard, "file", str(path.with_name("none.urdf")))
    hand.enter(wizard, "file", str(path))
    for name in ("LimitsPage", "FramesPage", "PosesPage"):
        go_on(person, hand, wizard, name)
    convention = person.field(wizard, "convention")
    convention.setCurrentIndex(convention.findText("quaternion", person.core.Qt.MatchContains))
    person.idle()
    poses = person.field(wizard, "poses")
    type_row(person, hand, poses, 0, [-0.408248] * 4, column=9)
    person.screenshot("machine_7_quaternions")
    for column in range(9, 13):
        item = poses.item(0, column)
        assert item.text() == "-0.408248"
        assert (
            poses.visualItemRect(item).width()
            > poses.fontMetrics().boundingRect(item.text()).width() + 6
        )


def test_a_positioner_out_of_the_urdf_of_a_whole_cell(person, hand, wizard, tmp_path):
    path = tmp_path / "cell.urdf"
    box = '<collision><origin xyz="0 0 0.1"/><geometry><box size="0.4 0.5 0.2"/></geometry></collision>'
    path.write_text(
        urdf_cells.whole_cell().replace(
            '<link name="positioner_base_link"/>', f'<link name="positioner_base_link">{box}</link>'
        ),
        encoding="utf-8",
    )
    hand.enter(wizard, "file", str(path))
    mechanism = person.field(wizard, "mechanism")
    assert [mechanism.itemText(row) for row in range(mechanism.count())] == [
        "Robot",
        "Track",
        "Positioner",
    ]
    base, tip = person.field(wizard, "baseLink"), person.field(wizard, "tipLink")
    assert (base.currentText(), tip.currentText()) == ("robot_base_link", "robot_tool0")
    person.choose(wizard, "mechanism", "Positioner")
    assert (base.currentText(), tip.currentText()) == ("positioner_base_link", "positioner_tool0")
    person.screenshot("machine_8_positioner")
    go_on(person, hand, wizard, "LimitsPage")
    assert person.field(wizard, "limits").rowCount() == 2
    messages = " ".join(
        label.text() for label in wizard.currentPage().findChildren(person.widgets.QLabel)
    )
    assert "NAME at 1400 50 -56 0 0 22.9183118052 carries part" in messages
    go_on(person, hand, wizard, "FramesPage")
    go_on(person, hand, wizard, "PosesPage")
    expected = external.load("motoman-motopos-d500")
    values = np.array([[0, 0], [30, 90], [-100, -170]], float)
    poses = KdlArm(expected).forward(np.radians(values))
    fill(
        person.field(wizard, "poses"),
        np.column_stack((values, draft.figures_of(draft.FANUC, poses))),
    )
    person.until(
        lambda: "reproduces all 3 poses" in person.field(wizard, "verdict").text(),
        "the mechanism to give its poses",
    )
    go_on(person, hand, wizard, "NamePage")
    hand.enter(wizard, "machineTitle", "Table 7")
    hand.enter(wizard, "poseSource", "pendant")
    hand.click(wizard.button(person.widgets.QWizard.FinishButton))
    new_positioner = external.load("table-7", user_machines.folders())
    ((fixed_body,), tilt, table) = new_positioner.bodies
    np.testing.assert_allclose(
        [fixed_body.points.min(axis=0), fixed_body.points.max(axis=0)],
        [[-200, -250, 0], [200, 250, 200]],
    )
    assert (tilt, table) == ((), ())
    q = np.random.default_rng(3).uniform(-2, 2, (30, 2))
    np.testing.assert_allclose(
        new_positioner.chain.forward(q), expected.chain.forward(q), atol=1e-6
    )
