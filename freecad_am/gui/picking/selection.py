# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a tool is meant for: the objects that are selected, and the stages of the jobs that these stand for."""

from __future__ import annotations

from typing import Any

import FreeCADGui as Gui

from ...objects.job_group import is_group, stages_in
from ...objects.stage import stage_of

# Of a job tools take a joint path where they can
_ORDER = ("joint path", "cell", "feature", "toolpath", "program")


def meant(document: str = "") -> list[Any]:
    """The selected objects of a document, by its name, or of the active one, and behind them the other stages of their
    jobs: joint paths, then the others in the order in which they are made."""
    chosen = selected(document)
    found = [obj for obj in chosen if not is_group(obj)]
    for obj in chosen:
        found += [stage for stage in _job(obj) if stage not in found]
    return found


def selected(document: str = "") -> list[Any]:
    """The selected objects of a document, by its name, or of the active one."""
    return list(Gui.Selection.getSelection(document) if document else Gui.Selection.getSelection())


def job_named() -> str:
    """The label of the job that the selection names, or of the stage where that is in none; '' where it names none."""
    for obj in selected():
        if _job(obj) or is_group(obj):
            return str((obj if is_group(obj) else _group_of(obj) or obj).Label)
    return ""


def _job(obj: Any) -> list[Any]:
    """The stages of a job, or of that of a stage: those in its group, first the ones that are linked with the stage, then
    what they are made from elsewhere. Without a group those that are linked with the stage, the latest first."""
    if is_group(obj):
        linked, group = [], obj
    elif stage_of(obj) is not None:
        linked, group = _line(obj), _group_of(obj)
    else:
        return []
    if group is None:
        return sorted(linked, key=lambda stage: (_rank(stage), -stage.ID))
    held = sorted(
        stages_in(group), key=lambda stage: (_rank(stage), bool(linked) and stage not in linked)
    )
    return [*held, *(one for stage in held for one in _leading_to(stage) if one not in held)]


def _group_of(stage: Any) -> Any:
    return next((obj for obj in stage.InList if is_group(obj)), None)


def _line(stage: Any) -> list[Any]:
    """What a stage is made from, what is made from it, and what else that is made from. Of an inspection that of what it
    measures."""
    planned = getattr(stage, "Planned", None)
    origin = stage if planned is None or stage_of(planned) is None else planned
    lines = [_leading_to(obj) for obj in stage.Document.Objects if stage_of(obj) is not None]
    return list(dict.fromkeys(one for line in lines if origin in line for one in line))


def _leading_to(stage: Any) -> list[Any]:
    """A stage and those that it is made from. Expressions count for nothing: jobs may share figures."""
    found = [stage]
    for obj in found:
        inputs = [getattr(obj, link.name) for link in obj.Proxy.links]
        every = [one for some in inputs for one in (some if isinstance(some, list) else [some])]
        found += [one for one in every if stage_of(one) is not None and one not in found]
    return found


def _rank(stage: Any) -> int:
    kind = stage.Proxy.kind
    return _ORDER.index(kind) if kind in _ORDER else len(_ORDER)
