# SPDX-License-Identifier: LGPL-2.1-or-later
"""Check whether a text leads to the planned points: positions, axis values, limits and solvers."""

from __future__ import annotations

import numpy as np

from .. import kdl as kdl_chain
from ..core.geometry import frames
from ..core.geometry.columns import lengths
from ..core.geometry.formatting import format_deviation
from ..core.issues import NOTE, Issue, Text
from ..core.kinematics.cell import Cell
from ..core.kinematics.chain import Chain
from ..core.program import OFF_WAY_MM, OFF_WAY_RAD, Program
from ..core.read_moves import ReadMoves
from ..core.types import Array, Index, Mask
from .text_path import (
    COMPUTED_AXIS,
    COMPUTED_MM,
    Joints,
    Path,
    Planned,
    digits,
    given_by_position,
    pieces,
    positions_path,
    tip_bounds,
)

# fractions of a move at which the path between two points is checked
BETWEEN = np.array([1.0, 2.0, 3.0, 4.0, 5.0]) / 6.0


def rapids_between(
    cell: Cell, planned: Planned, text: Joints, path: Path, linear: Mask
) -> tuple[float, float, Mask]:
    """Return the maximum deviation of the tip, mm, and of the tool axis, deg, on rapids.

    Also return the moves (n,) whose deviation from the checked rapid exceeds the rounding of the
    text. The text decides whether a move is straight in the joints or (linear) at the tip.
    """
    off, ends = np.zeros(len(planned.deposit), dtype=bool), planned.rapids
    if not len(ends):
        return 0.0, 0.0, off
    looked_at = _between(planned.joints, ends)
    tip, tool = _tips(cell, looked_at)
    driven_tip, driven_tool = _tips(cell, _between(text.serial, ends))
    straight_tip, straight_tool = _between(path.position, ends), _between(path.tool, ends)
    along = np.repeat(linear[ends], len(BETWEEN))[:, None]
    distances = np.linalg.norm(np.where(along, straight_tip, driven_tip) - tip, axis=1)
    tilted = np.linalg.norm(np.where(along, straight_tool, driven_tool) - tool, axis=1)
    bound, tool_bound = tip_bounds(cell, looked_at, _between(text.reach, ends))
    # a linear rapid may leave the path that was checked in the joints only by OFF_WAY. Near a
    # singularity, rounding may explain more than the clearance of rapids can spare; such a text is
    # rejected
    allowed = np.where(along[:, 0], OFF_WAY_MM, np.minimum(bound, OFF_WAY_MM))
    wrong = ~(
        (distances <= allowed) & (tilted <= np.maximum(tool_bound, OFF_WAY_RAD * along[:, 0]))
    )
    off[ends] = wrong.reshape(len(ends), -1).any(axis=1)
    return float(distances.max()), float(np.degrees(tilted.max())), off


def _between(rows: Array, ends: Index) -> Array:
    """Return intermediate points (len(ends) * len(BETWEEN), ...) of straight moves to the rows
    `ends`.
    """
    step = (rows[ends] - rows[ends - 1])[:, None]
    between: Array = (rows[ends - 1, None] + BETWEEN[:, None] * step).reshape(-1, rows.shape[1])
    return between


def _tips(cell: Cell, serial: Array) -> tuple[Array, Array]:
    return cell.tip_in_part(cell.machine.chain.forward(serial))


def beads_between(
    cell: Cell, planned: Planned, controller_values: Array, path: Path, chord_error: float
) -> tuple[float, Mask]:
    """Return the maximum distance of the tip from the planned segments while joints move straight,
    and the moves that are too far off.

    Only moves whose upper bound exceeds the tolerance or the maximum so far are evaluated. The
    bound is the larger deviation at the two end points plus the bow.
    """
    serial, ends = cell.machine.from_controller(controller_values), planned.ends
    largest, off = 0.0, np.zeros(len(controller_values), dtype=bool)
    upper_bounds = _larger_at_ends(lengths(path.position - planned.position), ends) + _bow(
        cell, serial, ends
    )
    upper_bounds[~(upper_bounds <= chord_error + _larger_at_ends(path.bound, ends))] = np.inf
    falling = np.argsort(-upper_bounds)
    for candidates in pieces(falling):
        if upper_bounds[candidates[0]] <= largest:
            break
        rows = ends[candidates]
        tips = cell.tip_at(_between(serial, rows))
        strayed, off[rows] = _off_segments(planned, rows, tips, path, chord_error)
        largest = float(np.maximum(largest, strayed))
    return largest, off


def _larger_at_ends(values: Array, ends: Index) -> Array:
    """Return the larger value (len(ends),) of the row `ends` and the row before; NaN if either is
    NaN.
    """
    return np.maximum(values[ends - 1], values[ends])


