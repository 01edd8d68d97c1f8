# SPDX-License-Identifier: LGPL-2.1-or-later
"""Speed of the machine at a moment: a shared machine may be two or three times slower for minutes,
and so is every time measured on it. Rows against fixed seconds state the processor time used and
are judged by the equivalent time on a quiet machine."""

from __future__ import annotations

import threading
import time
from statistics import median
from typing import Self

import numpy as np

QUIET_MS = 2.24  # of the fixed workload on the machine used for the figures in the docs, without other load
EVERY_S, ROUNDS = 0.5, 8


def pace() -> float:
    """Return the ms of processor time that a fixed workload takes now, the least of several
    rounds."""
    values, took = np.linspace(0.1, 1.0, 2000), []
    for _ in range(ROUNDS):
        start = time.thread_time()
        for _ in range(400):
            np.sqrt((values * values + values) * 1.1)
        took.append(time.thread_time() - start)
    return 1e3 * min(took)


class Watch:
    """Sample the pace every half second while entered, on any free core: for work of other
    processes."""

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
        """Return the median pace up to now (ms)."""
        return median(self._seen)

    def quiet(self, seconds: float) -> float:
        """Convert `seconds` measured during the watch to a quiet machine."""
        return seconds * QUIET_MS / self.pace
