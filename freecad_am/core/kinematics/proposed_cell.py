# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell that a machine is given until somebody says what it really has.

Of a robot: where the deposition point, or the fixed platform, may well be, and the branch to work in. Points before the
robot are tried on a grid in the plane of its arm. At each the robot deposits on a ball, from upright to lying, turned
about the tool axis however suits it; what counts is the worst of these poses: how near an axis comes to a limit, the
wrist to being stretched and the arm to its reach. Where it carries the part, axis 6 is left out: it turns the part, so
where on the ball one looks decides it. Where it carries the tool, the ball is gone round, and where no place serves
lying deposit, one that serves less is taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..geometry import frames
from ..parameters.cell import CellParameters, Pose
from ..parameters.external import externals
from . import machine as machines
from . import opw
from .cell import PART_ON_ROBOT, ROTARY_TABLE, TOOL_ON_ROBOT, Cell, resolve
from .limits import margins

Array = NDArray[np.float64]

TILTS = np.radians([0.0, 30.0, 60.0, 85.0])  # of the tool axis on the part
BALL = 50.0  # mm, radius of the deposit held
TURNS = 36  # rotations about the tool axis that are tried
# of a fixed ball, which is come at from so many directions
LEANING, ROUND = np.radians([0.0, 15.0, 30.0, 45.0, 60.0, 85.0]), 12
AHEAD = np.linspace(0.4, 0.85, 8)  # of the reach, from axis 2 on
ABOVE = np.linspace(-0.5, 0.7, 9)


def cell_of(
    machine: str, folders: Sequence[str] = (), setup: str = PART_ON_ROBOT, tool: Pose | None = None
) -> CellParameters:
    """The parameters of a cell with a machine, '' for the default one, whose cell is that of the papers. A robot has the
    set-up that is asked for; tool: pose of the tip on its flange, where it is known. InputError for an unknown one."""
    default = CellParameters()
    chosen = replace(default, machine=machine or default.machine)
    if machines.load(chosen.machine, tuple(folders)).is_table:
        return replace(chosen, setup=ROTARY_TABLE)
    nozzle = chosen.nozzle if tool is None else replace(chosen.nozzle, tool=tool)
    chosen = replace(chosen, setup=setup, nozzle=nozzle)
    return default if chosen == default else proposed(chosen, folders)


def proposed(parameters: CellParameters, folders: Sequence[str] = ()) -> CellParameters:
    """The cell with the deposition point or the platform, on whole mm, and the branch that serve best; as it is where none
    serves, and where the part is on a positioner. Errors as `cell.resolve`."""
    machine = machines.load(parameters.machine, tuple(folders))
    if externals(parameters.external) or machine.arm is None or parameters.setup not in (PART_ON_ROBOT, TOOL_ON_ROBOT):
        return parameters
    cell = resolve(parameters, np.eye(4), folders=folders)
    if cell.setup == PART_ON_ROBOT:
        return _best(parameters, cell, _directions(TILTS, 1)) or parameters
    for steepest in range(len(LEANING), 0, -1):
        found = _best(parameters, cell, _directions(LEANING[:steepest], ROUND))
        if found is not None:
            return found
    return parameters


def _directions(tilts: Array, count: int) -> Array:
    """(n, 3) unit vectors that lean by the tilts, each in so many directions round Z; upright once."""
    turn = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    tilt, turn = (grid.ravel() for grid in np.meshgrid(tilts, turn, indexing="ij"))
    axes = np.column_stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    once: Array = axes[(tilt > 0.0) | (turn == 0.0)]
    return once


def _best(parameters: CellParameters, cell: Cell, axes: Array) -> CellParameters | None:
    """The cell where deposit on a ball along the axes (n, 3) has most room, None where it has none anywhere."""
    machine, arm = cell.machine, cell.machine.arm
    assert arm is not None
    shoulder, height = arm.shoulder
    heights = height + ABOVE * arm.reach
    if cell.setup == TOOL_ON_ROBOT:  # no platform in the floor
        heights = np.unique(np.maximum(heights, 0.0))
    phi = np.broadcast_to(np.linspace(-np.pi, np.pi, TURNS, endpoint=False)[:, None], (TURNS, len(axes)))
    best: tuple[float, Pose, int] | None = None
    for ahead in AHEAD:
        for height in heights:
            x, z = np.round([shoulder + ahead * arm.reach, height])
            point = (float(x), 0.0, float(z), 0.0, 0.0, 0.0)
            there = replace(cell, station=machine.base @ frames.bryant(point))
            poses = there.pose_frames(BALL * axes, axes).at(phi)
            joints = arm.inverse(poses.reshape(-1, 4, 4)).reshape(-1, TURNS, len(axes), 6)[:8]
            worst = _room(cell, joints).max(axis=1).min(axis=1)
            branch = int(np.argmax(worst))
            if worst[branch] > 0.0 and (best is None or worst[branch] > best[0]):
                best = float(worst[branch]), point, branch
    if best is None:
        return None
    return replace(parameters, deposition_point=best[1], branch=opw.branch_name(best[2]))


def _room(cell: Cell, joints: Array) -> Array:
    """(8, turns, n) 1 in the middle of everything, 0 at a limit or where the arm or the wrist is stretched, less beyond
    and where the robot does not reach."""
    arm, limits = cell.machine.arm, cell.limits
    assert arm is not None
    if cell.setup == PART_ON_ROBOT:
        left = margins(joints[..., :5], limits.lower[:5], limits.upper[:5]).min(axis=-1)
    else:
        left = limits.smallest_share(joints.reshape(-1, 6)).reshape(joints.shape[:-1])
    room: Array = np.nan_to_num(np.minimum(left, arm.bend(joints)), nan=-1.0)
    return room
