# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs that were edited, or come from elsewhere, driven in a cell."""

import csv
import dataclasses
import io
import json
import re

import numpy as np
import pytest

from freecad_am import interop
from freecad_am.core.kinematics import cell as cells
from freecad_am.read_back.selected import into_platform
from tests.posts.planned_jobs import SETUPS, WAYS, written

WAY = WAYS[0]  # of a FANUC, in joints


@pytest.fixture
def sound(workshop):
    """The folder of a program that is sound, and the file of its cell."""
    _, motion, _, files = written(WAY)
    folder = workshop.folder / "edited"
    folder.mkdir()
    for name, data in files.items():
        (folder / name).write_bytes(data)
    (workshop.folder / "cell.yaml").write_text(
        interop.cell_text(SETUPS[WAY[3]].cell, str(workshop.folder)), encoding="utf-8"
    )
    return folder, motion


def report(workshop):
    return json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))


def changed(folder, pattern, by):
    """Change the first line of the program that fits a pattern."""
    for path in sorted(folder.iterdir()):
        text = path.read_bytes().decode("ascii")
        if re.search(pattern, text):
            path.write_bytes(re.sub(pattern, by, text, count=1).encode("ascii"))
            return
    raise AssertionError(pattern)


def told_line(workshop, done, code):
    """The line of the program that a finding names, in the report too."""
    (issue,) = [one for one in report(workshop)["issues"] if one["code"] == code]
    assert issue["message"].endswith(f"; {issue['file']} line {issue['line']}")
    assert f"; {issue['file']} line {issue['line']}\n" in done.err
    return (
        (workshop.folder / "edited" / issue["file"])
        .read_text(encoding="ascii")
        .splitlines()[issue["line"] - 1]
    )


def only_calls(errors):
    """Whether nothing but the program of the controller that is called is reported."""
    return re.fullmatch(r"warning\[OTHER_PROGRAM\] [^\n]*calls CLEAN,[^\n]*\n", errors)


def run(workshop, *words, cell="cell.yaml"):
    return workshop.run("check", "edited", "--cell", cell, "-o", "out", *words)


def test_a_sound_program_does_what_was_planned(workshop, sound):
    _, motion = sound
    done = run(workshop)
    assert done.status == 0 and only_calls(done.err), done.err
    assert done.out.split() == [
        str(workshop.folder / "out" / name) for name in ("report.json", "waypoints.csv")
    ]
    rows = list(
        csv.DictReader(
            io.StringIO((workshop.folder / "out" / "waypoints.csv").read_text(encoding="ascii"))
        )
    )
    for column, values in zip(("x_mm", "y_mm", "z_mm"), motion.position.T, strict=True):
        np.testing.assert_allclose([float(row[column]) for row in rows], values, atol=0.03)
    assert [row["kind"] == "deposit" for row in rows] == motion.deposit.tolist()
    found = report(workshop)
    assert (found["status"], found["post"]) == ("ok", "fanuc")
    assert found["counts"]["points"] == motion.deposit.sum()
    # nothing green stands for not looked at: of the beads nothing is known but where they are
    assert [one["ok"] for one in found["preflight"]] == [True, True, True, True, None]


def test_a_job_tells_how_wide_the_beads_are(workshop, sound):
    (workshop.folder / "part.step").write_text("not looked at", encoding="utf-8")
    (workshop.folder / "job.yaml").write_text(
        "part: {file: part.step}\nstrategy: {layer_height: 3 mm}\ncell: cell.yaml\nprocess: {bead_width: 8 mm}\n"
        "program: {post: fanuc}\n",
        encoding="utf-8",
    )
    done = run(workshop, cell="job.yaml")
    assert done.status == 0 and only_calls(done.err), done.err
    rapids = report(workshop)["preflight"][-1]
    assert rapids["ok"] is True and rapids["worst"] == 0.0
    # beads as high as nobody laid them stand in the way of the rapids
    job = workshop.folder / "job.yaml"
    job.write_text(job.read_text(encoding="utf-8").replace("3 mm", "60 mm"), encoding="utf-8")
    done = run(workshop, cell="job.yaml")
    assert done.status == 3 and "error[RAPID_COLLISION] layer 0" in done.err, done.err


@pytest.mark.parametrize(
    ("pattern", "by", "code"),
    [
        (r"J3=\s*-?[\d.]+ deg", "J3=   300.000 deg", "LIMIT"),
        (r"(TIME=?|)\s*\d+\.?\d*(m?sec)", r"\g<1> 1msec", "SPEED"),
    ],
)  # fmt: skip
def test_what_was_broken_is_told_with_its_place(workshop, sound, pattern, by, code):
    changed(sound[0], pattern, by)
    done = run(workshop)
    assert done.status == 3
    assert f"error[{code}] layer " in done.err, done.err
    assert report(workshop)["status"] == "infeasible"
    line = told_line(workshop, done, code)
    if code == "SPEED":
        assert " 1msec " in line
    else:  # the move to the record that was changed
        texts = [path.read_text(encoding="ascii") for path in sound[0].iterdir()]
        (record,) = [
            found[1]
            for text in texts
            if (found := re.search(r"P\[(\d+)\]\{[^}]*J3=   300.000", text))
        ]
        assert re.match(rf" *\d+:[JL] P\[{record}\] ", line)


