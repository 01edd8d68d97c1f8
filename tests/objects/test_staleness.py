# SPDX-License-Identifier: LGPL-2.1-or-later
"""A change of any input marks its dependants as stale at once, and a recompute renews exactly
these."""

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.core.issues import InfeasibleError, InputError

OK, STALE, FAILED = "up to date", "stale", "failed"


def statuses(job):
    return [obj.Status for obj in job.stages]


def test_all_is_up_to_date_once_made_and_nothing_is_due(job):
    assert statuses(job) == [OK] * 5
    keys = [obj.Key for obj in job.stages]
    assert len(set(keys)) == 5 and job.doc.recompute() == 0
    assert [obj.Key for obj in job.stages] == keys


@pytest.mark.parametrize(
    ("stage", "name", "value", "want"),
    [
        ("cell", "PlatformDiameter", 100, [STALE, OK, STALE, STALE, STALE]),
        (
            "cell",
            "DepositionPoint",
            App.Placement(App.Vector(1040, -630, 650), App.Rotation()),
            [STALE, OK] + [STALE] * 3,
        ),
        ("feature", "LayerHeight", 9, [OK, STALE, STALE, STALE, STALE]),
        ("feature", "MaxTilt", 80, [OK, STALE, STALE, STALE, STALE]),
        ("toolpath", "SeamAngle", 15, [OK, OK, STALE, STALE, STALE]),
        ("joint_path", "Rz", "5 deg", [OK, OK, OK, STALE, STALE]),
        ("program", "DryRun", True, [OK, OK, OK, OK, STALE]),
        ("program", "ProgramName", "MUG", [OK, OK, OK, OK, STALE]),
    ],
)
def test_a_changed_parameter_marks_what_follows_at_once(job, stage, name, value, want):
    old_keys = [obj.Key for obj in job.stages]
    setattr(getattr(job, stage), name, value)
    assert statuses(job) == want
    job.doc.recompute()
    assert statuses(job) == [OK] * 5
    renewed = [obj.Key != key for obj, key in zip(job.stages, old_keys, strict=True)]
    same = [
        name == "DepositionPoint" and obj == job.toolpath for obj in job.stages
    ]  # layers do not depend on its location
    assert renewed == [
        status == STALE and not is_same for status, is_same in zip(want, same, strict=True)
    ]


def test_changing_it_back_needs_no_computing(job):
    keys = [obj.Key for obj in job.stages]
    result = api.result(job.toolpath)
    job.feature.LayerHeight = 9
    job.feature.LayerHeight = 10
    assert statuses(job)[1:] == [STALE] * 4
    job.doc.recompute()
    assert statuses(job) == [OK] * 5 and [obj.Key for obj in job.stages] == keys
    assert api.result(job.toolpath) is result


def test_a_changed_shape_marks_what_follows_before_any_recompute(job):
    job.part.Radius = 30
    assert statuses(job) == [OK] + [STALE] * 4
    assert job.part.Label in job.toolpath.Message
    job.doc.recompute()
    assert statuses(job) == [OK] * 5
    assert job.feature.WallLength.Value == pytest.approx(30 * 3.141592653589793 / 2, rel=1e-6)


def test_moving_the_part_moves_the_path(job):
    old_points = api.result(job.toolpath).layers[0].beads[0].points
    job.part.Placement = App.Placement(App.Vector(100, 0, 7), App.Rotation())
    assert job.toolpath.Status == STALE
    job.doc.recompute()
    new_points = api.result(job.toolpath).layers[0].beads[0].points
    assert new_points - old_points == pytest.approx((new_points * 0) + [100, 0, 7], abs=1e-6)


def test_labels_and_visibility_are_no_inputs(job):
    for obj in (job.part, *job.stages):
        obj.Label = "Autre nom"
        obj.Visibility = False
    assert statuses(job) == [OK] * 5


