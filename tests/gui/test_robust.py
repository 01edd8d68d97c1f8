# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faults around a job give a message in words, without a traceback or an unexpected dialog."""

import gc
import json
import os
import re
import shutil
import sys
import threading
import weakref
import zipfile
from pathlib import Path

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.gui.panels import proposed_job as job_proposal
from freecad_am.gui.picking import Pick
from freecad_am.objects.job_group import is_group

TOOLS = (
    "NewJob",
    "Cell",
    "Feature",
    "WallOnPart",
    "Solid",
    "SolidsOnHub",
    "Toolpath",
    "JointPath",
    "Program",
)
EARLIER = Path(__file__).parent / "data" / "earlier.FCStd"


@pytest.fixture
def job(hemisphere):
    """Return the document of a job of few layers."""
    doc = hemisphere.Document
    cell, feature = (
        api.make_cell(doc, limits="paper"),
        api.make_feature(doc, hemisphere, layer_height=15),
    )
    toolpath = api.make_toolpath(doc, feature, cell)
    api.make_program(doc, api.make_joint_path(doc, toolpath, cell), name="CUP")
    return doc


def statuses(doc):
    return [obj.Status for obj in api.stages_of(doc)]


def use_everything(person, doc, renewed=None):
    """Open and close the panel of every stage, all context menus, the path dock and the simulation;
    renew some stages, or the last one, which renews all its inputs."""
    stages = api.stages_of(doc)
    renewed = stages[-1:] if renewed is None else renewed
    for obj in stages:
        person.double_click(obj)
        person.gui.Control.closeDialog()
        person.panel_closed()
        menu = person.widgets.QMenu()
        obj.ViewObject.Proxy.setupContextMenu(obj.ViewObject, menu)
        for action in menu.actions():
            expected = [
                "RoboticAM_MenuSimulate",
                *["RoboticAM_MenuRenew"] * (obj in renewed),
            ]  # this is an undo step
            if action.objectName() in expected and action.isEnabled():
                action.trigger()
                person.idle(0.1)
        for name in ("Colouring", "ShowMachine"):
            if hasattr(obj.ViewObject, name):
                value = getattr(obj.ViewObject, name)
                values = (
                    obj.ViewObject.getEnumerationsOfProperty(name)
                    if isinstance(value, str)
                    else [True, False]
                )
                for item in [*values, value]:
                    setattr(obj.ViewObject, name, item)
    person.gui.runCommand("RoboticAM_Path")
    person.idle()
    for name in ("RoboticAM_PathDock", "RoboticAM_ProgramText", "RoboticAM_Simulation"):
        for widget in person.present(person.widgets.QWidget, name):
            widget.close()
    person.idle()


def test_a_deleted_part_is_missing_everywhere_and_comes_back(person, job):
    person.select(job.Sphere)
    questions = person.will_answer("Yes")
    person.gui.runCommand("Std_Delete")
    person.idle(0.3)
    assert (
        len(questions) == 1 and "Feature" in questions[0]
    )  # FreeCAD's own question, which names the dependants
    assert job.Feature.Status == "failed" and "Source is missing" in job.Feature.Message
    job.recompute()
    assert statuses(job) == ["up to date", *["failed"] * 4]
    assert all("waits for" in obj.Message for obj in (job.Toolpath, job.JointPath, job.Program))
    use_everything(person, job, renewed=())
    person.gui.runCommand("Std_Undo")
    person.idle()
    job.recompute()
    assert statuses(job) == ["up to date"] * 5


@pytest.mark.parametrize("name", ["Cell", "Feature", "Toolpath", "JointPath"])
@pytest.mark.always("JointPath")
def test_a_deleted_stage_is_missing_and_comes_back(person, job, name):
    job.openTransaction("Delete")
    job.removeObject(name)
    job.commitTransaction()
    job.recompute()
    outdated = [obj for obj in api.stages_of(job) if obj.Status != "up to date"]
    assert (
        outdated if name != "Cell" else [obj.Name for obj in outdated] == ["JointPath", "Program"]
    )
    assert any("is missing" in obj.Message for obj in outdated)
    use_everything(person, job, renewed=())
    job.undo()
    job.recompute()
    person.idle()
    assert statuses(job) == ["up to date"] * 5


def test_a_link_whose_object_goes_is_told(person, hemisphere):
    doc = hemisphere.Document
    link = doc.addObject("App::Link", "Link")
    link.LinkedObject = hemisphere
    doc.recompute()
    feature = api.make_feature(doc, link, layer_height=15)
    toolpath = api.make_toolpath(doc, feature)
    doc.removeObject(hemisphere.Name)
    doc.recompute()
    assert feature.Status == "failed" and "Link" in feature.Message
    assert toolpath.Status != "up to date"
    use_everything(person, doc)
    doc.addObject("Part::Box", "Box")
    doc.recompute()
    person.select(link)
    person.click("RoboticAM_NewJob")
    assert "links to no object" in person.panel_error(person.panel("RoboticAM_NewJob"))
    person.press("Cancel")
    person.panel_closed()


