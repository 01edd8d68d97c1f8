# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan the joint path of a toolpath in a cell: branch, planning method, unwrapping and checks."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Sequence

import numpy as np

from ..issues import ERROR, NOTE, WARNING, Issue, Text, has_errors
from ..kinematics.cell import Cell
from ..kinematics.inverse import spherical_wrist
from ..parameters.joints import OF_CELL, JointParameters
from ..toolpath import Bead, Toolpath
from . import clear_rotations, criteria
from .arm_clearance import ArmKept, Cylinders, build_arm_clearance
from .beads import phases
from .beads.chord_error import all_refined
from .beads.retreat import extend_past_seam, go_back
from .beads.speeds import corners_slowed, rings_slowed, too_fast
from .external import optimised, track
from .external.level import ways
from .findings import findings, out_of_reach
from .joint_path import BeadPath, JointPath
from .methods import closed_form, constant, layer_by_layer, point_by_point
from .points import gather
from .rotation import given, global_search
from .task import Parts, Task
from .turns import unwrap as turns
from .turns.directed import as_held, lock_of

Progress = Callable[[float, str], None]
Place = tuple[int, int]

METHODS = {
    "layer-by-layer": layer_by_layer.plan,
    "point-by-point": point_by_point.plan,
    "constant": constant.plan,
}
ALL_METHODS = METHODS | {
    closed_form.METHOD: closed_form.plan
}  # planning method for machines without a free tool rotation
# settings that apply only to robots with a free tool rotation
OF_ROBOTS = (
    "method",
    "rz",
    "degree",
    "parameter",
    "rotation_range",
    "objective",
    "min_condition",
    "characteristic_length",
    "tolerance",
    "max_iterations",
    "compare",
    "given",
    "own_branch",
    "certificate",
    "close_gap",
    "external_axes",
)
BRANCHES = 8
# for branch auto: beads sampled in each branch, and branches planned until one is feasible
SCREENED, MAX_BRANCHES_PLANNED = 12, 3


def _silent(fraction: float, text: str) -> None:
    pass


def plan_joints(
    toolpath: Toolpath,
    cell: Cell,
    parameters: JointParameters,
    progress: Progress = _silent,
    cylinders: Cylinders = (),
) -> JointPath:
    """Plan the joint path of a toolpath.

    Report problems (unreachable, over a limit, singular, too fast) as issues with layer, bead
    and point. An infeasible path is still returned for display.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    cell : Cell
        The cell.
    parameters : JointParameters
        Method, objective, branch and thresholds.
    progress : callable, optional
        Called with the completed fraction and a text; may raise to cancel.
    cylinders : Cylinders, optional
        Cylinders around each robot link; kept clear of obstacles if `cell.arm_clearance` is
        set.

    Returns
    -------
    JointPath
        The first feasible path in the order of external axis values, then branches. If no path
        is feasible, the first one with its issues.

    Raises
    ------
    InputError
        NOT_FOR_SETUP for settings that need another kind of machine.
    """
    lock, (parameters, not_used) = lock_of(cell, parameters, toolpath), _used(cell, parameters)
    features = toolpath.parts
    joined = not any(feature.traits.has_axis for feature, _ in features)
    arm_clearance = build_arm_clearance(toolpath, cell, cylinders)
    requested_branch = _branch_wanted(cell, parameters)
    among = range(BRANCHES) if requested_branch is None else (requested_branch,)
    task = Task(
        cell,
        0,
        parameters,
        joined,
        arm_clearance,
        lock,
        toolpath.chord_error,
        toolpath.rules,
        features,
    )

    def count_served(sampled_beads: Sequence[Bead]) -> float:
        return -_ranked(sampled_beads, bead_ids, task, among)[0][0] / min(
            len(sampled_beads), SCREENED
        )

    planned: JointPath | None = None
    for beads, bead_ids, tilted in ways(cell, toolpath):
        for moved in track.place_track(beads, cell, count_served):
            branches = (
                [requested_branch]
                if requested_branch is not None
                else best_branches(moved, cell, parameters, joined, arm_clearance, bead_ids)
            )
            joint_path = _in_branches((moved, bead_ids), tilted, task, branches, progress)
            if planned is None or joint_path.feasible:
                planned = joint_path
            if planned.feasible:
                return dataclasses.replace(planned, issues=(*planned.issues, *not_used))
    assert planned is not None  # there is at least one way
    return dataclasses.replace(
        planned, issues=(*out_of_reach(cell, planned.beads), *planned.issues, *not_used)
    )


