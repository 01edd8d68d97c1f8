# SPDX-License-Identifier: LGPL-2.1-or-later
"""Zeros in spans of axis 6 where the polynomial of an offset wrist is as small as rounding.

There the point of axes 4 and 5 passes close to axis 1, or several solutions nearly meet.
The polynomial is a product of the conditions of both sides and both elbows, and loses its
digits where more than one of them is small. The condition of a single side and elbow
keeps them, and is sampled: `search` covers a whole turn and misses features narrow at
that scale.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ....types import Array, Index
from . import search
from .search import SAME_RAD, Zeros
from .shoulder_loops import EDGE, Curves, whole_turns

SAMPLES = 24  # of a span, finer where the condition is nearly zero
SEARCH_LEVEL = 1  # level of the search from which steps are divided: samples of a span are as close as those of its first pieces


def zeros(curves: Curves, pose: Index, low: Array, high: Array) -> Zeros:
    """Return all zeros that samples of spans (k,) show, on either side of axis 1 and with either
    elbow, unordered.
    """
    pose, low, high = _merge_spans(pose, low, high)
    span = np.repeat(np.arange(len(pose)), 4)
    side, elbow = (
        np.tile(signs, len(pose)) for signs in ([1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0])
    )
    loops, begin = whole_turns(curves, pose[span], side, elbow)
    # one more sample at both ends, for adjacent extremes
    share = np.arange(-1, SAMPLES + 2) / SAMPLES
    t = (low[span] - begin)[:, None] + share * (high - low)[span, None]
    samples = search.find_zeros_along(curves, loops, t, SEARCH_LEVEL)
    reached = np.abs(samples.bent[1]) <= 1.0 + EDGE
    columns: tuple[Any, ...] = samples
    return Zeros(*(column[..., reached] for column in columns))


def _merge_spans(pose: Index, low: Array, high: Array) -> tuple[Index, Array, Array]:
    """Spans of a pose that meet as one."""
    order = np.lexsort((low, pose))
    pose, low, high = pose[order], low[order], high[order]
    is_first = np.ones(len(pose), dtype=bool)
    is_first[1:] = (pose[1:] != pose[:-1]) | (low[1:] > high[:-1] + SAME_RAD)
    begins = np.flatnonzero(is_first)
    return pose[begins], low[begins], np.maximum.reduceat(high, begins)
