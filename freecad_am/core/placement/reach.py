# SPDX-License-Identifier: LGPL-2.1-or-later
"""Robot reach as a grid: at each point, the fraction of tool directions that the robot can hold."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..geometry import frames
from ..geometry.frames import TURN
from ..geometry.step_count import step_count
from ..kinematics.cell import Cell
from ..planning.plan import Progress
from ..planning.task import LimitRows, limit_rows
from ..types import Array

DIRECTIONS, TURNS = 32, 12  # tested directions, and rotations about each direction
PIECE = 60  # grid points computed per batch
MOST_PLACES = 40_000


@dataclass(frozen=True, eq=False)
class Reach:
    """Reachable grid points.

    places: (n, 3) mm in base_link. share: (n,) fraction of the DIRECTIONS that the robot can hold
    at each place. step: grid spacing, mm.
    """

    places: Array
    share: Array
    step: float


def reach(cell: Cell, step: float, progress: Progress = lambda share, text: None) -> Reach:
    """Return the reachable positions of the nozzle tip on a grid.

    For a robot that holds the part, return positions of the platform centre. Joint limits apply;
    obstacles and external axes are ignored.

    Parameters
    ----------
    cell : Cell
        The cell with its configuration.
    step : float
        Grid spacing, mm; increased where needed to keep the grid within MOST_PLACES.
    progress : callable, optional
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    Reach
        The reachable positions; empty for five-axis machines.
    """
    arm = cell.robot.arm
    if arm is None:
        return Reach(np.zeros((0, 3)), np.zeros(0), step)
    ahead, height = arm.shoulder
    tool_length = float(np.linalg.norm(cell.robot.chain.flange[:3, 3])) + float(
        np.linalg.norm(cell.poses.carried[:3, 3])
    )
    size = ahead + arm.reach + tool_length
    step = max(step, 2.0 * size / MOST_PLACES ** (1.0 / 3.0))
    count = step_count(size, step, 0)
    ticks = step * np.arange(-count, count + 1)
    grid = np.stack(np.meshgrid(ticks, ticks, ticks, indexing="ij"), axis=-1).reshape(-1, 3)
    grid = grid[np.linalg.norm(grid, axis=1) <= size]
    rows, hold = limit_rows(cell.limits), _poses(cell)
    grid_points = grid + [0.0, 0.0, height]
    share = np.zeros(len(grid_points))
    for k, batch in enumerate(_pieces(len(grid_points))):
        progress(k * PIECE / len(grid_points), "reach")
        share[batch] = _share(cell, rows, grid_points[batch], hold)
    is_reached = share > 0.0
    return Reach(grid_points[is_reached], share[is_reached], step)


def _pieces(count: int) -> Iterator[slice]:
    return (slice(start, min(start + PIECE, count)) for start in range(0, count, PIECE))


def _poses(cell: Cell) -> Array:
    """Return flange poses (DIRECTIONS, TURNS, 4, 4) that hold the load at the origin."""
    number = np.arange(DIRECTIONS) + 0.5
    up = 1.0 - 2.0 * number / DIRECTIONS
    around = np.pi * (1.0 + np.sqrt(5.0)) * number  # even distribution on a sphere (Fibonacci)
    across = np.sqrt(1.0 - up * up)
    axes = np.stack([across * np.cos(around), across * np.sin(around), up], axis=1)
    lean = np.swapaxes(frames.smallest_rotation(axes, (0.0, 0.0, 1.0)), 1, 2)
    turn = frames.about_z(np.linspace(0.0, TURN, TURNS, endpoint=False))
    poses: Array = frames.pose(lean[:, None] @ turn, np.zeros(3)) @ frames.inverse(
        cell.poses.carried
    )
    return poses


def _share(cell: Cell, rows: LimitRows, points: Array, hold: Array) -> Array:
    """Return the fraction (n,) of directions that the robot can hold at points (n, 3)."""
    arm = cell.robot.arm
    assert arm is not None
    poses = np.broadcast_to(hold, (len(points), *hold.shape)).copy()
    poses[..., :3, 3] += points[:, None, None]
    robot_axes, count = cell.robot.chain.axes, cell.machine.chain.axes
    served = np.zeros(poses.shape[:3], dtype=bool)
    with np.errstate(invalid="ignore"):  # continuous axes have infinite limits
        middle = 0.5 * (cell.limits.lower + cell.limits.upper)[:robot_axes]
    for branch in range(8) if cell.branch is None else (cell.branch,):
        remaining = np.nonzero(~served.any(axis=2))
        joints = arm.inverse_branch(poses[remaining].reshape(-1, 4, 4), branch)
        joints = np.pad(joints, ((0, 0), (0, count - robot_axes)))  # external axes stay at zero
        turns = np.where(
            np.isfinite(middle),
            np.round((np.nan_to_num(middle) - joints[:, :robot_axes]) / TURN),
            0.0,
        )
        joints[:, :robot_axes] += TURN * turns
        served[remaining] = (rows.margin(joints) >= 0.0).reshape(-1, TURNS)
    return np.asarray(served.any(axis=2).mean(axis=1))
