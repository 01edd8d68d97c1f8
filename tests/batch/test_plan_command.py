# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command `plan` as its users run it: outputs, exit status, messages."""

import csv
import io
import json
import re
import signal
import subprocess
import zipfile
from html.parser import HTMLParser

import FreeCAD
import numpy as np
import Part
import pytest

MESSAGE = re.compile(r"(error|warning|note)\[[A-Z_]+\] [^:]+.*: .+")


def deposit(text):
    rows = [row for row in csv.DictReader(io.StringIO(text)) if row["kind"] == "deposit"]
    return rows, np.array([[float(row[name]) for name in ("x_mm", "y_mm", "z_mm")] for row in rows])


def test_a_whole_job(workshop):
    command = workshop.launch("plan", "cup.yaml")
    assert command.status == 0, command.err
    names = set(workshop.files())
    assert {"cup.FCStd", "waypoints.csv", "report.json", "report.html", "program/CUP.LS"} <= names
    programs = names - {"cup.FCStd", "waypoints.csv", "report.json", "report.html"}
    assert all(name.startswith("program/") for name in programs)
    assert set(command.out.split("\n")[:-1]) == {
        str(workshop.folder / "out" / "cup" / name) for name in names
    }
    assert all(MESSAGE.fullmatch(line) for line in command.err.splitlines())
    assert "\x1b" not in command.err and "\r" not in command.err  # no progress without a terminal
    report = json.loads(workshop.files()["report.json"], parse_constant=pytest.fail)
    rows, points = deposit(workshop.files()["waypoints.csv"].decode())
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 40.0, atol=1e-5)
    assert report["version"] == 1 and report["name"] == "cup" and report["status"] == "ok"
    assert report["counts"] == {"layers": 16, "beads": 16, "points": len(rows)}
    assert report["programs"] == sorted(name for name in names if name.startswith("program/"))
    between = 80.0 * np.sin(0.05)  # the chord of a 4 mm arc
    assert report["spacing_mm"]["min"] == pytest.approx(between, abs=1e-4)
    assert report["spacing_mm"]["max"] == pytest.approx(between, abs=1e-4)
    layers = np.array([int(row["layer"]) for row in rows])
    steps = [np.diff(points[layers == k], axis=0) for k in range(16)]
    assert report["length_mm"] == pytest.approx(
        np.linalg.norm(np.concatenate(steps), axis=1).sum(), rel=1e-6
    )
    joints = report["joints"]
    assert joints["method"] == "layer-by-layer" and joints["feasible"] is True
    angles = np.array([[float(row[f"q{axis}_deg"]) for axis in range(1, 7)] for row in rows])
    np.testing.assert_allclose(joints["min_deg"], angles.min(axis=0), atol=1e-6)
    np.testing.assert_allclose(joints["max_deg"], angles.max(axis=0), atol=1e-6)
    assert all(value < 0.01 for value in joints["range_per_layer_max_deg"][:5])
    assert joints["range_per_layer_max_deg"][5] == pytest.approx(360.0)
    assert joints["limit_margin_deg"][5] is None and min(joints["limit_margin_deg"][:5]) > 0.0
    assert 0.0 < joints["condition_min"] < 1.0
    assert len(joints["speed_ratio_max"]) == 6 and 0.0 < max(joints["speed_ratio_max"]) <= 1.0
    assert report["comparison"] == []


