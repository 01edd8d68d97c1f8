# SPDX-License-Identifier: LGPL-2.1-or-later
"""Puts the beads and the rapid moves between them into one motion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ..geometry.surroundings import Body
from ..issues import ERROR, NOTE, Issue
from ..kinematics import opw
from ..kinematics.cell import Cell
from ..motion import APPROACH, DEPOSIT, RETRACT, TRAVEL, Motion
from ..parameters.process import ProcessParameters
from . import table
from .joint_path import BeadPath, JointPath
from .rapids import collisions

Array = NDArray[np.float64]

TURN = 2.0 * np.pi
# share of an axis's largest speed a rapid move may ask for, and the shortest time of one
RAPID_SHARE = 0.8
SHORTEST = 0.05
# largest turn of an endless axis in one rapid move, rad: such an axis takes the shorter way, so half a turn is in doubt
LARGEST_TURN = np.radians(170.0)
# how many times the lift is tried where the nozzle would meet the deposit, and further, beyond everything that is there
HIGHER = (1.5, 2.0, 3.0, 4.0, 6.0, 8.0)
FURTHER = 1.5


@dataclass(frozen=True)
class _Rows:
    """Some rows of a motion before they are joined."""

    role: NDArray[np.int64]
    layer: int
    bead: int
    position: Array
    build: Array
    tool: Array
    speed: Array
    width: Array
    joints: Array
    duration: Array
    wire: Array


def assemble(
    joint_path: JointPath, cell: Cell, process: ProcessParameters, bodies: Sequence[Body] = ()
) -> tuple[Motion, tuple[Issue, ...]]:
    """The motion of a joint path with its rapids, and what is wrong with the rapids.

    Between two beads the tool is withdrawn along its axis by `between_layers.lift`, goes to the same height above the
    next start and down onto it; an endless axis that turns far on the way does so in several moves. Where the nozzle
    would meet the deposit, the platform or one of the bodies (in part coordinates) on its way it is withdrawn further, as
    far as it takes, up to beyond the sphere about all of these; where no height does, or the robot cannot reach it, that is
    an issue.
    """
    lift = process.between_layers.lift
    lifts = np.full(len(joint_path.beads), lift)
    motion = _with_rapids(joint_path, cell, process, lifts)
    met = collisions(motion, cell, bodies=bodies)
    for height in _heights(joint_path, cell, lift, bodies):
        if not met:
            break
        higher = lifts.copy()
        higher[_numbers(joint_path, met)] = height
        tried = _with_rapids(joint_path, cell, process, higher)
        lost = ~tried.reachable & ~tried.deposit
        # a height out of reach is no help: those beads stay as they were
        for number in np.flatnonzero(higher != lifts):
            path = joint_path.beads[number]
            if lost[(tried.layer == path.layer) & (tried.bead == path.index)].any():
                higher[number] = lifts[number]
        lifts = higher
        motion = _with_rapids(joint_path, cell, process, lifts)
        met = collisions(motion, cell, {(int(i.layer or 0), int(i.bead or 0)) for i in met}, bodies)
    return motion, (*met, *_out_of_reach(joint_path, motion), *_lift_notes(joint_path, lifts, lift))


def _heights(joint_path: JointPath, cell: Cell, lift: float, bodies: Sequence[Body]) -> list[float]:
    """The lifts to try after the given one, mm, up to where the nozzle is beyond the sphere about all that is there."""
    if lift <= 0.0 or not joint_path.beads:
        return []
    radius = 0.5 * cell.platform_diameter
    x, y, origin = cell.mount[:3, 0], cell.mount[:3, 1], cell.mount[:3, 3]
    platform = [origin + radius * (a * x + b * y) for a in (-1.0, 1.0) for b in (-1.0, 1.0)]
    points = np.vstack([*(path.bead.points for path in joint_path.beads), platform, *(body.vertices for body in bodies)])
    # from anywhere inside, a way of the diameter along any direction leads out of it
    furthest = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
    heights = [factor * lift for factor in HIGHER]
    while heights[-1] < furthest:
        heights.append(min(FURTHER * heights[-1], furthest))
    return heights


def _numbers(joint_path: JointPath, met: Sequence[Issue]) -> list[int]:
    """Which beads of the path the issues are about."""
    places = {(issue.layer, issue.bead) for issue in met}
    return [k for k, path in enumerate(joint_path.beads) if (path.layer, path.index) in places]


def _out_of_reach(joint_path: JointPath, motion: Motion) -> list[Issue]:
    reachable = {(path.layer, path.index) for path in joint_path.beads if path.reachable}
    lost = np.flatnonzero(~motion.deposit & ~motion.reachable)
    places = dict.fromkeys((int(motion.layer[row]), int(motion.bead[row])) for row in lost)
    return [
        Issue(ERROR, "RAPID_UNREACHABLE", "the lifted points before or after the bead cannot be reached; lower "
              "process.between_layers.lift", layer, bead)
        for layer, bead in places if (layer, bead) in reachable
    ]


def _lift_notes(joint_path: JointPath, lifts: Array, lift: float) -> list[Issue]:
    raised = np.flatnonzero(lifts > lift)
    if not len(raised):
        return []
    text = (f"before {len(raised)} beads the tool is withdrawn by up to {lifts.max():.3g} mm instead of {lift:g} mm to pass "
            "clear")
    return [Issue(NOTE, "RAPID_LIFTED", text, joint_path.beads[raised[0]].layer)]


def _with_rapids(joint_path: JointPath, cell: Cell, process: ProcessParameters, lifts: Array) -> Motion:
    """The motion with the tool withdrawn by lifts (beads,) mm before each bead, and by the first of them at the end."""
    branch = None if cell.machine.is_table else opw.branch_index(joint_path.branch)
    parts: list[_Rows] = []
    before: BeadPath | None = None
    for path, lift in zip(joint_path.beads, lifts):
        waypoints, roles = [path.joints[0]], [TRAVEL]
        if lift > 0.0:
            waypoints, roles = [_lifted(path, 0, cell, branch, lift), *waypoints], [TRAVEL, APPROACH]
            if before is not None:
                waypoints, roles = [_lifted(before, -1, cell, branch, lift), *waypoints], [RETRACT, *roles]
        if before is not None:
            waypoints, roles = _shorter_turns([before.joints[-1], *waypoints], roles, cell.limits.endless)
        parts.append(_rapid(path, waypoints, roles, cell, lift))
        parts.append(_deposit(path))
        before = path
    if before is not None and process.between_layers.lift > 0.0:
        lift = process.between_layers.lift
        parts.append(_retract(before, _lifted(before, -1, cell, branch, lift), lift))
    return _joined(parts, cell, process)


def _lifted(path: BeadPath, index: int, cell: Cell, branch: int | None, lift: float) -> Array:
    """(axes,) joints at a point of the bead withdrawn by the lift along the tool axis, in the turns of the bead."""
    if branch is None:
        return table.lifted(cell, path.joints[index], path.bead.points[index], path.bead.tool[index], lift)
    arm = cell.machine.opw
    assert arm is not None
    tool = path.bead.tool[index]
    above = path.bead.points[index] + lift * tool
    flange = cell.flange_poses(above[None], tool[None], path.phi[index, None])
    joints = arm.inverse_branch(flange, branch)[0]
    moved: Array = joints + TURN * np.round((path.joints[index] - joints) / TURN)
    return moved


def _shorter_turns(
    waypoints: Sequence[Array], roles: Sequence[int], endless: NDArray[np.bool_]
) -> tuple[list[Array], list[int]]:
    """The waypoints after the first and their roles, with more on the straight way in the joints where an endless axis would
    turn too far at once."""
    result, of = [], []
    for start, end, role in zip(waypoints[:-1], waypoints[1:], roles):
        turn = float(np.nan_to_num(np.abs(end - start)[endless]).max(initial=0.0))
        moves = max(1, math.ceil(turn / LARGEST_TURN))
        result += [start + (end - start) * (k / moves) for k in range(1, moves)] + [end]
        of += [role] * moves
    return result, of


def _rapid(path: BeadPath, waypoints: Sequence[Array], roles: Sequence[int], cell: Cell, lift: float) -> _Rows:
    joints = np.array(waypoints)
    flange = cell.machine.chain.forward(np.nan_to_num(joints))
    position, tool = cell.tip_in_part(flange)
    lost = np.isnan(joints).any(axis=1)
    position[lost], tool[lost] = path.bead.points[0] + lift * path.bead.tool[0], path.bead.tool[0]
    position[-1], tool[-1] = path.bead.points[0], path.bead.tool[0]
    build = tool.copy()
    build[-1] = path.bead.build[0]
    none = np.full(len(joints), np.nan)
    return _Rows(np.array(roles), path.layer, path.index, position, build, tool, none, none, joints, none, none)


def _retract(path: BeadPath, joints: Array, lift: float) -> _Rows:
    tool = path.bead.tool[-1:]
    none = np.full(1, np.nan)
    return _Rows(np.array([RETRACT]), path.layer, path.index, path.bead.points[-1:] + lift * tool, path.bead.build[-1:],
                 tool, none, none, joints[None], none, none)


def _deposit(path: BeadPath) -> _Rows:
    bead = path.bead
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    duration = np.concatenate([[0.0], length / bead.speed[1:]])
    width = np.full(len(bead), np.nan) if bead.width is None else bead.width
    wire = np.full(len(bead), np.nan) if bead.wire_share is None else bead.wire_share * bead.speed
    return _Rows(
        np.full(len(bead), DEPOSIT), path.layer, path.index, bead.points, bead.build, bead.tool, bead.speed, width,
        path.joints, duration, wire,
    )


def _joined(parts: Sequence[_Rows], cell: Cell, process: ProcessParameters) -> Motion:
    counts = [len(part.joints) for part in parts]
    columns = {
        field.name: np.concatenate([getattr(part, field.name) for part in parts])
        for field in fields(_Rows) if field.name not in ("layer", "bead")
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
        deposit=columns["role"] == DEPOSIT,
        layer=number["layer"], bead=number["bead"],
        point=np.concatenate([np.arange(count) for count in counts]),
        position=position, build=columns["build"], tool=columns["tool"], speed=speed, width=columns["width"],
        joints=joints, duration=duration, wire=columns["wire"], role=columns["role"],
    )
