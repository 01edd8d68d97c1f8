# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fewer points that draw the same curve: of each column of the picture the first, the last, the least and the largest."""

from __future__ import annotations

import numpy as np

from freecad_am.core.types import Array, Index

POINTS_KEPT = 4  # points to a column that are drawn as they are


def envelope(x: Array, y: Array, columns: int, low: float, high: float) -> Index:
    """The points, rising numbers into x and y (n,), that look like all of them between x = low and high.

    x never falls. NaN in y is kept where it is to be seen as a gap. One point beyond either end is kept, for the lines that
    lead there.
    """
    first = max(int(np.searchsorted(x, low, side="left")) - 1, 0)
    end = min(int(np.searchsorted(x, high, side="right")) + 1, len(x))
    rows = np.arange(first, end)
    if len(rows) <= POINTS_KEPT * columns:
        return rows
    column = np.clip(np.floor((x[first:end] - low) / (high - low) * columns), -1, columns).astype(
        np.intp
    )
    begins = np.concatenate([[0], np.flatnonzero(np.diff(column)) + 1])
    ends = np.concatenate([begins[1:], [len(rows)]]) - 1
    known = np.flatnonzero(np.isfinite(y[first:end]))
    rising = known[np.lexsort((y[first:end][known], column[known]))]
    cuts = np.flatnonzero(np.diff(column[rising])) + 1
    least = rising[np.concatenate([[0], cuts])] if len(rising) else rising
    largest = rising[np.concatenate([cuts, [len(rising)]]) - 1] if len(rising) else rising
    kept: Index = rows[np.unique(np.concatenate([begins, ends, least, largest]))]
    return kept
