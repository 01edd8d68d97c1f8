# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a toolpath and a cell to the joint path: branch, method, turns, points between, findings."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..issues import ERROR, WARNING, InputError, Issue, has_errors
from ..kinematics import opw
from ..kinematics.cell import Cell
from ..parameters.joints import JointParameters
from ..toolpath import Bead, Toolpath
from . import comparison, constant, layer_by_layer, point_by_point, search, table, turns
from .findings import findings
from .joint_path import BeadPath, JointPath
from .overlap import run_on
from .points import gather
from .straight import kept_straight
from .task import Task

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

METHODS = {"layer-by-layer": layer_by_layer.plan, "point-by-point": point_by_point.plan, "constant": constant.plan}
BRANCHES = 8
# with the branch left open: beads looked at in each, and branches planned until one serves
SCREENED, TRIED = 12, 3
REVOLUTION = "revolution"


def _silent(fraction: float, text: str) -> None:
    pass


def plan_joints(
    toolpath: Toolpath, cell: Cell, parameters: JointParameters, progress: Progress = _silent
) -> JointPath:
    """The joint path of a toolpath.

    Findings (unreachable, over a limit, singular, too fast) are issues of the result with layer, bead and point; the
    path is there all the same, to be looked at. progress(fraction, text) may raise to cancel. Raises InputError
    NOT_FOR_SETUP for what only rotary axes can do.
    """
    places = [(layer, index) for layer, index, _ in toolpath]
    beads = [bead for _, _, bead in toolpath]
    if cell.machine.is_table:
        return _on_table(toolpath, cell, parameters, progress)
    if parameters.lock != "none":
        raise InputError("NOT_FOR_SETUP", "joints.lock", "robots need all their axes; only machines with rotary axes can do "
                         "with four; use none")
    joined = toolpath.family != REVOLUTION
    branches = [cell.branch] if cell.branch is not None else best_branches(beads, cell, parameters, joined)
    chosen = None
    for branch in branches:
        task = Task(cell, branch, parameters, joined)
        paths, issues = _planned(task, toolpath, beads, places, progress)
        if chosen is None or not has_errors(issues):
            chosen = task, paths, issues
        if not has_errors(issues):
            break
    assert chosen is not None
    task, paths, issues = chosen
    comparisons = tuple(
        _compared(task, beads, places, method, progress) for method in _compare_order(parameters)
    )
    return JointPath(
        parameters.method, parameters.objective, opw.branch_name(task.branch), cell.limits.name, tuple(paths),
        tuple(issues), comparisons,
    )


def _on_table(toolpath: Toolpath, cell: Cell, parameters: JointParameters, progress: Progress) -> JointPath:
    """The same on a machine with rotary axes, which leaves nothing to optimise."""
    paths, issues = table.plan(cell, toolpath, parameters, progress)
    if not has_errors(issues):
        paths, slowed = rings_slowed(cell, paths, toolpath.layer_height)
        issues += slowed + too_fast(cell, paths)
    return JointPath(table.METHOD, "none", (), cell.limits.name, tuple(paths), tuple(issues))


def best_branches(beads: Sequence[Bead], cell: Cell, parameters: JointParameters, joined: bool = False) -> list[int]:
    """The branches worth planning, the best first: those that serve as many beads as any, by objective, then margin.

    A few beads from the first to the last are looked at; what they promise, the planning has to keep.
    """
    some = np.unique(np.round(np.linspace(0, len(beads) - 1, SCREENED)).astype(int))
    points = gather([beads[k] for k in some], cell, search.POINTS_PER_BEAD)
    ranks = []
    for branch in range(BRANCHES):
        task = Task(cell, branch, parameters, joined)
        found = search.everywhere(task, points, task.thresholds(points))
        best, each = found.best(), np.arange(len(some))
        margin, objective = found.margin[best, each], found.objective[best, each]
        feasible = margin >= 0.0
        worth = float(objective[feasible].sum()) if feasible.any() else np.inf
        # rounded, so that of branches that are mirror images the same comes first everywhere
        ranks.append((-int(feasible.sum()), float(f"{worth:.8e}"), round(-float(margin.min()), 9), branch))
    ranks.sort()
    return [rank[-1] for rank in ranks if rank[0] == ranks[0][0]][:TRIED]


