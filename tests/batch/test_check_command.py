# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command `check` drives edited or foreign programs in a cell."""

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
from tests.posts.planned_jobs import SETUPS, WAYS, write_program

VARIANT = WAYS[0]  # the variant: FANUC, in joints


@pytest.fixture
def sound(workshop):
    """Return the folder of a valid program, and the file of its cell."""
    _, motion, _, files = write_program(VARIANT)
    folder = workshop.folder / "edited"
    folder.mkdir()
    for name, data in files.items():
        (folder / name).write_bytes(data)
    (workshop.folder / "cell.yaml").write_text(
        interop.cell_text(SETUPS[VARIANT[3]].cell, str(workshop.folder)), encoding="utf-8"
    )
    return folder, motion


def report(workshop):
    return json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))


def changed(folder, pattern, by):
    """Change the first line of the program that matches a pattern."""
    for path in sorted(folder.iterdir()):
        text = path.read_bytes().decode("ascii")
        if re.search(pattern, text):
            path.write_bytes(re.sub(pattern, by, text, count=1).encode("ascii"))
            return
    raise AssertionError(pattern)


def reported_line(workshop, command, code):
    """Return the program line that an issue names, which the report names too."""
    (issue,) = [candidate for candidate in report(workshop)["issues"] if candidate["code"] == code]
    assert issue["message"].endswith(f"; {issue['file']} line {issue['line']}")
    assert f"; {issue['file']} line {issue['line']}\n" in command.err
    return (
        (workshop.folder / "edited" / issue["file"])
        .read_text(encoding="ascii")
        .splitlines()[issue["line"] - 1]
    )


def only_calls(errors):
    """Return whether the only reported issue is the called program on the controller."""
    return re.fullmatch(r"warning\[OTHER_PROGRAM\] [^\n]*calls CLEAN,[^\n]*\n", errors)


def run(workshop, *words, cell="cell.yaml"):
    return workshop.run("check", "edited", "--cell", cell, "-o", "out", *words)


