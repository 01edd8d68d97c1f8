# SPDX-License-Identifier: LGPL-2.1-or-later
"""Zeros in spans of axis 6 throughout which the polynomial of an offset wrist is of the size of rounding.

There the point of axes 4 and 5 passes close to axis 1, or several solutions nearly meet: the polynomial is a product of the
conditions of both sides and both elbows, and has no digits where more than one of them is small. The condition of one side
and elbow has, and is sampled: `search` looks over a whole turn and passes over what is narrow here.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ....types import Array, Index
from . import search
from .loops import EDGE, whole_turns
from .plane import Curves
from .search import SAME_RAD, Zeros

SAMPLES = 24  # of a span, finer where the condition is nearly zero
SEARCH_LEVEL = 1  # of the search from which steps are divided: samples of a span are as near as those of its first pieces


def zeros(curves: Curves, pose: Index, low: Array, high: Array) -> Zeros:
    """All that samples of spans (k,) tell of, on either side of axis 1 and with either elbow, in no order."""
    pose, low, high = _merge_spans(pose, low, high)
    span = np.repeat(np.arange(len(pose)), 4)
    side, elbow = (
        np.tile(signs, len(pose)) for signs in ([1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0])
    )
    loops, begin = whole_turns(curves, pose[span], side, elbow)
    # one sample more at both ends, for extremes beside them
    share = np.arange(-1, SAMPLES + 2) / SAMPLES
    t = (low[span] - begin)[:, None] + share * (high - low)[span, None]
    samples = search.along(curves, loops, t, SEARCH_LEVEL)
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
