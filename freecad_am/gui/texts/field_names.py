# SPDX-License-Identifier: LGPL-2.1-or-later
"""Messages of the core name parameters as job files do, 'process.bead_width'; the window calls them as its panels do."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache

from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.cell import CellParameters
from ...core.parameters.inspection import InspectionParameters
from ...core.parameters.joints import JointParameters
from ...core.parameters.process import ProcessParameters
from ...core.parameters.program import ProgramParameters
from ...core.strategies.families import FAMILIES
from ...objects.fields.rows import group_of, rows

_SECTIONS = (
    ("cell", CellParameters),
    *(("strategy", family.parameters) for family in FAMILIES),
    ("build_direction", BuildDirectionParameters),
    ("process", ProcessParameters),
    ("joints", JointParameters),
    ("program", ProgramParameters),
    ("inspection", InspectionParameters),
)
_KEY = re.compile(
    rf"(?<![\w./\\-])(?:{'|'.join(sorted({section for section, _ in _SECTIONS}))})(?:\.[a-z_]+)+(?![\w/\\-])"
)


@lru_cache(maxsize=1)
def _known() -> dict[str, tuple[str, str]]:
    """The group within its panel, '' for none, and the label of each parameter, by its name in job files; of each group
    too. Ranges, which have two fields, are not among them."""
    found: dict[str, tuple[str, str]] = {}
    for section, cls in _SECTIONS:
        for row in rows(cls):
            steps = [step for step in row.path if isinstance(step, str)]
            if len(steps) == len(row.path):
                nested = len(steps) > 1
                found.setdefault(
                    ".".join([section, *steps]), (group_of(row) if nested else "", row.label)
                )
                if nested:
                    found.setdefault(f"{section}.{steps[0]}", ("", group_of(row)))
    return found


def as_in_panels(text: str, translate: Callable[[str], str], quoted: str = "“{}”") -> str:
    """A message with the names that parameters have in panels, translated: “Bead width” for process.bead_width."""

    def named(match: re.Match[str]) -> str:
        group, label = _known().get(match[0], ("", ""))
        if not label:
            return match[0]
        own = translate(label)
        return quoted.format(f"{translate(group)}, {own.lower()}" if group else own)

    return _KEY.sub(named, text)
