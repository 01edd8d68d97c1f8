# SPDX-License-Identifier: LGPL-2.1-or-later
"""How fast the machine is at a moment: one that is shared may take two or three times as long for minutes, and so does all
that is held to seconds. Such rows tell what was used, and are judged by what that is on a quiet machine."""

from __future__ import annotations

import threading
import time
from statistics import median
from typing import Self

import numpy as np

QUIET_MS = 2.24  # of the fixed piece of work, on the machine that the figures in the docs are of, with nothing else on it
EVERY_S, ROUNDS = 0.5, 8


def pace() -> float:
    """ms of the processor that a fixed piece of work takes now, the least of some."""
    values, took = np.linspace(0.1, 1.0, 2000), []
    for _ in range(ROUNDS):
        start = time.thread_time()
        for _ in range(400):
            np.sqrt((values * values + values) * 1.1)
        took.append(time.thread_time() - start)
    return 1e3 * min(took)


class Watch:
    """Takes the pace every half a second while it is entered, on whatever core is free: for work of other processes."""

    def __enter__(self) -> Self:
        self._seen = [pace()]
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._look, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()

    def _look(self) -> None:
        while not self._over.wait(EVERY_S):
            self._seen.append(pace())

    @property
    def pace(self) -> float:
        """Its median so far, ms."""
        return median(self._seen)

    def quiet(self, seconds: float) -> float:
        """What took `seconds` while it was watched, on a quiet machine."""
        return seconds * QUIET_MS / self.pace
