# SPDX-License-Identifier: LGPL-2.1-or-later
"""The group of a job's stages in the tree. It computes nothing: stages may be dragged out and in
again.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD as App

from .stage import stage_of
from .work import hooks

TYPE = "App::DocumentObjectGroupPython"
_PASTE = "Paste"  # what FreeCAD calls this step of undo, in every language


class JobGroup:
    """Proxy of a group of stages. Its class path is a file format."""

    _held: tuple[Any, ...] = ()  # members of the group before a change

    def __init__(self, obj: Any) -> None:
        obj.Proxy = self
        hooks.attach(obj)

    def onBeforeChange(self, obj: Any, name: str) -> None:
        """Remember the members of the group."""
        if name == "Group":
            self._held = tuple(obj.Group)

    def onChanged(self, obj: Any, name: str) -> None:
        """FreeCAD pastes into the selected group: move a pasted copy of the job, or of its part,
        out next to the job. Members added in another way, as by a macro, stay.
        """
        document, members = obj.Document, self._held
        if name != "Group" or document.Transacting or document.Restoring or document.Importing:
            return
        if (App.getActiveTransaction() or ("",))[0] == _PASTE:
            remaining = [
                member for member in obj.Group if member in members or stage_of(member) is not None
            ]
            if len(remaining) < len(obj.Group):
                obj.Group = remaining

    def onDocumentRestored(self, obj: Any) -> None:
        """Show one that was made without a window."""
        hooks.attach(obj)

    def dumps(self) -> None:
        """Nothing: all is in properties."""

    def loads(self, state: Any) -> None:
        """Nothing to restore."""

    # FreeCAD up to 0.21.1 calls this pair, later ones the other
    __getstate__ = dumps
    __setstate__ = loads


def grouped(doc: Any, label: str, stages: Sequence[Any]) -> Any:
    """A new group of stages."""
    group = doc.addObject(TYPE, "Job")
    JobGroup(group)
    group.Label = label
    group.addObjects(list(stages))
    group.purgeTouched()
    return group


def is_group(obj: Any) -> bool:
    """Whether an object is the group of a job."""
    return isinstance(getattr(obj, "Proxy", None), JobGroup)


def stages_in(group: Any) -> list[Any]:
    """The stages that are in a group now, in the order of the tree."""
    return [obj for obj in group.Group if stage_of(obj) is not None]
