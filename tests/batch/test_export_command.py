# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command `export` writes programs of a saved document, recomputed."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import FreeCAD
import numpy as np
import pytest

from freecad_am import api
from tests.batch.conftest import make_cup


@pytest.fixture(scope="module")
def two_cups(tmp_path_factory):
    """Return a document with two programs, made with the macro interface and saved."""
    folder = tmp_path_factory.mktemp("two cups")
    make_cup(folder)
    document = FreeCAD.newDocument("Two")
    imported_part = api.open_part(document, str(folder / "cup.step"))
    cell = api.make_cell(document, limits="paper", platform_diameter=100)
    feature = api.make_feature(document, imported_part, layer_height=8, chord_error=0.1)
    toolpath = api.make_toolpath(document, feature, cell)
    joint_path = api.make_joint_path(document, toolpath, cell)
    api.make_program(document, joint_path, "First one", name="first")
    api.make_program(document, joint_path, "Second", name="second", dry_run=True)
    path = folder / "Two Cups.FCStd"
    document.saveAs(str(path))
    FreeCAD.closeDocument(document.Name)
    return path


@pytest.fixture
def saved(workshop, two_cups):
    """Return a copy of that document next to the part."""
    return Path(shutil.copy(two_cups, workshop.folder))


@pytest.fixture
def script_of_another_freecad(tmp_path):
    """Return run(*lines), which runs the lines in a new process that finds FreeCAD but not this
    package."""

    def run(*lines):
        path = tmp_path / "script.py"
        path_setup = f"import sys; sys.path.append({os.path.dirname(FreeCAD.__file__)!r})"
        path.write_text("\n".join([path_setup, "import FreeCAD", *lines]))
        # a home of its own, because the tests' profile has this workbench among its modules
        home = tmp_path / "another home"
        home.mkdir(exist_ok=True)
        process = subprocess.run(
            [sys.executable, str(path)],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, "FREECAD_USER_HOME": str(home), "PYTHONPATH": ""},
        )
        assert process.returncode == 0, process.stderr

    return run


def test_writes_all_programs(workshop, saved):
    original = saved.read_bytes()
    command = workshop.launch("export", saved)
    assert command.status == 0, command.err
    files = workshop.files("out/Two Cups")
    assert set(files) == {"program/FIRST.LS", "program/SECOND.LS"}
    assert command.out.splitlines() == [
        str(workshop.folder / "out" / "Two Cups" / name) for name in sorted(files)
    ]
    assert files["program/FIRST.LS"] != files["program/SECOND.LS"]
    assert saved.read_bytes() == original
    again = workshop.launch("export", saved, "-o", "again")
    assert again.status == 0 and workshop.files("again") == files


def test_findings_of_all_stages_are_told_once(workshop, saved):
    document = FreeCAD.openDocument(str(saved))
    try:
        issues = {issue for obj in api.stages_of(document) for issue in api.issues(obj)}
    finally:
        FreeCAD.closeDocument(document.Name)
    assert any(issue.level == "warning" for issue in issues)
    messages = workshop.run("export", saved).err.splitlines()
    for issue in issues:
        line = (
            f"{issue.level}[{issue.code}] {issue.where or 'job'}: {' '.join(issue.message.split())}"
        )
        assert messages.count(line) == 1


@pytest.mark.parametrize("names", [["First one"], ["Program"]], ids=["Label", "Name"])
def test_writes_the_programs_named(workshop, saved, names):
    assert workshop.run("export", saved, "-o", "some", "--object", *names).status == 0
    assert set(workshop.files("some")) == {"program/FIRST.LS"}


