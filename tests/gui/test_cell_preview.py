# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a cell shows machine, platform and nozzle as they are entered, and proposes what suits a machine."""

import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.geometry import frames
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.proposed_cell import cell_of
from freecad_am.core.kinematics.urdf.cell import cell_values
from freecad_am.core.kinematics.urdf.reference import Reference
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.cell_records import EXTERNAL
from freecad_am.core.simulation.table_links import at_rest
from freecad_am.gui.nodes.cell import resting_point
from freecad_am.gui.panels import cell as cell_panel
from freecad_am.kdl import KdlArm
from freecad_am.objects.work.progress import Cancelled
from tests.core.kinematics import urdf_cells
from tests.gui.previews import drawn_by_previews

PANEL = "RoboticAM_Cell"
POINT = "DepositionPoint"


def previewed(person):
    """The poses (n, 4, 4) of what previews draw: platform, nozzle, then the links of the machine, base first; None without
    a preview."""
    nodes = drawn_by_previews(person, "SoMatrixTransform")
    if nodes is None:
        return None
    poses = [node.matrix.getValue().getValue() for node in nodes]
    return np.array(poses).reshape(-1, 4, 4).transpose(0, 2, 1)


def told(person, panel, words, seconds=10):
    state = person.field(panel, "preview")
    person.until(
        lambda: state.isVisible() and words in state.text(),
        f"{words}, not {state.text()!r}",
        seconds,
    )


def entered_point(person, panel):
    return [person.field(panel, f"{POINT}{axis}").property("rawValue") for axis in "XYZ"]


def stands_as(person, parameters, toolpath):
    """Whether the previewed machine stands as PyKDL puts it, the part where it is in the document."""
    drawn = previewed(person)
    cell = cells.resolve(parameters, np.eye(4) if toolpath is None else toolpath.frame)
    joints = at_rest(cell, resting_point(toolpath, cell.poses.mount))
    flange = KdlArm(cell.machine).forward([joints])[0]
    if drawn is None or len(drawn) != 9:
        return False
    if cell.setup == "tool-on-robot":
        tip = (drawn[2] @ flange @ cell.poses.carried)[:3, 3]
        return np.abs(tip - resting_point(toolpath, cell.poses.mount)).max() < 2e-3
    part = drawn[2] @ flange @ cell.poses.carried @ frames.inverse(cell.poses.mount)
    return (
        np.abs(part - np.eye(4)).max() < 2e-3 and np.abs(drawn[0] - cell.poses.mount).max() < 1e-5
    )


@pytest.fixture
def planned(person, hemisphere):
    """A cell with the toolpath that is cut for it."""
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
    which, before = (
        switch.whichChild.getValue(),
        cell.ViewObject.Proxy.nodes.nozzle.getChild(0).matrix.getValue().getValue(),
    )
    person.look()
    person.double_click(cell)
    panel = person.panel(PANEL)
    told(person, panel, "with the nozzle upright: q")
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
    told(person, panel, "does not reach the part")
    hand.enter(panel, "PlatformDiameter", "1 km")
    told(person, panel, "see the marked field")
    assert (
        "out of range" in person.field(panel, "PlatformDiameterNote").text()
        and len(previewed(person)) == 0
    )
    person.press("Cancel")
    person.panel_closed()
    assert previewed(person) is None and switch.whichChild.getValue() == which
    assert cell.ViewObject.Proxy.nodes.nozzle.getChild(0).matrix.getValue().getValue() == before
    assert (document.UndoCount, cell.Status, api.result(cell)) == (
        steps,
        "up to date",
        CellParameters(),
    )