def _bow(cell: Cell, serial: Array, ends: Index) -> Array:
    """Return the maximum distance (len(ends),) of the tip from its chord, mm, on straight joint
    moves to the rows `ends`.

    The bow is an eighth of the second derivative of the tip. In this derivative, each rotation acts
    on every other rotation over a lever of at most the chain length, and twice on prismatic axes.
    """
    chain, slides = cell.machine.chain, cell.machine.chain.sliding
    links = [*chain.origins, chain.flange, cell.poses.carried, cell.poses.station]
    lever = (
        sum(np.linalg.norm(link[:3, 3]) for link in links)
        + np.abs(serial[:, slides]).max(axis=0).sum()
    )
    step = np.abs(serial[ends] - serial[ends - 1])
    turned, slid = step[:, ~slides].sum(axis=1), step[:, slides].sum(axis=1)
    bow: Array = turned * (0.125 * lever * turned + 0.25 * slid)
    return bow


def tools_between(
    cell: Cell, planned: Planned, flanges: Array, tools: Array, path: Path, chord_error: float
) -> tuple[float, Mask]:
    """Return the same results as `beads_between` for tools that move straight in Cartesian space.

    flanges: (n, 4, 4) poses. tools: (n, 4, 4), a different tool at each point.
    """
    largest, off = 0.0, np.zeros(len(flanges), dtype=bool)
    for ends in pieces(planned.ends):
        flanges_between = (
            _straight(flanges[ends - 1] @ tools[ends], flanges[ends] @ tools[ends])
            @ frames.inverse(tools[ends])[:, None]
        )
        strayed, off[ends] = _off_segments(
            planned, ends, cell.tip_in_part(flanges_between.reshape(-1, 4, 4))[0], path, chord_error
        )
        largest = float(np.maximum(largest, strayed))
    return largest, off


def _off_segments(
    planned: Planned, ends: Index, tips: Array, path: Path, chord_error: float
) -> tuple[float, Mask]:
    """Return the maximum distance of tips (len(ends) * len(BETWEEN), 3) from the planned segments.

    The segments end at the rows `ends`. Also return the segments (len(ends),) at which the distance
    exceeds the chord error plus the rounding at the end points.
    """
    tips = tips.reshape(len(ends), len(BETWEEN), 3)
    start, step = planned.position[ends - 1], planned.position[ends] - planned.position[ends - 1]
    offsets = tips - start[:, None]
    squared = np.maximum(np.einsum("ni,ni->n", step, step), 1e-300)
    share = np.clip(np.einsum("nki,ni->nk", offsets, step) / squared[:, None], 0.0, 1.0)
    offsets -= share[..., None] * step[:, None]
    squared_distances = np.einsum("nki,nki->nk", offsets, offsets)
    distance = np.sqrt(np.maximum.reduce([squared_distances[:, k] for k in range(len(BETWEEN))]))
    return float(distance.max()), ~(distance <= chord_error + _larger_at_ends(path.bound, ends))


def _straight(start: Array, end: Array) -> Array:
    """Interpolate poses (n, len(BETWEEN), 4, 4) from start to end (n, 4, 4): linear in position,
    with a rotation about one axis.
    """
    turn = np.swapaxes(start[:, :3, :3], 1, 2) @ end[:, :3, :3]
    axis = 0.5 * np.stack(
        [
            turn[:, 2, 1] - turn[:, 1, 2],
            turn[:, 0, 2] - turn[:, 2, 0],
            turn[:, 1, 0] - turn[:, 0, 1],
        ],
        1,
    )
    sine = np.linalg.norm(axis, axis=1)
    angle = np.arctan2(sine, 0.5 * (np.trace(turn, axis1=1, axis2=2) - 1.0))
    axis = np.where(sine[:, None] > 1e-12, axis / np.maximum(sine, 1e-12)[:, None], [0.0, 0.0, 1.0])
    rotated = start[:, None, :3, :3] @ frames.rotation_about(
        axis[:, None], BETWEEN * angle[:, None]
    )
    return frames.pose(
        rotated, start[:, None, :3, 3] + BETWEEN[:, None] * (end - start)[:, None, :3, 3]
    )


ROW_STRIDE = 8  # PyKDL computes every eighth row of a long text
THIRDS = np.array([0.0, 2.0, 4.0]) * np.pi / 3.0
GRID_TO_ALL = (
    5.0 / 3.0
)  # maximum of a sum of a constant, a sine and a cosine, relative to its maximum at three angles


def joint_issues(cell: Cell, planned: Planned, text: ReadMoves, continuous: Mask) -> list[Issue]:
    """Compare joint values with the planned values. The tip does not reveal the tool rotation."""
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
            "axis {} is up to {:.3g} {} off the planned value",
            cell.machine.axes[axis],
            largest,
            cell.machine.units[axis],
        )
        issues += planned.issue("VERIFY_JOINT", wrong[:, axis], message)
    return issues


