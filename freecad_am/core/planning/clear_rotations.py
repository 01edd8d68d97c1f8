# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool rotations that keep the robot links clear.

The global search drops candidates whose links get too close to an obstacle. The local search may
move a clear candidate too close again. In this case take the last clear polynomial on the way to
its result, and repeat the local search from there with linearised link distances as constraints. If
the repeated search finds no clear result, keep this polynomial.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..geometry.frames import TURN
from ..issues import Issue
from ..kinematics.links.gaps import Gaps
from ..kinematics.links.self_collision import NONE
from ..toolpath import Bead
from ..types import Array, Index, Mask
from .arm_clearance import ArmKept, Place, clearance_issue
from .joint_path import BeadPath
from .points import Points, gather
from .rotation import refine_state
from .rotation.global_search import Found
from .rotation.local_optimisation import (
    CONSTRAINT_TOLERANCE,
    INACTIVE_VALUE,
    Linear,
    Refined,
    refine_along,
)
from .rotation.refine_state import state_of
from .task import MIN_MARGIN, UNREACHABLE, Task, condition_margin

MAX_LINEARIZATIONS = 10
GAP_RANGE_MM = 50.0  # mm; extra clearance beyond which a link pair does not constrain the search
EXTRA_GAP_MM = 0.01  # mm; extra clearance in the constraints, so that the result is clear
REACH = 0.3  # rad; maximum change of a polynomial between two checks
UNCHANGED = 1e-4  # changes below this do not count: rad, or fraction of the objective
STOPPED = "the path to a better solution comes too near"


def refined_clear(
    task: Task, arm_clearance: ArmKept, points: Points, bead_ids: Sequence[Place], start: Array
) -> Refined:
    """Lower the objective of bead polynomials while the links stay clear.

    Each step linearises the clearance about the current polynomial and optimises the bead again. A
    step without improvement halves the reach.

    Parameters
    ----------
    task : Task
        The plan of the beads.
    arm_clearance : ArmKept
        The link clearance check.
    points : Points
        T points of B beads.
    bead_ids : sequence of Place
        Layer and index of each bead.
    start : (B, degree + 1) array
        Start coefficients in ascending order.

    Returns
    -------
    Refined
        Coefficients, objective, stop reason and iteration count of each bead. A bead without a
        better polynomial keeps its start and has an infinite objective.
    """
    thresholds = task.thresholds(points)
    directions = refine_state.changes(task, points, start.shape[1] - 1)
    gaps = Gaps(arm_clearance.contact, GAP_RANGE_MM)
    moment = np.array([arm_clearance.moment(bead_id) for bead_id in bead_ids], dtype=np.int64)
    trial, best = start.copy(), start.copy()
    objective = np.full(points.beads, np.inf)
    reach, pending = np.full(points.beads, REACH), np.ones(points.beads, dtype=bool)
    reason, iterations = [STOPPED] * points.beads, [0] * points.beads
    for _ in range(MAX_LINEARIZATIONS):
        state = state_of(task, points, thresholds, trial, slopes=False)
        value, gap, slope = _looked(task, gaps, points, trial, moment, pending)
        clear = points.worst(gap.min(axis=0)) >= 0.0
        good = (
            clear
            & (state.constraints >= -CONSTRAINT_TOLERANCE).all(axis=1)
            & np.isfinite(state.objective)
        )
        better = pending & good & ~(state.objective > objective * (1.0 - UNCHANGED))
        best[better], objective[better] = trial[better], state.objective[better]
        pending &= better | ~clear
        reach[~better] *= 0.5
        for bead in np.flatnonzero(pending):
            bead_points, point_rows = points.only(int(bead))
            clearance_rows = Linear(
                value[point_rows],
                np.where(
                    gap[:, point_rows] < GAP_RANGE_MM,
                    (gap[:, point_rows] - EXTRA_GAP_MM) / GAP_RANGE_MM,
                    INACTIVE_VALUE,
                ),
                slope[:, point_rows] / GAP_RANGE_MM,
                reach[bead],
            )
            refined, why, count = refine_along(
                task,
                bead_points,
                thresholds[point_rows],
                trial[bead],
                directions[bead],
                clearance_rows,
            )
            reason[bead], iterations[bead] = why, iterations[bead] + count
            pending[bead] = bool(
                np.abs(bead_points.polynomial((refined - trial[bead])[None])).max() > UNCHANGED
            )
            trial[bead] = refined
        if not pending.any():
            break
    return Refined(best, objective, tuple(reason), tuple(iterations))


