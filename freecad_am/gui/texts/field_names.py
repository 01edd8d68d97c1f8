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
# the panel that has the fields of a section, as its stage or tool is called
_PANELS = {
    "cell": "Cell",
    "strategy": "Feature",
    "build_direction": "Feature",
    "process": "Toolpath",
    "joints": "Joint path",
    "program": "Program",
    "inspection": "Inspection",
}
_LINE = r"((?:[a-z_]+\.)*[a-z_]+): ([A-Za-z0-9+_-]+)"  # of a job file
_QUOTED, _BARE = re.compile(f"`{_LINE}`"), re.compile(rf"(?<![\w./\\`-]){_LINE}(?!`)")
_KEY = re.compile(
    rf"(?<![\w./\\-])(?:{'|'.join(sorted({section for section, _ in _SECTIONS}))})(?:\.[a-z_]+)+(?![\w/\\-])"
)


@lru_cache(maxsize=1)
def _known() -> dict[str, tuple[str, str]]:
    """The group within its panel, '' for none, and the label of each parameter, by its name in job files; of each group
    too, and of each range, which has two fields."""
    found: dict[str, tuple[str, str]] = {}
    for section, cls in _SECTIONS:
        for row in rows(cls):
            steps = [step for step in row.path if isinstance(step, str)]
            if len(steps) < len(row.path):
                found.setdefault(".".join([section, *steps]), ("", group_of(row)))
            else:
                nested = len(steps) > 1
                found.setdefault(
                    ".".join([section, *steps]), (group_of(row) if nested else "", row.label)
                )
                if nested:
                    found.setdefault(f"{section}.{steps[0]}", ("", group_of(row)))
    return found


@lru_cache(maxsize=1)
def _choices() -> dict[str, set[str]]:
    """What each parameter that has choices may be, in any family, by its name in job files."""
    found: dict[str, set[str]] = {}
    for section, cls in _SECTIONS:
        for row in rows(cls):
            name = ".".join([section, *(step for step in row.path if isinstance(step, str))])
            found.setdefault(name, set()).update(row.spec.choices, row.spec.words)
    return found


@lru_cache(maxsize=1)
def _short_names() -> dict[str, str]:
    """The whole name of each parameter whose last part no other section has, by that part."""
    found: dict[str, list[str]] = {}
    for name in _known():
        found.setdefault(name.rpartition(".")[2], []).append(name)
    return {
        short: names[0]
        for short, names in found.items()
        if len({name.partition(".")[0] for name in names}) == 1 and names[0].count(".") == 1
    }


def as_in_panels(
    text: str, translate: Callable[[str], str], quoted: str = "“{}”", with_panel: bool = False
) -> str:
    """A message with the names that parameters have in panels, translated: “Bead width” for process.bead_width, “Motion:
    joint” for motion: joint, with or without backticks. with_panel: tell whose panel has it, “Bead width” (Toolpath)."""

    def shown(name: str, value: str = "") -> str:
        group, label = _known()[name]
        own = translate(label)
        field = f"{translate(group)}, {own.lower()}" if group else own
        panel = f" ({translate(_PANELS[name.partition('.')[0]])})" if with_panel else ""
        return quoted.format(f"{field}: {translate(value)}" if value else field) + panel

    def named(match: re.Match[str]) -> str:
        return shown(match[0]) if _known().get(match[0], ("", ""))[1] else match[0]

    def paired(match: re.Match[str]) -> str:
        name = match[1] if match[1] in _known() else _short_names().get(match[1])
        return match[0] if name is None else shown(name, match[2])

    def paired_bare(match: re.Match[str]) -> str:
        name = match[1] if match[1] in _known() else _short_names().get(match[1], "")
        return paired(match) if match[2] in _choices().get(name, ()) else match[0]

    return _KEY.sub(named, _BARE.sub(paired_bare, _QUOTED.sub(paired, text)))
