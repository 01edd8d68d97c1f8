# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan all methods in the background and show the progress."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide import QtCore

from ...core.issues import AmError
from ...core.planning.redundancy import curve as rotation_curve
from ...core.planning.redundancy.curve import Compared
from ...core.planning.task import Task
from ...objects.work import progress
from ...objects.work.progress import Cancelled
from ..background.worker import Background, Worker
from ..texts.in_language import tr, translated, translated_error
from .draft import Source

TELL_EVERY = 100  # ms


class Comparison:
    """`done` gets the methods, none of them where it came to nothing; `tell` what goes on."""

    def __init__(
        self,
        form: Any,
        on_done: Callable[[tuple[Compared, ...]], None],
        tell: Callable[[str], None],
    ) -> None:
        self.done, self.tell = on_done, tell
        self.background = Background(form)
        self.timer = QtCore.QTimer(form)
        self.timer.setInterval(TELL_EVERY)
        self.timer.timeout.connect(self._show_progress)

    @property
    def runs(self) -> bool:
        """Whether it goes on."""
        return self.background.worker is not None

    def start(self, source: Source, task: Task) -> None:
        """Plan the beads of the toolpath, from their own seams, by all methods; with external axes,
        the beads of the plan, which hold their positions."""
        beads = (
            source.beads if source.cell.external else tuple(bead for _, _, bead in source.toolpath)
        )
        self.background.start(
            lambda: rotation_curve.compared(task, beads, source.places, progress.report), self._show
        )
        self.timer.start()
        self._show_progress()

    def cancel(self) -> None:
        """End it, if it goes on."""
        self.timer.stop()
        self.background.cancel()

    def _show(self, worker: Worker) -> None:
        self.timer.stop()
        try:
            compared = worker.result()
        except (AmError, Cancelled) as error:
            self.tell(translated_error(error))
            compared = ()
        self.done(compared)

    def _show_progress(self) -> None:
        worker = self.background.worker
        if worker is not None:
            share = (
                ""
                if worker.fraction is None
                else f"{100.0 * worker.fraction:.0f} %  {translated(worker.text)}"
            )
            self.tell(f"{tr('Planning')} {share}")
