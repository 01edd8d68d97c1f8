# SPDX-License-Identifier: LGPL-2.1-or-later
"""Keys of a job file that have no effect beside its other keys."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ...core.issues import NOTE, WARNING, Issue, Text
from ...core.kinematics.arrangement import arrangement_of
from ...core.parameters.external import NONE
from .job import Job

NO_EFFECT = "NO_EFFECT"


def unused_key_issues(job: Job) -> list[Issue]:
    """Name the keys that the job file gives and that change nothing."""
    if job.cell is None:
        return list(_issues_without_cell(job))
    return list(_issues_of_cell(job))


def _issues_without_cell(job: Job) -> Iterator[Issue]:
    if job.program is not None:
        message = Text(
            "program: the job has no cell, so no program is written; add the section `cell`, or "
            "remove `program`"
        )
        yield Issue(WARNING, NO_EFFECT, message)
    if job.tree.values.get("joints"):
        message = Text(
            "joints: the job has no cell, so no joint path is planned; add the section `cell`, "
            "or remove `joints`"
        )
        yield Issue(NOTE, NO_EFFECT, message)


def _issues_of_cell(job: Job) -> Iterator[Issue]:
    assert job.cell is not None
    arrangement = arrangement_of(job.cell.setup)
    joints, cell = (job.tree.values.get(section) for section in ("joints", "cell"))
    if _gives(joints, "rz") and "constant" not in (job.joints.method, *job.joints.compare):
        message = Text(
            "joints.rz has no effect with joints.method: {}; remove it, or use the method constant",
            job.joints.method,
        )
        yield Issue(WARNING, NO_EFFECT, message)
    fixed_part = not arrangement.carries_part and job.cell.external == NONE
    if fixed_part and _gives(cell, "platform"):
        message = Text(
            "cell.platform has no effect with cell.setup: {}: cell.deposition_point is the pose "
            "of the platform; remove it",
            job.cell.setup,
        )
        yield Issue(WARNING, NO_EFFECT, message)
    nozzle = cell.get("nozzle") if isinstance(cell, dict) else None
    if arrangement.holds_part and _gives(nozzle, "tool"):
        message = Text(
            "cell.nozzle.tool has no effect with cell.setup: {}: cell.deposition_point is the "
            "pose of the nozzle; remove it",
            job.cell.setup,
        )
        yield Issue(WARNING, NO_EFFECT, message)


def _gives(section: Any, key: str) -> bool:
    """Whether a section of the file has a value for a key."""
    return isinstance(section, dict) and section.get(key) is not None
