# SPDX-License-Identifier: LGPL-2.1-or-later
"""Export Path by clicks: files and objects appear, errors stay in the panel, one undo step."""

import csv
import json
import os
import threading
import time

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.gui import busy
from freecad_am.objects.work import progress
from freecad_am.report import made

NAME = "RoboticAM_ExportPath"


@pytest.fixture
def job(person):
    doc = App.newDocument("Export")
    doc.UndoMode = 1
    sphere = doc.addObject("Part::Sphere", "Sphere")
    sphere.Radius, sphere.Angle1, sphere.Angle2 = 45.0, 0, 90
    doc.recompute()
    feature = api.make_feature(doc, sphere, layer_height=15)
    toolpath = api.make_toolpath(doc, feature)
    person.open_workbench()
    person.gui.Selection.clearSelection()
    person.gui.Selection.addSelection(doc.Name, toolpath.Name)
    name = doc.Name
    yield toolpath
    if name in App.listDocuments():
        App.closeDocument(name)


def opened(person):
    person.click("RoboticAM_ExportPath")
    return person.panel(NAME)


def confirm_panel(person):
    person.press("Ok")
    person.panel_closed()


def refused(person):
    person.press("Ok")
    person.idle()


def test_wires_are_written_where_the_panel_says(person, job, tmp_path):
    folder = tmp_path / "fils"  # the other folder may have screenshots
    panel = opened(person)
    assert person.field(panel, "Path").currentText() == job.Label
    path = str(folder / "mes fils é.step")
    person.type(panel, "File", path)
    refused(person)
    note = person.field(panel, "FileNote")
    assert (
        note.isVisible()
        and note.text()
        == f"the folder {folder} does not exist; create the folder, or choose another"
    )
    assert not folder.exists()
    folder.mkdir()
    person.screenshot("export_path")
    confirm_panel(person)
    assert len(Part.read(path).Edges) == api.result(job).bead_count
    panel = opened(person)
    person.choose(panel, "Kind", "DXF file of polylines")
    assert person.field(panel, "File").text() == str(folder / f"{job.Label}.dxf")
    assert not person.field(panel, "Tolerance").isVisible()
    confirm_panel(person)
    assert sorted(os.listdir(folder)) == sorted([f"{job.Label}.dxf", "mes fils é.step"])


def test_waypoints_are_a_table_of_all_points_and_axes(person, job, tmp_path):
    """The robot has no post, and the table has the columns of every robot."""
    cell = api.make_cell(
        job.Document,
        machine="kuka-kr16-2",
        deposition_point=(1321, 0, 1621, 0, 0, 0),
        branch="auto",
    )
    path = api.make_joint_path(job.Document, job, cell)
    person.select(path)
    panel = opened(person)
    person.choose(panel, "Kind", "CSV table of waypoints")
    assert not person.field(panel, "Rapids").isVisible()
    person.type(panel, "File", str(tmp_path / "points.csv"))
    confirm_panel(person)
    with (tmp_path / "points.csv").open(encoding="ascii") as stream:
        rows = list(csv.DictReader(stream))
    motion = api.result(path).motion
    assert [name for name in rows[0] if name.startswith("q")] == [f"q{k}_deg" for k in range(1, 7)]
    joints = np.radians([[float(row[f"q{k}_deg"]) for k in range(1, 7)] for row in rows])
    np.testing.assert_allclose(joints, motion.joints, rtol=0, atol=1e-8)
    positions = [[float(row[f"{axis}_mm"]) for axis in "xyz"] for row in rows]
    np.testing.assert_allclose(positions, motion.position, rtol=0, atol=1e-6)
    assert {row["kind"] for row in rows} == {"deposit", "rapid"}


def test_a_joint_path_is_a_trajectory_of_ros(person, job, tmp_path):
    path = api.make_joint_path(job.Document, job, api.make_cell(job.Document, limits="paper"))
    person.select(path)
    panel = opened(person)
    person.choose(panel, "Kind", "JSON file of a ROS joint trajectory")
    person.type(panel, "File", str(tmp_path / "path.json"))
    confirm_panel(person)
    trajectory = json.loads((tmp_path / "path.json").read_text(encoding="utf-8"))
    motion = api.result(path).motion
    positions = [trajectory["points"][number]["positions"] for number in (0, -1)]
    np.testing.assert_allclose(positions, motion.joints[[0, -1]], rtol=0, atol=1e-8)


def panel_from_menu(job, person):
    """Return the panel that the entry of the context menu opens."""
    menu = person.widgets.QMenu()
    job.ViewObject.Proxy.setupContextMenu(job.ViewObject, menu)
    next(
        action for action in menu.actions() if action.objectName() == "RoboticAM_MenuExportReport"
    ).trigger()
    person.idle()
    return person.panel(NAME)