def _compare_order(parameters: JointParameters) -> list[str]:
    return [method for method in METHODS if method in parameters.compare and method != parameters.method]


def _planned(
    task: Task, toolpath: Toolpath, beads: Sequence[Bead], places: Sequence[tuple[int, int]], progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    paths, issues = METHODS[task.parameters.method](task, beads, places, progress)
    longer = [run_on(task, path, toolpath.overlap) for path in paths]
    straight = [kept_straight(task, path, toolpath.chord_error) for path in longer]
    paths, notes = turns.counted_on(task, [path for path, _ in straight])
    issues = issues + notes + [issue for _, found in straight for issue in found]
    for path in paths:
        issues += findings(task, path)
    if not has_errors(issues):
        paths, slowed = rings_slowed(task.cell, paths, toolpath.layer_height)
        issues += slowed + too_fast(task.cell, paths)
    return paths, issues


def _compared(
    task: Task, beads: Sequence[Bead], places: Sequence[tuple[int, int]], method: str, progress: Progress
) -> dict[str, object]:
    started = time.perf_counter()
    other = dataclasses.replace(task, parameters=dataclasses.replace(task.parameters, method=method))
    paths, issues = METHODS[method](other, beads, places, progress)
    for path in paths:
        issues += findings(other, path)
    return {
        "method": method,
        "feasible": not has_errors(issues),
        **comparison.figures(other, paths),
        "planning_time_s": time.perf_counter() - started,
        "issues": [issue.as_dict() for issue in issues if issue.level != WARNING][:20],
    }


def rings_slowed(
    cell: Cell, paths: Sequence[BeadPath], layer_height: float
) -> tuple[list[BeadPath], list[Issue]]:
    """The paths with the tightest turns at the speed the axes allow, and a warning that says so.

    Where a wall closes, the last rings are as small as chance leaves them, and the axis that turns the part would have to
    turn without bound. What runs at less than a layer from the axis of the part is slowed; the rest is not: that is for
    the user to decide.
    """
    result, slowed = [], []
    for path in paths:
        bead, ratio = path.bead, (_axis_speeds(path) / cell.machine.max_speed).max(axis=1)
        radius = np.linalg.norm(np.diff(bead.points, axis=0), axis=1) / np.abs(np.diff(bead.parameter))
        tight = (ratio > 1.0) & (radius < layer_height)
        if tight.any():
            speed = bead.speed.copy()
            speed[1:][tight] *= (1.0 - 1e-9) / ratio[tight]
            path = dataclasses.replace(path, bead=dataclasses.replace(bead, speed=speed))
            slowed.append(path)
        result.append(path)
    if not slowed:
        return result, []
    slowest = min(float(path.bead.speed.min()) for path in slowed)
    return result, [Issue(
        WARNING, "SLOWED",
        f"{len(slowed)} bead(s) where the wall closes are run at down to {slowest:.3g} mm/s: the axes turn no faster",
        slowed[0].layer, slowed[0].index,
    )]


def _axis_speeds(path: BeadPath) -> Array:
    """(n - 1, axes) rad/s at which the axes turn along a bead."""
    length = np.linalg.norm(np.diff(path.bead.points, axis=0), axis=1)
    speed: Array = np.abs(np.diff(path.joints, axis=0)) * (path.bead.speed[1:] / length)[:, None]
    return speed


def too_fast(cell: Cell, paths: Sequence[BeadPath]) -> list[Issue]:
    """An issue for every bead on which an axis would have to turn faster than it can."""
    found = []
    for path in paths:
        speed = _axis_speeds(path)
        ratio = speed / cell.machine.max_speed
        point, axis = np.unravel_index(int(ratio.argmax()), ratio.shape)
        if ratio[point, axis] > 1.0:
            value, unit = cell.machine.unit_values[axis], cell.machine.units[axis]
            found.append(Issue(
                ERROR, "SPEED",
                f"axis {cell.machine.axes[axis]} would move at {speed[point, axis] / value:.0f} {unit}/s, it can do "
                f"{cell.machine.max_speed[axis] / value:.0f}; lower the travel speed to "
                f"{path.bead.speed[point + 1] / ratio[point, axis]:.2f} mm/s",
                path.layer, path.index, int(point) + 1,
            ))
    return found
