# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell that a machine is given until somebody says what it really has.

Of a robot that carries the part: where the deposition point may well be, and the branch to work in. Points before the
robot are tried on a grid in the plane of its arm. At each the robot holds a ball of deposit from upright to lying, turned
about the tool axis however suits it; what counts is the worst of these poses: how near an axis comes to a limit, the
wrist to being stretched and the arm to its reach. Axis 6 is left out: it turns the part, so where on the ball one looks
decides it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..geometry import frames
from ..parameters.cell import CellParameters, Pose
from . import machine as machines
from . import opw
from .cell import PART_ON_ROBOT, ROTARY_TABLE, resolve
from .limits import margins
from .machine import Machine

Array = NDArray[np.float64]

TILTS = np.radians([0.0, 30.0, 60.0, 85.0])  # of the tool axis on the part
BALL = 50.0  # mm, radius of the deposit held
TURNS = 36  # rotations about the tool axis that are tried
AHEAD = np.linspace(0.4, 0.85, 8)  # of the reach, from axis 2 on
ABOVE = np.linspace(-0.5, 0.7, 9)


def cell_of(machine: str, folders: Sequence[str] = ()) -> CellParameters:
    """The parameters of a cell with a machine, '' for the default one, whose cell is that of the papers. InputError for an
    unknown one."""
    default = CellParameters()
    chosen = replace(default, machine=machine or default.machine)
    if machines.load(chosen.machine, tuple(folders)).is_table:
        return replace(chosen, setup=ROTARY_TABLE)
    return default if chosen == default else proposed(chosen, folders)


def proposed(parameters: CellParameters, folders: Sequence[str] = ()) -> CellParameters:
    """The cell with the deposition point, on whole mm, and the branch that serve best; as it is where none serves, or the
    robot does not carry the part. Errors as `cell.resolve`."""
    machine = machines.load(parameters.machine, tuple(folders))
    arm = machine.opw
    if arm is None or parameters.setup != PART_ON_ROBOT:
        return parameters
    reach = arm.c2 + arm.forearm
    axes = np.column_stack([np.sin(TILTS), np.zeros(len(TILTS)), np.cos(TILTS)])
    phi = np.linspace(-np.pi, np.pi, TURNS, endpoint=False)[:, None]
    cell = resolve(parameters, np.eye(4), folders=folders)
    best: tuple[float, Pose, int] | None = None
    for ahead in AHEAD:
        for above in ABOVE:
            x, z = np.round([arm.a1 + ahead * reach, arm.c1 + above * reach])
            point = (float(x), 0.0, float(z), 0.0, 0.0, 0.0)
            there = replace(cell, station=machine.base @ frames.bryant(point))
            poses = there.pose_frames(BALL * axes, axes).at(np.broadcast_to(phi, (TURNS, len(TILTS))))
            joints = arm.inverse(poses.reshape(-1, 4, 4)).reshape(8, TURNS, len(TILTS), 6)
            worst = _room(machine, cell.limits.lower, cell.limits.upper, joints).max(axis=1).min(axis=1)
            branch = int(np.argmax(worst))
            if worst[branch] > 0.0 and (best is None or worst[branch] > best[0]):
                best = float(worst[branch]), point, branch
    if best is None:
        return parameters
    return replace(parameters, deposition_point=best[1], branch=opw.branch_name(best[2]))


def _room(machine: Machine, lower: Array, upper: Array, joints: Array) -> Array:
    """(8, turns, tilts) 1 in the middle of everything, 0 at a limit or where the arm or the wrist is stretched, less beyond
    and where the robot does not reach."""
    arm = machine.opw
    assert arm is not None
    left = margins(joints[..., :5], lower[:5], upper[:5]).min(axis=-1)
    turned = joints * np.array(arm.signs, float) - np.array(arm.offsets)
    stretched = np.minimum(np.abs(np.sin(turned[..., 4])), np.abs(np.sin(turned[..., 2] + np.arctan2(arm.a2, arm.c3))))
    room: Array = np.nan_to_num(np.minimum(left, stretched), nan=-1.0)
    return room
