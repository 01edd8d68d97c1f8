# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a placement computes beside the window, and tells of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide import QtCore

from ...core.issues import AmError
from ...objects.work.progress import Cancelled
from ..background.later import Background
from ..background.worker import Worker
from ..texts.translation import tr, translated, translated_error

TELL_EVERY = 100  # ms


class Work:
    """One kind of work at a time. `done` gets its result, None where it was cancelled or failed; `tell` what goes on, and
    whether it is an error."""

    def __init__(
        self, form: Any, done: Callable[[Any], None], tell: Callable[[str, bool], None]
    ) -> None:
        self.done, self.tell = done, tell
        self.background = Background(form)
        self.timer = QtCore.QTimer(form)
        self.timer.setInterval(TELL_EVERY)
        self.timer.timeout.connect(self._tell)

    @property
    def runs(self) -> bool:
        """Whether it goes on."""
        return self.background.worker is not None

    def start(self, work: Callable[[], Any]) -> None:
        """Begin it."""
        self.background.start(work, self._show)
        self.timer.start()
        self._tell()

    def cancel(self) -> None:
        """End it, if it goes on."""
        self.timer.stop()
        self.background.cancel()

    def _show(self, worker: Worker) -> None:
        self.timer.stop()
        found = None
        try:
            found = worker.result()
        except AmError as error:
            self.tell(translated_error(error), True)
        except Cancelled:
            self.tell(tr("Cancelled."), False)
        self.done(found)

    def _tell(self) -> None:
        worker = self.background.worker
        if worker is not None:
            share = (
                ""
                if worker.fraction is None
                else f"{100.0 * worker.fraction:.0f} %  {translated(worker.text)}"
            )
            self.tell(f"{tr('Computing')} {share}", False)