def _choices(task: Task) -> tuple[str, str, tuple[str, ...]]:
    """Return the planning method, objective and branch names of a joint path.

    A machine without a free tool rotation has one method and no objective.
    """
    if not task.cell.machine.free:
        return closed_form.METHOD, "none", ()
    return (
        task.parameters.method,
        task.parameters.objective,
        spherical_wrist.branch_name(task.branch),
    )


def _branch_wanted(cell: Cell, parameters: JointParameters) -> int | None:
    """Return the branch to plan in; None to search all branches.

    A machine without a free tool rotation chooses the branch per bead.
    """
    if not cell.machine.free:
        return 0
    return (
        cell.branch
        if parameters.own_branch == OF_CELL
        else spherical_wrist.branch_index(parameters.own_branch.split("-"))
    )


def _in_branches(
    placed: tuple[list[Bead], list[Place]],
    tilted: list[Issue],
    base_task: Task,
    branches: Sequence[int],
    progress: Progress,
) -> JointPath:
    """Plan in each branch until a path is feasible; if none is, return the first branch's path."""
    (beads, bead_ids), cell, parameters = placed, base_task.cell, base_task.parameters
    together, notes = optimised.asked(parameters, cell)
    task = dataclasses.replace(base_task, branch=branches[0])
    paths, issues = _planned(task, beads, bead_ids, progress)
    failed = _failed(paths, issues, bead_ids)
    for branch in branches[1:] if has_errors(issues) else ():
        branch_task = dataclasses.replace(base_task, branch=branch)
        # a branch usually fails at the same beads as the first: plan these beads first
        failed_beads = [beads[k] for k in failed], [bead_ids[k] for k in failed]
        if failed and has_errors(_planned(branch_task, *failed_beads, progress)[1]):
            continue
        outcome = _planned(branch_task, beads, bead_ids, progress)
        if not has_errors(outcome[1]):
            task, (paths, issues) = branch_task, outcome
            break
    level = None
    if together:
        (paths, issues), level = _optimise_external(
            task, beads, bead_ids, (paths, issues), progress
        )
    issues = [*tilted, *issues, *notes]
    if cell.robot.arm is not None and cell.robot.arm.followed:
        issues = [
            *issues,
            Issue(
                NOTE,
                "FOLLOWED",
                "several solutions of the arm share a configuration; each bead keeps the "
                "solution of its first point",
            ),
        ]
    comparisons = tuple(
        _compared(task, beads, bead_ids, method, progress) for method in _compare_order(parameters)
    )
    optimality = None
    if parameters.certificate and not has_errors(issues):
        from .certificate import bound  # few jobs need it

        optimality, notes = bound.summed(
            task, paths, lambda share: progress(share, "computing the lower bound of the objective")
        )
        issues = [*issues, *notes]
    return JointPath(
        *_choices(task),
        cell.limits.name,
        tuple(paths),
        tuple(issues),
        comparisons,
        optimality,
        level,
    )


def _failed(
    paths: Sequence[BeadPath], issues: Sequence[Issue], bead_ids: Sequence[tuple[int, int]]
) -> list[int]:
    """Return the indices of up to SCREENED beads with errors.

    If planning split a bead, every bead of a layer with errors counts as failed.
    """
    wrong = {(issue.layer, issue.bead) for issue in issues if issue.level == ERROR}
    if len(paths) != len(set(bead_ids)):
        wrong_layers = {layer for layer, _ in wrong}
        wrong = {bead_id for bead_id in bead_ids if bead_id[0] in wrong_layers}
    failed = [k for k, bead_id in enumerate(bead_ids) if bead_id in wrong]
    if not failed:
        return []
    positions = np.linspace(0, len(failed) - 1, SCREENED)
    return [failed[k] for k in sorted({round(position) for position in positions})]


