# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run work in its own thread, which touches no document or window and can be cancelled at any time.

Cancelled work ends at its next progress report or between two Python steps, whichever comes first.
A single call into compiled code is not interrupted; its work continues and the result is dropped.

Widgets must be deleted in the window's thread: otherwise Qt still calls a deleted timer and FreeCAD
crashes. Python deletes an object in the thread that drops its last reference. It collects cycles
(such as a widget and the method that its signal calls) in the thread that has just created many
objects, which is the worker. Workers and the objects that they refer to are therefore kept until
their threads have ended, and meanwhile only a timer of the window collects cycles.
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

AGAIN = 200  # ms; interval of checks of running threads
YOUNG = 1  # oldest generation collected at each check: objects created since the last check


class Worker:
    """Runs `work` in a thread, from construction on.

    `fraction` (None at first) and `text` hold the progress.
    """

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
        """Return the result of the ended work, re-raise its error once, or raise Cancelled."""
        if self._cancelled:
            raise Cancelled
        error, self._error = self._error, None
        if error is not None:
            try:
                raise error
            finally:
                del error  # its traceback refers to this frame and to the calling panel
        return self._value

    def cancel(self) -> None:
        """Cancel the work as soon as possible and discard its result.

        Compiled code may swallow the exception that cancels the work, so the exception is raised
        until it takes effect.
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
            except BaseException as error:  # re-raised by `result`
                self._error = error
            with self._ending:
                self.ended.set()
        except BaseException:  # the cancellation arrived after the end
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
        """Whether the thread still runs; a cancelled thread is asked again to end."""
        alive = self._thread.is_alive()
        if self._cancelled:
            self._stop()
            if self.ended.is_set():  # always set if the thread was not alive above
                self._value = self._error = None  # unused, and its traceback refers to this worker
        return alive


class _RunningWorkers:
    """The workers whose threads run. collecting: whether Python's cycle collector was on before the
    first worker.
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
        """Drop ended workers and collect young cycles in the window's thread."""
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
)  # parts of PySide and FreeCAD errors about a deleted widget or view


@contextlib.contextmanager
def while_there() -> Iterator[None]:
    """Ignore errors about deleted fields and objects after a panel or document closes, but no other
    RuntimeError of FreeCAD or Python.
    """
    try:
        yield
    except ReferenceError:
        pass
    except RuntimeError as error:
        if not any(words in str(error) for words in DELETED):
            raise


class Later:
    """Calls a method some time after the last request, unless the panel is closed by then."""

    def __init__(self, form: Any, act: Callable[[], None]) -> None:
        self.act = WeakMethod(act)
        self.timer = QtCore.QTimer(form)
        self.timer.setSingleShot(True)
        self.timer.setInterval(WAIT)
        self.timer.timeout.connect(self._act)

    def ask(self, *_: Any) -> None:
        """Request a call; the delay restarts."""
        self.timer.start()

    def at_once(self) -> None:
        """Call the method now if a call is pending."""
        if self.timer.isActive():
            self.timer.stop()
            self._act()

    def _act(self) -> None:
        act = self.act()
        with while_there():  # FreeCAD may delete the fields of a closed panel before the timer
            if act is not None:
                act()


class Background:
    """Runs work for a panel in the background; new work cancels running work."""

    def __init__(self, form: Any) -> None:
        self.worker: Worker | None = None
        self.show: Callable[[Worker], None] | None = None
        self.timer = QtCore.QTimer(form)
        self.timer.setInterval(LOOK_EVERY)
        self.timer.timeout.connect(self._look)

    def start(self, work: Callable[[], Any], show: Callable[[Worker], None]) -> None:
        """Start work that touches no document; unless cancelled, `show` receives the worker at its
        end.
        """
        self.cancel()
        self.worker, self.show = Worker(work), show
        self.timer.start()

    def cancel(self) -> None:
        """Cancel running work, if any; may be called repeatedly."""
        if self.worker is not None:
            self.worker.cancel()
            self.worker = self.show = None
        with contextlib.suppress(RuntimeError):  # the panel and its timer are deleted
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
    """Runs one job of a kind at a time and reports its progress as text.

    `on_done` receives the result, None after a cancel or an error. `tell` receives the text, and
    whether it is an error. doing: text before the fraction, such as "Computing".
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