def test_parameters_follow_expressions(job):
    sheet = job.doc.addObject("Spreadsheet::Sheet", "Sheet")
    sheet.set("A1", "=5 mm")
    job.doc.recompute()
    job.feature.setExpression("LayerHeight", "Sheet.A1 * 2 + 5 mm")
    assert (
        job.feature.Status == job.program.Status == "stale"
    )  # at once, before the expression is evaluated
    job.toolpath.setExpression("TravelSpeed", "Feature.LayerHeight / 5 s")
    job.doc.recompute()
    assert job.feature.LayerHeight.Value == 15 and job.toolpath.TravelSpeed.Value == pytest.approx(
        3
    )
    assert statuses(job) == [OK] * 5 and job.toolpath.Layers == 5
    sheet.set("A1", "=0 mm")
    api.recompute(job.doc)
    assert job.toolpath.Layers == 15 and statuses(job) == [OK] * 5


def test_a_bad_parameter_fails_and_what_follows_waits(job, capfd, tmp_path):
    job.feature.LayerHeight = 0
    job.doc.recompute()
    assert statuses(job) == [OK] + [FAILED] * 4
    assert job.feature.Message == "Feature.LayerHeight: 0 mm is out of range; give more than 0 mm"
    assert "waits for Feature" in job.toolpath.Message
    assert job.program.Message == (  # each stage is named once
        "Program: waits for Joint path: waits for Toolpath: waits for Feature: "
        "Feature.LayerHeight: 0 mm is out of range; give more than 0 mm"
    )
    with pytest.raises(
        InputError, match=r"^Program: no program matches its inputs \(waits for Joint path: "
    ):
        api.export(job.program, str(tmp_path))
    assert "Traceback" not in "".join(capfd.readouterr())
    with pytest.raises(InputError, match="LayerHeight"):
        api.recompute(job.doc)
    assert len(api.result(job.toolpath).layers) == 8  # the last result stays
    job.feature.LayerHeight = 10
    job.doc.recompute()
    assert statuses(job) == [OK] * 5


def test_too_little_memory_is_told_and_the_last_result_stays(job, monkeypatch):
    def too_much(obj):
        def work():
            raise MemoryError("Unable to allocate 444. PiB")

        return work

    key = job.toolpath.Key
    monkeypatch.setattr(job.toolpath.Proxy, "prepare", too_much)
    job.feature.LayerHeight = 9
    with pytest.raises(InputError, match="Toolpath: the computation needs more memory") as caught:
        api.recompute(job.doc)
    assert caught.value.code == "NO_MEMORY" and job.toolpath.Status == FAILED
    assert job.toolpath.Key == key


def test_a_failed_document_can_be_saved_opened_and_cured(job, tmp_path):
    job.cell.Machine = "no such robot"
    job.doc.recompute()
    assert job.cell.Status == FAILED
    job.doc.saveAs(str(tmp_path / "failed.FCStd"))
    again = App.openDocument(str(tmp_path / "failed.FCStd"))
    try:
        assert again.Cell.Status == FAILED and "no such robot" in again.Cell.Message
        again.Cell.Machine = "fanuc-arcmate120ic"
        again.recompute()
        assert [obj.Status for obj in api.stages_of(again)] == [OK] * 5
    finally:
        App.closeDocument(again.Name)


@pytest.mark.parametrize("gone", ["cell", "feature", "toolpath", "joint_path"])
def test_deleting_an_input_fails_what_needs_it_with_a_message(job, gone, capfd):
    needed = {
        "cell": "joint_path",
        "feature": "toolpath",
        "toolpath": "joint_path",
        "joint_path": "program",
    }
    followers = [getattr(job, needed[gone])]  # a toolpath needs no cell
    job.doc.removeObject(getattr(job, gone).Name)
    for obj in followers:
        assert obj.Status == FAILED and "is missing; choose" in obj.Message
    job.doc.recompute()
    for obj in followers:
        assert obj.Status == FAILED and "is missing; choose" in obj.Message
    assert "Traceback" not in "".join(capfd.readouterr())


def test_deleting_the_part_fails_the_feature(job):
    job.doc.removeObject(job.part.Name)
    assert job.feature.Status == FAILED and "Source is missing" in job.feature.Message
    job.doc.recompute()
    assert statuses(job) == [OK] + [FAILED] * 4