def _used(cell: Cell, parameters: JointParameters) -> tuple[JointParameters, list[Issue]]:
    """Reset the tool rotation settings on a machine without a free tool rotation.

    Return the parameters, and a note that lists the ignored settings.
    """
    if cell.machine.free:
        return parameters, []
    usual = JointParameters()
    ignored = [
        f"joints.{name}" for name in OF_ROBOTS if getattr(parameters, name) != getattr(usual, name)
    ]
    parameters = dataclasses.replace(
        parameters, **{name: getattr(usual, name) for name in OF_ROBOTS}
    )
    ignored += [] if cell.arm_clearance is None else ["cell.arm_clearance"]
    ignored += ["cell.obstacles"] if cell.shapes.obstacles else []
    ignored += ["cell.nozzle.shape"] if cell.nozzle.shape is not None else []
    if not ignored:
        return parameters, []
    return parameters, [
        Issue(
            NOTE,
            "NOT_USED",
            Text(
                "{}: no effect on a five-axis machine, which has no tool redundancy; remove the "
                "settings for robots",
                ", ".join(ignored),
            ),
        )
    ]


def best_branches(
    beads: Sequence[Bead],
    cell: Cell,
    parameters: JointParameters,
    joined: bool = False,
    arm_clearance: ArmKept | None = None,
    bead_ids: Sequence[Place] = (),
) -> list[int]:
    """Return the branches worth planning, the best first.

    They reach the most beads, ordered by objective and then by margin. The ranking samples a
    few beads along the toolpath, so a full plan may still fail.

    Parameters
    ----------
    beads : sequence of Bead
        The beads in print order.
    cell : Cell
        The cell.
    parameters : JointParameters
        Objective and thresholds.
    joined : bool, optional
        Whether the rotation polynomial of a closed bead must return to its start value.
    arm_clearance : ArmKept or None, optional
        The link clearance check; None to skip it.
    bead_ids : sequence of Place, optional
        Layer and index of each bead; needed with `arm_clearance`.

    Returns
    -------
    list of int
        At most MAX_BRANCHES_PLANNED indices.
    """
    ranks = _ranked(
        beads, bead_ids, Task(cell, 0, parameters, joined, arm_clearance), range(BRANCHES)
    )
    return [rank[-1] for rank in ranks if rank[0] == ranks[0][0]][:MAX_BRANCHES_PLANNED]


def _ranked(
    beads: Sequence[Bead], bead_ids: Sequence[Place], base_task: Task, among: Sequence[int]
) -> list[tuple[int, int, float, float, int]]:
    """Return the ranking key of each branch, the best first.

    A key holds the number of sampled beads that the branch can print (negative), that number
    without the link clearance check (negative), the objective, the margin (negative) and the
    branch.
    """
    sampled = np.unique(np.round(np.linspace(0, len(beads) - 1, SCREENED)).astype(int))
    points = gather([beads[k] for k in sampled], base_task.cell, global_search.POINTS_PER_BEAD)
    ranks = []
    for branch in among:
        task = dataclasses.replace(base_task, branch=branch)
        candidates = global_search.everywhere(
            task, points, task.thresholds(points), best_alone=task.kept is None
        )
        within = 0
        if task.kept is not None:
            within = int((candidates.margin.max(axis=0) >= 0.0).sum())
            candidates = clear_rotations.exclude_touching(
                task, task.kept, points, [bead_ids[k] for k in sampled], candidates
            )
        best, bead_rows = candidates.best(), np.arange(len(sampled))
        margin = candidates.margin[best, bead_rows]
        objective = candidates.objective[best, bead_rows]
        feasible = margin >= 0.0
        worth = float(objective[feasible].sum()) if feasible.any() else np.inf
        # round, so that two mirrored branches rank the same on every computer
        ranks.append(
            (
                -int(feasible.sum()),
                -within,
                float(f"{worth:.8e}"),
                round(-float(margin.min()), 9),
                branch,
            )
        )
    return sorted(ranks)


def _compare_order(parameters: JointParameters) -> list[str]:
    return [
        method for method in METHODS if method in parameters.compare and method != parameters.method
    ]


