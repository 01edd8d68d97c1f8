# SPDX-License-Identifier: LGPL-2.1-or-later
"""A dome on a five-axis machine, from its job to the controller's texts; the trunnion's own
formulas drive them."""

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
    """Return a function that plans the example with changes: report, rows of waypoints.csv, texts
    by name, the folder."""

    def run(change=lambda text: text, page=False):
        folder = root / "resources" / "examples"
        shutil.copy(folder / "hemisphere.step", workshop.folder)
        text = change((folder / "hemisphere-on-table.yaml").read_text(encoding="utf-8"))
        (workshop.folder / "dome.yaml").write_text(text, encoding="utf-8")
        command = workshop.run("plan", "dome.yaml", "-o", "out", *(() if page else ("--no-page",)))
        assert command.status == 0, command.err
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
    """Return X Y Z A C, the time in s and whether the deposit is on, for each G1 in inverse time,
    in order of the file names."""
    words, moves_, on, inverse = {}, [], False, False
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
                words |= {letter: float(value) for letter, value in WORDS.findall(line)}
                moves_.append([*(words[letter] for letter in "XYZAC"), 60.0 / words["F"], on])
    return np.array(moves_)


def in_part(moves):
    """Return tip and torch direction in part coordinates: the trunnion's formulas, solved for
    them."""
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
    expected = [row for row in rows if row["kind"] == "deposit" and row["point"] != "0"]
    np.testing.assert_allclose(tip[on], column(expected, "x_mm", "y_mm", "z_mm"), atol=2e-4)
    np.testing.assert_allclose(tool[on], column(expected, "tx", "ty", "tz"), atol=1e-6)
    # at every point the bead has the requested speed, or a lower one where the wall closes, as
    # reported
    ends = np.flatnonzero(on)
    lengths = np.linalg.norm(tip[ends] - tip[ends - 1], axis=1)
    planned_speed = column(expected, "speed_mm_s")[:, 0]
    np.testing.assert_allclose(lengths / moves[ends, 5], planned_speed, rtol=2e-3)
    slowed = planned_speed < SPEED - 1e-9
    assert (
        slowed.any() == any(issue["code"] == "SLOWED" for issue in report["issues"])
        and slowed.mean() < 0.02
    )
    assert np.abs(moves[on, 3]).max() > 60.0  # the table tilts
    # no axis exceeds its speed
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
    )  # with a single method, the report has no table of methods
    drawn = [ElementTree.fromstring(text) for text in re.findall(r"<svg.*?</svg>", page, re.DOTALL)]
    texts = {
        chart.get("aria-label"): [node.text for node in chart.iter() if node.tag.endswith("text")]
        for chart in drawn
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
        words = [
            dict(re.findall(r"\b([XYZ]|[ABC]3)=?(-?\d+\.\d+)", line))
            for line in lines
            if "A3=" in line
        ]
        np.testing.assert_allclose(
            column(words, "X", "Y", "Z"), column(deposit, "x_mm", "y_mm", "z_mm"), atol=6e-6
        )
        np.testing.assert_allclose(
            column(words, "A3", "B3", "C3"), column(deposit, "tx", "ty", "tz"), atol=6e-7
        )
        return
    names = [name for name in rows[0] if name[:2] in ("mx", "my", "mz", "a_", "b_", "c_")]
    moved = column([row for row in rows if row["kind"] == "rapid" or row["point"] != "0"], *names)
    letters = [name.split("_")[0][-1].upper() for name in names]
    words = [dict(re.findall(r"\b([XYZABC])(?:=DC\()?(-?\d+\.\d+)", line)) for line in lines]
    differences = column(words, *letters) - moved
    if "C" in letters:  # DC takes the shorter way to an angle within one turn
        turn = letters.index("C")
        differences[:, turn] -= 360.0 * np.round(differences[:, turn] / 360.0)
        assert np.abs(np.diff(moved[:, turn])).max() < 180.0
    assert np.abs(differences).max() < 6e-6


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
    command = workshop.run("plan", "bend.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    machine = machines.load("table-xyzbc", ())
    axes = column(rows, "mx_mm", "my_mm", "mz_mm", "b_deg", "c_deg") * machine.unit_values
    in_part_frame = np.linalg.inv(
        KdlArm(machine).forward(axes)
    )  # the torch's tip relative to the face of the table
    np.testing.assert_allclose(
        in_part_frame[:, :3, 3] - [0.0, 0.0, 80.0], column(rows, "x_mm", "y_mm", "z_mm"), atol=1e-5
    )
    np.testing.assert_allclose(in_part_frame[:, :3, 2], column(rows, "tx", "ty", "tz"), atol=1e-7)


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
    command = workshop.run("plan", "leans.yaml", "-o", "out")
    assert (
        command.status == 2
        and "UNSUPPORTED_FRAME" in command.err
        and "cell.platform: [11, -7, 60, 0, 0, 35]" in command.err
    )