def test_recomputes(workshop, saved):
    assert workshop.run("export", saved, "-o", "before").status == 0
    document = FreeCAD.openDocument(str(saved))
    (feature,) = api.stages_of(document, "feature")
    feature.LayerHeight = 4.0
    document.save()
    FreeCAD.closeDocument(document.Name)
    assert workshop.run("export", saved, "-o", "after").status == 0
    old_program, new_program = (
        workshop.files("before")["program/FIRST.LS"],
        workshop.files("after")["program/FIRST.LS"],
    )
    assert new_program.count(b"J P[") > 1.6 * old_program.count(b"J P[") > 0


def test_a_document_saved_where_the_workbench_is_not_installed(
    workshop, saved, script_of_another_freecad
):
    """A FreeCAD without the workbench saves plain objects, which become stages again."""
    assert workshop.run("export", saved, "-o", "before").status == 0
    script_of_another_freecad(
        f"document = FreeCAD.openDocument({str(saved)!r})",
        "assert all(getattr(obj, 'Proxy', None) is None for obj in document.Objects)",
        "next(obj for obj in document.Objects if 'LayerHeight' in obj.PropertiesList).LayerHeight = 4.0",
        "document.recompute()",
        "document.save()",
    )
    command = workshop.run("export", saved, "-o", "after")
    assert command.status == 0, command.err
    expected, exported = (
        workshop.files("before")["program/FIRST.LS"],
        workshop.files("after")["program/FIRST.LS"],
    )
    assert exported.count(b"J P[") > 1.6 * expected.count(b"J P[") > 0


def application(saved, **program):
    """Return the first program as a VAL 3 application; the document gets a machine that reads
    those."""
    document = FreeCAD.openDocument(str(saved))
    (cell,) = api.stages_of(document, "cell")
    cell.Machine, cell.Limits = "staubli-rx60bl", "maker"
    cell.DepositionPoint = FreeCAD.Placement(FreeCAD.Vector(550, 0, 800), FreeCAD.Rotation())
    cell.Branch = "auto"
    first_program, second_program = api.stages_of(document, "program")
    document.removeObject(second_program.Name)
    first_program.Post = "staubli"
    for name, value in program.items():
        setattr(first_program, name, value)
    document.save()
    FreeCAD.closeDocument(document.Name)


@pytest.mark.any_version
def test_what_an_earlier_longer_export_left_is_removed_and_nothing_else(workshop, saved):
    application(saved, MaxPoints=200)
    command = workshop.run("export", saved, "-o", "out")
    assert command.status == 0, command.err
    longer = workshop.files("out")
    assert "program/first/first02/first02.pjx" in longer
    theirs = {
        "program/first/notes.txt": b"mine",
        "program/first/first02/more.pgx": b"mine",
        "program/other/other.pjx": b"<Project/>",
        "program/other/start.pgx": b"begin\n// Limits: none\nend",
        "program/first/firstly/start.pgx": b"mine",
    }
    for name, content in theirs.items():
        path = workshop.folder / "out" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    application_again = FreeCAD.openDocument(str(saved))
    api.stages_of(application_again, "program")[0].MaxPoints = 100000
    application_again.save()
    FreeCAD.closeDocument(application_again.Name)
    command = workshop.run("export", saved, "-o", "out")
    assert command.status == 0, command.err
    files = workshop.files("out")
    four = {f"program/first/{name}" for name in ("first.pjx", "first.dtx", "start.pgx", "stop.pgx")}
    assert set(files) == four | set(theirs)
    assert all(files[name] == content for name, content in theirs.items())
    assert files["program/first/start.pgx"] != longer["program/first/start.pgx"]


@pytest.mark.any_version
def test_what_cannot_be_carried_out_is_status_3(workshop, saved):
    document = FreeCAD.openDocument(str(saved))
    (cell,) = api.stages_of(document, "cell")
    cell.DepositionPoint = FreeCAD.Placement(FreeCAD.Vector(9000, 0, 0), FreeCAD.Rotation())
    document.save()
    FreeCAD.closeDocument(document.Name)
    command = workshop.run("export", saved)
    assert command.status == 3, command.err
    assert command.err.splitlines()[-1].startswith("error[")
    assert any(
        line.startswith("note[REMEDY]") for line in command.err.splitlines()
    )  # the remedies come first
    assert not (workshop.folder / "out").exists()


