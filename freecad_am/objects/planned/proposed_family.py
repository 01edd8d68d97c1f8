# SPDX-License-Identifier: LGPL-2.1-or-later
"""The family and layers that suit a part, and why: used for `strategy.kind: auto` of a job and
proposed by New Job.
"""

from __future__ import annotations

from ...core.families.registry import FAMILIES
from ..families.planner import FeaturePlanner
from ..families.recognition import Proposal, SelectedPart
from ..families.registry import planner_of


def propose_family(part: SelectedPart) -> Proposal:
    """The proposal of the family with the lowest rank that recognises a part; solids recognise every
    part. Remarks of the families that refuse it become part of the reason: if nothing serves the
    whole part, they name the omissions. Raises InputError FAULTY, NO_FACES.
    """
    remark = ""
    for planner in planners():
        answer = planner.recognise(part, remark)
        if isinstance(answer, Proposal):
            return answer
        remark = answer.remark or remark
    raise AssertionError("no family recognises the part")


def planners() -> list[FeaturePlanner]:
    """The planners of the families that can be proposed, in the order in which they are asked."""
    ranked = [
        (planner.recognition_rank, planner)
        for planner in map(planner_of, FAMILIES)
        if planner.recognition_rank is not None
    ]
    return [planner for _, planner in sorted(ranked, key=lambda entry: entry[0])]
