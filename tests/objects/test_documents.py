# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stages survive saving, opening, undo, copies, and opening of old files."""

import dataclasses
import hashlib
import shutil
import zipfile
from pathlib import Path

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.objects.results import fingerprints, store

# results in an earlier storage format, row by row with each number a float, and fingerprints of
# their values when read then
ROWS = Path(__file__).parent / "data" / "rows.FCStd"
IN_ROWS = {
    "Cell": "81db9bf2322c92a4d332aa3bfe226a39475f84164835c40f40eaf82b52b94d14",
    "Feature": "10aa08970a39bf1ceb00ac64bdc1e5bc2e80611e9e2e3d22e352b15323aacc9b",
    "Toolpath": "533c48b8c583ffc5fc92d67566afd3d8d4d41363467437c0b738f384a6b54eb0",
    "JointPath": "89d1a7bc3fce44748769bced321dbb314ee43ee37c1a03fb3a6cbe6822ce9d67",
    "Program": "c68b97f6de258e88953013104234abaa0707618c9e190fefb6473854ddf2f15d",
}
# fields that did not exist then: derived, or None if unknown
LATER_FIELDS = (
    "role",
    "bead_width",
    "unsupported",
    "wire_feed",
    "depths",
    "on_part",
    "volumes",
    "feature_label",
    "features",
    "feature",
    "uneven",
    "section",
    "coverage",
    "scarf",
    "settings",
    "twice",
    "external",
    "max_from_vertical",
    "world_up",
    "optimality",
    "certificate",
    "close_gap",
    "of_level",
    "arm_clearance",
    "obstacles",
    "bead_class",
    "classes",
    "schedule",
    "ends",
    "phase",
    "fitted",
    "material",
    "touched",
    "touched_tolerance",
    "shape",
    "halt",
    "retreat",
    "min_layer_time",
    "predicted",
    "shape_of_deposit",
    "machining_allowance",
)


def fingerprint(value):
    """Return a hash of the values under each name, in order; groups of fields may come and go."""
    by_name = {}
    for name, item in parts(value, ""):
        by_name.setdefault(name, []).append(item)
    return hashlib.sha256(repr(sorted(by_name.items())).encode()).hexdigest()


def parts(value, name):
    """Yield all values in a result, each with the name of its field."""
    if isinstance(value, np.ndarray):
        yield name, (str(value.dtype), value.shape, value.tobytes())
    elif isinstance(value, dict):
        for key, entry in value.items():
            yield from parts(entry, f"{name}[{key}]")
    elif dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            entry = getattr(value, field.name)
            if field.name not in LATER_FIELDS or dataclasses.is_dataclass(entry):
                yield from parts(entry, field.name)
    elif isinstance(value, (tuple, list)):
        for entry in value:
            yield from parts(entry, name)
    else:
        yield name, value


def equal(value, expected):
    """Return whether values are equal bit for bit, within dataclasses and tuples too."""
    if isinstance(value, np.ndarray):
        return (
            value.dtype == expected.dtype
            and value.shape == expected.shape
            and value.tobytes() == expected.tobytes()
        )
    if isinstance(value, (tuple, list)):
        return len(value) == len(expected) and all(map(equal, value, expected))
    if dataclasses.is_dataclass(value):
        names = [field.name for field in dataclasses.fields(value)]
        return type(value) is type(expected) and all(
            equal(getattr(value, name), getattr(expected, name)) for name in names
        )
    return value == expected or (value != value and expected != expected)


@pytest.fixture
def reopened(job, tmp_path):
    """Return the job saved and opened again, with its earlier values."""
    values = [api.result(obj) for obj in job.stages]
    path = str(tmp_path / "Pièce à déposer.FCStd")
    job.doc.saveAs(path)
    again = App.openDocument(path)
    yield again, values, path
    App.closeDocument(again.Name)


