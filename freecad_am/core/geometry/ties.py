# SPDX-License-Identifier: LGPL-2.1-or-later
"""Choices that do not depend on the last bits of a tie.

A symmetric problem has two best answers, and the processor and the library decide which
of them is a hair smaller. The first of values equal within a tolerance is taken.
"""

from __future__ import annotations

import numpy as np

from ..types import Array, ArrayLike, Index, Mask

TIE_TOLERANCE, TIE_SHARE = 1e-9, 1e-14


def is_tied(values: ArrayLike, best: ArrayLike) -> Mask:
    """Return whether values are no greater than the best plus the tolerance.

    False for NaN; all True where the best is infinite.
    """
    limit = np.asarray(best) + TIE_TOLERANCE + TIE_SHARE * np.abs(best)
    good: Mask = np.asarray(values) <= limit
    return good


def index_of_minimum(values: Array, axis: int = -1) -> Index:
    """Return the index along the axis of the first value that ties with the smallest; NaN counts
    as largest.
    """
    comparable = np.where(np.isnan(values), np.inf, values)
    with np.errstate(invalid="ignore"):
        index: Index = is_tied(comparable, comparable.min(axis=axis, keepdims=True)).argmax(
            axis=axis
        )
    return index


def first_most(values: Array, axis: int = -1) -> Index:
    """Index along the axis of the first of the values that are as large as the largest, NaN being smaller than any."""
    return index_of_minimum(-values, axis)
