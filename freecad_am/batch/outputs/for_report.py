# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job and what its stages came to, as the report asks for them."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any

from ..job.job import Job


def results(stages: Any, programs: Sequence[str]) -> Any:
    """What the stages came to, as far as they got, for the report."""
    from freecad_am import api
    from freecad_am.objects.checks import preflight

    from ...report.figures import Results

    path = stages.joint_path
    survey = functools.cache(preflight.survey_of(stages.toolpath, path, stages.job.program))
    return Results(
        api.result(stages.toolpath),
        None if path is None else api.result(path),
        0.0 if path is None else path.Seconds,
        stages.issues,
        programs,
        lambda: survey().distances,
        lambda: preflight.stage_preflight(stages.toolpath, path, stages.program, survey),
    )


def job(read_job: Job, stages: Any) -> Any:
    """The job in the form of its report."""
    from ...report import figures

    features = tuple(
        figures.Feature(
            feature_read.name,
            feature_read.strategy,
            feature_read.build_direction,
            feature_read.process,
            functools.partial(_result, feature),
        )
        for feature_read, feature in zip(read_job.features, stages.features, strict=True)
    )
    return figures.Job(read_job.name, features, read_job.process, read_job.joints, read_job.cell)


def _result(obj: Any) -> Any:
    from freecad_am import api

    return api.result(obj)
