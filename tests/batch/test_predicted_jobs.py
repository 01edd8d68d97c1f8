# SPDX-License-Identifier: LGPL-2.1-or-later
"""`process.machining_allowance` in a job adds the predicted deposit to report, page and preflight,
and jobs without it stay unchanged; also for the blades of the thruster."""

import csv
import json
import math

import Part
import pytest

BLOCK = """\
version: 1
name: block
part: {file: block.step}
strategy: {kind: solid, layer_height: 2 mm, bead_spacing: 4 mm, margin: %(margin)s mm, chord_error: 0.1 mm}
process: {travel_speed: 8 mm/s, wire: {diameter: 1.6 mm}%(more)s}
"""
KEY = ", machining_allowance: 0 mm"


@pytest.fixture
def block(workshop):
    Part.makeBox(50.0, 30.0, 14.0).exportStep(str(workshop.folder / "block.step"))

    def planned(folder, **what):
        workshop.write_job(BLOCK % {"margin": 2, "more": KEY, **what})
        command = workshop.run("plan", "cup.yaml", "-o", folder)
        assert command.status == 0, command.err
        out = workshop.folder / folder
        return json.loads((out / "report.json").read_text()), out, command

    return planned


def fed_by_hand(out, wire_mm_s, diameter):
    """Return the mm3 of wire of the rows that deposit: its section times its feed and their
    time."""
    with open(out / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    seconds = 0.0
    for waypoint, following in zip(rows, rows[1:], strict=False):
        if (waypoint["layer"], waypoint["bead"]) == (following["layer"], following["bead"]):
            step = math.dist(
                *([float(row[f"{axis}_mm"]) for axis in "xyz"] for row in (waypoint, following))
            )
            seconds += step / float(following["speed_mm_s"])
    return 0.25 * math.pi * diameter**2 * wire_mm_s * seconds


def test_a_block_against_its_predicted_deposit(block):
    """The block is inside the deposit on all sides, with 2 mm to machine. Its top is as high as the
    last layer, where beads sink at corners of contours, and the report says so."""
    report, out, command = block("out")
    shape_report = report["predicted_shape"]
    feed = (
        4.0 * 2.0 * 8.0 / (0.25 * math.pi * 1.6**2)
    )  # the volume of beads that are 4 mm apart in layers of 2 mm
    assert abs(1000.0 * shape_report["laid_cm3"] / fed_by_hand(out, feed, 1.6) - 1.0) < 1e-6
    assert abs(shape_report["laid_cm3"] / report["totals"]["fed_cm3"] - 1.0) < 1e-6
    assert (
        shape_report["allowance_mm"] == 0.0
        and shape_report["places"] > 10_000
        and len(shape_report["layers"]) == report["counts"]["layers"]
    )
    assert 0.0 < shape_report["short"] < 0.03 and -1.5 < shape_report["beyond_mm"]["min"] < 0.0
    assert abs(shape_report["worst"]["place"][2] - 14.0) < 1e-6 and "ALLOWANCE" in command.err
    assert 0.8 < shape_report["beyond_mm"]["mean"] < 2.5
    rows = {row["promise"]: row for row in report["preflight"]}
    inside = rows["The predicted deposit covers the part and its machining allowance"]
    assert (
        inside["ok"] is False
        and inside["worst"] == shape_report["beyond_mm"]["min"]
        and inside["bound"] == 0.0
    )
    assert rows["The predicted deposit has the volume of the wire fed"]["ok"]
    assert "Predicted deposit against the part" in (out / "report.html").read_text(encoding="utf-8")


def test_without_a_margin_more_of_the_block_sticks_out(block):
    report, _, _ = block("out", margin=0)
    assert report["predicted_shape"]["short"] > 0.03
    allowance_issue = next(issue for issue in report["issues"] if issue["code"] == "ALLOWANCE")
    assert (
        allowance_issue["level"] == "warning"
        and allowance_issue["layer"] is not None
        and "strategy.margin" in allowance_issue["message"]
    )
    worst = report["predicted_shape"]["worst"]
    x, y, z = worst["place"]
    # at an edge of the block, because beads end half of their width inside of it and are round
    assert min(x, 50.0 - x) < 2.0 or min(y, 30.0 - y) < 2.0 or z > 12.0
    assert report["predicted_shape"]["beyond_mm"]["min"] < 0.0 and report["status"] == "ok"
    broken = [row for row in report["preflight"] if row["ok"] is False]
    assert any("predicted deposit covers" in row["promise"] for row in broken)


def test_jobs_without_the_key_are_as_they_were(block):
    report, out, _ = block("with")
    plain, second, command = block("without", more="")
    assert plain["predicted_shape"] is None and "ALLOWANCE" not in command.err
    assert not any("redicted" in row["promise"] for row in plain["preflight"])
    assert (out / "waypoints.csv").read_bytes() == (second / "waypoints.csv").read_bytes()
    assert [row for row in report["preflight"] if "redicted" not in row["promise"]] == (
        plain["preflight"]
    )


def test_curves_have_no_part_to_lie_in(workshop):
    (workshop.folder / "line.csv").write_text("x,y,z\n0,0,0\n50,0,0\n50,30,0\n")
    workshop.write_job(
        "version: 1\nname: line\npart: {file: line.csv}\nstrategy: {kind: curves, layer_height: 2 mm}\n"
        "process: {machining_allowance: 0 mm}\n"
    )
    command = workshop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert command.status == 0 and "warning[NO_PREDICTION]" in command.err


@pytest.mark.long
def test_the_blades_of_the_thruster_are_told_not_to_be_inside(workshop, root):
    """In layers of 10 mm, with beads and wire as shipped, the wire is less than the layers need:
    they come out lower, and the report states the height. The blades are not inside the deposit,
    and the report says where."""
    text = (root / "resources" / "examples" / "thruster" / "thruster.yaml").read_text(
        encoding="utf-8"
    )
    text = text[: text.index("cell:")].replace(
        "file: ", f"file: {root}/resources/examples/thruster/"
    )
    text = text.replace("  direction:", "  machining_allowance: 0 mm\n  direction:")
    text = text.replace("layer_height: 2.5 mm", "layer_height: 10 mm").replace(
        "chord_error: 0.05", "chord_error: 0.2"
    )
    workshop.write_job(text)
    command = workshop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text())
    shape_report = report["predicted_shape"]
    assert abs(shape_report["laid_cm3"] / report["totals"]["fed_cm3"] - 1.0) < 1e-6
    issues = {issue["code"]: issue for issue in report["issues"]}
    assert "mm below where" in issues["LAYER_DRIFT"]["message"]
    assert issues["ALLOWANCE"]["layer"] is not None and shape_report["outside"] > 0.3
