# SPDX-License-Identifier: LGPL-2.1-or-later
"""Looks out for what a dock shows: its objects may be changed or deleted, their document closed, while it is open."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any, Protocol

import FreeCAD as App
from PySide import QtCore

from ..texts.translation import tr


class Shown(Protocol):
    """What a dock shows: the names of a document and of objects in it."""

    document: str
    objects: Collection[str]


class Lookout:
    """Calls `changed` with an object and the name of its property, and `ended` with why there is nothing to show any more
    and whether the document goes, until it is stopped. `goes` is called at once when an object goes, `ended` after it."""

    def __init__(
        self,
        shown: Callable[[], Shown],
        changed: Callable[[Any, str], None],
        ended: Callable[[str, bool], None],
        goes: Callable[[], None] = lambda: None,
    ) -> None:
        self.shown, self.changed, self.ended, self.goes = shown, changed, ended, goes
        App.addDocumentObserver(self)

    def stop(self) -> None:
        """Look out no more."""
        App.removeDocumentObserver(self)

    def _shows(self, obj: Any) -> bool:
        return obj.Name in self.shown().objects and obj.Document.Name == self.shown().document

    # ---- called by FreeCAD

    def slotDeletedDocument(self, document: Any) -> None:
        """A document is closed."""
        if document.Name == self.shown().document:
            self.ended(tr("the document was closed"), True)

    def slotDeletedObject(self, obj: Any) -> None:
        """An object is deleted."""
        if self._shows(obj):
            self.goes()
            text = tr("{label} was deleted").format(label=obj.Label)
            QtCore.QTimer.singleShot(0, lambda: self.ended(text, False))

    def slotChangedObject(self, obj: Any, name: str) -> None:
        """A property of an object has changed."""
        if self._shows(obj):
            self.changed(obj, name)
