# SPDX-License-Identifier: LGPL-2.1-or-later
"""waypoints.csv reproduces the motion."""

import csv
import dataclasses
import io

import numpy as np
import pytest

from freecad_am.core.motion import Motion
from freecad_am.core.parameters.bead_classes import CLASSES
from freecad_am.core.simulation import timeline, waypoints
from freecad_am.core.toolpath import Bead, Layer, Toolpath

COLUMNS = (
    "layer,bead,point,kind,x_mm,y_mm,z_mm,bx,by,bz,tx,ty,tz,speed_mm_s,width_mm,"
    "q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,class"
)
AXES = tuple(f"q{i}" for i in range(1, 7))


def random_motion(n, seed=3):
    rng = np.random.default_rng(seed)

    def units():
        vectors = rng.normal(size=(n, 3))
        return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)

    joints = rng.normal(size=(n, 6)) * 30.0
    joints[n // 3] = np.nan
    width = rng.uniform(5, 9, n)
    width[::2] = np.nan
    return Motion(
        deposit=rng.random(n) < 0.8,
        layer=np.sort(rng.integers(0, 70, n)),
        bead=rng.integers(0, 3, n),
        point=np.arange(n),
        position=rng.normal(size=(n, 3)) * 300,
        build=units(),
        tool=units(),
        speed=rng.uniform(1, 100, n),
        width=width,
        joints=joints,
        duration=rng.uniform(0, 1, n),
    )


@pytest.mark.parametrize("count", [1, 7, 20_000, 20_001])
def test_reads_back_to_the_motion(count):
    motion = random_motion(count)
    text = "".join(waypoints.text(motion, AXES))
    assert "\r" not in text and text.endswith("\n")
    assert not set(text.split("\n", 1)[1]) - set("0123456789.,-\ndeposit" + "rapid")
    assert "nan" not in text
    rows = list(csv.DictReader(io.StringIO(text)))
    assert text.split("\n", 1)[0] == COLUMNS
    assert len(rows) == count

    def column(*names):
        return np.array([[float(row[name] or "nan") for name in names] for row in rows])

    assert [row["kind"] for row in rows] == ["deposit" if d else "rapid" for d in motion.deposit]
    for name, values in (("layer", motion.layer), ("bead", motion.bead), ("point", motion.point)):
        assert [row[name] for row in rows] == [str(value) for value in values]
    np.testing.assert_allclose(column("x_mm", "y_mm", "z_mm"), motion.position, atol=5.1e-7)
    np.testing.assert_allclose(column("bx", "by", "bz"), motion.build, atol=1e-9)
    np.testing.assert_allclose(column("tx", "ty", "tz"), motion.tool, atol=1e-9)
    np.testing.assert_allclose(
        column("speed_mm_s", "width_mm"), np.c_[motion.speed, motion.width], atol=5.1e-7
    )
    np.testing.assert_allclose(
        np.radians(column(*(f"{a}_deg" for a in AXES))), motion.joints, atol=1e-8
    )
    numbers = [
        cell for name in COLUMNS.split(",")[4:] for cell in (rows[0][name], rows[-1][name]) if cell
    ]
    assert all(len(cell.partition(".")[2]) >= 6 for cell in numbers)


def test_the_last_column_is_the_class_whatever_comes_before():
    motion = random_motion(500)
    number = np.random.default_rng(4).integers(-1, len(CLASSES), 500)
    for extra_columns in ({}, {"wire": np.full(500, 2.0)}):
        changed = dataclasses.replace(motion, bead_class=number, **extra_columns)
        rows = [
            line.rpartition(",")[2] for line in "".join(waypoints.text(changed, AXES)).splitlines()
        ]
        assert rows == [
            "class",
            *(CLASSES[class_number] if class_number >= 0 else "" for class_number in number),
        ]


def test_no_negative_zero():
    motion = random_motion(2)
    small = Motion(
        **{
            **{f: getattr(motion, f).copy() for f in motion.__dataclass_fields__},
            "position": np.full((2, 3), -1e-9),
            "joints": np.full((2, 6), -1e-12),
        }
    )
    assert "-0.0000" not in "".join(waypoints.text(small, AXES))


def test_without_a_cell_the_deposit_alone():
    def bead(height, closed):
        angle = np.linspace(0, 2 * np.pi, 13)
        points = np.c_[np.cos(angle), np.sin(angle), np.full(13, height)]
        points[-1] = points[0]
        up = np.tile([0.0, 0.0, 1.0], (13, 1))
        return Bead(points, up, up, angle, np.full(13, 6.0), closed)

    path = Toolpath(
        (Layer((bead(0.0, True),)), Layer((bead(1.0, True), bead(1.5, True)))), np.eye(4), 1.0, 0.01
    )
    motion = timeline.deposit_motion(path)
    rows = list(csv.DictReader(io.StringIO("".join(waypoints.text(motion)))))
    assert list(rows[0]) == [*COLUMNS.split(",")[:15], "class"] and {
        row["class"] for row in rows
    } == {""}
    assert [(r["layer"], r["bead"], r["point"]) for r in rows] == [
        (str(i), str(j), str(k)) for i, j in ((0, 0), (1, 0), (1, 1)) for k in range(13)
    ]
    assert motion.total_time == pytest.approx(path.length / 6.0)
    start_row, end_row = rows[13], rows[25]
    assert (start_row["x_mm"], start_row["y_mm"], start_row["z_mm"]) == (
        end_row["x_mm"],
        end_row["y_mm"],
        end_row["z_mm"],
    )
