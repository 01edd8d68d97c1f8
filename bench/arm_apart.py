# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.arm_clearance` between what moves: links of a robot against each other, against the torch on its flange, and against
the bodies of a positioner.

In each job links come nearer than is kept as soon as the key is left out: the library has to see that too, or it sees
nothing. Judged by others on what was saved: joints of every row of waypoints.csv, and at nine places between two rows,
through PyKDL's chains of robot and positioner, and distances by python-fcl between the rods of links, the boxes that the
torch's file shows, and the boxes and cylinders of the positioner's file. Pairs of links that the rule of the manual leaves
out are found here by positions of the bench's own, at random within the limits.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from arm_jobs import CLEARANCE, EXAMPLE, box_text, carried_out, cylinder, is_path, places

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics.external import MECHANISMS
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.types import Array
from tests.core.kinematics.test_external_links import mechanism
from tests.kdl_links import KdlLinks

from rows import Row
from sizes import choose

POSITIONS = choose(1000, 50)  # at random, by which pairs are found that the rule leaves out
JOB = """version: 1
name: arm
part: {{file: {step}}}
strategy: {{kind: revolution, layer_height: 15 mm, chord_error: 0.2 mm}}
build_direction: {direction}
cell: {{machine: {robot}, setup: tool-on-robot, {cell}, nozzle: {nozzle}{key}}}
program: {{post: none}}
"""


@dataclass(frozen=True)
class Moving:
    """A job: what is told of it, its robot, the words of its cell, the pose of its tool on the flange, mm and deg; boxes
    (low, size) of a torch's file, mm, Z out of the nozzle; a positioner with its pose."""

    name: str
    robot: str
    cell: str
    tool: tuple[float, ...]
    direction: str = "{mode: fixed}"
    torch: tuple[tuple[tuple[float, ...], tuple[float, ...]], ...] = ()
    positioner: tuple[str, tuple[float, ...]] | None = None
    nozzle: str = "length: 60 mm"

    def job(self, key: str) -> str:
        """The text of the job, with words that follow in `cell`."""
        shape = ", shape: {file: torch.stl}" if self.torch else ""
        beside = (
            ""
            if self.positioner is None
            else (
                f", external: [{{machine: {self.positioner[0]}, pose: {list(self.positioner[1])}, carries: part}}]"
            )
        )
        return JOB.format(
            step=EXAMPLE,
            robot=self.robot,
            direction=self.direction,
            cell=self.cell + beside,
            key=key,
            nozzle=f"{{{self.nozzle}, tool: {list(self.tool)}{shape}}}",
        )


ACROSS = (0.0, 0.0, 200.0, 0.0, 90.0, 0.0)
JOBS = (
    Moving(
        "forearm and wrist of a UR5e",
        "ur-ur5e",
        "platform_diameter: 0 mm, deposition_point: [470, 20, -80, 0, 0, 0]",
        ACROSS,
    ),
    Moving(
        "forearm and wrist of a UR10e",
        "ur-ur10e",
        "platform_diameter: 0 mm, deposition_point: [590, -260, -180, 0, 0, 0]",
        ACROSS,
    ),
    Moving(
        "torch and links",
        "ur-ur10e",
        "platform_diameter: 0 mm, deposition_point: [550, 0, -100, 0, 0, 0]",
        ACROSS,
        torch=(
            ((-3.0, -3.0, -250.0), (6.0, 6.0, 250.0)),
            ((-130.0, -60.0, -420.0), (80.0, 120.0, 300.0)),
        ),
        nozzle="length: 60 mm, diameter: 10 mm",
    ),
    Moving(
        "links and positioner",
        "kuka-kr8-r2100-2-arc-hw",
        "branch: auto, platform: 5 mm",
        (0.0, 0.0, 90.0, 0.0, 34.4, 0.0),
        "{max_from_vertical: 10 deg}",
        positioner=("motoman-motopos-d500", (1400.0, 120.0, -50.0, 0.0, 0.0, 30.0)),
        nozzle="length: 80 mm",
    ),
)


def run() -> list[Row]:
    """The least distance between what is kept apart, of each job, against what was asked for."""
    found = []
    for job in choose(JOBS, JOBS[:1]):
        near, kept = (_judged(job, key) for key in ("", f", arm_clearance: {CLEARANCE:g} mm"))
        assert near is None or near < CLEARANCE, (
            f"nothing to keep apart: {near:.1f} mm between {job.name}"
        )
        found.append(
            Row(
                f"least distance between {job.name} by python-fcl, {0.0 if near is None else near:.1f} mm without "
                "cell.arm_clearance; what is kept",
                CLEARANCE,
                kept,
                "mm",
                1.0,
            )
        )
    return found


