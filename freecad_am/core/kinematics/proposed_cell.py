# SPDX-License-Identifier: LGPL-2.1-or-later
"""Propose a cell for a machine until the user describes the real one.

For a robot, this is a deposition point or a fixed platform, and a branch. Candidate points lie on
a grid in front of the robot, in the plane of its arm. At each point the robot deposits on a ball,
with tool axes from vertical to horizontal and the best tool rotation. The rating is the margin of
the worst pose: distance of the axes from their limits, of the wrist from being stretched and of
the arm from its reach. If the robot carries the part, axis 6 is ignored: it rotates the part, so
the choice of points on the ball would decide its value. If the robot carries the tool, it
approaches the ball from all sides; if no position allows horizontal deposit, a smaller tilt is
accepted. Poses in which a link, drawn from the kinematics, touches platform or nozzle are excluded,
unless no other pose exists.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..geometry import frames
from ..geometry.cylinders import Cylinder
from ..parameters.cell import CellParameters
from ..parameters.records import Pose
from ..types import Array
from .arrangement import OF_ROBOTS, arrangement_of
from .cell import Cell, resolve
from .inverse import spherical_wrist
from .limits import margins
from .links import external_links
from .links.contact import ArmContact
from .machines import machine as machines

# result for the default cell, so that most jobs need no search
USUAL_POINT, USUAL_BRANCH = (1562.0, 0.0, 691.0, 0.0, 0.0, 0.0), ("front", "down", "noflip")

TILTS = np.radians([0.0, 30.0, 60.0, 85.0])  # tilts of the tool axis on the part
BALL = 50.0  # mm; radius of the ball
TURNS = 36  # number of tool rotations to try
# tilts, rad, and number of directions, from which the robot approaches a fixed ball
LEANING, ROUND = np.radians([0.0, 15.0, 30.0, 45.0, 60.0, 85.0]), 12
AHEAD = np.linspace(0.4, 0.85, 8)  # grid positions relative to axis 2, as fractions of the reach
ABOVE = np.linspace(-0.5, 0.7, 9)


def cell_of(
    machine: str,
    folders: Sequence[str] = (),
    setup: str = OF_ROBOTS[0].setup,
    tool: Pose | None = None,
) -> CellParameters:
    """Return the cell parameters for a machine.

    Parameters
    ----------
    machine : str
        Machine id or file; '' for the default machine.
    folders : sequence of str, optional
        Folders with user machines.
    setup : str, optional
        Requested set-up of a robot.
    tool : Pose or None, optional
        Tip pose on the robot flange; None if unknown.

    Returns
    -------
    CellParameters
        The parameters; a proposal for a robot.

    Raises
    ------
    InputError
        For an unknown machine.
    """
    cell_parameters = CellParameters(machine=machine or CellParameters().machine)
    usual = machines.load(cell_parameters.machine, tuple(folders)).arrangements[0]
    if not usual.free:
        return replace(cell_parameters, setup=usual.setup)
    nozzle = cell_parameters.nozzle if tool is None else replace(cell_parameters.nozzle, tool=tool)
    return proposed(replace(cell_parameters, setup=setup, nozzle=nozzle), folders)


def proposed(
    parameters: CellParameters, folders: Sequence[str] = (), own_branch: bool = False
) -> CellParameters:
    """Return the cell with the best deposition point or platform, and the best branch.

    Parameters
    ----------
    parameters : CellParameters
        The cell; the result for the default cell is stored.
    folders : sequence of str, optional
        Folders with user machines.
    own_branch : bool, optional
        Whether to keep the branch of the cell.

    Returns
    -------
    CellParameters
        The cell, rounded to whole mm; unchanged if no position is feasible or the part is on a
        positioner.

    Raises
    ------
    InputError
        Errors of `cell.resolve`.
    """
    if parameters == CellParameters() and not own_branch:
        return replace(parameters, deposition_point=USUAL_POINT, branch=USUAL_BRANCH)
    return search_cell(parameters, folders, own_branch)


def search_cell(
    parameters: CellParameters, folders: Sequence[str] = (), own_branch: bool = False
) -> CellParameters:
    """Search for the best deposition point or platform, and the best branch, for `proposed`.

    Parameters
    ----------
    parameters : CellParameters
        The cell.
    folders : sequence of str, optional
        Folders with user machines.
    own_branch : bool, optional
        Whether to keep the branch of the cell.

    Returns
    -------
    CellParameters
        The cell; unchanged if no position is feasible.

    Raises
    ------
    InputError
        Errors of `cell.resolve`.
    """
    machine = machines.load(parameters.machine, tuple(folders))
    arrangement = arrangement_of(parameters.setup)
    if parameters.external or machine.arm is None or not (arrangement.free and arrangement.planned):
        return parameters
    cell = resolve(parameters, np.eye(4), folders=folders)
    branches = (
        range(len(spherical_wrist.BRANCHES))
        if cell.branch is None or not own_branch
        else [cell.branch]
    )
    if arrangement.carries_part:
        leanings = [_directions(TILTS, 1)]
    else:
        leanings = [
            _directions(LEANING[:steepest], ROUND) for steepest in range(len(LEANING), 0, -1)
        ]
    cylinders = external_links.robot_cylinders(cell.robot.chain)
    for touched in (cylinders, ()):
        for axes in leanings:
            best = _best(cell, axes, branches, touched)
            if best is not None:
                branch = (
                    parameters.branch if own_branch else spherical_wrist.branch_name(best.branch)
                )
                return replace(parameters, deposition_point=best.point, branch=branch)
    return parameters


def _directions(tilts: Array, count: int) -> Array:
    """Return unit vectors (n, 3) with the given tilts, each in `count` directions around Z.

    The vertical vector occurs once.
    """
    turn = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    tilt, turn = (grid.ravel() for grid in np.meshgrid(tilts, turn, indexing="ij"))
    axes = np.column_stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    once: Array = axes[(tilt > 0.0) | (turn == 0.0)]
    return once


class _Place(NamedTuple):
    """A candidate deposition point in a branch, ordered by the margin of its worst pose."""

    lack: float  # 1 - margin
    number: int
    branch: int
    point: Pose


def _best(
    cell: Cell, axes: Array, branches: Sequence[int], cylinders: Sequence[Sequence[Cylinder]]
) -> _Place | None:
    """Return the position with the maximum margin for deposit on a ball along the axes (n, 3).

    None if no position has a margin. Without cylinders, link contacts are ignored.
    """
    candidates = sorted(_places(cell, axes, branches))
    best: _Place | None = None
    for candidate in candidates if cylinders else candidates[:1]:
        if (
            best is not None and best.lack <= candidate.lack
        ):  # the remaining positions have less margin, even without contacts
            break
        lack = 1.0 - _clear_margin(_stood(cell, candidate.point), axes, candidate.branch, cylinders)
        if lack < (1.0 if best is None else best.lack):
            best = candidate._replace(lack=lack)
    return best


def _places(cell: Cell, axes: Array, branches: Sequence[int]) -> Iterator[_Place]:
    """Yield the grid positions and branches where all poses have a margin."""
    arm = cell.machine.arm
    assert arm is not None
    shoulder, height = arm.shoulder
    heights = height + ABOVE * arm.reach
    if not cell.torch_stands:  # a platform must not be below the floor
        heights = np.unique(np.maximum(heights, 0.0))
    for number, (ahead, above) in enumerate(itertools.product(AHEAD, heights)):
        x, z = np.round([shoulder + ahead * arm.reach, above])
        point = (float(x), 0.0, float(z), 0.0, 0.0, 0.0)
        cell_at_point = _stood(cell, point)
        worst = _margin(cell, _joints(cell_at_point, axes)).max(axis=1).min(axis=1)
        yield from (
            _Place(1.0 - float(worst[k]), number, k, point) for k in branches if worst[k] > 0.0
        )


def _stood(cell: Cell, point: Pose) -> Cell:
    """Return the cell with its deposition point or platform at a pose in the manufacturer's base
    frame.
    """
    station = cell.machine.base @ frames.bryant(point)
    return replace(cell, poses=replace(cell.poses, station=station))


def _joints(cell: Cell, axes: Array) -> Array:
    """Return joints (8, turns, n, 6) for deposit on a ball along the axes (n, 3), by branch."""
    arm = cell.machine.arm
    assert arm is not None
    phi = np.broadcast_to(
        np.linspace(-np.pi, np.pi, TURNS, endpoint=False)[:, None], (TURNS, len(axes))
    )
    poses = cell.pose_frames(BALL * axes, axes).flange_poses(phi)
    joints: Array = arm.inverse(poses.reshape(-1, 4, 4)).reshape(-1, TURNS, len(axes), 6)[:8]
    return joints


def _clear_margin(
    cell: Cell, axes: Array, branch: int, cylinders: Sequence[Sequence[Cylinder]]
) -> float:
    """Return the margin of the worst pose in a branch, with the best rotation free of contact.

    Negative if a pose has no such rotation.
    """
    joints = _joints(cell, axes)[branch]
    margin = _margin(cell, joints)
    if cylinders:
        has_margin = margin > 0.0
        margin[has_margin] = np.where(
            ArmContact(cell, cylinders).touches(joints[has_margin]).any, -1.0, margin[has_margin]
        )
    return float(margin.max(axis=0).min())


def _margin(cell: Cell, joints: Array) -> Array:
    """Return the margin (..., turns, n).

    1 at mid-range of all axes, 0 at a limit or for a stretched arm or wrist, negative beyond.
    """
    arm, limits = cell.machine.arm, cell.limits
    assert arm is not None
    if cell.torch_stands:
        axis_margin = margins(joints[..., :5], limits.lower[:5], limits.upper[:5]).min(axis=-1)
    else:
        axis_margin = limits.smallest_share(joints.reshape(-1, 6)).reshape(joints.shape[:-1])
    margin: Array = np.nan_to_num(np.minimum(axis_margin, arm.bend(joints)), nan=-1.0)
    return margin
