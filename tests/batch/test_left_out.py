# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a job does not deposit of its part stands in report.json, or the job is refused."""

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
    """Plan a part; how the command ended, and its report or None."""

    def run(shape, kind="revolution", faces=""):
        shape.exportStep(str(workshop.folder / "part.step"))
        job = workshop.write_job(JOB.format(kind=kind, faces=faces))
        done = workshop.run("plan", job.name, "-o", "out", "--no-page")
        report = workshop.folder / "out" / "part" / "report.json"
        report = report if report.exists() else workshop.folder / "out" / "report.json"
        return done, json.loads(report.read_text(encoding="utf-8")) if report.exists() else None

    return run


def of_code(report, code):
    return [issue for issue in report["issues"] if issue["code"] == code]


def test_a_solid_that_becomes_a_skin_is_told(planned):
    done, report = planned(Part.makeCylinder(30, 40))
    assert done.status == 0
    (issue,) = of_code(report, "NOT_DEPOSITED")
    whole, skin = (math.pi * area * 40 / 1000 for area in (900, 900 - 22**2))
    found = report["deposit"]
    assert found["part_cm3"] == pytest.approx(whole, rel=1e-6) and found["estimate"]
    assert found["deposited_cm3"] == pytest.approx(skin, rel=0.03)
    assert (
        found["left_out_cm3"] == pytest.approx(whole - skin, rel=0.03)
        and found["beside_cm3"] == 0.0
    )
    assert (
        issue["level"] == "warning"
        and "113 cm3" in issue["message"]
        and "one bead, 8 mm wide" in issue["message"]
    )


def test_a_bracket_is_refused_as_a_part_of_revolution_and_told_of_as_solids_on_its_bend(planned):
    done, report = planned(bracket())
    assert (
        done.status == 2
        and report is None
        and "error[NOT_OF_REVOLUTION]" in done.err
        and "Solid2" in done.err
    )
    done, report = planned(bracket(), "developable")
    assert done.status == 0
    issue, within = of_code(report, "NOT_DEPOSITED")
    bend = math.pi * (15**2 - 10**2) / 4 * 50 / 1000
    found = report["deposit"]
    assert found["part_cm3"] == pytest.approx(30.0 + bend, rel=1e-3) and found[
        "solids_left_out"
    ] == ["part solid 2"]
    assert found["deposited_cm3"] == pytest.approx(found["part_cm3"] - found["left_out_cm3"])
    # of the plates what is nearer to the bend's axis than its outside is, where none are laid, and corners
    under = 2.0 * 50.0 * quad(lambda y: math.sqrt(15.0**2 - y * y), 10.0, 15.0)[0] / 1000.0
    assert bend + under < found["left_out_cm3"] < bend + under + 0.03 * 30.0
    assert f"about {found['left_out_cm3'] - bend:.3g} of the 30 cm3" in within["message"]
    assert "the inside of a hub is not filled" in within["message"]
    assert "solid 2" in issue["message"] and "34.9" in issue["message"]
    # beads of 8 mm in plates of 5 mm lie over one another: what is laid is far more than what is covered
    (twice,) = of_code(report, "DEPOSITED_TWICE")
    laid, covered = report["totals"]["volume_cm3"], found["deposited_cm3"] + found["beside_cm3"]
    assert laid > 1.4 * covered and found["twice_cm3"] == pytest.approx(laid - covered, rel=0.06)
    assert twice["level"] == "warning" and f"{found['twice_cm3']:.3g} cm3" in twice["message"]


def test_how_much_of_a_first_layer_lies_beside_the_platform(workshop):
    """A block of 60 mm on a disc of 50: the length that the report tells is that of the written points beyond its edge."""
    Part.makeBox(60, 60, 8, FreeCAD.Vector(-30, -30, 0)).exportStep(
        str(workshop.folder / "cup.step")
    )
    text = workshop.text.replace("strategy:\n", "strategy:\n  kind: solid\n  bead_spacing: 6 mm\n")
    text = text.replace("diameter: 100 mm", "diameter: 50 mm").replace(
        "process:\n", "process:\n  bead_width: 6 mm\n"
    )
    workshop.write_job(text)
    done = workshop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert done.status == 0, done.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text())
    (issue,) = [one for one in report["issues"] if one["code"] == "OVER_PLATFORM"]
    told = re.match(
        r"([\d.]+) mm of the first layer overhang the platform edge, by up to ([\d.]+) mm",
        issue["message"],
    )
    with open(workshop.folder / "out" / "waypoints.csv", newline="") as stream:
        rows = [
            row for row in csv.DictReader(stream) if row["layer"] == "0" and row["kind"] != "rapid"
        ]
    points = np.array([[float(row[axis]) for axis in ("x_mm", "y_mm")] for row in rows])
    same = np.array([one["bead"] == other["bead"] for one, other in zip(rows, rows[1:])])
    share = (np.arange(2000) + 0.5) / 2000
    along = points[:-1, None] + share[:, None] * (points[1:] - points[:-1])[:, None]
    off = np.linalg.norm(along, axis=2) - 25.0
    length = np.linalg.norm(np.diff(points, axis=0), axis=1)
    beside = (((off > 3.0).mean(axis=1) * length)[same]).sum()
    assert beside > 50.0 and float(told[1]) == pytest.approx(beside, rel=0.02)
    assert (
        off[same].max() - 1.0 < float(told[2]) <= off[same].max() + 0.01
    )  # in the middle of a piece of the bead
    assert (
        "OVER_PLATFORM" in done.err and "cell.mount" not in issue["message"]
    )  # it would be over the edge there, too
    (promise,) = [
        one for one in report["preflight"] if one["promise"].startswith("Every bead is supported")
    ]
    assert promise["ok"] is False and promise["place"]["layer"] == 0


def test_a_part_beside_the_middle_of_the_platform_is_put_there_by_the_remedy_that_is_told(workshop):
    Part.makeBox(30, 30, 8, FreeCAD.Vector(20, 10, 0)).exportStep(str(workshop.folder / "cup.step"))
    text = workshop.text.replace("strategy:\n", "strategy:\n  kind: solid\n  bead_spacing: 6 mm\n")
    text = text.replace("diameter: 100 mm", "diameter: 60 mm").replace(
        "process:\n", "process:\n  bead_width: 6 mm\n"
    )
    for asked, mended in (
        (text, False),
        (text.replace("cell:\n", "cell:\n  mount: feature\n"), True),
    ):
        workshop.write_job(asked)
        done = workshop.run("plan", "cup.yaml", "-o", "out", "--no-page")
        report = json.loads((workshop.folder / "out" / "report.json").read_text())
        found = [one["message"] for one in report["issues"] if one["code"] == "OVER_PLATFORM"]
        assert bool(found) != mended and all(
            "centre the part by cell.mount: feature" in one for one in found
        )
        assert done.status == 0, done.err