def _judged(job: Moving, key: str) -> float | None:
    """The least distance in mm on what a job writes, None without python-fcl."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if job.torch:
            text = "".join(box_text(low, size) for low, size in job.torch)
            (folder / "torch.stl").write_text(text, encoding="utf-8")
        done = carried_out(folder, job.job(key))
        assert is_path(done, key), done.stderr
        try:
            import fcl
        except ImportError:
            return None
        return _least(fcl, job, places(folder))


@dataclass(frozen=True)
class Piece:
    """A convex solid of the library, where it is in the frame of what it belongs to, and the radius of a ball about it."""

    solid: Any
    pose: Array
    radius: float


def _least(fcl: Any, job: Moving, joints: Array) -> float:
    """The least distance in mm with joints (k, axes) between what is kept apart."""
    robot = machine.load(job.robot)
    links = [
        [_rod(fcl, rod) for rod in rods] for rods in external_links.robot_cylinders(robot.chain)
    ]
    last, arm = len(links) - 1, KdlLinks(robot)

    def of_links(q: Array) -> list[Array]:
        return [frames.inverse(robot.base) @ arm.frame(q, number) for number in range(last + 1)]

    # of a robot those that no joint connects and no stop of one axis keeps apart
    free = [
        (one, other)
        for one, other in combinations(range(last + 1), 2)
        if other - one > 1 and (one, other) not in ((0, 2), (last - 2, last))
    ]
    pairs = _not_mostly_near(fcl, robot, links, of_links, free)
    things = list(links)
    if job.torch:
        pairs += [(one, len(things)) for one in range(last - 1)]
        things.append(
            [_box(fcl, size, np.add(low, 0.5 * np.array(size))) for low, size in job.torch]
        )
    if job.positioner is not None:
        bodies = _bodies(fcl, job.positioner[0])
        pairs += [
            (link, len(things) + body) for link in range(1, last + 1) for body in range(len(bodies))
        ]
        things += bodies
    tool = frames.bryant([*job.tool[:3], *np.radians(job.tool[3:])])

    def of_all(q: Array) -> list[Array]:
        found = of_links(q)
        found += [frames.inverse(robot.base) @ arm.frame(q) @ tool] if job.torch else []
        return found + ([] if job.positioner is None else mechanism(*job.positioner, q[last:]))

    least = np.inf
    for q in joints:
        at = of_all(q)
        for one, other in pairs:
            least = _apart(fcl, (things[one], at[one]), (things[other], at[other]), least)
    return max(float(least), 0.0)


def _not_mostly_near(
    fcl: Any,
    robot: machine.Machine,
    links: Sequence[Sequence[Piece]],
    of_links: Callable[[Array], list[Array]],
    pairs: Sequence[tuple[int, int]],
) -> list[tuple[int, int]]:
    """Of pairs of links those that are nearer than the clearance in no more than half of all positions."""
    limits, axes = robot.limits(machine.MAKER), len(robot.axes)
    joints = np.random.default_rng(15).uniform(
        np.maximum(limits.lower, -np.pi), np.minimum(limits.upper, np.pi), (POSITIONS, axes)
    )
    near = np.zeros(len(pairs))
    for q in joints:
        at = of_links(q)
        near += [
            _apart(fcl, (links[one], at[one]), (links[other], at[other]), CLEARANCE) < CLEARANCE
            for one, other in pairs
        ]
    return [pair for pair, share in zip(pairs, near / POSITIONS) if share <= 0.5]


def _apart(
    fcl: Any, one: tuple[Sequence[Piece], Array], other: tuple[Sequence[Piece], Array], least: float
) -> float:
    """The distance in mm of two things, pieces and their frame, where it is less than another."""
    for first in one[0]:
        for second in other[0]:
            here, there = one[1] @ first.pose, other[1] @ second.pose
            if np.linalg.norm(here[:3, 3] - there[:3, 3]) - first.radius - second.radius < least:
                solids = [
                    fcl.CollisionObject(piece.solid, fcl.Transform(at[:3, :3], at[:3, 3]))
                    for piece, at in ((first, here), (second, there))
                ]
                least = min(
                    least, fcl.distance(*solids, fcl.DistanceRequest(), fcl.DistanceResult())
                )
    return least


def _rod(fcl: Any, rod: Any) -> Piece:
    solid, turned, at = cylinder(fcl, rod)
    return Piece(solid, frames.pose(turned, at), float(np.hypot(0.5 * rod.length, rod.radius)))


def _box(fcl: Any, size: Sequence[float], middle: Array) -> Piece:
    return Piece(fcl.Box(*size), frames.pose(np.eye(3), middle), 0.5 * float(np.linalg.norm(size)))


def _bodies(fcl: Any, name: str) -> list[list[Piece]]:
    """Of each link of a mechanism, the base first, the boxes and cylinders of its file."""
    told = json.loads((MECHANISMS / f"{name}.json").read_text(encoding="utf-8"))["bodies"]
    return [
        [_of_file(fcl, piece) for piece in told.get(link, ())]
        for link in ("base", *(link for link in told if link not in ("base", "source")))
    ]


def _of_file(fcl: Any, piece: dict[str, Sequence[float]]) -> Piece:
    pose = frames.from_rpy(
        piece.get("origin", (0.0,) * 3), np.radians(piece.get("rpy", (0.0,) * 3))
    )
    if "box" in piece:
        return Piece(fcl.Box(*piece["box"]), pose, 0.5 * float(np.linalg.norm(piece["box"])))
    diameter, length = piece["cylinder"]
    return Piece(
        fcl.Cylinder(0.5 * diameter, length), pose, 0.5 * float(np.hypot(diameter, length))
    )
