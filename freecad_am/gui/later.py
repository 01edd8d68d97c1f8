# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a panel does once nothing has been typed for a moment."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

from PySide import QtCore

WAIT = 300  # ms


class Later:
    """Calls a function some time after it was last asked to, unless the panel is gone by then."""

    def __init__(self, form: Any, act: Callable[[], None]) -> None:
        self.act = act
        self.timer = QtCore.QTimer(form)
        self.timer.setSingleShot(True)
        self.timer.setInterval(WAIT)
        self.timer.timeout.connect(self._act)

    def ask(self, *_: Any) -> None:
        """Something was typed."""
        self.timer.start()

    def at_once(self) -> None:
        """Do it now where it is still to be done."""
        if self.timer.isActive():
            self.timer.stop()
            self._act()

    def _act(self) -> None:
        with contextlib.suppress(RuntimeError):  # FreeCAD has taken fields of a closed panel away before the timer
            self.act()
