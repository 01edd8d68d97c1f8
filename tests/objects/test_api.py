# SPDX-License-Identifier: LGPL-2.1-or-later
"""The macro interface: parameters as keywords, no remains of failed calls, files in and out."""

import dataclasses
import math
import os

import FreeCAD as App
import Mesh
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError, Issue
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.strategies import estimated_size
from freecad_am.core.strategies.solids import plan as solids_plan
from freecad_am.macro import suit
from freecad_am.objects.checks import controllers
from freecad_am.objects.program import files_of
from freecad_am.objects.work import progress

LABEL = "Hémisphère n° 1"


def test_keywords_are_in_outer_units(doc):
    cell = api.make_cell(
        doc,
        "Ma cellule",
        nozzle_half_angle="0.5 rad",
        nozzle_length=80,
        deposition_point=(1000, 0, 700, 0, 90, 0),
        platform="1 cm",
        branch="front up noflip",
        platform_diameter=App.Units.Quantity("12 cm"),
    )
    parameters = api.result(cell)
    assert parameters.nozzle.half_angle == pytest.approx(0.5) and parameters.nozzle.length == 80
    assert parameters.deposition_point == pytest.approx((1000, 0, 700, 0, math.pi / 2, 0))
    assert (parameters.platform, parameters.platform_diameter) == (10.0, 120.0)
    assert parameters.branch == ("front", "up", "noflip") and cell.Label == "Ma cellule"
    api.change(cell, platform_diameter=90, nozzle_length="10 cm")
    assert (api.result(cell).platform_diameter, api.result(cell).nozzle.length) == (90.0, 100.0)


def test_dataclasses_and_keywords_together(doc, part):
    feature = api.make_feature(
        doc,
        part,
        strategy=RevolutionParameters(layer_height=7.0, spacing="iso-height"),
        build_direction=BuildDirectionParameters(max_tilt=1.0),
        chord_error=0.02,
    )
    assert feature.Proxy.parameters(feature, RevolutionParameters) == RevolutionParameters(
        7.0, 0.02, "iso-height"
    )
    assert feature.MaxTilt.Value == pytest.approx(math.degrees(1.0))
    cell = api.make_cell(doc, parameters=CellParameters(platform_diameter=60.0))
    assert api.result(cell) == CellParameters(platform_diameter=60.0)


@pytest.mark.parametrize("undo", [0, 1])
@pytest.mark.parametrize(
    ("values", "code", "where"),
    [
        ({"layer_height": -1}, "BAD_VALUE", "strategy.layer_height"),
        ({"layer_height": "1 s"}, "BAD_UNIT", "strategy.layer_height"),
        ({"layer_height": "1,5 mm"}, "BAD_VALUE", "strategy.layer_height"),
        ({"layer_height": 1e-6}, "TOO_MANY", "strategy.layer_height"),
        ({"spacing": "odd"}, "BAD_VALUE", "strategy.spacing"),
        ({"layer_hight": 1}, "UNKNOWN_PARAMETER", "Feature"),
        ({"faces": ["Edge1"]}, "BAD_FACES", "Feature.Source"),
        ({"faces": ["Face9"]}, None, None),
    ],
)
def test_what_fails_leaves_nothing_behind(doc, part, undo, values, code, where):
    doc.UndoMode = undo
    with pytest.raises(InputError) as caught:
        api.make_feature(doc, part, **values)
    if code:
        assert (caught.value.code, caught.value.where) == (code, where)
    assert [obj.Name for obj in doc.Objects] == [part.Name]
    assert doc.UndoCount == 0 and not doc.HasPendingTransaction


def test_a_failed_change_changes_nothing(job):
    job.doc.UndoMode = 1
    with pytest.raises(InputError):
        api.change(job.feature, chord_error=0.05, layer_height=0)
    assert (job.feature.ChordError.Value, job.feature.Status) == (0.01, "up to date")


def test_a_step_in_which_nothing_changed_is_not_left_open(job):
    """FreeCAD closes no step that no document has begun; the next step once became part of it, and
    was not undone."""
    job.doc.UndoMode = 1
    for refused in (0, 0, 1e-6, 1e-6):
        with pytest.raises(InputError):
            api.change(job.feature, layer_height=refused)
        assert App.getActiveTransaction() is None and job.doc.UndoCount == 0
        assert (job.feature.LayerHeight.Value, job.feature.Status, job.feature.State) == (
            10.0,
            "up to date",
            ["Up-to-date"],
        )
    api.change(job.feature)
    assert App.getActiveTransaction() is None
    api.change(job.feature, layer_height=20)
    api.change(job.feature, layer_height=12)
    assert job.doc.UndoNames == ["Edit Feature", "Edit Feature"]


