# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work in a thread of its own, which touches no document and no window, and can be cancelled at any moment.

It ends at its next report of progress, or between any two steps of Python, whichever comes first. A single call into
compiled code is not interrupted: the work is left to itself then, and what it returns is dropped.
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from typing import Any

from PySide import QtCore

from ..objects.progress import Cancelled, told_to

AGAIN = 200  # ms between two attempts to end work that goes on


class Worker:
    """Carries `work` out, from now on. What it has said of its progress is in `fraction` (None before) and `text`."""

    def __init__(self, work: Callable[[], Any]) -> None:
        self.fraction: float | None = None
        self.text = ""
        self.ended = threading.Event()
        self._work = work
        self._value: Any = None
        self._error: BaseException | None = None
        self._cancelled = False
        self._ending = threading.Lock()
        self._thread = threading.Thread(target=self._run, name="Robotic AM", daemon=True)
        self._thread.start()

    def result(self) -> Any:
        """What the work, which has ended, returned; raises what it raised, Cancelled when it was."""
        if self._cancelled:
            raise Cancelled
        if self._error is not None:
            raise self._error
        return self._value

    def cancel(self) -> None:
        """End it, as soon as it can be; its result is of no use any more."""
        self._cancelled = True
        self._stop()
        if not self.ended.is_set():
            _keep_stopping(self)

    # ---- in the thread

    def _run(self) -> None:
        try:
            try:
                with told_to(self._tell):
                    self._value = self._work()
            except BaseException as error:  # told to whoever asks for the result
                self._error = error
            with self._ending:
                self.ended.set()
        except BaseException:  # the order to end came when it was over
            with self._ending:
                self.ended.set()

    def _tell(self, fraction: float, text: str) -> None:
        if self._cancelled:
            raise Cancelled
        self.fraction, self.text = fraction, text

    # ---- in the window's thread

    def _stop(self) -> None:
        with self._ending:
            if not self.ended.is_set():
                ctypes.pythonapi.PyThreadState_SetAsyncExc(
                    ctypes.c_ulong(self._thread.ident or 0), ctypes.py_object(Cancelled)
                )


_to_stop: list[Worker] = []


def _keep_stopping(worker: Worker) -> None:
    """Compiled code may have swallowed the order to end: give it again until it is followed."""
    _to_stop.append(worker)
    if len(_to_stop) == 1:
        QtCore.QTimer.singleShot(AGAIN, _stop_again)


def _stop_again() -> None:
    _to_stop[:] = [worker for worker in _to_stop if not worker.ended.is_set()]
    for worker in _to_stop:
        worker._stop()
    if _to_stop:
        QtCore.QTimer.singleShot(AGAIN, _stop_again)
