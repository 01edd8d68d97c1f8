# SPDX-License-Identifier: LGPL-2.1-or-later
"""External axes `optimised`: polynomials per bead for tool rotation and all external axes.

The optimisation starts from the joint path with the external axes placed by `level`. For each bead
it tries other positions of the external axes, each with a new search of the rotation. Two local
optimisations then start from the best position and from the path itself: the minimum objective with
at least the same margin, then the maximum margin that keeps most of the gain. A bead that does not
improve, or that collides, keeps its path.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from ...issues import ERROR, NOTE, InputError, Issue, Text, has_errors
from ...kinematics.cell import Cell
from ...kinematics.external import tilt_from
from ...parameters.joints import LEVEL_METHOD, JointParameters
from ...types import Array
from ..joint_path import BeadPath
from ..points import Points, gather, thinned
from ..rotation import global_search, local_optimisation, refine_state
from ..rotation.given import GIVEN
from ..rotation.local_optimisation import evaluate_paths
from ..task import Task, condition_margin
from .freedom import Freedom, largest_margin, least_objective, set_external_values
from .level import allowed_by_layer, axes_figures
from .stroke import directions_on_face

OPTIMISED = "rotation and external axes together"
POINTS_PER_BEAD = 40
GIVEN_BACK = 0.25  # fraction of the gain in the objective to trade for a larger margin
SUFFICIENT_MARGIN = 0.5  # sufficient margin: halfway between limit and mid-range
TRIES = 2  # attempts for a bead that tilts too far between the optimised points
SPARE = 1e-4  # reserve of margin and angle for the curve between the points
STANDING = 12  # number of positions to try for an axis without a preferred position
LEANING = np.array(
    [-1.0, -0.5, 0.5, 1.0]
)  # shifts to try for every axis, relative to the maximum angle from the vertical
SLIDING = np.array([-0.2, -0.1, 0.1, 0.2])  # track shifts to try, relative to the arm reach


def optimised(
    task: Task,
    paths: Sequence[BeadPath],
    directions: Callable[[Array], Array],
    allowed: Mapping[int, float],
    report: Callable[[float], None] = lambda share: None,
) -> list[BeadPath]:
    """Replace paths by paths with a lower objective and at least the same margin.

    Parameters
    ----------
    task : Task
        The plan.
    paths : sequence of BeadPath
        The paths; given polynomials and beads of two points stay unchanged.
    directions : callable
        Returns the tool axes (n, 3) in the frame of the face that carries the part.
    allowed : mapping of int to float
        Maximum angle from the vertical by layer, rad.
    report : callable, optional
        Receives the completed fraction; may raise to cancel.

    Returns
    -------
    list of BeadPath
        The paths, in the order of `paths`.
    """
    usable = [
        k
        for k, path in enumerate(paths)
        if path.coefficients is not None and path.reason != GIVEN and len(path.bead) > 2
    ]
    if not usable:
        return list(paths)
    result = list(paths)
    starts = _elsewhere(task, [paths[k] for k in usable], directions, allowed)
    for number, (k, start) in enumerate(zip(usable, starts, strict=True)):
        report(number / len(usable))
        result[k] = _bead(task, paths[k], start, directions, allowed[paths[k].layer])
    return result


def better(path: BeadPath, reference: BeadPath) -> bool:
    """Whether a path is feasible and better than another path.

    Its objective is not higher and its margin not lower (up to SUFFICIENT_MARGIN), or the other
    path violates limits.
    """
    if not path.reachable or path.margin < 0.0 or not np.isfinite(path.objective):
        return False
    if not reference.reachable or reference.margin < 0.0:
        return True
    return path.objective <= reference.objective and path.margin >= min(
        reference.margin, SUFFICIENT_MARGIN
    )


Start = tuple[Array, Array]  # shift (k,) of the external axes, rotation coefficients


def _elsewhere(
    task: Task,
    paths: Sequence[BeadPath],
    directions: Callable[[Array], Array],
    allowed: Mapping[int, float],
) -> list[Start | None]:
    """Return the best shift of the external axes, and its rotation, for each path.

    None if no shift is better.
    """
    external = task.cell.external
    assert external is not None
    beads = [path.bead for path in paths]
    points = gather(beads, task.cell, global_search.POINTS_PER_BEAD)
    max_lean = np.array([allowed[path.layer] for path in paths])
    thresholds = np.concatenate(
        [path.threshold[thinned(path.bead, global_search.POINTS_PER_BEAD)] for path in paths]
    )
    best = _evaluate_shifts(
        task, points, thresholds, max_lean, directions, np.zeros((len(paths), external.axes))
    )
    for axis in reversed(range(external.axes)):
        candidates = [best]
        for step in _steps(task, axis, float(max_lean.max())):
            shifts = best[0].copy()
            shifts[:, axis] += step
            candidates.append(
                _evaluate_shifts(task, points, thresholds, max_lean, directions, shifts)
            )
        rank = np.argmin(
            [
                np.where(candidate[3] >= 0.0, candidate[2], 1e6 - candidate[3])
                for candidate in candidates
            ],
            axis=0,
        )
        best = tuple(  # type: ignore[assignment]
            np.stack([candidates[r][field][k] for k, r in enumerate(rank)]) for field in range(4)
        )
    return [
        (best[0][k], best[1][k]) if best[3][k] >= 0.0 and best[0][k].any() else None
        for k in range(len(paths))
    ]


def _evaluate_shifts(
    task: Task,
    points: Points,
    thresholds: Array,
    max_lean: Array,
    directions: Callable[[Array], Array],
    shifts: Array,
) -> tuple[Array, Array, Array, Array]:
    """Return the shifts (B, k) of the external axes, with the best coefficients, objective and
    margin of each bead.
    """
    assert points.external is not None
    values = points.external + shifts[points.bead]
    candidates = global_search.everywhere(
        task, set_external_values(points, task.cell, values), thresholds, best_alone=True
    )
    best, bead_rows = candidates.best(), np.arange(points.beads)
    margin = candidates.margin[best, bead_rows]
    if task.cell.external is not None and task.cell.external.turning:
        external = task.cell.external
        upright = external.upright(directions(points.tool), values) @ external.up
        upright_before = external.upright(directions(points.tool), points.external) @ external.up
        keeps = (
            points.worst(upright - np.minimum(np.cos(max_lean)[points.bead], upright_before))
            >= -1e-9
        )
        margin = np.where(keeps, margin, -np.inf)
    return (
        shifts,
        candidates.coefficients[best, bead_rows],
        candidates.objective[best, bead_rows],
        margin,
    )


def _steps(task: Task, axis: int, max_lean: float) -> Array:
    """Return the shifts to try for an external axis."""
    external, arm = task.cell.external, task.cell.robot.arm
    assert external is not None and arm is not None
    if axis == external.slides:
        return SLIDING * arm.reach
    if max_lean < math.radians(90.0):
        return LEANING * max_lean
    turn = 2.0 * math.pi / STANDING
    return np.asarray((np.arange(1, STANDING) - STANDING // 2) * turn)


def _bead(
    task: Task,
    path: BeadPath,
    start: Start | None,
    directions: Callable[[Array], Array],
    allowed: float,
) -> BeadPath:
    """Return the best path from local optimisations that start from this path and from `start`."""
    best = path
    for shift, coefficients in ([] if start is None else [start]) + [(None, path.coefficients)]:
        assert coefficients is not None and path.bead.external is not None
        values = path.bead.external if shift is None else path.bead.external + shift
        shifted = dataclasses.replace(path, bead=dataclasses.replace(path.bead, external=values))
        candidate = _upright_enough(task, path, shifted, coefficients, directions, allowed)
        if (
            candidate is not None
            and better(candidate, best)
            and (best is path or candidate.objective < best.objective)
        ):
            best = candidate
    return best


def _upright_enough(
    task: Task,
    path: BeadPath,
    shifted: BeadPath,
    coefficients: Array,
    directions: Callable[[Array], Array],
    allowed: float,
) -> BeadPath | None:
    """Optimise from a start, and tighten the tilt limit until no point in between exceeds it."""
    external, spare = task.cell.external, SPARE
    assert external is not None
    for _ in range(TRIES):
        freedom = _freedom(task, shifted, coefficients, directions, allowed - spare)
        candidate = _evaluate_path(task, shifted, *_optimise_in_stages(freedom, path))
        assert candidate.bead.external is not None
        leans = tilt_from(
            external.upright(directions(candidate.bead.tool), candidate.bead.external), external.up
        )
        over = float(leans.max()) - allowed
        if over <= 0.0:
            return candidate
        spare += 2.0 * over
    return None


def _freedom(
    task: Task,
    path: BeadPath,
    coefficients: Array,
    directions: Callable[[Array], Array],
    allowed: float,
) -> Freedom:
    thin = thinned(path.bead, POINTS_PER_BEAD)
    points = gather([path.bead], task.cell, POINTS_PER_BEAD)
    full = np.zeros(max(len(coefficients), task.parameters.degree + 1))
    full[: len(coefficients)] = coefficients
    changes = refine_state.changes(task, points, len(full) - 1)[0]
    changes = changes[:, np.abs(changes).any(axis=0)]
    durations = np.linalg.norm(np.diff(path.bead.points, axis=0), axis=1) / path.bead.speed[1:]
    times = np.diff(np.concatenate([[0.0], np.cumsum(durations)])[thin], prepend=0.0)
    return Freedom(
        task, points, path.threshold[thin], full, changes, allowed, directions(points.tool), times
    )


def _evaluate_path(
    task: Task, path: BeadPath, freedom: Freedom, x: Array, iterations: int
) -> BeadPath:
    """Return the path of a bead with changes x, evaluated at all its points."""
    coefficients, _ = freedom.values(x)
    points = gather([path.bead], task.cell)
    rows = x.reshape(1 + freedom.external.axes, -1)
    assert points.external is not None
    shape = points.powers(len(coefficients) - 1) @ freedom.changes
    bead = dataclasses.replace(
        path.bead, external=points.external + shape @ rows[1:].T * freedom.unit
    )
    points = gather([bead], task.cell)
    why = local_optimisation.Refined(coefficients[None], np.zeros(1), (OPTIMISED,), (iterations,))
    (result,) = evaluate_paths(
        task,
        [bead],
        [(path.layer, path.index)],
        points,
        task.thresholds(points),
        coefficients[None],
        why,
    )
    return result


def _optimise_in_stages(freedom: Freedom, path: BeadPath) -> tuple[Freedom, Array, int]:
    """Minimise the objective with at least the margin of the path, then maximise the margin at the
    expense of a fraction of the gain.
    """
    x = np.zeros((1 + freedom.external.axes) * freedom.shape.shape[1])
    state = freedom.look(x)
    if state is None:
        return freedom, x, 0
    sound = path.reachable and path.margin >= 0.0
    margin = min(max(path.margin, 0.0), SUFFICIENT_MARGIN) if sound else 0.0
    x, count = least_objective(freedom, x, margin + SPARE)
    state = freedom.look(x)
    if state is None:
        return freedom, x, count
    max_objective = (
        state.objective + GIVEN_BACK * max(0.0, path.objective - state.objective)
        if sound
        else 2.0 * state.objective
    )
    x, more_iterations = largest_margin(freedom, x, max_objective, SUFFICIENT_MARGIN)
    return freedom, x, count + more_iterations


Found = tuple[list[BeadPath], list[Issue]]
METHOD = "layer-by-layer"


def asked(parameters: JointParameters, cell: Cell) -> tuple[bool, list[Issue]]:
    """Return whether to optimise the external axes.

    Parameters
    ----------
    parameters : JointParameters
        Joint planning parameters.
    cell : Cell
        The cell.

    Returns
    -------
    wanted : bool
        Whether the job requests it and the cell has external axes.
    issues : list of Issue
        A note if there are no external axes to optimise.

    Raises
    ------
    InputError
        NOT_FOR_SETUP for methods without polynomials per bead.
    """
    if parameters.external_axes == LEVEL_METHOD:
        return False, []
    if cell.external is None:
        return False, [
            Issue(
                NOTE,
                "NOT_USED",
                Text(
                    "joints.external_axes: {} has no effect without cell.external; remove "
                    "joints.external_axes",
                    parameters.external_axes,
                ),
            )
        ]
    if parameters.method != METHOD:
        raise InputError(
            "NOT_FOR_SETUP",
            "joints.external_axes",
            "{} needs polynomials per bead, which the method {} lacks; use method: {}, or "
            "external_axes: {}",
            parameters.external_axes,
            parameters.method,
            METHOD,
            LEVEL_METHOD,
        )
    return True, []


def choose_better(
    task: Task,
    level: Found,
    planned: Sequence[BeadPath],
    finish: Callable[[list[BeadPath]], Found],
    report: Callable[[float], None],
) -> tuple[Found, dict[str, object]]:
    """Return the better of the level plan and the plan with optimised external axes.

    Parameters
    ----------
    task : Task
        The plan.
    level : Found
        The finished paths and issues of the level plan.
    planned : sequence of BeadPath
        Beads of the level plan before `finish` refines and unwraps them.
    finish : callable
        Returns the finished paths and their issues.
    report : callable
        Receives the completed fraction; may raise to cancel.

    Returns
    -------
    result : Found
        Paths and issues of the better plan.
    figures : dict
        Statistics of the level plan, for comparison.
    """
    # few jobs have external axes

    paths = list(planned)
    candidate = optimised(
        task,
        paths,
        lambda tool: directions_on_face(task.cell, tool),
        allowed_by_layer(task.parts),
        report,
    )
    result = finish(candidate)
    if not _better(task, result, level):
        wrong = _worse(task, result, level)
        result = finish(
            [
                old if (new.layer, new.index) in wrong else new
                for old, new in zip(paths, candidate, strict=True)
            ]
        )
    return (result if _better(task, result, level) else level), figures(task, level[0])


def _worse(task: Task, result: Found, level: Found) -> set[tuple[int | None, int | None]]:
    """Return the beads that have errors after unwrapping, or a lower margin than `level`."""
    wrong = {(issue.layer, issue.bead) for issue in result[1] if issue.level == ERROR}
    if not has_errors(level[1]):
        smallest_margin = least_margin(task, level[0])
        wrong |= {
            (path.layer, path.index)
            for path in result[0]
            if path.reachable and least_margin(task, [path]) < smallest_margin
        }
    return wrong


def figures(task: Task, paths: Sequence[BeadPath]) -> dict[str, object]:
    """Return the statistics for comparing paths.

    These are the objective, the minimum margin to a limit or the condition threshold, the minimum
    condition, and the travel of the external axes.
    """
    complete = all(path.reachable for path in paths)
    return {
        "objective_value": float(sum(path.objective for path in paths)) if complete else None,
        "least_margin": least_margin(task, paths) if complete else None,
        "condition_min": float(min(path.condition.min() for path in paths)),
        **axes_figures(task.cell, paths),
    }


def least_margin(task: Task, paths: Sequence[BeadPath]) -> float:
    """Return the minimum margin of any axis to its limits less RESERVE, or of the condition.

    1 is mid-range.
    """
    margins = [
        np.minimum(
            task.rows.margin(path.joints), condition_margin(path.condition, path.threshold)
        ).min()
        for path in paths
    ]
    return float(min(margins))


def _better(task: Task, result: Found, level: Found) -> bool:
    if has_errors(result[1]):
        return False
    if has_errors(level[1]):
        return True
    less = sum(path.objective for path in result[0]) <= sum(path.objective for path in level[0])
    return less and least_margin(task, result[0]) >= least_margin(task, level[0])