def test_a_new_cell_is_seen_at_the_toolpath_that_waits_for_one(person, hemisphere):
    """That of a document with one toolpath; of two the selected one, and the platform where neither is."""
    document = hemisphere.Document
    small = api.make_toolpath(document, api.make_feature(document, hemisphere, layer_height=15))
    panel_of = {"": api.result(small)}
    for chosen in ("", "large", "neither"):
        if chosen == "large":
            large = api.make_toolpath(
                document, api.make_feature(document, hemisphere, layer_height=4)
            )
            panel_of.update(large=api.result(large), neither=None)
        person.gui.Selection.clearSelection()
        if chosen == "large":
            person.gui.Selection.addSelection(large)
        person.click("RoboticAM_Cell")
        panel = person.panel(PANEL)
        told(person, panel, "with the nozzle upright: q")
        person.until(
            lambda of=panel_of[chosen]: stands_as(person, cell_of(""), of),
            f"the machine, {chosen}",
            10,
        )
        person.press("Cancel")
        person.panel_closed()


def test_a_toolpath_that_is_made_anew_beside_the_panel_moves_the_machine(person, planned):
    cell, toolpath = planned
    before = api.result(toolpath)
    person.double_click(cell)
    panel = person.panel(PANEL)
    told(person, panel, "with the nozzle upright: q")
    assert stands_as(person, CellParameters(), before)
    cell.Document.Feature.LayerHeight = "20 mm"
    cell.Document.recompute()
    after = api.result(toolpath)
    person.until(
        lambda: stands_as(person, CellParameters(), after),
        "the machine to stand at the new toolpath",
        10,
    )
    assert not stands_as(person, CellParameters(), before)
    person.press("Cancel")
    person.panel_closed()


def test_without_its_machine_the_nozzle_is_where_the_deposit_ends(person, hand, planned):
    cell, toolpath = planned
    last = api.result(toolpath).layers[-1].beads[-1]
    person.double_click(cell)
    panel = person.panel(PANEL)
    told(person, panel, "with the nozzle upright: ")
    hand.click(person.field(panel, "PreviewMachine"))
    person.until(lambda: len(previewed(person)) == 2, "the machine to go", 5)
    np.testing.assert_allclose(previewed(person)[1, :3, 3], last.points[-1], atol=1e-4)
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
    told(person, panel, "FANUC")
    person.until(lambda: stands_as(person, cell_of(""), None), "the default robot at its point", 10)
    assert note.isVisible() and note.text().startswith("Proposed for FANUC")
    hand.enter(panel, "Machine", "kuka-kr16-2")
    wanted = cell_of("kuka-kr16-2")
    person.until(
        lambda: entered_point(person, panel) == list(wanted.deposition_point[:3]),
        "what is proposed",
        10,
    )
    assert note.isVisible() and note.text().startswith("Proposed for KUKA KR 16-2")
    assert person.field(panel, "Branch").currentText() == " ".join(wanted.branch)
    told(person, panel, "KUKA KR 16-2 with the nozzle upright: ")
    person.until(lambda: stands_as(person, wanted, None), "the robot at its point", 10)
    person.look()
    person.screenshot("cell_proposed")
    hand.enter(panel, f"{POINT}Z", "1.5 m")
    person.until(lambda: not note.isVisible(), "the note to go with what it was about", 5)
    hand.enter(panel, "Machine", "motoman-ar1440")
    other = cell_of("motoman-ar1440")
    person.until(
        lambda: note.isVisible() and note.text().startswith("Kept as entered"),
        "what is kept",
        10,
    )
    assert f"{other.deposition_point[0]:g} 0 {other.deposition_point[2]:g}" in note.text()
    assert entered_point(person, panel) == [wanted.deposition_point[0], 0.0, 1500.0]
    assert person.field(panel, "Branch").currentText() == " ".join(
        other.branch
    )  # nobody has typed another one
    person.press("Ok")
    person.panel_closed()
    made = api.result(document.Cell)
    assert made.deposition_point == (wanted.deposition_point[0], 0.0, 1500.0, 0.0, 0.0, 0.0)
    assert (made.machine, made.branch, document.UndoCount) == (
        "motoman-ar1440",
        other.branch,
        steps + 1,
    )