def test_missing_inputs_are_told(doc, part):
    for make in (
        lambda: api.make_feature(doc, None),
        lambda: api.make_toolpath(doc, None),
        lambda: api.make_joint_path(doc, None, None),
        lambda: api.make_program(doc, None),
    ):
        with pytest.raises(InputError, match="is missing; choose"):
            make()
    with pytest.raises(InputError, match="no shape"):
        api.make_feature(doc, api.make_cell(doc))
    with pytest.raises(InputError, match="not a stage"):
        api.result(part)


def test_what_is_not_a_document_or_a_path_is_refused_by_name(doc, part):
    for call, where in (
        (lambda: api.open_part("a.step", doc), "doc"),
        (lambda: api.open_part(doc, part), "path"),
        (lambda: api.open_part(None, "a.csv"), "doc"),
        (lambda: api.make_cell(part), "doc"),
        (lambda: api.make_surface_feature(part, ["Face1"], part), "doc"),
        (lambda: api.make_toolpath(part, doc), "doc"),
        (lambda: api.make_all(part, doc), "doc"),
        (lambda: api.make_all(doc, part, cell=part), "cell"),
        (lambda: api.make_scan(part, doc, "a.ply"), "doc"),
        (lambda: api.make_scan(doc, "a.ply", part), "file"),
        (lambda: api.inspect(doc, "a.csv", part), "file"),
        (lambda: api.read_cell(part), "cell"),
        (lambda: api.stages_of(part), "doc"),
        (lambda: api.recompute("Feature"), "target"),
        (lambda: api.export("out", part), "folder"),
        (lambda: api.export_cell("a.yaml", part), "path"),
        (lambda: api.export_wires("a.dxf", part), "path"),
        (lambda: api.export_waypoints("a.csv", part), "path"),
        (lambda: api.export_report("a.html", part), "path"),
    ):
        with pytest.raises(InputError) as caught:
            call()
        assert (caught.value.code, caught.value.where) == ("BAD_INPUT", where)
    with pytest.raises(InputError) as caught:
        api.open_part("cup.step", doc)
    assert caught.value.line() == (
        "error[BAD_INPUT] doc: 'cup.step' is not a document; pass a document, such as FreeCAD.ActiveDocument"
    )
    with pytest.raises(
        InputError, match=f"path: {part.Label} is not a path; pass a path as a text"
    ):
        api.open_part(doc, part)
    assert [obj.Name for obj in doc.Objects] == [part.Name]


def test_stale_inputs_are_renewed_by_what_is_made_from_them(doc, part):
    feature = api.make_feature(doc, part, layer_height=10)
    feature.LayerHeight = 20
    toolpath = api.make_toolpath(doc, feature)
    assert feature.Status == toolpath.Status == "up to date" and toolpath.Layers == 4


def test_all_stages_at_once(doc, part):
    part.Radius = 15  # fewer layers at the defaults
    doc.recompute()
    stages = api.make_all(doc, part)
    assert [obj.Proxy.kind for obj in stages] == [
        "cell",
        "feature",
        "toolpath",
        "joint path",
        "program",
    ]
    assert stages[-1].ProgramName == "HEMISPHERE_N_1" and stages[-1].Status == "up to date"
    assert api.stages_of(doc, "program") == [stages[-1]]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("Hémisphère n° 1", "HEMISPHERE_N_1"),
        ("cup", "CUP"),
        ("12", "P12"),
        ("ω", "P"),
        ("a" * 50, "A" * 20),
    ],
)
def test_proposed_names(text, name):
    assert api.proposed_name(text) == name


def test_progress_is_told_and_may_cancel(job):
    texts = []
    with api.told_to(lambda fraction, text: texts.append(fraction)):
        api.change(job.joint_path, tolerance=1e-7)
    falls = sum(later < earlier for earlier, later in zip(texts, texts[1:]))
    assert (
        texts and falls == 1 and min(texts) >= 0.0 and max(texts) <= 1.0
    )  # joint path, then the program

    def cancel(fraction, text):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), api.told_to(cancel):
        api.change(job.joint_path, tolerance=1e-6)
    assert job.joint_path.Status == "failed"
    api.recompute(job.doc)
    assert job.joint_path.Status == "up to date"