def test_results_are_there_after_reopening_and_nothing_is_computed(job, reopened, monkeypatch):
    again, values, _ = reopened
    for kind in {type(obj.Proxy) for obj in job.stages}:
        monkeypatch.setattr(kind, "prepare", lambda self, obj: pytest.fail("computed"))
    stages = api.stages_of(again)
    assert [obj.Label for obj in stages] == [obj.Label for obj in api.stages_of(job.doc)]
    for original in job.stages:
        obj = again.getObject(original.Name)
        assert obj.Status == "up to date" and obj.State == ["Up-to-date"]
        assert obj.Key == original.Key == obj.Proxy.key(obj)
        assert equal(api.result(obj), values[job.stages.index(original)])
    again.recompute()
    for obj in stages:
        obj.touch()
    again.recompute()
    assert [obj.Status for obj in stages] == ["up to date"] * 5


def test_results_are_compressed_outside_the_document_text(reopened):
    path = reopened[2]
    with zipfile.ZipFile(path) as archive:
        text = archive.getinfo("Document.xml")
        assert text.file_size < 300_000
        assert all(entry.compress_type == zipfile.ZIP_DEFLATED for entry in archive.infolist())


def test_a_forced_recompute_gives_the_same(job):
    results = [api.result(obj) for obj in job.stages]
    api.recompute(job.doc, force=True)
    for obj, value in zip(job.stages, results, strict=True):
        assert api.result(obj) is not value and equal(api.result(obj), value)


def test_undo_and_redo_take_parameters_results_and_status_along(job):
    job.doc.UndoMode = 1
    first_result, first_key = api.result(job.toolpath), job.toolpath.Key
    api.change(job.feature, layer_height=20)
    second = api.result(job.toolpath)
    assert job.doc.UndoCount == 1 and job.doc.UndoNames == ["Edit Feature"]
    assert len(second.layers) < len(first_result.layers)
    for _ in range(2):
        job.doc.undo()
        assert (job.feature.LayerHeight.Value, job.toolpath.Key) == (10.0, first_key)
        assert [obj.Status for obj in job.stages] == ["up to date"] * 5
        assert equal(api.result(job.toolpath), first_result)
        job.doc.redo()
        assert job.feature.LayerHeight.Value == 20.0 and equal(api.result(job.toolpath), second)
    job.doc.undo()
    job.doc.openTransaction("By hand")
    job.feature.LayerHeight = 5
    job.doc.commitTransaction()
    assert job.program.Status == "stale"
    job.doc.undo()
    assert [obj.Status for obj in job.stages] == ["up to date"] * 5


def test_every_function_is_one_step_of_undo(doc, part):
    doc.UndoMode = 1
    cell = api.make_cell(doc)
    feature = api.make_feature(doc, part, layer_height=10)
    toolpath = api.make_toolpath(doc, feature, cell)
    joint_path = api.make_joint_path(doc, toolpath, cell)
    api.make_program(doc, joint_path, name="CUP")
    assert doc.UndoCount == 5
    for count in (4, 3, 2, 1, 0):
        doc.undo()
        assert len(api.stages_of(doc)) == count
    for _ in range(5):
        doc.redo()
    assert [obj.Status for obj in api.stages_of(doc)] == ["up to date"] * 5
    assert api.result(doc.Program).files.keys() >= {"CUP.LS"}


def test_copies_keep_their_own_result(job):
    copy = job.doc.copyObject(job.toolpath, False)
    assert copy.Name != job.toolpath.Name and equal(api.result(copy), api.result(job.toolpath))
    copied_result = api.result(copy)
    api.change(job.toolpath, seam_angle=30)
    assert (
        copy.SeamAngle.Value == 0
        and equal(api.result(copy), copied_result)
        and copy.Status == "up to date"
    )
    api.change(copy, seam_angle=60)
    assert job.toolpath.SeamAngle.Value == 30
    start = [api.result(obj).layers[0].beads[0].points[0] for obj in (job.toolpath, copy)]
    assert not np.allclose(*start)


