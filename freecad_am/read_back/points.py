# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points, axis values, limits and solvers: whether a text leads where it should."""

from __future__ import annotations

import numpy as np

from freecad_am.core.types import Array, Mask

from ..core.geometry.columns import lengths
from ..core.geometry.formatting import format_deviation
from ..core.issues import NOTE, Issue, Text
from ..core.kinematics.cell import Cell
from ..core.kinematics.chain import Chain
from ..core.program import Program
from ..core.read_moves import ReadMoves
from ..kdl import chain as kdl_chain
from .planned import COMPUTED_AXIS, COMPUTED_MM, Planned, pieces
from .text_path import Joints, Path, digits, given_by_position, positions_path

ROW_STRIDE = 8  # of a long text so many-th row is driven through PyKDL
THIRDS = np.array([0.0, 2.0, 4.0]) * np.pi / 3.0
GRID_TO_ALL = (
    5.0 / 3.0
)  # how much larger a sum of a constant, a sine and a cosine is anywhere than at three angles


def joint_issues(cell: Cell, planned: Planned, text: ReadMoves, continuous: Mask) -> list[Issue]:
    """Joint values against the planned ones: the tip does not show where the rotation about the tool is."""
    assert text.joints is not None
    differences = text.joints - cell.machine.to_controller(planned.joints)
    differences[:, continuous] -= 2.0 * np.pi * np.rint(differences[:, continuous] / (2.0 * np.pi))
    is_given = ~np.isnan(text.joints) | ~given_by_position(cell, text.joints)
    differences[~is_given] = 0.0
    computed = np.where(cell.machine.chain.sliding, COMPUTED_MM, COMPUTED_AXIS)
    wrong = ~(np.abs(differences) <= digits(cell, text) + computed)
    issues = []
    for axis in np.flatnonzero(wrong.any(axis=0)):
        largest = np.abs(differences[:, axis]).max() / cell.machine.unit_values[axis]
        message = Text(
            "axis {} is up to {:.3g} {} from the planned value",
            cell.machine.axes[axis],
            largest,
            cell.machine.units[axis],
        )
        issues += planned.issue("VERIFY_JOINT", wrong[:, axis], message)
    return issues


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
        largest = np.nan_to_num(np.fmax.reduce(over), nan=-np.inf)
        if largest.max() > worst:
            worst, label = float(largest.max()), int(largest.argmax())
    if worst <= COMPUTED_AXIS:
        return []
    unit = cell.machine.units[label] if label < limits.axes else "deg"
    excess = worst / (cell.machine.unit_values[label] if label < limits.axes else np.radians(1.0))
    message = Text(
        "the text takes {} up to {:.3g} {} beyond its limit", limits.labels[label], excess, unit
    )
    return planned.issue("VERIFY_LIMIT", wrong, message)


def point_issues(planned: Planned, path: Path) -> list[Issue]:
    off = lengths(path.position - planned.position)
    tilted = lengths(path.tool - planned.tool)
    message = Text(
        "the text leads up to {} mm away from the planned point, more than its digits explain",
        format_deviation(float(off.max())),
    )
    issues = planned.issue("VERIFY_POINT", ~(off <= path.bound), message)
    message = Text(
        "the tool is tilted by up to {:.3g} deg, more than the digits explain",
        np.degrees(tilted.max()),
    )
    return issues + planned.issue("VERIFY_TOOL", ~(tilted <= path.tool_bound), message)


def twice_issues(
    cell: Cell, planned: Planned, program: Program, text: ReadMoves, flange: Array
) -> list[Issue]:
    """Positions that a text tells beside the joint values of a row, as where an arc is struck, against the planned point and
    flange (n, 4, 4)."""
    if text.position is None or text.joints is None:
        return []
    twice = np.isfinite(text.joints).all(axis=1) & np.isfinite(text.position).all(axis=1)
    if not twice.any():
        return []
    path, text_flanges, _ = positions_path(cell, program, text)
    off = ~(lengths(path.position - planned.position) <= path.bound)
    off |= ~(lengths(path.tool - planned.tool) <= path.tool_bound) | turned_otherwise(
        text_flanges, flange, path
    )
    return planned.issue(
        "VERIFY_POINT", twice & off, "the text gives another position there than the joint values"
    )


def turned_otherwise(text_flanges: Array, flange: Array, path: Path) -> Mask:
    """(n,) whether flanges (n, 4, 4) are turned by more than digits explain: an angle of a shows as sqrt(2) a in the sum of
    squares of the nine entries."""
    differences = np.linalg.norm(text_flanges[:, :3, :3] - flange[:, :3, :3], axis=(1, 2))
    return np.asarray(differences > np.sqrt(2.0) * path.tool_bound)


def second_opinion(
    cell: Cell, planned: Planned, controller_values: Array, flange: Array
) -> tuple[list[Issue], tuple[str, ...]]:
    """The same joint values through PyKDL, where it is installed: all of them, or of a long text some and joint values of
    every kind (docs/decisions/0022)."""
    if not kdl_chain.available():
        message = "PyKDL is not installed; the program was checked by one solver only"
        return [Issue(NOTE, "VERIFY_ONE_SOLVER", message)], ("chain",)
    arm, wrong = kdl_chain.KdlArm(cell.machine), np.zeros(len(controller_values), dtype=bool)
    grid = grid_of(cell.machine.chain, planned.joints)
    long = len(controller_values) > ROW_STRIDE * len(grid)
    if long:
        # what differs by so much on the grid may differ by as much again for each turning axis elsewhere
        share = GRID_TO_ALL ** -np.count_nonzero(~cell.machine.chain.sliding)
        wrong |= _differ(arm.forward(grid), cell.machine.chain.forward(grid), share).any()
    for rows in pieces(np.arange(0, len(controller_values), ROW_STRIDE if long else 1)):
        wrong[rows] |= _differ(
            arm.forward(cell.machine.from_controller(controller_values[rows])), flange[rows]
        )
    issues = planned.issue("VERIFY_SOLVERS", wrong, "PyKDL and the joint-frame chain disagree")
    return issues, ("chain", "pykdl")


def _differ(poses: Array, reference: Array, share: float = 1.0) -> Mask:
    """(n,) whether poses (n, 4, 4) of two solvers differ by more than a share of what rounding explains."""
    differences = poses - reference
    differing: Mask = lengths(differences[:, :3, 3]) > share * COMPUTED_MM
    differing |= np.abs(differences[:, :3, :3]).max(axis=(1, 2)) > share * COMPUTED_AXIS
    return differing


def grid_of(chain: Chain, joints: Array) -> Array:
    """Joint values (m, axes) on which two solvers that agree do so everywhere: three of each turning axis, two of each that
    slides. The entries of a pose are a sum of constants, sines and cosines in each angle, and of degree one in each way;
    so is their difference."""
    low, high = np.nanmin(joints, axis=0), np.nanmax(joints, axis=0)
    end_values = np.stack([low, np.where(high > low, high, low + 1.0)], axis=1)
    values = [
        ends if slides else THIRDS for ends, slides in zip(end_values, chain.sliding, strict=True)
    ]
    grid: Array = np.stack(np.meshgrid(*values, indexing="ij"), axis=-1).reshape(-1, chain.axes)
    return grid
