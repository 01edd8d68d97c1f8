# SPDX-License-Identifier: LGPL-2.1-or-later
"""Connect signals of objects created by Qt or FreeCAD, such as FreeCAD's fields.

`sender.signal.connect` of PySide2 keeps the Python wrapper of such an object for ever, even if the
object is deleted. PySide then finds the wrapper of a deleted FreeCAD field by memory address
instead of a later object at this address. Python takes a new line edit for a deleted spin box, and
its panel cannot be created.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide import QtCore


def connect(sender: Any, signal: str, act: Callable[..., None]) -> None:
    """Call a function at a signal, by its C++ name such as "textChanged(QString)", while the sender
    exists.
    """
    QtCore.QObject.connect(sender, QtCore.SIGNAL(signal), act)
