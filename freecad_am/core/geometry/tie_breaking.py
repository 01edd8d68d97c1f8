# SPDX-License-Identifier: LGPL-2.1-or-later
"""Minimum and maximum searches whose results do not depend on the last bits of ties.

A symmetric problem has two optimal solutions, and rounding on a processor or in a library decides
which of the two values is smaller. These functions take the first value within a tolerance.
"""

from __future__ import annotations

import numpy as np

from ..types import Array, ArrayLike, Index, Mask

TIE_TOLERANCE, TIE_SHARE = 1e-9, 1e-14


def is_tied(values: ArrayLike, best: ArrayLike) -> Mask:
    """Return whether values tie with the best values, or are less.

    Parameters
    ----------
    values : array_like
        Values.
    best : array_like
        Minimum values, of a shape that broadcasts.

    Returns
    -------
    array of bool
        True up to `best` plus the tolerance; False for NaN; all True if `best` is infinite.
    """
    limit = np.asarray(best) + TIE_TOLERANCE + TIE_SHARE * np.abs(best)
    good: Mask = np.asarray(values) <= limit
    return good


def index_of_minimum(values: Array, axis: int = -1) -> Index:
    """Return the index of the first value that ties with the minimum.

    Parameters
    ----------
    values : array
        Values; NaN counts as infinite.
    axis : int, optional
        Axis to search along.

    Returns
    -------
    array of int
        Indices, in the shape of the values without that axis.
    """
    comparable = np.where(np.isnan(values), np.inf, values)
    with np.errstate(invalid="ignore"):
        index: Index = is_tied(comparable, comparable.min(axis=axis, keepdims=True)).argmax(
            axis=axis
        )
    return index


def first_most(values: Array, axis: int = -1) -> Index:
    """Return the index of the first value that ties with the maximum.

    Parameters
    ----------
    values : array
        Values; NaN counts as minus infinity.
    axis : int, optional
        Axis to search along.

    Returns
    -------
    array of int
        Indices, in the shape of the values without that axis.
    """
    return index_of_minimum(-values, axis)