@pytest.fixture
def leaning(person, hemisphere):
    """A toolpath whose beads may lean by 10 deg from the vertical, which takes a positioner under a torch."""
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
    """With its toolpath in the document, a positioner; before, the platform was put where a ball could be laid."""
    document, steps = leaning.Document, leaning.Document.UndoCount
    person.click("RoboticAM_Cell")
    panel = person.panel(PANEL)
    choose_torch(person, hand, panel)
    external, note = person.field(panel, "External"), person.field(panel, "ExternalNote")
    person.until(lambda: "carries part" in external.text(), "a positioner", 30)
    assert note.isVisible() and note.text().startswith(f"Proposed for the job of {leaning.Label}; ")
    assert person.field(panel, "Branch").currentText() == "auto"
    told(person, panel, "with the nozzle upright: ")
    person.look()
    person.screenshot("cell_for_job")
    before = len(person.console())
    person.press("Ok")
    person.panel_closed()
    cell = document.Cell
    assert (
        document.UndoCount == steps + 1 and "is now" not in person.console()[before:]
    )  # all was seen
    (positioner,) = EXTERNAL.read(cell.External)
    assert positioner.carries == "part"
    path = api.make_joint_path(document, leaning, cell)
    assert path.Status == "up to date", api.issues(path)
    plain = api.make_cell(
        document, machine=cell.Machine, setup="tool-on-robot"
    )  # what suits the robot alone
    assert api.make_joint_path(document, leaning, plain).Status == "infeasible"


POSITIONER = "motoman-motopos-d500 at 1615 0 0 0 0 0 carries part"


