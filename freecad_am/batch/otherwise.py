# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan a job again if its stages end with an error: with other choices for its open settings, or to
find a remedy.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

from freecad_am.core.issues import ERROR, NOTE, Issue, Text, has_errors

from .job.features import UPRIGHT, JobFeature, leans
from .job.job import Job

Plan = Callable[
    [Job, str], Any
]  # the stages of a job, given the error code of the automatic choice


def planned(job: Job, plan: Plan, close: Callable[[Any], None]) -> Any:
    """The stages of a job. If automatically chosen curved layers end with an error, with planes; if
    chosen walls do, with fixed build directions, provided that these succeed. close: disposes of
    unused stages.
    """
    stages = plan(job, "")
    if not has_errors(stages.issues):
        return stages
    if fails := _in_vain(stages, _curved(job, stages)):
        close(stages)
        return plan(job, fails)
    if fails := _in_vain(stages, _leaning(job, stages)):
        alternative = plan(job, fails)
        better = not has_errors(alternative.issues)
        close(stages if better else alternative)
        return alternative if better else stages
    return _check_remedy(job, stages, plan, close)


def _in_vain(stages: Any, is_chosen: bool) -> str:
    """The code of the first error if something was chosen automatically; else ''."""
    return next((issue.code for issue in stages.issues if is_chosen and issue.level == ERROR), "")


def _curved(job: Job, stages: Any) -> bool:
    """Whether curved layers were chosen for a feature that leaves layers open."""
    from freecad_am.core.parameters.filled import GEODESIC

    feature_pairs = zip(job.features, stages.job.features, strict=True)
    return any(
        job_feature.sections is not None
        and "layers" not in job_feature.sections["strategy"]
        and getattr(chosen_feature.strategy, "layers", "") == GEODESIC
        for job_feature, chosen_feature in feature_pairs
    )


def _leaning(job: Job, stages: Any) -> bool:
    """Whether a wall was chosen for a feature that leaves its directions open, and one was not yet tried in vain."""
    from freecad_am.core.planning.remedies import NO_REMEDY

    if stages.joint_path is None and any(issue.code == NO_REMEDY for issue in stages.issues):
        return False
    feature_pairs = zip(job.features, stages.job.features, strict=True)
    return any(
        job_feature.sections is not None and leans(job_feature, chosen_feature.strategy)
        for job_feature, chosen_feature in feature_pairs
    )


def _with(feature: JobFeature, alone: bool) -> JobFeature:
    """A feature changed to clear its nozzle: a wall gets one direction, curved layers (of a single
    feature) become plane ones.
    """
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


def _check_remedy(job: Job, stages: Any, plan: Plan, close: Callable[[Any], None]) -> Any:
    """The stages with a note on whether the whole job is feasible with the remedy that its toolpath
    reported for the nozzle; unchanged without such a remedy.
    """
    from freecad_am.core.planning.remedies import NO_REMEDY, REMEDY

    text = next((issue for issue in stages.issues if issue.code == REMEDY), None)
    if text is None or stages.joint_path is not None or job.cell is None:
        return stages
    features = tuple(
        _with(feature, len(stages.job.features) == 1) for feature in stages.job.features
    )
    what = text.message.values[0]
    alternative = plan(dataclasses.replace(job, features=features), "")
    feasible = not has_errors(alternative.issues)
    close(alternative)
    note = (
        Issue(NOTE, REMEDY, Text("the job is feasible with {}; tested, not applied", what))
        if feasible
        else Issue(
            NOTE,
            NO_REMEDY,
            Text("with {} the nozzle is clear, but the job is still infeasible (tested)", what),
        )
    )
    stages.issues = [note if issue is text else issue for issue in stages.issues]
    return stages
