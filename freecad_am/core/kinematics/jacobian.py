# SPDX-License-Identifier: LGPL-2.1-or-later
"""The geometric Jacobian over arrays of joint vectors, and its distance from singularity.

A Jacobian mixes mm and rad, so every measure takes a characteristic length in mm that
divides the translation rows (errata to Chalvin 2020, eq. 6). The condition is sigma_min /
sigma_max of the scaled Jacobian: 1 is best, 0 is singular.

Internally an array holds one entry of the matrices of all poses.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..types import Array, ArrayLike
from .chain import Chain

BATCH_SIZE = 4096  # poses: limits the memory of intermediate arrays


def jacobian(chain: Chain, q: ArrayLike, point: ArrayLike) -> Array:
    """Return the geometric Jacobians of a point of the last link.

    Parameters
    ----------
    chain : Chain
        The chain.
    q : (n, axes) array
        Joint values, rad or mm.
    point : (n, 3) or (3,) array
        The current position of the point in base_link, mm.

    Returns
    -------
    (n, 6, axes) array
        Rows: velocity in mm and angular velocity in rad, per rad or mm of each joint, in
        base_link.
    """
    angles = np.asarray(q, float)
    count = len(angles)
    points = np.ascontiguousarray(np.broadcast_to(np.asarray(point, float), (count, 3)).T)
    result = np.empty((6, chain.axes, count))
    for start in range(0, count, BATCH_SIZE):
        rows_now = slice(start, start + BATCH_SIZE)
        direction, origin = chain.axes_at(angles[rows_now])
        arm = np.subtract(points[:, rows_now], origin, out=origin)
        for row, (following, column_2) in enumerate(((1, 2), (2, 0), (0, 1))):
            np.multiply(direction[:, following], arm[:, column_2], out=result[row, :, rows_now])
            result[row, :, rows_now] -= direction[:, column_2] * arm[:, following]
            result[3 + row, :, rows_now] = direction[:, row]
        for joint in np.flatnonzero(chain.sliding):
            result[:3, joint, rows_now], result[3:, joint, rows_now] = direction[joint], 0.0
    return result.transpose(2, 0, 1)


def condition(jacobians: ArrayLike, length: float) -> Array:
    """Return the ratio of the smallest to the largest singular value.

    Parameters
    ----------
    jacobians : (n, 6, axes) array
        Jacobians in mm and rad.
    length : float
        Characteristic length that divides the rows of translation, mm.

    Returns
    -------
    (n,) array
        sigma_min / sigma_max.

    Notes
    -----
    Computed from the eigenvalues of J J^T: accurate to about 1e-15 divided by the condition
    itself.
    """

    def compute_batch(scaled: Array) -> Array:
        products = np.einsum("ikn,jkn->ijn", scaled, scaled)
        values = np.linalg.eigvalsh(products.transpose(2, 0, 1))
        result: Array = np.sqrt(np.maximum(values[:, 0], 0.0) / values[:, -1])
        return result

    return _in_pieces(compute_batch, jacobians, length)


def condition_bound(jacobians: ArrayLike, length: float) -> Array:
    """Return a lower bound of `condition` at a fraction of its cost.

    Parameters
    ----------
    jacobians : (n, 6, 6) array
        Jacobians in mm and rad.
    length : float
        Characteristic length that divides the rows of translation, mm.

    Returns
    -------
    (n,) array
        1 / (norm(J) norm(J^-1)) with Frobenius norms; 0 where the last three axes have no
        common inverse, at the wrist's singularity.

    Notes
    -----
    The condition is at most 6 times the bound, for arms of the usual proportions 1 to 2.5
    times.
    """
    return _in_pieces(_frobenius, jacobians, length)


def condition_rate(jacobians: ArrayLike, rates: ArrayLike, length: float) -> Array:
    """Return the derivative of `condition` while the joints move.

    The point moves with the last link. If the rates leave it in place, as the rotation about
    the tool axis does, a point fixed in the base frame gives the same.

    Parameters
    ----------
    jacobians : (n, 6, 6) array
        Jacobians in mm and rad.
    rates : (n, 6) array
        Joint rates, rad per unit of the parameter.
    length : float
        Characteristic length that divides the rows of translation, mm.

    Returns
    -------
    (n,) array
        Derivative by the parameter; NaN where sigma_min is 0. For a double singular value
        it is one-sided and not unique.

    Notes
    -----
    Computed from the singular vectors and the derivative of the columns: joint j turns the
    columns after it, and moves the point of the columns before it.
    """
    rates = np.asarray(rates, float).T

    def compute_batch(scaled: Array, rows: slice) -> Array:
        change = _rate(scaled, rates[:, rows])
        values, vectors = np.linalg.eigh(np.einsum("ikn,jkn->nij", scaled, scaled))
        halves = []
        for extreme in (0, -1):
            vector = np.ascontiguousarray(vectors[:, :, extreme].T)
            # d(sigma^2) = 2 u^T dJ J^T u
            product = np.einsum("in,ikn->kn", vector, change) * np.einsum(
                "in,ikn->kn", vector, scaled
            )
            halves.append(product.sum(axis=0))
        low, high = values[:, 0], values[:, -1]
        with np.errstate(invalid="ignore", divide="ignore"):
            result: Array = np.sqrt(low / high) * (halves[0] / low - halves[1] / high)
        return result

    return _in_pieces(compute_batch, jacobians, length, with_slice=True)


def manipulability(jacobians: ArrayLike, length: float) -> Array:
    """Return the manipulability of Jacobians.

    Parameters
    ----------
    jacobians : (n, 6, 6) array
        Jacobians in mm and rad.
    length : float
        Characteristic length that divides the rows of translation, mm.

    Returns
    -------
    (n,) array
        sqrt(det(J J^T)).

    References
    ----------
    Yoshikawa 1985.
    """

    def compute_batch(scaled: Array) -> Array:
        result: Array = np.abs(np.linalg.det(scaled.transpose(2, 0, 1)))
        return result

    return _in_pieces(compute_batch, jacobians, length)


def manipulability_rate(jacobians: ArrayLike, rates: ArrayLike, length: float) -> Array:
    """Return the derivative of `manipulability` while the joints move.

    Parameters
    ----------
    jacobians : (n, 6, 6) array
        Jacobians in mm and rad.
    rates : (n, 6) array
        Joint rates, rad per unit of the parameter.
    length : float
        Characteristic length that divides the rows of translation, mm.

    Returns
    -------
    (n,) array
        Derivative by the parameter; NaN where J is singular.

    Notes
    -----
    Jacobi's formula, d det J = det J tr(J^-1 dJ).
    """
    rates = np.asarray(rates, float).T

    def compute_batch(scaled: Array, rows: slice) -> Array:
        matrices = np.ascontiguousarray(scaled.transpose(2, 0, 1))
        size = np.abs(np.linalg.det(matrices))
        singular = size == 0.0
        matrices[singular] = np.eye(6)
        relative: Array = np.einsum(
            "nij,jin->n", np.linalg.inv(matrices), _rate(scaled, rates[:, rows])
        )
        relative[singular] = np.nan
        relative *= size
        return relative

    return _in_pieces(compute_batch, jacobians, length, with_slice=True)


def _in_pieces(
    function: Callable[..., Array],
    jacobians: ArrayLike,
    length: float,
    with_slice: bool = False,
) -> Array:
    """Return `function` of scaled Jacobians (6, axes, m), in batches."""
    matrices = np.moveaxis(np.asarray(jacobians, float), 0, -1)
    result = np.empty(matrices.shape[2])
    for start in range(0, len(result), BATCH_SIZE):
        rows = slice(start, min(start + BATCH_SIZE, len(result)))
        scaled = np.array(matrices[:, :, rows], order="C")
        scaled[:3] *= 1.0 / length
        unknown = np.isnan(scaled).any(axis=(0, 1)) if np.isnan(scaled.max()) else None
        if unknown is not None:
            # LAPACK rejects NaN: replace it by any finite matrix
            scaled[:, :, unknown] = np.eye(scaled.shape[0], scaled.shape[1])[:, :, None]
        result[rows] = function(scaled, rows) if with_slice else function(scaled)
        if unknown is not None:
            result[rows][unknown] = np.nan
    return result


def _rate(matrices: Array, rates: Array) -> Array:
    """The derivative (6, 6, n) of Jacobians along joint rates (6, n).

    d J_i / d q_j is (z_j x v_i, z_j x z_i) for j <= i, and (z_i x v_j, 0) for j > i, with v and z the columns' halves.
    """
    velocity, direction = matrices[:3], matrices[3:]
    turning = np.cumsum(direction * rates, axis=1)
    carried = velocity * rates
    carried = carried.sum(axis=1, keepdims=True) - np.cumsum(carried, axis=1)
    return np.concatenate(
        (_cross(turning, velocity) + _cross(direction, carried), _cross(turning, direction))
    )


def _frobenius(matrices: Array) -> Array:
    """1 / (|J|_F |J^-1|_F) (n,) of (6, 6, n), by blocks: [[A, B], [C, D]] with the inverse of D and of A - B D^-1 C."""
    upper_right, lower_left = matrices[:3, 3:], matrices[3:, :3]
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        wrist = _inverse3(matrices[3:, 3:])
        carried = _product(upper_right, wrist)
        arm = _inverse3(matrices[:3, :3] - _product(carried, lower_left))
        right = _product(arm, carried)
        below = _product(wrist, lower_left)
        lower_block = _product(below, arm)
        wrist += _product(lower_block, carried)
        squares = [_squared_norm(block) for block in (arm, right, lower_block, wrist)]
        bound = 1.0 / np.sqrt(_squared_norm(matrices) * sum(squares))
    bound[np.isnan(bound)] = 0.0
    return np.asarray(bound)


def _squared_norm(matrices: Array) -> Array:
    """The sums of squares (n,) of the entries of matrices (k, k, n)."""
    result: Array = np.einsum("ijn,ijn->n", matrices, matrices)
    return result


def _product(a: Array, b: Array) -> Array:
    """Products (3, 3, n) of matrices (3, 3, n)."""
    result: Array = a[:, 0, None] * b[None, 0]
    spare = np.empty_like(result)
    for k in (1, 2):  # as einsum does it, in four fifths of its time
        result += np.multiply(a[:, k, None], b[None, k], out=spare)
    return result


def _inverse3(matrices: Array) -> Array:
    """Inverses of matrices (3, 3, n): the cross products of the rows are the columns of the adjugate."""
    row_a, row_b, row_c = matrices
    adjugate = np.stack((_cross(row_b, row_c), _cross(row_c, row_a), _cross(row_a, row_b)), axis=1)
    adjugate *= 1.0 / np.einsum("in,in->n", row_a, adjugate[:, 0])
    return adjugate


def _cross(a: Array, b: Array) -> Array:
    """Cross products (3, ...) of vectors along the first dimension."""
    result = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for row, (following, preceding) in enumerate(((1, 2), (2, 0), (0, 1))):
        np.multiply(a[following], b[preceding], out=result[row])
        result[row] -= a[preceding] * b[following]
    return result
