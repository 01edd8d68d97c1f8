# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a panel does once nothing has been typed for a moment, and what it computes beside the window.

Neither keeps the panel: one that refers to itself in a circle is there until Python collects cycles, with its fields, long
after FreeCAD has deleted what they show. FreeCAD 1.0 and 1.1 then take such a field for whatever comes to be at its place
in memory, and the next panel cannot be made, or FreeCAD crashes.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any
from weakref import WeakMethod

from PySide import QtCore

from .worker import Worker

WAIT = 300  # ms
LOOK_EVERY = 30  # ms
DELETED = (
    "already deleted",
    "of deleted object",
)  # in what PySide and FreeCAD say of a widget or a view that is gone


@contextlib.contextmanager
def while_there() -> Iterator[None]:
    """Pass over that a field of a closed panel, or an object of a closed document, is gone, and nothing else: FreeCAD and
    Python tell other errors as a RuntimeError too."""
    try:
        yield
    except ReferenceError:
        pass
    except RuntimeError as error:
        if not any(words in str(error) for words in DELETED):
            raise


class Later:
    """Calls a method some time after it was last asked to, unless the panel is gone by then."""

    def __init__(self, form: Any, act: Callable[[], None]) -> None:
        self.act = WeakMethod(act)
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
        act = self.act()
        with while_there():  # FreeCAD has taken fields of a closed panel away before the timer
            if act is not None:
                act()


class Background:
    """Carries out work for a panel while the window goes on; what is begun anew ends what went on."""

    def __init__(self, form: Any) -> None:
        self.worker: Worker | None = None
        self.show: Callable[[Worker], None] | None = None
        self.timer = QtCore.QTimer(form)
        self.timer.setInterval(LOOK_EVERY)
        self.timer.timeout.connect(self._look)

    def start(self, work: Callable[[], Any], show: Callable[[Worker], None]) -> None:
        """Begin work that touches no document; `show` gets the worker once it has ended, unless it was cancelled."""
        self.cancel()
        self.worker, self.show = Worker(work), show
        self.timer.start()

    def cancel(self) -> None:
        """End what goes on, if anything does; once or more often."""
        if self.worker is not None:
            self.worker.cancel()
            self.worker = self.show = None
        with contextlib.suppress(RuntimeError):  # the panel is gone, and with it the timer
            self.timer.stop()

    def at_once(self) -> None:
        """Show what has ended, without waiting for the next look."""
        self._look()

    def _look(self) -> None:
        worker, show = self.worker, self.show
        if worker is None or not worker.ended.is_set() or show is None:
            return
        self.worker = self.show = None
        self.timer.stop()
        with while_there():
            show(worker)
