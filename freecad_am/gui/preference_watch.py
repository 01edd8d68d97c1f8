# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tells whoever shows something when a preference of what is shown has changed, wherever it was changed."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

import FreeCAD as App
from PySide import QtCore

from ..objects.preferences import GROUP, SHOWN

_listeners: list[Callable[[], None]] = []


class _Watch:
    """Attached to the group of our preferences; several changes at once are told once."""

    def __init__(self) -> None:
        self.group = App.ParamGet(GROUP)
        self.asked = False
        self.group.Attach(self)

    def onChange(self, group: Any, name: str) -> None:
        """Called by FreeCAD when an entry has changed or gone."""
        if name in SHOWN and not self.asked:
            self.asked = True
            QtCore.QTimer.singleShot(0, self._tell)

    def _tell(self) -> None:
        self.asked = False
        for listener in tuple(_listeners):  # one may end what it shows, and with it another
            with contextlib.suppress(ReferenceError, RuntimeError):  # what it shows is gone
                listener()


_watch: _Watch | None = None


def listen(listener: Callable[[], None]) -> None:
    """Call this, until `forget`, once preferences have changed."""
    global _watch
    if _watch is None:
        _watch = _Watch()
    _listeners.append(listener)


def forget(listener: Callable[[], None]) -> None:
    """Call it no more."""
    if listener in _listeners:
        _listeners.remove(listener)
