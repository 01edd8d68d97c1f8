# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the part can stand, by clicks: poses are drawn where the machine would have them, the best is entered and planned,
work is cancelled, and nothing is left in the view."""

import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.simulation.table_links import at_rest, placing
from freecad_am.gui.nodes.cell import resting_point
from freecad_am.gui.placement import dock as docks
from freecad_am.gui.placement import figures

HIGH = (1045.747, -630.155, 2153.167, 0, 0, 0)  # out of reach
LONG = 60  # s


@pytest.fixture
def path(hemisphere):
    """A joint path that cannot be carried out where its part is."""
    doc = hemisphere.Document
    feature = api.make_feature(doc, hemisphere, layer_height=12, chord_error="0.2 mm")
    cell = api.make_cell(doc, limits="paper", deposition_point=HIGH)
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
    before = node_count(person)
    panel, one = opened(person, path)
    told = {label.text() for label in panel.findChildren(person.widgets.QLabel)}
    assert {"± X", "± Y", "± Z", "± RX", "Step"} <= told  # lengths to either side, no coordinates
    entered(person, panel, X="0 mm", Y="0 mm", Z="1500 mm", Step="500 mm")
    hand.click(person.field(panel, "compute"))
    person.until(lambda: one.found is not None and not one.work.runs, "the poses", LONG)
    found = one.found
    person.screenshot("placement")
    assert len(found.poses) == 7 and found.best is not None
    assert {judged.feasible for judged in found.judged} == {True, False}
    assert person.field(panel, "poses").rowCount() == len(figures.rows(found, "margin"))

    # a place is where the nozzle would be, seen from the part as it is drawn
    settings, toolpath = one.placing.settings, one.placing.job().toolpath
    cell = cells.resolve(settings, toolpath.frame, toolpath.family)
    rest = placing(cell, at_rest(cell, resting_point(toolpath, cell.poses.mount)))
    for number, place in enumerate(one.scene.places):
        world = rest.part @ np.append(place, 1.0)
        there = np.linalg.inv(cell.machine.base) @ world
        assert np.abs(there[:3] - found.poses[number, :3]).max() < 1e-6
    grey = np.all(np.isclose(figures.coloured(found, "margin").colours, figures.GREY), axis=1)
    assert grey.sum() == sum(not judged.feasible for judged in found.judged)

    hand.click(person.field(panel, "use"))
    person.until(lambda: path.Status == "up to date", "the plan", LONG)
    assert tuple(api.result(path.Cell).deposition_point) == pytest.approx(found.pose(found.best))
    recorded = person.window.findChild(
        person.widgets.QPlainTextEdit, "Python console"
    ).toPlainText()
    assert "am.change(App.ActiveDocument.getObject('Cell'), deposition_point=(" in recorded
    path.Document.undo()
    assert api.result(path.Cell).deposition_point == pytest.approx(HIGH)
    panel.close()
    person.idle()
    assert node_count(person) == before and not docks._open


def test_cancelled_refused_and_stale(person, hand, no_remedies, path):
    panel, one = opened(person, path)
    told = person.field(panel, "told")
    entered(person, panel, Step="16 mm")  # 15,625 poses: far more than a click takes
    hand.click(person.field(panel, "compute"))
    person.until(
        lambda: one.work.runs and one.work.background.worker.fraction is not None, "the work", LONG
    )
    assert person.field(panel, "compute").text() == "Cancel"
    hand.click(person.field(panel, "compute"))
    person.idle()
    assert not one.work.runs and one.found is None and told.text() == "Cancelled."
    entered(person, panel, Step="1 mm")
    hand.click(person.field(panel, "compute"))
    person.idle()
    assert not one.work.runs and "use a larger step" in told.text()
    entered(person, panel, X="0 mm", Y="0 mm", Z="0 mm", Step="100 mm")
    hand.click(person.field(panel, "compute"))
    person.until(lambda: one.found is not None, "the pose", LONG)
    assert "At most" in told.text() and not person.field(panel, "use").isEnabled()
    api.change(path.Toolpath, travel_speed=5)
    person.idle()
    assert one.found is None and "compute again" in told.text()
    path.Document.removeObject(path.Name)
    person.idle(0.3)
    assert not docks._open


def test_the_reach_is_a_cloud_of_the_directions_that_serve(person, hand, no_remedies, path):
    _, one = opened(person, path)
    panel = person.panel(docks.NAME)
    hand.click(person.field(panel, "reach"))
    person.until(lambda: one.volume is not None, "the reach", LONG)
    person.screenshot("placement_reach")
    points = np.array(one.scene.cloud.coordinates.point.getValues())
    assert len(points) == len(one.volume.places) > 1000
    away = np.linalg.norm(points[:, None] - points[None, :200], axis=2).max()
    arm = one.scene.cell.machine.arm
    assert 1.2 * arm.reach < away < 3.5 * arm.reach
    hand.click(person.field(panel, "reach"))
    person.idle()
    assert one.volume is None and one.scene.cloud.points.numPoints.getValue() == 0
