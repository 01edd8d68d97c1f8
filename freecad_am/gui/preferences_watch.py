# SPDX-License-Identifier: LGPL-2.1-or-later
"""Notify listeners when a display preference or the language of the window changes, from any source."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ..objects.fields.preferences import GROUP, SCHEME, SHOWN, UNIT_SETTINGS

_listeners: list[Callable[[], None]] = []
_readers: list[Callable[[], None]] = []  # listeners that show texts


class _Watch:
    """Observer of our preferences and FreeCAD's units; simultaneous changes cause one notification."""

    def __init__(self) -> None:
        self.groups = [App.ParamGet(GROUP), App.ParamGet(UNIT_SETTINGS)]
        self.is_scheduled = False
        for group in self.groups:
            group.Attach(self)

    def onChange(self, group: Any, name: str) -> None:
        """Called by FreeCAD when an entry was changed or removed."""
        if name in (*SHOWN, SCHEME) and not self.is_scheduled:
            self.is_scheduled = True
            QtCore.QTimer.singleShot(0, self._notify)

    def _notify(self) -> None:
        self.is_scheduled = False
        _notify(_listeners)


class _Ear(QtGui.QWidget):
    """Hidden widget: Qt notifies all widgets of a language change, once per translation file."""

    def __init__(self) -> None:
        super().__init__(Gui.getMainWindow())
        self.hide()
        self.is_scheduled = False

    def changeEvent(self, event: Any) -> None:
        """Called by Qt."""
        super().changeEvent(event)
        if event.type() == QtCore.QEvent.LanguageChange and not self.is_scheduled:
            self.is_scheduled = True
            QtCore.QTimer.singleShot(0, self._notify)  # after all files are read

    def _notify(self) -> None:
        self.is_scheduled = False
        _notify(_readers)


def _notify(listeners: list[Callable[[], None]]) -> None:
    for listener in tuple(listeners):  # a listener may remove itself and others
        with contextlib.suppress(ReferenceError, RuntimeError):  # the listener's widget is deleted
            listener()


@functools.cache
def _watch() -> _Watch:
    """Return the observer of the preferences, created once."""
    return _Watch()


@functools.cache
def _ear() -> _Ear:
    """Return the widget that receives language changes, created once."""
    return _Ear()


def listen(listener: Callable[[], None]) -> None:
    """Call `listener` after each change of preferences, until `forget`."""
    _watch()
    _listeners.append(listener)


def listen_to_language(listener: Callable[[], None]) -> None:
    """Call `listener` after each change of the window's language, until `forget`."""
    _ear()
    _readers.append(listener)


def forget(listener: Callable[[], None]) -> None:
    """Stop calling a listener."""
    for listeners in (_listeners, _readers):
        if listener in listeners:
            listeners.remove(listener)
