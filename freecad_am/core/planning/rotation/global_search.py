# SPDX-License-Identifier: LGPL-2.1-or-later
"""Global search over offset and slope of the rotation, the start of the search for every layer.

A local optimiser with one start fails on layers whose feasible rotations are elsewhere. Array
kinematics makes a global search cheap. It uses few points per bead and checks the limits first. A
cheap bound then screens the candidates by condition. The exact condition is computed only where
the bound is inconclusive.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.frames import TURN, shortest
from ...geometry.tie_breaking import first_most, index_of_minimum, is_tied
from ...kinematics import jacobian as jac
from ...toolpath import Bead
from ...types import Array, ArrayLike, Index, Integers, Mask
from .. import criteria
from ..joint_path import BeadPath
from ..points import Points, gather, in_pieces, steps
from ..task import MIN_MARGIN, UNREACHABLE, Task, condition_margin
from . import local_optimisation
from .local_optimisation import evaluate_paths

POINTS_PER_BEAD = 10
OFFSETS = 24
SLOPES = np.linspace(-2.0, 2.0, 13)
# slopes that rotate the tool by whole turns over a closed bead
CLOSING_SLOPES = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
# weight of the joint motion that breaks ties between candidates with equal objective
TIE = 1e-6
# poses per batch: fits the processor cache and bounds the memory of long jobs
CHUNK = 30_000
# passes of condition checks; the last pass covers all unknown candidates of unfinished beads
MAX_CONDITION_PASSES = 5
# bound <= sigma_min / sigma_max <= 6 bound with bound = 1 / kappa_F, since
# kappa_2 <= kappa_F <= 6 kappa_2
BOUND_SPREAD = 6.0


@dataclass(frozen=True, eq=False)
class Found:
    """C candidates per bead.

    coefficients: (C, B, degree + 1). objective: (C, B). margin: (C, B) minimum of limit and
    condition margins, negative if exceeded, -inf if a point is unreachable.
    """

    coefficients: Array
    objective: Array
    margin: Array

    def select_slope(self, slope: float) -> Found:
        """Return the candidates with a given slope."""
        candidate_rows = np.abs(self.coefficients[:, 0, 1] - slope) < 1e-9
        return Found(
            self.coefficients[candidate_rows],
            self.objective[candidate_rows],
            self.margin[candidate_rows],
        )

    def select_beads(self, beads: Index) -> Found:
        """Return the candidates of selected beads.

        Parameters
        ----------
        beads : (k,) array of int
            Bead indices.

        Returns
        -------
        Found
            The candidates of these beads.
        """
        return Found(self.coefficients[:, beads], self.objective[:, beads], self.margin[:, beads])

    def best(self) -> Integers:
        """Return the index (B,) of the feasible candidate with the minimum objective.

        If no candidate is feasible, return the one with the maximum margin.
        """
        return self._best(self.margin)

    def is_best(self, margin: Array) -> Mask:
        """Return which candidates are the best for given margins.

        Parameters
        ----------
        margin : (C, B) array
            Margins of the candidates.

        Returns
        -------
        (C, B) array of bool
            True for one candidate per bead.
        """
        best_mask: Mask = np.arange(len(margin))[:, None] == self._best(margin)
        return best_mask

    def _best(self, margin: Array) -> Integers:
        feasible = margin >= 0.0
        ranked = index_of_minimum(np.where(feasible, self.objective, np.inf), axis=0)
        return np.asarray(
            np.where(feasible.any(axis=0), ranked, first_most(margin, axis=0)), dtype=np.int64
        )


def everywhere(
    task: Task,
    points: Points,
    thresholds: Array,
    slopes: Array | None = None,
    offsets: int = OFFSETS,
    best_alone: bool = False,
) -> Found:
    """Return candidates over the full range of offset and slope for every bead.

    Closed beads whose rotation must return to its start allow only integer slopes.

    Parameters
    ----------
    task : Task
        The plan.
    points : Points
        T points of B beads; may be a sample.
    thresholds : (T,) array
        Required minimum condition.
    slopes : array or None, optional
        Slopes to try; None for the defaults.
    offsets : int, optional
        Number of offsets over a turn.
    best_alone : bool, optional
        Whether only the best candidate of each bead is needed; conditions of other candidates
        are then skipped.

    Returns
    -------
    Found
        C candidates per bead.
    """
    joined = task.joined & points.closed
    if slopes is None:
        slopes = CLOSING_SLOPES if joined.all() else SLOPES
    degree = task.parameters.degree
    turn = np.arange(offsets) * (2.0 * np.pi / offsets) - np.pi
    slope = slopes if degree > 0 else np.zeros(1)
    offset_grid, slope_grid = (grid.ravel() for grid in np.meshgrid(turn, slope, indexing="ij"))
    coefficients = np.zeros((len(offset_grid), points.beads, degree + 1))
    coefficients[:, :, 0] = offset_grid[:, None]
    if degree > 0:
        coefficients[:, :, 1] = slope_grid[:, None]
    candidates = judge(task, points, thresholds, coefficients, conditions=not best_alone)
    not_whole = np.abs(slope_grid - np.round(slope_grid)) > 1e-9
    candidates.margin[np.ix_(not_whole, joined)] = UNREACHABLE
    if best_alone:
        candidates = replace(
            candidates,
            margin=add_conditions(task, points, thresholds, candidates, candidates.is_best),
        )
    return candidates


def add_conditions(
    task: Task,
    points: Points,
    thresholds: Array,
    candidates: Found,
    select_needed: Callable[[Array], Mask],
) -> Array:
    """Add the condition to the margins of the candidates that need it.

    Parameters
    ----------
    task : Task
        The plan.
    points : Points
        T points of B beads.
    thresholds : (T,) array
        Required minimum condition.
    candidates : Found
        C candidates per bead, with margins of limits only.
    select_needed : callable
        Returns which candidates (C, B) need the condition, given margins (C, B).

    Returns
    -------
    (C, B) array
        Margins, exact for the candidates that need the condition.
    """
    margin = candidates.margin.copy()
    is_known = candidates.margin < 0.0
    bead_ids = np.arange(points.beads)
    for look in range(MAX_CONDITION_PASSES):
        new = select_needed(margin) & ~is_known
        if not new.any():
            break
        if look == MAX_CONDITION_PASSES - 1:
            new = ~is_known & new.any(axis=0)
        candidate_ids = np.argsort(~new, axis=0, kind="stable")[: new.sum(axis=0).max()]
        new_margin = judge(
            task, points, thresholds, candidates.coefficients[candidate_ids, bead_ids]
        ).margin
        margin[candidate_ids, bead_ids] = np.where(
            is_known[candidate_ids, bead_ids], margin[candidate_ids, bead_ids], new_margin
        )
        is_known[candidate_ids, bead_ids] = True
    return margin


def judge(
    task: Task, points: Points, thresholds: Array, coefficients: Array, conditions: bool = True
) -> Found:
    """Return candidates with objective and margin.

    Parameters
    ----------
    task : Task
        The plan.
    points : Points
        T points of B beads.
    thresholds : (T,) array
        Required minimum condition.
    coefficients : (C, B, degree + 1) array
        Coefficients in ascending order.
    conditions : bool, optional
        Whether the margin includes the condition; otherwise it covers only limits.

    Returns
    -------
    Found
        The candidates with objective and margin.
    """
    size = max(1, CHUNK // len(points))
    results = [
        _judge(task, points, thresholds, coefficients[start : start + size], conditions)
        for start in range(0, len(coefficients), size)
    ]
    return Found(
        coefficients,
        np.concatenate([objective for objective, _ in results]),
        np.concatenate([margin for _, margin in results]),
    )


def _judge(
    task: Task, points: Points, thresholds: Array, coefficients: Array, conditions: bool
) -> tuple[Array, Array]:
    value = np.zeros((len(coefficients), len(points)))
    for power in range(coefficients.shape[2] - 1, -1, -1):
        value = value * points.parameter + coefficients[:, points.bead, power]
    phi = (
        np.stack([task.rotation(points, row)[0] for row in value])
        if task.parameters.parameter == "rz"
        else value
    )
    joints = task.joints(points, phi)
    limit = points.worst(task.rows.margin(joints))
    margin = np.minimum(limit, _range_margin(task, points, phi))
    objective = _objective(task, points, phi, joints)
    objective[np.isnan(objective)] = np.inf
    if not conditions:
        return objective, margin
    open_beads = (margin >= 0.0)[:, points.bead]
    condition = np.full(len(coefficients) * len(points), UNREACHABLE)
    open_rows = np.flatnonzero(open_beads.ravel())
    if len(open_rows):
        condition[open_rows] = _screened_condition_margin(
            task,
            points,
            phi.ravel()[open_rows],
            joints.reshape(-1, joints.shape[-1])[open_rows],
            open_rows % len(points),
            thresholds,
        )
    worst = points.worst(condition.reshape(phi.shape))
    margin = np.where(margin >= 0.0, np.minimum(margin, worst), margin)
    return objective, margin


def _range_margin(task: Task, points: Points, phi: Array) -> Array | float:
    low, high = task.parameters.rotation_range
    if high - low >= 2.0 * np.pi - 1e-9:
        return np.inf
    half = 0.5 * (high - low)
    return points.worst(1.0 - np.abs(phi - (low + half)) / half)


def _objective(task: Task, points: Points, phi: Array, joints: Array) -> Array:
    name = task.parameters.objective
    if name in criteria.JOINT_ONLY:
        value = criteria.JOINT_ONLY[name](task, points, joints)
        return (
            value if name == "displacement" else value + TIE * _total_joint_motion(points, joints)
        )
    flat = joints.reshape(-1, joints.shape[-1])
    good = np.flatnonzero(np.isfinite(flat).all(axis=1))
    worth = np.full(len(flat), np.nan)
    matrix = task.jacobian_at(points.frames.of(good % len(points)), phi.ravel()[good], flat[good])
    length = task.parameters.characteristic_length
    measure = jac.manipulability if name == "manipulability" else jac.condition
    worth[good] = 1.0 / np.maximum(measure(matrix, length), 1e-300)
    mean: Array = points.total(worth.reshape(phi.shape)) / np.bincount(points.bead)
    return mean + TIE * _total_joint_motion(points, joints)


def _total_joint_motion(points: Points, joints: Array) -> Array:
    """Return the squared joint steps (..., B), summed over all axes with equal weights, rad^2."""
    step = steps(joints, points)
    return points.total((step * step).sum(axis=-1))


def _screened_condition_margin(
    task: Task, points: Points, phi: Array, joints: Array, index: Integers, thresholds: Array
) -> Array:
    """Return the condition margins of selected poses.

    They are exact near the threshold. Elsewhere the bound suffices for the sign.
    """
    length, threshold = task.parameters.characteristic_length, thresholds[index]
    condition, undecided = np.empty(len(index)), np.empty(len(index), dtype=bool)
    matrices: list[Array] = []
    for rows in in_pieces(len(index)):
        matrix = task.jacobian_at(points.frames.of(index[rows]), phi[rows], joints[rows])
        bound = condition[rows] = jac.condition_bound(matrix, length)
        is_close = undecided[rows] = (bound < threshold[rows]) & (
            BOUND_SPREAD * bound >= threshold[rows]
        )
        matrices.append(matrix[is_close])
    condition[undecided] = jac.condition(np.concatenate(matrices), length)
    return condition_margin(condition, threshold)


COARSE, FINE = 72, 15
# minimum separation of two margin peaks, in coarse steps (30 deg)
MIN_PEAK_SEPARATION_STEPS = 6
# relative tolerance for equal objectives, and tolerance for equal margins (1 is mid-range)
OBJECTIVE_TOLERANCE = 1e-6
MAX_MARGIN_LOSS = 0.01


def resolve(task: Task, points: Points, thresholds: Array, coefficients: Array) -> Array:
    """Resolve ties: where the objective is flat, shift the offset to the maximum margin.

    Parameters
    ----------
    task : Task
        The plan.
    points : Points
        T points of B beads; may be a sample.
    thresholds : (T,) array
        Required minimum condition.
    coefficients : (B, degree + 1) array
        The optimum, in ascending order.

    Returns
    -------
    (B, degree + 1) array
        Coefficients; unchanged where the optimum is unique.
    """
    current = judge(task, points, thresholds, coefficients[None])
    coarse = _offset_candidates(
        coefficients,
        np.broadcast_to(np.arange(COARSE)[:, None] * (TURN / COARSE), (COARSE, points.beads)),
    )
    rough = judge(task, points, thresholds, coarse, conditions=False)
    flat = as_good(task, rough.objective, current.objective)
    if not flat[1:].any():
        return coefficients
    rough = replace(rough, margin=np.where(flat, rough.margin, -np.inf))
    around = _peaks(add_conditions(task, points, thresholds, rough, _are_peaks)) * (TURN / COARSE)
    offsets = (around[:, None] + np.linspace(-1.0, 1.0, FINE)[:, None] * (TURN / COARSE)).reshape(
        -1, points.beads
    )
    fine = judge(task, points, thresholds, _offset_candidates(coefficients, offsets))
    flat = as_good(task, fine.objective, current.objective)
    margin = np.where(flat, fine.margin, -np.inf)
    chosen_ids = _least_motion(task, points, fine.coefficients, margin)
    improved = ~is_tied(-current.margin[0], -margin[chosen_ids, np.arange(points.beads)])
    return np.where(
        improved[:, None], fine.coefficients[chosen_ids, np.arange(points.beads)], coefficients
    )


def as_good(task: Task, objective: ArrayLike, best: Array) -> Mask:
    """Return which objectives count as equal to the best ones.

    Parameters
    ----------
    task : Task
        The plan, including the tolerance.
    objective : array
        Objectives.
    best : array
        Best objectives, broadcast against `objective`.

    Returns
    -------
    bool array
        True within the tolerance.
    """
    good: Mask = (
        np.asarray(objective) <= best * (1.0 + OBJECTIVE_TOLERANCE) + task.parameters.tolerance
    )
    return good


def _are_peaks(margin: Array) -> Mask:
    """Return which candidates (C, B) are `_peaks`."""
    is_peak: Mask = (np.arange(COARSE)[:, None] == _peaks(margin)[:, None]).any(axis=0)
    return is_peak


def _peaks(margin: Array) -> Array:
    """Return the coarse steps (2, B) of the two highest separate peaks of the margin (C, B)."""
    highest = first_most(margin, axis=0)
    separation = np.abs((np.arange(COARSE)[:, None] - highest + COARSE // 2) % COARSE - COARSE // 2)
    second_highest = first_most(
        np.where(separation >= MIN_PEAK_SEPARATION_STEPS, margin, -np.inf), axis=0
    )
    return np.stack([highest, second_highest]).astype(float)


def _offset_candidates(coefficients: Array, offsets: Array) -> Array:
    offset_coefficients = np.repeat(coefficients[None], len(offsets), axis=0)
    offset_coefficients[:, :, 0] += offsets
    return offset_coefficients


def _least_motion(task: Task, points: Points, candidates: Array, margin: Array) -> Integers:
    """Return the candidate index (B,) of each bead.

    Among the candidates close to the maximum margin, take the nearest to the previous bead.
    """
    start = _joints_at(task, points, candidates, points.first)
    end = _joints_at(task, points, candidates, np.append(points.first[1:], len(points)) - 1)
    chosen_ids = np.empty(points.beads, dtype=np.int64)
    for bead in range(points.beads):
        close = margin[:, bead] >= margin[:, bead].max() - MAX_MARGIN_LOSS
        if bead == 0 or not np.isfinite(margin[:, bead].max()):
            chosen_ids[bead] = first_most(margin[:, bead])
            continue
        step = start[:, bead] - end[chosen_ids[bead - 1], bead - 1]
        step = shortest(step)
        chosen_ids[bead] = index_of_minimum(np.where(close, (step * step) @ task.weights, np.inf))
    return chosen_ids


def _joints_at(task: Task, points: Points, candidates: Array, index: Integers) -> Array:
    """Return the joints (C, B, axes) at one point of each bead; 0 where unreachable."""
    bead_points = points.select_points(index)
    value = np.stack([bead_points.polynomial(row) for row in candidates])
    phi = np.stack([task.rotation(bead_points, row)[0] for row in value])
    return np.nan_to_num(task.raw_joints(bead_points, phi))


Place = tuple[int, int]

LOW_CONDITION_RATIO = (
    3.0  # times the threshold; below this ratio the condition may be too low between points
)
HALVINGS = 2  # times that each segment is halved to check between its points
CANDIDATES = 12  # candidates per bead that are checked between points
BEADS_PER_BATCH = 64  # beads per batch, to bound memory


def find_infeasible(task: Task, beads: Sequence[Bead], paths: Sequence[BeadPath]) -> list[int]:
    """Return the beads that are infeasible at their points or between them.

    Parameters
    ----------
    task : Task
        The plan.
    beads : sequence of Bead
        The beads.
    paths : sequence of BeadPath
        The paths of the beads.

    Returns
    -------
    list of int
        Bead indices, sorted.
    """
    infeasible = [k for k, path in enumerate(paths) if path.margin < MIN_MARGIN]
    low = [
        k
        for k, path in enumerate(paths)
        if path.margin >= MIN_MARGIN
        and (path.condition < LOW_CONDITION_RATIO * path.threshold).any()
    ]
    if low:
        finer = [_finer(beads[k]) for k in low]
        points = gather(finer, task.cell)
        share = 0.5**HALVINGS
        phi = np.concatenate(
            [
                np.interp(np.arange(len(bead)) * share, np.arange(len(paths[k].phi)), paths[k].phi)
                for k, bead in zip(low, finer)
            ]
        )
        joints = task.joints(points, phi)
        condition = condition_margin(task.condition(points, phi, joints), task.thresholds(points))
        margin = points.worst(np.minimum(task.rows.margin(joints), condition))
        infeasible += [k for k, lowest_margin in zip(low, margin) if lowest_margin < MIN_MARGIN]
    return sorted(infeasible)


def replace_infeasible(
    task: Task,
    beads: Sequence[Bead],
    bead_ids: Sequence[Place],
    paths: Sequence[BeadPath],
    candidates_found: Found,
    report: Callable[[float], None],
) -> dict[int, BeadPath | None]:
    """Replace infeasible paths of beads that have a feasible candidate.

    Parameters
    ----------
    task : Task
        The plan.
    beads : sequence of Bead
        The beads.
    bead_ids : sequence of Place
        Layer and index of each bead.
    paths : sequence of BeadPath
        The paths of the beads.
    candidates_found : Found
        Candidates of the beads, rated at a few points.
    report : callable
        Receives the completed fraction; may raise to cancel.

    Returns
    -------
    dict[int, BeadPath or None]
        Results of `find_rotations` by bead index.
    """
    promising = candidates_found.margin.max(axis=0) >= 0.0
    rows = [k for k in find_infeasible(task, beads, paths) if promising[k]]
    replacements: dict[int, BeadPath | None] = {}
    for start in range(0, len(rows), BEADS_PER_BATCH):
        report(start / len(rows))
        batch = rows[start : start + BEADS_PER_BATCH]
        candidates = candidates_found.select_beads(np.array(batch, dtype=np.intp))
        replacements |= zip(
            batch,
            find_rotations(
                task, [beads[k] for k in batch], [bead_ids[k] for k in batch], candidates
            ),
        )
    return replacements


def find_rotations(
    task: Task, beads: Sequence[Bead], bead_ids: Sequence[Place], candidates_found: Found
) -> list[BeadPath | None]:
    """Return the best path of each bead that is feasible at all points and between them.

    The best candidate is refined, unless the refined path is infeasible.

    Parameters
    ----------
    task : Task
        The plan.
    beads : sequence of Bead
        The beads.
    bead_ids : sequence of Place
        Layer and index of each bead.
    candidates_found : Found
        Candidates of the beads, rated at a few points.

    Returns
    -------
    list[BeadPath or None]
        The paths; None if no candidate is feasible.
    """
    points, between = gather(beads, task.cell), gather([_finer(bead) for bead in beads], task.cell)
    thresholds = task.thresholds(points)
    judged_candidates = _judged_at(
        task, points, thresholds, candidates_found, len(candidates_found.margin)
    )
    judged_candidates = _judged_at(
        task, between, task.thresholds(between), judged_candidates, CANDIDATES
    )
    best, bead_rows = judged_candidates.best(), np.arange(len(beads))
    start = judged_candidates.coefficients[best, bead_rows]
    serves = judged_candidates.margin[best, bead_rows] >= 0.0
    refined = local_optimisation.refine(task, points, thresholds, start[None], serves)
    as_found = dataclasses.replace(refined, coefficients=start)
    paths: list[BeadPath | None] = [None] * len(beads)
    for solution in (refined, as_found):
        attempted = evaluate_paths(
            task, beads, bead_ids, points, thresholds, solution.coefficients, solution
        )
        short = find_infeasible(task, beads, attempted)
        paths = [
            path or (attempt if good and k not in short else None)
            for k, (path, attempt, good) in enumerate(zip(paths, attempted, serves))
        ]
    return paths


def _judged_at(
    task: Task, points: Points, thresholds: Array, candidates: Found, max_count: int
) -> Found:
    """Rate up to `max_count` feasible candidates of each bead, the best first, at given points."""
    worth = np.where(candidates.margin >= 0.0, candidates.objective, np.inf)
    count = max(1, min(max_count, int((candidates.margin >= 0.0).sum(axis=0).max())))
    best_rows = np.argsort(worth, axis=0, kind="stable")[:count]
    bead_rows = np.arange(points.beads)
    judged_there = judge(task, points, thresholds, candidates.coefficients[best_rows, bead_rows])
    serves = candidates.margin[best_rows, bead_rows] >= 0.0
    return dataclasses.replace(
        judged_there, margin=np.where(serves, judged_there.margin, UNREACHABLE)
    )


def _finer(bead: Bead) -> Bead:
    for _ in range(HALVINGS):
        bead = bead.halved(np.arange(len(bead) - 1))
    return bead
