# SPDX-License-Identifier: LGPL-2.1-or-later
"""`export`: programs out of a saved document, computed again."""

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
    """A document with two programs, made through the macro interface and saved."""
    folder = tmp_path_factory.mktemp("two cups")
    make_cup(folder)
    document = FreeCAD.newDocument("Two")
    part = api.open_part(document, str(folder / "cup.step"))
    cell = api.make_cell(document, limits="paper", platform_diameter=100)
    feature = api.make_feature(document, part, layer_height=8, chord_error=0.1)
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
    """A copy of that document beside the part."""
    return Path(shutil.copy(two_cups, workshop.folder))


@pytest.fixture
def script_of_another_freecad(tmp_path):
    """run(*lines): the lines run in a new process that finds FreeCAD but not this package."""

    def run(*lines):
        path = tmp_path / "script.py"
        found = f"import sys; sys.path.append({os.path.dirname(FreeCAD.__file__)!r})"
        path.write_text("\n".join([found, "import FreeCAD", *lines]))
        # a home of its own: the tests' own profile has this workbench among its modules
        home = tmp_path / "another home"
        home.mkdir(exist_ok=True)
        done = subprocess.run(
            [sys.executable, str(path)],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, "FREECAD_USER_HOME": str(home), "PYTHONPATH": ""},
        )
        assert done.returncode == 0, done.stderr

    return run


def test_writes_all_programs(workshop, saved):
    before = saved.read_bytes()
    done = workshop.launch("export", saved)
    assert done.status == 0, done.err
    files = workshop.files("out/Two Cups")
    assert set(files) == {"program/FIRST.LS", "program/SECOND.LS"}
    assert done.out.splitlines() == [
        str(workshop.folder / "out" / "Two Cups" / name) for name in sorted(files)
    ]
    assert files["program/FIRST.LS"] != files["program/SECOND.LS"]
    assert saved.read_bytes() == before
    again = workshop.launch("export", saved, "-o", "again")
    assert again.status == 0 and workshop.files("again") == files


def test_findings_of_all_stages_are_told_once(workshop, saved):
    document = FreeCAD.openDocument(str(saved))
    try:
        found = {issue for obj in api.stages_of(document) for issue in api.issues(obj)}
    finally:
        FreeCAD.closeDocument(document.Name)
    assert any(issue.level == "warning" for issue in found)
    said = workshop.run("export", saved).err.splitlines()
    for issue in found:
        line = (
            f"{issue.level}[{issue.code}] {issue.where or 'job'}: {' '.join(issue.message.split())}"
        )
        assert said.count(line) == 1


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
    before, after = (
        workshop.files("before")["program/FIRST.LS"],
        workshop.files("after")["program/FIRST.LS"],
    )
    assert after.count(b"J P[") > 1.6 * before.count(b"J P[") > 0


def test_a_document_saved_where_the_workbench_is_not_installed(
    workshop, saved, script_of_another_freecad
):
    """A FreeCAD that does not know the workbench saves plain objects; they are stages again for us."""
    assert workshop.run("export", saved, "-o", "before").status == 0
    script_of_another_freecad(
        f"document = FreeCAD.openDocument({str(saved)!r})",
        "assert all(getattr(obj, 'Proxy', None) is None for obj in document.Objects)",
        "next(obj for obj in document.Objects if 'LayerHeight' in obj.PropertiesList).LayerHeight = 4.0",
        "document.recompute()",
        "document.save()",
    )
    done = workshop.run("export", saved, "-o", "after")
    assert done.status == 0, done.err
    before, after = (
        workshop.files("before")["program/FIRST.LS"],
        workshop.files("after")["program/FIRST.LS"],
    )
    assert after.count(b"J P[") > 1.6 * before.count(b"J P[") > 0


def application(saved, **program):
    """The first program as a VAL 3 application; the document with a machine that reads those."""
    document = FreeCAD.openDocument(str(saved))
    (cell,) = api.stages_of(document, "cell")
    cell.Machine, cell.Limits = "staubli-rx60bl", "maker"
    cell.DepositionPoint = FreeCAD.Placement(FreeCAD.Vector(550, 0, 800), FreeCAD.Rotation())
    cell.Branch = "auto"
    first, second = api.stages_of(document, "program")
    document.removeObject(second.Name)
    first.Post = "staubli"
    for name, value in program.items():
        setattr(first, name, value)
    document.save()
    FreeCAD.closeDocument(document.Name)


