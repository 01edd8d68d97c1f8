# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rule `optimised` of external axes beside the rule `level`: it begins where that ends, and what is not better stays."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...issues import ERROR, NOTE, InputError, Issue, Text, has_errors
from ...kinematics.cell import Cell
from ...parameters.joints import LEVEL, JointParameters
from ..joint_path import BeadPath
from ..task import Task, condition_margin
from .courses import directions_on_face
from .level import allowed_by_layer, axes_figures

Found = tuple[list[BeadPath], list[Issue]]
METHOD = "layer-by-layer"


def asked(parameters: JointParameters, cell: Cell) -> tuple[bool, list[Issue]]:
    """Whether external axes are to be optimised, and a note where there are none. Raises InputError NOT_FOR_SETUP for
    methods without polynomials per bead."""
    if parameters.external_axes == LEVEL:
        return False, []
    if cell.external is None:
        return False, [
            Issue(
                NOTE,
                "NOT_USED",
                Text(
                    "joints.external_axes: {} has no effect without cell.external; remove it",
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
            LEVEL,
        )
    return True, []


def choose_better(
    task: Task,
    level: Found,
    planned: Sequence[BeadPath],
    finish: Callable[[list[BeadPath]], Found],
    report: Callable[[float], None],
) -> tuple[Found, dict[str, object]]:
    """What is planned with all external axes optimised, and the figures of `level`, which stays where it is no worse.

    level: what was found with it; planned: its beads before points were added and turns counted on, which `finish` does.
    """
    from .optimised import optimised  # few jobs have external axes

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
    """Places of beads that have errors, or less margin than any of `level`, once turns are counted."""
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
    """What paths are compared by: objective, least margin to a limit or the condition asked for, as shares, least condition,
    and how far external axes go."""
    complete = all(path.reachable for path in paths)
    return {
        "objective_value": float(sum(path.objective for path in paths)) if complete else None,
        "least_margin": least_margin(task, paths) if complete else None,
        "condition_min": float(min(path.condition.min() for path in paths)),
        **axes_figures(task.cell, paths),
    }


def least_margin(task: Task, paths: Sequence[BeadPath]) -> float:
    """The least share of any axis that is left to its limit, the reserve beside it taken off (1: in the middle), or of the
    condition to the one asked for."""
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
