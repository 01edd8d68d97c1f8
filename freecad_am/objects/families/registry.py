# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planner of each family, imported when a feature is made or planned, and a family for a part.

`core.families.registry` lists the families. Each planner module is named after the family kind.
"""

from __future__ import annotations

import functools
import importlib

from ...core.families.family import Family
from ...core.families.registry import FAMILIES, family_of
from ...core.parameters.strategy import LayerParameters
from ..stage import Stage
from .planner import FeaturePlanner
from .recognition import Proposal, SelectedPart


@functools.cache
def planner_of(family: Family) -> FeaturePlanner:
    """Return the planner of a family."""
    module = importlib.import_module(f"{__package__}.{family.kind}")
    name = f"{type(family).__name__}Planner"
    planner: FeaturePlanner = getattr(module, name)()
    return planner


def planner_for(strategy: LayerParameters) -> FeaturePlanner:
    """Return the planner of a feature with this strategy."""
    return planner_of(family_of(strategy))


def stage_family(stage: Stage) -> Family | None:
    """Return the family of a feature; None for other stages."""
    sections = {section.cls for section in stage.sections}
    return next((family for family in FAMILIES if family.parameters in sections), None)


def propose_family(part: SelectedPart) -> Proposal:
    """Return the proposal of the family with the lowest rank that recognises a part.

    Used for `strategy.kind: auto` of a job and by New Job.
    The solid family recognises every part. Remarks of families that refuse the part become part of
    the reason. Raises InputError FAULTY, NO_FACES.
    """
    remark = ""
    for planner in ranked_planners():
        answer = planner.recognise(part, remark)
        if isinstance(answer, Proposal):
            return answer
        remark = answer.remark or remark
    raise AssertionError("no family recognises the part")


def ranked_planners() -> list[FeaturePlanner]:
    """Return the planners of the families that can be proposed, by rank."""
    ranked = [
        (planner.recognition_rank, planner)
        for planner in map(planner_of, FAMILIES)
        if planner.recognition_rank is not None
    ]
    return [planner for _, planner in sorted(ranked, key=lambda entry: entry[0])]
