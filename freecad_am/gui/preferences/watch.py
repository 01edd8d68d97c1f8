# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tells whoever shows something when a preference of what is shown has changed, wherever it was changed, or the language of
the window."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ...objects.fields.preferences import GROUP, SCHEME, SHOWN, UNIT_SETTINGS

_listeners: list[Callable[[], None]] = []
_readers: list[Callable[[], None]] = []  # who shows texts


class _Watch:
    """Attached to the group of our preferences and that of FreeCAD's units; several changes at once are told once."""

    def __init__(self) -> None:
        self.groups = [App.ParamGet(GROUP), App.ParamGet(UNIT_SETTINGS)]
        self.asked = False
        for group in self.groups:
            group.Attach(self)

    def onChange(self, group: Any, name: str) -> None:
        """Called by FreeCAD when an entry has changed or gone."""
        if name in (*SHOWN, SCHEME) and not self.asked:
            self.asked = True
            QtCore.QTimer.singleShot(0, self._tell)

    def _tell(self) -> None:
        self.asked = False
        _tell(_listeners)


class _Ear(QtGui.QWidget):
    """Never to be seen: Qt tells all widgets of the window of another language, once for each file of translations."""

    def __init__(self) -> None:
        super().__init__(Gui.getMainWindow())
        self.hide()
        self.asked = False

    def changeEvent(self, event: Any) -> None:
        """Called by Qt."""
        super().changeEvent(event)
        if event.type() == QtCore.QEvent.LanguageChange and not self.asked:
            self.asked = True
            QtCore.QTimer.singleShot(0, self._tell)  # once all files are read

    def _tell(self) -> None:
        self.asked = False
        _tell(_readers)


def _tell(listeners: list[Callable[[], None]]) -> None:
    for listener in tuple(listeners):  # one may end what it shows, and with it another
        with contextlib.suppress(ReferenceError, RuntimeError):  # what it shows is gone
            listener()


_watch: _Watch | None = None
_ear: _Ear | None = None


def listen(listener: Callable[[], None]) -> None:
    """Call this, until `forget`, once preferences have changed."""
    global _watch
    if _watch is None:
        _watch = _Watch()
    _listeners.append(listener)


def listen_to_language(listener: Callable[[], None]) -> None:
    """Call this, until `forget`, once the window has another language."""
    global _ear
    if _ear is None:
        _ear = _Ear()
    _readers.append(listener)


def forget(listener: Callable[[], None]) -> None:
    """Call it no more."""
    for listeners in (_listeners, _readers):
        if listener in listeners:
            listeners.remove(listener)
