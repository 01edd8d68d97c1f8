# SPDX-License-Identifier: LGPL-2.1-or-later
"""Classes of beads from a job file to its program: the class of a bead follows from its position on
the part only, and every class has its settings."""

import csv
import json
import re

import FreeCAD
import numpy as np
import Part
import pytest

from freecad_am.batch.job import job as jobs
from freecad_am.core.issues import InputError

# a bar with contours as outermost beads and lines inside
SIDE, HIGH, WIDTH, LAYER = 28.0, 6.0, 4.0, 2.0
JOB = """\
version: 1
name: bar
part: {file: bar.step}
strategy: {kind: solid, layer_height: 2 mm, bead_spacing: 4 mm, fill: lines, chord_error: 0.1 mm}
build_direction: {clearance: none}
cell: {setup: tool-on-robot, deposition_point: [1000, 0, -100, 0, 0, 0], nozzle: {tool: [0, 0, 250, 0, 0, 0]},
  limits: maker, branch: auto, platform_diameter: 300 mm}
joints: {method: constant}
process:
  bead_width: 4 mm
  travel_speed: 6 mm/s
CLASSES
program: {post: fanuc, schedule: {output: 5}}
"""
CLASSES = """\
  schedule: 9
  classes:
    first_layer: {travel_speed: 240 mm/min, schedule: 1}
    contour: {travel_speed: 8 mm/s, schedule: 3, lead: 10 deg, tilt: -5 deg, lead_on: 0.8 s}
    fill: {lead_off: 1.5 s}
"""


