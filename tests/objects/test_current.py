# SPDX-License-Identifier: LGPL-2.1-or-later
"""No function that writes files writes a result that does not fit the current document."""

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError
from freecad_am.objects import staleness

OK, STALE = "up to date", "stale"
WRITERS = {
    "export": lambda job, folder: api.export(job.program, str(folder / "program")),
    "step": lambda job, folder: api.export_wires(job.joint_path, str(folder / "w.step")),
    "dxf": lambda job, folder: api.export_wires(job.toolpath, str(folder / "w.dxf")),
    "trajectory of ROS": lambda job, folder: api.export_joint_trajectory(
        job.joint_path, str(folder / "j.json")
    ),
    "waypoints": lambda job, folder: api.export_waypoints(job.joint_path, str(folder / "w.csv")),
    "waypoints of the program": lambda job, folder: api.export_waypoints(
        job.program, str(folder / "p.csv")
    ),
    "report": lambda job, folder: api.export_report(job.program, str(folder / "r.html")),
    "CAM path": lambda job, folder: api.make_cam_path(job.joint_path),
    "trajectory": lambda job, folder: api.make_trajectory(job.joint_path),
}


def write(name, job, folder):
    """Let one function write, and return whether it wrote or created anything."""
    folder.mkdir(exist_ok=True)
    object_count = len(job.doc.Objects)
    try:
        WRITERS[name](job, folder)
    except InputError as error:
        if error.code == "NO_MODULE":
            pytest.skip("this FreeCAD lacks the other workbench")
        assert error.code in ("NO_RESULT", "NO_PROGRAM") and "recompute" in str(error)
        assert not list(folder.rglob("*")) and len(job.doc.Objects) == object_count
        return False
    return True


@pytest.fixture
def nested(doc):
    """Return a job of a box in a part in a part."""
    inner, outer = doc.addObject("App::Part", "Inner"), doc.addObject("App::Part", "Outer")
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 40, 20, 8
    inner.addObject(box)
    outer.addObject(inner)
    doc.recompute()
    feature = api.make_solid_feature(doc, box, layer_height=4)
    return doc, inner, outer, box, feature, api.make_toolpath(doc, feature)


@pytest.mark.parametrize("name", WRITERS)
def test_a_part_that_was_changed_and_not_recomputed(job, tmp_path, name):
    assert write(name, job, tmp_path / "now")
    job.part.Radius = 30
    assert not write(name, job, tmp_path / "changed")
    job.doc.recompute()
    assert write(name, job, tmp_path / "then")


@pytest.mark.parametrize("name", WRITERS)
def test_changes_that_freecad_tells_nobody_of(job, tmp_path, name):
    # like frozen objects: FreeCAD 1.0 changes their shape and notifies neither observers nor
    # dependants
    lowest = api.result(job.toolpath).layers[0].beads[0].points[:, 2].min()
    App.removeDocumentObserver(staleness.document_observer())
    try:
        job.part.Placement.Base = App.Vector(0, 0, 7)
    finally:
        App.addDocumentObserver(staleness.document_observer())
    job.part.purgeTouched()
    assert job.program.Status == OK
    assert not write(name, job, tmp_path / "changed")
    job.doc.recompute()
    assert job.program.Status == OK
    assert write(name, job, tmp_path / "then")
    raised = api.result(job.toolpath).layers[0].beads[0].points[:, 2].min()
    assert raised == pytest.approx(lowest + 7.0)


@pytest.mark.parametrize("which", ["inner", "outer"])
def test_a_container_that_was_moved(nested, tmp_path, which):
    doc, inner, outer, _, feature, toolpath = nested
    container = inner if which == "inner" else outer
    lowest = api.result(toolpath).layers[0].beads[0].points[:, 2].min()
    container.Placement.Base = App.Vector(0, 0, 25)
    assert [feature.Status, toolpath.Status] == [STALE, STALE]
    with pytest.raises(InputError, match="recompute"):
        api.export_wires(toolpath, str(tmp_path / "w.dxf"))
    doc.recompute()
    assert [feature.Status, toolpath.Status] == [OK, OK]
    raised = api.result(toolpath).layers[0].beads[0].points[:, 2].min()
    assert raised == pytest.approx(lowest + 25.0)
    api.export_wires(toolpath, str(tmp_path / "w.dxf"))


