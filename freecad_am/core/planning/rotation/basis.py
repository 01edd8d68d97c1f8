# SPDX-License-Identifier: LGPL-2.1-or-later
"""The polynomials that the optimiser may add: all, or those that keep a closed bead joined.

A closed bead whose polynomial takes the same value at both ends, up to whole turns, comes back to
its starting pose. The search chooses the turns; polynomials equal at both ends remain free.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev, polynomial

from ...types import Array
from ..points import Points
from ..task import Task


def changes(task: Task, points: Points, degree: int) -> Array:
    """(B, degree + 1, degree + 1) per bead the coefficients, the constant first, of independent changes as columns.

    They are Chebyshev polynomials over the bead's parameter, so that all are of the size of a rotation; the column that
    would part the ends of a closed bead is zero.
    """
    joined = task.joined & points.closed
    # most beads have their ends where others have them
    ends, of_bead = np.unique(np.stack(points.ends, axis=1), axis=0, return_inverse=True)
    result = np.stack([_chebyshev(low, high, degree) for low, high in ends])[of_bead]
    if degree > 0:
        result[joined, :, 3::2] -= result[joined, :, 1:2]
        result[joined, :, 1] = 0.0
    return result


def _chebyshev(low: float, high: float, degree: int) -> Array:
    """Columns T_0 .. T_degree of the parameter brought from low .. high to -1 .. 1."""
    columns = np.zeros((degree + 1, degree + 1))
    shift = np.array([-(high + low) / (high - low), 2.0 / (high - low)])
    for j in range(degree + 1):
        value = np.zeros(1)
        for coefficient in chebyshev.cheb2poly(np.eye(degree + 1)[j])[::-1]:
            value = polynomial.polyadd(polynomial.polymul(value, shift), [coefficient])
        columns[: len(value), j] = value[: degree + 1]
    return columns
