# SPDX-License-Identifier: LGPL-2.1-or-later
"""Independent interpreters run programs of jobs with solids on hubs, and the trunnions' own
formulas convert their axes: they print the beads of waypoints.csv."""

import csv
import re

import FreeCAD
import numpy as np
import Part
import pytest

from tests.posts.interpreters import nc_python, rs274, run_nc, run_rs274

JOB = """\
part: {file: part.step}
strategy:
  kind: developable
  base: {radius: 30 mm, height: HEIGHT, axis: [[0, 0, 0], [0, 0, 1]]}
  layer_height: 8 mm
  chord_error: 0.1 mm
  bead_spacing: 5 mm
  fill: FILL
process: {bead_model: csw, bead_width: 9.5 mm, wire: {feed: 6.5 m/min}}
cell: {machine: MACHINE, setup: rotary-table, platform: 60 mm}
program: {post: POST, motion: MOTION}
"""
PLATFORM = 60.0
# rounding of the text, of rs274's output and of the single precision of nc-gcode-interpreter 0.1.9,
# at levers of up to 150 mm
TOLERANCE_MM, AXIS_TOLERANCE = 1e-3, 3e-6

linuxcnc_is_here = pytest.mark.skipif(
    rs274() is None, reason="no rs274 of LinuxCNC: `./freecad-am test` fetches it"
)
sinumerik_is_here = pytest.mark.skipif(
    nc_python() is None, reason="no nc-gcode-interpreter: `./freecad-am test` fetches it"
)


def blade():
    return Part.makeBox(50.0, 20.5, 34.5, FreeCAD.Vector(0, -10.25, 20))


def collar():
    outer, inner = (
        Part.makeCylinder(radius, 24.0, FreeCAD.Vector(0, 0, 20)) for radius in (46.0, 20.0)
    )
    return outer.cut(inner)


@pytest.fixture
def planned(workshop):
    """Return a function that plans a part: the moves of waypoints.csv as rows of numbers by name,
    whether each deposits, and the program."""

    def run(shape, height, fill, machine, post, motion):
        shape.exportStep(str(workshop.folder / "part.step"))
        text = JOB
        for old, new in (
            ("HEIGHT", height),
            ("FILL", fill),
            ("MACHINE", machine),
            ("POST", post),
            ("MOTION", motion),
        ):
            text = text.replace(old, new)
        (workshop.folder / "hub.yaml").write_text(text, encoding="utf-8")
        command = workshop.run("plan", "hub.yaml", "-o", "out", "--no-page")
        assert command.status == 0, command.err
        out = workshop.folder / "out"
        with open(out / "waypoints.csv", encoding="utf-8", newline="") as stream:
            rows = [
                row
                for row in csv.DictReader(stream)
                if row["kind"] == "rapid" or row["point"] != "0"
            ]
        deposit = np.array([row["kind"] == "deposit" for row in rows])
        positions, tools = (
            np.array([[float(row[name]) for name in names] for row in rows])
            for names in (("x_mm", "y_mm", "z_mm"), ("tx", "ty", "tz"))
        )
        return (
            positions,
            tools,
            deposit,
            {path.name: path.read_bytes() for path in (out / "program").iterdir()},
        )

    return run


def in_part(machine, axis_values):
    """Return tip and tool axis (n, 3) in the part at axis values (n, 5) in mm and deg: the formulas
    of LinuxCNC's trunnions with the offsets of the machine files, solved for them."""
    x, y, z = axis_values[:, :3].T
    tilt, turn = np.radians(axis_values[:, 3:].T)
    up, side, zero = np.cos(tilt), np.sin(tilt), np.zeros(len(axis_values))
    if machine == "table-xyzac":
        v, w = y - 20.0, z - 10.0
        level = np.stack([x, up * v + side * w + 20.0, -side * v + up * w + 10.0])
        axis = np.stack([zero, side, up])
    else:
        v, w = x - 20.0, z - 10.0
        level = np.stack([up * v - side * w + 20.0, y, side * v + up * w + 10.0])
        axis = np.stack([-side, zero, up])
    cos, sin = np.cos(turn), np.sin(turn)
    tip, tool = (
        np.stack([cos * u + sin * v, -sin * u + cos * v, w], axis=1) for u, v, w in (level, axis)
    )
    return tip - [0.0, 0.0, PLATFORM], tool


