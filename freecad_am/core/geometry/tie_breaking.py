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
    """Return whether values tie with the best, or are less.

    Parameters
    ----------
    values : array_like
        Values.
    best : array_like
        Least values, of a shape that broadcasts.

    Returns
    -------
    array of bool
        True up to the best plus the tolerance; False for NaN, all True where the best is infinite.
    """
    limit = np.asarray(best) + TIE_TOLERANCE + TIE_SHARE * np.abs(best)
    good: Mask = np.asarray(values) <= limit
    return good


def index_of_minimum(values: Array, axis: int = -1) -> Index:
    """Return the index of the first value that ties with the smallest.

    Parameters
    ----------
    values : array
        Values; NaN counts as largest.
    axis : int, optional
        The axis to search along.

    Returns
    -------
    array of int
        Of the shape of the values without that axis.
    """
    comparable = np.where(np.isnan(values), np.inf, values)
    with np.errstate(invalid="ignore"):
        index: Index = is_tied(comparable, comparable.min(axis=axis, keepdims=True)).argmax(
            axis=axis
        )
    return index


def first_most(values: Array, axis: int = -1) -> Index:
    """Return the index of the first value that ties with the largest.

    Parameters
    ----------
    values : array
        Values; NaN counts as smallest.
    axis : int, optional
        The axis to search along.

    Returns
    -------
    array of int
        Of the shape of the values without that axis.
    """
    return index_of_minimum(-values, axis)