def test_a_link_into_a_closed_document_keeps_the_result(person, hemisphere, tmp_path):
    source_document = hemisphere.Document
    source_document.saveAs(str(tmp_path / "pièce à côté.FCStd"))
    doc = App.newDocument("Job")
    doc.saveAs(str(tmp_path / "job.FCStd"))
    link = doc.addObject("App::Link", "Link")
    link.LinkedObject = hemisphere
    doc.recompute()
    feature = api.make_feature(doc, link, layer_height=15)
    toolpath = api.make_toolpath(doc, feature)
    doc.save()
    App.closeDocument(source_document.Name)
    person.idle(0.2)
    use_everything(person, doc)
    App.closeDocument(doc.Name)
    os.remove(tmp_path / "pièce à côté.FCStd")
    again = App.openDocument(str(tmp_path / "job.FCStd"))
    person.idle(0.3)
    feature, toolpath = again.Feature, again.Toolpath
    assert len(api.result(toolpath).layers) == toolpath.Layers
    assert feature.Status in ("up to date", "stale", "failed")
    again.recompute()
    use_everything(person, again)


def test_files_and_folders_that_cannot_be_written(person, job, tmp_path, monkeypatch):
    path = tmp_path / "job.FCStd"
    job.saveAs(str(path))
    App.closeDocument(job.Name)
    path.chmod(0o444)
    tmp_path.chmod(0o555)
    try:
        doc = App.openDocument(str(path))
        person.idle(0.3)
        assert statuses(doc) == ["up to date"] * 5
        person.double_click(doc.Feature)
        person.type(person.panel("RoboticAM_RevolutionFeature"), "LayerHeight", "20 mm")
        person.press("Ok")
        person.panel_closed()
        assert statuses(doc) == ["up to date"] * 5
        (Path(App.getTempPath()) / "no folder").write_text("a file", encoding="utf-8")
        unwritable = str(Path(App.getTempPath()) / "no folder")  # for root too
        monkeypatch.setattr(
            person.widgets.QFileDialog,
            "getExistingDirectory",
            staticmethod(lambda *_: os.path.join(unwritable, "out")),
        )
        person.double_click(doc.Program)
        panel = person.panel("RoboticAM_ProgramText")
        person.field(panel, "export").click()
        assert "choose a writable folder" in person.field(panel, "state").text()
        person.field(panel, "close").click()
    finally:
        tmp_path.chmod(0o755)


@pytest.mark.parametrize("command", TOOLS)
@pytest.mark.always("Cell", "JointPath", "NewJob", "WallOnPart", "Program")
def test_a_document_closed_while_a_panel_is_open(person, job, command):
    person.select(job.Sphere)
    person.click(f"RoboticAM_{command}")
    assert person.gui.Control.activeDialog()
    App.newDocument("Other")
    App.closeDocument(job.Name)
    person.idle(0.6)
    if person.gui.Control.activeDialog():
        person.press("Ok")
        person.idle()
        if person.gui.Control.activeDialog():
            person.press("Cancel")
    person.panel_closed()
    assert api.stages_of(App.getDocument("Other")) == []