def test_what_is_found_on_the_way_is_told():
    issue, issues = Issue("note", "LARGE", "it takes long"), []
    progress.report_issue(issue)
    with api.told_to(lambda fraction, text: None, issues.append):
        progress.report_issue(issue)
        with api.told_to(lambda fraction, text: None):
            progress.report_issue(issue)
    assert issues == [issue]


def test_export_writes_the_files(job, tmp_path):
    paths = api.export(job.program, str(tmp_path / "new" / "folder"))
    files = api.result(job.program).files
    assert (
        {os.path.basename(path) for path in paths}
        == set(files)
        == set(os.listdir(tmp_path / "new" / "folder"))
    )
    for path in paths:
        with open(path, "rb") as file:
            assert file.read() == files[os.path.basename(path)]
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="choose a writable folder"):
        api.export(job.program, str(tmp_path / "file"))


@pytest.mark.parametrize("ending", ["step", "brep", "iges"])
def test_parts_from_files(doc, tmp_path, ending):
    path = str(tmp_path / f"Été.{ending}")
    shape = Part.makeSphere(30, App.Vector(), App.Vector(0, 0, 1), 0, 90)
    {"step": shape.exportStep, "brep": shape.exportBrep, "iges": shape.exportIges}[ending](path)
    imported_part = api.open_part(doc, path)
    assert imported_part.Label == "Été" and imported_part.State == ["Up-to-date"]
    assert imported_part.Shape.BoundBox.ZMax == pytest.approx(30, abs=1e-3)
    assert api.make_feature(doc, imported_part, layer_height=5).WallLength.Value == pytest.approx(
        15 * math.pi, rel=1e-5
    )


def test_parts_from_documents_are_taken_where_they_stand(doc, part, tmp_path):
    box = doc.addObject("App::Part", "Assembly")
    box.addObject(part)
    box.Placement = App.Placement(App.Vector(5, 6, 7), App.Rotation())
    doc.recompute()
    doc.saveAs(str(tmp_path / "part.FCStd"))
    open_before = App.listDocuments().keys() - {doc.Name}
    target, doc_name = App.newDocument("Target"), doc.Name
    try:
        for closed in (False, True):
            imported_part = api.open_part(target, str(tmp_path / "part.FCStd"), LABEL)
            assert imported_part.Shape.BoundBox.ZMin == pytest.approx(
                7, abs=1e-6
            ) and imported_part.Label.startswith("Hémisphère n°")
            assert App.ActiveDocument.Name == target.Name
            assert (doc_name in App.listDocuments()) is not closed
            if not closed:
                App.closeDocument(doc_name)
        assert App.listDocuments().keys() - open_before == {target.Name}
        with pytest.raises(InputError, match="Hémisphère"):
            api.open_part(target, str(tmp_path / "part.FCStd"), "no such")
        (tmp_path / "bad.FCStd").write_bytes(b"nothing")
        for name in ("bad.FCStd", "none.FCStd", "none.step"):
            with pytest.raises(InputError):
                api.open_part(target, str(tmp_path / name))
        assert len(target.Objects) == 2
    finally:
        App.closeDocument(target.Name)


def test_a_mesh_of_a_document_is_taken_where_it_stands(doc, tmp_path):
    box = doc.addObject("App::Part", "Assembly")
    scan = doc.addObject("Mesh::Feature", "Scan")
    scan.Mesh = Mesh.createBox(20, 20, 20)
    scan.Placement = App.Placement(App.Vector(10, 10, 10), App.Rotation())
    box.addObject(scan)
    box.Placement = App.Placement(App.Vector(5, 0, 0), App.Rotation(App.Vector(0, 0, 1), 90))
    doc.recompute()
    doc.saveAs(str(tmp_path / "scan.FCStd"))
    App.closeDocument(doc.Name)
    target = App.newDocument("Target")
    try:
        imported_mesh = api.open_part(target, str(tmp_path / "scan.FCStd"))
        low, high = (
            np.array(imported_mesh.Mesh.Topology[0]).min(axis=0),
            np.array(imported_mesh.Mesh.Topology[0]).max(axis=0),
        )
        assert low == pytest.approx([-15, 0, 0], abs=1e-4) and high == pytest.approx(
            [5, 20, 20], abs=1e-4
        )
        assert imported_mesh.Label == "Scan" and len(imported_mesh.Mesh.Topology[1]) == 12
    finally:
        App.closeDocument(target.Name)


