# SPDX-License-Identifier: LGPL-2.1-or-later
"""A curve of the tool rotation along a path: its effect on the machine, and handles to edit it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..geometry.frames import TURN
from ..issues import Issue, has_errors
from ..toolpath import Bead
from ..types import Array, Integers, Mask
from . import criteria
from .findings import ROUNDING, findings
from .joint_path import BeadPath
from .plan import METHODS
from .points import Points, gather, steps
from .rotation import refine_state
from .task import Task

Progress = Callable[[float, str], None]


@dataclass(frozen=True, eq=False)
class Followed:
    """Machine state along a curve at T points of B beads.

    phi: (T,) rad. joints: (T, axes) rad or mm, unwrapped along each bead, NaN out of reach. margin:
    (T,) limit margin, 1 at mid-range, negative beyond a limit, -inf out of reach. condition: (T,),
    0 out of reach. displacement: (B,) eq. 17, NaN out of reach. ratio: (T,) maximum joint speed on
    the segment that ends at the point, as a fraction of the axis limit. good: (T,) points that the
    planner accepts. wound: (T,) points beyond a limit that other whole turns of an axis would keep:
    the axis exceeds its range by turning along the bead.
    """

    phi: Array
    joints: Array
    margin: Array
    condition: Array
    displacement: Array
    ratio: Array
    good: Mask
    wound: Mask


@dataclass(frozen=True)
class Sums:
    """The summary of a curve.

    lost: number of points that the planner rejects. wound: number of points with an axis out of
    turns. margin, condition: minima. ratio: maximum fraction of a joint speed limit, at the
    requested speed. displacement: eq. 17 summed over the beads, NaN out of reach.
    """

    lost: int
    wound: int
    margin: float
    condition: float
    ratio: float
    displacement: float


def durations(beads: Sequence[Bead], point_indices: Sequence[Integers] | None = None) -> Array:
    """Return the duration of each segment at travel speed.

    Parameters
    ----------
    beads : sequence of Bead
        The beads.
    point_indices : Sequence[Integers] or None, optional
        Sampled points of each bead; None for all points.

    Returns
    -------
    (T,) array
        Duration of the segment that ends at each point, s; 0 at the start of a bead.
    """
    segment_times = []
    for k, bead in enumerate(beads):
        length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
        times = np.concatenate([[0.0], np.cumsum(length / bead.speed[1:])])
        segment_times.append(
            np.diff(times if point_indices is None else times[point_indices[k]], prepend=0.0)
        )
    return np.concatenate(segment_times)


def follow(task: Task, points: Points, thresholds: Array, lasts: Array, phi: Array) -> Followed:
    """Return the machine state along a curve of rotations.

    Parameters
    ----------
    task : Task
        The plan, including limits and rotation range.
    points : Points
        T points.
    thresholds : (T,) array
        Required minimum condition.
    lasts : (T,) array
        Durations from `durations`, s.
    phi : (T,) array
        Rotations, rad.

    Returns
    -------
    Followed
        State at the points.
    """
    joints = task.joints(points, phi)
    condition, margin = task.condition(points, phi, joints), task.given_rows.margin(joints)
    speed = np.abs(steps(joints, points)) / np.where(lasts > 0.0, lasts, np.inf)[:, None]
    ratio = (speed / task.cell.machine.max_speed).max(axis=1)
    low, high = task.parameters.rotation_range
    good = (margin >= -ROUNDING) & (thresholds - condition <= ROUNDING)
    if high - low < TURN - 1e-9:
        good &= (phi >= low - ROUNDING) & (phi <= high + ROUNDING)
    wound = margin < -ROUNDING
    turns = np.where(task.continuous, 0.0, np.round((task.middle - joints[wound]) / TURN))
    wound[wound] = task.given_rows.margin(joints[wound] + TURN * turns) >= -ROUNDING
    return Followed(
        phi,
        joints,
        margin,
        condition,
        criteria.displacement(task, points, joints),
        ratio,
        good,
        wound,
    )


def sums(curve: Followed) -> Sums:
    """Return the summary of a curve."""
    ratio = curve.ratio[np.isfinite(curve.ratio)]
    return Sums(
        int((~curve.good).sum()),
        int(curve.wound.sum()),
        float(curve.margin.min()),
        float(curve.condition.min()),
        float(ratio.max()) if len(ratio) else float("nan"),
        float(curve.displacement.sum()),
    )


# ---- Handles


def fitted(points: Points, values: Array, degree: int) -> Array:
    """Fit polynomials of the bead parameter to values.

    Parameters
    ----------
    points : Points
        T points of B beads.
    values : (T,) array
        Values at the points.
    degree : int
        Degree of the polynomials; lower for beads with few points.

    Returns
    -------
    (B, degree + 1) array
        Least-squares coefficients in ascending order.
    """
    result = np.zeros((points.beads, degree + 1))
    low, high = points.ends
    for bead in range(points.beads):
        bead_points, rows = points.only(bead)
        # centre and scale the parameter, so that powers of large angles keep their precision
        middle, half = 0.5 * (low[bead] + high[bead]), 0.5 * (high[bead] - low[bead])
        share = np.vander(
            (bead_points.parameter - middle) / half,
            min(degree, len(bead_points) - 1) + 1,
            increasing=True,
        )
        solution = np.linalg.lstsq(share, values[rows], rcond=None)[0]
        # convert to the parameter itself by Horner's scheme; numpy's polynomial class is slow
        for order in range(len(solution) - 1, -1, -1):
            shifted = result[bead] / half
            result[bead] *= -middle / half
            result[bead, 1:] += shifted[:-1]
            result[bead, 0] += solution[order]
    return result


def handles(task: Task, points: Points, bead: int, degree: int) -> Array:
    """Return the parameters of the handles of a bead's polynomial.

    Parameters
    ----------
    task : Task
        The plan.
    points : Points
        The points.
    bead : int
        Bead index.
    degree : int
        Degree of the polynomial.

    Returns
    -------
    (n,) array
        One parameter per degree of freedom of the polynomial.
    """
    bead_points, _ = points.only(bead)
    low, high = (float(end[0]) for end in bead_points.ends)
    count = int(np.abs(refine_state.changes(task, bead_points, degree)[0]).any(axis=0).sum())
    if count == 1:
        return np.array([0.5 * (low + high)])
    # the rotation at the end of such a closed bead equals the start, so the end has no handle
    joined = task.joined and bool(bead_points.closed[0])
    return np.linspace(low, high, count, endpoint=not joined)


def pull(task: Task, points: Points, bead: int, degree: int, handle: int) -> Array:
    """Return the change of coefficients that moves one handle by 1 rad.

    All other handles stay, and the rotation of a closed bead still returns to its start.

    Parameters
    ----------
    task : Task
        The plan.
    points : Points
        The points.
    bead : int
        Bead index.
    degree : int
        Degree of the polynomial.
    handle : int
        Handle index in `handles`.

    Returns
    -------
    (degree + 1,) array
        Change of the coefficients in ascending order.
    """
    bead_points, _ = points.only(bead)
    parameters = handles(task, points, bead, degree)
    free = refine_state.changes(task, bead_points, degree)[0]
    free = free[:, np.abs(free).any(axis=0)]
    unit_change = np.where(np.arange(len(parameters)) == handle, 1.0, 0.0)
    return np.asarray(
        free
        @ np.linalg.solve(np.vander(parameters, degree + 1, increasing=True) @ free, unit_change)
    )


# ---- Comparison of methods


@dataclass(frozen=True)
class Compared:
    """The result of one planning method, before rapids and refinement.

    issues: errors and notes. seconds: planning time.
    """

    name: str
    paths: tuple[BeadPath, ...]
    sums: Sums
    issues: tuple[Issue, ...]
    seconds: float

    @property
    def feasible(self) -> bool:
        """Whether the result has no errors."""
        return not has_errors(self.issues)


def compared(
    task: Task, beads: Sequence[Bead], bead_ids: Sequence[tuple[int, int]], progress: Progress
) -> tuple[Compared, ...]:
    """Plan the beads with every method, in the branch of the task.

    Given polynomials are ignored.

    Parameters
    ----------
    task : Task
        The plan.
    beads : sequence of Bead
        The beads in print order.
    bead_ids : Sequence[tuple[int, int]]
        Layer and index of each bead.
    progress : callable
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    tuple of Compared
        The result of each method.
    """
    results = []
    for number, (method, plan) in enumerate(METHODS.items()):
        started = time.perf_counter()
        method_task = replace(
            task, parameters=replace(task.parameters, method=method, given=(), rz="auto")
        )

        def part(
            fraction: float, text: str, finished_count: int = number, name: str = method
        ) -> None:
            progress((finished_count + fraction) / len(METHODS), f"{name}: {text}")

        part(0.0, "planning")
        paths, issues = plan(method_task, beads, bead_ids, part)
        issues = issues + [issue for path in paths for issue in findings(method_task, path)]
        results.append(
            Compared(
                method,
                tuple(paths),
                sums_of(method_task, paths),
                tuple(issues),
                time.perf_counter() - started,
            )
        )
    return tuple(results)


def sums_of(task: Task, paths: Sequence[BeadPath]) -> Sums:
    """Return the summary of planned paths."""
    beads = [path.bead for path in paths]
    phi, threshold = (
        np.concatenate([getattr(path, name) for path in paths]) for name in ("phi", "threshold")
    )
    return sums(follow(task, gather(beads, task.cell), threshold, durations(beads), phi))