@pytest.mark.any_version
def test_the_page_is_one_file_that_parses(workshop):
    workshop.change(
        "travel_speed: 6 mm/s",
        "travel_speed: 6 mm/s\njoints: {compare: [constant], certificate: true}",
    )
    assert workshop.run("plan", "cup.yaml").status == 0
    page = workshop.files()["report.html"].decode()
    assert re.findall(r"<script[^>]*>", page) == [
        '<script type="application/json" id="path-facts">',
        '<script type="text/plain" id="path-columns">',
        "<script>",
    ]  # the path: its figures, its columns, and the code that draws them
    assert not re.search(r"(src|href)\s*=|@import|url\((?!#)", page)
    open_tags = []

    class Checker(HTMLParser):
        def handle_starttag(self, tag, attributes):
            if tag != "meta":
                open_tags.append(tag)

        def handle_startendtag(self, tag, attributes):
            pass

        def handle_endtag(self, tag):
            assert open_tags.pop() == tag

    Checker().feed(page)
    assert open_tags == []
    for word in (
        "q1",
        "q6 (endless)",
        "Distance to the previous layer",
        "Joint speeds",
        "Condition",
        "Comparison",
    ):
        assert word in page
    page_text = re.sub(
        r"<script>.*</script>", "", page, flags=re.DOTALL
    )  # its code contains the word
    assert (
        "NaN" not in page_text
        and "Infinity" not in page_text
        and ">nan" not in page_text
        and "inf<" not in page_text
    )
    report = json.loads(workshop.files()["report.json"])
    proved = report["joints"]["optimality"]
    assert proved["gap"] == pytest.approx(1.0 - proved["bound"] / proved["objective"])
    assert 0.0 <= proved["gap"] < 0.01 and f"a gap of {proved['gap']:.1%}" in page
    (constant,) = report["comparison"]
    assert constant["method"] == "constant" and constant["feasible"] is False
    assert {
        "min_deg",
        "limit_margin_deg",
        "speed_max_deg_s",
        "acceleration_max_deg_s2",
        "jerk_max_deg_s3",
    } <= set(constant)


def test_the_document_holds_every_stage(workshop):
    assert workshop.run("plan", "cup.yaml", "--no-page").status == 0
    path = workshop.folder / "out" / "cup" / "cup.FCStd"
    assert zipfile.ZipFile(path).testzip() is None
    from freecad_am import api

    document = FreeCAD.openDocument(str(path))
    try:
        assert document.Label == "cup"
        kinds = [stage.Proxy.kind for stage in api.stages_of(document)]
        assert sorted(kinds) == ["cell", "feature", "joint path", "program", "toolpath"]
        (program,) = api.stages_of(document, "program")
        files = workshop.files()
        assert {f"program/{name}": data for name, data in api.result(program).files.items()} == {
            name: data for name, data in files.items() if name.startswith("program/")
        }
    finally:
        FreeCAD.closeDocument(document.Name)


def test_the_same_job_gives_the_same_bytes(workshop):
    assert workshop.launch("plan", "cup.yaml", "-o", "one", "--no-page").status == 0
    assert workshop.launch("plan", "cup.yaml", "-o", "two", "--no-page").status == 0
    first_run, second_run = workshop.files("one"), workshop.files("two")
    assert set(first_run) == set(second_run)
    same = [name for name in first_run if name.startswith("program/") or name == "waypoints.csv"]
    assert len(same) >= 2
    assert all(first_run[name] == second_run[name] for name in same)


@pytest.mark.any_version
def test_sections_left_out_end_the_job_early(workshop):
    no_program = workshop.text[: workshop.text.index("program:")]
    workshop.write_job(no_program)
    assert workshop.run("plan", "cup.yaml", "--no-page").status == 0
    files = workshop.files()
    assert not [name for name in files if name.startswith("program/")]
    assert b"q6_deg" in files["waypoints.csv"] and b"rapid" in files["waypoints.csv"]
    workshop.write_job(no_program[: no_program.index("cell:")])
    assert workshop.run("plan", "cup.yaml", "--no-page").status == 0
    files = workshop.files()
    assert files["waypoints.csv"].startswith(
        b"layer,bead,point,kind,x_mm,y_mm,z_mm,bx,by,bz,tx,ty,tz,speed_mm_s,width_mm,class\n0,0,0,deposit,"
    )
    report = json.loads(files["report.json"])
    assert (
        report["joints"] is None and report["counts"]["layers"] == 16 and report["status"] == "ok"
    )


