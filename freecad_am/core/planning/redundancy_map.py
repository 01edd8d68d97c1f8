# SPDX-License-Identifier: LGPL-2.1-or-later
"""The redundancy map: points of a path against a whole turn of the tool, with the machine state in
each cell.

Every cell is rated as the planner rates an independent point: by the closed form of all branches at
once, with limited axes in the turn nearest to the middle of their range. `curve` shows further
effects of a curve on the map, such as an axis that runs out of turns along a bead.
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
MIN_POINTS_PER_BEAD = 12  # points of a bead below which a curve is not readable


@dataclass(frozen=True, eq=False)
class Columns:
    """Sampled points of a path. bead: (C,) bead of each; point: (C,) point number in the bead;
    points: the points, each independent.
    """

    bead: Index
    point: Index
    points: Points

    def __len__(self) -> int:
        return len(self.bead)


@dataclass(frozen=True, eq=False)
class RedundancyMap:
    """Cells of `values` (R,) rad by columns C. axis: the kind of the values, RZ or ROTATION.

    phi: (R, C) rotation about the tool axis. margin: (8, R, C) for each branch the share left to
    the nearest limit, 1 in the middle of all ranges, 0 at a limit, -inf out of reach. touching:
    (C,) whether the nozzle meets the platform or a body, whatever the rotation. outside: (R, C)
    whether the job forbids the rotation.
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

    margin, condition: (R, C). threshold: (C,) smallest condition allowed. forbidden: (R, C) cells
    outside of the allowed rotations or with nozzle contact. arm: (R, C) cells with contact of a
    robot link, None before this check has run.
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
        """(R, C) cells in which a rotation is not allowed, or nozzle or robot touch something."""
        return self.forbidden if self.arm is None else self.forbidden | self.arm

    @property
    def reachable(self) -> Mask:
        """(R, C) cells with joint values."""
        return np.asarray(self.margin > UNREACHABLE)

    @property
    def past_limit(self) -> Mask:
        """(R, C) cells past a limit."""
        return self.reachable & (self.margin < -ROUNDING)

    @property
    def singular(self) -> Mask:
        """(R, C) cells too near to a singularity."""
        return self.reachable & (self.threshold - self.condition > ROUNDING)

    @property
    def feasible(self) -> Mask:
        """(R, C) cells in which the planner has nothing to say against a point."""
        return self.reachable & ~self.past_limit & ~self.singular & ~self.outside


def columns(beads: Sequence[Bead], cell: Cell, max_columns: int = MAX_COLUMNS) -> Columns:
    """Return points of the beads, evenly spread, ends included.

    If not all beads have room for MIN_POINTS_PER_BEAD points each, an even selection of beads
    is taken.

    Parameters
    ----------
    beads : sequence of Bead
        The beads.
    cell : Cell
        The cell.
    max_columns : int, optional
        Number of points to aim at.

    Returns
    -------
    Columns
        The points, each as a bead of one point.
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
    """Return the values of the external axes at selected points.

    Parameters
    ----------
    cell : Cell
        The cell.
    beads : sequence of Bead
        The beads.
    point_indices : sequence of Index
        The selected points of each bead.

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
    """Return the planned values of the external axes along a bead.

    Parameters
    ----------
    bead : Bead
        A bead from a plan with external axes.

    Returns
    -------
    (n, k) array
        Values, rad or mm.
    """
    assert bead.external is not None  # beads of a plan with external axes have their values
    return bead.external