def test_a_neighbour_in_the_container_makes_nothing_stale(nested):
    doc, inner, _, _, feature, toolpath = nested
    neighbour = doc.addObject("Part::Cylinder", "Other")
    inner.addObject(neighbour)
    doc.recompute()
    neighbour.Radius = 3
    neighbour.Placement.Base = App.Vector(50, 0, 0)
    assert [feature.Status, toolpath.Status] == [OK, OK]


def test_a_part_that_leaves_its_container(nested, tmp_path):
    doc, inner, _, box, _, toolpath = nested
    inner.Placement.Base = App.Vector(0, 0, 25)
    doc.recompute()
    inner.removeObject(box)
    with pytest.raises(InputError, match="recompute"):
        api.export_wires(toolpath, str(tmp_path / "w.dxf"))
    doc.recompute()
    assert api.result(toolpath).layers[0].beads[0].points[:, 2].min() < 10.0


def test_a_spreadsheet_behind_the_place_of_a_container(nested, tmp_path):
    doc, inner, _, _, feature, toolpath = nested
    sheet = doc.addObject("Spreadsheet::Sheet", "Sheet")
    sheet.set("A1", "5")
    sheet.setAlias("A1", "height")
    inner.setExpression("Placement.Base.z", "Sheet.height")
    doc.recompute()
    assert toolpath.Status == OK
    sheet.set("A1", "45")
    assert [feature.Status, toolpath.Status] == [STALE, STALE]
    with pytest.raises(InputError, match="recompute"):
        api.export_wires(toolpath, str(tmp_path / "w.dxf"))
    doc.recompute()
    assert toolpath.Status == OK
    assert api.result(toolpath).layers[0].beads[0].points[:, 2].min() == pytest.approx(45.0)


def test_an_opened_document_is_up_to_date(nested, tmp_path):
    doc, inner, *_ = nested
    inner.Placement.Base = App.Vector(0, 0, 25)
    doc.recompute()
    path = str(tmp_path / "saved.FCStd")
    doc.saveCopy(path)
    opened = App.openDocument(path)
    try:
        toolpath = api.stages_of(opened, "toolpath")[0]
        api.export_wires(toolpath, str(tmp_path / "w.dxf"))
        opened.recompute()
        assert toolpath.Status == OK
    finally:
        App.closeDocument(opened.Name)


def test_a_linked_document_that_was_changed(tmp_path):
    linked_document, doc = App.newDocument("Linked"), App.newDocument("Linking")
    try:
        box = linked_document.addObject("Part::Box", "Box")
        box.Length, box.Width, box.Height = 40, 20, 8
        linked_document.recompute()
        linked_document.saveAs(str(tmp_path / "linked.FCStd"))
        doc.saveAs(str(tmp_path / "linking.FCStd"))
        link = doc.addObject("App::Link", "Link")
        link.setLink(box)
        doc.recompute()
        toolpath = api.make_toolpath(doc, api.make_solid_feature(doc, link, layer_height=4))
        box.Length = 60
        assert toolpath.Status == STALE
        with pytest.raises(InputError, match="recompute"):
            api.export_wires(toolpath, str(tmp_path / "w.dxf"))
        linked_document.recompute()
        doc.recompute()
        assert toolpath.Status == OK
        points = api.result(toolpath).layers[0].beads[0].points
        assert points[:, 0].max() - points[:, 0].min() > 44.0
    finally:
        App.closeDocument(doc.Name)
        App.closeDocument(linked_document.Name)


def test_a_stage_that_freecad_leaves_out(job, tmp_path):
    """FreeCAD skips frozen objects; the export names the first one and the remedy."""
    doc = job.doc
    job.feature.LayerHeight = 4.0
    doc.recompute([job.feature])
    assert job.feature.Status == OK and job.toolpath.Status == STALE
    assert "Toggle Freeze" in job.toolpath.Message
    for write_it in (
        lambda: api.export(job.program, str(tmp_path / "program")),
        lambda: api.export_wires(job.joint_path, str(tmp_path / "w.dxf")),
    ):
        with pytest.raises(InputError, match=f"{job.toolpath.Label}.*Toggle Freeze"):
            write_it()
    assert not list(tmp_path.rglob("*.*"))
    doc.recompute()
    assert job.program.Status == OK and "Toggle Freeze" not in job.toolpath.Message
    api.export(job.program, str(tmp_path / "program"))