CASES = [
    ("zigzag", blade, "inf", "joint"),
    ("contours", blade, "200 mm", "cartesian"),
    ("spiral", blade, "200 mm", "joint"),
    ("contours", collar, "inf", "cartesian"),
]


TABLES = [
    *((*case, "table-xyzac" if case[1] is blade else "table-xyzbc") for case in CASES),
    ("contours", blade, "200 mm", "joint", "table-xyzbc"),
    ("lines", collar, "inf", "joint", "table-xyzbc"),
]


@linuxcnc_is_here
@pytest.mark.parametrize(("fill", "part", "height", "motion", "machine"), TABLES)
def test_linuxcnc_lays_the_beads(planned, tmp_path, fill, part, height, motion, machine):
    positions, tools, deposit, files = planned(part(), height, fill, machine, "linuxcnc", motion)
    folder = tmp_path / "linuxcnc"
    folder.mkdir()
    moves, complaints = run_rs274(folder, files, "hub.ngc")
    assert not complaints and len(moves) == len(positions) and deposit.sum() > 40
    assert [move["deposit"] for move in moves] == deposit.tolist()
    columns = [0, 1, 2, 3 if machine == "table-xyzac" else 4, 5]
    axis_values = np.array([move["at"] for move in moves])[:, columns]
    tip, tool = in_part(machine, axis_values)
    is_checked = deposit & (
        motion == "cartesian"
    )  # with the kinematics on, positions are those of the tip on the part
    assert [move["kinematics"] for move in moves] == [428 if on else 429 for on in is_checked]
    tip[is_checked] = axis_values[is_checked, :3]
    assert np.abs(tip - positions).max() < TOLERANCE_MM
    assert np.abs(tool - tools).max() < AXIS_TOLERANCE


@sinumerik_is_here
@pytest.mark.parametrize(("fill", "part", "height", "motion"), CASES)
def test_a_sinumerik_lays_the_beads(planned, fill, part, height, motion):
    positions, tools, deposit, files = planned(
        part(), height, fill, "table-xyzac", "siemens", motion
    )
    order = sorted(files)
    texts = [files[name].decode("ascii") for name in order]
    moves, on_part = [], []
    for text, (rows, _, complaint) in zip(texts, run_nc(texts), strict=True):
        assert not complaint
        blocks = {}
        for row in rows:
            blocks.setdefault(row["N"], row)
        for number, words in re.findall(r"(?m)^N(\d+) (.*\bG1 .*)$", text):
            moves.append(blocks[int(number)])
            on_part.append("A3=" in words)
    assert len(moves) == len(positions) and deposit.sum() > 40
    assert on_part == (deposit & (motion == "cartesian")).tolist()
    on_part = np.array(on_part)
    tip, tool = np.full_like(positions, np.nan), np.full_like(positions, np.nan)
    if on_part.any():
        tip[on_part] = [[moves[k][name] for name in "XYZ"] for k in np.flatnonzero(on_part)]
        tool[on_part] = [
            [moves[k][name] for name in ("A3", "B3", "C3")] for k in np.flatnonzero(on_part)
        ]
    axes = np.array([[moves[k][name] for name in "XYZAC"] for k in np.flatnonzero(~on_part)])
    tip[~on_part], tool[~on_part] = in_part("table-xyzac", axes)
    assert np.abs(tip - positions).max() < TOLERANCE_MM
    assert np.abs(tool - tools).max() < AXIS_TOLERANCE
