# SPDX-License-Identifier: LGPL-2.1-or-later
"""Undo, redo, copies and closed documents while every dock and panel is open."""

import subprocess
import threading
from pathlib import Path

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.brep.kernel import process as kernel_process
from freecad_am.objects.job_group import grouped, is_group

EXAMPLES = Path(__file__).resolve().parent.parent.parent / "resources" / "examples"
DOCKS = ("Path", "Plots", "SpinMap", "Simulate")


@pytest.fixture
def job(person, hemisphere):
    """Return the document of a job of few layers, in its group."""
    doc = hemisphere.Document
    cell, feature = (
        api.make_cell(doc, limits="paper"),
        api.make_feature(doc, hemisphere, layer_height=15),
    )
    toolpath = api.make_toolpath(doc, feature, cell)
    api.make_program(doc, api.make_joint_path(doc, toolpath, cell), name="CUP")
    grouped(doc, "Job of a cup", api.stages_of(doc))
    return doc


def statuses(doc):
    return [obj.Status for obj in api.stages_of(doc)]


def docks(person):
    return [
        dock
        for dock in person.present(person.widgets.QDockWidget)
        if dock.objectName().startswith("RoboticAM") and dock.isVisible()
    ]


@pytest.fixture
def watched(person, job, rough_map):
    """Return the job with all docks open on it."""
    for name in DOCKS:
        person.select(job.JointPath)
        person.gui.runCommand(f"RoboticAM_{name}")
        person.idle(0.4)
    yield job
    for dock in docks(person):
        dock.close()
    person.idle(0.2)


def focus(person, hand):
    """Click next to the part, so that the keys go to the 3D view."""
    view = person.gui.activeDocument().activeView()
    corner = hand.corner(view)
    hand.at((corner.x() + 6, corner.y() + view.getSize()[1] - 6))


def test_undo_and_redo_of_all_stages_under_open_docks(person, hand, watched):
    names, keys = (
        [obj.Name for obj in api.stages_of(watched)],
        [obj.Key for obj in api.stages_of(watched)],
    )
    assert len(docks(person)) >= 3
    steps = watched.UndoCount
    for _ in range(steps):
        focus(person, hand)
        hand.undo()
        person.idle(0.3)
    assert api.stages_of(watched) == []
    person.idle(0.5)
    for _ in range(steps):
        focus(person, hand)
        hand.redo()
        person.idle(0.3)
    assert [obj.Name for obj in api.stages_of(watched)] == names
    watched.recompute()
    assert [obj.Key for obj in api.stages_of(watched)] == keys and set(statuses(watched)) == {
        "up to date"
    }
    person.idle(0.5)


def test_a_stage_deleted_under_open_docks(person, watched):
    watched.openTransaction("Delete")
    watched.removeObject("JointPath")
    watched.commitTransaction()
    person.idle(0.5)
    watched.recompute()
    person.idle(0.5)
    watched.undo()
    person.idle(0.5)
    watched.recompute()
    assert set(statuses(watched)) == {"up to date"}


def test_a_document_closed_under_open_docks(person, watched, coarse):
    other_document = App.newDocument("Other")
    App.closeDocument(watched.Name)
    person.idle(1.0)
    ball = other_document.addObject("Part::Sphere", "Ball")
    ball.Angle1 = 0
    other_document.recompute()
    api.make_all(other_document, ball)
    person.idle(0.5)
    for name in DOCKS:
        person.select(other_document.JointPath)
        person.gui.runCommand(f"RoboticAM_{name}")
        person.idle(0.4)
    assert len(statuses(other_document)) >= 4


def test_a_document_closed_while_a_preview_is_with_the_kernel(person, monkeypatch):
    """The preview's kernel call runs in another process, which ends with the panel."""
    monkeypatch.setattr(kernel_process, "MAX_FACES", 0)
    doc = App.newDocument("Preview")
    blades = api.open_part(doc, str(EXAMPLES / "thruster" / "blades.brep"))
    spindle = api.open_part(doc, str(EXAMPLES / "thruster" / "spindle.step"))
    person.gui.Selection.clearSelection()
    for obj in (blades, spindle):
        person.gui.Selection.addSelection(doc.Name, obj.Name)
    person.click("RoboticAM_SolidsOnHub")
    panel = person.panel("RoboticAM_DevelopableFeature")
    person.until(
        lambda: [thread for thread in threading.enumerate() if thread.name == "Kernel process"],
        "the preview to begin",
        20,
    )
    App.newDocument("Other")
    App.closeDocument(doc.Name)
    person.idle(0.5)
    if person.gui.Control.activeDialog():
        person.press("Cancel")
    person.panel_closed()
    del panel
    person.until(
        lambda: not [thread for thread in threading.enumerate() if thread.name == "Robotic AM"],
        "the work to end",
        20,
    )
    assert len(kernel_process.kernel_workers.idle) <= 1 and not kernel_process.kernel_workers.unable


