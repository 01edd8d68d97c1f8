# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files show everything when they are opened, wherever they were made."""

import subprocess

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.gui.path.dock import facts
from freecad_am.gui.path.pieces import Rows
from freecad_am.objects.results import store

HEADLESS = """
import functools, sys
sys.path.insert(0, {root!r})
from freecad_am.batch import host
host.find_freecad()
import FreeCAD as App, Part
from freecad_am import api
document = App.newDocument("Made")
part = document.addObject("Part::Feature", "Part")
part.Shape = Part.makeSphere(45, App.Vector(), App.Vector(0, 0, 1), 0, 90)
api.make_feature_of = functools.partial(api.make_feature_of, values=dict(layer_height=5.0, chord_error=0.1))
stages = api.make_all(document, part)
assert len(stages) == 5
document.saveAs({path!r})
"""


def columns(document):
    motion = api.result(document.JointPath).motion
    beads = [bead.points for _, _, bead in api.result(document.Toolpath)]
    return [motion.joints, motion.position, motion.duration, *beads], api.result(
        document.Program
    ).files


def assert_shown(person, document):
    for obj in api.stages_of(document):
        covered = obj.Name == "Toolpath"  # hidden by the joint path, which is at the same place
        assert obj.ViewObject.Proxy is not None and obj.ViewObject.Visibility != covered, obj.Label
        assert obj.Status == "up to date" and "Touched" not in obj.State
    person.path_is_seen()


def test_saved_closed_and_opened_again(person, hemisphere, coarse, tmp_path):
    document = hemisphere.Document
    api.make_all(document, hemisphere)
    document.Toolpath.ViewObject.ShowDirections = True
    arrays, files = columns(document)
    assert_shown(person, document)
    path = str(tmp_path / "Été en ville.FCStd")
    document.saveAs(path)
    App.closeDocument(document.Name)
    again = App.openDocument(path)
    person.idle(0.4)
    assert again.Toolpath.ViewObject.ShowDirections
    assert_shown(person, again)
    person.screenshot("reopened")
    arrays_again, files_again = columns(again)
    assert files_again == files
    for array, reopened_array in zip(arrays, arrays_again, strict=True):
        assert np.array_equal(array, reopened_array, equal_nan=True)


def test_opening_reads_what_is_drawn_alone(person, hemisphere, coarse, tmp_path, monkeypatch):
    document = hemisphere.Document
    api.make_all(document, hemisphere)
    path = str(tmp_path / "part.FCStd")
    person.idle(0.2)
    document.saveAs(path)
    App.closeDocument(document.Name)
    read_parts, unpack = [], store.unpack
    monkeypatch.setattr(
        store, "unpack", lambda *arguments: read_parts.append(arguments[3]) or unpack(*arguments)
    )
    again = App.openDocument(path)
    person.idle(0.4)
    assert_shown(person, again)
    assert not {again.Toolpath.Label, again.JointPath.Label, again.Program.Label} & set(read_parts)
    view = again.JointPath.ViewObject.Proxy
    rows, margin = view.rows, view.scale.values
    person.select(again.JointPath)
    person.click("RoboticAM_Path")  # the dock describes the last bead
    facts_field = person.field(person.panel("RoboticAM_PathDock"), "facts")
    assert (
        facts_field.text().endswith(facts(rows, len(rows) - 1))
        and again.JointPath.Label not in read_parts
    )
    expected_facts = facts(rows, len(rows) - 2)
    assert again.JointPath.Label not in read_parts
    again.JointPath.ViewObject.Look = "tubes"
    assert read_parts.count(again.JointPath.Label) == 1
    planned = api.result(again.JointPath)
    assert read_parts.count(again.JointPath.Label) == 1
    paths = planned.joint_path.beads
    all_rows = Rows.of(
        [bead_path.bead for bead_path in paths],
        [bead_path.layer for bead_path in paths],
        8.0,
        lambda: 1.0,
    )
    for name in ("points", "starts", "layers", "width"):
        assert np.array_equal(getattr(rows, name), getattr(all_rows, name)), name
    assert len(rows.beads) == len(paths) and all(
        row_bead is path.bead for row_bead, path in zip(rows.beads, paths, strict=True)
    )
    assert (
        facts(rows, len(rows) - 2) == expected_facts and facts(rows, 0) != expected_facts
    )  # equal to reading only this bead
    assert margin.shape == (len(rows),) and 0.0 < margin.min() < margin.max() <= 100.0


def test_a_document_made_without_a_window_shows_its_path(person, root, tmp_path):
    path = str(tmp_path / "made.FCStd")
    code = HEADLESS.format(root=str(root), path=path)
    subprocess.run(["/usr/bin/python3", "-c", code], check=True, stdin=subprocess.DEVNULL)
    document = App.openDocument(path)
    person.idle(0.4)
    height = person.gui.ActiveDocument.ActiveView.getCameraNode().height.getValue()
    assert 90 < height < 600  # everything is visible before the camera moves
    assert_shown(person, document)
    person.double_click(document.Feature)
    person.panel("RoboticAM_RevolutionFeature")
    person.press("Cancel")
    person.panel_closed()
    document.saveAs(str(tmp_path / "again.FCStd"))
    App.closeDocument(document.Name)
    assert_shown(person, App.openDocument(str(tmp_path / "again.FCStd")))


@pytest.mark.any_version
def test_directions_and_infeasible_points_are_drawn_on_demand(person, hemisphere, no_remedies):
    document = hemisphere.Document
    cell = api.make_cell(document, limits="paper")
    toolpath = api.make_toolpath(
        document, api.make_feature(document, hemisphere, layer_height=5), cell
    )

    def pixels(colour):
        return int((np.abs(person.picture() - np.array(colour)).max(axis=1) < 25).sum())

    assert pixels((219, 51, 140)) == 0
    toolpath.ViewObject.ShowDirections = True
    assert pixels((219, 51, 140)) > 100
    person.screenshot("directions")
    toolpath.ViewObject.ShowDirections = False
    joint_path = api.make_joint_path(document, toolpath, cell, method="constant")
    assert joint_path.Status == "infeasible" and joint_path.Message
    assert pixels((230, 26, 51)) > 20
    person.screenshot("infeasible")


def test_a_copy_is_drawn_too(person, hemisphere):
    document = hemisphere.Document
    toolpath = api.make_toolpath(document, api.make_feature(document, hemisphere, layer_height=5))
    document.openTransaction("Copy")
    copy = document.copyObject(toolpath, False)
    document.commitTransaction()
    document.Feature.ViewObject.Visibility = toolpath.ViewObject.Visibility = False
    assert copy.Status == "up to date" and copy.ViewObject.Visibility
    person.path_is_seen()
    person.double_click(copy)
    person.panel("RoboticAM_Toolpath")
    person.press("Cancel")
    person.panel_closed()
