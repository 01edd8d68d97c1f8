# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feasible positions of the part by clicks: poses are drawn where the machine would put them, the
best is entered and planned, work is cancelled, and the view keeps nothing."""

import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.simulation.table_links import at_rest, placing
from freecad_am.gui.nodes.cell import resting_point
from freecad_am.gui.placement import dock as docks
from freecad_am.gui.placement import figures

HIGH_POSE = (1045.747, -630.155, 2153.167, 0, 0, 0)  # out of reach
TIMEOUT_S = 60  # s


@pytest.fixture
def path(hemisphere):
    """Return a joint path that is infeasible at the current position of its part."""
    doc = hemisphere.Document
    feature = api.make_feature(doc, hemisphere, layer_height=12, chord_error="0.2 mm")
    cell = api.make_cell(doc, limits="paper", deposition_point=HIGH_POSE)
    toolpath = api.make_toolpath(doc, feature, cell)
    return api.make_joint_path(doc, toolpath, cell)


def opened(person, path):
    person.select(path)
    person.click("RoboticAM_Placement")
    return person.panel(docks.NAME), docks._open[0]


def entered(person, panel, **values):
    for name, text in values.items():
        person.type(panel, name, text)


def node_count(person):
    import FreeCADGui as Gui

    return Gui.ActiveDocument.ActiveView.getSceneGraph().getNumChildren()


def test_the_best_pose_is_entered_and_planned(person, hand, no_remedies, path):
    assert path.Status == "infeasible"
    original_nodes = node_count(person)
    panel, tool = opened(person, path)
    label_texts = {label.text() for label in panel.findChildren(person.widgets.QLabel)}
    assert {
        "± X",
        "± Y",
        "± Z",
        "± RX",
        "Step",
    } <= label_texts  # lengths to either side, no coordinates
    entered(person, panel, X="0 mm", Y="0 mm", Z="1500 mm", Step="500 mm")
    hand.click(person.field(panel, "compute"))
    person.until(lambda: tool.found is not None and not tool.work.runs, "the poses", TIMEOUT_S)
    placement = tool.found
    person.screenshot("placement")
    assert len(placement.poses) == 7 and placement.best is not None
    assert {judged.feasible for judged in placement.judged} == {True, False}
    assert person.field(panel, "poses").rowCount() == len(figures.rows(placement, "margin"))

    # a position is that of the nozzle relative to the part as drawn
    settings, toolpath = tool.placing.settings, tool.placing.job().toolpath
    cell = cells.resolve(settings, toolpath.frame, toolpath.family)
    rest_placing = placing(cell, at_rest(cell, resting_point(toolpath, cell.poses.mount)))
    for number, drawn_place in enumerate(tool.scene.places):
        world = rest_placing.part @ np.append(drawn_place, 1.0)
        in_base = np.linalg.inv(cell.machine.base) @ world
        assert np.abs(in_base[:3] - placement.poses[number, :3]).max() < 1e-6
    grey = np.all(np.isclose(figures.coloured(placement, "margin").colours, figures.GREY), axis=1)
    assert grey.sum() == sum(not judged.feasible for judged in placement.judged)

    hand.click(person.field(panel, "use"))
    person.until(lambda: path.Status == "up to date", "the plan", TIMEOUT_S)
    assert tuple(api.result(path.Cell).deposition_point) == pytest.approx(
        placement.pose(placement.best)
    )
    recorded = person.window.findChild(
        person.widgets.QPlainTextEdit, "Python console"
    ).toPlainText()
    assert "am.change(App.ActiveDocument.getObject('Cell'), deposition_point=(" in recorded
    path.Document.undo()
    assert api.result(path.Cell).deposition_point == pytest.approx(HIGH_POSE)
    panel.close()
    person.idle()
    assert node_count(person) == original_nodes and not docks._open


def test_cancelled_refused_and_stale(person, hand, no_remedies, path):
    panel, tool = opened(person, path)
    message = person.field(panel, "told")
    entered(person, panel, Step="16 mm")  # 15,625 poses: far more than a click takes
    hand.click(person.field(panel, "compute"))
    person.until(
        lambda: tool.work.runs and tool.work.background.worker.fraction is not None,
        "the work",
        TIMEOUT_S,
    )
    assert person.field(panel, "compute").text() == "Cancel"
    hand.click(person.field(panel, "compute"))
    person.idle()
    assert not tool.work.runs and tool.found is None and message.text() == "Cancelled."
    entered(person, panel, Step="1 mm")
    hand.click(person.field(panel, "compute"))
    person.idle()
    assert not tool.work.runs and "use a larger step" in message.text()
    entered(person, panel, X="0 mm", Y="0 mm", Z="0 mm", Step="100 mm")
    hand.click(person.field(panel, "compute"))
    person.until(lambda: tool.found is not None, "the pose", TIMEOUT_S)
    assert "At most" in message.text() and not person.field(panel, "use").isEnabled()
    api.change(path.Toolpath, travel_speed=5)
    person.idle()
    assert tool.found is None and "compute again" in message.text()
    path.Document.removeObject(path.Name)
    person.idle(0.3)
    assert not docks._open


def test_the_reach_is_a_cloud_of_the_directions_that_serve(person, hand, no_remedies, path):
    _, tool = opened(person, path)
    panel = person.panel(docks.NAME)
    hand.click(person.field(panel, "reach"))
    person.until(lambda: tool.volume is not None, "the reach", TIMEOUT_S)
    person.screenshot("placement_reach")
    points = np.array(tool.scene.cloud.coordinates.point.getValues())
    assert len(points) == len(tool.volume.places) > 1000
    largest_distance = np.linalg.norm(points[:, None] - points[None, :200], axis=2).max()
    arm = tool.scene.cell.machine.arm
    assert 1.2 * arm.reach < largest_distance < 3.5 * arm.reach
    hand.click(person.field(panel, "reach"))
    person.idle()
    assert tool.volume is None and tool.scene.cloud.points.numPoints.getValue() == 0
