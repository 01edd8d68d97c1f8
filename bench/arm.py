# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.arm_clearance`: how near links come to a post beside a dome, and what keeping them clear adds to planning.

Judged by others on what was saved: joints of every row of waypoints.csv, and at nine places between two rows, through
PyKDL's chain of the machine, and distances by python-fcl between the rods of the links and the post. Without the key the
same job drives links into the post, which the library has to see too, or it sees nothing.
"""

from __future__ import annotations

import csv
import json
import os
import subprocess
import tempfile
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from freecad_am.core.kinematics import link_rods, machine
from freecad_am.kdl.chain import KdlArm

from rows import Row

ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "resources" / "examples" / "hemisphere.step"
CLEARANCE, TIMES = 10.0, 3.0  # mm that are kept, and times the planning may take
BETWEEN = 10  # places looked at from one row to the next, the row's own among them
LOW, SIZE = (50.0, 108.5, -5.0), (60.0, 60.0, 400.0)  # of the post, mm in part coordinates
ROUNDS = 5  # of both jobs in turns
ROBOT, STATION, LEAN = "fanuc-arcmate120ic", (900.0, 0.0, -100.0), 45.0
JOB = """version: 1
name: arm
part: {{file: {step}}}
fixtures: [{{file: post.stl}}]
strategy: {{kind: revolution, layer_height: 15 mm, chord_error: 0.2 mm}}
build_direction: {{mode: fixed}}
cell: {{machine: {robot}, limits: paper, setup: tool-on-robot, deposition_point: [{x}, {y}, {z}, 0, 0, 0],
       nozzle: {{length: 60 mm, tool: [120, 0, 200, 0, {lean}, 0]}}, branch: [front, down, noflip]{key}}}
program: {{post: fanuc}}
"""


def run() -> list[Row]:
    """The least distance against what was asked for, and the time against the same without."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "post.stl").write_text(_box(), encoding="utf-8")
        done = [
            [_planned(folder, key) for key in ("", f", arm_clearance: {CLEARANCE:g} mm")] for _ in range(ROUNDS)
        ]
    plain, took = (median(seconds for _, seconds in some) for some in zip(*done))
    (near, _), (kept, _) = done[0]
    assert near is None or near < CLEARANCE, f"nothing to keep clear of: {near:.1f} mm"
    return [
        Row(f"least distance of links from a post by python-fcl, {0.0 if near is None else near:.1f} mm without "
            "cell.arm_clearance; what is kept", CLEARANCE, kept, "mm", 1.0),
        Row(f"joint path with cell.arm_clearance, against {TIMES:g} times that without", took, TIMES * plain, "s", 1.0),
    ]


def _planned(folder: Path, key: str) -> tuple[float | None, float]:
    """The least distance in mm, None without python-fcl, and seconds that the joint path took."""
    x, y, z = STATION
    (folder / "arm.yaml").write_text(
        JOB.format(step=EXAMPLE, robot=ROBOT, x=x, y=y, z=z, lean=LEAN, key=key), encoding="utf-8")
    command = [str(ROOT / "freecad-am"), "plan", str(folder / "arm.yaml"), "-o", str(folder / "out"), "--no-page"]
    environment = {name: value for name, value in os.environ.items() if name not in ("BENCH_INSIDE", "VIRTUAL_ENV")}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    assert not done.returncode, done.stderr
    report = json.loads((folder / "out" / "report.json").read_text(encoding="utf-8"))
    return _nearest(folder / "out" / "waypoints.csv"), float(report["timing_s"]["joint_path"])


def _nearest(table: Path) -> float | None:
    """Least distance in mm of links from the post along a saved path."""
    try:
        import fcl
    except ImportError:
        return None
    with open(table, encoding="utf-8", newline="") as file:
        rows = [[float(row[f"q{axis}_deg"]) for axis in range(1, 7)] for row in csv.DictReader(file)]
    joints = np.radians(rows)
    shares = np.linspace(0.0, 1.0, BETWEEN, endpoint=False)[:, None, None]
    joints = (joints[:-1] + shares * np.diff(joints, axis=0)).reshape(-1, 6)
    robot = machine.load(ROBOT)
    arm, frame, least = KdlArm(robot), None, np.inf
    frame = arm.kdl.Frame()
    # the part stands at the deposition point, its frame as that of the base
    middle = robot.base[:3, :3] @ (np.add(LOW, 0.5 * np.array(SIZE)) + STATION) + robot.base[:3, 3]
    post = fcl.CollisionObject(fcl.Box(*SIZE), fcl.Transform(middle))
    links = [(number, [_rod(fcl, rod) for rod in rods]) for number, rods in enumerate(link_rods.of_robot(robot.chain))]
    for q in joints:
        angles = arm.angles(q)
        for number, rods in links[1:]:
            arm._forward.JntToCart(angles, frame, 2 * number)
            turn = np.array([[frame.M[i, j] for j in range(3)] for i in range(3)])
            place = np.array([frame.p.x(), frame.p.y(), frame.p.z()])
            for cylinder, turned, at in rods:
                moving = fcl.CollisionObject(cylinder, fcl.Transform(turn @ turned, place + turn @ at))
                least = min(least, fcl.distance(moving, post, fcl.DistanceRequest(), fcl.DistanceResult()))
    return max(float(least), 0.0)


def _rod(fcl: Any, rod: Any) -> tuple[Any, np.ndarray, np.ndarray]:
    """A cylinder of the library, and where it is in the frame of its link."""
    axis = (rod.end - rod.start) / rod.length
    one = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    one /= np.linalg.norm(one)
    turned = np.column_stack([one, np.cross(axis, one), axis])
    return fcl.Cylinder(rod.radius, rod.length), turned, 0.5 * (rod.start + rod.end)


def _box() -> str:
    """The post as a text of STL."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * SIZE + LOW
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    lines = ["solid post"]
    for a, b, c, d in faces:
        for triangle in ((a, b, c), (a, c, d)):
            points = [f"vertex {x:g} {y:g} {z:g}" for x, y, z in corners[list(triangle)]]
            lines += ["facet normal 0 0 0", "outer loop", *points, "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid post", ""])