@pytest.mark.any_version
def test_an_infeasible_job_writes_all_but_the_program(workshop):
    assert workshop.run("plan", "cup.yaml", "--no-page").status == 0
    out = workshop.folder / "out" / "cup"
    (out / "program" / "notes.txt").write_text("mine")
    (out / "program" / "HOME.LS").write_text("mine")
    (out / "photo.jpg").write_text("mine")
    workshop.change(
        "  limits: paper", "  limits: paper\n  deposition_point: [9000, 0, 500, 0, 0, 0]"
    )
    command = workshop.run("plan", "cup.yaml")
    assert command.status == 3
    assert re.search(r"^error\[[A-Z_]+\] layer 0 .*: ", command.err, re.MULTILINE)
    assert set(workshop.files()) == {
        "cup.FCStd",
        "waypoints.csv",
        "report.json",
        "report.html",
        "program/notes.txt",
        "program/HOME.LS",
        "photo.jpg",
    }
    report = json.loads(workshop.files()["report.json"])
    assert report["status"] == "infeasible" and report["programs"] == []
    assert report["issues"][0].keys() == {"level", "code", "message", "layer", "bead", "point"}
    assert report["joints"]["feasible"] is False and report["duration_s"] > 0.0
    page = workshop.files()["report.html"].decode()
    assert "UNREACHABLE" in page and not re.search(r"\bnan\b|\binf\b", page)
    rows, _ = deposit(workshop.files()["waypoints.csv"].decode())
    assert rows[0]["q1_deg"] == "" and rows[0]["x_mm"] != ""


@pytest.mark.any_version
def test_a_toolpath_that_cannot_be_deposited_is_reported_too(workshop):
    workshop.change("cell:\n", "build_direction: {tilt: 60 deg, max_tilt: 10 deg}\ncell:\n")
    command = workshop.run("plan", "cup.yaml")
    assert command.status == 3 and "error[" in command.err
    assert set(workshop.files()) == {"cup.FCStd", "waypoints.csv", "report.json", "report.html"}
    rows, points = deposit(workshop.files()["waypoints.csv"].decode())
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 40.0, atol=1e-5)
    assert all(row[f"q{axis}_deg"] == "" for row in rows for axis in range(1, 7))
    report = json.loads(workshop.files()["report.json"])
    assert report["status"] == "infeasible" and report["joints"] is None


@pytest.mark.any_version
def test_a_run_of_another_name_takes_the_place_of_the_last(workshop):
    assert workshop.run("plan", "cup.yaml", "-o", "out", "--no-page").status == 0
    workshop.change("name: cup", "name: bowl")
    assert workshop.run("plan", "cup.yaml", "-o", "out", "--no-page").status == 0
    names = set(workshop.files("out"))
    assert "bowl.FCStd" in names and "program/BOWL.LS" in names
    assert not [name for name in names if "cup" in name.lower()]


def test_spaces_and_accents(workshop):
    workshop.write_job(
        workshop.text[: workshop.text.index("program:")].replace(
            "name: cup", "name: Käse Glocke n° 1"
        )
    )
    folder = "mit Leerzeichen é"
    command = workshop.launch("plan", workshop.job, "-o", workshop.folder / folder, "--no-page")
    assert command.status == 0, command.err
    assert "Käse Glocke n° 1.FCStd" in workshop.files(folder)


@pytest.mark.any_version
def test_through_a_link_and_from_elsewhere(workshop, tmp_path_factory):
    link = tmp_path_factory.mktemp("bin") / "am"
    link.symlink_to(workshop.launcher)
    workshop.launcher = link
    job = workshop.folder / "cup.yaml"
    workshop.folder, home = tmp_path_factory.mktemp("elsewhere"), workshop.folder
    command = workshop.launch("plan", job, "--no-page")
    assert command.status == 0, command.err
    assert (home / "out" / "cup" / "cup.FCStd").is_file()


