# SPDX-License-Identifier: LGPL-2.1-or-later
"""Puts the beads and the rapid moves between them into one motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ..issues import ERROR, Issue
from ..kinematics import opw
from ..kinematics.cell import Cell
from ..motion import Motion
from ..parameters.process import ProcessParameters
from .joint_path import BeadPath, JointPath
from .rapids import collisions

Array = NDArray[np.float64]

TURN = 2.0 * np.pi
# share of an axis's largest speed a rapid move may ask for, and the shortest time of one
RAPID_SHARE = 0.8
SHORTEST = 0.05


@dataclass(frozen=True)
class _Rows:
    """Some rows of a motion before they are joined."""

    deposit: bool
    layer: int
    bead: int
    position: Array
    build: Array
    tool: Array
    speed: Array
    width: Array
    joints: Array
    duration: Array


def assemble(joint_path: JointPath, cell: Cell, process: ProcessParameters) -> tuple[Motion, tuple[Issue, ...]]:
    """The motion of a joint path with its rapids, and what is wrong with the rapids.

    Between two beads the tool is withdrawn along its axis by `between_layers.lift`, goes to the same height above the
    next start and down onto it.
    """
    parts: list[_Rows] = []
    issues: list[Issue] = []
    before: Array | None = None
    lift, branch = process.between_layers.lift, opw.branch_index(joint_path.branch)
    for path in joint_path.beads:
        above = _lifted(path, 0, cell, branch, lift)
        if lift > 0.0 and path.reachable and np.isnan(above).any():
            issues.append(Issue(ERROR, "RAPID_UNREACHABLE", f"the point {lift:g} mm above the start of the bead cannot be "
                                "reached; lower process.between_layers.lift", path.layer, path.index))
        waypoints = [] if before is None or lift == 0.0 else [before]
        waypoints += [above, path.joints[0]] if lift > 0.0 else [path.joints[0]]
        parts.append(_rapid(path, waypoints, cell, lift))
        parts.append(_deposit(path))
        before = _lifted(path, -1, cell, branch, lift)
    last = joint_path.beads[-1]
    if lift > 0.0:
        parts.append(_retract(last, _lifted(last, -1, cell, branch, lift), lift))
    motion = _joined(parts, cell, process)
    return motion, (*issues, *collisions(motion, cell))


def _lifted(path: BeadPath, index: int, cell: Cell, branch: int, lift: float) -> Array:
    """(axes,) joints at a point of the bead withdrawn by the lift along the tool axis, in the turns of the bead."""
    arm = cell.machine.opw
    assert arm is not None
    tool = path.bead.tool[index]
    above = path.bead.points[index] + lift * tool
    flange = cell.flange_poses(above[None], tool[None], path.phi[index, None])
    joints = arm.inverse_branch(flange, branch)[0]
    moved: Array = joints + TURN * np.round((path.joints[index] - joints) / TURN)
    return moved


def _rapid(path: BeadPath, waypoints: Sequence[Array], cell: Cell, lift: float) -> _Rows:
    joints = np.array(waypoints)
    flange = cell.machine.chain.forward(np.nan_to_num(joints))
    position, tool = cell.tip_in_part(flange)
    lost = np.isnan(joints).any(axis=1)
    position[lost], tool[lost] = path.bead.points[0] + lift * path.bead.tool[0], path.bead.tool[0]
    position[-1], tool[-1] = path.bead.points[0], path.bead.tool[0]
    build = tool.copy()
    build[-1] = path.bead.build[0]
    none = np.full(len(joints), np.nan)
    return _Rows(False, path.layer, path.index, position, build, tool, none, none, joints, none)


def _retract(path: BeadPath, joints: Array, lift: float) -> _Rows:
    tool = path.bead.tool[-1:]
    none = np.full(1, np.nan)
    return _Rows(False, path.layer, path.index, path.bead.points[-1:] + lift * tool, path.bead.build[-1:], tool, none,
                 none, joints[None], none)


def _deposit(path: BeadPath) -> _Rows:
    bead = path.bead
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    duration = np.concatenate([[0.0], length / bead.speed[1:]])
    width = np.full(len(bead), np.nan) if bead.width is None else bead.width
    return _Rows(True, path.layer, path.index, bead.points, bead.build, bead.tool, bead.speed, width, path.joints, duration)


def _joined(parts: Sequence[_Rows], cell: Cell, process: ProcessParameters) -> Motion:
    counts = [len(part.joints) for part in parts]
    columns = {
        field.name: np.concatenate([getattr(part, field.name) for part in parts])
        for field in fields(_Rows) if field.name not in ("deposit", "layer", "bead")
    }
    joints, position, duration = columns["joints"], columns["position"], columns["duration"]
    distance = np.concatenate([[0.0], np.linalg.norm(np.diff(position, axis=0), axis=1)])
    turned = np.concatenate([np.zeros((1, joints.shape[1])), np.abs(np.diff(joints, axis=0))])
    by_axes = np.nan_to_num(turned / (RAPID_SHARE * cell.machine.max_speed)).max(axis=1)
    rapid = np.isnan(duration)
    shortest = np.maximum(np.maximum(distance / process.rapid_speed, by_axes), SHORTEST)
    duration = np.where(rapid, shortest, duration)
    duration[0] = 0.0
    speed = np.where(rapid, distance / np.maximum(shortest, 1e-12), columns["speed"])
    speed[0] = process.rapid_speed if rapid[0] else speed[0]
    number = {name: np.repeat([int(getattr(part, name)) for part in parts], counts) for name in ("layer", "bead")}
    return Motion(
        deposit=np.repeat([part.deposit for part in parts], counts),
        layer=number["layer"], bead=number["bead"],
        point=np.concatenate([np.arange(count) for count in counts]),
        position=position, build=columns["build"], tool=columns["tool"], speed=speed, width=columns["width"],
        joints=joints, duration=duration,
    )
