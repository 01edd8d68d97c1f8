# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.arm_clearance` between moving bodies: links of a robot against each other, the torch on the
flange and the bodies of a positioner. Without the key the links of each job come nearer than the
clearance; the library must detect that too, or its result proves nothing. Other libraries judge the
saved files: PyKDL's chains of robot and positioner give the bodies for every row of waypoints.csv
and nine joint positions between two rows; python-fcl gives distances between link capsules, the
boxes of the torch's file, and the boxes and cylinders of the positioner's file. The benchmark finds
the link pairs that the manual's rule omits from its own random joint positions within the
limits."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from arm_jobs import CLEARANCE, EXAMPLE, box_text, cylinder, is_path, run_plan, sample_joints

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics.external import MECHANISMS
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.types import Array
from tests.core.kinematics.test_external_links import mechanism
from tests.kdl_links import KdlLinks

from rows import Row
from sizes import choose

POSITIONS = choose(1000, 50)  # random joint positions that decide which link pairs the rule omits
JOB = """version: 1
name: arm
part: {{file: {step}}}
strategy: {{kind: revolution, layer_height: 15 mm, chord_error: 0.2 mm}}
build_direction: {direction}
cell: {{machine: {robot}, setup: tool-on-robot, {cell}, nozzle: {nozzle}{key}}}
program: {{post: none}}
"""


