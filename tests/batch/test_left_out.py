# SPDX-License-Identifier: LGPL-2.1-or-later
"""report.json states which regions of its part a job does not deposit, or the job is rejected."""

import csv
import json
import math
import re

import FreeCAD
import numpy as np
import Part
import pytest
from scipy.integrate import quad

JOB = """\
version: 1
name: part
part: {{file: part.step{faces}}}
strategy: {{kind: {kind}, layer_height: 5 mm, chord_error: 0.1 mm}}
"""


def bracket():
    bend = Part.makeCylinder(15, 50, FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 90).cut(
        Part.makeCylinder(10, 50)
    )
    plates = (
        Part.makeBox(60, 5, 50, FreeCAD.Vector(-60, 10, 0)),
        Part.makeBox(5, 60, 50, FreeCAD.Vector(10, -60, 0)),
    )
    return Part.Compound([plates[0], bend, plates[1]])


@pytest.fixture
def planned(workshop):
    """Plan a part and return how the command ended and its report, or None."""

    def run(shape, kind="revolution", faces=""):
        shape.exportStep(str(workshop.folder / "part.step"))
        job = workshop.write_job(JOB.format(kind=kind, faces=faces))
        command = workshop.run("plan", job.name, "-o", "out", "--no-page")
        report = workshop.folder / "out" / "part" / "report.json"
        report = report if report.exists() else workshop.folder / "out" / "report.json"
        return command, json.loads(report.read_text(encoding="utf-8")) if report.exists() else None

    return run


def issues_with_code(report, code):
    return [issue for issue in report["issues"] if issue["code"] == code]


def test_a_solid_that_becomes_a_skin_is_told(planned):
    command, report = planned(Part.makeCylinder(30, 40))
    assert command.status == 0
    (issue,) = issues_with_code(report, "NOT_DEPOSITED")
    solid_volume, skin_volume = (math.pi * area * 40 / 1000 for area in (900, 900 - 22**2))
    deposit_figures = report["deposit"]
    assert (
        deposit_figures["part_cm3"] == pytest.approx(solid_volume, rel=1e-6)
        and deposit_figures["estimate"]
    )
    assert deposit_figures["deposited_cm3"] == pytest.approx(skin_volume, rel=0.03)
    assert (
        deposit_figures["left_out_cm3"] == pytest.approx(solid_volume - skin_volume, rel=0.03)
        and deposit_figures["beside_cm3"] == 0.0
    )
    assert (
        issue["level"] == "warning"
        and "113 cm3" in issue["message"]
        and "one bead, 8 mm wide" in issue["message"]
    )


def test_a_bracket_is_refused_as_a_part_of_revolution_and_told_of_as_solids_on_its_bend(planned):
    command, report = planned(bracket())
    assert (
        command.status == 2
        and report is None
        and "error[NOT_OF_REVOLUTION]" in command.err
        and "Solid2" in command.err
    )
    command, report = planned(bracket(), "developable")
    assert command.status == 0
    issue, within = issues_with_code(report, "NOT_DEPOSITED")
    bend = math.pi * (15**2 - 10**2) / 4 * 50 / 1000
    deposit_figures = report["deposit"]
    assert deposit_figures["part_cm3"] == pytest.approx(30.0 + bend, rel=1e-3) and deposit_figures[
        "solids_left_out"
    ] == ["part solid 2"]
    assert deposit_figures["deposited_cm3"] == pytest.approx(
        deposit_figures["part_cm3"] - deposit_figures["left_out_cm3"]
    )
    # the region of the plates inside the bend's outer radius, where no beads are, and the corners
    under = 2.0 * 50.0 * quad(lambda y: math.sqrt(15.0**2 - y * y), 10.0, 15.0)[0] / 1000.0
    assert bend + under < deposit_figures["left_out_cm3"] < bend + under + 0.03 * 30.0
    said = float(re.search(r"about ([\d.]+) of the 30 cm3", within["message"])[1])
    assert said == pytest.approx(deposit_figures["left_out_cm3"] - bend, abs=0.01)
    assert "the inside of a hub is not filled" in within["message"]
    assert "solid 2" in issue["message"] and "34.9" in issue["message"]
    # beads of 8 mm in plates of 5 mm overlap, so the deposit is far more than the covered volume
    (twice,) = issues_with_code(report, "DEPOSITED_TWICE")
    laid, covered = (
        report["totals"]["volume_cm3"],
        deposit_figures["deposited_cm3"] + deposit_figures["beside_cm3"],
    )
    assert laid > 1.4 * covered and deposit_figures["twice_cm3"] == pytest.approx(
        laid - covered, rel=0.06
    )
    assert (
        twice["level"] == "warning"
        and f"{deposit_figures['twice_cm3']:.3g} cm3" in twice["message"]
    )


