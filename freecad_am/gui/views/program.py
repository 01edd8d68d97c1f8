# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program in the tree; a double click opens its text."""

from __future__ import annotations

import contextlib
from typing import Any

from PySide import QtCore

from ...core.parameters.program import ProgramParameters
from ...objects.fields.rows import rows
from ...posts import catalogue
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
        from ..program_window import show

        show(obj)

    def attach(self, vobj: Any) -> None:
        """Called when the view provider is set, and when a document opens."""
        super().attach(vobj)
        QtCore.QTimer.singleShot(0, self._fit_post)  # once all properties are there

    def _fit_post(self) -> None:
        """Show in the property editor what the post reads, and what differs from its default."""
        with contextlib.suppress(ReferenceError, RuntimeError, AttributeError):  # it is gone
            post = str(self.obj.Post)
            for row in rows(ProgramParameters):
                if row.path[0] != "nc" or row.name not in self.obj.PropertiesList:
                    continue
                same = getattr(self.obj, row.name) in (row.outer(row.default), row.default, "")
                hidden = same and not catalogue.reads_nc(post, str(row.path[1]))
                modes = ["Hidden"] if hidden else []
                if list(self.obj.getEditorMode(row.name)) != modes:
                    self.obj.setEditorMode(row.name, modes)

    def refresh(self) -> None:
        """Nothing is drawn, and so nothing read."""

    def updateData(self, obj: Any, name: str) -> None:
        """A property of the object has changed."""
        super().updateData(obj, name)
        if name == "Post" and not obj.Document.Restoring:
            self._fit_post()
        if name in _SHOWN and not obj.Document.Restoring:
            from ..program_window import renew

            renew(obj)
