# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layer by layer: one polynomial of the rotation per bead (Chalvin 2020, section 4.3).

The method searches globally, refines locally, resolves ties, then fits limited axes to limits.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from ...issues import Issue
from ...toolpath import Bead
from ...types import Array
from .. import clear_rotations
from ..joint_path import BeadPath
from ..points import Points, gather
from ..rotation import given, global_search, local_optimisation
from ..rotation.local_optimisation import evaluate_paths
from ..task import MIN_MARGIN, Task
from ..turns import unwrap

Progress = Callable[[float, str], None]
Place = tuple[int, int]

# whole turns of the rotation of a joined bead to try in addition to the best candidate
OTHER_TURNS = (-1.0, 0.0, 1.0)
# maximum objective of these alternatives, relative to the best objective
NOT_MUCH_WORSE = 2.0


def plan(
    task: Task, beads: Sequence[Bead], bead_ids: Sequence[Place], progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    """Plan the paths with one polynomial of the rotation per bead.

    Beads with a given polynomial use it and get the same checks.

    Parameters
    ----------
    task : Task
        The plan.
    beads : sequence of Bead
        The beads in print order.
    bead_ids : sequence of Place
        Layer and index of each bead.
    progress : callable
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    paths : list of BeadPath
        The paths; moved seams and split beads may increase their number.
    issues : list of Issue
        Notes on moved seams and split beads.

    References
    ----------
    Chalvin 2020, section 4.3.
    """
    fixed = given.coefficients(task.parameters, bead_ids)
    free = [k for k in range(len(beads)) if k not in fixed]
    paths, helped = (
        _searched(task, [beads[k] for k in free], [bead_ids[k] for k in free], progress)
        if free
        else ([], {})
    )
    of_bead = dict(zip(free, paths)) | given.paths(task, beads, bead_ids, fixed)
    together, issues = unwrap.insert_replacements(
        task,
        [of_bead[k] for k in range(len(beads))],
        {free[k]: replacements for k, replacements in helped.items()},
    )
    return together, issues


def _searched(
    task: Task, beads: Sequence[Bead], bead_ids: Sequence[Place], progress: Progress
) -> tuple[list[BeadPath], dict[int, list[BeadPath]]]:
    """Return the path of every bead, and replacements for beads that need a new seam or a split."""
    coarse, full = gather(beads, task.cell, global_search.POINTS_PER_BEAD), gather(beads, task.cell)
    coarse_threshold, threshold = task.thresholds(coarse), task.thresholds(full)
    progress(0.1, "searching rotations")
    joined = task.joined & full.closed
    candidates = global_search.everywhere(
        task, coarse, coarse_threshold, best_alone=task.kept is None and not joined.any()
    )
    if task.kept is not None:
        progress(0.2, "keeping the arm clear")
        arm_points = gather(beads, task.cell, clear_rotations.POINTS_PER_BEAD)
        candidates = clear_rotations.exclude_touching(
            task, task.kept, arm_points, bead_ids, candidates
        )
    best, bead_rows = candidates.best(), np.arange(len(beads))
    start = candidates.coefficients[best, bead_rows]
    # a bead that is infeasible from its seam may be feasible from another seam, which is cheaper to
    # try than a local search
    hopeless = [int(k) for k in np.flatnonzero(candidates.margin[best, bead_rows] < 0.0)]
    roomy = unwrap.for_beads(task, [beads[k] for k in hopeless], [bead_ids[k] for k in hopeless])
    helped = {k: paths for k, paths in zip(hopeless, roomy) if paths is not None}
    starts = _add_other_turns(start, candidates) if joined.any() else start[None]
    starts[1:, ~joined] = np.nan
    progress(0.4, "refining layers")
    needs_search = np.array([k not in helped for k in bead_rows])
    needs_search |= np.array(
        [len(helped.get(int(k), ())) > 1 and bool(joined[k]) for k in bead_rows]
    )
    refined = local_optimisation.refine(
        task,
        full,
        threshold,
        starts,
        needs_search,
        lambda share: progress(0.4 + 0.3 * share, "refining layers"),
    )
    progress(0.7, "settling")
    paths = _resolved(task, beads, bead_ids, (coarse, coarse_threshold), (full, threshold), refined)
    retried = global_search.replace_infeasible(
        task,
        beads,
        bead_ids,
        paths,
        candidates,
        lambda share: progress(0.7 + 0.1 * share, "settling"),
    )
    paths = [retried.get(k) or path for k, path in enumerate(paths)]
    if task.kept is not None:
        progress(0.8, "keeping the arm clear")
        reached = dataclasses.replace(
            refined, coefficients=np.array([path.coefficients for path in paths])
        )
        clear, changed = clear_rotations.brought_clear(
            task, task.kept, beads, bead_ids, start, reached
        )
        if changed.any():
            moved = evaluate_paths(
                task, beads, bead_ids, full, threshold, clear.coefficients, clear
            )
            paths = [
                cleared if is_changed else path
                for path, cleared, is_changed in zip(paths, moved, changed)
            ]
    # a joined bead need not be split if a higher degree makes it feasible as a whole
    helped = {
        k: replacements
        for k, replacements in helped.items()
        if len(replacements) == 1 or not joined[k] or paths[k].margin < MIN_MARGIN
    }
    late = [
        k
        for k in range(len(beads))
        if k not in helped
        and k not in hopeless
        and (
            paths[k].margin < MIN_MARGIN or (task.kept is None and retried.get(k, paths[k]) is None)
        )
    ]
    late_beads = [beads[k] for k in late]
    late_ids = [bead_ids[k] for k in late]
    for k, replacements in zip(late, unwrap.for_beads(task, late_beads, late_ids)):
        if replacements is not None:
            helped[k] = replacements
    return paths, helped


def _resolved(
    task: Task,
    beads: Sequence[Bead],
    bead_ids: Sequence[Place],
    coarse: tuple[Points, Array],
    full: tuple[Points, Array],
    refined: local_optimisation.Refined,
) -> list[BeadPath]:
    """Return the paths of all beads, with ties between optima resolved.

    coarse, full: sampled points and all points, each with its condition thresholds.
    """
    resolved = global_search.resolve(task, *coarse, refined.coefficients)
    paths = evaluate_paths(task, beads, bead_ids, *full, resolved, refined)
    equal = global_search.as_good(task, [path.objective for path in paths], refined.objective)
    if equal.all() and all(path.margin >= MIN_MARGIN for path in paths):
        return paths
    # ties are resolved at sampled points; if the result is worse at all points, keep the original
    # optimum
    as_found = evaluate_paths(task, beads, bead_ids, *full, refined.coefficients, refined)
    return [
        path if good and path.margin >= min(MIN_MARGIN, unresolved.margin) else unresolved
        for path, unresolved, good in zip(paths, as_found, equal)
    ]


def _add_other_turns(start: Array, candidates: global_search.Found) -> Array:
    """Return start coefficients (S, B, degree + 1): the given ones, and the best for each other
    number of whole turns.

    NaN marks an unpromising start. A higher degree may change the best number of turns.
    """
    if start.shape[1] < 2:
        return start[None]
    bead_rows = np.arange(len(start))
    best = candidates.best()
    margin = candidates.margin[best, bead_rows]
    max_objective = NOT_MUCH_WORSE * candidates.objective[best, bead_rows]
    alternatives = []
    for turns in OTHER_TURNS:
        turned_candidates = candidates.select_slope(turns)
        row = turned_candidates.best()
        serves = (turned_candidates.margin[row, bead_rows] >= 0.0) & (
            turned_candidates.objective[row, bead_rows] <= max_objective
        )
        promising = np.where(
            margin >= 0.0, serves, np.isfinite(turned_candidates.margin[row, bead_rows])
        )
        is_other = promising & (np.abs(start[:, 1] - turns) > 1e-9)
        alternatives.append(
            np.where(is_other[:, None], turned_candidates.coefficients[row, bead_rows], np.nan)
        )
    return np.stack([start, *alternatives])