def test_a_part_inside_a_moved_assembly_is_planned_where_it_is_seen(doc, part):
    box = doc.addObject("App::Part", "Assembly")
    box.addObject(part)
    box.Placement = App.Placement(App.Vector(5, 6, 7), App.Rotation(App.Vector(0, 0, 1), 90))
    part.Placement.Base = App.Vector(10, 0, 0)
    doc.recompute()
    feature = api.make_feature(doc, part, layer_height=10)
    assert api.result(feature).frame[:3, 3] == pytest.approx([5, 16, 7], abs=1e-9)


def test_a_wire_turned_about_a_line(doc):
    wire = doc.addObject("Part::Feature", "Wire")
    wire.Shape = Part.makePolygon([App.Vector(20, 0, 0), App.Vector(30, 0, 40)])
    line = doc.addObject("Part::Line", "Axis")
    line.X1 = line.Y1 = line.Z1 = line.X2 = line.Y2 = 0
    line.Z2 = 50
    doc.recompute()
    feature = api.make_feature(doc, wire, axis=(line, "Edge1"), layer_height=10)
    assert feature.WallLength.Value == pytest.approx(math.hypot(10, 40))
    line.X1 = 1
    assert feature.Status == "stale"
    box = doc.addObject("Part::Box", "Box")
    doc.recompute()
    with pytest.raises(InputError, match="not a straight line"):
        api.make_feature(doc, wire, axis=(box, "Face1"))


def test_a_sketch_turned_about_its_own_axis(doc):
    import Sketcher  # noqa: F401  (makes the type known)

    sketch = doc.addObject("Sketcher::SketchObject", "Sketch")
    sketch.addGeometry(Part.LineSegment(App.Vector(20, 0, 0), App.Vector(30, 40, 0)))
    sketch.Placement = App.Placement(App.Vector(1, 2, 3), App.Rotation(App.Vector(1, 0, 0), 90))
    doc.recompute()
    feature = api.make_feature(doc, sketch, axis=(sketch, "V_Axis"), layer_height=10)
    frame = api.result(feature).frame
    assert frame[:3, 3] == pytest.approx([1, 2, 3]) and frame[:3, 2] == pytest.approx([0, 0, 1])
    assert feature.WallLength.Value == pytest.approx(math.hypot(10, 40))
    key = feature.Key
    default_axis = api.make_feature(
        doc, sketch, layer_height=10
    )  # the vertical axis is the default
    assert default_axis.Key == key and default_axis.Axis is None


def test_with_the_part_mounted_by_its_own_frame_the_platform_is_there(doc, part):
    """A wall above the platform of its part's frame, or next to it, is reported at its real
    position."""
    part.Placement.Base = (200, 0, 0)
    doc.recompute()
    beside = api.make_cell(doc, limits="paper", mount="part")
    feature = api.make_feature(doc, part, layer_height=10)
    with pytest.raises(InputError) as error:
        api.make_toolpath(doc, feature, beside)
    assert error.value.code == "OFF_PLATFORM"
    assert api.make_toolpath(doc, feature, api.make_cell(doc, limits="paper", mount="feature"))


def test_a_solid_drawn_above_the_platform_is_put_on_it_by_a_new_job(doc):
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 30, 30, 6
    box.Placement.Base = (40, 10, 20)
    doc.recompute()
    cell, _, toolpath, *_ = api.make_all(doc, box, kind="solid")
    assert cell.Mount == "feature" and not {"ABOVE_PLATFORM", "UNSUPPORTED"} & {
        issue.code for issue in api.issues(toolpath)
    }
    api.change(cell, mount="part")
    issues = {issue.code: issue for issue in api.issues(toolpath)}
    assert {"ABOVE_PLATFORM", "UNSUPPORTED"} <= set(issues) and "20 mm above" in issues[
        "ABOVE_PLATFORM"
    ].message
    api.change(cell, platform_diameter=0)  # the height of the platform is then unknown
    assert not {"ABOVE_PLATFORM", "UNSUPPORTED"} & {issue.code for issue in api.issues(toolpath)}


