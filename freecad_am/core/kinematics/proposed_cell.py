# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell that a machine is given until somebody says what it really has.

Of a robot: where the deposition point, or the fixed platform, may well be, and the branch to work in. Points before the
robot are tried on a grid in the plane of its arm. At each the robot deposits on a ball, from upright to lying, turned
about the tool axis however suits it; what counts is the worst of these poses: how near an axis comes to a limit, the
wrist to being stretched and the arm to its reach. Where it carries the part, axis 6 is left out: it turns the part, so
where on the ball one looks decides it. Where it carries the tool, the ball is gone round, and where no place serves
lying deposit, one that serves less is taken. Poses in which a link, as far as it is drawn from the kinematics, touches
platform or nozzle do not count, unless there are no others anywhere.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..geometry import frames
from ..geometry.cylinders import Cylinder
from ..parameters.cell import CellParameters, Pose
from ..parameters.external import externals
from ..types import Array
from .arrangement import OF_ROBOTS, arrangement_of
from .cell import Cell, resolve
from .inverse import opw
from .limits import margins
from .links import cylinders as link_cylinders
from .links.contact import ArmContact
from .machines import machine as machines

# what is found for the cell that most jobs have, so that it is not looked for with each of them
USUAL_POINT, USUAL_BRANCH = (1562.0, 0.0, 691.0, 0.0, 0.0, 0.0), ("front", "down", "noflip")

TILTS = np.radians([0.0, 30.0, 60.0, 85.0])  # of the tool axis on the part
BALL = 50.0  # mm, radius of the deposit held
TURNS = 36  # rotations about the tool axis that are tried
# of a fixed ball, which is come at from so many directions
LEANING, ROUND = np.radians([0.0, 15.0, 30.0, 45.0, 60.0, 85.0]), 12
AHEAD = np.linspace(0.4, 0.85, 8)  # of the reach, from axis 2 on
ABOVE = np.linspace(-0.5, 0.7, 9)


def cell_of(
    machine: str,
    folders: Sequence[str] = (),
    setup: str = OF_ROBOTS[0].setup,
    tool: Pose | None = None,
) -> CellParameters:
    """The parameters of a cell with a machine, '' for the default one. A robot has the set-up that is asked for; tool: pose
    of the tip on its flange, where it is known. InputError for an unknown one."""
    chosen = CellParameters(machine=machine or CellParameters().machine)
    usual = machines.load(chosen.machine, tuple(folders)).arrangements[0]
    if not usual.free:
        return replace(chosen, setup=usual.setup)
    nozzle = chosen.nozzle if tool is None else replace(chosen.nozzle, tool=tool)
    return proposed(replace(chosen, setup=setup, nozzle=nozzle), folders)


def proposed(
    parameters: CellParameters, folders: Sequence[str] = (), own_branch: bool = False
) -> CellParameters:
    """The cell with the deposition point or the platform, on whole mm, and the branch that serve best, its own one with
    `own_branch`; as it is where none serves, and where the part is on a positioner. Errors as `cell.resolve`."""
    if parameters == CellParameters() and not own_branch:
        return replace(parameters, deposition_point=USUAL_POINT, branch=USUAL_BRANCH)
    return searched(parameters, folders, own_branch)


def searched(
    parameters: CellParameters, folders: Sequence[str] = (), own_branch: bool = False
) -> CellParameters:
    """What is `proposed`, looked for."""
    machine = machines.load(parameters.machine, tuple(folders))
    arrangement = arrangement_of(parameters.setup)
    if (
        externals(parameters.external)
        or machine.arm is None
        or not (arrangement.free and arrangement.planned)
    ):
        return parameters
    cell = resolve(parameters, np.eye(4), folders=folders)
    branches = range(len(opw.BRANCHES)) if cell.branch is None or not own_branch else [cell.branch]
    if arrangement.carries_part:
        leanings = [_directions(TILTS, 1)]
    else:
        leanings = [
            _directions(LEANING[:steepest], ROUND) for steepest in range(len(LEANING), 0, -1)
        ]
    cylinders = link_cylinders.of_robot(cell.robot.chain)
    for touched in (cylinders, ()):
        for axes in leanings:
            found = _best(cell, axes, branches, touched)
            if found is not None:
                branch = parameters.branch if own_branch else opw.branch_name(found.branch)
                return replace(parameters, deposition_point=found.point, branch=branch)
    return parameters


