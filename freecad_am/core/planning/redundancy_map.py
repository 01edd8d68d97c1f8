# SPDX-License-Identifier: LGPL-2.1-or-later
"""The redundancy map: machine state over the points of a path and a full turn of tool rotation.

Each cell of the map is an independent point, rated as the planner rates it: by the closed form of
all branches, with limited axes shifted by whole turns to the middle of their range. Effects along
a curve, such as an axis that exceeds its range along a bead, are shown by `redundancy_curve`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..collision.scene import depositing, scene
from ..geometry import frames
from ..geometry.frames import TURN, shortest
from ..geometry.obstacles import Body, disc
from ..kinematics.cell import Cell
from ..kinematics.links.contact import ArmContact
from ..toolpath import Bead
from ..types import Array, Index, Mask
from .findings import ROUNDING
from .points import Points
from .task import UNREACHABLE, LimitRows, Task, append_external

RZ, ROTATION = "rz", "rotation"
ROWS, MAX_COLUMNS = 181, 300
MIN_POINTS_PER_BEAD = 12  # fewer points make the curve of a bead unreadable


@dataclass(frozen=True, eq=False)
class Columns:
    """Sampled points of a path, one per column.

    bead: (C,) bead index. point: (C,) point index in the bead. points: the independent points.
    """

    bead: Index
    point: Index
    points: Points

    def __len__(self) -> int:
        return len(self.bead)


@dataclass(frozen=True, eq=False)
class RedundancyMap:
    """A map of R rows by C columns.

    columns: the points. axis: quantity of the rows, RZ or ROTATION. values: (R,) row values, rad.
    phi: (R, C) rotation about the tool axis, rad. margin: (8, R, C) limit margin per branch, 1 at
    mid-range, 0 at a limit, -inf out of reach. touching: (C,) whether the nozzle touches the
    platform or a body at any rotation. outside: (R, C) whether the job forbids the rotation.
    """

    columns: Columns
    axis: str
    values: Array
    phi: Array
    margin: Array
    touching: Mask
    outside: Mask


@dataclass(frozen=True, eq=False)
class Picture:
    """One branch of a map.

    margin, condition: (R, C). threshold: (C,) required minimum condition. outside: (R, C) cells
    outside the allowed rotation range. forbidden: (R, C) cells outside this range or with nozzle
    contact. arm: (R, C) cells with robot link contact; None before this check.
    """

    branch: int
    margin: Array
    condition: Array
    threshold: Array
    outside: Mask
    forbidden: Mask
    arm: Mask | None = None

    @property
    def hatched(self) -> Mask:
        """(R, C) cells with a forbidden rotation, nozzle contact or robot contact."""
        return self.forbidden if self.arm is None else self.forbidden | self.arm

    @property
    def reachable(self) -> Mask:
        """(R, C) cells within reach."""
        return np.asarray(self.margin > UNREACHABLE)

    @property
    def past_limit(self) -> Mask:
        """(R, C) cells beyond a joint limit."""
        return self.reachable & (self.margin < -ROUNDING)

    @property
    def singular(self) -> Mask:
        """(R, C) cells too close to a singularity."""
        return self.reachable & (self.threshold - self.condition > ROUNDING)

    @property
    def feasible(self) -> Mask:
        """(R, C) cells without reach, limit, singularity or rotation range errors."""
        return self.reachable & ~self.past_limit & ~self.singular & ~self.outside


def columns(beads: Sequence[Bead], cell: Cell, max_columns: int = MAX_COLUMNS) -> Columns:
    """Return evenly spaced points of the beads, including their ends.

    Take an even selection of beads if `max_columns` does not allow MIN_POINTS_PER_BEAD points for
    every bead.

    Parameters
    ----------
    beads : sequence of Bead
        The beads.
    cell : Cell
        The cell.
    max_columns : int, optional
        Target number of points.

    Returns
    -------
    Columns
        The points, each as a separate bead.
    """
    counts = np.array([len(bead) for bead in beads])
    bead_numbers = list(range(len(beads)))
    if counts.sum() > max_columns and MIN_POINTS_PER_BEAD * len(beads) > max_columns:
        bead_count = max(1, max_columns // MIN_POINTS_PER_BEAD)
        even_numbers = np.round(np.linspace(0, len(beads) - 1, bead_count))
        bead_numbers = np.unique(even_numbers.astype(int)).tolist()
        share = np.full(len(bead_numbers), max_columns // len(bead_numbers))
    else:
        share = np.maximum(2, counts * max_columns // max(int(counts.sum()), max_columns))
    point_indices = []
    for k, number in zip(bead_numbers, share):
        point_count = min(int(number), int(counts[k]))
        even_points = np.round(np.linspace(0, counts[k] - 1, point_count))
        point_indices.append(np.unique(even_points.astype(np.int64)))

    def sampled(name: str) -> Array:
        columns_of_beads = zip((getattr(beads[k], name) for k in bead_numbers), point_indices)
        values: Array = np.concatenate([column[index] for column, index in columns_of_beads])
        return values

    position = sampled("points")
    tool = sampled("tool")
    parameter = sampled("parameter")
    return Columns(
        np.repeat(np.array(bead_numbers), [len(index) for index in point_indices]),
        np.concatenate(point_indices),
        single_points(
            cell,
            position,
            tool,
            parameter,
            external_of(cell, [beads[k] for k in bead_numbers], point_indices),
        ),
    )


def external_of(cell: Cell, beads: Sequence[Bead], point_indices: Sequence[Index]) -> Array | None:
    """Return the external axis values at selected points.

    Parameters
    ----------
    cell : Cell
        The cell.
    beads : sequence of Bead
        The beads.
    point_indices : sequence of Index
        Indices of the selected points, per bead.

    Returns
    -------
    (T, k) array or None
        Values, rad or mm; None for a cell without external axes.
    """
    if cell.external is None:
        return None
    external_values: Array = np.concatenate(
        [planned_external(bead)[index] for bead, index in zip(beads, point_indices, strict=True)]
    )
    return external_values


def planned_external(bead: Bead) -> Array:
    """Return the planned external axis values along a bead.

    Parameters
    ----------
    bead : Bead
        A bead from a plan with external axes.

    Returns
    -------
    (n, k) array
        Values, rad or mm.
    """
    assert bead.external is not None  # a plan with external axes sets them for each bead
    return bead.external


def single_points(
    cell: Cell, position: Array, tool: Array, parameter: Array, external: Array | None
) -> Points:
    """Return points, each as a separate bead.

    Parameters
    ----------
    cell : Cell
        The cell.
    position : (T, 3) array
        Points in the part frame, mm.
    tool : (T, 3) array
        Tool axes in the part frame.
    parameter : (T,) array
        Bead parameter.
    external : (T, k) array or None
        External axis values.

    Returns
    -------
    Points
        The points with their pose frames.
    """
    number, slides = np.arange(len(position)), cell.machine.chain.sliding
    return Points(
        position,
        tool,
        parameter,
        number,
        number,
        np.zeros(len(number), dtype=bool),
        cell.pose_frames(position, tool, external),
        external,
        slides if slides.any() else None,
    )


def redundancy_map(
    task: Task,
    map_columns: Columns,
    axis: str = RZ,
    bodies: Sequence[Body] = (),
    values: Array | None = None,
) -> RedundancyMap:
    """Return the map of all branches for given columns.

    Parameters
    ----------
    task : Task
        The plan, including cell, limits and rotation range.
    map_columns : Columns
        C points.
    axis : str, optional
        Quantity of the rows, RZ or ROTATION.
    bodies : sequence of Body, optional
        Obstacles in part coordinates.
    values : (R,) array or None, optional
        Row values, rad; None for a full turn.

    Returns
    -------
    RedundancyMap
        A map of R rows by C columns.
    """
    values = np.linspace(-np.pi, np.pi, ROWS) if values is None else values
    phi = rotation_of(task.cell, map_columns.points.tool, values[:, None], axis)
    joints = _joints_of_branches(task, map_columns.points, phi)
    margin = _margin(task, task.given_rows, joints)
    low, high = task.parameters.rotation_range
    outside = np.zeros(phi.shape, dtype=bool)
    if high - low < TURN - 1e-9:
        outside = (phi - low) % TURN > high - low + ROUNDING
    return RedundancyMap(
        map_columns,
        axis,
        values,
        phi,
        margin,
        _touching(task.cell, map_columns.points, bodies),
        outside,
    )


def picture(task: Task, redundancy: RedundancyMap, branch: int) -> Picture:
    """Return one branch of a map, including its condition.

    Parameters
    ----------
    task : Task
        The plan.
    redundancy : RedundancyMap
        The map.
    branch : int
        Index of the branch.

    Returns
    -------
    Picture
        Margin, condition and forbidden cells of the branch.
    """
    branch_task = dataclasses.replace(task, branch=branch)
    points = redundancy.columns.points
    flange = points.frames.flange_poses(redundancy.phi).reshape(-1, 4, 4)
    condition = branch_task.condition_at(
        flange, branch_task.arm.inverse_branch(flange, branch)
    ).reshape(redundancy.phi.shape)
    return Picture(
        branch,
        redundancy.margin[branch],
        condition,
        branch_task.thresholds(points),
        redundancy.outside,
        redundancy.outside | redundancy.touching,
    )


def arm_touched(
    task: Task,
    redundancy: RedundancyMap,
    branch: int,
    arm: ArmContact,
    moment: Index,
    row_stride: int = 1,
) -> Mask:
    """Return the cells of a branch in which a robot link touches an obstacle.

    Obstacles are nozzle, platform, bodies and the deposit printed before each column. Cells that
    are infeasible for another reason are not checked.

    Parameters
    ----------
    task : Task
        The plan.
    redundancy : RedundancyMap
        The map of R rows by C columns.
    branch : int
        Index of the branch.
    arm : ArmContact
        The contact check.
    moment : (C,) int array
        Number of points printed before each column.
    row_stride : int, optional
        Check every n-th row; its result also applies to the rows around it.

    Returns
    -------
    (R, C) bool array
        Cells with contact.
    """
    count = len(redundancy.values)
    rows = np.arange(min(row_stride // 2, count - 1), count, row_stride)
    branch_task = dataclasses.replace(task, branch=branch)
    points = redundancy.columns.points
    joints = branch_task.arm.inverse_branch(
        points.frames.flange_poses(redundancy.phi[rows]).reshape(-1, 4, 4), branch
    )
    if points.external is not None:
        joints = append_external(joints, np.tile(points.external, (len(rows), 1)))
    considered = (
        (redundancy.margin[branch] >= -ROUNDING) & ~redundancy.outside & ~redundancy.touching
    )
    joints[~considered[rows].ravel()] = np.nan
    touches = arm.touches(joints, np.tile(moment, len(rows))).any.reshape(len(rows), -1)
    return np.asarray(
        touches[np.minimum(np.arange(count) // row_stride, len(rows) - 1)] & considered
    )


def rotation_of(cell: Cell, tool: Array, value: Array, axis: str) -> Array:
    """Convert values on the axis of a map to rotations phi.

    Parameters
    ----------
    cell : Cell
        The cell.
    tool : (C, 3) array
        Tool axes in the part frame.
    value : (..., C) array
        Axis values, rad.
    axis : str
        RZ or ROTATION.

    Returns
    -------
    (..., C) array
        Rotations about the tool axes, rad.

    Notes
    -----
    Inverts `CellPoses.rz_of_phi` (Chalvin 2020, eqs. 9 and 10).
    """
    if axis == ROTATION:
        return np.array(np.broadcast_to(value, np.broadcast_shapes(value.shape, (len(tool),))))
    # eqs. 9 and 10 solved for phi; CellPoses.rz_of_phi solves them for RZ
    upright = frames.smallest_rotation(tool @ cell.poses.mount[:3, :3], (0.0, 0.0, 1.0))
    sin, cos = np.sin(value), np.cos(value)
    return np.asarray(
        np.arctan2(
            upright[:, 0, 0] * sin + upright[:, 0, 1] * cos,
            upright[:, 1, 0] * sin + upright[:, 1, 1] * cos,
        )
    )


def value_of(cell: Cell, tool: Array, phi: Array, axis: str) -> Array:
    """Convert rotations phi to values on the axis of a map.

    Parameters
    ----------
    cell : Cell
        The cell.
    tool : (C, 3) array
        Tool axes in the part frame.
    phi : (C,) array
        Rotations about the tool axes, rad.
    axis : str
        RZ or ROTATION.

    Returns
    -------
    (C,) array
        Axis values, rad; RZ in -pi to pi.
    """
    return phi if axis == ROTATION else cell.poses.rz_of_phi(tool, phi)


def in_turns(values: Array, starts: Mask) -> Array:
    """Unwrap values along each bead.

    Parameters
    ----------
    values : (C,) array
        Angles, rad.
    starts : (C,) bool array
        True at the first column of a bead.

    Returns
    -------
    (C,) array
        Unwrapped angles; each bead starts within half a turn of 0.
    """
    step = np.diff(values, prepend=values[:1])
    step = shortest(step)
    step[starts] = 0.0
    rising = np.cumsum(step)
    start_rows = np.flatnonzero(starts)
    begin = shortest(values[start_rows])
    number = np.cumsum(starts) - 1
    return np.asarray(rising - rising[start_rows][number] + begin[number])


def joints_at(task: Task, map_columns: Columns, column: int, phi: float) -> Array:
    """Return the joints of all branches in one cell of a map.

    Parameters
    ----------
    task : Task
        The plan.
    map_columns : Columns
        The columns.
    column : int
        Column index.
    phi : float
        Rotation about the tool axis, rad.

    Returns
    -------
    (8, axes) array
        Joints, shifted by whole turns as in the map; NaN out of reach.
    """
    joints = _joints_of_branches(
        task, map_columns.points.select_points(np.array([column])), np.array([[phi]])
    )[:, 0, 0]
    turns = np.where(task.continuous, 0.0, np.round((task.middle - joints) / TURN))
    turns[:, task.cell.robot.chain.axes :] = 0.0  # external axes keep their planned values
    return np.asarray(joints + TURN * turns)


def _joints_of_branches(task: Task, points: Points, phi: Array) -> Array:
    """Return the joints (8, R, C, axes) of all branches at C points for rotations phi (R, C).

    Joints are NaN out of reach.
    """
    arm = task.cell.machine.arm
    assert arm is not None  # resolve() rejects other machines
    joints = arm.inverse(points.frames.flange_poses(phi).reshape(-1, 4, 4))[:8]
    joints = joints.reshape(len(joints), *phi.shape, -1)
    return joints if points.external is None else append_external(joints, points.external)


def _margin(task: Task, rows: LimitRows, joints: Array) -> Array:
    """Return `rows.margin` (...) for joints (..., axes).

    Shift each limited axis by whole turns to the middle of its range first.
    """
    angle = []
    for axis in range(joints.shape[-1]):
        value = joints[..., axis]
        if axis < task.cell.robot.chain.axes and not task.continuous[axis]:
            turns = np.round((task.middle[axis] - value) / TURN)
            value = value + TURN * turns if np.nan_to_num(turns).any() else value
        angle.append(value)
    worst = np.zeros(joints.shape[:-1])
    for row, mean, half in zip(rows.matrix, rows.mean, rows.half):
        value = sum(factor * angle[axis] for axis, factor in enumerate(row) if factor)
        np.maximum(worst, np.abs((value - mean) / half), out=worst)
    return np.where(np.isnan(worst + angle[0]), UNREACHABLE, 1.0 - worst)


def _touching(cell: Cell, points: Points, bodies: Sequence[Body]) -> Mask:
    """Return at which points (C,) the nozzle touches the platform or a body.

    The nozzle is symmetric about the tool axis. Its lowest part is left out, as in planning.
    """
    around = list(bodies)
    if cell.platform_diameter > 0.0:
        around.append(disc(cell.platform_diameter, cell.poses.mount))
    if not around:
        return np.zeros(len(points), dtype=bool)
    slope = float(np.tan(cell.nozzle.half_angle))
    nozzle = depositing(0.5 * cell.nozzle.diameter, slope, cell.nozzle.length, 0.0)
    return scene(around, points.position, nozzle.reach).find_touching(
        nozzle, points.position, points.tool
    )


def across(
    beads: Sequence[Bead], cell: Cell, bead_point: tuple[int, int], axis: int, values: Array
) -> Columns:
    """Return one bead point at several values of an external axis.

    Parameters
    ----------
    beads : sequence of Bead
        The beads of a plan with external axes.
    cell : Cell
        The cell.
    bead_point : tuple[int, int]
        Bead index and point index in the bead.
    axis : int
        Index of the external axis.
    values : (C,) array
        Axis values, rad or mm; the other axes keep their planned values.

    Returns
    -------
    Columns
        One column per value.
    """
    return _columns_with_external(beads, cell, bead_point, (axis,), (values,))


def across_two_axes(
    beads: Sequence[Bead],
    cell: Cell,
    bead_point: tuple[int, int],
    axes: tuple[int, int],
    values: tuple[Array, Array],
) -> Columns:
    """Return one bead point at all pairs of values of two external axes.

    Parameters
    ----------
    beads : sequence of Bead
        The beads of a plan with external axes.
    cell : Cell
        The cell.
    bead_point : tuple[int, int]
        Bead index and point index in the bead.
    axes : tuple[int, int]
        Indices of the two external axes.
    values : (C,) array and (R,) array
        Axis values, rad or mm; the other axes keep their planned values.

    Returns
    -------
    Columns
        R C columns, row by row.
    """
    across, up = np.meshgrid(*values)
    return _columns_with_external(beads, cell, bead_point, axes, (across.ravel(), up.ravel()))


def in_rows(picture: Picture, rows: int) -> Picture:
    """Reshape a picture (1, R C) of value pairs to (R, C)."""
    return dataclasses.replace(
        picture,
        margin=picture.margin.reshape(rows, -1),
        condition=picture.condition.reshape(rows, -1),
        threshold=picture.threshold.reshape(rows, -1),
        outside=picture.outside.reshape(rows, -1),
        forbidden=picture.forbidden.reshape(rows, -1),
        arm=None if picture.arm is None else picture.arm.reshape(rows, -1),
    )


def _columns_with_external(
    beads: Sequence[Bead],
    cell: Cell,
    bead_point: tuple[int, int],
    axes: tuple[int, ...],
    values: tuple[Array, ...],
) -> Columns:
    """Return one bead point at external axis values (n,)."""
    bead, point = bead_point
    count = len(values[0])
    external = np.tile(planned_external(beads[bead])[point], (count, 1))
    for axis, value in zip(axes, values, strict=True):
        external[:, axis] = value
    position, tool, parameter = (
        np.repeat(getattr(beads[bead], name)[point : point + 1], count, axis=0)
        for name in ("points", "tool", "parameter")
    )
    return Columns(
        np.full(count, bead),
        np.full(count, point),
        single_points(cell, position, tool, parameter, external),
    )


def span(task: Task, bead: Bead, point: int, axis: int, count: int) -> Array:
    """Return evenly spaced values over the range of an external axis.

    Parameters
    ----------
    task : Task
        The plan.
    bead : Bead
        A bead with planned external axes.
    point : int
        Point index in the bead.
    axis : int
        Index of the external axis.
    count : int
        Number of values.

    Returns
    -------
    (count,) array
        Values, rad or mm; for a revolute axis at most half a turn on either side of the planned
        value.
    """
    machine_axis = task.cell.robot.chain.axes + axis
    planned_value = float(planned_external(bead)[point, axis])
    low = float(task.cell.limits.lower[machine_axis])
    high = float(task.cell.limits.upper[machine_axis])
    if not task.cell.machine.chain.sliding[machine_axis]:
        low, high = max(low, planned_value - np.pi), min(high, planned_value + np.pi)
    return np.linspace(low, high, count)