def limit_issues(cell: Cell, planned: Planned, text: Joints) -> list[Issue]:
    """Return issues if joints exceed the limits of the cell by more than the rounding of the text."""
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
        "the program moves {} up to {:.3g} {} beyond its limit", limits.labels[label], excess, unit
    )
    return planned.issue("VERIFY_LIMIT", wrong, message)


def point_issues(planned: Planned, path: Path) -> list[Issue]:
    off = lengths(path.position - planned.position)
    tilted = lengths(path.tool - planned.tool)
    message = Text(
        "the program moves the tip up to {} mm away from the planned point, more than the "
        "rounding of its numbers explains",
        format_deviation(float(off.max())),
    )
    issues = planned.issue("VERIFY_POINT", ~(off <= path.bound), message)
    message = Text(
        "the program tilts the tool by up to {:.3g} deg off the plan, more than the rounding of "
        "its numbers explains",
        np.degrees(tilted.max()),
    )
    return issues + planned.issue("VERIFY_TOOL", ~(tilted <= path.tool_bound), message)


def twice_issues(
    cell: Cell, planned: Planned, program: Program, text: ReadMoves, flange: Array
) -> list[Issue]:
    """Check positions that a text gives in addition to joint values, as at an arc start.

    These positions must match the planned points and flange poses (n, 4, 4).
    """
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
        "VERIFY_POINT", twice & off, "the position in the program does not match its joint values"
    )


def turned_otherwise(text_flanges: Array, flange: Array, path: Path) -> Mask:
    """Whether flanges (n, 4, 4) are rotated by more than rounding explains.

    A rotation by an angle a changes the Frobenius norm of the matrix by sqrt(2) a.
    """
    differences = np.linalg.norm(text_flanges[:, :3, :3] - flange[:, :3, :3], axis=(1, 2))
    return np.asarray(differences > np.sqrt(2.0) * path.tool_bound)


def second_opinion(
    cell: Cell, planned: Planned, controller_values: Array, flange: Array
) -> tuple[list[Issue], tuple[str, ...]]:
    """Compare the flange poses with PyKDL for the same joint values, if PyKDL is installed.

    For long texts, PyKDL computes some rows and a grid of joint values (docs/decisions/0022).
    """
    if not kdl_chain.available():
        message = "PyKDL is not installed, so only one solver checked the program"
        return [Issue(NOTE, "VERIFY_ONE_SOLVER", message)], ("chain",)
    arm, wrong = kdl_chain.KdlArm(cell.machine), np.zeros(len(controller_values), dtype=bool)
    grid = grid_of(cell.machine.chain, planned.joints)
    long = len(controller_values) > ROW_STRIDE * len(grid)
    if long:
        # away from the grid, a difference may grow by GRID_TO_ALL with each rotary axis
        share = GRID_TO_ALL ** -np.count_nonzero(~cell.machine.chain.sliding)
        wrong |= _differ(arm.forward(grid), cell.machine.chain.forward(grid), share).any()
    for rows in pieces(np.arange(0, len(controller_values), ROW_STRIDE if long else 1)):
        wrong[rows] |= _differ(
            arm.forward(cell.machine.from_controller(controller_values[rows])), flange[rows]
        )
    issues = planned.issue(
        "VERIFY_SOLVERS",
        wrong,
        "PyKDL and the joint-frame chain compute different poses for this program",
    )
    return issues, ("chain", "pykdl")


def _differ(poses: Array, reference: Array, share: float = 1.0) -> Mask:
    """Whether poses (n, 4, 4) of two solvers differ by more than a fraction of the rounding error."""
    differences = poses - reference
    differing: Mask = lengths(differences[:, :3, 3]) > share * COMPUTED_MM
    differing |= np.abs(differences[:, :3, :3]).max(axis=(1, 2)) > share * COMPUTED_AXIS
    return differing


def grid_of(chain: Chain, joints: Array) -> Array:
    """Return joint values (m, axes) such that solvers that agree on them agree everywhere.

    The grid has three values of each rotary axis and two of each prismatic axis. Pose entries, and
    so their difference, are sums of a constant, a sine and a cosine in each angle, and linear in
    each prismatic value.
    """
    low, high = np.nanmin(joints, axis=0), np.nanmax(joints, axis=0)
    end_values = np.stack([low, np.where(high > low, high, low + 1.0)], axis=1)
    values = [
        ends if slides else THIRDS for ends, slides in zip(end_values, chain.sliding, strict=True)
    ]
    grid: Array = np.stack(np.meshgrid(*values, indexing="ij"), axis=-1).reshape(-1, chain.axes)
    return grid