@pytest.mark.parametrize(
    ("layers", "low"), [("", 0.0), ("", 4.0), ("", 20.0), ("", -4.0), ("offset", 9.0)]
)
def test_a_new_job_plans_its_layers_once_wherever_the_part_is(doc, monkeypatch, layers, low):
    """Layers may take minutes. The result equals that of a toolpath that is checked for missing
    support."""
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 16, 12, 4
    box.Placement = App.Placement(App.Vector(40, 10, low), App.Rotation(App.Vector(0, 0, 1), 30))
    doc.recompute()
    planned, plan = [], solids_plan.plan
    monkeypatch.setattr(
        solids_plan, "plan", lambda *arguments: planned.append(arguments) or plan(*arguments)
    )
    cell, _, toolpath, *_ = api.make_all(doc, box, kind="solid", layers=layers)
    assert len(planned) == 1
    monkeypatch.setattr(suit, "_is_above", lambda cell, features: False)
    feature, _, planned_toolpath, *_ = api.make_all(doc, box, kind="solid", layers=layers)
    assert (cell.Mount, toolpath.Status, toolpath.Issues) == (
        feature.Mount,
        planned_toolpath.Status,
        planned_toolpath.Issues,
    )
    assert toolpath.ResultData == planned_toolpath.ResultData


def test_a_users_own_machine_is_known_by_its_name(doc, part, tmp_path, monkeypatch, root):
    """Its file is in FreeCAD's folder of user data; a change of the file makes the cell stale at
    the next recompute."""
    folder = tmp_path / "RoboticAM" / "machines"
    folder.mkdir(parents=True)
    text = (root / "freecad_am" / "machines" / "fanuc-arcmate120ic.json").read_text(
        encoding="utf-8"
    )
    machine_file = folder / "our-arm.json"
    machine_file.write_text(
        text.replace('"id": "fanuc-arcmate120ic"', '"id": "our-arm"'), encoding="utf-8"
    )
    monkeypatch.setattr(App, "getUserAppDataDir", lambda: str(tmp_path) + os.sep)
    cell = api.make_cell(doc, machine="our-arm", limits="paper")
    feature = api.make_feature(doc, part, layer_height=15)
    toolpath = api.make_toolpath(doc, feature, cell)
    joint_path = api.make_joint_path(doc, toolpath, cell)
    assert api.result(joint_path).joint_path.feasible
    key = cell.Key
    machine_file.write_text(
        machine_file.read_text(encoding="utf-8").replace("(= M-20iA", "(ours, = M-20iA"),
        encoding="utf-8",
    )
    api.recompute(doc)
    assert cell.Key != key and "ours" in cell.MachineTitle


@pytest.mark.any_version
@pytest.mark.parametrize("machine", ["kuka-kr6-r900-2", "motoman-ma2010", "staubli-tx60"])
def test_a_new_job_of_another_robot_can_be_carried_out(doc, monkeypatch, machine, no_remedies):
    """At the deposition point and in the configuration of the default robot, each of these is out
    of reach or past a limit."""
    make = api.make_feature_of

    def coarse(*arguments, values, **named):
        return make(*arguments, values={"layer_height": 5.0, "chord_error": 0.1, **values}, **named)

    monkeypatch.setattr(api, "make_feature_of", coarse)
    dome = doc.addObject("Part::Sphere", "Dome")
    dome.Radius, dome.Angle1 = 30, 0
    doc.recompute()
    cell, feature, toolpath, joint_path = api.make_all(doc, dome, machine=machine)[:4]
    assert (joint_path.Status, cell.Machine, feature.LayerHeight.Value) == (
        "up to date",
        machine,
        5.0,
    )
    like_default = api.make_cell(doc, parameters=CellParameters(machine=machine))
    assert api.make_joint_path(doc, toolpath, like_default).Status == "infeasible"


