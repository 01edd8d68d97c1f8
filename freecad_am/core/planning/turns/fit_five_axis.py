# SPDX-License-Identifier: LGPL-2.1-or-later
"""Finds room for the turns of limited axes of five-axis machines: another seam, or as the last resort a split bead."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ...geometry.angles import shortest
from ...kinematics.limits import Limits
from ...toolpath import Bead
from ...types import Array

MOST_PIECES = 4
FEWEST_POINTS = 3  # of a piece


def short_of(limits: Limits, turning: Sequence[int], axes: Array, reserve: float) -> bool:
    """Whether it is a turning axis that runs out of its stroke on axis values (n, axes)."""
    over = np.maximum(limits.lower + reserve - axes, axes - limits.upper + reserve) > 1e-9
    return bool(over[:, list(turning)].any())


def ways(
    limits: Limits, turning: Sequence[int], courses: Sequence[Array], bead: Bead, overlap: float
) -> Iterator[list[Bead]]:
    """Other ways to lay a bead, the best first: a closed one begun where a turning axis has room for all of it, then any in
    two or more pieces. courses: the axis values (n, axes) of its points, counted on, one per branch."""
    if bead.closed:
        for course in courses:
            for axis in turning:
                if np.isfinite(limits.upper[axis] - limits.lower[axis]) and np.isfinite(course).all():
                    start = _start(course[:, axis], float(limits.lower[axis]), float(limits.upper[axis]))
                    if start:
                        yield [bead.started_at(start).run_on(overlap)]
    whole = bead.run_on(overlap)
    for count in range(2, min(MOST_PIECES, (len(whole) - 1) // (FEWEST_POINTS - 1)) + 1):
        cuts = np.round(np.linspace(0, len(whole) - 1, count + 1)).astype(int).tolist()
        yield [whole.part(slice(low, high + 1)) for low, high in zip(cuts[:-1], cuts[1:])]


def _start(angles: Array, low: float, high: float) -> int:
    """The point of a closed bead from which its course (n,) lies best in the middle between two limits, but for turns."""
    n = len(angles) - 1
    turn = angles[-1] - angles[0]
    twice = np.concatenate([angles[:-1], angles + turn])
    windows = np.lib.stride_tricks.sliding_window_view(twice, n + 1)[:n]
    least, most = windows.min(axis=1), windows.max(axis=1)
    off = 0.5 * (least + most) - 0.5 * (low + high)
    off = shortest(off)
    over = np.maximum(np.abs(off) + 0.5 * (most - least) - 0.5 * (high - low), 0.0)
    # rounded, so that the same point is taken everywhere; of those that fit, the nearest to the seam
    fits = np.flatnonzero(over <= 0.0)
    if len(fits):
        return int(fits[np.argmin(np.minimum(fits, n - fits))])
    return int(np.argmin(np.round(over, 9)))
