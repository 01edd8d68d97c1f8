# SPDX-License-Identifier: LGPL-2.1-or-later
"""A ladder graph, the method of Descartes, against `cell.arm_clearance` on the same points; and a
certificate of a hemisphere. The peer is written here plainly and receives the same inputs: joints
of all rotations at all points from our closed form, our link frames, and steps from rung to rung as
arrays. At each point it asks python-fcl, for each rotation within limits and conditioning, whether
a link touches the wall or another link of our checked pairs, all enlarged by half the clearance.
The cheapest way up the ladder, bead by bead, is the exact optimum of its rotations. Ours is the
whole joint path at the same points, including the refinement and final check that the peer
lacks."""

from __future__ import annotations

import dataclasses
import time
from statistics import median
from typing import Any

import numpy as np

from freecad_am.core.geometry import frames
from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, sample_curve
from freecad_am.core.geometry.frames import TURN, shortest
from freecad_am.core.geometry.obstacles import box
from freecad_am.core.issues import has_errors
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.cell import Cell
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.links.contact import ArmContact
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.planning.joint_path import JointPath
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.points import gather
from freecad_am.core.planning.task import Task, condition_margin
from freecad_am.core.strategies.revolution import plan as revolution
from freecad_am.core.toolpath import Toolpath

from rows import Row
from sizes import choose

RADIUS, ROUNDS = 45.0, choose(3, 1)
TURNS, CLEARANCE = choose(72, 36), 10.0  # rotations of a rung; mm
CERTIFIED = 10.0  # s
LAYER_HEIGHT, LAYERS = choose((1.0, 71), (10.0, 8))  # of the certified hemisphere
ROBOT, STATION, LEAN = "fanuc-arcmate120ic", (1000.0, 0.0, -100.0), 45.0
WALL_LOW, WALL = (-130.0, 104.0, 0.0), (260.0, 12.0, 420.0)


def run() -> list[Row]:
    """Compare both in turns on the same job, then time the certificate."""
    dome, cell = hemisphere(15.0, choose(0.2, 1.0), "fixed"), cell_with_wall()
    rods, task = (
        external_links.robot_cylinders(cell.robot.chain),
        Task(cell, cell.branch or 0, JointParameters()),
    )
    rows = []
    times: list[tuple[float, float]] = []
    for _ in range(ROUNDS):
        began = time.perf_counter()
        path = plan_joints(dome, cell, task.parameters, cylinders=rods)
        ours = time.perf_counter() - began
        assert not has_errors(path.issues), path.issues
        began = time.perf_counter()
        cost = _ladder(dome, task, rods)
        times.append((ours, time.perf_counter() - began if cost is not None else np.nan))
    took, peer = (median(column) for column in zip(*times))
    has_peer = np.isfinite(peer)
    rows.append(
        Row(
            "joint path beside a wall with cell.arm_clearance, against a ladder graph of "
            f"{TURNS} rotations at the same {dome.point_count} points",
            took,
            peer if has_peer else None,
            "s",
            10.0,
        )
    )
    if cost is not None:
        rows.append(
            Row(
                "what that path costs (displacement), against the cheapest way up the ladder",
                _cost(path),
                cost,
                "rad",
                0.98,
            )
        )
    rows.append(
        Row(
            f"joint path of the hemisphere of {LAYERS} layers with its certificate",
            time_certificate(),
            CERTIFIED,
            "s",
            1.0,
        )
    )
    return rows


def hemisphere(layer_height: float, chord_error: float, mode: str) -> Toolpath:
    """Return the paper's hemisphere (Chalvin 2020, eq. 20)."""
    meridian = sample_curve(
        lambda t: (np.c_[RADIUS * np.cos(t), RADIUS * np.sin(t)], np.c_[-np.sin(t), np.cos(t)]),
        [0, np.pi / 2],
    )
    return revolution.plan(
        RevolvedWall(Meridian.chained([meridian]), np.eye(4)),
        RevolutionParameters(layer_height=layer_height, chord_error=chord_error),
        BuildDirectionParameters(mode=mode),
        ProcessParameters(),
        NozzleParameters(),
        113.0,
    )


def cell_with_wall() -> Cell:
    nozzle = NozzleParameters(
        length=60.0, tool=(120.0, 0.0, 200.0, 0.0, float(np.radians(LEAN)), 0.0)
    )
    cell = cells.resolve(
        CellParameters(
            machine=ROBOT,
            limits="paper",
            setup="tool-on-robot",
            deposition_point=(*STATION, 0.0, 0.0, 0.0),
            nozzle=nozzle,
            branch=("front", "down", "noflip"),
            arm_clearance=CLEARANCE,
        ),
        np.eye(4),
    )
    middle = np.add(WALL_LOW, 0.5 * np.array(WALL)) + STATION
    wall = box(WALL, frames.pose(np.eye(3), middle), "wall")
    return dataclasses.replace(cell, shapes=cells.CellShapes(obstacles=(wall,)))


