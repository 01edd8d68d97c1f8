# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work in a thread of its own, which touches no document and no window, and can be cancelled at any moment.

A cancelled work ends at its next progress report or between two Python steps, whichever comes first. A single call
into compiled code is not interrupted: the work then continues and its result is dropped.

Widgets must be deleted in the window's thread: Qt still calls a timer deleted in another thread, and FreeCAD
crashes. Python deletes an object in the thread that drops its last reference, and collects cycles (such as a widget
and the method its signal calls) in the thread that has just made many objects, which is the worker. So workers and
the objects they refer to are kept until their threads have ended, and while a thread runs only a timer of the
window collects cycles.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import threading
from collections.abc import Callable, Iterator
from typing import Any
from weakref import WeakMethod

from PySide import QtCore

from ..core import one_thread
from ..core.issues import AmError
from ..objects.work.progress import Cancelled, told_to
from .in_language import tr, translated, translated_error

AGAIN = 200  # ms between two checks of running threads
YOUNG = (
    1  # generation up to which cycles are collected at each check: objects made since the last one
)


class Worker:
    """Runs `work` in a thread, from now on. Its progress is in `fraction` (None at first) and `text`."""

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
        _running_workers.add(self)
        self._thread.start()

    def result(self) -> Any:
        """Return the result of the ended work; re-raise its error once, or Cancelled."""
        if self._cancelled:
            raise Cancelled
        error, self._error = self._error, None
        if error is not None:
            try:
                raise error
            finally:
                del error  # its traceback refers to here, and to the panel that asked
        return self._value

    def cancel(self) -> None:
        """Cancel the work as soon as possible and discard its result.

        Compiled code may swallow the exception that cancels it, so it is raised until it takes
        effect.
        """
        self._cancelled = True
        self._stop()

    # ---- in the thread

    def _run(self) -> None:
        try:
            one_thread.limit_calling_thread()
            try:
                with told_to(self._report):
                    self._value = self._work()
            except BaseException as error:  # raised by `result`
                self._error = error
            with self._ending:
                self.ended.set()
        except BaseException:  # the order to end came when it was over
            with self._ending:
                self.ended.set()

    def _report(self, fraction: float, text: str) -> None:
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

    def goes_on(self) -> bool:
        """Whether the thread still runs; a cancelled one is asked again to end."""
        alive = self._thread.is_alive()
        if self._cancelled:
            self._stop()
            if self.ended.is_set():  # as it is where it was not alive before
                self._value = self._error = (
                    None  # of no use, and its traceback refers to this worker
                )
        return alive


class _RunningWorkers:
    """The workers whose threads run. collecting: whether Python's cycle collector was on before the
    first one.
    """

    def __init__(self) -> None:
        self.workers: list[Worker] = []
        self.collecting = False

    def add(self, worker: Worker) -> None:
        """Keep a worker that is about to start until its thread has ended."""
        if not self.workers:
            self.collecting = gc.isenabled()
            gc.disable()
            one_thread.hold()
            QtCore.QTimer.singleShot(AGAIN, self._look)
        self.workers.append(worker)

    def _look(self) -> None:
        """Drop workers that have ended, and collect the cycles of a moment, in the window's thread."""
        self.workers[:] = [worker for worker in self.workers if worker.goes_on()]
        if self.collecting:
            gc.collect(YOUNG)
        if self.workers:
            QtCore.QTimer.singleShot(AGAIN, self._look)
            return
        one_thread.release()
        if self.collecting:
            gc.enable()


_running_workers = _RunningWorkers()

WAIT = 300  # ms
LOOK_EVERY = 30  # ms
DELETED = (
    "already deleted",
    "of deleted object",
)  # in what PySide and FreeCAD say of a widget or a view that is gone


@contextlib.contextmanager
def while_there() -> Iterator[None]:
    """Ignore errors of deleted fields and objects, after a panel or document closes, but no other RuntimeError of
    FreeCAD or Python."""
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
    """Runs work for a panel in the background; new work cancels the running one."""

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
        """Cancel running work, if any; may be called repeatedly."""
        if self.worker is not None:
            self.worker.cancel()
            self.worker = self.show = None
        with contextlib.suppress(RuntimeError):  # the panel is gone, and with it the timer
            self.timer.stop()

    def at_once(self) -> None:
        """Show the result of finished work now instead of at the next check."""
        self._look()

    def _look(self) -> None:
        worker, show = self.worker, self.show
        if worker is None or not worker.ended.is_set() or show is None:
            return
        self.worker = self.show = None
        self.timer.stop()
        with while_there():
            show(worker)


TELL_EVERY = 100  # ms


class Work:
    """One kind of work at a time, with its progress told as text.

    `on_done` receives its result, None after a cancel or an error; `tell` the text, and whether it
    is an error. doing: what the text says before the share, such as "Computing".
    """

    def __init__(
        self,
        form: Any,
        on_done: Callable[[Any], None],
        tell: Callable[[str, bool], None],
        doing: str,
    ) -> None:
        self.done, self.tell, self.doing = on_done, tell, doing
        self.background = Background(form)
        self.timer = QtCore.QTimer(form)
        self.timer.setInterval(TELL_EVERY)
        self.timer.timeout.connect(self._show_progress)

    @property
    def runs(self) -> bool:
        """Whether the work is running."""
        return self.background.worker is not None

    def start(self, work: Callable[[], Any]) -> None:
        """Start the work."""
        self.background.start(work, self._show)
        self.timer.start()
        self._show_progress()

    def cancel(self) -> None:
        """Cancel the work if it is running."""
        self.timer.stop()
        self.background.cancel()

    def _show(self, worker: Worker) -> None:
        self.timer.stop()
        result = None
        try:
            result = worker.result()
        except AmError as error:
            self.tell(translated_error(error), True)
        except Cancelled:
            self.tell(tr("Cancelled."), False)
        self.done(result)

    def _show_progress(self) -> None:
        worker = self.background.worker
        if worker is not None:
            share = (
                ""
                if worker.fraction is None
                else f"{100.0 * worker.fraction:.0f} %  {translated(worker.text)}"
            )
            self.tell(f"{self.doing} {share}", False)