def test_a_new_job_puts_a_part_that_lies_about_its_origin_on_the_platform(doc):
    """It was once rejected with a remedy for which the panel has no field. The program is that of
    the part moved up."""
    lying, up = doc.addObject("Part::Box", "Block"), doc.addObject("Part::Box", "Block")
    for block, base in ((lying, App.Vector(5, 8, -1.5)), (up, App.Vector(5, 8, 0))):
        block.Length, block.Width, block.Height, block.Placement.Base = 12, 12, 3, base
    doc.recompute()
    cell, *_, program = api.make_all(doc, lying, kind="solid", name="BLOCK")
    raised_feature, *_, above = api.make_all(doc, up, kind="solid", name="BLOCK")
    assert (cell.Mount, raised_feature.Mount, program.Status) == ("feature", "auto", "up to date")
    api.change(raised_feature, mount="feature")
    assert files_of(program) == files_of(above)


@pytest.mark.any_version
@pytest.mark.parametrize(("seconds", "long"), [(0.0, True), (3600.0, False)])
def test_remedies_that_take_long_are_told_before_they_are_looked_for(
    doc, part, monkeypatch, seconds, long
):
    """The test sets the limit for a long search below or above the search time of this part."""
    cell = api.make_cell(doc, deposition_point=(5000, 0, 0, 0, 0, 0))  # out of reach
    toolpath = api.make_toolpath(
        doc, api.make_feature(doc, part, layer_height=15, chord_error=0.5), cell
    )
    monkeypatch.setattr(estimated_size, "LARGE_SECONDS", seconds)
    issues, searches = [], []
    monkeypatch.setattr(
        "freecad_am.objects.joint_path.remedies", lambda *_: searches.append(list(issues)) or []
    )
    with api.told_to(lambda *_: None, lambda issue: issues.append(issue.code)):
        path = api.make_joint_path(doc, toolpath, cell)
    assert any(issue.level == "error" for issue in api.issues(path))
    assert searches == [["LARGE"] if long else []]


@pytest.mark.parametrize(
    ("machine", "setup", "written"),
    [
        (
            "kuka-kr16-2",
            "tool-on-robot",
            ("kuka", "cartesian"),
        ),  # joint moves of KRL cannot keep a speed
        ("kuka-kr16-2", "part-on-robot", ("", "")),
        (
            "kuka-lbr-iisy11-r1300",
            "tool-on-robot",
            ("", ""),
        ),  # its wrist has no names for positions
        ("abb-irb2400-12-155", "tool-on-robot", ("abb", "joint")),
        ("fanuc-crx10ia", "part-on-robot", ("fanuc", "joint")),
    ],
)
def test_a_new_job_is_written_in_the_motion_that_the_controller_has(machine, setup, written):
    settings = dataclasses.replace(CellParameters(), machine=machine, setup=setup)
    assert controllers.post_of(settings, "", ()) == written


@pytest.mark.any_version
def test_a_new_job_of_a_kuka_robot_with_the_torch_ends_with_a_program(doc, part, monkeypatch):
    make = api.make_feature_of
    monkeypatch.setattr(
        api,
        "make_feature_of",
        lambda *arguments, values, **named: make(
            *arguments, values={"layer_height": 15.0, "chord_error": 0.5, **values}, **named
        ),
    )
    *_, program = api.make_all(doc, part, machine="kuka-kr16-2", setup="tool-on-robot")
    assert (program.Status, program.Post, program.Motion) == ("up to date", "kuka", "cartesian")
    assert any(b"LIN " in content for content in files_of(program).values())


def test_a_job_whose_toolpath_cannot_be_carried_out_is_there_as_far_as_it_goes(doc):
    """A low block inside a frame leaves no room for the nozzle."""
    frame, block = (doc.addObject("Part::Feature", name) for name in ("Frame", "Block"))
    frame.Shape = Part.makeBox(40, 40, 40).cut(Part.makeBox(24, 24, 40, App.Vector(8, 8, 0)))
    block.Shape = Part.makeBox(18, 18, 2, App.Vector(11, 11, 0))
    doc.recompute()
    doc.UndoMode = 1
    stages = api.make_all(doc, frame, kind="solid", then=[{"source": block, "kind": "solid"}])
    assert [obj.Proxy.kind for obj in stages] == ["cell", "feature", "feature", "toolpath"]
    assert (
        stages[3].Status == "infeasible" and "CLEARANCE" in stages[3].Issues and stages[3].Message
    )
    (group,) = [obj for obj in doc.Objects if obj.Label.startswith("Job ")]
    assert set(group.Group) == set(stages)
    doc.undo()
    assert doc.Objects == [frame, block]
