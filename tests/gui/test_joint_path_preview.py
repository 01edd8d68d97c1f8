# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a joint path previews the result of the entered values, as text and drawing, before
the final planning."""

import re
import threading

import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.planning.rotation.headroom import judge_paths
from freecad_am.gui.panels import joint_path as joint_path_panel
from tests.gui.previews import drawn_by_previews

PANEL = "RoboticAM_JointPath"


@pytest.fixture
def stages(person, hemisphere):
    """Return a toolpath and its cell."""
    document = hemisphere.Document
    cell = api.make_cell(document)
    feature = api.make_feature(document, hemisphere, layer_height=10)
    toolpath_and_cell = api.make_toolpath(document, feature, cell), cell
    cell.ViewObject.Visibility = feature.ViewObject.Visibility = False
    person.idle()
    return toolpath_and_cell


def first_of(person, kind):
    """Return the first Coin node of a kind that previews draw; None without a preview."""
    nodes = drawn_by_previews(person, kind)
    return None if nodes is None else nodes[0]


def drawn_points(person):
    """Return points (n, 3) of the lines that previews draw; None without a preview."""
    node = first_of(person, "SoCoordinate3")
    return None if node is None else np.array([tuple(point) for point in node.point.getValues()])


def previewed_colours(person):
    """Return colours (n, 3) of these points."""
    return np.array(
        [tuple(colour) for colour in first_of(person, "SoMaterial").diffuseColor.getValues()]
    )


def wait_for_message(person, panel, words, seconds=60):
    state = person.field(panel, "preview")
    person.until(lambda: state.isVisible() and words in state.text(), words, seconds)
    return state.text()


def threads_end(person):
    person.until(
        lambda: not [thread for thread in threading.enumerate() if thread.name == "Robotic AM"],
        "the threads to end",
        10,
    )


def test_the_figures_of_a_whole_preview_are_those_of_the_plan(person, stages, monkeypatch):
    toolpath, cell = stages
    monkeypatch.setattr(joint_path_panel, "MAX_POINTS", 100_000)
    document, steps = toolpath.Document, toolpath.Document.UndoCount
    person.select(toolpath)
    person.click("RoboticAM_JointPath")
    panel = person.panel(PANEL)
    text = wait_for_message(person, panel, "Preview of all points")
    assert text.startswith("All deposit points are feasible.\nSmallest joint margin: ")
    assert text.endswith("Preview of all points; OK also checks the rapids.")
    figures = [float(number) for number in re.findall(r": (-?[\d.]+)", text)]
    assert len(drawn_points(person)) >= api.result(toolpath).point_count
    assert (
        toolpath.ViewObject.Proxy.switch.whichChild.getValue() == -1
    )  # the preview is at the same position
    person.look()
    person.screenshot("joint_path_preview")
    assert document.UndoCount == steps and document.getObject("JointPath") is None
    person.press("Ok")
    person.panel_closed()
    assert drawn_points(person) is None and document.UndoCount == steps + 1
    planned = api.result(document.JointPath).joint_path
    machine = machines.load(cell.Machine)
    path_figures = judge_paths(planned.beads, machine.limits("maker"), machine.max_speed)
    shown_figures = [
        round(100.0 * path_figures.worst_margin.value, 1),
        round(path_figures.worst_condition.value, 3),
        round(100.0 * path_figures.worst_ratio.value),
    ]
    assert figures == shown_figures
    assert path_figures.worst_condition.value == pytest.approx(document.JointPath.SmallestCondition)


def test_a_change_is_planned_anew_and_tells_where_it_cannot_be_carried_out(
    person, hand, stages, monkeypatch
):
    toolpath, cell = stages
    monkeypatch.setattr(joint_path_panel, "MAX_POINTS", 300)
    document = toolpath.Document
    joint_path = api.make_joint_path(document, toolpath, cell)
    person.idle()
    switch_state, key = joint_path.ViewObject.Proxy.switch.whichChild.getValue(), joint_path.Key
    person.double_click(joint_path)
    panel = person.panel(PANEL)
    assert joint_path.ViewObject.Proxy.switch.whichChild.getValue() == -1
    first_message = wait_for_message(person, panel, "No problem found so far.")
    note_pattern = r"Preview of one point in \d+(?: of one bead in \d+)?; OK checks the points (?:and beads )?between and the rapids too\."
    assert re.search(note_pattern, first_message) and "are feasible" not in first_message
    assert 100 < len(drawn_points(person)) < api.result(toolpath).point_count
    person.choose(panel, "Method", "constant")
    worse = wait_for_message(person, panel, "Infeasible:")
    assert re.search(r"layer \d+: ", worse) and "bead" not in worse.partition("Preview")[0]
    person.look()
    person.screenshot("joint_path_infeasible")
    person.choose(panel, "Method", "layer-by-layer")
    hand.enter(panel, "MinCondition", "2")
    wait_for_message(person, panel, "see the marked field")
    assert "out of range" in person.field(panel, "MinConditionNote").text()
    assert len(drawn_points(person)) == 0
    hand.enter(panel, "MinCondition", "auto")
    wait_for_message(person, panel, "No problem found so far.")
    person.press("Cancel")
    person.panel_closed()
    assert (
        drawn_points(person) is None
        and joint_path.ViewObject.Proxy.switch.whichChild.getValue() == switch_state
    )
    assert (joint_path.Key, joint_path.Status, joint_path.Method) == (
        key,
        "up to date",
        "layer-by-layer",
    )


def test_a_panel_that_is_closed_while_it_computes_leaves_nothing(person, stages, monkeypatch):
    has_begun, has_ended = threading.Event(), threading.Event()
    plan_sample = joint_path_panel._plan_sample

    def endless(job):
        has_begun.set()
        try:
            while True:
                plan_sample(job)
        finally:
            has_ended.set()

    monkeypatch.setattr(joint_path_panel, "_plan_sample", endless)
    person.select(stages[0])
    person.click("RoboticAM_JointPath")
    panel = person.panel(PANEL)
    person.until(has_begun.is_set, "the preview to begin", 10)
    wait_for_message(person, panel, "Computing the preview")
    person.press("Cancel")
    person.panel_closed()
    person.until(has_ended.is_set, "its end", 20)
    threads_end(person)
    assert (
        drawn_points(person) is None
        and stages[0].ViewObject.Proxy.switch.whichChild.getValue() != -1
    )
    assert len(api.stages_of(stages[0].Document)) == 3


def test_what_is_missing_is_told_and_a_stale_toolpath_too(person, stages):
    toolpath = stages[0]
    toolpath.TravelSpeed = "7 mm/s"
    assert toolpath.Status == "stale"
    person.select(toolpath)
    person.click("RoboticAM_JointPath")
    panel = person.panel(PANEL)
    text = wait_for_message(person, panel, "All deposit points are feasible.")
    assert "Toolpath is out of date; the preview shows its earlier state." in text
    toolpath.Document.recompute()
    state = person.field(panel, "preview")
    person.until(
        lambda: "All deposit points" in state.text() and "out of date" not in state.text(),
        "what it is now",
        30,
    )
    toolpath.Document.removeObject(toolpath.Name)
    text = wait_for_message(person, panel, "No preview: see the marked field.")
    note = person.field(panel, "InputToolpathNote")
    assert (
        note.isVisible()
        and "Toolpath is missing" in note.text()
        and "Error" not in text + note.text()
    )
    assert len(drawn_points(person)) == 0
    person.press("Cancel")
    person.panel_closed()
    threads_end(person)


def test_inputs_deleted_while_the_preview_is_computed_are_told_as_missing(
    person, stages, monkeypatch
):
    toolpath, _ = stages
    has_begun, go_on, messages = threading.Event(), threading.Event(), []
    plan_sample = joint_path_panel._plan_sample

    def plan_when_released(job):
        has_begun.set()
        go_on.wait(20)
        return plan_sample(job)

    monkeypatch.setattr(joint_path_panel, "_plan_sample", plan_when_released)
    say = joint_path_panel.JointPathPanel._say
    monkeypatch.setattr(
        joint_path_panel.JointPathPanel,
        "_say",
        lambda panel, text, *options: (messages.append(text), say(panel, text, *options)),
    )
    monkeypatch.setattr(
        joint_path_panel.JointPathPanel, "_entered", lambda panel: "the same"
    )  # a preview that ends before the next poll
    person.select(toolpath)
    person.click("RoboticAM_JointPath")
    panel = person.panel(PANEL)
    person.until(has_begun.is_set, "the preview to begin", 10)
    toolpath.Document.removeObject(toolpath.Name)
    go_on.set()
    person.until(
        lambda: any("deposit points" in text for text in messages),
        f"the preview, not {messages}",
        30,
    )
    assert not [text for text in messages if "Error" in text]
    monkeypatch.undo()
    wait_for_message(person, panel, "No preview: see the marked field.")
    person.press("Cancel")
    person.panel_closed()
    threads_end(person)


def test_apply_renews_the_preview_and_the_toolpath_stays_back(person, stages, monkeypatch):
    toolpath, cell = stages
    monkeypatch.setattr(joint_path_panel, "MAX_POINTS", 300)
    joint_path = api.make_joint_path(toolpath.Document, toolpath, cell)
    started = []
    plan_sample = joint_path_panel._plan_sample
    monkeypatch.setattr(
        joint_path_panel,
        "_plan_sample",
        lambda job: (started.append(job.parameters.degree), plan_sample(job))[1],
    )
    person.double_click(joint_path)
    panel = person.panel(PANEL)
    first_message = wait_for_message(person, panel, "No problem found so far.")
    person.type(panel, "Degree", "0")
    person.until(lambda: started[-1:] == [0], "the preview of what is typed to begin", 10)
    person.press("Apply")  # Apply ends it
    person.until(lambda: joint_path.Degree == 0, "Apply", 30)
    switches = toolpath.ViewObject.Proxy.switch, joint_path.ViewObject.Proxy.switch
    assert [switch.whichChild.getValue() for switch in switches] == [-1, -1]
    state, count = person.field(panel, "preview"), len(started)
    person.until(
        lambda: len(started) > count or started.count(0) > 1, "the preview of what was made", 10
    )
    person.until(
        lambda: state.text() not in (first_message, "Computing the preview."), "its figures", 30
    )
    assert (
        "Infeasible:" in state.text()
        and "Preview of one point" in state.text()
        and len(drawn_points(person)) > 100
    )
    assert [switch.whichChild.getValue() for switch in switches] == [-1, -1]
    person.press("Ok")
    person.panel_closed()
    assert all(switch.whichChild.getValue() != -1 for switch in switches)


def test_a_table_has_no_condition_and_is_told_of_all_the_same(person, stages):
    toolpath, _ = stages
    table = api.make_cell(toolpath.Document, machine="table-xyzac", setup="rotary-table")
    api.change(toolpath, cell=table)
    joint_path = api.make_joint_path(toolpath.Document, toolpath, table)
    joint_path.ViewObject.Colouring = "condition"
    person.idle()
    person.double_click(joint_path)
    panel = person.panel(PANEL)
    text = wait_for_message(person, panel, "Preview of all points")
    assert (
        "Smallest joint margin: " in text
        and "Largest joint speed: " in text
        and "condition" not in text
    )
    colours = previewed_colours(person)
    assert (
        len(np.unique(colours, axis=0)) == 8
    )  # coloured by margin, like the layer, because it has no other value
    person.press("Cancel")
    person.panel_closed()
