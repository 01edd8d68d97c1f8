# SPDX-License-Identifier: LGPL-2.1-or-later
"""Choices that do not hang on the last bits of a tie.

What is symmetric has two best answers, and which of them comes out a hair smaller differs with the processor and the
library. Of values alike to a grain the first is taken.
"""

from __future__ import annotations

import numpy as np

from ..types import Array, ArrayLike, Index, Mask

GRAIN, SHARE = 1e-9, 1e-14


def alike(values: ArrayLike, best: ArrayLike) -> Mask:
    """Whether values are no greater than the best but for the grain; none that is NaN, all where the best is infinite."""
    most = np.asarray(best) + GRAIN + SHARE * np.abs(best)
    good: Mask = np.asarray(values) <= most
    return good


def first_least(values: Array, axis: int = -1) -> Index:
    """Index along the axis of the first of the values that are as small as the smallest, NaN being larger than any."""
    known = np.where(np.isnan(values), np.inf, values)
    with np.errstate(invalid="ignore"):
        first: Index = alike(known, known.min(axis=axis, keepdims=True)).argmax(axis=axis)
    return first


def first_most(values: Array, axis: int = -1) -> Index:
    """Index along the axis of the first of the values that are as large as the largest, NaN being smaller than any."""
    return first_least(-values, axis)
