# SPDX-License-Identifier: LGPL-2.1-or-later
"""Signals of what Qt or FreeCAD has made, such as FreeCAD's fields and their parts.

`sender.signal.connect` of PySide2 keeps the Python side of such an object for ever, also when the object itself is deleted.
That of a field of FreeCAD is then found, by its place in memory, in stead of whatever comes to be there later: what Python
takes for a new line edit is a dead spin box, and the panel it belongs to cannot be made.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide import QtCore


def connect(sender: Any, signal: str, act: Callable[..., None]) -> None:
    """Call a function at a signal, by its C++ name such as "textChanged(QString)", as long as the sender is there."""
    QtCore.QObject.connect(sender, QtCore.SIGNAL(signal), act)
