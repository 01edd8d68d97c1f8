# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tree group of a job's stages. The group computes nothing, so stages may be dragged out and in."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD as App

from .stage import stage_of
from .work import hooks

TYPE = "App::DocumentObjectGroupPython"
_PASTE = "Paste"  # FreeCAD's name of the undo step, not translated


class JobGroup:
    """Proxy of a stage group. The class path is a file format."""

    _held: tuple[Any, ...] = ()  # members of the group before a change

    def __init__(self, obj: Any) -> None:
        obj.Proxy = self
        hooks.attach(obj)

    def onBeforeChange(self, obj: Any, name: str) -> None:
        """Remember the members of the group."""
        if name == "Group":
            self._held = tuple(obj.Group)

    def onChanged(self, obj: Any, name: str) -> None:
        """Move a pasted copy of the job, or of its part, out of the group.

        FreeCAD pastes into the selected group. Members added in other ways, such as by a macro,
        stay.
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
        """Attach the view to a group that was made without a window."""
        hooks.attach(obj)

    def dumps(self) -> None:
        """Save nothing: all data is in properties."""

    def loads(self, state: Any) -> None:
        """Restore nothing: all data is in properties."""

    # FreeCAD up to 0.21.1 calls __getstate__ and __setstate__, later versions dumps and loads
    __getstate__ = dumps
    __setstate__ = loads


def grouped(doc: Any, label: str, stages: Sequence[Any]) -> Any:
    """Make a group of stages."""
    group = doc.addObject(TYPE, "Job")
    JobGroup(group)
    group.Label = label
    group.addObjects(list(stages))
    group.purgeTouched()
    return group


def is_group(obj: Any) -> bool:
    """Whether an object is a job group."""
    return isinstance(getattr(obj, "Proxy", None), JobGroup)


def stages_in(group: Any) -> list[Any]:
    """Return the stages in a group, in tree order."""
    return [obj for obj in group.Group if stage_of(obj) is not None]
