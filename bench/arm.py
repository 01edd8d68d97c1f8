# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.arm_clearance`: how near links come to what stands beside a dome, and what keeping them clear adds to planning.

A post that is a fixture, a table on which the part stands and a tall finished wall, which the same job drives links into
without the key: the library has to see that too, or it sees nothing. And a screen between robot and part, which is refused
by name. Judged by others on what was saved: joints of every row of waypoints.csv, and at nine places between two rows,
through PyKDL's chain of the machine, and distances by python-fcl between the rods of the links and the body. What moves
against links, these among themselves, is in `arm_apart`.
"""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import arm_apart
import numpy as np
from arm_jobs import CLEARANCE, EXAMPLE, box_text, carried_out, cylinder, is_path, places

from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.machines import machine
from tests.kdl_links import KdlLinks

from rows import Row
from sizes import choose

TIMES = 3.0  # the planning may take, of what it takes without
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
class Standing:
    """A box beside the part: its name, its lower corner and its edges, mm in part coordinates, the branch that is asked for,
    and whether it is a fixture."""

    name: str
    low: tuple[float, float, float]
    size: tuple[float, float, float]
    branch: str
    fixture: bool = False

    def job(self, key: str) -> str:
        """The text of a job beside it."""
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


CLEARED = (
    Standing("post", (50.0, 108.5, -5.0), (60.0, 60.0, 400.0), DOWN, fixture=True),
    Standing("table", (-500.0, -400.0, -30.0), (1000.0, 800.0, 30.0), AUTO),
    Standing("finished wall", (-130.0, 104.0, 0.0), (260.0, 12.0, 420.0), DOWN),
)
SCREEN = Standing("screen", (-470.0, -1500.0, -1400.0), (40.0, 3000.0, 3000.0), AUTO)


def run() -> list[Row]:
    """The least distance from each against what was asked for, and the time against the same without."""
    found = []
    for body in choose(CLEARED, CLEARED[:1]):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "post.stl").write_text(box_text(body.low, body.size), encoding="utf-8")
            done = [
                [_planned(folder, body, key) for key in ("", f", arm_clearance: {CLEARANCE:g} mm")]
                for _ in range(ROUNDS)
            ]
        plain, took = (median(seconds for _, seconds in some) for some in zip(*done))
        (near, _), (kept, _) = done[0]
        assert near is None or near < CLEARANCE, (
            f"nothing to keep clear of: {near:.1f} mm from the {body.name}"
        )
        found += [
            Row(
                f"least distance of links from a {body.name} by python-fcl, {0.0 if near is None else near:.1f} mm without "
                "cell.arm_clearance; what is kept",
                CLEARANCE,
                kept,
                "mm",
                1.0,
            ),
            Row(
                f"joint path beside a {body.name} with cell.arm_clearance, against {TIMES:g} times that without",
                took,
                TIMES * plain,
                "s",
                1.0,
            ),
        ]
    _refused()
    return found + arm_apart.run()


def _refused() -> None:
    """The screen, which nothing clears, is refused by name, with link, layer and bead."""
    with tempfile.TemporaryDirectory() as name:
        done = carried_out(Path(name), SCREEN.job(f", arm_clearance: {CLEARANCE:g} mm"))
    told = "error[ARM_CLEARANCE] layer 0 bead 0: ", ": link q", f"mm to {SCREEN.name}"
    assert done.returncode == 3 and all(text in done.stderr for text in told), done.stderr


def _planned(folder: Path, body: Standing, key: str) -> tuple[float | None, float]:
    """The least distance in mm, None without python-fcl, and seconds that the joint path took.

    Without a clearance the arm may be in the body, which makes the job infeasible and its path the one to compare with.
    """
    done = carried_out(folder, body.job(key))
    assert is_path(done, key), done.stderr
    report = json.loads((folder / "out" / "report.json").read_text(encoding="utf-8"))
    return _nearest(folder, body), float(report["timing_s"]["joint_path"])


def _nearest(folder: Path, body: Standing) -> float | None:
    """Least distance in mm of links from the body along a saved path."""
    try:
        import fcl
    except ImportError:
        return None
    robot = machine.load(ROBOT)
    arm, least = KdlLinks(robot), np.inf
    # the part stands at the deposition point, its frame as that of the base
    middle = (
        robot.base[:3, :3] @ (np.add(body.low, 0.5 * np.array(body.size)) + STATION)
        + robot.base[:3, 3]
    )
    box = fcl.CollisionObject(fcl.Box(*body.size), fcl.Transform(middle))
    links = [
        (number, [cylinder(fcl, rod) for rod in rods])
        for number, rods in enumerate(external_links.robot_cylinders(robot.chain))
    ]
    for q in places(folder):
        for number, rods in links[1:]:
            pose = arm.frame(q, number)
            turn, place = pose[:3, :3], pose[:3, 3]
            for solid, turned, at in rods:
                moving = fcl.CollisionObject(solid, fcl.Transform(turn @ turned, place + turn @ at))
                least = min(
                    least, fcl.distance(moving, box, fcl.DistanceRequest(), fcl.DistanceResult())
                )
    return max(float(least), 0.0)
