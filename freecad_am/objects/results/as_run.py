# SPDX-License-Identifier: LGPL-2.1-or-later
"""Executed motion of a joint path: complete, or the rows of a program."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from ...core.issues import Issue
from ...core.kinematics.cell import Cell
from ...core.motion import Motion
from ...core.parameters.program import ProgramParameters
from ...core.planning import program as programs
from ...core.planning.beads import steps
from ...core.simulation.achievable_feed import spread_to_deposit_rows
from ...core.types import Array, Integers
from ...posts import catalogue
from ..joint_path import Planned


@dataclass(frozen=True, eq=False)
class AsRun:
    """An executed motion of n rows.

    condition, threshold: inverse condition number and its minimum, (n,), NaN if unknown. issues:
    located at the points of this motion.
    """

    motion: Motion
    condition: Array
    threshold: Array
    issues: tuple[Issue, ...]


def as_run(
    planned: Planned,
    cell: Cell,
    chord_error: float,
    settings: ProgramParameters | None,
    issues: tuple[Issue, ...],
) -> AsRun:
    """Return the executed motion of a joint path, complete without `settings`.

    settings: program parameters. The motion of a program includes points added to linear moves,
    excludes points too close for the controller, and starts at the program start.
    """
    motion = planned.motion
    condition, threshold = (
        spread_to_deposit_rows(motion.deposit, column)
        for column in planned.joint_path.conditions(motion)
    )
    if settings is None:
        return AsRun(motion, condition, threshold, issues)
    controller = catalogue.controller(settings.post)
    straight = settings.motion == "cartesian" and not controller.straight_in_part
    if straight and cell.arrangement.holds_part:
        origin = steps.origins(motion, cell, chord_error)
        beads = [path.bead for path in planned.joint_path.beads]
        motion = steps.refined_to_chord_error(motion, cell, chord_error, beads)
        condition, threshold = condition[origin], threshold[origin]
        issues = tuple(_renumbered(issue, planned.motion, motion, origin) for issue in issues)
    full_motion = motion
    motion, kept_rows = steps.programmed(motion, controller, chord_error, settings.blend)
    if len(motion) < len(full_motion):
        condition, threshold = condition[kept_rows], threshold[kept_rows]
        issues = tuple(_renumbered(issue, full_motion, motion, kept_rows) for issue in issues)
    rows = programs.rows_from(motion, settings.start_at)
    motion = Motion(**{field.name: getattr(motion, field.name)[rows] for field in fields(motion)})
    return AsRun(motion, condition[rows], threshold[rows], issues)


def _renumbered(issue: Issue, old_motion: Motion, new_motion: Motion, origin: Integers) -> Issue:
    """Renumber an issue to its point in the new motion, or to the last remaining point before."""
    is_row = (
        old_motion.deposit
        & (old_motion.layer == issue.layer)
        & (old_motion.bead == issue.bead)
        & (old_motion.point == issue.point)
    )
    if issue.point is None or not is_row.any():
        return issue
    row = int(np.searchsorted(origin, int(np.argmax(is_row)), side="right")) - 1
    return replace(issue, point=int(new_motion.point[row]))