def test_writes_joint_paths_as_trajectories(workshop, saved):
    command = workshop.run("export", saved, "-o", "ros", "--trajectory")
    assert command.status == 0, command.err
    ((name, content),) = workshop.files("ros").items()
    assert name == "trajectories/Joint path.json"
    trajectory = json.loads(content)
    document = FreeCAD.openDocument(str(saved))
    try:
        (path,) = api.stages_of(document, "joint path")
        motion = api.result(path).motion
        assert trajectory["joint_names"] == ["q1", "q2", "q3", "q4", "q5", "q6"]
        ends = [trajectory["points"][number]["positions"] for number in (0, -1)]
        np.testing.assert_allclose(ends, motion.joints[[0, -1]], rtol=0, atol=1e-8)
        end_time = trajectory["points"][-1]["time_from_start"]
        assert end_time["sec"] + 1e-9 * end_time["nanosec"] == pytest.approx(
            path.TotalTime, abs=1e-3
        )
    finally:
        FreeCAD.closeDocument(document.Name)
    command = workshop.run("export", saved, "-o", "none", "--trajectory", "--object", "Toolpath")
    assert command.status == 2
    assert "error[BAD_INPUT] Toolpath: a toolpath has no joint values" in command.err
    command = workshop.run("export", saved, "-o", "none", "--trajectory", "--wires", "dxf")
    assert command.status == 2 and "error[USAGE]" in command.err
    assert not (workshop.folder / "none").exists()


@pytest.mark.parametrize("kind", ["step", "dxf"])
def test_writes_paths_as_wires(workshop, saved, kind):
    command = workshop.run("export", saved, "-o", "wires of it", "--wires", kind)
    assert command.status == 0, command.err
    files = workshop.files("wires of it")
    assert set(files) == {f"wires/Joint path.{kind}"}
    assert command.out.strip() == str(
        workshop.folder / "wires of it" / "wires" / f"Joint path.{kind}"
    )
    if kind == "dxf":
        assert (
            files["wires/Joint path.dxf"].startswith(b"  0\r\nSECTION")
            and b"RAPID" in files["wires/Joint path.dxf"]
        )
    command = workshop.run(
        "export", saved, "-o", "some", "--wires", kind, "--object", "Toolpath", "Second"
    )
    assert set(workshop.files("some")) == {f"wires/Toolpath.{kind}", f"wires/Second.{kind}"}
    command = workshop.run("export", saved, "-o", "none", "--wires", "iges")
    assert command.status == 2 and "error[USAGE]" in command.err
    command = workshop.run("export", saved, "-o", "none", "--wires", kind, "--object", "Cell")
    assert (
        command.status == 2
        and "error[NO_OBJECT]" in command.err
        and "Joint path, Toolpath, First one, Second" in command.err
    )
    assert not (workshop.folder / "none").exists()


def test_bad_input(workshop, saved):
    command = workshop.run("export", saved, "--object", "Third")
    assert command.status == 2 and "First one, Second" in command.err
    empty = workshop.folder / "empty.FCStd"
    document = FreeCAD.newDocument("Empty")
    document.saveAs(str(empty))
    FreeCAD.closeDocument(document.Name)
    command = workshop.run("export", empty)
    assert command.status == 2 and "error[NO_PROGRAM] empty.FCStd" in command.err
    (workshop.folder / "noise.FCStd").write_bytes(bytes(range(256)))
    command = workshop.run("export", "noise.FCStd")
    assert command.status == 2 and "error[BAD_FILE] noise.FCStd" in command.err
    command = workshop.run("export", saved, "-o", "cup.step/below")
    assert command.status == 2 and "error[UNWRITABLE]" in command.err
    assert not (workshop.folder / "out").exists()
