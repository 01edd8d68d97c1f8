# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's bend on the paper's robot, an RX60B L, through the Stäubli post, with its texts
driven through PyKDL."""

import csv
import json
import re
import shutil

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.kdl import KdlArm
from freecad_am.posts.staubli import post as staubli
from tests.batch.conftest import Workshop

NAME = "tube-on-pipe-staubli"
TARGET, ORIGIN, PLATFORM = [550.0, 0.0, 800.0], [0.0, 0.0, 32.0], 60.0
BEND, TUBE = 60.0, 15.0


@pytest.fixture(scope="module", params=["cartesian", pytest.param("joint", marks=pytest.mark.long)])
def made(tmp_path_factory, root, request):
    """Return the motion, the rows of waypoints.csv and the texts of the example."""
    workshop = Workshop(tmp_path_factory.mktemp("staubli"), root / "freecad-am")
    folder = root / "resources" / "examples"
    for name in ("tube-on-pipe.step", "pipe.step"):
        shutil.copy(folder / name, workshop.folder)
    text = (
        (folder / f"{NAME}.yaml")
        .read_text(encoding="utf-8")
        .replace("motion: cartesian", f"motion: {request.param}")
    )
    (workshop.folder / "bend.yaml").write_text(text, encoding="utf-8")
    command = workshop.run("plan", "bend.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["joints"]["feasible"] is True
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    program = workshop.folder / "out" / "program"
    texts = {
        str(path.relative_to(program)): path.read_bytes()
        for path in program.rglob("*")
        if path.is_file()
    }
    return request.param, rows, texts


def columns(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def test_the_texts_bring_the_points_of_the_part_to_the_nozzle(made):
    motion, rows, texts = made
    readback = staubli.read(texts)
    arm = KdlArm(machines.load("staubli-rx60bl", ()))
    moves = [row for row in rows if row["kind"] == "rapid" or row["point"] != "0"]
    deposit = [row for row in moves if row["kind"] == "deposit"]
    expected = arm.forward(np.radians(columns(deposit, *(f"q{axis}_deg" for axis in range(1, 7)))))
    points = columns(deposit, "x_mm", "y_mm", "z_mm")
    if motion == "joint":
        assert len(readback.joints) == len(moves)
        flange = arm.forward(readback.joints[readback.deposit])
        assert np.abs(flange - expected).max() < 1e-3
        return
    gauge = readback.tool[readback.deposit]
    flange = readback.frame @ np.linalg.inv(
        gauge
    )  # the flange pose that the robot must reach, from the texts only
    assert (
        np.abs(readback.frame[:3, 3] - TARGET).max() == 0.0
        and np.abs(readback.position[readback.deposit]).max() == 0.0
    )
    part_points = gauge[:, :3, 3] + [0.0, 0.0, -PLATFORM]
    # all programmed points are on the wall, including those that planning added between the points
    # of the layers
    x, y, z = part_points.T
    assert np.abs(np.hypot(np.hypot(x + BEND, z) - BEND, y) - TUBE).max() < 2e-4
    off, row = cKDTree(part_points).query(points)
    assert off.max() < 2e-4 and (np.diff(row) > 0).all() and len(part_points) >= len(points)
    assert np.abs(flange[row][:, :3, :3] - expected[:, :3, :3]).max() < 1e-6
    assert np.linalg.norm(flange[row][:, :3, 3] - expected[:, :3, 3], axis=1).max() < 1e-3


def test_parts_are_loaded_only_where_the_deposit_is_off(made):
    motion, rows, texts = made
    start = texts["tubeOnPipe/start.pgx"].decode("utf-8-sig")
    part_names = re.findall(r'libLoad\("\./(\w+)"\)', start)
    assert len(part_names) > 1 and "doDeposit" not in start
    beads = {(row["layer"], row["bead"]) for row in rows}
    switched = 0
    for part_name in part_names:
        code = texts[f"tubeOnPipe/{part_name}/start.pgx"].decode("utf-8-sig")
        switches = re.findall(r"doDeposit=(\w+)", code)
        assert switches == ["true", "false"] * (len(switches) // 2)
        switched += len(switches) // 2
        data = texts[f"tubeOnPipe/{part_name}/{part_name}.dtx"].decode("utf-8-sig")
        sizes = {
            name: int(size) for name, size in re.findall(r'name="([jt]Path)".*? size="(\d+)"', data)
        }
        assert sum(sizes.values()) <= 400
        if motion == "cartesian":
            assert (
                f'z="{PLATFORM + ORIGIN[2]:.4f}"' in data
            )  # the program origin relative to the flange, which carries all gauges
            assert data.count('fatherId="tCarried[0]"') == sizes["tPath"]
    assert switched == len(beads)