def _looked(
    task: Task, gaps: Gaps, points: Points, coefficients: Array, moment: Index, selected: Mask
) -> tuple[Array, Array, Array]:
    """Return polynomial values and link gaps of the selected beads (B,).

    The values are (T,), the gaps (pairs, T) in mm for all link pairs and points. The derivatives
    (pairs, T) are with respect to the polynomial values.
    """
    value = points.polynomial(coefficients)
    phi, phi_rate = task.rotation(points, value)
    joints = task.joints(points, phi)
    shape = len(gaps.pairs), len(points)
    gap, slope = np.full(shape, gaps.reach), np.zeros(shape)
    reachable_rows = np.flatnonzero(selected[points.bead] & np.isfinite(joints).all(axis=1))
    rates, _ = task.rotation_rates(
        points.frames.of(reachable_rows), phi[reachable_rows], joints[reachable_rows]
    )
    all_pairs = np.ones((len(gaps.pairs), len(reachable_rows)), dtype=bool)
    gap[:, reachable_rows], slope[:, reachable_rows] = gaps.gaps_and_rates(
        joints[reachable_rows],
        rates * phi_rate[reachable_rows, None],
        moment[points.bead[reachable_rows]],
        all_pairs,
    )
    return value, gap, slope


FIRST_LOOK, TURNS = (
    4,
    72,
)  # candidates checked directly before a map is computed, and rotations in this map
# points checked first; a bead fails if one of them has no clear rotation
ENDS = 3
POINTS_PER_BEAD = 24  # points per bead and turn for the link check
SHARES = (
    0.75,
    0.5,
    0.25,
    0.0,
)  # fractions of the local search step to fall back to
TOUCHING = -1e-3  # margin of the best candidate if none is clear; its plan names the obstacle


def exclude_touching(
    task: Task, arm_clearance: ArmKept, points: Points, bead_ids: Sequence[Place], candidates: Found
) -> Found:
    """Remove the margin of candidates whose links get too close.

    The best candidates of each bead are checked directly until one is clear. After a few failures,
    a map of the rotations with contact checks all candidates.

    Parameters
    ----------
    task : Task
        The plan of the beads.
    arm_clearance : ArmKept
        The link clearance check.
    points : Points
        Points of the B beads; may be a sample.
    bead_ids : sequence of Place
        Layer and index of each bead.
    candidates : Found
        C candidates per bead from the global search.

    Returns
    -------
    Found
        The candidates, with margin -inf where a link gets too close. If no candidate of a bead
        is clear, its best candidate keeps a margin just below 0.
    """
    margin, bead_rows = candidates.margin.copy(), np.arange(points.beads)
    pending = np.ones(points.beads, dtype=bool)
    for attempt in range(3 * FIRST_LOOK):
        if attempt == FIRST_LOOK:
            margin[
                _mapped(task, arm_clearance, points, bead_ids, candidates.coefficients, pending)
            ] = UNREACHABLE
        best = Found(candidates.coefficients, candidates.objective, margin).best()
        pending &= margin[best, bead_rows] >= 0.0
        if not pending.any():
            break
        pending &= _find_touching(
            task, arm_clearance, points, bead_ids, candidates.coefficients[best, bead_rows], pending
        )
        margin[best[pending], bead_rows[pending]] = UNREACHABLE
    initial_best = candidates.best()
    blocked = np.flatnonzero(
        (margin < 0.0).all(axis=0) & (candidates.margin[initial_best, bead_rows] >= 0.0)
    )
    margin[initial_best[blocked], blocked] = TOUCHING
    return Found(candidates.coefficients, candidates.objective, margin)


