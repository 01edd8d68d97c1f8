# SPDX-License-Identifier: LGPL-2.1-or-later
"""Propose family and layer kind for a part, with the reason.

Used for `strategy.kind: auto` of a job and by New Job.
"""

from __future__ import annotations

from ...core.families.registry import FAMILIES
from ..families.planner import FeaturePlanner
from ..families.recognition import Proposal, SelectedPart
from ..families.registry import planner_of


def propose_family(part: SelectedPart) -> Proposal:
    """Return the proposal of the family with the lowest rank that recognises a part.

    The solid family recognises every part. Remarks of families that refuse the part become part of
    the reason. Raises InputError FAULTY, NO_FACES.
    """
    remark = ""
    for planner in planners():
        answer = planner.recognise(part, remark)
        if isinstance(answer, Proposal):
            return answer
        remark = answer.remark or remark
    raise AssertionError("no family recognises the part")


def planners() -> list[FeaturePlanner]:
    """Return the planners of the families that can be proposed, by rank."""
    ranked = [
        (planner.recognition_rank, planner)
        for planner in map(planner_of, FAMILIES)
        if planner.recognition_rank is not None
    ]
    return [planner for _, planner in sorted(ranked, key=lambda entry: entry[0])]
