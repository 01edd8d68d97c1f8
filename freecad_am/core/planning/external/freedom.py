# SPDX-License-Identifier: LGPL-2.1-or-later
"""Optimise all free coordinates of one bead, as polynomials: tool rotation and external axes.

r(s) is in R^(1 + k). The rotation is the given polynomial plus a change; external axis j is its
position from a rule plus a change. All changes are polynomials of one degree over the bead
parameter. The robot follows by inverse kinematics. Its joint derivatives therefore come from a
closed chain, in which robot and external axes keep the tool on the part.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...geometry import frames
from ...kinematics import jacobian as jac
from ...kinematics.cell import Cell
from ...kinematics.external import ExternalAxes
from ...types import Array, Index
from .. import criteria
from ..points import Points
from ..task import Task

IRRELEVANT_MARGIN = (
    0.75  # condition margin above which derivatives are omitted; larger than any requested margin
)
MAX_SPEED_SHARE = 0.9  # fraction of its maximum speed that an external axis may use


@dataclass(frozen=True, eq=False)
class Bound:
    """Objective and constraints for v changes.

    objective: with derivative `slope` (v,). margins: (r,) relative margins of limits and condition,
    0 at the limit, with `margin_slopes` (r, v). hard: (h,) satisfied if >= 0, with `hard_slopes`
    (h, v).
    """

    objective: float
    slope: Array
    margins: Array
    margin_slopes: Array
    hard: Array
    hard_slopes: Array


@dataclass(frozen=True, eq=False)
class Freedom:
    """The free coordinates of one bead of T points.

    thresholds: (T,) required minimum condition. start: (degree + 1,) rotation coefficients.
    changes: (degree + 1, c) coefficients of the possible changes. allowed: maximum angle from the
    vertical, rad. directions: (T, 3) tool axes in the frame of the positioner face. times: (T,)
    duration since the previous point, s; 0 at the first point.
    """

    task: Task
    points: Points
    thresholds: Array
    start: Array
    changes: Array
    allowed: float
    directions: Array
    times: Array

    @property
    def external(self) -> ExternalAxes:
        """The external axes."""
        external_axes = self.task.cell.external
        assert external_axes is not None
        return external_axes

    @cached_property
    def shape(self) -> Array:
        """Return the effect of a unit change at each point.

        Returns
        -------
        (T, c) array
            Polynomial values of the changes.
        """
        return np.asarray(self.points.powers(len(self.start) - 1) @ self.changes)

    @cached_property
    def unit(self) -> Array:
        """Return the unit of changes for each external axis.

        Returns
        -------
        (k,) array
            rad or mm per unit; one characteristic length corresponds to 1 rad.
        """
        robot_axes = self.task.cell.robot.chain.axes
        sliding = self.task.cell.machine.chain.sliding[robot_axes:]
        return np.where(sliding, self.task.parameters.characteristic_length, 1.0)

    def values(self, x: Array) -> tuple[Array, Array]:
        """Return the rotation and the external axis values for changes.

        Parameters
        ----------
        x : (v,) array
            The changes: c values for the rotation, then c for each external axis.

        Returns
        -------
        coefficients : (degree + 1,) array
            Rotation coefficients in ascending order.
        external : (T, k) array
            External axis values, rad or mm.
        """
        rows = x.reshape(1 + self.external.axes, -1)
        assert self.points.external is not None
        return self.start + self.changes @ rows[0], self.points.external + self.shape @ rows[
            1:
        ].T * self.unit

    def look(self, x: Array) -> Bound | None:
        """Evaluate objective and constraints.

        Parameters
        ----------
        x : (v,) array
            Changes of the free coordinates.

        Returns
        -------
        Bound or None
            Values with derivatives; None if a point is unreachable.
        """
        task = self.task
        coefficients, values = self.values(x)
        points = set_external_values(self.points, task.cell, values)
        phi, phi_rate = task.rotation(points, points.polynomial(coefficients[None]))
        joints = task.joints(points, phi)
        if np.isnan(joints).any():
            return None
        rate, matrix = task.rotation_rates(points.frames, phi, joints)
        rates = [
            rate * phi_rate[:, None],
            *(
                joint_rate * unit
                for joint_rate, unit in zip(
                    external_rates(task.cell, points.position, joints), self.unit, strict=True
                )
            ),
        ]
        slope = np.concatenate(
            [
                criteria.rate(task, points, joints, joint_rate, matrix) @ self.shape
                for joint_rate in rates
            ]
        )
        margins, margin_slopes = self._margins(joints, rates, matrix)
        hard, hard_slopes = self._hard(values, phi, phi_rate)
        return Bound(
            float(criteria.value(task, points, joints, matrix)[0]),
            slope,
            margins,
            margin_slopes,
            hard,
            hard_slopes,
        )

    def _margins(self, joints: Array, rates: list[Array], matrix: Array) -> tuple[Array, Array]:
        rows, length = self.task.rows, self.task.parameters.characteristic_length
        offset = rows.offset(joints)
        ratio = np.maximum(jac.condition(matrix, length), 1e-12)
        values = np.concatenate(
            [1.0 - offset, 1.0 + offset, (1.0 - self.thresholds / ratio)[:, None]], axis=1
        )
        close_rows, slopes = values[:, -1] < IRRELEVANT_MARGIN, []
        for joint_rate in rates:
            along, turned = joint_rate @ rows.matrix.T / rows.half, np.zeros(len(ratio))
            if close_rows.any():
                change = np.nan_to_num(
                    criteria.condition_rate(
                        self.task, joints[close_rows], joint_rate[close_rows], matrix[close_rows]
                    )
                )
                turned[close_rows] = change * self.thresholds[close_rows] / ratio[close_rows] ** 2
            slopes.append(self._by_number(np.concatenate([-along, along, turned[:, None]], axis=1)))
        return values.T.ravel(), np.concatenate(slopes, axis=1)

    def _hard(self, values: Array, phi: Array, phi_rate: Array) -> tuple[Array, Array]:
        """Return the constraints on tool tilt, rotation range and speed of the external axes."""
        constraints, count = [], 1 + self.external.axes
        if self.allowed < np.pi - 1e-9:
            constraints.append(self._tilts(values))
        low, high = self.task.parameters.rotation_range
        if high - low < 2.0 * np.pi - 1e-9:
            share = (phi - 0.5 * (low + high)) / (0.5 * (high - low))
            rate = phi_rate / (0.5 * (high - low))
            none = [np.zeros((len(phi), 2))] * (count - 1)
            constraints.append(
                (
                    np.concatenate([1.0 - share, 1.0 + share]),
                    np.concatenate(
                        [
                            self._by_number(column)
                            for column in (np.stack([-rate, rate], axis=1), *none)
                        ],
                        axis=1,
                    ),
                )
            )
        constraints.append(self._speeds(values))
        return np.concatenate([value for value, _ in constraints]), np.concatenate(
            [slope for _, slope in constraints]
        )

    def _tilts(self, values: Array) -> tuple[Array, Array]:
        external = self.external
        upright = external.upright(self.directions, values)
        slopes = [np.zeros((len(upright), 1)) for _ in range(1 + external.axes)]
        for axis, axis_index in zip(axes_in_world(external, values), external.turned, strict=True):
            slopes[1 + axis_index] = (np.cross(axis, upright) @ external.up)[:, None] * self.unit[
                axis_index
            ]
        value = upright @ external.up - np.cos(self.allowed)
        return value, np.concatenate([self._by_number(slope) for slope in slopes], axis=1)

    def _speeds(self, values: Array) -> tuple[Array, Array]:
        robot_axes, k = self.task.cell.robot.chain.axes, self.external.axes
        assert self.points.external is not None
        fastest = self.task.cell.machine.max_speed[robot_axes:]
        max_step = np.maximum(
            MAX_SPEED_SHARE * fastest * self.times[1:, None],
            np.abs(np.diff(self.points.external, axis=0)),
        )
        step, change = np.diff(values, axis=0) / max_step, np.diff(self.shape, axis=0)
        slopes = np.zeros((k, len(step), (1 + k) * self.shape.shape[1]))
        for j in range(k):
            columns = slice((1 + j) * self.shape.shape[1], (2 + j) * self.shape.shape[1])
            slopes[j, :, columns] = change * self.unit[j] / max_step[:, j : j + 1]
        rates = slopes.reshape(-1, slopes.shape[-1])
        step = step.T.ravel()
        return np.concatenate([1.0 - step, 1.0 + step]), np.concatenate([-rates, rates])

    def _by_number(self, slopes: Array) -> Array:
        """Convert derivatives (T, m) by polynomial value to derivatives (m T, c) by change."""
        return np.asarray((slopes.T[:, :, None] * self.shape).reshape(-1, self.shape.shape[1]))


def set_external_values(points: Points, cell: Cell, values: Array) -> Points:
    """Return the points with new external axis values.

    Parameters
    ----------
    points : Points
        T points.
    cell : Cell
        The cell, for the pose frames.
    values : (T, k) array
        External axis values, rad or mm.

    Returns
    -------
    Points
        The points, with new pose frames.
    """
    return dataclasses.replace(
        points, external=values, frames=cell.pose_frames(points.position, points.tool, values)
    )


def external_rates(cell: Cell, position: Array, joints: Array) -> list[Array]:
    """Return the joint rates for motion of each external axis, with the tool fixed on the part.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    position : (T, 3) array
        Points in the part frame, mm.
    joints : (T, axes) array
        Joints of robot and external axes, rad or mm.

    Returns
    -------
    list of (T, axes) array
        d q / d e per external axis.
    """
    robot_axes, count = cell.robot.chain.axes, cell.machine.chain.axes
    stands = cell.poses.station @ frames.inverse(cell.poses.mount)
    jacobian = jac.jacobian(cell.machine.chain, joints, position @ stands[:3, :3].T + stands[:3, 3])
    robot, external = jacobian[:, :, :robot_axes], jacobian[:, :, robot_axes:]
    try:
        follows = -np.linalg.solve(robot, external)
    except np.linalg.LinAlgError:
        follows = -np.linalg.pinv(robot) @ external
    rates = []
    for j in range(count - robot_axes):
        rate = np.zeros((len(joints), count))
        rate[:, :robot_axes], rate[:, robot_axes + j] = follows[:, :, j], 1.0
        rates.append(rate)
    return rates


def axes_in_world(external: ExternalAxes, values: Array) -> list[Array]:
    """Return the directions of the positioner axes in the world.

    Parameters
    ----------
    external : ExternalAxes
        The external axes.
    values : (T, k) array
        External axis values, rad or mm.

    Returns
    -------
    list of (T, 3) array
        Unit vectors of each positioner axis, starting at the floor.
    """
    world_axes = []
    for number, axis in enumerate(external.turning):
        direction = np.tile(axis, (len(values), 1))
        for earlier_axis, row in reversed(
            list(zip(external.turning[:number], external.turned[:number], strict=True))
        ):
            direction = np.einsum(
                "nij,nj->ni", frames.rotation_about(earlier_axis, values[:, row]), direction
            )
        world_axes.append(direction)
    return world_axes


ROUNDS = 4  # optimiser runs; each adds the constraints that the previous run came close to
ACTIVE = 0.1  # excess margin above which the first run omits a constraint
ITERATIONS, TOLERANCE = 80, 1e-7
# Maximum change of a variable in further attempts, if the attempt without bounds ends outside its
# constraints. SLSQP may step across a singularity and not return. Whether it does depends on the
# last bits of the processor's results.
CLOSER = (0.5, 0.1)
VIOLATION = 1e-5  # violation that counts as satisfied, unless the start violates more
# objective of an unreachable state, relative to the objective at the start
UNREACHABLE_OBJECTIVE = 1e3


class Seen:
    """Caches the bound of the last changes, so that value and derivatives cost one evaluation."""

    def __init__(self, freedom: Freedom) -> None:
        self.freedom, self.key = freedom, b""
        self.found: Bound | None = None

    def bound_at(self, x: Array) -> Bound | None:
        """Return objective and constraints, cached for the last changes.

        Parameters
        ----------
        x : (v,) array
            Changes of the free coordinates.

        Returns
        -------
        Bound or None
            Result of `Freedom.look`.
        """
        if x.tobytes() != self.key:
            self.key, self.found = x.tobytes(), self.freedom.look(x)
        return self.found


def least_objective(freedom: Freedom, start: Array, margin: float) -> tuple[Array, int]:
    """Minimise the objective of a bead for a given margin.

    Parameters
    ----------
    freedom : Freedom
        The free coordinates of the bead.
    start : (v,) array
        Start changes.
    margin : float
        Required minimum margin of limits and condition.

    Returns
    -------
    x : (v,) array
        Changes with the minimum objective.
    iterations : int
        SLSQP iterations.
    """
    cache = Seen(freedom)
    initial = cache.bound_at(start)
    scale = 1.0 if initial is None else max(initial.objective, 1e-12)

    def value(z: Array) -> tuple[float, Array]:
        state = cache.bound_at(z)
        return (
            (UNREACHABLE_OBJECTIVE, np.zeros(len(z)))
            if state is None
            else (state.objective / scale, np.nan_to_num(state.slope) / scale)
        )

    def constraint_values(state: Bound, z: Array) -> tuple[Array, Array]:
        return np.concatenate([state.margins - margin, state.hard]), np.concatenate(
            [state.margin_slopes, state.hard_slopes]
        )

    return _solved(cache, start, start, value, constraint_values)


def largest_margin(
    freedom: Freedom, start: Array, objective: float, enough: float
) -> tuple[Array, int]:
    """Maximise the margin of a bead for a given objective.

    Parameters
    ----------
    freedom : Freedom
        The free coordinates of the bead.
    start : (v,) array
        Start changes.
    objective : float
        Maximum objective.
    enough : float
        Margin at which the search stops.

    Returns
    -------
    x : (v,) array
        The changes; the start if it is unreachable or has enough margin.
    iterations : int
        SLSQP iterations.
    """
    cache, v = Seen(freedom), len(start)
    initial = cache.bound_at(start)
    if initial is None or initial.margins.min() >= enough:
        return start, 0
    scale = max(objective, 1e-12)

    def value(z: Array) -> tuple[float, Array]:
        return float(-z[-1]), np.concatenate([np.zeros(v), [-1.0]])

    def constraint_values(state: Bound, z: Array) -> tuple[Array, Array]:
        values = np.concatenate(
            [
                state.margins - z[-1],
                state.hard,
                [(objective - state.objective) / scale, enough - z[-1]],
            ]
        )
        slopes = np.zeros((len(values), v + 1))
        count = len(state.margins)
        slopes[:count, :v], slopes[:count, v] = state.margin_slopes, -1.0
        slopes[count : count + len(state.hard), :v] = state.hard_slopes
        slopes[-2, :v], slopes[-1, v] = -np.nan_to_num(state.slope) / scale, -1.0
        return values, slopes

    z, count = _solved(
        cache, start, np.append(start, initial.margins.min()), value, constraint_values
    )
    return z[:v], count


def _solved(
    cache: Seen,
    start: Array,
    z: Array,
    value: Callable[[Array], tuple[float, Array]],
    constraint_values: Callable[[Bound, Array], tuple[Array, Array]],
) -> tuple[Array, int]:
    """Return the best z that SLSQP finds.

    SLSQP runs again if z violates constraints that the run did not include.
    """
    from scipy.optimize import minimize  # slow to import, and most jobs do not need it

    v, count, rows = len(start), 0, np.zeros(0, dtype=np.int64)
    for _ in range(ROUNDS):
        current = cache.bound_at(z[:v])
        if current is None:
            break
        previous_count, values = len(rows), constraint_values(current, z)[0]
        rows = np.union1d(
            rows, np.flatnonzero(values < ACTIVE if not previous_count else values < 0.1 * ACTIVE)
        )
        if len(rows) == previous_count and previous_count:
            break
        reported = rows

        def constraints(z: Array, reported: Index = reported) -> tuple[Array, Array]:
            state = cache.bound_at(z[:v])
            if state is None:
                return np.full(len(reported), -1.0), np.zeros((len(reported), len(z)))
            values, slopes = constraint_values(state, z)
            return values[reported], np.nan_to_num(slopes[reported])

        for reach in (np.inf, *CLOSER):
            result: Any = minimize(
                lambda z: value(z)[0],
                z,
                jac=lambda z: value(z)[1],
                method="SLSQP",
                bounds=None if np.isinf(reach) else list(zip(z - reach, z + reach)),
                constraints=[
                    {
                        "type": "ineq",
                        "fun": lambda z: constraints(z)[0],
                        "jac": lambda z: constraints(z)[1],
                    }
                ]
                if len(reported)
                else [],
                options={"ftol": TOLERANCE, "maxiter": ITERATIONS},
            )
            count += int(result.nit)
            if constraints(result.x)[0].min(initial=0.0) >= min(
                -VIOLATION, constraints(z)[0].min(initial=0.0)
            ):
                break
        if cache.bound_at(result.x[:v]) is None:
            break
        z = result.x
    return z, count
