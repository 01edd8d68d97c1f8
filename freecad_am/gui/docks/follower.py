# SPDX-License-Identifier: LGPL-2.1-or-later
"""What docks that look at one object at a time share: they look at another when that goes."""

from __future__ import annotations

from typing import Any

from PySide import QtCore


class Follower:
    """An observer of documents; `fill` shows the target, or what there is where that is gone."""

    target: tuple[str, str] | None = None  # names of document and object

    def fill(self) -> None:
        """Show what there is now."""
        raise NotImplementedError

    def slotDeletedObject(self, obj: Any) -> None:
        """An object is about to go; once it is gone, another is looked at."""
        QtCore.QTimer.singleShot(0, self.fill)

    def slotDeletedDocument(self, document: Any) -> None:
        """A document is closed."""
        QtCore.QTimer.singleShot(0, self.fill)

    def slotActivateDocument(self, document: Any) -> None:
        """Another document is looked at."""
        if self.target is not None and self.target[0] != document.Name:
            self.target = None
        QtCore.QTimer.singleShot(0, self.fill)