@pytest.mark.parametrize("branch", [pytest.param("", marks=pytest.mark.long), "back down noflip"])
def test_what_the_job_at_hand_would_need_is_entered_whole_or_told(
    person, hand, planned, monkeypatch, branch
):
    """Nothing of it where one of its fields holds something of the user's: a positioner with another branch would be a third
    cell. It goes with the robot that it was proposed for."""
    asked = []

    def suited(settings):
        asked.append(settings)
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
    left = f"Kept as entered; the job of {label} is feasible with "
    words = left if branch else f"Proposed for the job of {label}; "
    person.until(
        lambda: all(note.isVisible() and note.text().startswith(words) for note in notes),
        "what it needs",
        60,
    )
    wanted = cell_of("kuka-kr8-r2100-2-arc-hw", setup="tool-on-robot")
    last = asked[-1]
    assert (last.setup, last.deposition_point, last.external) == (
        "tool-on-robot",
        wanted.deposition_point,
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
    """With the torch as it is entered; what was proposed for the one before goes, what was typed stays."""
    document = hemisphere.Document
    person.click("RoboticAM_Cell")
    panel = person.panel(PANEL)
    note = person.field(panel, f"{POINT}Note")
    hand.enter(panel, "Machine", "kuka-kr16-2")
    first = cell_of("kuka-kr16-2")
    person.until(
        lambda: entered_point(person, panel) == list(first.deposition_point[:3]),
        "what is proposed",
        10,
    )
    person.choose(panel, "Setup", "tool-on-robot")
    wanted = cell_of("kuka-kr16-2", setup="tool-on-robot")
    person.until(
        lambda: entered_point(person, panel) == list(wanted.deposition_point[:3]),
        "the platform",
        10,
    )
    assert note.isVisible() and note.text().startswith("Proposed for KUKA KR 16-2")
    assert person.field(panel, "Branch").currentText() == " ".join(wanted.branch)
    told(person, panel, "KUKA KR 16-2 with the nozzle upright: ")
    person.until(lambda: stands_as(person, wanted, None), "the robot over its platform", 10)
    person.look()
    person.screenshot("cell_tool_on_robot")
    person.choose(panel, "Setup", "part-on-robot")
    person.until(
        lambda: entered_point(person, panel) == list(first.deposition_point[:3]),
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
    made = api.result(document.Cell)
    assert (made.setup, made.branch, made.deposition_point[2]) == (
        "tool-on-robot",
        wanted.branch,
        900.0,
    )


def test_a_cell_that_is_changed_keeps_what_was_entered_and_ok_waits_for_the_proposal(
    person, planned, monkeypatch
):
    def slowly(*asked):
        time.sleep(1.0)
        return cell_of(*asked)

    cell = planned[0]
    monkeypatch.setattr(cell_panel, "cell_of", slowly)  # it goes on when OK is pressed
    api.change(cell, deposition_point=(1000, 0, 700, 0, 0, 0))
    person.double_click(cell)
    panel = person.panel(PANEL)
    person.type(panel, "Machine", "kuka-kr16-2")
    before = len(person.console())
    person.press("Ok")  # before anything has followed by itself
    person.panel_closed()
    line = f"{cell.Label}: Branch is now {' '.join(cell_of('kuka-kr16-2').branch)}. Proposed for KUKA KR 16-2; enter the values"
    person.until(lambda: line in person.console()[before:], "what nobody saw to be told", 5)
    assert "Deposition point is now" not in person.console()[before:]
    proposed, made = cell_of("kuka-kr16-2"), api.result(cell)
    assert made == replace(proposed, deposition_point=(1000.0, 0.0, 700.0, 0.0, 0.0, 0.0))
    person.double_click(cell)
    panel = person.panel(PANEL)
    told(person, panel, "KUKA")
    assert not person.field(panel, f"{POINT}Note").isVisible()  # no other machine was chosen
    person.press("Cancel")
    person.panel_closed()
    person.until(
        lambda: not [one for one in threading.enumerate() if one.name == "Robotic AM"],
        "the threads to end",
        10,
    )


def test_an_expression_in_a_coordinate_is_left_and_told(person, hand, hemisphere):
    person.click("RoboticAM_Cell")
    panel = person.panel(PANEL)
    hand.enter(panel, f"{POINT}X", "=500 mm")
    hand.enter(panel, "Machine", "kuka-kr16-2")
    note = person.field(panel, f"{POINT}Note")
    person.until(lambda: note.text().startswith("Kept as entered"), "what is kept", 30)
    hand.enter(panel, f"{POINT}X", "=600 mm")
    person.until(lambda: not note.isVisible(), "the note to go with what it was about", 5)
    person.press("Cancel")
    person.panel_closed()


@pytest.mark.parametrize("ends", ["cancelled", "fails"])
def test_a_proposal_that_is_cancelled_or_fails_is_told(person, hemisphere, monkeypatch, ends):
    """The user cancels while OK waits for it, or the work ends in an error of nobody's making."""
    document = hemisphere.Document

    def proposing(*asked):
        raise RuntimeError("broken")

    def slowly(*asked):
        time.sleep(1.0)
        return cell_of(*asked)

    def cancelled(work, title):
        raise Cancelled

    if ends == "fails":
        monkeypatch.setattr(cell_panel, "cell_of", proposing)
    else:
        monkeypatch.setattr(cell_panel, "cell_of", slowly)  # it goes on when OK is pressed
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
    """Robot, track and positioner of one file: typed as one word, and its bodies are seen."""
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
    told(person, panel, "with the nozzle upright: q")
    hand.enter(panel, "Machine", str(path))
    setup = person.field(panel, "Setup")
    setup.setCurrentIndex(setup.findData("tool-on-robot"))
    field = person.field(panel, "External")
    person.until(field.isEnabled, "external axes to be asked for", 5)
    field.setText("urdf")
    machine, mechanisms = cell_values(Reference(str(path)))
    wanted = machine, EXTERNAL.text(mechanisms)
    person.until(
        lambda: person.field(panel, "External").text() == wanted[1],
        "track and positioner to be entered",
        10,
    )
    assert person.field(panel, "Machine").currentText() == wanted[0]
    assert "track" in wanted[1] and "positioner" in wanted[1]
    person.until(
        lambda: (drawn := previewed(person)) is not None and len(drawn) == 9 + 3,
        "their bodies to be seen",
        20,
    )
    person.look()
    person.screenshot("cell_whole_urdf")
    person.press("Cancel")
    person.panel_closed()
