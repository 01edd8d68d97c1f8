# SPDX-License-Identifier: LGPL-2.1-or-later
"""`process.machining_allowance` in a job: what its deposit is predicted to be, in report, page and preflight; nothing of it
in jobs without; the blades of the thruster."""

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
        done = workshop.run("plan", "cup.yaml", "-o", folder)
        assert done.status == 0, done.err
        out = workshop.folder / folder
        return json.loads((out / "report.json").read_text()), out, done

    return planned


def fed_by_hand(out, wire_mm_s, diameter):
    """mm3 of the wire, of the rows that deposit: its section times its feed and their time."""
    with open(out / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    seconds = 0.0
    for one, other in zip(rows, rows[1:], strict=False):
        if (one["layer"], one["bead"]) == (other["layer"], other["bead"]):
            step = math.dist(
                *([float(row[f"{axis}_mm"]) for axis in "xyz"] for row in (one, other))
            )
            seconds += step / float(other["speed_mm_s"])
    return 0.25 * math.pi * diameter**2 * wire_mm_s * seconds


def test_a_block_against_its_predicted_deposit(block):
    """Inside on all sides, with 2 mm to machine; on its top, which is as high as the last layer, beads sink at corners of
    contours, and that is told."""
    report, out, done = block("out")
    found = report["predicted_shape"]
    feed = (
        4.0 * 2.0 * 8.0 / (0.25 * math.pi * 1.6**2)
    )  # what beads take that lie 4 mm apart in layers of 2 mm
    assert abs(1000.0 * found["laid_cm3"] / fed_by_hand(out, feed, 1.6) - 1.0) < 1e-6
    assert abs(found["laid_cm3"] / report["totals"]["fed_cm3"] - 1.0) < 1e-6
    assert (
        found["allowance_mm"] == 0.0
        and found["places"] > 10_000
        and len(found["layers"]) == report["counts"]["layers"]
    )
    assert 0.0 < found["short"] < 0.03 and -1.5 < found["beyond_mm"]["min"] < 0.0
    assert abs(found["worst"]["place"][2] - 14.0) < 1e-6 and "ALLOWANCE" in done.err
    assert 0.8 < found["beyond_mm"]["mean"] < 2.5
    rows = {row["promise"]: row for row in report["preflight"]}
    inside = rows["The predicted deposit covers the part and its machining allowance"]
    assert (
        inside["ok"] is False
        and inside["worst"] == found["beyond_mm"]["min"]
        and inside["bound"] == 0.0
    )
    assert rows["The predicted deposit has the volume of the wire fed"]["ok"]
    assert "Predicted deposit against the part" in (out / "report.html").read_text(encoding="utf-8")


def test_without_a_margin_more_of_the_block_sticks_out(block):
    report, _, _ = block("out", margin=0)
    assert report["predicted_shape"]["short"] > 0.03
    told = next(issue for issue in report["issues"] if issue["code"] == "ALLOWANCE")
    assert (
        told["level"] == "warning"
        and told["layer"] is not None
        and "strategy.margin" in told["message"]
    )
    worst = report["predicted_shape"]["worst"]
    x, y, z = worst["place"]
    # at an edge of the block: beads end half of their width inside of it, and round
    assert min(x, 50.0 - x) < 2.0 or min(y, 30.0 - y) < 2.0 or z > 12.0
    assert report["predicted_shape"]["beyond_mm"]["min"] < 0.0 and report["status"] == "ok"
    broken = [row for row in report["preflight"] if row["ok"] is False]
    assert any("predicted deposit covers" in row["promise"] for row in broken)


def test_jobs_without_the_key_are_as_they_were(block):
    report, out, _ = block("with")
    plain, other, done = block("without", more="")
    assert plain["predicted_shape"] is None and "ALLOWANCE" not in done.err
    assert not any("redicted" in row["promise"] for row in plain["preflight"])
    assert (out / "waypoints.csv").read_bytes() == (other / "waypoints.csv").read_bytes()
    assert [row for row in report["preflight"] if "redicted" not in row["promise"]] == (
        plain["preflight"]
    )


def test_curves_have_no_part_to_lie_in(workshop):
    (workshop.folder / "line.csv").write_text("x,y,z\n0,0,0\n50,0,0\n50,30,0\n")
    workshop.write_job(
        "version: 1\nname: line\npart: {file: line.csv}\nstrategy: {kind: curves, layer_height: 2 mm}\n"
        "process: {machining_allowance: 0 mm}\n"
    )
    done = workshop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert done.status == 0 and "warning[NO_PREDICTION]" in done.err


@pytest.mark.long
def test_the_blades_of_the_thruster_are_told_not_to_be_inside(workshop, root):
    """In layers of 10 mm, with beads and wire as shipped, which feed less than layers take: these come out lower, and with
    what height is told; the blades are not inside, and where is told."""
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
    done = workshop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert done.status == 0, done.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text())
    found = report["predicted_shape"]
    assert abs(found["laid_cm3"] / report["totals"]["fed_cm3"] - 1.0) < 1e-6
    issues = {issue["code"]: issue for issue in report["issues"]}
    assert "mm below where" in issues["LAYER_DRIFT"]["message"]
    assert issues["ALLOWANCE"]["layer"] is not None and found["outside"] > 0.3