@pytest.mark.any_version
def test_what_an_earlier_longer_export_left_is_removed_and_nothing_else(workshop, saved):
    application(saved, MaxPoints=200)
    done = workshop.run("export", saved, "-o", "out")
    assert done.status == 0, done.err
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
    done = workshop.run("export", saved, "-o", "out")
    assert done.status == 0, done.err
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
    done = workshop.run("export", saved)
    assert done.status == 3, done.err
    assert done.err.splitlines()[-1].startswith("error[")
    assert any(
        line.startswith("note[REMEDY]") for line in done.err.splitlines()
    )  # what would help is told first
    assert not (workshop.folder / "out").exists()


def test_writes_joint_paths_as_trajectories(workshop, saved):
    done = workshop.run("export", saved, "-o", "ros", "--trajectory")
    assert done.status == 0, done.err
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
        last = trajectory["points"][-1]["time_from_start"]
        assert last["sec"] + 1e-9 * last["nanosec"] == pytest.approx(path.TotalTime, abs=1e-3)
    finally:
        FreeCAD.closeDocument(document.Name)
    done = workshop.run("export", saved, "-o", "none", "--trajectory", "--object", "Toolpath")
    assert done.status == 2
    assert "error[BAD_INPUT] Toolpath: a toolpath has no joint values" in done.err
    done = workshop.run("export", saved, "-o", "none", "--trajectory", "--wires", "dxf")
    assert done.status == 2 and "error[USAGE]" in done.err
    assert not (workshop.folder / "none").exists()


@pytest.mark.parametrize("kind", ["step", "dxf"])
def test_writes_paths_as_wires(workshop, saved, kind):
    done = workshop.run("export", saved, "-o", "wires of it", "--wires", kind)
    assert done.status == 0, done.err
    files = workshop.files("wires of it")
    assert set(files) == {f"wires/Joint path.{kind}"}
    assert done.out.strip() == str(workshop.folder / "wires of it" / "wires" / f"Joint path.{kind}")
    if kind == "dxf":
        assert (
            files["wires/Joint path.dxf"].startswith(b"  0\r\nSECTION")
            and b"RAPID" in files["wires/Joint path.dxf"]
        )
    done = workshop.run(
        "export", saved, "-o", "some", "--wires", kind, "--object", "Toolpath", "Second"
    )
    assert set(workshop.files("some")) == {f"wires/Toolpath.{kind}", f"wires/Second.{kind}"}
    done = workshop.run("export", saved, "-o", "none", "--wires", "iges")
    assert done.status == 2 and "error[USAGE]" in done.err
    done = workshop.run("export", saved, "-o", "none", "--wires", kind, "--object", "Cell")
    assert (
        done.status == 2
        and "error[NO_OBJECT]" in done.err
        and "Joint path, Toolpath, First one, Second" in done.err
    )
    assert not (workshop.folder / "none").exists()


def test_bad_input(workshop, saved):
    done = workshop.run("export", saved, "--object", "Third")
    assert done.status == 2 and "First one, Second" in done.err
    empty = workshop.folder / "empty.FCStd"
    document = FreeCAD.newDocument("Empty")
    document.saveAs(str(empty))
    FreeCAD.closeDocument(document.Name)
    done = workshop.run("export", empty)
    assert done.status == 2 and "error[NO_PROGRAM] empty.FCStd" in done.err
    (workshop.folder / "noise.FCStd").write_bytes(bytes(range(256)))
    done = workshop.run("export", "noise.FCStd")
    assert done.status == 2 and "error[BAD_FILE] noise.FCStd" in done.err
    done = workshop.run("export", saved, "-o", "cup.step/below")
    assert done.status == 2 and "error[UNWRITABLE]" in done.err
    assert not (workshop.folder / "out").exists()