@pytest.mark.long
def test_closed_panels_leave_nothing_behind(person, job, coarse):
    """Fields disappear with their panel, not when Python collects cycles, or never: otherwise they
    would be mistaken for later ones."""

    class Wrappers(dict):
        """Remember whether a type is one of Qt's, because there are a million objects."""

        def __missing__(self, kind):
            return self.setdefault(kind, issubclass(kind, person.core.QObject))

    wraps = Wrappers()

    def wrappers():
        return [obj for obj in gc.get_objects() if wraps[type(obj)]]

    def dead():
        """Return the types of deleted widgets that Python still holds; a holder keeps the rest of
        their panel too."""
        wrappers_held = [*(reference() for reference in old), *wrappers()]
        return [
            type(obj).__name__
            for obj in wrappers_held
            if obj is not None and not person.qt.isValid(obj)
        ]

    def press(name):
        """Press a button without asking the main window, which would keep what it finds."""
        button_kind = getattr(person.widgets.QDialogButtonBox, name)
        boxes = [
            box
            for box in person.widgets.QApplication.allWidgets()
            if isinstance(box, person.widgets.QDialogButtonBox)
        ]
        next(
            box.button(button_kind)
            for box in boxes
            if box.isVisible() and box.button(button_kind) is not None
        ).click()
        person.idle()

    person.idle(0.5)
    gc.collect()
    gc.disable()
    old = [weakref.ref(obj) for obj in wrappers()]
    gc.freeze()  # scan the million existing objects once; from now on only new wrappers
    try:
        dead_count = len(dead())
        for command in (*TOOLS, "ExportPath", "Inspect"):
            for standard_button in ("Cancel", "Ok"):
                person.select(job.Sphere)
                person.click(f"RoboticAM_{command}")
                person.idle(0.5)  # for deferred actions
                press(standard_button)
                if person.gui.Control.activeDialog():  # OK was rejected
                    press("Cancel")
                person.panel_closed()
                # delete the new stages, to keep their toolpath fast
                for stage in api.stages_of(job):
                    if getattr(stage, "LayerHeight", 15) != 15:
                        stage.LayerHeight = 15
                remaining = dead()
                for _ in range(20):  # cancelled threads may still run
                    if len(remaining) <= dead_count:
                        break
                    person.idle(0.2)
                    remaining = dead()
                assert len(remaining) <= dead_count, (
                    command,
                    standard_button,
                    set(remaining[dead_count:]),
                )
    finally:
        gc.unfreeze()
        gc.enable()


def test_a_document_closed_while_its_part_is_looked_at(person, hemisphere, monkeypatch):
    """The result belongs to a deleted object, and so do later choices."""
    proposal = job_proposal.JobProposal("revolution", "", (Pick(hemisphere),))
    closed = threading.Event()

    def slowly():
        closed.wait(20)
        return proposal

    monkeypatch.setattr(job_proposal, "proposal", lambda picks, bead_width: slowly)
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    App.newDocument("Other")
    App.closeDocument(hemisphere.Document.Name)
    kind = person.field(panel, "Kind")
    kind.activated.emit(kind.currentIndex())  # before the panel closes too
    person.press("Ok")
    closed.set()
    person.panel_closed()
    person.idle(0.4)


def test_a_machine_file_that_is_gone(person, hemisphere, coarse, tmp_path, monkeypatch):
    content = json.loads(
        (machines.BUILT_IN / "fanuc-arcmate120ic.json").read_text(encoding="utf-8")
    )
    content["id"] = "mine"
    from freecad_am.objects import user_machines

    monkeypatch.setattr(user_machines, "folders", lambda: (Path(tmp_path),))
    file = tmp_path / "mine.json"
    file.write_text(json.dumps(content), encoding="utf-8")
    doc = hemisphere.Document
    api.make_all(doc, hemisphere, machine="mine")
    assert set(statuses(doc)) == {"up to date"}
    file.unlink()
    doc.Cell.PlatformDiameter = 150
    doc.recompute()
    assert doc.Cell.Status == "failed" and "mine" in doc.Cell.Message
    use_everything(person, doc)
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    person.idle(0.5)
    assert (
        person.field(person.panel("RoboticAM_NewJob"), "Machine").currentText() == "mine"
    )  # like the cell before
    person.press("Ok")
    assert "mine" in person.panel_error(person.panel("RoboticAM_NewJob"))
    person.press("Cancel")
    person.panel_closed()
    assert len(api.stages_of(doc)) == 5


def test_two_documents_at_once(person, hemisphere, coarse):
    first_document, second_document = hemisphere.Document, App.newDocument("Other")
    ball = second_document.addObject("Part::Sphere", "Ball")
    ball.Angle1 = 0
    second_document.recompute()
    App.setActiveDocument(first_document.Name)
    person.gui.ActiveDocument = person.gui.getDocument(first_document.Name)
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    App.setActiveDocument(second_document.Name)
    person.gui.ActiveDocument = person.gui.getDocument(second_document.Name)
    person.select(ball)
    person.idle(0.3)
    assert person.field(panel, "Source").text() == hemisphere.Label
    person.as_revolution(panel)
    person.press("Ok")
    person.panel_closed()
    assert statuses(first_document) == ["up to date"] * 5 and statuses(second_document) == []
    person.select(ball)
    person.click("RoboticAM_NewJob")
    person.idle(0.5)
    person.as_revolution()
    person.press("Ok")
    person.panel_closed()
    assert len(statuses(second_document)) >= 4
    second_document.undo()
    assert statuses(second_document) == [] and statuses(first_document) == ["up to date"] * 5
    use_everything(person, first_document)