def test_a_copy_of_the_whole_job_stands_alone_in_another_document(job):
    target = App.newDocument("Other")
    try:
        target.copyObject(job.program, True)
        stages = api.stages_of(target)
        assert len(target.Objects) == 6 and [obj.Status for obj in stages] == ["up to date"] * 5
        program = api.stages_of(target, "program")[0]
        assert api.result(program).files == api.result(job.program).files
        api.change(api.stages_of(target, "feature")[0], layer_height=20)
        assert job.feature.LayerHeight.Value == 10 and job.program.Status == "up to date"
    finally:
        App.closeDocument(target.Name)


def test_an_old_document_gets_what_it_lacks(job, tmp_path):
    for name in ("MaxTilt", "Seconds", "WallFaces"):
        assert job.feature.removeProperty(name)
    job.doc.saveAs(str(tmp_path / "old.FCStd"))
    again = App.openDocument(str(tmp_path / "old.FCStd"))
    try:
        assert again.Feature.MaxTilt.Value == 90 and again.Feature.WallFaces == []
        assert (
            again.Feature.Status == "up to date"
            and again.Feature.SchemaVersion == fingerprints.SCHEMA_VERSION
        )
        api.recompute(again)
        assert [obj.Status for obj in api.stages_of(again)] == ["up to date"] * 5
    finally:
        App.closeDocument(again.Name)


def _size_of_results(path):
    """Return the bytes of the results in a document, without the data of its objects."""
    with zipfile.ZipFile(path) as files:
        return sum(
            member.compress_size
            for member in files.infolist()
            if member.filename.startswith("ResultData")
        )


def test_results_of_an_old_document_are_read_to_the_last_bit_and_stored_anew(tmp_path, monkeypatch):
    path = str(shutil.copy(ROWS, tmp_path))
    document = App.openDocument(path)
    try:
        for name, expected in IN_ROWS.items():
            obj = document.getObject(name)
            monkeypatch.setattr(
                type(obj.Proxy), "prepare", lambda self, obj: pytest.fail("computed")
            )
            assert obj.Status == "up to date" and fingerprint(api.result(obj)) == expected
            if name == "JointPath":
                motion = api.result(obj).motion
                assert (
                    set(motion.role.tolist()) == {0, 1, 2, 3}
                    and ((motion.role == 0) == motion.deposit).all()
                )
            obj.ResultData, obj.ResultLayout = store.pack(api.result(obj), obj.Key)
        original_size = _size_of_results(path)
        document.save()
        assert _size_of_results(path) < 2.5 * original_size  # npz without a codec of its own
        App.closeDocument(document.Name)
        document = App.openDocument(path)
        for name, expected in IN_ROWS.items():
            assert fingerprint(api.result(document.getObject(name))) == expected
    finally:
        App.closeDocument(document.Name)


def test_class_paths_are_those_of_the_file_format(job):
    paths = [f"{type(obj.Proxy).__module__}.{type(obj.Proxy).__qualname__}" for obj in job.stages]
    assert paths == [
        "freecad_am.objects.cell.Cell",
        "freecad_am.objects.feature.RevolutionFeature",
        "freecad_am.objects.toolpath.Toolpath",
        "freecad_am.objects.joint_path.JointPath",
        "freecad_am.objects.program.Program",
    ]


def test_a_program_of_an_earlier_version_is_not_given_out_until_it_is_recomputed(job, monkeypatch):
    from freecad_am.objects.program import files_of

    monkeypatch.setattr(fingerprints, "SCHEMA_VERSION", fingerprints.SCHEMA_VERSION - 1)
    for stage in job.stages:
        stage.Proxy.renew(stage, force=True)
    old = files_of(job.program)
    monkeypatch.undo()
    assert (
        job.program.Status == "up to date" and api.result(job.program).files == old
    )  # for inspection
    with pytest.raises(api.InputError, match="earlier version"):
        files_of(job.program)
    for stage in job.stages:
        stage.Proxy.renew(stage)
    assert files_of(job.program) == old