def _cost(path: JointPath) -> float:
    return sum(bead.objective for bead in path.beads)


def time_certificate() -> float:
    """Seconds of a joint path with its certificate."""
    dome, cell = (
        hemisphere(LAYER_HEIGHT, 0.02, "local"),
        cells.resolve(CellParameters(limits="paper"), np.eye(4)),
    )
    began = time.perf_counter()
    path = plan_joints(dome, cell, JointParameters(certificate=True))
    took = time.perf_counter() - began
    assert path.optimality is not None and len(dome.layers) == LAYERS, (
        path.issues,
        len(dome.layers),
    )
    return took


def _ladder(toolpath: Toolpath, task: Task, rods: Any) -> float | None:
    """Cost of the cheapest ways up the ladders of the beads (rad); None without python-fcl."""
    try:
        import fcl
    except ImportError:
        return None
    looks, total = CollisionChecks(fcl, task.cell, rods), 0.0
    phi = np.arange(TURNS)[:, None] * (TURN / TURNS)
    for _, _, bead in toolpath:
        points = gather([bead], task.cell)
        rungs = np.broadcast_to(phi, (TURNS, len(points)))
        joints = task.raw_joints(points, rungs)
        singular = condition_margin(task.condition(points, rungs, joints), task.thresholds(points))
        stands = np.minimum(task.rows.margin(joints), singular) >= 0.0
        for turn, point in zip(*np.nonzero(stands)):
            stands[turn, point] = not looks.meet(joints[turn, point])
        best = np.where(stands[:, 0], 0.0, np.inf)
        for point in range(1, len(points)):
            step = shortest(joints[None, :, point] - joints[:, None, point - 1])
            best = (best[:, None] + np.nan_to_num(step * step @ task.weights, nan=np.inf)).min(
                axis=0
            )
            best[~stands[:, point]] = np.inf
        total += float(best.min())
    return total


class CollisionChecks:
    """Links as python-fcl cylinders enlarged by the clearance, checked against the wall and in
    pairs against each other."""

    def __init__(self, fcl: Any, cell: Cell, rods: Any) -> None:
        self.fcl, self.cell = fcl, cell
        middle = (
            cell.machine.base
            @ frames.pose(np.eye(3), np.add(WALL_LOW, 0.5 * np.array(WALL)) + STATION)
        )[:3, 3]
        self.wall = fcl.CollisionObject(fcl.Box(*np.add(WALL, CLEARANCE)), fcl.Transform(middle))
        self.cylinders = [[_cylinder(fcl, capsule) for capsule in link] for link in rods]
        self.pairs = ArmContact(cell, rods, (), None, CLEARANCE).own_links.pairs
        self.request, self.result = fcl.CollisionRequest(), fcl.CollisionResult

    def meet(self, q: np.ndarray) -> bool:
        """Return whether joint positions (axes,) collide."""
        poses = self.cell.links(q[None])[0]
        for number, link in enumerate(self.cylinders):
            for solid, rotation, centre in link:
                pose = poses[number]
                solid.setTransform(
                    self.fcl.Transform(pose[:3, :3] @ rotation, pose[:3, :3] @ centre + pose[:3, 3])
                )
                if number and self.fcl.collide(solid, self.wall, self.request, self.result()):
                    return True
        return any(
            self.fcl.collide(solid, peer, self.request, self.result())
            for outer, inner in self.pairs
            for solid, _, _ in self.cylinders[outer]
            for peer, _, _ in self.cylinders[inner]
        )


def _cylinder(fcl: Any, rod: Any) -> tuple[Any, np.ndarray, np.ndarray]:
    """Return a cylinder enlarged by half the clearance with its rotation and centre in the frame of
    its link."""
    axis = (rod.end - rod.start) / rod.length
    normal = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    normal /= np.linalg.norm(normal)
    margin = 0.5 * CLEARANCE
    cylinder = fcl.CollisionObject(
        fcl.Cylinder(rod.radius + margin, rod.length + 2.0 * margin), fcl.Transform()
    )
    return (
        cylinder,
        np.column_stack([normal, np.cross(axis, normal), axis]),
        0.5 * (rod.start + rod.end),
    )
