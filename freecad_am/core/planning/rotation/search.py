# SPDX-License-Identifier: LGPL-2.1-or-later
"""The search over the whole range of offset and slope that every layer starts from.

One start of a local optimiser loses layers whose feasible rotations lie elsewhere. Kinematics over arrays makes
looking everywhere cheap: few points per bead, the limits first, a cheap bound of the condition as screen, the
true condition only for what the bound leaves open.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.ties import first_most, index_of_minimum
from ...kinematics import jacobian as jac
from ...types import Array, Index, Integers, Mask
from .. import criteria
from ..limit_rows import UNREACHABLE
from ..points import Points, in_pieces, steps
from ..task import Task, condition_margin

POINTS_PER_BEAD = 10
OFFSETS = 24
SLOPES = np.linspace(-2.0, 2.0, 13)
# slopes that close a full turn in joint space
CLOSING_SLOPES = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
# of candidates with the same objective the one that moves the joints less is taken
TIE = 1e-6
# poses handled at once, so that they stay in the processor's cache and a long job does not fill the memory
CHUNK = 30_000
# passes of condition checks; the last one covers all unknown candidates of beads that need more
MAX_CONDITION_PASSES = 5
# sigma_min / sigma_max lies between the bound 1 / kappa_F and its 6-fold: kappa_2 <= kappa_F <= 6 kappa_2
BOUND_SPREAD = 6.0


@dataclass(frozen=True, eq=False)
class Found:
    """C candidates per bead: coefficients (C, B, degree + 1), objective and margin (C, B).

    margin is the smallest of the limit and condition margins, negative where one is exceeded, -inf where a point
    cannot be reached.
    """

    coefficients: Array
    objective: Array
    margin: Array

    def select_slope(self, slope: float) -> Found:
        """Return only the candidates of one slope."""
        candidate_rows = np.abs(self.coefficients[:, 0, 1] - slope) < 1e-9
        return Found(
            self.coefficients[candidate_rows],
            self.objective[candidate_rows],
            self.margin[candidate_rows],
        )

    def select_beads(self, beads: Index) -> Found:
        """Return only the candidates of some beads (k,)."""
        return Found(self.coefficients[:, beads], self.objective[:, beads], self.margin[:, beads])

    def best(self) -> Integers:
        """(B,) index of the candidate with the least objective among the feasible, else of the largest margin."""
        return self._best(self.margin)

    def is_best(self, margin: Array) -> Mask:
        """(C, B) which candidates are the best ones if their margins are these, (C, B)."""
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
    """Candidates over the whole range of offset (one turn) and slope, for every bead of the points.

    Of closed beads that have to join up those of slopes that do not make whole turns are out of the question. best_alone:
    nothing is asked for but the best of each bead; where one serves, conditions of worse ones are not looked at.
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
    """Return the margins (C, B) of candidates that were judged by limits only, lowered by their condition
    where that matters: wherever `select_needed` of the margins, (C, B), says so, until all needed ones
    are known.
    """
    margin, is_known, bead_ids = (
        candidates.margin.copy(),
        candidates.margin < 0.0,
        np.arange(points.beads),
    )
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
    """Return objective and margin of given candidates (C, B, degree + 1); without `conditions` the margin
    of the limits only.
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
    """Return the sum (..., B) of the squared steps of all axes with equal weights, rad^2."""
    step = steps(joints, points)
    return points.total((step * step).sum(axis=-1))


def _screened_condition_margin(
    task: Task, points: Points, phi: Array, joints: Array, index: Integers, thresholds: Array
) -> Array:
    """Condition margins of chosen poses: exact near the threshold, by the bound where that settles the sign."""
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
