# SPDX-License-Identifier: LGPL-2.1-or-later
"""A document counts as changed only after a change: not after opening it, or opening panels and
docks of its stages."""

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.batch.job.part_source import PartSource
from freecad_am.batch.job.shapes import bring
from freecad_am.core.issues import InputError

PANELS = {
    "Cell": "RoboticAM_Cell",
    "Feature": "RoboticAM_RevolutionFeature",
    "Toolpath": "RoboticAM_Toolpath",
    "JointPath": "RoboticAM_JointPath",
}


def touched_objects(document):
    return [obj.Label for obj in document.Objects if "Touched" in obj.State]


@pytest.fixture
def saved(person, hemisphere, coarse, tmp_path):
    """Return a job saved like a user's."""
    document = hemisphere.Document
    api.make_all(document, hemisphere)
    document.recompute()
    person.idle(0.3)
    document.saveAs(str(tmp_path / "job.FCStd"))
    person.gui.SendMsgToActiveView("Save")
    assert not person.gui.getDocument(document.Name).Modified
    return document


def test_panels_and_docks_change_nothing(person, saved):
    window = person.gui.getDocument(saved.Name)
    for name, panel in PANELS.items():
        person.double_click(saved.getObject(name))
        person.panel(panel)
        person.idle(0.3)
        assert not window.Modified and touched_objects(saved) == [], name
        person.press("Cancel")
        person.panel_closed()
        assert not window.Modified and touched_objects(saved) == [], name
    for stage in (saved.Toolpath, saved.JointPath):  # each is shown in place of the other one
        person.select(stage)
        person.click("RoboticAM_Path")
        person.idle(0.3)
        assert stage.ViewObject.Visibility and stage.Visibility
        assert not window.Modified and touched_objects(saved) == [], stage.Label
    saved.Toolpath.ViewObject.Visibility = True  # by the user, in the tree
    assert window.Modified


def test_opened_and_pasted_jobs_are_up_to_date(person, saved, tmp_path):
    path = saved.FileName
    App.closeDocument(saved.Name)
    again = App.openDocument(path)
    person.idle(0.4)
    assert not person.gui.getDocument(again.Name).Modified and touched_objects(again) == []
    group = again.findObjects("App::DocumentObjectGroup")[0]
    other_document = App.newDocument("Other")
    other_document.copyObject(group, True)
    again.copyObject(group, True)
    person.idle(0.3)
    for document, count in ((other_document, 5), (again, 10)):
        stages = api.stages_of(document)
        assert len(stages) == count
        assert [stage.Label for stage in stages if "Touched" in stage.State] == []
        assert {stage.Status for stage in stages} == {"up to date"}
    # FreeCAD 1.0 touches pasted shapes, for its names of faces; one recompute ends that without
    # recomputing a stage
    keys = [stage.Key for stage in api.stages_of(other_document)]
    other_document.recompute()
    assert touched_objects(other_document) == [] and keys == [
        stage.Key for stage in api.stages_of(other_document)
    ]
    api.export(other_document.Program, str(tmp_path / "program"))


def test_a_frozen_stage_is_not_exported(person, saved, tmp_path):
    if int(App.Version()[0]) < 1:
        pytest.skip("FreeCAD freezes objects since 1.0")
    person.select(saved.Toolpath)
    person.gui.runCommand("Std_ToggleFreeze")
    saved.Feature.LayerHeight = 4.0
    saved.recompute()
    assert saved.Toolpath.Status == "stale" and "Toggle Freeze" in saved.Toolpath.Message
    with pytest.raises(InputError, match=r"Toolpath.*Toggle Freeze"):
        api.export(saved.Program, str(tmp_path / "program"))
    person.select(saved.Toolpath)
    person.gui.runCommand("Std_ToggleFreeze")
    saved.recompute()
    assert saved.Program.Status == "up to date"
    api.export(saved.Program, str(tmp_path / "program"))


@pytest.mark.parametrize("frozen", ["Box", "Cut"])
def test_a_value_set_of_what_was_frozen_when_it_was_saved(person, tmp_path, frozen):
    """Files do not store the frozen state: a value set in the opened file changes the part, frozen
    or not."""
    if App.Version()[:2] != ["1", "0"]:
        pytest.skip(
            "FreeCAD freezes objects since 1.0, and 1.1 saves no document with frozen objects"
        )
    document = App.newDocument("Frozen")
    box, hole = document.addObject("Part::Box", "Box"), document.addObject("Part::Box", "Hole")
    hole.Length, hole.Width, hole.Height = 2, 2, 10
    cut = document.addObject("Part::Cut", "Cut")
    cut.Base, cut.Tool = box, hole
    document.recompute()
    person.select(document.getObject(frozen))
    person.gui.runCommand("Std_ToggleFreeze")
    document.saveAs(str(tmp_path / "frozen.FCStd"))
    box.Length = 20
    document.recompute()
    assert cut.Shape.Volume == pytest.approx(960)  # the object or its inputs are frozen
    job = App.newDocument("Job")
    feature = bring(
        job, PartSource(document.FileName, "Cut", settings=(("Box", "Length", "30 mm"),))
    )
    assert feature.Shape.Volume == pytest.approx(30 * 10 * 10 - 40)
