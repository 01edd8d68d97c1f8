# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a cell shows machine, platform and nozzle while they are entered, and proposes
values for a machine."""

import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.geometry import frames
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.proposed_cell import cell_of
from freecad_am.core.kinematics.urdf.cell import cell_values
from freecad_am.core.kinematics.urdf.reference import Reference
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.cell_records import EXTERNAL
from freecad_am.core.simulation.table_links import at_rest
from freecad_am.gui.nodes.cell import resting_point
from freecad_am.gui.panels import cell as cell_panel
from freecad_am.gui.panels import preview
from freecad_am.kdl import KdlArm
from freecad_am.objects.work.progress import Cancelled
from tests.core.kinematics import urdf_cells
from tests.gui.previews import drawn_by_previews

PANEL = "RoboticAM_Cell"
POINT = "DepositionPoint"


def previewed(person):
    """Return the poses (n, 4, 4) that previews draw: platform, nozzle, then the links of the
    machine, base first; None without a preview."""
    nodes = drawn_by_previews(person, "SoMatrixTransform")
    if nodes is None:
        return None
    poses = [node.matrix.getValue().getValue() for node in nodes]
    return np.array(poses).reshape(-1, 4, 4).transpose(0, 2, 1)


def wait_for_message(person, panel, words, seconds=10):
    state = person.field(panel, "preview")
    person.until(
        lambda: state.isVisible() and words in state.text(),
        f"{words}, not {state.text()!r}",
        seconds,
    )


def entered_point(person, panel):
    return [person.field(panel, f"{POINT}{axis}").property("rawValue") for axis in "XYZ"]


def stands_as(person, parameters, toolpath):
    """Return whether the preview shows the machine at PyKDL's pose, and the part at its position in
    the document."""
    drawn = previewed(person)
    cell = cells.resolve(parameters, np.eye(4) if toolpath is None else toolpath.frame)
    joints = at_rest(cell, resting_point(toolpath, cell.poses.mount))
    flange = KdlArm(cell.machine).forward([joints])[0]
    if drawn is None or len(drawn) != 9:
        return False
    if cell.setup == "tool-on-robot":
        tip = (drawn[2] @ flange @ cell.poses.carried)[:3, 3]
        return np.abs(tip - resting_point(toolpath, cell.poses.mount)).max() < 2e-3
    part_frame = drawn[2] @ flange @ cell.poses.carried @ frames.inverse(cell.poses.mount)
    return (
        np.abs(part_frame - np.eye(4)).max() < 2e-3
        and np.abs(drawn[0] - cell.poses.mount).max() < 1e-5
    )


@pytest.fixture
def planned(person, hemisphere):
    """Return a cell with a toolpath planned for it."""
    document = hemisphere.Document
    cell = api.make_cell(document)
    toolpath = api.make_toolpath(
        document, api.make_feature(document, hemisphere, layer_height=5), cell
    )
    person.idle()
    return cell, toolpath


def test_the_machine_moves_as_the_deposition_point_is_typed_and_cancel_puts_the_picture_back(
    person, hand, planned
):
    cell, toolpath = planned
    document, steps, path = cell.Document, cell.Document.UndoCount, api.result(toolpath)
    switch = cell.ViewObject.Proxy.switch
    switch_state, picture = (
        switch.whichChild.getValue(),
        cell.ViewObject.Proxy.nodes.nozzle.getChild(0).matrix.getValue().getValue(),
    )
    person.look()
    person.double_click(cell)
    panel = person.panel(PANEL)
    wait_for_message(person, panel, "with the nozzle upright: q")
    assert switch.whichChild.getValue() == -1
    assert stands_as(person, CellParameters(), path)
    person.look()
    person.screenshot("cell_preview")
    point = (1100.0, *CellParameters().deposition_point[1:])
    hand.enter(panel, f"{POINT}X", "1.1 m")
    moved = replace(CellParameters(), deposition_point=point, platform=30.0)
    hand.enter(panel, "Platform", "30 mm")
    person.until(lambda: stands_as(person, moved, path), "the machine to stand elsewhere", 10)
    hand.enter(panel, f"{POINT}X", "5 m")
    wait_for_message(person, panel, "does not reach the part")
    hand.enter(panel, "PlatformDiameter", "1 km")
    wait_for_message(person, panel, "see the marked field")
    assert (
        "out of range" in person.field(panel, "PlatformDiameterNote").text()
        and len(previewed(person)) == 0
    )
    person.press("Cancel")
    person.panel_closed()
    assert previewed(person) is None and switch.whichChild.getValue() == switch_state
    assert cell.ViewObject.Proxy.nodes.nozzle.getChild(0).matrix.getValue().getValue() == picture
    assert (document.UndoCount, cell.Status, api.result(cell)) == (
        steps,
        "up to date",
        CellParameters(),
    )


def test_a_new_cell_is_seen_at_the_toolpath_that_waits_for_one(person, hemisphere):
    """The preview uses the document's only toolpath, or the selected one of two, or the platform if
    none is selected."""
    document = hemisphere.Document
    small = api.make_toolpath(document, api.make_feature(document, hemisphere, layer_height=15))
    panel_of = {"": api.result(small)}
    for selection in ("", "large", "neither"):
        if selection == "large":
            large = api.make_toolpath(
                document, api.make_feature(document, hemisphere, layer_height=4)
            )
            panel_of.update(large=api.result(large), neither=None)
        person.gui.Selection.clearSelection()
        if selection == "large":
            person.gui.Selection.addSelection(large)
        person.click("RoboticAM_Cell")
        panel = person.panel(PANEL)
        wait_for_message(person, panel, "with the nozzle upright: q")
        person.until(
            lambda toolpath_=panel_of[selection]: stands_as(person, cell_of(""), toolpath_),
            f"the machine, {selection}",
            10,
        )
        person.press("Cancel")
        person.panel_closed()


def test_a_toolpath_that_is_made_anew_beside_the_panel_moves_the_machine(person, planned):
    cell, toolpath = planned
    old_result = api.result(toolpath)
    person.double_click(cell)
    panel = person.panel(PANEL)
    wait_for_message(person, panel, "with the nozzle upright: q")
    assert stands_as(person, CellParameters(), old_result)
    cell.Document.Feature.LayerHeight = "20 mm"
    cell.Document.recompute()
    new_result = api.result(toolpath)
    person.until(
        lambda: stands_as(person, CellParameters(), new_result),
        "the machine to stand at the new toolpath",
        10,
    )
    assert not stands_as(person, CellParameters(), old_result)
    person.press("Cancel")
    person.panel_closed()


def test_without_its_machine_the_nozzle_is_where_the_deposit_ends(person, hand, planned):
    cell, toolpath = planned
    last_bead = api.result(toolpath).layers[-1].beads[-1]
    person.double_click(cell)
    panel = person.panel(PANEL)
    wait_for_message(person, panel, "with the nozzle upright: ")
    hand.click(person.field(panel, "PreviewMachine"))
    person.until(lambda: len(previewed(person)) == 2, "the machine to go", 5)
    np.testing.assert_allclose(previewed(person)[1, :3, 3], last_bead.points[-1], atol=1e-4)
    hand.enter(panel, "PlatformDiameter", "100 mm")
    person.press("Apply")
    assert (
        cell.PlatformDiameter.Value == 100.0
        and cell.ViewObject.Proxy.switch.whichChild.getValue() == -1
    )
    person.press("Ok")
    person.panel_closed()
    assert cell.ViewObject.Proxy.switch.whichChild.getValue() != -1 and previewed(person) is None


def test_another_machine_proposes_its_deposition_point_and_branch(person, hand, hemisphere):
    document, steps = hemisphere.Document, hemisphere.Document.UndoCount
    person.click("RoboticAM_Cell")
    panel = person.panel(PANEL)
    note = person.field(panel, f"{POINT}Note")
    wait_for_message(person, panel, "FANUC")
    person.until(lambda: stands_as(person, cell_of(""), None), "the default robot at its point", 10)
    assert note.isVisible() and note.text().startswith("Proposed for FANUC")
    hand.enter(panel, "Machine", "kuka-kr16-2")
    expected = cell_of("kuka-kr16-2")
    person.until(
        lambda: entered_point(person, panel) == list(expected.deposition_point[:3]),
        "what is proposed",
        10,
    )
    assert note.isVisible() and note.text().startswith("Proposed for KUKA KR 16-2")
    assert person.field(panel, "Branch").currentText() == " ".join(expected.branch)
    wait_for_message(person, panel, "KUKA KR 16-2 with the nozzle upright: ")
    person.until(lambda: stands_as(person, expected, None), "the robot at its point", 10)
    person.look()
    person.screenshot("cell_proposed")
    hand.enter(panel, f"{POINT}Z", "1.5 m")
    person.until(lambda: not note.isVisible(), "the note to go with what it was about", 5)
    hand.enter(panel, "Machine", "motoman-ar1440")
    other_cell = cell_of("motoman-ar1440")
    person.until(
        lambda: note.isVisible() and note.text().startswith("Kept as entered"),
        "what is kept",
        10,
    )
    assert f"{other_cell.deposition_point[0]:g} 0 {other_cell.deposition_point[2]:g}" in note.text()
    assert entered_point(person, panel) == [expected.deposition_point[0], 0.0, 1500.0]
    assert person.field(panel, "Branch").currentText() == " ".join(
        other_cell.branch
    )  # the user has typed no other one
    person.press("Ok")
    person.panel_closed()
    cell_result = api.result(document.Cell)
    assert cell_result.deposition_point == (
        expected.deposition_point[0],
        0.0,
        1500.0,
        0.0,
        0.0,
        0.0,
    )
    assert (cell_result.machine, cell_result.branch, document.UndoCount) == (
        "motoman-ar1440",
        other_cell.branch,
        steps + 1,
    )


@pytest.fixture
def leaning(person, hemisphere):
    """Return a toolpath whose beads may lean by 10 deg from the vertical, which needs a positioner
    under a torch."""
    document = hemisphere.Document
    feature = api.make_feature(
        document, hemisphere, layer_height=15, chord_error=0.5, max_from_vertical=10
    )
    toolpath = api.make_toolpath(document, feature)
    person.idle()
    return toolpath


def choose_torch(person, hand, panel):
    hand.enter(panel, "Machine", "kuka-kr8-r2100-2-arc-hw")
    setup = person.field(panel, "Setup")
    person.until(setup.isEnabled, "the set-ups of a robot", 5)
    person.choose(panel, "Setup", "tool-on-robot")


@pytest.mark.long
def test_the_job_at_hand_is_done_in_the_cell_that_is_proposed_for_a_robot(person, hand, leaning):
    """With its toolpath in the document, the panel proposes a positioner; without one, a platform
    position that suits a ball."""
    document, steps = leaning.Document, leaning.Document.UndoCount
    person.click("RoboticAM_Cell")
    panel = person.panel(PANEL)
    choose_torch(person, hand, panel)
    external, note = person.field(panel, "External"), person.field(panel, "ExternalNote")
    person.until(lambda: "carries part" in external.text(), "a positioner", 30)
    assert note.isVisible() and note.text().startswith(f"Proposed for the job of {leaning.Label}; ")
    assert person.field(panel, "Branch").currentText() == "auto"
    wait_for_message(person, panel, "with the nozzle upright: ")
    person.look()
    person.screenshot("cell_for_job")
    console_length = len(person.console())
    person.press("Ok")
    person.panel_closed()
    cell = document.Cell
    assert (
        document.UndoCount == steps + 1 and "is now" not in person.console()[console_length:]
    )  # all is visible
    (positioner,) = EXTERNAL.read(cell.External)
    assert positioner.carries == "part"
    path = api.make_joint_path(document, leaning, cell)
    assert path.Status == "up to date", api.issues(path)
    plain = api.make_cell(
        document, machine=cell.Machine, setup="tool-on-robot"
    )  # the proposal for the robot alone
    assert api.make_joint_path(document, leaning, plain).Status == "infeasible"


POSITIONER = "motoman-motopos-d500 at 1615 0 0 0 0 0 carries part"


@pytest.mark.parametrize("branch", [pytest.param("", marks=pytest.mark.long), "back down noflip"])
def test_what_the_job_at_hand_would_need_is_entered_whole_or_told(
    person, hand, planned, monkeypatch, branch
):
    """Nothing is entered if the user has typed into one of the fields, because a positioner with
    another configuration would be a third cell. The proposal disappears with its robot."""
    requests = []

    def suited(settings):
        requests.append(settings)
        torch = settings.setup == "tool-on-robot"
        return replace(settings, external=POSITIONER, branch="auto") if torch else settings

    monkeypatch.setattr(cell_panel.suited_cell, "suit_to_toolpath", lambda toolpath: suited)
    label = planned[1].Label
    person.click("RoboticAM_Cell")
    panel = person.panel(PANEL)
    if branch:
        person.field(panel, "Branch").setEditText(branch)
    choose_torch(person, hand, panel)
    external = person.field(panel, "External")
    notes = [person.field(panel, f"{name}Note") for name in ("External", "Branch")]
    kept_message = f"Kept as entered; the job of {label} is feasible with "
    words = kept_message if branch else f"Proposed for the job of {label}; "
    person.until(
        lambda: all(note.isVisible() and note.text().startswith(words) for note in notes),
        "what it needs",
        60,
    )
    expected = cell_of("kuka-kr8-r2100-2-arc-hw", setup="tool-on-robot")
    last_request = requests[-1]
    assert (last_request.setup, last_request.deposition_point, last_request.external) == (
        "tool-on-robot",
        expected.deposition_point,
        (),
    )
    if branch:
        assert external.text() == "none" and person.field(panel, "Branch").currentText() == branch
        assert [note.text() for note in notes] == [
            f"{words}{text}." for text in (POSITIONER, "auto")
        ]
    else:
        assert (
            external.text() == POSITIONER and person.field(panel, "Branch").currentText() == "auto"
        )
    hand.enter(panel, "Machine", "kuka-kr16-2")
    person.choose(panel, "Setup", "part-on-robot")
    person.until(
        lambda: external.text() == "none" and not notes[0].isVisible(), "the positioner to go", 60
    )
    person.press("Cancel")
    person.panel_closed()


@pytest.mark.long
def test_another_set_up_proposes_where_the_platform_stands(person, hand, hemisphere):
    """The proposal considers the entered torch; the earlier proposal disappears, and typed values
    stay."""
    document = hemisphere.Document
    person.click("RoboticAM_Cell")
    panel = person.panel(PANEL)
    note = person.field(panel, f"{POINT}Note")
    hand.enter(panel, "Machine", "kuka-kr16-2")
    first_cell = cell_of("kuka-kr16-2")
    person.until(
        lambda: entered_point(person, panel) == list(first_cell.deposition_point[:3]),
        "what is proposed",
        10,
    )
    person.choose(panel, "Setup", "tool-on-robot")
    expected = cell_of("kuka-kr16-2", setup="tool-on-robot")
    person.until(
        lambda: entered_point(person, panel) == list(expected.deposition_point[:3]),
        "the platform",
        10,
    )
    assert note.isVisible() and note.text().startswith("Proposed for KUKA KR 16-2")
    assert person.field(panel, "Branch").currentText() == " ".join(expected.branch)
    wait_for_message(person, panel, "KUKA KR 16-2 with the nozzle upright: ")
    person.until(lambda: stands_as(person, expected, None), "the robot over its platform", 10)
    person.look()
    person.screenshot("cell_tool_on_robot")
    person.choose(panel, "Setup", "part-on-robot")
    person.until(
        lambda: entered_point(person, panel) == list(first_cell.deposition_point[:3]),
        "the first again",
        10,
    )
    hand.enter(panel, f"{POINT}Z", "900 mm")
    person.choose(panel, "Setup", "tool-on-robot")
    person.until(
        lambda: note.isVisible() and note.text().startswith("Kept as entered"),
        "what is kept",
        10,
    )
    assert entered_point(person, panel)[2] == 900.0
    person.press("Ok")
    person.panel_closed()
    cell_result = api.result(document.Cell)
    assert (cell_result.setup, cell_result.branch, cell_result.deposition_point[2]) == (
        "tool-on-robot",
        expected.branch,
        900.0,
    )


def test_a_cell_that_is_changed_keeps_what_was_entered_and_ok_waits_for_the_proposal(
    person, planned, monkeypatch
):
    def slowly(*request):
        time.sleep(1.0)
        return cell_of(*request)

    cell = planned[0]
    monkeypatch.setattr(cell_panel, "cell_of", slowly)  # it continues when OK is pressed
    api.change(cell, deposition_point=(1000, 0, 700, 0, 0, 0))
    person.double_click(cell)
    panel = person.panel(PANEL)
    person.type(panel, "Machine", "kuka-kr16-2")
    console_length = len(person.console())
    person.press("Ok")  # before the panel has updated its proposal
    person.panel_closed()
    line = f"{cell.Label}: Branch is now {' '.join(cell_of('kuka-kr16-2').branch)}. Proposed for KUKA KR 16-2; enter the values"
    person.until(lambda: line in person.console()[console_length:], "what nobody saw to be told", 5)
    assert "Deposition point is now" not in person.console()[console_length:]
    proposed, cell_result = cell_of("kuka-kr16-2"), api.result(cell)
    assert cell_result == replace(proposed, deposition_point=(1000.0, 0.0, 700.0, 0.0, 0.0, 0.0))
    person.double_click(cell)
    panel = person.panel(PANEL)
    wait_for_message(person, panel, "KUKA")
    assert not person.field(panel, f"{POINT}Note").isVisible()  # the user chose no other machine
    person.press("Cancel")
    person.panel_closed()
    person.until(
        lambda: not [thread for thread in threading.enumerate() if thread.name == "Robotic AM"],
        "the threads to end",
        10,
    )


def test_an_expression_in_a_coordinate_is_left_and_told(person, hand, hemisphere):
    """A coordinate takes no expression. Its error outlives the proposal for another machine."""
    person.click("RoboticAM_Cell")
    panel = person.panel(PANEL)
    coordinate, note = person.field(panel, f"{POINT}X"), person.field(panel, f"{POINT}Note")
    assert not coordinate.lineEdit().actions()  # no button that starts an expression
    hand.enter(panel, f"{POINT}X", "=500 mm")
    person.until(lambda: "takes no expression" in note.text(), "the error")
    hand.enter(panel, "Machine", "kuka-kr16-2")
    proposed = cell_of("kuka-kr16-2")
    branch = person.field(panel, "Branch")
    person.until(
        lambda: branch.currentText().split() == list(proposed.branch), "the branch to be proposed"
    )
    wait_for_message(person, panel, "No preview: see the marked field.", 20)
    assert coordinate.lineEdit().text() == "=500 mm"
    assert "takes no expression" in note.text() and note.isVisible()
    hand.enter(panel, f"{POINT}X", "600 mm")
    person.until(lambda: not note.isVisible(), "the error to go with the entry")
    wait_for_message(person, panel, "KUKA", 20)
    person.press("Cancel")
    person.panel_closed()


def test_a_late_error_of_earlier_entries_brings_back_no_field(person, hemisphere, monkeypatch):
    """The preview of a table with the set-up of a robot marks the set-up, which the panel hides
    meanwhile."""
    ended = threading.Event()

    def work_slowly(panel, draft):
        def compute():
            time.sleep(1.5)
            ended.set()
            raise InputError("BAD_VALUE", "cell.setup", "this set-up suits no table")

        return compute

    monkeypatch.setattr(cell_panel.CellPanel, "_work", work_slowly)
    person.click("RoboticAM_Cell")
    panel = person.panel(PANEL)
    state, setup = person.field(panel, "preview"), person.field(panel, "Setup")
    person.until(lambda: "Computing" in state.text(), "a preview to run")
    monkeypatch.setattr(preview.hooks, "carrying", lambda: True)  # no other preview starts
    person.type(panel, "Machine", "table-xyzbc")
    person.until(lambda: not setup.isVisible(), "the panel to follow the machine")
    assert not ended.is_set()
    person.until(ended.is_set, "the error")
    person.idle(0.5)
    assert not setup.isVisible()
    monkeypatch.undo()
    wait_for_message(person, panel, "Trunnion", 20)
    assert not setup.isVisible()
    person.press("Cancel")
    person.panel_closed()


@pytest.mark.parametrize("ends", ["cancelled", "fails"])
def test_a_proposal_that_is_cancelled_or_fails_is_told(person, hemisphere, monkeypatch, ends):
    """The user cancels while OK waits for the proposal, or the work ends with an unexpected
    error."""
    document = hemisphere.Document

    def proposing(*request):
        raise RuntimeError("broken")

    def slowly(*request):
        time.sleep(1.0)
        return cell_of(*request)

    def cancelled(work, title):
        raise Cancelled

    if ends == "fails":
        monkeypatch.setattr(cell_panel, "cell_of", proposing)
    else:
        monkeypatch.setattr(cell_panel, "cell_of", slowly)  # it continues when OK is pressed
        monkeypatch.setattr(cell_panel, "carry_out", cancelled)
    person.click("RoboticAM_Cell")
    panel = person.panel(PANEL)
    person.type(panel, "Machine", "kuka-kr16-2")
    if ends == "fails":
        note = person.field(panel, "MachineNote")
        person.until(
            lambda: note.isVisible() and note.text() == "RuntimeError: broken", "the error", 10
        )
        person.type(panel, "Machine", "fanuc-arcmate120ic")
        monkeypatch.undo()
        person.until(lambda: not note.isVisible(), "the error to go", 10)
    else:
        person.press("Ok")
        assert person.panel_error(panel) == "Cancelled: the document is unchanged."
        assert document.getObject("Cell") is None
    person.press("Cancel")
    person.panel_closed()


def test_urdf_as_external_axes_takes_the_whole_cell_of_a_file(person, hand, planned, tmp_path):
    """Robot, track and positioner of one file are entered with one word, and their bodies are
    visible."""
    cell, _ = planned
    text = urdf_cells.whole_cell()
    for link, size in (
        ("positioner_base_link", "0.4 0.4 0.1"),
        ("positioner_link_2", "0.3 0.3 0.02"),
        ("track_base_link", "3 0.4 0.2"),
    ):
        box = f'<collision><geometry><box size="{size}"/></geometry></collision>'
        text = text.replace(f'<link name="{link}"/>', f'<link name="{link}">{box}</link>')
    path = tmp_path / "bay.urdf"
    path.write_text(text, encoding="utf-8")
    person.double_click(cell)
    panel = person.panel(PANEL)
    wait_for_message(person, panel, "with the nozzle upright: q")
    hand.enter(panel, "Machine", str(path))
    setup = person.field(panel, "Setup")
    setup.setCurrentIndex(setup.findData("tool-on-robot"))
    field = person.field(panel, "External")
    person.until(field.isEnabled, "external axes to be asked for", 5)
    field.setText("urdf")
    machine, mechanisms = cell_values(Reference(str(path)))
    expected = machine, EXTERNAL.text(mechanisms)
    person.until(
        lambda: person.field(panel, "External").text() == expected[1],
        "track and positioner to be entered",
        10,
    )
    assert person.field(panel, "Machine").currentText() == expected[0]
    assert "track" in expected[1] and "positioner" in expected[1]
    person.until(
        lambda: (drawn := previewed(person)) is not None and len(drawn) == 9 + 3,
        "their bodies to be seen",
        20,
    )
    person.look()
    person.screenshot("cell_whole_urdf")
    person.press("Cancel")
    person.panel_closed()