def planned(workshop, options, program=""):
    if not (workshop.folder / "bar.step").exists():
        Part.makeBox(SIDE, SIDE, HIGH).exportStep(str(workshop.folder / "bar.step"))
    (workshop.folder / "bar.yaml").write_text(
        JOB.replace("CLASSES\n", options).replace("program: {", "program: {" + program)
    )
    command = workshop.run("plan", "bar.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    out = workshop.folder / "out"
    with open(out / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    return (
        rows,
        json.loads((out / "report.json").read_text()),
        (out / "program" / "BAR.LS").read_bytes().decode(),
    )


def numbers(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def test_classes_of_a_filled_bar(workshop):
    rows, report, text = planned(workshop, CLASSES)
    deposit = [row for row in rows if row["kind"] == "deposit"]
    assert list(rows[0])[-1] == "class" and all(row["class"] for row in rows)
    # by geometry only: the lowest plane; beads that run half a width inside of the border; the
    # others
    positions, layer = numbers(deposit, "x_mm", "y_mm", "z_mm"), numbers(deposit, "layer")[:, 0]
    bead = numbers(deposit, "bead")[:, 0]
    edge = np.minimum(positions[:, :2], SIDE - positions[:, :2]).min(axis=1)
    assert (
        np.ptp(
            np.bincount(layer.astype(int), positions[:, 2]) / np.bincount(layer.astype(int))
            - LAYER * np.arange(3)
        )
        < 1e-9
    )
    for key in sorted(set(zip(layer.tolist(), bead.tolist()))):
        of_bead = (layer == key[0]) & (bead == key[1])
        along = np.abs(edge[of_bead] - 0.5 * WIDTH).max() < 0.02
        expected = "first_layer" if key[0] == 0 else "contour" if along else "fill"
        assert {deposit[k]["class"] for k in np.flatnonzero(of_bead)} == {expected}
    name = np.array([row["class"] for row in deposit])
    assert set(name) == {"first_layer", "contour", "fill"}
    speed = numbers(deposit, "speed_mm_s")[:, 0]
    for class_name, expected in (("first_layer", 4.0), ("contour", 8.0), ("fill", 6.0)):
        assert np.abs(speed[name == class_name] - expected).max() < 1e-6
    # lead tilts along the bead and tilt across it, both checked in the middle of its straight sides
    tool, build = numbers(deposit, "tx", "ty", "tz"), numbers(deposit, "bx", "by", "bz")
    angle = np.degrees(np.arccos(np.clip((tool * build).sum(axis=1), -1.0, 1.0)))
    leant = np.degrees(np.arccos(np.cos(np.radians(10.0)) * np.cos(np.radians(5.0))))
    assert (
        np.abs(angle[name != "contour"]).max() < 1e-6
        and abs(np.median(angle[name == "contour"]) - leant) < 1e-4
    )
    _figures(report, rows)
    _program(text, deposit)


def wire_line(report):
    """Return the line of the preflight about the wire."""
    (line,) = [
        line
        for line in report["preflight"]
        if line["promise"] == "The wire feed matches the volume of the beads"
    ]
    return line


def _figures(report, rows):
    """Check lengths and times of classes with the rows only; the job's total includes the lead
    times of classes."""
    positions = numbers(rows, "x_mm", "y_mm", "z_mm")
    distances = np.r_[0.0, np.linalg.norm(np.diff(positions, axis=0), axis=1)]
    moves = np.array([row["kind"] == "deposit" and row["point"] != "0" for row in rows])
    speed = np.array([float(row["speed_mm_s"] or "inf") for row in rows])
    assert [row["class"] for row in report["classes"]] == ["first_layer", "contour", "fill"]
    for class_figures in report["classes"]:
        of_class = moves & np.array([row["class"] == class_figures["class"] for row in rows])
        assert class_figures["length_mm"] == pytest.approx(distances[of_class].sum(), abs=1e-3)
        assert class_figures["deposit_s"] == pytest.approx(
            (distances[of_class] / speed[of_class]).sum(), abs=1e-3
        )
        begins = {
            (row["layer"], row["bead"])
            for row in rows
            if row["kind"] == "deposit" and row["class"] == class_figures["class"]
        }
        assert class_figures["beads"] == len(begins)
    assert [row["schedule"] for row in report["classes"]] == [1, 3, 9]
    assert wire_line(report)["ok"] is None and wire_line(report)["how"].endswith(
        "the wire feed of contour, first_layer"
    )
    count = {row["class"]: row["beads"] for row in report["classes"]}
    assert report["totals"]["wait_s"] == pytest.approx(
        0.8 * count["contour"] + 1.5 * count["fill"], abs=1e-9
    )


def _program(text, deposit):
    """Return the events before each bead, and the waits at its ends."""
    begins = [row["class"] for row in deposit if row["point"] == "0"]
    events = re.findall(
        r"GO\[5\]=(\d+) ;\r\n *\d+:  DO\[1\]=ON ;\r\n *\d+:(?:  WAIT +([.\d]+)\(sec\))?", text
    )
    ends = re.findall(r":(?:  WAIT +([.\d]+)\(sec\))? ?;?\r?\n? *\d*:? *DO\[1\]=OFF", text)
    assert [int(number) for number, _ in events] == [
        {"first_layer": 1, "contour": 3, "fill": 9}[name] for name in begins
    ]
    assert [wait for _, wait in events] == [".80" if name == "contour" else "" for name in begins]
    assert len(ends) == len(begins) and ends == [
        "1.50" if name == "fill" else "" for name in begins
    ]


def test_a_job_without_classes_keeps_its_program(workshop):
    _, plain, plain_program = planned(workshop, "")
    _, class_report, class_program = planned(
        workshop, "  classes: {wall: {travel_speed: 20 mm/s}, closing: {lead: 5 deg}}\n"
    )
    assert plain_program == class_program and "GO[" not in plain_program
    assert (
        plain["classes"] == class_report["classes"]
        and [row["schedule"] for row in plain["classes"]] == [None] * 3
    )


@pytest.mark.parametrize(
    ("process", "code", "where", "words"),
    [
        ("{classes: {outer: {}}}", "UNKNOWN_KEY", "process.classes.outer", "use one of"),
        (
            "{classes: {contour: {speed: 8}}}",
            "UNKNOWN_KEY",
            "process.classes.contour.speed",
            "travel_speed",
        ),
        (
            "{classes: {contour: {travel_speed: 8 mm}}}",
            "BAD_UNIT",
            "process.classes.contour.travel_speed",
            "speed",
        ),
        (
            "{classes: {contour: {travel_speed: 0}}}",
            "BAD_VALUE",
            "process.classes.contour.travel_speed",
            "more than 0",
        ),
        (
            "{classes: {fill: {schedule: 2.5}}}",
            "BAD_VALUE",
            "process.classes.fill.schedule",
            "whole number",
        ),
        (
            "{classes: {fill: {schedule: 0}}}",
            "BAD_VALUE",
            "process.classes.fill.schedule",
            "at least 1",
        ),
        (
            "{classes: [contour]}",
            "BAD_VALUE",
            "process.classes",
            "is not a mapping of bead classes",
        ),
        ("{classes: {wall: 5}}", "BAD_VALUE", "process.classes.wall", "is not a section"),
        ("{schedule: -1}", "BAD_VALUE", "process.schedule", "at least 1"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, process, code, where, words):
    (tmp_path / "part.step").write_text("")
    (tmp_path / "job.yaml").write_text(f"part: {{file: part.step}}\nprocess: {process}\n")
    with pytest.raises(InputError) as caught:
        jobs.read_job(str(tmp_path / "job.yaml"))
    assert (
        caught.value.code == code and where in caught.value.where and words in caught.value.message
    )


PHASES = """\
  start: {length: 5 mm, travel_speed: 3 mm/s}
  end: {length: 2.5 mm, travel_speed: 12 mm/s}
  classes: {contour: {travel_speed: 8 mm/s, start: {length: 0}, end: {length: 4 mm, travel_speed: 2 mm/s}}}
"""
TABLE = """\
cell: {machine: table-xyzac, setup: rotary-table, platform: 60 mm, platform_diameter: 200 mm}
program: {post: linuxcnc, schedule: {output: 3}}
"""


def split_beads(rows):
    """Return each bead's rows with the distance along it, from the rows only."""
    deposit = [row for row in rows if row["kind"] == "deposit"]
    starts = [k for k, row in enumerate(deposit) if row["point"] == "0"]
    for start, end in zip(starts, [*starts[1:], len(deposit)]):
        bead_rows = deposit[start:end]
        lengths = np.linalg.norm(
            np.diff(numbers(bead_rows, "x_mm", "y_mm", "z_mm"), axis=0), axis=1
        )
        yield bead_rows, np.r_[0.0, np.cumsum(lengths)]


def test_starts_and_ends_of_beads_have_speeds_of_their_own(workshop):
    plain, _, _ = planned(workshop, "  classes: {contour: {travel_speed: 8 mm/s}}\n")
    rows, report, text = planned(workshop, PHASES)
    assert report["status"] == "ok" and wire_line(report)["ok"] is False
    assert wire_line(report)["worst"] == pytest.approx(
        200.0, rel=0.02
    )  # ends of contours at 2 mm/s, while the wire feeds for 6
    (message,) = [issue["message"] for issue in report["issues"] if issue["code"] == "FEED_BALANCE"]
    assert (
        "contour 64, contour.end 16" in message
        and "fill.start 24" in message
        and "fill.end 96" in message
    )
    for (bead_rows, along), (plain_rows, plain_along) in zip(
        split_beads(rows), split_beads(plain), strict=True
    ):
        contour = bead_rows[0]["class"] == "contour"
        start_length, end_length, speed = (0.0, 4.0, 8.0) if contour else (5.0, 2.5, 6.0)
        assert abs(along[-1] - plain_along[-1]) < 0.01 and len(bead_rows) <= len(plain_rows) + 2
        for border in (start_length, along[-1] - end_length):
            assert np.abs(along - border).min() < 2e-3
        middle = 0.5 * (along[1:] + along[:-1])
        expected = np.where(
            middle < start_length,
            3.0,
            np.where(middle > along[-1] - end_length, 2.0 if contour else 12.0, speed),
        )
        assert np.abs(numbers(bead_rows[1:], "speed_mm_s")[:, 0] - expected).max() < 1e-6
    moves = re.findall(r"J P\[\d+\] (\d+)msec (FINE|CNT)", text)
    assert moves  # no stop within a bead: as many stops as without phases
    assert text.count("FINE") == planned(workshop, "")[2].count("FINE")


def test_schedules_change_within_a_bead_without_a_stop(workshop):
    options = PHASES + "  schedule: 9\n"
    for speed, schedule in ((3, 4), (2, 5)):
        options = options.replace(
            f"speed: {speed} mm/s}}", f"speed: {speed} mm/s, schedule: {schedule}}}"
        )
    job = JOB.replace("CLASSES\n", options)
    job = job[: job.index("cell:")] + job[job.index("process:") : job.index("program:")] + TABLE
    Part.makeBox(SIDE, SIDE, HIGH).exportStep(str(workshop.folder / "bar.step"))
    (workshop.folder / "bar.yaml").write_text(job)
    command = workshop.run("plan", "bar.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    lines = (workshop.folder / "out" / "program" / "bar.ngc").read_text().splitlines()
    beads = list(split_beads(rows))
    on, off = (
        [k for k, line in enumerate(lines) if line.startswith(word)]
        for word in ("M64 P0", "M65 P0")
    )
    assert len(on) == len(off) == len(beads)
    for (bead_rows, along), start, end in zip(beads, on, off, strict=True):
        contour = bead_rows[0]["class"] == "contour"
        inside = lines[start + 1 : end]
        assert not any(line.startswith(("M68", "G4", "G61", "M6 ")) for line in inside)
        schedule_lines = [line for line in inside if line.startswith("M67")]
        ahead = [line for line in lines[:start] if line.startswith("M68")][-1]
        assert (ahead, schedule_lines) == (
            ("M68 E2 Q9", ["M67 E2 Q5"]) if contour else ("M68 E2 Q4", ["M67 E2 Q9"])
        )
        moves = [
            line for line in inside[: inside.index(schedule_lines[0])] if re.search(r"\bX", line)
        ]
        border = along[-1] - 4.0 if contour else 5.0
        assert abs(along[len(moves)] - border) < 2e-3  # the next move begins there


def test_points_put_in_look_where_the_machine_looks_there(workshop):
    """Tools tilt between coarse pieces of a class; the joint frames and the trunnion of a table
    drive the text."""
    Part.makeCylinder(12.0, 40.0).Faces[0].exportBrep(str(workshop.folder / "tube.brep"))
    Part.makeBox(40, 40, 10, FreeCAD.Vector(-20, -20, -10)).exportStep(
        str(workshop.folder / "block.step")
    )
    (workshop.folder / "bar.yaml").write_text(
        "part: {file: tube.brep}\nsubstrate: {file: block.step}\n"
        "strategy: {kind: surface, layer_height: 10 mm, chord_error: 0.5 mm}\nbuild_direction: {tilt: 30 deg}\n"
        "process: {start: {length: 2 mm, travel_speed: 5 mm/s}, end: {length: 3 mm, travel_speed: 8 mm/s}}\n"
        "cell: {machine: table-xyzac, setup: rotary-table, platform: 60 mm}\nprogram: {post: siemens}\n"
    )
    command = workshop.run("plan", "bar.yaml", "-o", "out", "--no-page")
    assert command.status == 0 and (workshop.folder / "out" / "program" / "BAR.MPF").is_file(), (
        command.err
    )
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    tool, tilt = (
        numbers(rows, "tx", "ty", "tz"),
        numbers(rows, "a_deg")[:, 0],
    )  # the trunnion of the table
    assert len(rows) > 20 and np.abs(np.degrees(np.arccos(tool[:, 2])) - np.abs(tilt)).max() < 1e-5


@pytest.mark.parametrize(
    ("more", "status", "words"),
    [
        ("  schedule: 2\n  start: {length: 5 mm, schedule: 3}\n", 2, "error[SCHEDULE]"),
        ("  end: {length: 30 mm, travel_speed: 3 mm/s}\n", 2, "error[PHASE_LENGTH]"),
        ("  start: {length: 5 mm, travel_speed: 0}\n", 2, "process.start.travel_speed"),
        ("  classes: {fill: {start: {long: 5 mm}}}\n", 2, "process.classes.fill.start.long"),
        ("  classes: {fill: {end: 5 mm}}\n", 2, "process.classes.fill.end"),
        (
            "  bead_model: csw\n  start: {length: 5 mm, travel_speed: 5 mm/s}\n",
            2,
            "process.start.travel_speed",
        ),
    ],
)
def test_phases_that_cannot_be(workshop, more, status, words):
    Part.makeBox(SIDE, SIDE, HIGH).exportStep(str(workshop.folder / "bar.step"))
    (workshop.folder / "bar.yaml").write_text(JOB.replace("CLASSES\n", more))
    command = workshop.run("plan", "bar.yaml", "-o", "out", "--no-page")
    assert command.status == status and words in command.err, command.err
    assert (
        not list((workshop.folder / "out").glob("program/*"))
        if (workshop.folder / "out").exists()
        else True
    )


WEAVE = "  classes:\n    first_layer: {weave: 0}\n    contour: {weave: 3}\n  weave: 7\n"


def test_beads_are_woven_as_their_class_says(workshop):
    """The text has the weaves of the job: first layers straight, contours by 3, lines by 7."""
    rows, report, text = planned(workshop, WEAVE, "motion: cartesian, ")
    weaves = re.findall(
        r"Weave Sine\[(\d+)\] ;\r\n((?: *\d+:L P\[\d+\][^\n]*\n)+) *\d+:  Weave End ;", text
    )
    beads = {}
    for row in rows:
        if row["kind"] == "deposit":
            beads.setdefault((int(row["layer"]), int(row["bead"])), row["class"])
    expected = [
        {"contour": "3", "fill": "7"}[name] for name in beads.values() if name != "first_layer"
    ]
    assert [number for number, _ in weaves] == expected and set(expected) == {"3", "7"}
    straight = re.sub(r"Weave Sine.*?Weave End", "", text, flags=re.DOTALL)
    assert (
        len(re.findall(r"DO\[1\]=ON ;\r\n *\d+:L", straight))
        == list(beads.values()).count("first_layer")
        > 0
    )
    assert {row["class"]: row["weave"] for row in report["classes"]} == {
        "first_layer": None,
        "contour": 3,
        "fill": 7,
    }


def test_a_weave_that_cannot_be_told_is_named_before_planning(workshop):
    planned(workshop, "")
    job = (workshop.folder / "bar.yaml").read_text()
    (workshop.folder / "joint.yaml").write_text(job.replace("process:\n", "process:\n  weave: 2\n"))
    command = workshop.run("plan", "joint.yaml", "-o", "joint")
    assert (
        command.status == 2
        and "error[WEAVE]" in command.err
        and "program.motion to cartesian" in command.err
    )
    assert not list((workshop.folder / "joint").glob("program/*"))


RAMPED = """\
  wire: {feed_mode: proportional, feed: 30 mm/s}
  start: {length: 4 mm, travel_speed: 3 mm/s, ramp: 5 mm}
  end: {length: 2 mm, travel_speed: 9 mm/s, ramp: 3 mm}
"""


def test_speed_and_feed_of_a_ramp_are_in_the_text(workshop):
    """A text of LinuxCNC has the speed of every move, and before it the wire speed; both rise along
    the ramp in small steps from the values of the start to those of the bead, and then change to
    those of the end."""
    job = JOB.replace("CLASSES\n", RAMPED)
    job = (
        job[: job.index("cell:")]
        + job[job.index("process:") : job.index("program:")]
        + (
            "cell: {machine: table-xyzac, setup: rotary-table, platform: 30 mm}\n"
            "program: {post: linuxcnc, nc: {feed: path, wire_output: 2, wire_gain: 1}}\n"
        )
    )
    Part.makeBox(SIDE, SIDE, HIGH).exportStep(str(workshop.folder / "bar.step"))
    (workshop.folder / "bar.yaml").write_text(job)
    command = workshop.run("plan", "bar.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    lines = (workshop.folder / "out" / "program" / "bar.ngc").read_text().splitlines()
    position, wire, speed, bead_moves, beads = np.zeros(3), None, 0.0, [], []
    for line in lines:
        words = dict(re.findall(r"\b([XYZFQ])(-?[\d.]+)", line))
        if line.startswith(("M67 E1", "M68 E1")):
            wire = float(words["Q"])
        elif line.startswith("M64 P0"):
            bead_moves = []
        elif line.startswith("M65 P0"):
            beads.append(np.array(bead_moves))
        elif {"X", "Y", "Z"} & set(words):
            target = np.array([float(words.get(axis, old)) for axis, old in zip("XYZ", position)])
            speed = float(words.get("F", speed))
            bead_moves.append((np.linalg.norm(target - position), speed / 60.0, wire))
            position = target
    assert len(beads) > 10
    for moves in beads:
        length, speeds, wires = moves.T
        end = np.cumsum(length)
        middle = end - 0.5 * length
        total = end[-1]
        expected = np.interp(
            middle, [0.0, 4.0, 9.0, total - 5.0, total - 2.0, total], [3.0, 3.0, 6.0, 6.0, 9.0, 9.0]
        )
        assert np.abs(speeds - expected).max() <= 0.1 * 9.0 / 2.0 + 0.01
        assert np.abs(np.diff(speeds)).max() <= 0.1 * 9.0 + 0.01 and {3.0, 6.0, 9.0} <= set(
            np.round(speeds, 2)
        )
        # the wire feeds 30 mm/s at 6 mm/s of the torch, in proportion everywhere; the output is in
        # m/min
        np.testing.assert_allclose(wires / 0.06 / speeds, 30.0 / 6.0, rtol=1e-3)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (
            "  end: {length: 8 mm, travel_speed: 3 mm/s, ramp: 21 mm}\n",
            [
                "error[PHASE_LENGTH]",
                "29 mm with their ramps",
                "is 20 mm long",
                "shorten start and end of the class",
            ],
        ),
        (
            "  start: {length: 5 mm, ramp: 5 mm}\n",
            ["error[BAD_VALUE]", "process.start.ramp", "is not set; set travel_speed"],
        ),
        (
            "  classes: {fill: {end: {ramp: 5 mm}}}\n",
            ["error[BAD_VALUE]", "process.classes.fill.end.ramp", "set travel_speed"],
        ),
        (RAMPED, ["error[NO_WIRE_OUTPUT]"]),
    ],
)
def test_ramps_that_cannot_be(workshop, more, words):
    Part.makeBox(SIDE, SIDE, HIGH).exportStep(str(workshop.folder / "bar.step"))
    (workshop.folder / "bar.yaml").write_text(JOB.replace("CLASSES\n", more))
    command = workshop.run("plan", "bar.yaml", "-o", "out", "--no-page")
    assert command.status in (2, 3) and all(word in command.err for word in words), command.err
