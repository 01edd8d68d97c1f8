# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points, axis values, limits and solvers: whether a text leads where it should."""

from __future__ import annotations

import numpy as np

from freecad_am.core.types import Array, Mask

from ..core.geometry.columns import lengths
from ..core.geometry.formatting import deviation
from ..core.issues import NOTE, Issue, Text
from ..core.kinematics.cell import Cell
from ..core.kinematics.chain import Chain
from ..core.program import Program
from ..core.read_moves import ReadMoves
from ..kdl import chain as kdl_chain
from .planned import COMPUTED_AXIS, COMPUTED_MM, Planned, pieces
from .text_path import Joints, Path, digits, given_by_position, positions_path

EVERY = 8  # of a long text so many-th row is driven through PyKDL
THIRDS = np.array([0.0, 2.0, 4.0]) * np.pi / 3.0
GRID_TO_ALL = (
    5.0 / 3.0
)  # how much larger a sum of a constant, a sine and a cosine is anywhere than at three angles


def joint_issues(cell: Cell, planned: Planned, read: ReadMoves, continuous: Mask) -> list[Issue]:
    """Joint values against the planned ones: the tip does not show where the rotation about the tool is."""
    assert read.joints is not None
    apart = read.joints - cell.machine.to_controller(planned.joints)
    apart[:, continuous] -= 2.0 * np.pi * np.rint(apart[:, continuous] / (2.0 * np.pi))
    given = ~np.isnan(read.joints) | ~given_by_position(cell, read.joints)
    apart[~given] = 0.0
    computed = np.where(cell.machine.chain.sliding, COMPUTED_MM, COMPUTED_AXIS)
    wrong = ~(np.abs(apart) <= digits(cell, read) + computed)
    found = []
    for axis in np.flatnonzero(wrong.any(axis=0)):
        most = np.abs(apart[:, axis]).max() / cell.machine.unit_values[axis]
        message = Text(
            "axis {} is up to {:.3g} {} from the planned value",
            cell.machine.axes[axis],
            most,
            cell.machine.units[axis],
        )
        found += planned.issue("VERIFY_JOINT", wrong[:, axis], message)
    return found


def limit_issues(cell: Cell, planned: Planned, text: Joints) -> list[Issue]:
    """Whether the joints that a text asks for are within the limits of the cell, but for its digits."""
    limits, wrong = cell.limits, np.zeros(len(text.serial), dtype=bool)
    worst, label = -np.inf, 0
    for rows in pieces(np.arange(len(text.serial))):
        reach = text.reach[rows]
        over = -limits.margin(text.serial[rows]) - np.hstack(
            [reach, reach @ np.abs(limits.coefficients).T]
        )
        wrong[rows] = (over > COMPUTED_AXIS).any(axis=1)
        most = np.nan_to_num(np.fmax.reduce(over), nan=-np.inf)
        if most.max() > worst:
            worst, label = float(most.max()), int(most.argmax())
    if worst <= COMPUTED_AXIS:
        return []
    unit = cell.machine.units[label] if label < limits.axes else "deg"
    shown = worst / (cell.machine.unit_values[label] if label < limits.axes else np.radians(1.0))
    message = Text(
        "the text takes {} up to {:.3g} {} beyond its limit", limits.labels[label], shown, unit
    )
    return planned.issue("VERIFY_LIMIT", wrong, message)


def point_issues(planned: Planned, path: Path) -> list[Issue]:
    off = lengths(path.position - planned.position)
    tilted = lengths(path.tool - planned.tool)
    message = Text(
        "the text leads up to {} mm away from the planned point, more than its digits explain",
        deviation(float(off.max())),
    )
    found = planned.issue("VERIFY_POINT", ~(off <= path.bound), message)
    message = Text(
        "the tool is tilted by up to {:.3g} deg, more than the digits explain",
        np.degrees(tilted.max()),
    )
    return found + planned.issue("VERIFY_TOOL", ~(tilted <= path.tool_bound), message)


def twice_issues(
    cell: Cell, planned: Planned, program: Program, read: ReadMoves, flange: Array
) -> list[Issue]:
    """Positions that a text tells beside the joint values of a row, as where an arc is struck, against the planned point and
    flange (n, 4, 4)."""
    if read.position is None or read.joints is None:
        return []
    twice = np.isfinite(read.joints).all(axis=1) & np.isfinite(read.position).all(axis=1)
    if not twice.any():
        return []
    path, asked, _ = positions_path(cell, program, read)
    off = ~(lengths(path.position - planned.position) <= path.bound)
    off |= ~(lengths(path.tool - planned.tool) <= path.tool_bound) | turned_otherwise(
        asked, flange, path
    )
    return planned.issue(
        "VERIFY_POINT", twice & off, "the text gives another position there than the joint values"
    )


def turned_otherwise(asked: Array, flange: Array, path: Path) -> Mask:
    """(n,) whether flanges (n, 4, 4) are turned by more than digits explain: an angle of a shows as sqrt(2) a in the sum of
    squares of the nine entries."""
    apart = np.linalg.norm(asked[:, :3, :3] - flange[:, :3, :3], axis=(1, 2))
    return np.asarray(apart > np.sqrt(2.0) * path.tool_bound)


def second_opinion(
    cell: Cell, planned: Planned, shown: Array, flange: Array
) -> tuple[list[Issue], tuple[str, ...]]:
    """The same joint values through PyKDL, where it is installed: all of them, or of a long text some and joint values of
    every kind (docs/decisions/0022)."""
    if not kdl_chain.available():
        message = "PyKDL is not installed; the program was checked by one solver only"
        return [Issue(NOTE, "VERIFY_ONE_SOLVER", message)], ("chain",)
    arm, wrong = kdl_chain.KdlArm(cell.machine), np.zeros(len(shown), dtype=bool)
    grid = grid_of(cell.machine.chain, planned.joints)
    long = len(shown) > EVERY * len(grid)
    if long:
        # what differs by so much on the grid may differ by as much again for each turning axis elsewhere
        share = GRID_TO_ALL ** -np.count_nonzero(~cell.machine.chain.sliding)
        wrong |= _differ(arm.forward(grid), cell.machine.chain.forward(grid), share).any()
    for rows in pieces(np.arange(0, len(shown), EVERY if long else 1)):
        wrong[rows] |= _differ(arm.forward(cell.machine.from_controller(shown[rows])), flange[rows])
    issues = planned.issue("VERIFY_SOLVERS", wrong, "PyKDL and the joint-frame chain disagree")
    return issues, ("chain", "pykdl")


def _differ(one: Array, other: Array, share: float = 1.0) -> Mask:
    """(n,) whether poses (n, 4, 4) of two solvers differ by more than a share of what rounding explains."""
    apart = one - other
    found: Mask = lengths(apart[:, :3, 3]) > share * COMPUTED_MM
    found |= np.abs(apart[:, :3, :3]).max(axis=(1, 2)) > share * COMPUTED_AXIS
    return found


def grid_of(chain: Chain, joints: Array) -> Array:
    """Joint values (m, axes) on which two solvers that agree do so everywhere: three of each turning axis, two of each that
    slides. The entries of a pose are a sum of constants, sines and cosines in each angle, and of degree one in each way;
    so is their difference."""
    low, high = np.nanmin(joints, axis=0), np.nanmax(joints, axis=0)
    ways = np.stack([low, np.where(high > low, high, low + 1.0)], axis=1)
    values = [way if slides else THIRDS for way, slides in zip(ways, chain.sliding, strict=True)]
    grid: Array = np.stack(np.meshgrid(*values, indexing="ij"), axis=-1).reshape(-1, chain.axes)
    return grid