def _mapped(
    task: Task,
    arm_clearance: ArmKept,
    points: Points,
    bead_ids: Sequence[Place],
    coefficients: Array,
    selected: Mask,
) -> Mask:
    """Return for which candidates (C, B) of the selected beads a link gets too close.

    coefficients: (C, B, degree + 1). A candidate is rated by the mapped rotations on either side of
    its rotation.
    """
    joints = task.raw_joints(
        points, np.broadcast_to(np.arange(TURNS)[:, None] * (TURN / TURNS), (TURNS, len(points)))
    )
    contact_map, hopeless = _map(arm_clearance, points, bead_ids, joints, selected)
    point_rows, touching = np.arange(len(points)), np.zeros(coefficients.shape[:2], dtype=bool)
    for row, candidate in zip(touching, coefficients):
        phi = task.rotation(points, points.polynomial(candidate))[0]
        sector = np.mod(phi / (TURN / TURNS), TURNS).astype(np.intp) % TURNS
        row[:] = selected & np.logical_or.reduceat(
            contact_map[sector, point_rows] | contact_map[(sector + 1) % TURNS, point_rows],
            points.first,
        )
    touching[:, hopeless] = True
    return touching


def _map(
    arm_clearance: ArmKept, points: Points, bead_ids: Sequence[Place], joints: Array, selected: Mask
) -> tuple[Mask, Mask]:
    """Return the rotations at which a link gets too close, and the beads without a clear rotation.

    The first mask (TURNS, T) applies to the joints (TURNS, T, axes) of the selected beads. The
    second mask (B,) marks beads with a point at which no rotation is clear. ENDS points per bead
    are checked first, and other points only if these have a clear rotation.
    """
    contact_map = np.zeros(joints.shape[:2], dtype=bool)
    hopeless = np.zeros(points.beads, dtype=bool)
    last_points = np.append(points.first[1:], len(points)) - 1
    share = np.linspace(0.0, 1.0, ENDS)[:, None]
    ends = np.zeros(len(points), dtype=bool)
    ends[np.round(points.first + share * (last_points - points.first)).astype(np.intp)] = True
    reached = np.isfinite(joints).all(axis=2)
    for subset in (ends, ~ends):
        columns = np.flatnonzero(subset & (selected & ~hopeless)[points.bead])
        contact_map[:, columns] = arm_clearance.rotations_near(
            joints[:, columns], points.bead[columns], bead_ids
        )
        closed = (contact_map | ~reached).all(axis=0) & contact_map.any(axis=0)
        hopeless |= np.logical_or.reduceat(closed, points.first)
    return contact_map, hopeless


def brought_clear(
    task: Task,
    arm_clearance: ArmKept,
    beads: Sequence[Bead],
    bead_ids: Sequence[Place],
    start: Array,
    reached: Refined,
) -> tuple[Refined, Mask]:
    """Replace polynomials whose links get too close by clear ones, where possible.

    Parameters
    ----------
    task : Task
        The plan of the beads.
    arm_clearance : ArmKept
        The link clearance check.
    beads : sequence of Bead
        The B beads.
    bead_ids : sequence of Place
        Layer and index of each bead.
    start : (B, degree + 1) array
        Start coefficients of the local search.
    reached : Refined
        Result of the local search.

    Returns
    -------
    refined : Refined
        The polynomials, clear where possible.
    replaced : (B,) bool array
        Beads with contact that got a clear polynomial.
    """
    points = gather(beads, task.cell, POINTS_PER_BEAD)
    touching = _find_touching(
        task,
        arm_clearance,
        points,
        bead_ids,
        reached.coefficients,
        np.ones(points.beads, dtype=bool),
    )
    affected = np.flatnonzero(touching)
    if not len(affected):
        return reached, touching
    points = gather([beads[k] for k in affected], task.cell, POINTS_PER_BEAD)
    serves = _Serving(task, arm_clearance, points, [bead_ids[k] for k in affected])
    back, touching[affected] = _stepped_back(
        start[affected], reached.coefficients[affected], task.joined & points.closed, serves
    )
    coefficients = reached.coefficients.copy()
    reason = list(reached.reason)
    iterations = list(reached.iterations)
    coefficients[affected] = back
    affected = np.flatnonzero(touching)
    if len(affected):
        full = gather([beads[k] for k in affected], task.cell)
        again = refined_clear(
            task, arm_clearance, full, [bead_ids[k] for k in affected], coefficients[affected]
        )
        points = gather([beads[k] for k in affected], task.cell, POINTS_PER_BEAD)
        for k in np.flatnonzero(
            _Serving(task, arm_clearance, points, [bead_ids[k] for k in affected])(
                again.coefficients
            )
        ):
            coefficients[affected[k]] = again.coefficients[k]
            reason[affected[k]], iterations[affected[k]] = again.reason[k], again.iterations[k]
    return Refined(coefficients, reached.objective, tuple(reason), tuple(iterations)), touching