def test_a_sound_program_does_what_was_planned(workshop, sound):
    _, motion = sound
    command = run(workshop)
    assert command.status == 0 and only_calls(command.err), command.err
    assert command.out.split() == [
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
    report_data = report(workshop)
    assert (report_data["status"], report_data["post"]) == ("ok", "fanuc")
    assert report_data["counts"]["points"] == motion.deposit.sum()
    # an unchecked promise is not green: of the beads only the positions are known
    assert [entry["ok"] for entry in report_data["preflight"]] == [True, True, True, True, None]


def test_a_job_tells_how_wide_the_beads_are(workshop, sound):
    (workshop.folder / "part.step").write_text("not looked at", encoding="utf-8")
    (workshop.folder / "job.yaml").write_text(
        "part: {file: part.step}\nstrategy: {layer_height: 3 mm}\ncell: cell.yaml\nprocess: {bead_width: 8 mm}\n"
        "program: {post: fanuc}\n",
        encoding="utf-8",
    )
    command = run(workshop, cell="job.yaml")
    assert command.status == 0 and only_calls(command.err), command.err
    rapids = report(workshop)["preflight"][-1]
    assert rapids["ok"] is True and rapids["worst"] == 0.0
    # beads higher than printed block the rapids
    job = workshop.folder / "job.yaml"
    job.write_text(job.read_text(encoding="utf-8").replace("3 mm", "60 mm"), encoding="utf-8")
    command = run(workshop, cell="job.yaml")
    assert command.status == 3 and "error[RAPID_COLLISION] layer 0" in command.err, command.err


@pytest.mark.parametrize(
    ("pattern", "by", "code"),
    [
        (r"J3=\s*-?[\d.]+ deg", "J3=   300.000 deg", "LIMIT"),
        (r"(TIME=?|)\s*\d+\.?\d*(m?sec)", r"\g<1> 1msec", "SPEED"),
    ],
)  # fmt: skip
def test_what_was_broken_is_told_with_its_place(workshop, sound, pattern, by, code):
    changed(sound[0], pattern, by)
    command = run(workshop)
    assert command.status == 3
    assert f"error[{code}] layer " in command.err, command.err
    assert report(workshop)["status"] == "infeasible"
    line = reported_line(workshop, command, code)
    if code == "SPEED":
        assert " 1msec " in line
    else:  # the move to the changed record
        texts = [path.read_text(encoding="ascii") for path in sound[0].iterdir()]
        (record,) = [
            match[1]
            for text in texts
            if (match := re.search(r"P\[(\d+)\]\{[^}]*J3=   300.000", text))
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
    command = run(workshop)
    assert (
        command.status == 3 and f"error[{code}] layer " in command.err and words in command.err
    ), command.err
    assert command.err.count(f"error[{code}]") == 1
    line = reported_line(workshop, command, code)
    assert "DO[1]=OFF" in line if code == "TRIGGER_LEAD" else re.match(r" *\d+:[JL] P\[", line)


@pytest.mark.parametrize(("depth", "told"), [(0.05, 0), (3.0, 1)])
def test_a_nozzle_that_deposits_below_the_platform_is_told(workshop, sound, depth, told):
    """The test raises the platform by the height of the lowest point and a little more."""
    _, motion = sound
    cell = SETUPS[VARIANT[3]].cell
    rows = motion.deposit & (np.hypot(*motion.position[:, :2].T) < 0.5 * cell.platform_diameter)
    thicker = float(motion.position[rows, 2].min()) + depth
    raised_cell = dataclasses.replace(cell, platform=cell.platform + thicker)
    (workshop.folder / "cell.yaml").write_text(
        interop.cell_text(raised_cell, str(workshop.folder)), encoding="utf-8"
    )
    command = run(workshop)
    assert command.err.count("error[INTO_PLATFORM]") == told, command.err
    if told:
        depth_said = float(re.search(r" by ([\d.]+) mm", command.err)[1])
        assert command.status == 3 and depth_said == pytest.approx(depth, abs=0.02)
        assert re.match(r" *\d+:[JL] P\[", reported_line(workshop, command, "INTO_PLATFORM"))


@pytest.mark.parametrize(
    ("below", "words"),
    [
        (1, "at 1 point below the platform, by 2 mm; correct the height of the point,"),
        (2, "at 2 points below the platform, here by 2 mm; correct the heights of these points,"),
    ],
)
def test_one_point_below_the_platform_is_not_called_points(sound, below, words):
    _, motion = sound
    settings = SETUPS[VARIANT[3]].cell
    cell = cells.resolve(
        dataclasses.replace(settings, platform=-1e3), np.eye(4)
    )  # the whole job is clear of it
    position, up = motion.position.copy(), cell.poses.mount[:3, 2]
    rows = np.flatnonzero(motion.deposit)[:below]
    position[rows] = cell.poses.mount[:3, 3] - 2.0 * up
    (issue_,) = into_platform(dataclasses.replace(motion, position=position), cell)
    assert words in issue_.issue.message and issue_.row == rows[0]


@pytest.mark.parametrize(
    "controller", ["abb", "kuka", "linuxcnc", "siemens", "ur", "val3", "yaskawa"]
)
def test_a_program_of_another_controller_is_refused_in_its_name(workshop, sound, root, controller):
    """The refusal holds for golden programs of all other controllers, whatever post the cell's
    robot has."""
    folder, _ = sound
    for path in folder.iterdir():
        path.unlink()
    golden = root / "tests" / "golden" / controller
    for path in golden.rglob("*"):
        if path.is_file():
            (folder / path.name).write_bytes(path.read_bytes())
    command = run(workshop)
    assert command.status == 2 and re.match(
        r"error\[(UNREADABLE_PROGRAM|NO_FILE)\]", command.err
    ), command.err
    assert "Traceback" not in command.err and not (workshop.folder / "out").exists()


def test_programs_that_cannot_be_read_are_refused(workshop, sound):
    folder, _ = sound
    command = run(workshop, "--post", "siemens")
    assert command.status == 2 and "error[UNREADABLE_PROGRAM]" in command.err
    command = run(workshop, "--post", "klingon")
    assert command.status == 2 and "error[UNKNOWN_POST]" in command.err
    command = run(workshop, cell="nowhere.yaml")
    assert command.status == 2 and "error[NO_FILE]" in command.err
    command = workshop.run("check", "edited")
    assert command.status == 2 and "error[USAGE]" in command.err
    command = workshop.run("check", "nothing", "--cell", "cell.yaml")
    assert command.status == 2 and "error[NO_FILE]" in command.err
    for path in folder.iterdir():
        path.unlink()
    for number in range(2001):
        (folder / str(number)).touch()
    command = run(workshop)
    assert (
        command.status == 2
        and "error[BAD_FILE] edited: the folder holds more than 2000 files" in command.err
    )
    for path in folder.iterdir():
        path.unlink()
    command = run(workshop)
    assert command.status == 2 and "error[NO_FILE]" in command.err
    assert not (workshop.folder / "out").exists()


def test_a_job_file_without_a_part_tells_cell_and_program(workshop, sound):
    folder, motion = sound
    cell = (workshop.folder / "cell.yaml").read_text(encoding="utf-8")
    inner = "".join(f"  {line}\n" for line in cell.splitlines() if not line.startswith("#"))
    job = workshop.folder / "bay.yaml"
    job.write_text(
        f"version: 1\nname: bay\ncell:\n{inner}program: {{post: fanuc}}\n", encoding="utf-8"
    )
    command = workshop.run("check", str(folder), "--cell", "bay.yaml", "-o", "out")
    assert command.status == 0, command.err
    assert report(workshop)["counts"]["points"] == motion.deposit.sum()
    job.write_text(f"version: 1\ncell:\n{inner}prgram: {{post: fanuc}}\n", encoding="utf-8")
    command = workshop.run("check", str(folder), "--cell", "bay.yaml", "-o", "out")
    assert (
        command.status == 2 and "error[UNKNOWN_KEY]" in command.err and "prgram" in command.err
    ), command.err
