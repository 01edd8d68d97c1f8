# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program in the tree; a double click opens its text."""

from __future__ import annotations

from typing import Any

from .view_base import StageView

_SHOWN = ("Key", "ResultLayout", "ResultData", "Status", "Message")  # undo brings them back in any order


class ProgramView(StageView):
    """Nothing to draw. A double click reads the text; the context menu has the parameters and the export."""

    icon = "program"

    def edit(self, obj: Any) -> None:
        from .program_window import show

        show(obj)

    def refresh(self) -> None:
        """Nothing is drawn, and so nothing read."""

    def updateData(self, obj: Any, name: str) -> None:
        """A property of the object has changed."""
        super().updateData(obj, name)
        if name in _SHOWN and not obj.Document.Restoring:
            from .program_window import renew

            renew(obj)

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Entries of the context menu in the tree."""
        super().setupContextMenu(vobj, menu)
        from .path import dock

        if vobj.Object.JointPath is not None:
            dock.add_action(menu, vobj.Object.JointPath)