def _planned(
    task: Task, beads: Sequence[Bead], bead_ids: Sequence[Place], progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    paths, issues = ALL_METHODS[_choices(task)[0]](task, beads, bead_ids, progress)
    paths, issues_found = _finished(task, paths)
    return paths, given.not_used(task.parameters, bead_ids) + issues + issues_found


def _optimise_external(
    task: Task,
    beads: Sequence[Bead],
    bead_ids: Sequence[Place],
    level: tuple[list[BeadPath], list[Issue]],
    progress: Progress,
) -> tuple[tuple[list[BeadPath], list[Issue]], dict[str, object]]:
    """Return the better of `level` and the plan with optimised external axes, with the statistics
    of `level`.
    """
    planned, issues = METHODS[task.parameters.method](task, beads, bead_ids, _silent)
    first_issues = given.not_used(task.parameters, bead_ids) + issues

    def finish(paths: list[BeadPath]) -> tuple[list[BeadPath], list[Issue]]:
        finished, issues_found = _finished(task, paths)
        return finished, first_issues + issues_found

    return optimised.choose_better(
        task,
        level,
        planned,
        finish,
        lambda share: progress(share, "optimising the external axes"),
    )


def _finished(task: Task, paths: Sequence[BeadPath]) -> tuple[list[BeadPath], list[Issue]]:
    """Finish planned paths: add points for linear motion, unwrap, split into phases and slow down.

    Return the paths and their issues.
    """
    from .certificate import bound  # few jobs need it

    straight = bound.close_gaps(task, _as_run(task, paths))
    paths, notes = turns.unwrapped(task, [path for path, _ in straight])
    paths, missed = as_held(task.cell, paths, task.lock, task.parameters.max_residual)
    phased = [phases.phased(task.cell, path, task.condition_at) for path in paths]
    paths = [path for path, _ in phased]
    issues = notes + [issue for _, issues_found in (*phased, *straight) for issue in issues_found]
    for path in paths:
        issues += findings(task, path)
    issues += missed
    if task.kept is not None:
        issues += clear_rotations.findings(task.kept, paths)
    if not has_errors(issues):
        paths, issues_found = _slowed(task.cell, paths, task.parts)
        issues = issues + issues_found
    return paths, issues


def _as_run(task: Task, paths: Sequence[BeadPath]) -> list[tuple[BeadPath, list[Issue]]]:
    """Extend each path by its retreat and seam overlap, and refine it to the chord error."""
    if (
        not task.cell.machine.free
        # planned with overlap and retreat already: the axis limits allow the whole bead or
        # none of it
    ):
        return [(path, []) for path in paths]
    longer = [
        extend_past_seam(task, go_back(task, path, task.rules.retreat), task.rules.overlap)
        for path in paths
    ]
    return all_refined(task, longer, task.chord_error)


def _slowed(
    cell: Cell, paths: Sequence[BeadPath], features: Parts
) -> tuple[list[BeadPath], list[Issue]]:
    """Slow the beads that axes cannot follow, where the strategy allows it; report the others."""
    slowed, notes = list(paths), []
    for feature, layers in features:
        feature_layers = set(layers.tolist())
        rows = [k for k, path in enumerate(paths) if path.layer in feature_layers]
        feature_paths = [paths[k] for k in rows]
        if not feature_paths:
            continue
        if feature.traits.is_filled:
            feature_paths, issues_found = corners_slowed(
                cell, feature_paths, feature.layer_height, feature.law
            )
        else:
            feature_paths, issues_found = rings_slowed(cell, feature_paths, feature.layer_height)
        notes += issues_found
        for k, path in zip(rows, feature_paths, strict=True):
            slowed[k] = path
    return slowed, notes + too_fast(cell, slowed)


def _compared(
    task: Task,
    beads: Sequence[Bead],
    bead_ids: Sequence[tuple[int, int]],
    method: str,
    progress: Progress,
) -> dict[str, object]:
    started = time.perf_counter()
    compared_task = dataclasses.replace(
        task, parameters=dataclasses.replace(task.parameters, method=method)
    )
    paths, issues = METHODS[method](compared_task, beads, bead_ids, progress)
    for path in paths:
        issues += findings(compared_task, path)
    return {
        "method": method,
        "feasible": not has_errors(issues),
        **criteria.figures(compared_task, paths),
        "planning_time_s": time.perf_counter() - started,
        "issues": [issue.as_dict() for issue in issues if issue.level != WARNING][:20],
    }
