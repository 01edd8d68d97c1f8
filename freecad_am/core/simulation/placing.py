# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where everything in a cell is for given joint values, seen from what stands still; and how a cell stands at rest.

What stands still, the world, is the floor plate of a robot, where it is with its track at zero, or the bearings of a
machine with rotary axes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import frames
from ..kinematics.cell import Cell
from ..kinematics.inverse.five_axis import TURNING, FiveAxis
from ..types import Array, ArrayLike
from .table_links import standing_link

# rotations about the nozzle that are looked at for a robot at rest
_ROTATIONS = 24


@dataclass(frozen=True, eq=False)
class Placing:
    """Poses in the world, mm. links: (axes + 1, 4, 4), the robot's own. part: (4, 4), its own coordinates. nozzle: (4, 4),
    the tip, its Z pointing into the nozzle. platform: (4, 4), what the part stands on. external_links: (k, 4, 4), the links of
    positioner and track that are known."""

    links: Array
    part: Array
    nozzle: Array
    platform: Array
    external_links: Array


def placing(cell: Cell, joints: ArrayLike) -> Placing:
    """Where links, part and nozzle are for a joint vector (axes,)."""
    chain, values = cell.robot.chain, np.asarray(joints, float)
    links = cell.links(values)
    flange = links[-1] @ chain.flange
    carried = flange @ cell.carried
    on_robot = not cell.torch_stands
    platform = cell.station if on_robot else carried
    nozzle = carried @ frames.pose(frames.about_x(np.pi), np.zeros(3)) if on_robot else cell.station
    stands = links[standing_link(chain)]
    if cell.external is not None:
        stands = cell.world(values[None])[0] @ frames.inverse(cell.robot.base)
    to_world = frames.inverse(stands)
    return Placing(
        links=to_world @ links,
        part=to_world @ platform @ frames.inverse(cell.mount),
        nozzle=to_world @ nozzle,
        platform=to_world @ platform,
        external_links=to_world @ cell.external_link_frames(values[None])[0],
    )


def at_rest(cell: Cell, point: ArrayLike) -> Array:
    """(axes,) joints with which the nozzle stands upright, by the platform, on a point (3,) of the part.

    A robot takes the rotation and branch with the most room to its limits; all axes are 0 where it does not reach. Turning
    axes of a machine with rotary axes are at 0.
    """
    target, chain = np.asarray(point, float), cell.machine.chain
    if not cell.machine.free:
        on_flange, _ = cell.to_flange(target[None], cell.mount[None, :3, 2])
        return np.asarray(
            FiveAxis(chain).place_points(np.zeros((1, TURNING)), on_flange, cell.station)[0]
        )
    arm = cell.robot.arm
    assert arm is not None  # a cell has no other robots
    rotations = np.linspace(0.0, 2.0 * np.pi, _ROTATIONS, endpoint=False)
    external = np.zeros((_ROTATIONS, chain.axes))
    targets, axes = np.tile(target, (_ROTATIONS, 1)), np.tile(cell.mount[:3, 2], (_ROTATIONS, 1))
    flange = cell.flange_poses(targets, axes, rotations, external)
    branches = range(8) if cell.branch is None else (cell.branch,)
    solutions = np.concatenate([arm.inverse_branch(flange, branch) for branch in branches])
    solutions = np.arctan2(np.sin(solutions), np.cos(solutions))
    solutions = np.pad(solutions, ((0, 0), (0, chain.axes - solutions.shape[1])))
    margin = np.nan_to_num(cell.limits.smallest(solutions).margin, nan=-np.inf)
    best = int(np.argmax(margin))
    return np.asarray(solutions[best]) if np.isfinite(margin[best]) else np.zeros(chain.axes)
