# SPDX-License-Identifier: LGPL-2.1-or-later
"""The default cell of a machine until the user describes the real one.

For a robot: a suitable deposition point, or fixed platform, and the branch to work in.
Points in front of the robot are tried on a grid in the plane of its arm. At each the
robot deposits on a ball, from upright to horizontal, with the best rotation about the
tool axis. The worst of these poses counts: the margin of an axis to its limit, of the
wrist to being stretched and of the arm to its reach. If it carries the part, axis 6 is
left out: it turns the part, so the choice of points on the ball would decide it. If it
carries the tool, the ball is approached from all sides; if no position allows horizontal
deposit, one that allows less is taken. Poses in which a link, as drawn from the
kinematics, touches platform or nozzle do not count, unless there are no others anywhere.
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
BALL = 50.0  # mm, radius of the deposit held
TURNS = 36  # rotations about the tool axis that are tried
# number of directions from which a fixed ball is approached
LEANING, ROUND = np.radians([0.0, 15.0, 30.0, 45.0, 60.0, 85.0]), 12
AHEAD = np.linspace(0.4, 0.85, 8)  # shares of the reach, from axis 2
ABOVE = np.linspace(-0.5, 0.7, 9)


def cell_of(
    machine: str,
    folders: Sequence[str] = (),
    setup: str = OF_ROBOTS[0].setup,
    tool: Pose | None = None,
) -> CellParameters:
    """Return the parameters of a cell with a machine.

    Parameters
    ----------
    machine : str
        Id or file of the machine, '' for the default one.
    folders : sequence of str, optional
        Folders with user machines.
    setup : str, optional
        Requested set-up of a robot.
    tool : Pose or None, optional
        Pose of the tip on the robot's flange; None if unknown.

    Returns
    -------
    CellParameters
        The parameters, proposed for a robot.

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
    """Return the cell with the best deposition point, or platform, and branch.

    Parameters
    ----------
    parameters : CellParameters
        The cell; the default one has a known answer.
    folders : sequence of str, optional
        Folders with user machines.
    own_branch : bool, optional
        Whether to keep the branch of the cell.

    Returns
    -------
    CellParameters
        The cell, on whole mm; unchanged if no position serves or the part is on a
        positioner.

    Raises
    ------
    InputError
        As `cell.resolve`.
    """
    if parameters == CellParameters() and not own_branch:
        return replace(parameters, deposition_point=USUAL_POINT, branch=USUAL_BRANCH)
    return search_cell(parameters, folders, own_branch)


def search_cell(
    parameters: CellParameters, folders: Sequence[str] = (), own_branch: bool = False
) -> CellParameters:
    """Search the best deposition point, or platform, and branch for `proposed`.

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
        The cell; unchanged if no position serves.

    Raises
    ------
    InputError
        As `cell.resolve`.
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
    """Return unit vectors (n, 3) leaning by the tilts, each in `count` directions around Z;
    upright once.
    """
    turn = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    tilt, turn = (grid.ravel() for grid in np.meshgrid(tilts, turn, indexing="ij"))
    axes = np.column_stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    once: Array = axes[(tilt > 0.0) | (turn == 0.0)]
    return once


class _Place(NamedTuple):
    """A possible deposition point with the room of its worst pose in a branch; the lowest number
    has the most room.
    """

    lack: float  # of room, 1 - room
    number: int
    branch: int
    point: Pose


def _best(
    cell: Cell, axes: Array, branches: Sequence[int], cylinders: Sequence[Sequence[Cylinder]]
) -> _Place | None:
    """Return the position where deposit on a ball along the axes (n, 3) has most margin, None if
    it has none anywhere.

    Without cylinders, contacts of links are ignored.
    """
    candidates = sorted(_places(cell, axes, branches))
    best: _Place | None = None
    for candidate in candidates if cylinders else candidates[:1]:
        if (
            best is not None and best.lack <= candidate.lack
        ):  # the remaining positions have no more room, even without contacts
            break
        lack = 1.0 - _clear_margin(_stood(cell, candidate.point), axes, candidate.branch, cylinders)
        if lack < (1.0 if best is None else best.lack):
            best = candidate._replace(lack=lack)
    return best


def _places(cell: Cell, axes: Array, branches: Sequence[int]) -> Iterator[_Place]:
    """Yield the positions on the grid, and the branches, where all poses have margin."""
    arm = cell.machine.arm
    assert arm is not None
    shoulder, height = arm.shoulder
    heights = height + ABOVE * arm.reach
    if not cell.torch_stands:  # a platform must not be in the floor
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
    """The cell with deposition point or platform at a point of the manufacturer's base frame."""
    station = cell.machine.base @ frames.bryant(point)
    return replace(cell, poses=replace(cell.poses, station=station))


def _joints(cell: Cell, axes: Array) -> Array:
    """(8, turns, n, 6) joint values for deposit on a ball along the axes (n, 3), by branch."""
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
    """Return the margin of the worst pose in a branch, over rotations without contact; negative
    if none is free.
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
    """Return the margin (..., turns, n): 1 in the middle of all ranges, 0 at a limit or a
    stretched arm or wrist, less beyond.
    """
    arm, limits = cell.machine.arm, cell.limits
    assert arm is not None
    if cell.torch_stands:
        axis_margin = margins(joints[..., :5], limits.lower[:5], limits.upper[:5]).min(axis=-1)
    else:
        axis_margin = limits.smallest_share(joints.reshape(-1, 6)).reshape(joints.shape[:-1])
    margin: Array = np.nan_to_num(np.minimum(axis_margin, arm.bend(joints)), nan=-1.0)
    return margin