def single_points(
    cell: Cell, position: Array, tool: Array, parameter: Array, external: Array | None
) -> Points:
    """Return points that each form a bead of one point.

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
        Values of the external axes.

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
    """Return the map of all branches for some columns.

    Parameters
    ----------
    task : Task
        The plan, with cell, limits and rotation range.
    map_columns : Columns
        C points.
    axis : str, optional
        Kind of the rows, RZ or ROTATION.
    bodies : sequence of Body, optional
        Obstacles in part coordinates.
    values : (R,) array or None, optional
        Values of the rows, rad; None for a whole turn.

    Returns
    -------
    RedundancyMap
        The map of R rows by C columns.
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
    """Return one branch of a map, with its condition.

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
    """Return the cells of a branch in which a link of the robot touches an obstacle.

    Obstacles are nozzle, platform, bodies and the deposit printed before each column. Cells
    past a limit, or forbidden for another reason, are not checked.

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
        Number of printed points at each column.
    row_stride : int, optional
        One of this many rows is checked and represents its neighbours.

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
    """Return the rotations phi for values on the axis of a map.

    Parameters
    ----------
    cell : Cell
        The cell.
    tool : (C, 3) array
        Tool axes in the part frame.
    value : (..., C) array
        Values on the axis, rad.
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
    # eq. 9 and 10 solved for phi, as CellPoses.rz_of_phi has them for RZ
    upright = frames.smallest_rotation(tool @ cell.poses.mount[:3, :3], (0.0, 0.0, 1.0))
    sin, cos = np.sin(value), np.cos(value)
    return np.asarray(
        np.arctan2(
            upright[:, 0, 0] * sin + upright[:, 0, 1] * cos,
            upright[:, 1, 0] * sin + upright[:, 1, 1] * cos,
        )
    )


def value_of(cell: Cell, tool: Array, phi: Array, axis: str) -> Array:
    """Return the values on the axis of a map for rotations phi.

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
        Values, rad; RZ is in -pi to pi.
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
        Number of the column.
    phi : float
        Rotation about the tool axis, rad.

    Returns
    -------
    (8, axes) array
        Joints in the turns that the map uses; NaN out of reach.
    """
    joints = _joints_of_branches(
        task, map_columns.points.select_points(np.array([column])), np.array([[phi]])
    )[:, 0, 0]
    turns = np.where(task.continuous, 0.0, np.round((task.middle - joints) / TURN))
    turns[:, task.cell.robot.chain.axes :] = 0.0  # external axes are where they are said to be
    return np.asarray(joints + TURN * turns)


def _joints_of_branches(task: Task, points: Points, phi: Array) -> Array:
    """Return the joints (8, R, C, axes) of all branches at C points with rotations phi (R, C); NaN
    out of reach.
    """
    arm = task.cell.machine.arm
    assert arm is not None  # resolve() refuses other machines
    joints = arm.inverse(points.frames.flange_poses(phi).reshape(-1, 4, 4))[:8]
    joints = joints.reshape(len(joints), *phi.shape, -1)
    return joints if points.external is None else append_external(joints, points.external)


def _margin(task: Task, rows: LimitRows, joints: Array) -> Array:
    """(...) what `rows.margin` gives for joints (..., axes) in the turns that suit limited axes best, axis by axis."""
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
    """(C,) whether the nozzle, which is round about the tool axis, meets the platform or a body at a point; its lowest part
    is left out, as where toolpaths are kept clear."""
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
    """Return one point of the beads with varied values of an external axis.

    Parameters
    ----------
    beads : sequence of Bead
        The beads of a plan with external axes.
    cell : Cell
        The cell.
    bead_point : tuple[int, int]
        Number of the bead and of the point in it.
    axis : int
        Index of the external axis.
    values : (C,) array
        Its values, rad or mm; the other axes keep their planned values.

    Returns
    -------
    Columns
        One column for each value.
    """
    return _columns_with_external(beads, cell, bead_point, (axis,), (values,))


def across_two_axes(
    beads: Sequence[Bead],
    cell: Cell,
    bead_point: tuple[int, int],
    axes: tuple[int, int],
    values: tuple[Array, Array],
) -> Columns:
    """Return one point of the beads with all pairs of values of two external axes.

    Parameters
    ----------
    beads : sequence of Bead
        The beads of a plan with external axes.
    cell : Cell
        The cell.
    bead_point : tuple[int, int]
        Number of the bead and of the point in it.
    axes : tuple[int, int]
        Indices of the two external axes.
    values : (C,) array and (R,) array
        Their values, rad or mm; the other axes keep their planned values.

    Returns
    -------
    Columns
        R C columns, row after row.
    """
    across, up = np.meshgrid(*values)
    return _columns_with_external(beads, cell, bead_point, axes, (across.ravel(), up.ravel()))


def in_rows(picture: Picture, rows: int) -> Picture:
    """A picture (1, R C) of pairs as one (R, C)."""
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
    """One point with external axes elsewhere: each at values (n,)."""
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
    """Return values of an external axis over its range.

    Parameters
    ----------
    task : Task
        The plan.
    bead : Bead
        A bead with planned external axes.
    point : int
        Number of a point in the bead.
    axis : int
        Index of the external axis.
    count : int
        Number of values.

    Returns
    -------
    (count,) array
        Evenly spaced, rad or mm; a turning axis covers at most a turn about its planned
        value.
    """
    machine_axis = task.cell.robot.chain.axes + axis
    planned_value = float(planned_external(bead)[point, axis])
    low = float(task.cell.limits.lower[machine_axis])
    high = float(task.cell.limits.upper[machine_axis])
    if not task.cell.machine.chain.sliding[machine_axis]:
        low, high = max(low, planned_value - np.pi), min(high, planned_value + np.pi)
    return np.linspace(low, high, count)
