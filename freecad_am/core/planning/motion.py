# SPDX-License-Identifier: LGPL-2.1-or-later
"""Combine beads and the rapids between them into one motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from ..geometry.obstacles import Body
from ..issues import Issue
from ..kinematics.cell import Cell
from ..motion import DEPOSIT, Motion
from ..parameters.bead_classes import number_of
from ..parameters.joints import JointParameters
from ..parameters.process import ProcessParameters
from ..program import SHORTEST_RAPID
from ..toolpath import settings_of
from ..types import Array, Integers
from . import nozzle_obstacles
from .arm_clearance import Cylinders
from .beads.retreat import turns_back
from .joint_path import BeadPath, JointPath
from .rapids.moves_between_beads import RapidWays, Way, findings
from .rapids.retracts import Leg

RAPID_SHARE = 0.8  # fraction of the maximum axis speed that a rapid may use
OF_ALL = ("layer", "bead", "bead_class")  # fields with one value for all rows of a group


@dataclass(frozen=True, eq=False)
class _Rows:
    """A group of motion rows before joining."""

    role: Integers
    layer: int
    bead: int
    bead_class: int
    position: Array
    build: Array
    tool: Array
    speed: Array
    width: Array
    joints: Array
    duration: Array
    wire: Array
    phase: Array
    halt: Array
    settings: Array


def assemble(
    joint_path: JointPath,
    cell: Cell,
    process: ProcessParameters,
    bodies: Sequence[Body] = (),
    parameters: JointParameters | None = None,
    layer_height: float = 0.0,
    cylinders: Cylinders = (),
) -> tuple[Motion, tuple[Issue, ...]]:
    """Return the motion of a joint path, including its rapids.

    Between two beads the tool retracts along its axis by `between_layers.lift`, travels to the same
    height above the next start and approaches along its axis. A continuous axis that rotates far
    does so in several moves. If limits, reach or condition rule out this path, `retracts` chooses
    another. If the nozzle would hit an obstacle, it retracts further, up to outside the sphere
    around all obstacles, and then in other directions.

    Parameters
    ----------
    joint_path : JointPath
        The joint path.
    cell : Cell
        The cell.
    process : ProcessParameters
        The process, including lift and bead sizes.
    bodies : sequence of Body, optional
        Obstacles in part coordinates.
    parameters : JointParameters or None, optional
        Joint planning parameters, for the minimum condition; None for the defaults.
    layer_height : float, optional
        Height of beads without a height, mm.
    cylinders : Cylinders, optional
        Cylinders around each robot link; kept clear like the nozzle if `cell.arm_clearance` is
        set.

    Returns
    -------
    motion : Motion
        Rapids and beads in execution order.
    issues : tuple of Issue
        Issues for rapids that are infeasible or hit an obstacle.
    """
    rapids = RapidWays(
        joint_path,
        cell,
        process.between_layers.lift,
        bodies,
        parameters or JointParameters(),
        process.bead_width,
        layer_height,
        cylinders,
    )
    row_groups: list[_Rows] = []
    for number, path in enumerate(joint_path.beads):
        row_groups += [
            _rapid(path, rapids.ways[number], rapids.legs[2 * number], cell),
            _deposit(path),
        ]
    if len(rapids.ways[-1].joints):
        last_leg = 2 * len(joint_path.beads) - 1
        row_groups.append(_retract(joint_path.beads[-1], rapids.ways[-1], rapids.legs[last_leg]))
    motion = _join_rows(row_groups, cell, process)
    return motion, (*findings(rapids), *nozzle_obstacles.findings(motion, cell))


def _place(path: BeadPath) -> tuple[int, int, int]:
    """Return layer, bead index and bead class of a path."""
    return path.layer, path.index, number_of(path.bead.role.bead_class)


def _rapid(path: BeadPath, rapid: Way, onto: Leg | None, cell: Cell) -> _Rows:
    joints = rapid.joints
    flange = cell.machine.chain.forward(np.nan_to_num(joints))
    position, tool = cell.tip_in_part(flange)
    unreachable = np.isnan(joints).any(axis=1)
    height = 0.0 if onto is None else onto.height
    position[unreachable], tool[unreachable] = (
        path.bead.points[0] + height * path.bead.tool[0],
        path.bead.tool[0],
    )
    position[-1], tool[-1] = path.bead.points[0], path.bead.tool[0]
    build = tool.copy()
    build[-1] = path.bead.build[0]
    none, zero = np.full(len(joints), np.nan), np.zeros(len(joints))
    return _Rows(
        rapid.role,
        *_place(path),
        position,
        build,
        tool,
        none,
        none,
        joints,
        none,
        none,
        zero,
        zero,
        zero,
    )


def _retract(path: BeadPath, rapid: Way, leg: Leg | None) -> _Rows:
    assert leg is not None
    count = len(rapid.joints)
    tool, build = (
        np.repeat(column[-1:], count, axis=0) for column in (path.bead.tool, path.bead.build)
    )
    none, zero = np.full(count, np.nan), np.zeros(count)
    return _Rows(
        rapid.role,
        *_place(path),
        leg.position,
        build,
        tool,
        none,
        none,
        rapid.joints,
        none,
        none,
        zero,
        zero,
        zero,
    )


def _deposit(path: BeadPath) -> _Rows:
    bead = path.bead
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    duration = np.concatenate([[0.0], length / bead.speed[1:]])
    width = np.full(len(bead), np.nan) if bead.width is None else bead.width
    wire = np.full(len(bead), np.nan) if bead.wire_share is None else bead.wire_share * bead.speed
    return _Rows(
        np.full(len(bead), DEPOSIT),
        *_place(path),
        bead.points,
        bead.build,
        bead.tool,
        bead.speed,
        width,
        path.joints,
        duration,
        wire,
        np.zeros(len(bead)) if bead.phase is None else bead.phase,
        turns_back(bead),
        settings_of(bead),
    )


def _join_rows(row_groups: Sequence[_Rows], cell: Cell, process: ProcessParameters) -> Motion:
    counts = [len(rows.joints) for rows in row_groups]
    columns = {
        field.name: np.concatenate([getattr(rows, field.name) for rows in row_groups])
        for field in fields(_Rows)
        if field.name not in OF_ALL
    }
    joints, position, duration = columns["joints"], columns["position"], columns["duration"]
    speed = columns["speed"]
    rapid = np.flatnonzero(np.isnan(duration))
    previous = np.maximum(rapid - 1, 0)
    distance = np.linalg.norm(position[rapid] - position[previous], axis=1)
    turned = np.abs(joints[rapid] - joints[previous])
    by_axes = np.nan_to_num(turned / (RAPID_SHARE * cell.machine.max_speed)).max(axis=1)
    shortest = np.maximum(np.maximum(distance / process.rapid_speed, by_axes), SHORTEST_RAPID)
    duration[rapid], speed[rapid] = shortest, distance / np.maximum(shortest, 1e-12)
    if len(rapid) and rapid[0] == 0:
        speed[0] = process.rapid_speed
    duration[0] = 0.0
    number = {
        name: np.repeat([int(getattr(rows, name)) for rows in row_groups], counts)
        for name in OF_ALL
    }
    return Motion(
        deposit=columns["role"] == DEPOSIT,
        **number,
        point=np.concatenate([np.arange(count) for count in counts]),
        position=position,
        build=columns["build"],
        tool=columns["tool"],
        speed=speed,
        width=columns["width"],
        joints=joints,
        duration=duration,
        wire=columns["wire"],
        role=columns["role"],
        phase=np.nan_to_num(columns["phase"]).astype(np.int64),
        halt=columns["halt"] > 0.0,
        settings=columns["settings"].astype(np.int64),
    )
