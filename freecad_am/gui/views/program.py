# SPDX-License-Identifier: LGPL-2.1-or-later
"""A program in the tree; a double click opens its text."""

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
)  # undo restores the properties in any order


class ProgramView(StageView):
    """Draws nothing. A double click opens the text; the context menu has the parameters and the
    export.
    """

    icon = "program"

    def edit(self, obj: Any) -> None:
        from ..program_window import show

        show(obj)

    def attach(self, vobj: Any) -> None:
        """Called when the view provider is set, and when a document opens."""
        super().attach(vobj)
        QtCore.QTimer.singleShot(0, self._fit_post)  # after all properties exist

    def _fit_post(self) -> None:
        """Show in the property editor the parameters that the post reads, and other non-default
        parameters.
        """
        with contextlib.suppress(ReferenceError, RuntimeError, AttributeError):  # deleted
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
        """Do nothing, because nothing is drawn."""

    def updateData(self, obj: Any, name: str) -> None:
        """Handle a changed property of the object."""
        super().updateData(obj, name)
        if name == "Post" and not obj.Document.Restoring:
            self._fit_post()
        if name in _SHOWN and not obj.Document.Restoring:
            from ..program_window import renew

            renew(obj)