def _directions(tilts: Array, count: int) -> Array:
    """(n, 3) unit vectors that lean by the tilts, each in so many directions round Z; upright once."""
    turn = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    tilt, turn = (grid.ravel() for grid in np.meshgrid(tilts, turn, indexing="ij"))
    axes = np.column_stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    once: Array = axes[(tilt > 0.0) | (turn == 0.0)]
    return once


class _Place(NamedTuple):
    """Where the deposition point may be: the room of the worst pose there, in a branch; the lowest number has most."""

    lack: float  # of room, 1 - room
    number: int
    branch: int
    point: Pose


def _best(
    cell: Cell, axes: Array, branches: Sequence[int], cylinders: Sequence[Sequence[Cylinder]]
) -> _Place | None:
    """Where deposit on a ball along the axes (n, 3) has most room, None where it has none anywhere. Without cylinders links
    may touch what they like."""
    places = sorted(_places(cell, axes, branches))
    best: _Place | None = None
    for place in places if cylinders else places[:1]:
        if (
            best is not None and best.lack <= place.lack
        ):  # those that come now have no more room, whatever is touched
            break
        lack = 1.0 - _clear_margin(_stood(cell, place.point), axes, place.branch, cylinders)
        if lack < (1.0 if best is None else best.lack):
            best = place._replace(lack=lack)
    return best


def _places(cell: Cell, axes: Array, branches: Sequence[int]) -> Iterator[_Place]:
    """The places on the grid, and the branches, in which all of the poses have room."""
    arm = cell.machine.arm
    assert arm is not None
    shoulder, height = arm.shoulder
    heights = height + ABOVE * arm.reach
    if not cell.torch_stands:  # no platform in the floor
        heights = np.unique(np.maximum(heights, 0.0))
    for number, (ahead, above) in enumerate(itertools.product(AHEAD, heights)):
        x, z = np.round([shoulder + ahead * arm.reach, above])
        point = (float(x), 0.0, float(z), 0.0, 0.0, 0.0)
        there = _stood(cell, point)
        worst = _margin(cell, _joints(there, axes)).max(axis=1).min(axis=1)
        yield from (
            _Place(1.0 - float(worst[k]), number, k, point) for k in branches if worst[k] > 0.0
        )


def _stood(cell: Cell, point: Pose) -> Cell:
    """The cell with the deposition point, or the platform, at a point of the manufacturer's base frame."""
    return replace(cell, station=cell.machine.base @ frames.bryant(point))


def _joints(cell: Cell, axes: Array) -> Array:
    """(8, turns, n, 6) joint values for deposit on a ball along the axes (n, 3), by branch."""
    arm = cell.machine.arm
    assert arm is not None
    phi = np.broadcast_to(
        np.linspace(-np.pi, np.pi, TURNS, endpoint=False)[:, None], (TURNS, len(axes))
    )
    poses = cell.pose_frames(BALL * axes, axes).at(phi)
    joints: Array = arm.inverse(poses.reshape(-1, 4, 4)).reshape(-1, TURNS, len(axes), 6)[:8]
    return joints


def _clear_margin(
    cell: Cell, axes: Array, branch: int, cylinders: Sequence[Sequence[Cylinder]]
) -> float:
    """The room of the worst pose in a branch, of those turned so that no link touches anything; below 0 where there is
    none."""
    joints = _joints(cell, axes)[branch]
    margin = _margin(cell, joints)
    if cylinders:
        some = margin > 0.0
        margin[some] = np.where(
            ArmContact(cell, cylinders).touches(joints[some]).any, -1.0, margin[some]
        )
    return float(margin.max(axis=0).min())


def _margin(cell: Cell, joints: Array) -> Array:
    """(..., turns, n) 1 in the middle of everything, 0 at a limit or where the arm or the wrist is stretched, less beyond
    and where the robot does not reach."""
    arm, limits = cell.machine.arm, cell.limits
    assert arm is not None
    if cell.torch_stands:
        left = margins(joints[..., :5], limits.lower[:5], limits.upper[:5]).min(axis=-1)
    else:
        left = limits.smallest_share(joints.reshape(-1, 6)).reshape(joints.shape[:-1])
    margin: Array = np.nan_to_num(np.minimum(left, arm.bend(joints)), nan=-1.0)
    return margin