@pytest.mark.parametrize(
    ("pattern", "by", "code", "words"),
    [
        (r" *\d+:  DO\[1\]=OFF ;", "   1:  ;", "DEPOSIT_SWITCH", "already on"),
        (r"(?s)(.*)DO\[1\]=OFF ;", r"\1 ;", "DEPOSIT_SWITCH", "the program ends with the deposit still on"),
        (r"(?s)(FINE {4};.*?)FINE {4};", r"\1FINE TB  29.00sec,DO[1]=OFF    ;", "TRIGGER_LEAD", "less than the lead of 29 s"),
    ],
)  # fmt: skip
def test_a_deposit_that_is_switched_as_no_program_does_is_told(
    workshop, sound, pattern, by, code, words
):
    changed(sound[0], pattern, by)
    done = run(workshop)
    assert done.status == 3 and f"error[{code}] layer " in done.err and words in done.err, done.err
    assert done.err.count(f"error[{code}]") == 1
    line = told_line(workshop, done, code)
    assert "DO[1]=OFF" in line if code == "TRIGGER_LEAD" else re.match(r" *\d+:[JL] P\[", line)


@pytest.mark.parametrize(("depth", "told"), [(0.05, 0), (3.0, 1)])
def test_a_nozzle_that_deposits_below_the_platform_is_told(workshop, sound, depth, told):
    """The platform is told to be as much thicker as the lowest point is above it, and some more."""
    _, motion = sound
    cell = SETUPS[WAY[3]].cell
    rows = motion.deposit & (np.hypot(*motion.position[:, :2].T) < 0.5 * cell.platform_diameter)
    thicker = float(motion.position[rows, 2].min()) + depth
    other = dataclasses.replace(cell, platform=cell.platform + thicker)
    (workshop.folder / "cell.yaml").write_text(
        interop.cell_text(other, str(workshop.folder)), encoding="utf-8"
    )
    done = run(workshop)
    assert done.err.count("error[INTO_PLATFORM]") == told, done.err
    if told:
        depth_said = float(re.search(r"here ([\d.]+) mm", done.err)[1])
        assert done.status == 3 and depth_said == pytest.approx(depth, abs=0.02)
        assert re.match(r" *\d+:[JL] P\[", told_line(workshop, done, "INTO_PLATFORM"))


@pytest.mark.parametrize(
    ("below", "words"),
    [
        (1, "at 1 point below the platform, by 2 mm; correct the height of the point,"),
        (2, "at 2 points below the platform, here by 2 mm; correct the heights of these points,"),
    ],
)
def test_one_point_below_the_platform_is_not_called_points(sound, below, words):
    _, motion = sound
    settings = SETUPS[WAY[3]].cell
    cell = cells.resolve(
        dataclasses.replace(settings, platform=-1e3), np.eye(4)
    )  # of which all of the job is clear
    position, up = motion.position.copy(), cell.poses.mount[:3, 2]
    rows = np.flatnonzero(motion.deposit)[:below]
    position[rows] = cell.poses.mount[:3, 3] - 2.0 * up
    (found,) = into_platform(dataclasses.replace(motion, position=position), cell)
    assert words in found.issue.message and found.row == rows[0]


@pytest.mark.parametrize(
    "controller", ["abb", "kuka", "linuxcnc", "siemens", "ur", "val3", "yaskawa"]
)
def test_a_program_of_another_controller_is_refused_in_its_name(workshop, sound, root, controller):
    """Whatever the cell's robot reads: golden programs of all other controllers."""
    folder, _ = sound
    for path in folder.iterdir():
        path.unlink()
    golden = root / "tests" / "golden" / controller
    for path in golden.rglob("*"):
        if path.is_file():
            (folder / path.name).write_bytes(path.read_bytes())
    done = run(workshop)
    assert done.status == 2 and re.match(r"error\[(UNREADABLE_PROGRAM|NO_FILE)\]", done.err), (
        done.err
    )
    assert "Traceback" not in done.err and not (workshop.folder / "out").exists()


def test_programs_that_cannot_be_read_are_refused(workshop, sound):
    folder, _ = sound
    done = run(workshop, "--post", "siemens")
    assert done.status == 2 and "error[UNREADABLE_PROGRAM]" in done.err
    done = run(workshop, "--post", "klingon")
    assert done.status == 2 and "error[UNKNOWN_POST]" in done.err
    done = run(workshop, cell="nowhere.yaml")
    assert done.status == 2 and "error[NO_FILE]" in done.err
    done = workshop.run("check", "edited")
    assert done.status == 2 and "error[USAGE]" in done.err
    done = workshop.run("check", "nothing", "--cell", "cell.yaml")
    assert done.status == 2 and "error[NO_FILE]" in done.err
    for path in folder.iterdir():
        path.unlink()
    for number in range(2001):
        (folder / str(number)).touch()
    done = run(workshop)
    assert (
        done.status == 2
        and "error[BAD_FILE] edited: the folder holds more than 2000 files" in done.err
    )
    for path in folder.iterdir():
        path.unlink()
    done = run(workshop)
    assert done.status == 2 and "error[NO_FILE]" in done.err
    assert not (workshop.folder / "out").exists()


def test_a_job_file_without_a_part_tells_cell_and_program(workshop, sound):
    folder, motion = sound
    cell = (workshop.folder / "cell.yaml").read_text(encoding="utf-8")
    inner = "".join(f"  {line}\n" for line in cell.splitlines() if not line.startswith("#"))
    job = workshop.folder / "bay.yaml"
    job.write_text(
        f"version: 1\nname: bay\ncell:\n{inner}program: {{post: fanuc}}\n", encoding="utf-8"
    )
    done = workshop.run("check", str(folder), "--cell", "bay.yaml", "-o", "out")
    assert done.status == 0, done.err
    assert report(workshop)["counts"]["points"] == motion.deposit.sum()
    job.write_text(f"version: 1\ncell:\n{inner}prgram: {{post: fanuc}}\n", encoding="utf-8")
    done = workshop.run("check", str(folder), "--cell", "bay.yaml", "-o", "out")
    assert done.status == 2 and "error[UNKNOWN_KEY]" in done.err and "prgram" in done.err, done.err
