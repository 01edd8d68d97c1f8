# SPDX-License-Identifier: LGPL-2.1-or-later
"""Classes of beads from a job file to its program: which bead is of which class told by where it lies on the part alone, and
every class laid as it is asked for."""

import csv
import json
import re

import numpy as np
import Part
import pytest

from freecad_am.batch import job as jobs
from freecad_am.core.issues import InputError

# a bar of which the outermost beads are contours and lines fill the rest
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


def planned(workshop, more):
    if not (workshop.folder / "bar.step").exists():
        Part.makeBox(SIDE, SIDE, HIGH).exportStep(str(workshop.folder / "bar.step"))
    (workshop.folder / "bar.yaml").write_text(JOB.replace("CLASSES\n", more))
    done = workshop.run("plan", "bar.yaml", "-o", "out", "--no-page")
    assert done.status == 0, done.stderr
    out = workshop.folder / "out"
    with open(out / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    return rows, json.loads((out / "report.json").read_text()), (out / "program" / "BAR.LS").read_bytes().decode()


def numbers(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def test_classes_of_a_filled_bar(workshop):
    rows, report, text = planned(workshop, CLASSES)
    deposit = [row for row in rows if row["kind"] == "deposit"]
    assert list(rows[0])[-1] == "class" and all(row["class"] for row in rows)
    # by geometry alone: the lowest plane; beads that run half a width inside of the border; the rest
    place, layer = numbers(deposit, "x_mm", "y_mm", "z_mm"), numbers(deposit, "layer")[:, 0]
    bead = numbers(deposit, "bead")[:, 0]
    edge = np.minimum(place[:, :2], SIDE - place[:, :2]).min(axis=1)
    assert np.ptp(np.bincount(layer.astype(int), place[:, 2]) / np.bincount(layer.astype(int)) - LAYER * np.arange(3)) < 1e-9
    for key in sorted(set(zip(layer.tolist(), bead.tolist()))):
        mine = (layer == key[0]) & (bead == key[1])
        along = np.abs(edge[mine] - 0.5 * WIDTH).max() < 0.02
        wanted = "first_layer" if key[0] == 0 else "contour" if along else "fill"
        assert {deposit[k]["class"] for k in np.flatnonzero(mine)} == {wanted}
    name = np.array([row["class"] for row in deposit])
    assert set(name) == {"first_layer", "contour", "fill"}
    speed = numbers(deposit, "speed_mm_s")[:, 0]
    for one, wanted in (("first_layer", 4.0), ("contour", 8.0), ("fill", 6.0)):
        assert np.abs(speed[name == one] - wanted).max() < 1e-6
    # lead is towards the way of the bead, tilt across it; both in the middle of its straight sides
    tool, build = numbers(deposit, "tx", "ty", "tz"), numbers(deposit, "bx", "by", "bz")
    angle = np.degrees(np.arccos(np.clip((tool * build).sum(axis=1), -1.0, 1.0)))
    leant = np.degrees(np.arccos(np.cos(np.radians(10.0)) * np.cos(np.radians(5.0))))
    assert np.abs(angle[name != "contour"]).max() < 1e-6 and abs(np.median(angle[name == "contour"]) - leant) < 1e-4
    _figures(report, rows)
    _program(text, deposit)


def _figures(report, rows):
    """Lengths and times of classes, by the rows alone; the total of the job has the lead times of classes."""
    place = numbers(rows, "x_mm", "y_mm", "z_mm")
    way = np.r_[0.0, np.linalg.norm(np.diff(place, axis=0), axis=1)]
    moves = np.array([row["kind"] == "deposit" and row["point"] != "0" for row in rows])
    speed = np.array([float(row["speed_mm_s"] or "inf") for row in rows])
    assert [row["class"] for row in report["classes"]] == ["first_layer", "contour", "fill"]
    for told in report["classes"]:
        mine = moves & np.array([row["class"] == told["class"] for row in rows])
        assert told["length_mm"] == pytest.approx(way[mine].sum(), abs=1e-3)
        assert told["deposit_s"] == pytest.approx((way[mine] / speed[mine]).sum(), abs=1e-3)
        begins = {(row["layer"], row["bead"]) for row in rows if row["kind"] == "deposit" and row["class"] == told["class"]}
        assert told["beads"] == len(begins)
    assert [row["schedule"] for row in report["classes"]] == [1, 3, 9]
    count = {row["class"]: row["beads"] for row in report["classes"]}
    assert report["totals"]["wait_s"] == pytest.approx(0.8 * count["contour"] + 1.5 * count["fill"], abs=1e-9)


def _program(text, deposit):
    """What is told before each bead, and how long the robot stands at its ends."""
    begins = [row["class"] for row in deposit if row["point"] == "0"]
    told = re.findall(r"GO\[5\]=(\d+) ;\r\n *\d+:  DO\[1\]=ON ;\r\n *\d+:(?:  WAIT +([.\d]+)\(sec\))?", text)
    ends = re.findall(r":(?:  WAIT +([.\d]+)\(sec\))? ?;?\r?\n? *\d*:? *DO\[1\]=OFF", text)
    assert [int(number) for number, _ in told] == [{"first_layer": 1, "contour": 3, "fill": 9}[name] for name in begins]
    assert [wait for _, wait in told] == [".80" if name == "contour" else "" for name in begins]
    assert len(ends) == len(begins) and ends == ["1.50" if name == "fill" else "" for name in begins]


def test_a_job_without_classes_keeps_its_program(workshop):
    _, plain, before = planned(workshop, "")
    _, told, after = planned(workshop, "  classes: {wall: {travel_speed: 20 mm/s}, closing: {lead: 5 deg}}\n")
    assert before == after and "GO[" not in before
    assert plain["classes"] == told["classes"] and [row["schedule"] for row in plain["classes"]] == [None] * 3


@pytest.mark.parametrize(("process", "code", "where", "words"), [
    ("{classes: {outer: {}}}", "UNKNOWN_KEY", "process.classes.outer", "known here"),
    ("{classes: {contour: {speed: 8}}}", "UNKNOWN_KEY", "process.classes.contour.speed", "travel_speed"),
    ("{classes: {contour: {travel_speed: 8 mm}}}", "BAD_UNIT", "process.classes.contour.travel_speed", "speed"),
    ("{classes: {contour: {travel_speed: 0}}}", "BAD_VALUE", "process.classes.contour.travel_speed", "more than 0"),
    ("{classes: {fill: {schedule: 2.5}}}", "BAD_VALUE", "process.classes.fill.schedule", "whole number"),
    ("{classes: {fill: {schedule: 0}}}", "BAD_VALUE", "process.classes.fill.schedule", "at least 1"),
    ("{classes: [contour]}", "BAD_VALUE", "process.classes", "write classes below it"),
    ("{classes: {wall: 5}}", "BAD_VALUE", "process.classes.wall", "is not a section"),
    ("{schedule: -1}", "BAD_VALUE", "process.schedule", "at least 1"),
])
def test_what_is_wrong_is_named(tmp_path, process, code, where, words):
    (tmp_path / "part.step").write_text("")
    (tmp_path / "job.yaml").write_text(f"part: {{file: part.step}}\nprocess: {process}\n")
    with pytest.raises(InputError) as caught:
        jobs.read_job(str(tmp_path / "job.yaml"))
    assert caught.value.code == code and where in caught.value.where and words in caught.value.message
