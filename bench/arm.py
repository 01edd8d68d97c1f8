# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.arm_clearance`: distance of the links from obstacles next to a dome, and the planning time
that it costs. The obstacles are a post declared as a fixture, a table that carries the part, and a
tall finished wall. Without the key the same job drives links into each obstacle; the library must
detect that too, or its result proves nothing. A screen between robot and part must be rejected by
name. Other libraries judge the saved files: PyKDL's chain of the machine gives the links for every
row of waypoints.csv and nine joint positions between two rows; python-fcl gives distances between
link capsules and obstacle. `arm_apart` covers links against each other, the torch and the
positioner."""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import arm_apart
import numpy as np
from arm_jobs import CLEARANCE, EXAMPLE, box_text, cylinder, is_path, run_plan, sample_joints

from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.machines import machine
from tests.kdl_links import KdlLinks

from rows import Row
from sizes import choose

MAX_TIME_RATIO = 3.0  # maximum planning time, as a multiple of the time without the key
ROUNDS = choose(5, 1)  # of both jobs in turns
ROBOT, STATION, LEAN = "fanuc-arcmate120ic", (1000.0, 0.0, -100.0), 45.0
JOB = """version: 1
name: arm
part: {{file: {step}}}
{fixtures}
strategy: {{kind: revolution, layer_height: 15 mm, chord_error: 0.2 mm}}
build_direction: {{mode: fixed}}
cell: {{machine: {robot}, limits: paper, setup: tool-on-robot, deposition_point: [{x}, {y}, {z}, 0, 0, 0],
       nozzle: {{length: 60 mm, tool: [120, 0, 200, 0, {lean}, 0]}}, branch: {branch}, obstacles: {obstacles}{key}}}
program: {{post: fanuc}}
"""
DOWN, AUTO = "[front, down, noflip]", "auto"


@dataclass(frozen=True)
class Obstacle:
    """A box next to the part: name, lower corner and edge lengths (mm, part coordinates), requested
    configuration, and whether it is a fixture."""

    name: str
    low: tuple[float, float, float]
    size: tuple[float, float, float]
    branch: str
    fixture: bool = False

    def job(self, key: str) -> str:
        """Return the text of a job with this obstacle."""
        x, y, z = STATION
        middle = np.add(self.low, 0.5 * np.array(self.size)) + STATION
        stands = (
            "[]"
            if self.fixture
            else (
                f"[{{name: {self.name}, box: {list(self.size)}, pose: [{', '.join(map(repr, middle.tolist()))}, 0, 0, 0]}}]"
            )
        )
        return JOB.format(
            step=EXAMPLE,
            robot=ROBOT,
            x=x,
            y=y,
            z=z,
            lean=LEAN,
            key=key,
            branch=self.branch,
            obstacles=stands,
            fixtures="fixtures: [{file: post.stl}]" if self.fixture else "",
        )


OBSTACLES = (
    Obstacle("post", (50.0, 108.5, -5.0), (60.0, 60.0, 400.0), DOWN, fixture=True),
    Obstacle("table", (-500.0, -400.0, -30.0), (1000.0, 800.0, 30.0), AUTO),
    Obstacle("finished wall", (-130.0, 104.0, 0.0), (260.0, 12.0, 420.0), DOWN),
)
SCREEN = Obstacle("screen", (-470.0, -1500.0, -1400.0), (40.0, 3000.0, 3000.0), AUTO)


def run() -> list[Row]:
    """Compare the least distance from each obstacle with the clearance, and planning times with and
    without the key."""
    rows = []
    for body in choose(OBSTACLES, OBSTACLES[:1]):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "post.stl").write_text(box_text(body.low, body.size), encoding="utf-8")
            rounds = [
                [
                    plan_and_measure(folder, body, key)
                    for key in ("", f", arm_clearance: {CLEARANCE:g} mm")
                ]
                for _ in range(ROUNDS)
            ]
        plain, took = (median(seconds for _, seconds in times) for times in zip(*rounds))
        (distance, _), (kept_distance, _) = rounds[0]
        assert distance is None or distance < CLEARANCE, (
            f"nothing to keep clear of: {distance:.1f} mm from the {body.name}"
        )
        rows += [
            Row(
                f"least distance of links from a {body.name} by python-fcl, {0.0 if distance is None else distance:.1f} mm without "
                "cell.arm_clearance; what is kept",
                CLEARANCE,
                kept_distance,
                "mm",
                1.0,
            ),
            Row(
                f"joint path beside a {body.name} with cell.arm_clearance, against {MAX_TIME_RATIO:g} times that without",
                took,
                MAX_TIME_RATIO * plain,
                "s",
                1.0,
            ),
        ]
    check_rejection()
    return rows + arm_apart.run()


def check_rejection() -> None:
    """The post rejects the screen, which no path clears, and names link, layer and bead."""
    with tempfile.TemporaryDirectory() as name:
        process = run_plan(Path(name), SCREEN.job(f", arm_clearance: {CLEARANCE:g} mm"))
    fragments = "error[ARM_CLEARANCE] layer 0 bead 0: ", ": link q", f"mm to {SCREEN.name}"
    assert process.returncode == 3 and all(text in process.stderr for text in fragments), (
        process.stderr
    )


def plan_and_measure(folder: Path, body: Obstacle, key: str) -> tuple[float | None, float]:
    """Return the least distance (mm; None without python-fcl) and the planning time of the joint
    path (s).

    Without a clearance the arm may collide with the obstacle; the job is then infeasible, but its
    path serves as the reference.
    """
    process = run_plan(folder, body.job(key))
    assert is_path(process, key), process.stderr
    report = json.loads((folder / "out" / "report.json").read_text(encoding="utf-8"))
    return least_distance(folder, body), float(report["timing_s"]["joint_path"])


def least_distance(folder: Path, body: Obstacle) -> float | None:
    """Least distance in mm between links and obstacle along a saved path."""
    try:
        import fcl
    except ImportError:
        return None
    robot = machine.load(ROBOT)
    arm, distance = KdlLinks(robot), np.inf
    # the part stands at the deposition point and its frame is parallel to the base
    middle = (
        robot.base[:3, :3] @ (np.add(body.low, 0.5 * np.array(body.size)) + STATION)
        + robot.base[:3, 3]
    )
    box = fcl.CollisionObject(fcl.Box(*body.size), fcl.Transform(middle))
    links = [
        (number, [cylinder(fcl, rod) for rod in rods])
        for number, rods in enumerate(external_links.robot_cylinders(robot.chain))
    ]
    for q in sample_joints(folder):
        for number, rods in links[1:]:
            pose = arm.frame(q, number)
            turn, position = pose[:3, :3], pose[:3, 3]
            for solid, turned, centre in rods:
                moving = fcl.CollisionObject(
                    solid, fcl.Transform(turn @ turned, position + turn @ centre)
                )
                distance = min(
                    distance, fcl.distance(moving, box, fcl.DistanceRequest(), fcl.DistanceResult())
                )
    return max(float(distance), 0.0)
