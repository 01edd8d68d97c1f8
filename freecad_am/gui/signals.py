# SPDX-License-Identifier: LGPL-2.1-or-later
"""Signals of objects created by Qt or FreeCAD, such as FreeCAD's fields.

`sender.signal.connect` of PySide2 keeps the Python side of such an object for ever, also when the object itself is deleted.
The wrapper of a deleted FreeCAD field is then found by its memory address instead of a later object there: Python
takes a new line edit for a dead spin box, and its panel cannot be created.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide import QtCore


def connect(sender: Any, signal: str, act: Callable[..., None]) -> None:
    """Call a function at a signal, by its C++ name such as "textChanged(QString)", as long as the sender is there."""
    QtCore.QObject.connect(sender, QtCore.SIGNAL(signal), act)