@dataclass(frozen=True)
class _Serving:
    """Tests which beads (B,) keep limits, condition and link clearance.

    Call with coefficients (B, degree + 1).
    """

    task: Task
    kept: ArmKept
    points: Points
    places: Sequence[Place]

    @cached_property
    def _threshold(self) -> Array:
        return self.task.thresholds(self.points)

    def __call__(self, coefficients: Array) -> Mask:
        selected = np.ones(self.points.beads, dtype=bool)
        touching = _find_touching(
            self.task, self.kept, self.points, self.places, coefficients, selected
        )
        return np.asarray(~touching & _fits(self.task, self.points, self._threshold, coefficients))


def _stepped_back(
    start: Array, reached: Array, joined: Mask, serves: Callable[[Array], Mask]
) -> tuple[Array, Mask]:
    """Step back from `reached` towards `start` until limits, condition and clearance are kept.

    Return coefficients (B, degree + 1) and the mask (B,) of beads for which this succeeds; other
    beads keep `reached`. joined: (B,) beads whose rotation must return to its start.
    """
    result, changed = reached.copy(), np.zeros(len(start), dtype=bool)
    for share in SHARES:
        if changed.all():
            break
        mixed = start + share * (reached - start)
        good = ~changed & serves(mixed)
        if (
            share > 0.0
        ):  # an intermediate slope is not integer, so the rotation would not return to its start
            good &= ~joined | (np.abs(reached - start)[:, 1:].max(axis=1, initial=0.0) < 1e-9)
        result[good], changed[good] = mixed[good], True
    return result, changed


def findings(arm_clearance: ArmKept, paths: Sequence[BeadPath]) -> list[Issue]:
    """Return an issue for each bead with a link too close, naming the link and the obstacle."""
    issues = []
    for path in paths:
        sampled = np.unique(
            np.linspace(0, len(path.bead) - 1, min(len(path.bead), POINTS_PER_BEAD)).astype(np.intp)
        )
        met = arm_clearance.contact.touches(
            path.joints[sampled],
            np.full(len(sampled), arm_clearance.moment((path.layer, path.index))),
        )
        if met.any.any():
            first_contact = int(np.argmax(met.link != NONE))
            link = arm_clearance.contact.links[met.link[first_contact]]
            what = arm_clearance.contact.names[met.what[first_contact]]
            issues.append(
                clearance_issue(arm_clearance.contact.cell, link, what, path.layer, path.index)
            )
    return issues


def _find_touching(
    task: Task,
    arm_clearance: ArmKept,
    points: Points,
    bead_ids: Sequence[Place],
    coefficients: Array,
    selected: Mask,
) -> Mask:
    """Return on which of the selected beads (B,) a link gets too close."""
    joints = task.joints(points, task.rotation(points, points.polynomial(coefficients))[0])
    met = arm_clearance.touches(
        np.where(selected[points.bead, None], joints, np.nan), points, bead_ids
    )
    return np.asarray(np.logical_or.reduceat(met.any, points.first))


def _fits(task: Task, points: Points, threshold: Array, coefficients: Array) -> Mask:
    """Return which beads (B,) keep limits and condition."""
    phi = task.rotation(points, points.polynomial(coefficients))[0]
    joints = task.joints(points, phi)
    margin = np.minimum(
        task.rows.margin(joints), condition_margin(task.condition(points, phi, joints), threshold)
    )
    return np.asarray(points.worst(margin) >= MIN_MARGIN)