@dataclass(frozen=True)
class MovingBodies:
    """A job: its description, robot, `cell` keys, tool pose on the flange (mm, deg), boxes (low,
    size) of a torch file (mm, Z out of the nozzle), and a positioner with its pose."""

    name: str
    robot: str
    cell: str
    tool: tuple[float, ...]
    direction: str = "{mode: fixed}"
    torch: tuple[tuple[tuple[float, ...], tuple[float, ...]], ...] = ()
    positioner: tuple[str, tuple[float, ...]] | None = None
    nozzle: str = "length: 60 mm"

    def job(self, key: str) -> str:
        """Return the text of the job with further keys in `cell`."""
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
    MovingBodies(
        "forearm and wrist of a UR5e",
        "ur-ur5e",
        "platform_diameter: 0 mm, deposition_point: [470, 20, -80, 0, 0, 0]",
        ACROSS,
    ),
    MovingBodies(
        "forearm and wrist of a UR10e",
        "ur-ur10e",
        "platform_diameter: 0 mm, deposition_point: [590, -260, -180, 0, 0, 0]",
        ACROSS,
    ),
    MovingBodies(
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
    MovingBodies(
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
    """Compare the least distance of each job with the clearance."""
    rows = []
    for job in choose(JOBS, JOBS[:1]):
        distance, kept_distance = (
            plan_and_measure(job, key) for key in ("", f", arm_clearance: {CLEARANCE:g} mm")
        )
        assert distance is None or distance < CLEARANCE, (
            f"nothing to keep apart: {distance:.1f} mm between {job.name}"
        )
        rows.append(
            Row(
                f"least distance between {job.name} by python-fcl, {0.0 if distance is None else distance:.1f} mm without "
                "cell.arm_clearance; what is kept",
                CLEARANCE,
                kept_distance,
                "mm",
                1.0,
            )
        )
    return rows


def plan_and_measure(job: MovingBodies, key: str) -> float | None:
    """Return the least distance (mm) along the path of a job, None without python-fcl."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if job.torch:
            text = "".join(box_text(low, size) for low, size in job.torch)
            (folder / "torch.stl").write_text(text, encoding="utf-8")
        process = run_plan(folder, job.job(key))
        assert is_path(process, key), process.stderr
        try:
            import fcl
        except ImportError:
            return None
        return least_distance(fcl, job, sample_joints(folder))


@dataclass(frozen=True)
class Solid:
    """A convex solid of the library, its pose in the frame of its link, and its bounding radius."""

    solid: Any
    pose: Array
    radius: float


def least_distance(fcl: Any, job: MovingBodies, joints: Array) -> float:
    """Return the least distance (mm) between the checked pairs for joint positions (k, axes)."""
    robot = machine.load(job.robot)
    links = [
        [_rod(fcl, rod) for rod in rods] for rods in external_links.robot_cylinders(robot.chain)
    ]
    last_link, arm = len(links) - 1, KdlLinks(robot)

    def link_poses(q: Array) -> list[Array]:
        return [
            frames.inverse(robot.base) @ arm.frame(q, number) for number in range(last_link + 1)
        ]

    # robot links that no joint connects and no stop of one axis separates
    candidates = [
        (first, second)
        for first, second in combinations(range(last_link + 1), 2)
        if second - first > 1 and (first, second) not in ((0, 2), (last_link - 2, last_link))
    ]
    pairs = select_separable(fcl, robot, links, link_poses, candidates)
    things = list(links)
    if job.torch:
        pairs += [(first, len(things)) for first in range(last_link - 1)]
        things.append(
            [_box(fcl, size, np.add(low, 0.5 * np.array(size))) for low, size in job.torch]
        )
    if job.positioner is not None:
        bodies = _bodies(fcl, job.positioner[0])
        pairs += [
            (link, len(things) + body)
            for link in range(1, last_link + 1)
            for body in range(len(bodies))
        ]
        things += bodies
    tool = frames.bryant([*job.tool[:3], *np.radians(job.tool[3:])])

    def body_poses(q: Array) -> list[Array]:
        poses = link_poses(q)
        poses += [frames.inverse(robot.base) @ arm.frame(q) @ tool] if job.torch else []
        return poses + ([] if job.positioner is None else mechanism(*job.positioner, q[last_link:]))

    distance = np.inf
    for q in joints:
        poses_of_bodies = body_poses(q)
        for first, second in pairs:
            distance = body_distance(
                fcl,
                (things[first], poses_of_bodies[first]),
                (things[second], poses_of_bodies[second]),
                distance,
            )
    return max(float(distance), 0.0)


def select_separable(
    fcl: Any,
    robot: machine.Machine,
    links: Sequence[Sequence[Solid]],
    link_poses: Callable[[Array], list[Array]],
    pairs: Sequence[tuple[int, int]],
) -> list[tuple[int, int]]:
    """Select the link pairs that are nearer than the clearance in at most half of the positions."""
    limits, axes = robot.limits(machine.MAKER), len(robot.axes)
    joints = np.random.default_rng(15).uniform(
        np.maximum(limits.lower, -np.pi), np.minimum(limits.upper, np.pi), (POSITIONS, axes)
    )
    near_count = np.zeros(len(pairs))
    for q in joints:
        poses = link_poses(q)
        near_count += [
            body_distance(
                fcl, (links[first], poses[first]), (links[second], poses[second]), CLEARANCE
            )
            < CLEARANCE
            for first, second in pairs
        ]
    return [pair for pair, share in zip(pairs, near_count / POSITIONS) if share <= 0.5]


def body_distance(
    fcl: Any,
    body: tuple[Sequence[Solid], Array],
    peer_body: tuple[Sequence[Solid], Array],
    limit: float,
) -> float:
    """Return the distance (mm) between two bodies, each a list of solids with its pose, but at most
    `limit`."""
    for solid in body[0]:
        for peer_solid in peer_body[0]:
            pose, peer_pose = body[1] @ solid.pose, peer_body[1] @ peer_solid.pose
            if (
                np.linalg.norm(pose[:3, 3] - peer_pose[:3, 3]) - solid.radius - peer_solid.radius
                < limit
            ):
                solids = [
                    fcl.CollisionObject(
                        member.solid, fcl.Transform(member_pose[:3, :3], member_pose[:3, 3])
                    )
                    for member, member_pose in ((solid, pose), (peer_solid, peer_pose))
                ]
                limit = min(
                    limit, fcl.distance(*solids, fcl.DistanceRequest(), fcl.DistanceResult())
                )
    return limit


def _rod(fcl: Any, rod: Any) -> Solid:
    solid, turned, centre = cylinder(fcl, rod)
    return Solid(solid, frames.pose(turned, centre), float(np.hypot(0.5 * rod.length, rod.radius)))


def _box(fcl: Any, size: Sequence[float], middle: Array) -> Solid:
    return Solid(fcl.Box(*size), frames.pose(np.eye(3), middle), 0.5 * float(np.linalg.norm(size)))


def _bodies(fcl: Any, name: str) -> list[list[Solid]]:
    """Read the boxes and cylinders of each link of a mechanism file, the base first."""
    bodies = json.loads((MECHANISMS / f"{name}.json").read_text(encoding="utf-8"))["bodies"]
    return [
        [read_solid(fcl, shape) for shape in bodies.get(link, ())]
        for link in ("base", *(link for link in bodies if link not in ("base", "source")))
    ]


def read_solid(fcl: Any, shape: dict[str, Sequence[float]]) -> Solid:
    pose = frames.from_rpy(
        shape.get("origin", (0.0,) * 3), np.radians(shape.get("rpy", (0.0,) * 3))
    )
    if "box" in shape:
        return Solid(fcl.Box(*shape["box"]), pose, 0.5 * float(np.linalg.norm(shape["box"])))
    diameter, length = shape["cylinder"]
    return Solid(
        fcl.Cylinder(0.5 * diameter, length), pose, 0.5 * float(np.hypot(diameter, length))
    )