def test_the_report_of_a_joint_path_is_a_page(person, job, tmp_path):
    """The menu of the joint path opens it, also for a robot without a program; tests/batch checks
    the content of the page."""
    cell = api.make_cell(
        job.Document,
        machine="kuka-kr16-2",
        deposition_point=(1321, 0, 1621, 0, 0, 0),
        branch="auto",
    )
    path = api.make_joint_path(job.Document, job, cell)
    panel = panel_from_menu(path, person)
    assert person.field(panel, "Path").currentText() == path.Label
    assert person.field(panel, "Kind").currentText() == "HTML page of the report"
    assert not person.field(panel, "Rapids").isVisible()
    file = tmp_path / "none" / "page.html"
    person.type(panel, "File", str(file))
    refused(person)
    note = person.field(panel, "FileNote")
    assert (
        note.isVisible()
        and note.text()
        == f"the folder {file.parent} does not exist; create the folder, or choose another"
    )
    file.parent.mkdir()
    person.screenshot("export_report")
    confirm_panel(person)
    page = file.read_text(encoding="utf-8")
    assert [entry.name for entry in file.parent.iterdir()] == ["page.html"]
    assert (
        page.startswith("<!DOCTYPE html>") and page.endswith("</html>\n") and "KUKA KR 16-2" in page
    )
    assert f">{len(api.result(path).joint_path.beads)}</b><span>beads" in page
    panel_from_menu(job, person)  # a path without joints has one too
    person.press("Cancel")


def test_a_report_is_cancelled_and_leaves_nothing(person, job, tmp_path, monkeypatch):
    started = []

    def endless(self):
        started.append(True)
        for _ in range(6000):
            time.sleep(0.01)
            progress.report(0.8, "drawing the page")
        raise AssertionError("seen to the end")

    def cancel():
        for dialog in person.present(person.widgets.QDialog, busy.NAME):
            if started and dialog.isVisible():
                timer.stop()
                person.field(dialog, "cancel").click()

    monkeypatch.setattr(made.Made, "page", endless)
    timer = person.core.QTimer()
    timer.timeout.connect(cancel)
    panel = panel_from_menu(job, person)
    person.type(panel, "File", str(tmp_path / "page.html"))
    timer.start(50)
    person.press("Ok")
    assert started and "Cancelled" in person.panel_error(panel)
    monkeypatch.undo()
    person.until(
        lambda: not any(thread.name == "Robotic AM" for thread in threading.enumerate()),
        "the work to end",
        60,
    )
    assert not any(tmp_path.iterdir())
    person.press("Ok")
    person.panel_closed()
    assert (tmp_path / "page.html").is_file()


def test_what_cannot_be_written_is_told_in_the_panel(person, job, tmp_path):
    (tmp_path / "file").write_text("in the way")
    panel = opened(person)
    person.type(panel, "File", str(tmp_path / "file" / "a.step"))
    refused(person)
    note = person.field(panel, "FileNote")
    assert note.isVisible() and "does not exist" in note.text()
    assert not person.field(panel, "error").isVisible()
    person.type(panel, "File", str(tmp_path / "a.txt"))
    assert not note.isVisible()  # its cause is gone
    refused(person)
    assert note.isVisible() and "use the extension .step or .dxf" in note.text()
    person.choose(panel, "Kind", "CAM path in this document")
    assert not note.isVisible()
    person.press("Cancel")
    assert os.listdir(tmp_path) == ["file"]


def test_cam_path_and_trajectory_are_objects_in_one_step(person, job):
    doc = job.Document
    for kind, type_name in (
        ("CAM path in this document", "Path::Feature"),
        ("Robot trajectory in this document", "Robot::TrajectoryObject"),
    ):
        object_count, steps = len(doc.Objects), doc.UndoCount
        panel = opened(person)
        person.choose(panel, "Kind", kind)
        assert not person.field(panel, "File").isVisible()
        confirm_panel(person)
        assert doc.Objects[-1].TypeId == type_name and len(doc.Objects) == object_count + 1
        assert doc.UndoCount == steps + 1
        doc.undo()
        person.idle()
        assert len(doc.Objects) == object_count


def test_tolerances_take_no_expression(person, job):
    object_count, panel = len(job.Document.Objects), opened(person)
    person.choose(panel, "Kind", "Robot trajectory in this document")
    for name, value, unit in (("Tolerance", "0.1 mm", "mm"), ("Turn", "2 deg", "°")):
        field = person.field(panel, name)
        assert not field.lineEdit().actions()  # no button that starts an expression
        person.type(panel, name, "=1 + 1")
        refused(person)
        error = person.field(panel, "error").text()
        assert "takes no expression" in error and name in error and error.endswith(unit)
        person.type(panel, name, value)
    assert len(job.Document.Objects) == object_count
    person.press("Cancel")
    person.panel_closed()


def test_a_document_closed_meanwhile_is_told(person, job):
    panel = opened(person)
    App.newDocument("Other")  # FreeCAD 1.1 hides panels, which cover a view, where there is no view
    App.closeDocument(job.Document.Name)
    person.idle()
    if person.gui.Control.activeDialog():
        refused(person)
        assert "closed" in person.panel_error(panel) or "gone" in person.panel_error(panel)
        person.press("Cancel")
