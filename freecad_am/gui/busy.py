# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run long work while the window stays responsive, with progress and a cancel button.

The work runs in another thread while this thread handles events, so that the window is redrawn and
FreeCAD's timers run. User input is queued for a moment; if the work takes longer, a modal dialog
receives it.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from time import monotonic
from typing import Any

import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ..objects.work import progress
from .in_language import tr, translated
from .signals import connect
from .worker import Worker

NAME = "RoboticAM_Progress"
AT_ONCE = 0.04  # s; wait this long without handling events
SHOWN_AFTER = 0.5  # s
LOOK_EVERY = 40  # ms
GRACE = 0.15  # s; wait this long for cancelled work
STEPS = 1000
_WIDTH = 420  # px

_dialog: ContextVar[_Dialog | None] = ContextVar("dialog", default=None)


def carry_out(work: Callable[[], Any], title: str, doing: str = "") -> Any:
    """Run `work` in another thread and return its result; `work` must touch no document.

    doing: message until the work reports progress. Raises Cancelled, and the errors of `work`.
    """
    worker = Worker(work)
    if not worker.ended.wait(AT_ONCE):
        with busy() as dialog:
            _attend(worker, title, doing, dialog)
    return worker.result()


@contextlib.contextmanager
def busy() -> Iterator[_Dialog]:
    """Show one dialog for several jobs if together they take long."""
    outer = _dialog.get()
    if outer is not None:
        yield outer
        return
    dialog = _Dialog()
    token = _dialog.set(dialog)
    try:
        yield dialog
    finally:
        _dialog.reset(token)
        dialog.close()


def _attend(worker: Worker, title: str, doing: str, dialog: _Dialog) -> None:
    """Handle events until the work has ended or was cancelled."""
    loop, timer = QtCore.QEventLoop(), QtCore.QTimer()
    failure: list[BaseException] = []

    def look() -> None:
        try:
            if worker.fraction is not None:
                progress.report(worker.fraction, worker.text)  # a macro may listen, and cancel
        except BaseException as error:  # Qt would swallow the error here
            failure.append(error)
        if (
            worker.ended.is_set()
            or failure
            or dialog.cancelled
            or (dialog.is_due and not dialog.visible)
        ):
            loop.quit()
        dialog.show_progress(title, worker.fraction, worker.text or doing)

    timer.setInterval(LOOK_EVERY)
    timer.timeout.connect(look)
    timer.start()
    while not (worker.ended.is_set() or failure or dialog.cancelled):
        if dialog.is_due:
            dialog.show(title, doing)
            _run(loop, QtCore.QEventLoop.AllEvents)
        else:
            _run(loop, QtCore.QEventLoop.ExcludeUserInputEvents)
    timer.stop()
    if failure or dialog.cancelled:
        worker.cancel()
        worker.ended.wait(GRACE)
    if failure:
        raise failure[0]


def _run(loop: Any, flags: Any) -> None:
    (getattr(loop, "exec", None) or loop.exec_)(flags)  # Qt 6, Qt 5


class _Dialog:
    """Dialog with text, bar and Cancel, shown after a delay. Esc and closing it cancel too.

    While FreeCAD recomputes, it blocks mouse and keys except in modal messages and progress
    dialogs. In a progress dialog, Esc is a shortcut, which Qt handles before keys. The application
    therefore needs no event filter, which would call Python for every event.
    """

    def __init__(self) -> None:
        self.since = monotonic()
        self.cancelled = False
        self.box: Any = None

    @property
    def is_due(self) -> bool:
        """Whether the work has taken long enough to show the dialog."""
        return monotonic() - self.since >= SHOWN_AFTER

    @property
    def visible(self) -> bool:
        """Whether the progress dialog is visible."""
        return self.box is not None

    def show(self, title: str, doing: str) -> None:
        """Show the progress dialog unless it is already visible."""
        if self.box is not None:
            return
        self.box = QtGui.QProgressDialog(Gui.getMainWindow())
        self.box.setObjectName(NAME)
        self.box.setWindowTitle(tr("Robotic AM"))
        self.box.setWindowModality(QtCore.Qt.ApplicationModal)
        self.box.setAutoClose(False)
        self.box.setAutoReset(False)
        self.text, self.bar, self.button = (
            QtGui.QLabel(),
            QtGui.QProgressBar(),
            QtGui.QPushButton(tr("Cancel")),
        )
        self.text.setObjectName("text")
        self.bar.setObjectName("bar")
        self.button.setObjectName("cancel")
        self.button.setToolTip(tr("Stops the computation; the document stays unchanged"))
        self.box.setLabel(self.text)
        self.box.setBar(self.bar)
        self.box.setCancelButton(self.button)
        for escape in self.box.findChildren(
            QtGui.QShortcut
        ):  # also if the main window keeps the focus
            escape.setContext(QtCore.Qt.ApplicationShortcut)
            connect(
                escape, "activatedAmbiguously()", self.cancel
            )  # Qt adds a shortcut for each Cancel button
        self.box.setMinimumWidth(_WIDTH)
        self.box.canceled.connect(self.cancel)
        self.show_progress(title, None, doing)
        QtGui.QApplication.setOverrideCursor(
            QtGui.QCursor(QtCore.Qt.ArrowCursor)
        )  # overrides FreeCAD's wait cursor
        self.box.show()
        self.button.setFocus()

    def show_progress(self, title: str, fraction: float | None, text: str) -> None:
        """Show what is computed, its progress (None: unknown) and the current step."""
        if self.box is None:
            return
        message = (
            tr("{}: {}").format(title, translated(text))
            if text
            else tr("{} is being computed").format(title)
        )
        if self.text.text() != message:
            self.text.setText(message)
        self.bar.setRange(0, 0 if fraction is None else STEPS)
        if fraction is not None:
            self.bar.setValue(round(STEPS * min(1.0, max(0.0, fraction))))

    def cancel(self, *_: Any) -> None:
        """Record that the user cancelled."""
        self.cancelled = True

    def close(self) -> None:
        """Close the dialog."""
        if self.box is None:
            return
        QtGui.QApplication.restoreOverrideCursor()
        self.box.canceled.disconnect(self.cancel)
        self.box.close()
        self.box.deleteLater()
        self.box = None