def test_an_infeasible_path_is_kept_and_stops_the_program(job, no_remedies):
    job.joint_path.Method = "constant"
    job.doc.recompute()
    assert job.joint_path.Status == "infeasible" and job.program.Status == "infeasible"
    issues = api.issues(job.joint_path)
    assert any(issue.level == "error" and issue.layer is not None for issue in issues)
    assert api.result(job.joint_path).joint_path.method == "constant"
    with pytest.raises(InputError, match="no program matches"):
        api.export(job.program, "anywhere")
    with pytest.raises(InfeasibleError):
        api.make_program(job.doc, job.joint_path, name="NEXT")
    assert len(api.stages_of(job.doc, "program")) == 1


def test_what_could_not_be_carried_out_is_up_to_date_once_its_inputs_are_as_they_were(doc):
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 16, 12, 4
    doc.recompute()
    feature = api.make_solid_feature(doc, box, layer_height=2, thin="refuse")
    toolpath = api.make_toolpath(doc, feature, api.make_cell(doc))
    path = api.make_joint_path(doc, toolpath, doc.Cell)
    keys, spacing = [obj.Key for obj in (toolpath, path)], feature.BeadSpacing
    message = toolpath.Message
    assert "narrower than a bead" not in message
    for _ in range(2):
        feature.BeadSpacing = 30
        doc.recompute()
        assert (
            toolpath.Status == path.Status == "infeasible"
            and "narrower than a bead" in toolpath.Message
        )
        feature.BeadSpacing = spacing
        doc.recompute()
        assert [obj.Status for obj in (feature, toolpath, path)] == [
            OK
        ] * 3 and toolpath.Message == message
        assert [obj.Key for obj in (toolpath, path)] == keys
        assert not [
            issue for obj in (toolpath, path) for issue in api.issues(obj) if issue.level == "error"
        ]


def test_a_link_to_the_wrong_kind_is_told(job):
    job.toolpath.Feature = job.cell
    job.doc.recompute()
    assert (
        job.toolpath.Status == FAILED
        and job.toolpath.Message == "Toolpath.Feature: Cell is not a feature; choose another object"
    )


def test_what_failed_is_tried_again_at_the_next_recompute(job, root, tmp_path):
    machine = tmp_path / "robot.json"
    job.cell.Machine = str(machine)
    job.doc.recompute()
    assert job.cell.Status == FAILED
    machine.write_bytes((root / "freecad_am" / "machines" / "fanuc-arcmate120ic.json").read_bytes())
    job.doc.recompute()
    assert statuses(job) == [OK] * 5


def test_a_changed_mechanism_file_is_noticed_by_a_recompute(root, tmp_path):
    table = tmp_path / "table.json"
    text = (root / "freecad_am/machines/mechanisms/motoman-motopos-d500.json").read_text(
        encoding="utf-8"
    )
    table.write_text(text, encoding="utf-8")
    doc = App.newDocument("Mechanism")
    cell = api.make_cell(
        doc,
        setup="tool-on-robot",
        branch="auto",
        external=f"{table} at 1400 0 0 0 0 0 carries part",
    )
    key = cell.Key
    api.recompute(doc)
    assert cell.Key == key and cell.Status == OK
    table.write_text(text.replace("[0, 0, 380]", "[0, 0, 390]"), encoding="utf-8")
    with pytest.raises(
        InputError, match="give a flange"
    ):  # the poses of the file are those of 380 mm
        api.recompute(doc)
    table.write_text(text + "\n", encoding="utf-8")
    api.recompute(doc)
    assert cell.Key != key and cell.Status == OK
    App.closeDocument(doc.Name)


def test_a_changed_machine_file_is_noticed_by_a_recompute(job, root, tmp_path):
    machine = tmp_path / "robot.json"
    text = (root / "freecad_am" / "machines" / "fanuc-arcmate120ic.json").read_text(
        encoding="utf-8"
    )
    machine.write_text(text, encoding="utf-8")
    job.cell.Machine = str(machine)
    job.doc.recompute()
    key = job.program.Key
    machine.write_text(text + "\n", encoding="utf-8")
    api.recompute(job.doc)
    assert job.program.Key != key and statuses(job) == [OK] * 5