@pytest.mark.parametrize(
    ("old", "new", "code", "says"),
    [
        (
            "layer_height: 4 mm",
            "layer_height: 4 cubits",
            "BAD_UNIT",
            "cup.yaml: strategy.layer_height",
        ),
        (
            "layer_height: 4 mm",
            "layer_height: 0 mm",
            "BAD_VALUE",
            "cup.yaml: strategy.layer_height",
        ),
        (
            "layer_height: 4 mm",
            "layer_height: 500 mm",
            "LAYER_HEIGHT",
            "cup.yaml: strategy.layer_height",
        ),
        (
            "layer_height: 4 mm",
            "layer_height: 1e-6 mm",
            "TOO_MANY",
            "cup.yaml: strategy.layer_height",
        ),
        ("limits: paper", "nozzle: {length: 1e9 mm}", "BAD_VALUE", "cup.yaml: cell.nozzle.length"),
        ("limits: paper", "limits: papre", "UNKNOWN_LIMITS", "cup.yaml: cell.limits"),
        (
            "limits: paper",
            "machine: fanuc-arcmate120",
            "UNKNOWN_MACHINE",
            "did you mean fanuc-arcmate120ic",
        ),
        ("limits: paper", "machine: none/such.json", "UNKNOWN_MACHINE", "such.json"),
        ("post: fanuc", "post: fanuk", "UNKNOWN_POST", "cup.yaml: program.post"),
        ("name: cup", "name: my-cup", "PROGRAM_NAME", "cup.yaml: name"),
        ("post: fanuc", "post: fanuc\n  motion: cartesian", "REMOTE_TCP", "remote TCP"),
        ("cup.step", "none.step", "NO_FILE", "none.step"),
        ("cup.step", "empty.step", "EMPTY_FILE", "empty.step"),
        ("cup.step", "noise.step", "BAD_FILE", "noise.step"),
        ("cup.step", "noise.iges", "BAD_FILE", "noise.iges"),
        ("cup.step", "noise.brep", "BAD_FILE", "noise.brep"),
        ("cup.step", "noise.FCStd", "BAD_FILE", "noise.FCStd"),
        ("cup.step", "cup.docx", "UNSUPPORTED_FILE", "cup.docx"),
        ("cup.step}", "cup.step, faces: [Face77]}", "", "Face77"),
        ("cup.step", "box.step", "", "box"),
    ],
)
def test_bad_input_is_status_2_and_writes_nothing(workshop, old, new, code, says):
    (workshop.folder / "empty.step").write_bytes(b"")
    for name in ("noise.step", "noise.iges", "noise.brep", "noise.FCStd", "cup.docx"):
        (workshop.folder / name).write_bytes(bytes(range(256)) * 20)
    Part.makeBox(10, 20, 30).exportStep(str(workshop.folder / "box.step"))
    workshop.change(old, new)
    command = workshop.run("plan", "cup.yaml")
    assert command.status == 2, command.err
    (line,) = command.err.splitlines()
    assert MESSAGE.fullmatch(line)
    assert line.startswith(f"error[{code}]" if code else "error[")
    assert says in line
    assert command.out == ""
    assert not (workshop.folder / "out").exists()


@pytest.mark.parametrize("folder", ["taken", "taken/below", "/proc/none/below"])
def test_a_folder_that_cannot_be_written(workshop, folder):
    (workshop.folder / "taken").write_text("a file, not a folder")
    command = workshop.run("plan", "cup.yaml", "-o", folder)
    assert command.status == 2
    assert re.fullmatch(r"error\[UNWRITABLE\] \S*: .*choose another.*\n", command.err)
    assert (workshop.folder / "taken").read_text() == "a file, not a folder"


