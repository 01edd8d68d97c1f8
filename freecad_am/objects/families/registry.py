# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planner of each family, imported when a feature of the family is made or planned.

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
