# SPDX-License-Identifier: LGPL-2.1-or-later
"""A dome on a five-axis table, from its job to the controller's texts; these driven by the trunnion's own formulas."""

import csv
import json
import math
import re
import shutil
from xml.etree import ElementTree

import numpy as np
import pytest

from freecad_am.batch.job.job import read_job
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.kdl import KdlArm
from tests.batch import row_limits

RADIUS, PLATFORM, SPEED = 45.0, 60.0, 5.0
Y_OFFSET, Z_OFFSET = 20.0, 10.0
WORDS = re.compile(r"([A-Z])(-?\d+\.?\d*)")


@pytest.fixture
def planned(workshop, root):
    """Plans the example, its job changed: report, rows of waypoints.csv, texts by name, the folder."""

    def run(change=lambda text: text, page=False):
        folder = root / "resources" / "examples"
        shutil.copy(folder / "hemisphere.step", workshop.folder)
        text = change((folder / "hemisphere-on-table.yaml").read_text(encoding="utf-8"))
        (workshop.folder / "dome.yaml").write_text(text, encoding="utf-8")
        done = workshop.run("plan", "dome.yaml", "-o", "out", *(() if page else ("--no-page",)))
        assert done.status == 0, done.err
        out = workshop.folder / "out"
        with open(out / "waypoints.csv", encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
        texts = {
            path.name: path.read_text(encoding="ascii") for path in (out / "program").iterdir()
        }
        cell = read_job(str(workshop.folder / "dome.yaml")).cell
        assert row_limits.over_all(out, cell.machine, cell.limits) <= 0.0
        return json.loads((out / "report.json").read_text(encoding="utf-8")), rows, texts, out

    return run


def column(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def moves_of(texts):
    """X Y Z A C, the time (s) of the move and whether the deposit is on, of each G1 in inverse time, in order of name."""
    last, found, on, inverse = {}, [], False, False
    for name in sorted(texts):
        for line in texts[name].splitlines():
            if line.startswith("("):
                continue
            inverse = (inverse or "G93" in line) and "G94" not in line
            if re.search(r"M6[24] P0", line):
                on = True
            if re.search(r"M6[35] P0", line):
                on = False
            if "G1 " in line:
                assert inverse
                last |= {letter: float(value) for letter, value in WORDS.findall(line)}
                found.append([*(last[letter] for letter in "XYZAC"), 60.0 / last["F"], on])
    return np.array(found)


def in_part(moves):
    """Tip and torch direction in the part's coordinates: the trunnion's formulas, solved for them."""
    x, y, z = moves[:, :3].T
    a, c = np.radians(moves[:, 3:5].T)
    v, w = y - Y_OFFSET, z - Z_OFFSET
    yr, zt = np.cos(a) * v + np.sin(a) * w + Y_OFFSET, -np.sin(a) * v + np.cos(a) * w + Z_OFFSET
    tip = np.stack(
        [np.cos(c) * x + np.sin(c) * yr, -np.sin(c) * x + np.cos(c) * yr, zt - PLATFORM], axis=1
    )
    return tip, np.stack([np.sin(c) * np.sin(a), np.cos(c) * np.sin(a), np.cos(a)], axis=1)


def test_the_text_lays_the_dome(planned):
    report, rows, texts, _ = planned()
    moves = moves_of(texts)
    on = moves[:, 6] > 0.0
    tip, tool = in_part(moves)
    np.testing.assert_allclose(np.linalg.norm(tip[on], axis=1), RADIUS, atol=1e-3)
    wanted = [row for row in rows if row["kind"] == "deposit" and row["point"] != "0"]
    np.testing.assert_allclose(tip[on], column(wanted, "x_mm", "y_mm", "z_mm"), atol=2e-4)
    np.testing.assert_allclose(tool[on], column(wanted, "tx", "ty", "tz"), atol=1e-6)
    # as fast along the bead as asked for, at every point; where the wall closes slower, and said so
    ends = np.flatnonzero(on)
    way = np.linalg.norm(tip[ends] - tip[ends - 1], axis=1)
    asked = column(wanted, "speed_mm_s")[:, 0]
    np.testing.assert_allclose(way / moves[ends, 5], asked, rtol=2e-3)
    slowed = asked < SPEED - 1e-9
    assert (
        slowed.any() == any(issue["code"] == "SLOWED" for issue in report["issues"])
        and slowed.mean() < 0.02
    )
    assert np.abs(moves[on, 3]).max() > 60.0  # the table tilts
    # no axis faster than it can
    rate = np.abs(np.diff(moves[:, :5], axis=0)) / moves[1:, 5:6]
    assert (rate.max(axis=0) <= np.array([200, 200, 200, 90, 180]) * 1.001).all()


def test_what_is_told_of_axes_is_in_their_units(planned):
    report, rows, _, out = planned(
        lambda text: text.replace("layer_height: 2 mm", "layer_height: 5 mm"), page=True
    )
    assert report["machine"]["axes"] == ["mx", "my", "mz", "a", "c"]
    assert report["machine"]["units"] == ["mm", "mm", "mm", "deg", "deg"]
    assert list(rows[0])[-6:] == ["mx_mm", "my_mm", "mz_mm", "a_deg", "c_deg", "class"]
    axes = column([row for row in rows if row["kind"] == "deposit"], *list(rows[0])[-6:-1])
    joints = report["joints"]
    np.testing.assert_allclose(joints["min_deg"], axes.min(axis=0), atol=1e-6)
    np.testing.assert_allclose(joints["max_deg"], axes.max(axis=0), atol=1e-6)
    assert joints["limit_margin_deg"][0] == pytest.approx(
        500.0 - np.abs(axes[:, 0]).max(), abs=1e-6
    )
    assert (
        joints["limit_margin_deg"][4] is None
        and joints["condition_min"] is None
        and joints["branch"] == []
    )
    assert all(0.0 <= share <= 1.0 for share in joints["speed_ratio_max"])
    page = (out / "report.html").read_text(encoding="utf-8")
    assert (
        "mx, mm" in page and "largest speed, deg/s or mm/s" not in page
    )  # one method: no table of methods
    drawn = [ElementTree.fromstring(text) for text in re.findall(r"<svg.*?</svg>", page, re.DOTALL)]
    texts = {
        one.get("aria-label"): [node.text for node in one.iter() if node.tag.endswith("text")]
        for one in drawn
    }
    assert {"place, mm", "limits -500 to 500 mm"} <= set(texts["mx"]) and "angle, deg" not in texts[
        "mx"
    ]
    assert "angle, deg" in texts["c (endless)"] and "place, mm" not in texts["c (endless)"]
    assert not any("limits" in text for text in texts["c (endless)"])
    assert "smallest condition" not in page and "Condition of the Jacobian" not in page


@pytest.mark.parametrize(
    "machine, motion",
    [
        ("table-xyzac", "joint"),
        ("table-xyzbc", "joint"),
        ("head-table-xyzbc", "joint"),
        ("head-xyzab", "joint"),
        ("table-xyzac", "cartesian"),
    ],
)
def test_sinumerik_texts_of_tables_and_heads(planned, machine, motion):
    def change(text):
        return (
            text.replace("linuxcnc", "siemens")
            .replace("motion: joint", f"motion: {motion}")
            .replace("table-xyzac", machine)
            .replace("layer_height: 2 mm", "layer_height: 8 mm")
            .replace(
                "travel_speed: 5",
                "travel_speed: 2" if machine == "head-xyzab" else "travel_speed: 5",
            )
        )

    report, rows, texts, _ = planned(change)
    assert report["status"] == "ok" and all(name.upper() == name for name in texts)
    deposit = [row for row in rows if row["kind"] == "deposit" and row["point"] != "0"]
    lines = [line for name in sorted(texts) for line in texts[name].splitlines() if " G1 " in line]
    if motion == "cartesian":
        told = [
            dict(re.findall(r"\b([XYZ]|[ABC]3)=?(-?\d+\.\d+)", line))
            for line in lines
            if "A3=" in line
        ]
        np.testing.assert_allclose(
            column(told, "X", "Y", "Z"), column(deposit, "x_mm", "y_mm", "z_mm"), atol=6e-6
        )
        np.testing.assert_allclose(
            column(told, "A3", "B3", "C3"), column(deposit, "tx", "ty", "tz"), atol=6e-7
        )
        return
    names = [name for name in rows[0] if name[:2] in ("mx", "my", "mz", "a_", "b_", "c_")]
    moved = column([row for row in rows if row["kind"] == "rapid" or row["point"] != "0"], *names)
    letters = [name.split("_")[0][-1].upper() for name in names]
    told = [dict(re.findall(r"\b([XYZABC])(?:=DC\()?(-?\d+\.\d+)", line)) for line in lines]
    apart = column(told, *letters) - moved
    if "C" in letters:  # DC takes the shorter way to an angle of one turn
        turn = letters.index("C")
        apart[:, turn] -= 360.0 * np.round(apart[:, turn] / 360.0)
        assert np.abs(np.diff(moved[:, turn])).max() < 180.0
    assert np.abs(apart).max() < 6e-6


def test_a_wall_on_an_existing_part_on_a_table(workshop, root):
    folder = root / "resources" / "examples"
    for name in ("tube-on-pipe.step", "pipe.step"):
        shutil.copy(folder / name, workshop.folder)
    text = (folder / "tube-on-pipe.yaml").read_text(encoding="utf-8").split("cell:")[0]
    text += (
        "cell: {machine: table-xyzbc, setup: rotary-table, platform: 80 mm}\nprocess: {travel_speed: 6 mm/s}\n"
        "program: {post: linuxcnc, motion: cartesian}\n"
    )
    (workshop.folder / "bend.yaml").write_text(text, encoding="utf-8")
    done = workshop.run("plan", "bend.yaml", "-o", "out", "--no-page")
    assert done.status == 0, done.err
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    machine = machines.load("table-xyzbc", ())
    axes = column(rows, "mx_mm", "my_mm", "mz_mm", "b_deg", "c_deg") * machine.unit_values
    seen = np.linalg.inv(
        KdlArm(machine).forward(axes)
    )  # the torch's tip from the face of the table
    np.testing.assert_allclose(
        seen[:, :3, 3] - [0.0, 0.0, 80.0], column(rows, "x_mm", "y_mm", "z_mm"), atol=1e-5
    )
    np.testing.assert_allclose(seen[:, :3, 2], column(rows, "tx", "ty", "tz"), atol=1e-7)


def test_four_axes_are_told_with_what_they_miss(planned):
    report, rows, _, _ = planned(
        lambda text: text + "joints:\n  lock: first\n  lock_at: -40 deg\n  max_residual: 50 deg\n"
    )
    note = next(issue for issue in report["issues"] if issue["code"] == "FOUR_AXES")
    assert note["level"] == "note" and "axis a is locked at -40 deg" in note["message"]
    assert set(column(rows, "a_deg")[:, 0].round(6)) == {-40.0}
    tool = column([row for row in rows if row["kind"] == "deposit"], "tx", "ty", "tz")
    np.testing.assert_allclose(tool[:, 2], math.cos(math.radians(40.0)), atol=1e-9)


def test_a_part_that_leans_is_refused_before_it_is_planned(workshop, root):
    (workshop.folder / "dome.step").write_text("no part: it is never read", encoding="utf-8")
    text = (
        "version: 1\npart: {file: dome.step}\nprogram: {post: linuxcnc, motion: cartesian}\n"
        "cell: {machine: table-xyzac, setup: rotary-table, platform: [11, -7, 60, 0, 20, 35]}\n"
    )
    (workshop.folder / "leans.yaml").write_text(text, encoding="utf-8")
    done = workshop.run("plan", "leans.yaml", "-o", "out")
    assert (
        done.status == 2
        and "UNSUPPORTED_FRAME" in done.err
        and "cell.platform: [11, -7, 60, 0, 0, 35]" in done.err
    )