@pytest.mark.any_version
def test_folders_in_the_place_of_files_leave_all_as_it_was(workshop):
    (workshop.folder / "out" / "cup" / "waypoints.csv").mkdir(parents=True)
    (workshop.folder / "out" / "cup" / "report.json").write_text("{}")
    command = workshop.run("plan", "cup.yaml")
    assert command.status == 2 and "error[UNWRITABLE]" in command.err
    assert set(workshop.files()) == {"report.json"}


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ([], ""),
        (["plan"], "JOB.yaml"),
        (["plan", "a", "b"], "b"),
        (["plna", "a"], "did you mean plan"),
        (["plan", "none.yaml"], "none.yaml"),
        (["plan", "cup.yaml", "--nope"], "--nope"),
        (["plan", "cup.yaml", "-o"], "-o"),
        (["export"], "DOC.FCStd"),
        (["export", "none.FCStd"], "none.FCStd"),
        (["export", "cup.step"], "FCStd"),
        (["batch", "t.csv"], "--job"),
        (["batch", "t.csv", "--job", "cup.yaml"], "t.csv"),
        (["batch", "t.csv", "--job", "cup.yaml", "-j", "0"], "processes"),
        (["machines", "all"], "all"),
    ],
)
def test_usage_errors(workshop, words, says):
    command = (workshop.launch if words in ([], ["plan"]) else workshop.run)(*words)
    assert command.status == 2
    assert says in command.err
    assert "Traceback" not in command.err


@pytest.mark.any_version
def test_machines_lists_those_that_plan_accepts(workshop):
    command = workshop.launch("machines")
    assert command.status == 0 and command.err == ""
    listed = dict(line.split(None, 1) for line in command.out.splitlines())
    assert (
        "FANUC" in listed["fanuc-arcmate120ic"]
        and "kuka-kr16-2" in listed
        and "staubli-rx60bl" in listed
    )
    folder = workshop.folder / "RoboticAM" / "machines"
    folder.mkdir(parents=True)
    from freecad_am.core.kinematics.machines import machine

    machine_data = json.loads(
        (machine.BUILT_IN / "fanuc-arcmate120ic.json").read_text(encoding="utf-8")
    )
    machine_data.update(id="my-robot", title="My own robot")
    (folder / "my-robot.json").write_text(json.dumps(machine_data))
    assert "my-robot" in workshop.launch("machines").out
    workshop.change("limits: paper", "limits: paper\n  machine: my-robot")
    command = workshop.launch("plan", "cup.yaml", "--no-page")
    assert command.status == 0, command.err
    assert json.loads(workshop.files()["report.json"])["machine"]["id"] == "my-robot"


@pytest.mark.any_version
def test_progress_shows_on_a_terminal_and_is_gone_at_the_end(workshop):
    import os
    import pty

    chunks = []

    def read(descriptor):
        chunks.append(os.read(descriptor, 4096))
        return chunks[-1]

    screen = os.open(os.devnull, os.O_WRONLY)
    keep = os.dup(1)
    os.dup2(screen, 1)  # pty.spawn copies to it
    try:
        home = workshop.environment()["FREECAD_USER_HOME"]
        command = f"cd '{workshop.folder}' && FREECAD_USER_HOME='{home}' '{workshop.launcher}' plan cup.yaml"
        status = pty.spawn(["/bin/sh", "-c", command], read)
    finally:
        os.dup2(keep, 1)
        os.close(keep)
        os.close(screen)
    text = b"".join(chunks).decode()
    assert os.waitstatus_to_exitcode(status) == 0
    assert "joint path" in text and "%" in text
    last_frame = text.rindex("page ...")
    assert text[last_frame:].startswith("page ...\r\x1b[K")
    assert "\x1b" not in text[last_frame + 12 :]


@pytest.mark.any_version
def test_a_large_job_is_told_before_its_work(workshop):
    """With 670,000 points, the warning appears while the work runs; the test then interrupts it."""
    workshop.write_job(
        workshop.text.replace("4 mm", "0.1 mm").replace(
            "chord_error: 0.1 mm", "chord_error: 0.0001 mm"
        )
    )
    process = subprocess.Popen(
        [str(workshop.launcher), "plan", "cup.yaml"],
        cwd=workshop.folder,
        env=workshop.environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    line = process.stderr.readline()
    assert re.fullmatch(
        r"note\[LARGE\] job: planning about 6\d0,000 points in 6\d0 layers takes .+\n", line
    ), line
    assert process.poll() is None
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=120)[1] == "interrupted: nothing was written\n"
    assert process.returncode == 130 and not (workshop.folder / "out").exists()