def test_the_window_finds_a_python_for_the_kernel(person, monkeypatch):
    """FreeCAD's own program is not a Python; without another one the window would wait for the
    kernel."""
    monkeypatch.setattr(kernel_process, "MAX_FACES", 0)
    doc = App.newDocument("Kernel")
    pipe = api.open_part(doc, str(EXAMPLES / "pipe.step"))
    tube = api.open_part(doc, str(EXAMPLES / "tube-on-pipe.step"))
    feature = api.make_surface_feature(doc, tube, ["Face1"], pipe)
    assert feature.Status == "up to date" and not kernel_process.kernel_workers.unable
    assert [process.popen.poll() for process in kernel_process.kernel_workers.idle] == [None]


def test_a_preview_after_the_kernel_process_has_left(person, monkeypatch):
    """The process ends after some minutes without work; the next preview starts another one, and
    FreeCAD continues."""
    monkeypatch.setattr(kernel_process, "MAX_FACES", 0)
    doc = App.newDocument("Later")
    pipe = api.open_part(doc, str(EXAMPLES / "pipe.step"))
    tube = api.open_part(doc, str(EXAMPLES / "tube-on-pipe.step"))

    def previewed():
        person.gui.Selection.clearSelection()
        person.gui.Selection.addSelection(doc.Name, tube.Name, "Face1")
        person.gui.Selection.addSelection(doc.Name, pipe.Name)
        person.click("RoboticAM_WallOnPart")
        panel = person.panel("RoboticAM_SurfaceFeature")
        note = person.field(panel, "preview")
        person.until(
            lambda: note.isVisible() and note.text().startswith("First layer: "), "the preview", 60
        )
        person.press("Cancel")
        person.panel_closed()
        return person.until(
            lambda: [process.popen for process in kernel_process.kernel_workers.idle],
            "the kernel to be free",
            20,
        )

    old_preview = previewed()
    for popen in old_preview:
        popen.terminate()
        popen.wait(20)
    new_preview = previewed()
    assert not set(old_preview) & set(new_preview) and [popen.poll() for popen in new_preview] == [
        None
    ] * len(new_preview)


def test_a_job_copied_by_keys_into_another_document(person, hand, job):
    """FreeCAD asks which objects to copy along, as for every object with inputs; Return takes all
    of them."""
    target = App.newDocument("Copy")
    person.gui.ActiveDocument = person.gui.getDocument(job.Name)
    App.setActiveDocument(job.Name)
    person.idle(0.3)
    person.select(next(obj for obj in job.Objects if is_group(obj)))
    questions = []

    def answer():
        box = person.widgets.QApplication.activeModalWidget()
        if box is not None and box.objectName() != "RoboticAM_Progress":
            questions.append(box.windowTitle())
            subprocess.Popen(["xdotool", "key", "Return"])

    timer = person.core.QTimer()
    timer.setInterval(400)
    timer.timeout.connect(answer)
    timer.start()
    person.gui.runCommand("Std_Copy")
    person.idle(0.5)
    person.gui.ActiveDocument = person.gui.getDocument(target.Name)
    App.setActiveDocument(target.Name)
    person.idle(0.3)
    person.gui.runCommand("Std_Paste")
    person.idle(0.5)
    timer.stop()
    target.recompute()
    assert (
        len(questions) <= 1
        and len(api.stages_of(target)) == 5
        and set(statuses(target)) == {"up to date"}
    )
    assert all(link.Document == target for obj in api.stages_of(target) for link in obj.OutList)
    App.closeDocument(job.Name)
    person.idle(0.3)
    api.change(target.getObject(api.stages_of(target, "feature")[0].Name), layer_height=20)
    assert set(statuses(target)) == {"up to date"}


@pytest.mark.any_version
def test_a_parameter_follows_a_spreadsheet_until_that_goes(person, hand, job):
    sheet = job.addObject("Spreadsheet::Sheet", "Sizes")
    sheet.set("A1", "=12 mm")
    sheet.setAlias("A1", "height")
    job.recompute()
    api.change(job.Feature, layer_height="=Sizes.height")
    layers = job.Toolpath.Layers
    sheet.set("A1", "=6 mm")
    job.recompute()
    assert job.Toolpath.Layers > layers and set(statuses(job)) == {"up to date"}
    job.openTransaction("Delete")
    job.removeObject("Sizes")
    job.commitTransaction()
    job.recompute()
    assert job.Feature.Status == "failed" and "Sizes.height" in job.Feature.Message
    person.idle(0.3)
    person.double_click(job.Feature)
    panel = person.panel("RoboticAM_RevolutionFeature")
    hand.enter(panel, "LayerHeight", "7 mm")
    person.press("Ok")
    person.panel_closed()
    assert job.Feature.LayerHeight.Value == 7.0 and set(statuses(job)) == {"up to date"}
    while job.getObject("Sizes") is None:
        job.undo()
    job.recompute()
    person.idle(0.3)
    assert job.Feature.LayerHeight.Value == 6.0 and set(statuses(job)) == {"up to date"}
