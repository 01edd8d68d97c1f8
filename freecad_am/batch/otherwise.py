# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job whose stages end with an error, planned otherwise: what it leaves open chosen anew, or to tell what would help."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

from freecad_am.core.issues import ERROR, NOTE, Issue, Text, has_errors

from .job.features import UPRIGHT, JobFeature, leans
from .job.job import Job

Plan = Callable[
    [Job, str], Any
]  # the stages of a job, given the code of the error that what was chosen ends with


def planned(job: Job, plan: Plan, close: Callable[[Any], None]) -> Any:
    """The stages of a job. Where curved layers that were chosen for it end with an error, with planes; where walls do that
    were, with fixed build directions, if these are carried out. close: what becomes of stages that are not wanted."""
    stages = plan(job, "")
    if not has_errors(stages.issues):
        return stages
    if fails := _in_vain(stages, _curved(job, stages)):
        close(stages)
        return plan(job, fails)
    if fails := _in_vain(stages, _leaning(job, stages)):
        other = plan(job, fails)
        better = not has_errors(other.issues)
        close(stages if better else other)
        return other if better else stages
    return _with_remedy(job, stages, plan, close)


def _in_vain(stages: Any, chosen: bool) -> str:
    """The code of the first error where something was chosen; else ''."""
    return next((issue.code for issue in stages.issues if chosen and issue.level == ERROR), "")


def _curved(job: Job, stages: Any) -> bool:
    """Whether curved layers were chosen for a feature that leaves layers open."""
    from freecad_am.core.parameters.filled import GEODESIC

    chosen = zip(job.features, stages.job.features, strict=True)
    return any(
        asked.sections is not None
        and "layers" not in asked.sections["strategy"]
        and getattr(one.strategy, "layers", "") == GEODESIC
        for asked, one in chosen
    )


def _leaning(job: Job, stages: Any) -> bool:
    """Whether a wall was chosen for a feature that leaves its directions open, and one was not yet tried in vain."""
    from freecad_am.core.planning.remedies import NO_REMEDY

    if stages.joint_path is None and any(issue.code == NO_REMEDY for issue in stages.issues):
        return False
    chosen = zip(job.features, stages.job.features, strict=True)
    return any(asked.sections is not None and leans(asked, one.strategy) for asked, one in chosen)


def _with(feature: JobFeature, alone: bool) -> JobFeature:
    """A feature with what is tried to clear its nozzle: a wall with one direction, curved layers, alone, as plane ones."""
    from freecad_am.core.parameters.filled import GEODESIC, OFFSET, PLANES

    if leans(feature, feature.strategy):
        return dataclasses.replace(
            feature, build_direction=dataclasses.replace(feature.build_direction, mode=UPRIGHT)
        )
    if alone and getattr(feature.strategy, "layers", "") in (GEODESIC, OFFSET):
        return dataclasses.replace(
            feature, strategy=dataclasses.replace(feature.strategy, layers=PLANES)
        )
    return feature


def _with_remedy(job: Job, stages: Any, plan: Plan, close: Callable[[Any], None]) -> Any:
    """The stages with a note on whether the whole job is feasible with what would clear the nozzle, if its toolpath told
    something that does; the stages as they are, if not."""
    from freecad_am.core.planning.remedies import NO_REMEDY, REMEDY

    text = next((issue for issue in stages.issues if issue.code == REMEDY), None)
    if text is None or stages.joint_path is not None or job.cell is None:
        return stages
    features = tuple(_with(one, len(stages.job.features) == 1) for one in stages.job.features)
    what = text.message.values[0]
    other = plan(dataclasses.replace(job, features=features), "")
    feasible = not has_errors(other.issues)
    close(other)
    note = (
        Issue(NOTE, REMEDY, Text("with {} this job is feasible; tried, not applied", what))
        if feasible
        else Issue(
            NOTE,
            NO_REMEDY,
            Text("with {} the nozzle is clear, but the job is not feasible, which was tried", what),
        )
    )
    stages.issues = [note if issue is text else issue for issue in stages.issues]
    return stages
