# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layer by layer: one polynomial of the rotation per bead (Chalvin 2020, section 4.3).

Search everywhere, refine locally, settle in the flat valley, then find room for the turns of limited axes.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from ...issues import Issue
from ...toolpath import Bead
from ...types import Array
from ..arm import clear as arm_clear
from ..joint_path import BeadPath
from ..points import Points, gather
from ..rotation import elsewhere, given, refine, search, ties
from ..rotation.evaluation import judged
from ..task import FITS, Task
from ..turns import fit

Progress = Callable[[float, str], None]
Place = tuple[int, int]

# of a joined bead's rotation from start to end, tried besides what the search found best
OTHER_TURNS = (-1.0, 0.0, 1.0)
# times the objective of the best, from where another number of turns is not tried
NOT_MUCH_WORSE = 2.0


def plan(
    task: Task, beads: Sequence[Bead], places: Sequence[Place], progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    """The paths of all beads with their layer and index, and what was done to make them fit.

    Beads with a polynomial that is given have that one, and are judged like the others.
    """
    fixed = given.coefficients(task.parameters, places)
    free = [k for k in range(len(beads)) if k not in fixed]
    paths, helped = (
        _searched(task, [beads[k] for k in free], [places[k] for k in free], progress)
        if free
        else ([], {})
    )
    of_bead = dict(zip(free, paths)) | given.paths(task, beads, places, fixed)
    together, issues = fit.put_in(
        task, [of_bead[k] for k in range(len(beads))], {free[k]: some for k, some in helped.items()}
    )
    return together, issues


def _searched(
    task: Task, beads: Sequence[Bead], places: Sequence[Place], progress: Progress
) -> tuple[list[BeadPath], dict[int, list[BeadPath]]]:
    """The path of every bead, and of those that another seam or a cut helps what to put in its place."""
    coarse, full = gather(beads, task.cell, search.POINTS_PER_BEAD), gather(beads, task.cell)
    coarse_threshold, threshold = task.thresholds(coarse), task.thresholds(full)
    progress(0.1, "searching rotations")
    joined = task.joined & full.closed
    found = search.everywhere(
        task, coarse, coarse_threshold, best_alone=task.kept is None and not joined.any()
    )
    if task.kept is not None:
        progress(0.2, "keeping the arm clear")
        looked = gather(beads, task.cell, arm_clear.POINTS_PER_BEAD)
        found = arm_clear.exclude_touching(task, task.kept, looked, places, found)
    best, each = found.best(), np.arange(len(beads))
    start = found.coefficients[best, each]
    # a bead that no rotation serves from its own seam may do from another: cheaper to try than a local search
    hopeless = [int(k) for k in np.flatnonzero(found.margin[best, each] < 0.0)]
    roomy = fit.for_beads(task, [beads[k] for k in hopeless], [places[k] for k in hopeless])
    helped = {k: paths for k, paths in zip(hopeless, roomy) if paths is not None}
    starts = _with_other_turns(start, found) if joined.any() else start[None]
    starts[1:, ~joined] = np.nan
    progress(0.4, "refining layers")
    wanted = np.array([k not in helped for k in each])
    wanted |= np.array([len(helped.get(int(k), ())) > 1 and bool(joined[k]) for k in each])
    refined = refine.refine(
        task,
        full,
        threshold,
        starts,
        wanted,
        lambda share: progress(0.4 + 0.3 * share, "refining layers"),
    )
    progress(0.7, "settling")
    paths = _resolved(task, beads, places, (coarse, coarse_threshold), (full, threshold), refined)
    others = elsewhere.where_lost(
        task, beads, places, paths, found, lambda share: progress(0.7 + 0.1 * share, "settling")
    )
    paths = [others.get(k) or path for k, path in enumerate(paths)]
    if task.kept is not None:
        progress(0.8, "keeping the arm clear")
        reached = dataclasses.replace(
            refined, coefficients=np.array([path.coefficients for path in paths])
        )
        clear, changed = arm_clear.brought_clear(task, task.kept, beads, places, start, reached)
        if changed.any():
            moved = judged(task, beads, places, full, threshold, clear.coefficients, clear)
            paths = [other if one else path for path, other, one in zip(paths, moved, changed)]
    # a joined bead that a higher degree serves in one piece need not be split
    helped = {
        k: some
        for k, some in helped.items()
        if len(some) == 1 or not joined[k] or paths[k].margin < FITS
    }
    late = [
        k
        for k in range(len(beads))
        if k not in helped
        and k not in hopeless
        and (paths[k].margin < FITS or (task.kept is None and others.get(k, paths[k]) is None))
    ]
    helped.update(
        {
            k: found
            for k, found in zip(
                late, fit.for_beads(task, [beads[k] for k in late], [places[k] for k in late])
            )
            if found is not None
        }
    )
    return paths, helped


def _resolved(
    task: Task,
    beads: Sequence[Bead],
    places: Sequence[Place],
    coarse: tuple[Points, Array],
    full: tuple[Points, Array],
    refined: refine.Refined,
) -> list[BeadPath]:
    """The paths of all beads with the ties of their optima resolved. coarse, full: few and all of their points, with the
    conditions asked for there."""
    resolved = ties.resolve(task, *coarse, refined.coefficients)
    paths = judged(task, beads, places, *full, resolved, refined)
    equal = ties.as_good(task, [path.objective for path in paths], refined.objective)
    if equal.all() and all(path.margin >= FITS for path in paths):
        return paths
    # ties are resolved at few points of a bead: where all of them say otherwise, the optimum stays as it was found
    as_found = judged(task, beads, places, *full, refined.coefficients, refined)
    return [
        path if good and path.margin >= min(FITS, other.margin) else other
        for path, other, good in zip(paths, as_found, equal)
    ]


def _with_other_turns(start: Array, found: search.Found) -> Array:
    """(S, B, degree + 1) the starts with the best of each other number of whole turns, NaN where that is not promising.

    Which number of turns is best can change with what a higher degree makes of it.
    """
    if start.shape[1] < 2:
        return start[None]
    each = np.arange(len(start))
    best = found.best()
    margin, most = found.margin[best, each], NOT_MUCH_WORSE * found.objective[best, each]
    others = []
    for turns in OTHER_TURNS:
        few = found.of_slope(turns)
        row = few.best()
        serves = (few.margin[row, each] >= 0.0) & (few.objective[row, each] <= most)
        promising = np.where(margin >= 0.0, serves, np.isfinite(few.margin[row, each]))
        other = promising & (np.abs(start[:, 1] - turns) > 1e-9)
        others.append(np.where(other[:, None], few.coefficients[row, each], np.nan))
    return np.stack([start, *others])