@pytest.mark.parametrize("whole", [True, False])
@pytest.mark.always("False")
def test_a_job_copied_into_another_document(person, hemisphere, coarse, whole):
    doc = hemisphere.Document
    api.make_all(doc, hemisphere)
    group = next(obj for obj in doc.Objects if is_group(obj))
    target = App.newDocument("Copy")
    if whole:
        target.copyObject([group], True)  # with its dependencies
        person.idle()
        target.recompute()
        assert statuses(target) == ["up to date"] * 5 and len(api.stages_of(target)) == 5
        copied = next(obj for obj in target.Objects if is_group(obj))
        assert {obj.Name for obj in copied.Group} == {obj.Name for obj in api.stages_of(target)}
        assert all(link.Document == target for obj in api.stages_of(target) for link in obj.OutList)
    else:
        target.copyObject([doc.JointPath], False)
        person.idle()
        target.recompute()
        assert [obj.Proxy.kind for obj in api.stages_of(target)] == ["joint path"]
        assert target.JointPath.Status == "failed" and "is missing" in target.JointPath.Message
    use_everything(person, target)
    assert statuses(doc) == ["up to date"] * 5
    App.closeDocument(doc.Name)
    person.idle()
    use_everything(person, target)


@pytest.mark.long
def test_undo_and_redo_across_recomputes(person, job):
    keys = [[obj.Key for obj in api.stages_of(job)]]
    for height in (20, 30):
        job.openTransaction("Height")
        job.Feature.LayerHeight = height
        job.recompute()
        job.commitTransaction()
        keys.append([obj.Key for obj in api.stages_of(job)])
    job.openTransaction("Radius")
    job.Sphere.Radius = 40
    job.commitTransaction()
    job.recompute()
    assert statuses(job) == ["up to date"] * 5
    job.undo()
    job.recompute()
    assert [obj.Key for obj in api.stages_of(job)] == keys[2]
    job.undo()
    job.undo()
    person.idle()
    job.recompute()
    assert [obj.Key for obj in api.stages_of(job)] == keys[0] and statuses(job) == [
        "up to date"
    ] * 5
    for k in (1, 2):
        job.redo()
        person.idle()
        job.recompute()
        assert [obj.Key for obj in api.stages_of(job)] == keys[k] and statuses(job) == [
            "up to date"
        ] * 5
    assert len(api.result(job.Toolpath).layers) == job.Toolpath.Layers
    use_everything(person, job, renewed=api.stages_of(job))


def test_a_document_of_an_earlier_version(person, tmp_path):
    """The window of an earlier commit saved it: it opens with its results, is usable at once, and
    can be renewed."""
    path = str(tmp_path / "earlier.FCStd")
    shutil.copy(EARLIER, path)
    doc = App.openDocument(path)
    person.idle(0.5)
    assert [obj.Proxy.kind for obj in api.stages_of(doc)] == [
        "cell",
        "feature",
        "toolpath",
        "joint path",
        "program",
    ]
    with zipfile.ZipFile(EARLIER) as file:
        named = set(
            re.findall(r'module="(freecad_am\.gui\.[^"]+)"', file.read("GuiDocument.xml").decode())
        )
    assert (
        len(named) == 5 and named <= sys.modules.keys()
    )  # view providers are found, under any former name
    assert len(api.result(doc.Toolpath).layers) == doc.Toolpath.Layers > 0
    use_everything(person, doc)
    doc.recompute()
    person.idle()
    api.recompute(doc, force=True)
    assert statuses(doc) == ["up to date"] * 5
    assert "EARLIER.LS" in doc.Program.Files
    person.double_click(doc.Cell)
    person.press("Ok")
    person.panel_closed()
    use_everything(person, doc)


@pytest.mark.parametrize("text", ["2,5 mm", "2,5", "0,25 cm"])
@pytest.mark.always("0,25 cm", "2,5")
def test_decimals_with_a_comma(person, hemisphere, text):
    original_locale = person.core.QLocale()
    french = person.core.QLocale(person.core.QLocale.French, person.core.QLocale.France)
    person.core.QLocale.setDefault(french)  # both as FreeCAD sets them for French
    person.window.setLocale(french)
    try:
        person.select(hemisphere)
        person.click("RoboticAM_Feature")
        panel = person.panel("RoboticAM_RevolutionFeature")
        person.type(panel, "LayerHeight", text)
        person.press("Ok")
        person.panel_closed()
        doc = hemisphere.Document
        assert abs(doc.Feature.LayerHeight.Value - 2.5) < 1e-12
        undo = doc.UndoCount
        person.double_click(doc.Feature)
        person.press("Ok")  # the shown values are read as the original ones
        person.panel_closed()
        assert abs(doc.Feature.LayerHeight.Value - 2.5) < 1e-12 and doc.UndoCount == undo
    finally:
        person.core.QLocale.setDefault(original_locale)
        person.window.setLocale(original_locale)
