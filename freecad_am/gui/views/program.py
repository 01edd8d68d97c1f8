# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program in the tree; a double click opens its text."""

from __future__ import annotations

from typing import Any

from .base import StageView

_SHOWN = (
    "Key",
    "ResultLayout",
    "ResultData",
    "Status",
    "Message",
)  # undo brings them back in any order


class ProgramView(StageView):
    """Nothing to draw. A double click reads the text; the context menu has the parameters and the export."""

    icon = "program"

    def edit(self, obj: Any) -> None:
        from ..program.window import show

        show(obj)

    def refresh(self) -> None:
        """Nothing is drawn, and so nothing read."""

    def updateData(self, obj: Any, name: str) -> None:
        """A property of the object has changed."""
        super().updateData(obj, name)
        if name in _SHOWN and not obj.Document.Restoring:
            from ..program.window import renew

            renew(obj)
