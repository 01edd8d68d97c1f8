# SPDX-License-Identifier: LGPL-2.1-or-later
"""The smallest and the largest eigenvalue of many small symmetric matrices at once.

For one matrix at a time LAPACK spends more than half of the time in calls. Here all
matrices are brought to tridiagonal form by Householder reflections together, and
Laguerre's iteration, which cannot pass a root from outside, runs from both sides to the
outermost roots of all characteristic polynomials.
"""

from __future__ import annotations

import numpy as np

from ..types import Array

# fewer matrices than this are done faster one at a time
BATCH_THRESHOLD = 400
ITERATIONS = 60
TOLERANCE = 1e-10


def extremes(matrices: Array) -> tuple[Array, Array]:
    """The smallest and largest eigenvalues (n,) of positive semidefinite matrices (k, k, n), to about 1e-15 of the
    largest."""
    if matrices.shape[2] < BATCH_THRESHOLD:
        values = np.linalg.eigvalsh(matrices.transpose(2, 0, 1))
        return np.asarray(values[:, 0]), np.asarray(values[:, -1])
    diagonal, squares = _tridiagonal(matrices)
    trace = diagonal.sum(axis=0)
    scale = 1.0 / np.where(trace > 0.0, trace, 1.0)
    diagonal *= scale
    squares *= scale * scale
    roots = np.zeros((2, matrices.shape[2]))
    roots[1] = 1.0
    _iterate(diagonal, squares, roots)
    roots /= scale
    return roots[0], roots[1]


def _iterate(diagonal: Array, squares: Array, roots: Array) -> None:
    """Laguerre's iteration from starts outside all roots (2, n) to the nearest ones, in place."""
    size = len(diagonal)
    current, columns = roots.copy(), np.arange(roots.shape[1])
    for _ in range(ITERATIONS):
        value, slope, curve = _polynomial(diagonal, squares, current)
        radicand = ((size - 1) ** 2 * slope) * slope
        radicand -= (size * (size - 1) * value) * curve
        slope += np.copysign(np.sqrt(np.maximum(radicand, 0.0)), slope)
        step = size * value / np.where(slope == 0.0, 1.0, slope)
        current -= step
        going = (np.abs(step) > TOLERANCE).any(axis=0)
        remaining = np.count_nonzero(going)
        if 2 * remaining < len(columns):
            # most have converged: continue with the others
            roots[:, columns] = current
            if not remaining:
                return
            current, columns = current[:, going], columns[going]
            diagonal, squares = diagonal[:, going], squares[:, going]
    roots[:, columns] = current


def _tridiagonal(matrices: Array) -> tuple[Array, Array]:
    """Diagonal (k, n) and squares of the subdiagonal (k - 1, n) of similar tridiagonal matrices."""
    size, _, count = matrices.shape
    diagonal, squares = np.empty((size, count)), np.empty((size - 1, count))
    block = matrices
    for step in range(size - 2):
        diagonal[step] = block[0, 0]
        column = block[1:, 0].copy()
        squares[step] = np.einsum("in,in->n", column, column)
        head = column[0].copy()
        column[0] += np.copysign(np.sqrt(squares[step]), head)
        half = squares[step] + np.abs(head) * np.sqrt(squares[step])
        inverse = np.where(half > 0.0, 1.0 / np.where(half > 0.0, half, 1.0), 0.0)
        inner = block[1:, 1:]
        product = np.einsum("ijn,jn->in", inner, column) * inverse
        product -= (0.5 * inverse * np.einsum("in,in->n", product, column)) * column
        update = column[:, None] * product
        block = inner - update
        block -= update.transpose(1, 0, 2)
    diagonal[-2:] = block[0, 0], block[1, 1]
    squares[-1] = np.square(block[1, 0])
    return diagonal, squares


def _polynomial(diagonal: Array, squares: Array, x: Array) -> tuple[Array, Array, Array]:
    """The characteristic polynomial of tridiagonal matrices at `x` with its first and second derivative."""
    # of degree 2, then up by the recurrence of the leading minors; half the second derivative saves a factor
    previous, factor = diagonal[0] - x, diagonal[1] - x
    value, slope, curve = factor * previous - squares[0], -factor - previous, np.ones_like(x)
    slope_before, curve_before, spare = np.full_like(x, -1.0), np.zeros_like(x), np.empty_like(x)
    for row in range(2, len(diagonal)):
        np.subtract(diagonal[row], x, out=factor)
        square = squares[row - 1]
        # the new minor takes the place of the one before the last
        for older, current, lower in (
            (curve_before, curve, slope),
            (slope_before, slope, value),
            (previous, value, None),
        ):
            older *= square
            np.multiply(factor, current, out=spare)
            np.subtract(spare, older, out=older)
            if lower is not None:
                older -= lower
        value, previous, slope, slope_before, curve, curve_before = (
            previous,
            value,
            slope_before,
            slope,
            curve_before,
            curve,
        )
    curve *= 2.0
    return value, slope, curve