def test_how_much_of_a_first_layer_lies_beside_the_platform(workshop):
    """A block of 60 mm on a disc of 50 mm: the report states the length of bead whose written
    points are beyond its edge."""
    Part.makeBox(60, 60, 8, FreeCAD.Vector(-30, -30, 0)).exportStep(
        str(workshop.folder / "cup.step")
    )
    text = workshop.text.replace("strategy:\n", "strategy:\n  kind: solid\n  bead_spacing: 6 mm\n")
    text = text.replace("diameter: 100 mm", "diameter: 50 mm").replace(
        "process:\n", "process:\n  bead_width: 6 mm\n"
    )
    workshop.write_job(text)
    command = workshop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text())
    (issue,) = [candidate for candidate in report["issues"] if candidate["code"] == "OVER_PLATFORM"]
    match = re.match(
        r"([\d.]+) mm of the first layer overhang the platform edge, by up to ([\d.]+) mm",
        issue["message"],
    )
    with open(workshop.folder / "out" / "waypoints.csv", newline="") as stream:
        rows = [
            row for row in csv.DictReader(stream) if row["layer"] == "0" and row["kind"] != "rapid"
        ]
    points = np.array([[float(row[axis]) for axis in ("x_mm", "y_mm")] for row in rows])
    same = np.array([row["bead"] == following["bead"] for row, following in zip(rows, rows[1:])])
    share = (np.arange(2000) + 0.5) / 2000
    along = points[:-1, None] + share[:, None] * (points[1:] - points[:-1])[:, None]
    off = np.linalg.norm(along, axis=2) - 25.0
    length = np.linalg.norm(np.diff(points, axis=0), axis=1)
    beside = (((off > 3.0).mean(axis=1) * length)[same]).sum()
    assert beside > 50.0 and float(match[1]) == pytest.approx(beside, rel=0.02)
    assert (
        off[same].max() - 1.0 < float(match[2]) <= off[same].max() + 0.01
    )  # in the middle of a segment of the bead
    assert (
        "OVER_PLATFORM" in command.err and "cell.mount" not in issue["message"]
    )  # it would be beyond the edge there too
    (promise,) = [
        entry
        for entry in report["preflight"]
        if entry["promise"].startswith("Every bead is supported")
    ]
    assert promise["ok"] is False and promise["place"]["layer"] == 0


def test_a_part_beside_the_middle_of_the_platform_is_put_there_by_the_remedy_that_is_told(workshop):
    Part.makeBox(30, 30, 8, FreeCAD.Vector(20, 10, 0)).exportStep(str(workshop.folder / "cup.step"))
    text = workshop.text.replace("strategy:\n", "strategy:\n  kind: solid\n  bead_spacing: 6 mm\n")
    text = text.replace("diameter: 100 mm", "diameter: 60 mm").replace(
        "process:\n", "process:\n  bead_width: 6 mm\n"
    )
    for setting, mended in (
        (text, False),
        (text.replace("cell:\n", "cell:\n  mount: feature\n"), True),
    ):
        workshop.write_job(setting)
        command = workshop.run("plan", "cup.yaml", "-o", "out", "--no-page")
        report = json.loads((workshop.folder / "out" / "report.json").read_text())
        messages = [
            issue["message"] for issue in report["issues"] if issue["code"] == "OVER_PLATFORM"
        ]
        assert bool(messages) != mended and all(
            "centre the part by cell.mount: feature" in message for message in messages
        )
        assert command.status == 0, command.err
