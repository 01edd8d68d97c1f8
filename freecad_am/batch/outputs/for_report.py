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
    from freecad_am.report.asked import Results

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


def job(of: Job, stages: Any) -> Any:
    """The job as its report tells of it."""
    from freecad_am.report import asked

    features = tuple(
        asked.Feature(
            one.name,
            one.strategy,
            one.build_direction,
            one.process,
            functools.partial(_result, feature),
        )
        for one, feature in zip(of.features, stages.features, strict=True)
    )
    return asked.Job(of.name, features, of.process, of.joints, of.cell)


def _result(obj: Any) -> Any:
    from freecad_am import api

    return api.result(obj)
