# SPDX-License-Identifier: LGPL-2.1-or-later
"""Geometric Jacobians of arrays of joint vectors, and measures of distance from singularity.

A Jacobian mixes mm and rad, so every measure divides the translation rows by a characteristic
length in mm (errata to Chalvin 2020, eq. 6). The condition is sigma_min / sigma_max of the scaled
Jacobian: 1 is best, 0 is singular.

Internal arrays hold one matrix entry for all poses.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..types import Array, ArrayLike
from .chain import Chain

BATCH_SIZE = 4096  # poses per batch, to limit the memory of intermediate arrays


def jacobian(chain: Chain, q: ArrayLike, point: ArrayLike) -> Array:
    """Return the geometric Jacobians of a point of the last link.

    Parameters
    ----------
    chain : Chain
        The chain.
    q : (n, axes) array
        Joint values, rad or mm.
    point : (n, 3) or (3,) array
        Current position of the point in base_link, mm.

    Returns
    -------
    (n, 6, axes) array
        Three rows for velocity (mm), three for angular velocity (rad), per rad or mm of each
        joint, in base_link.
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
    """Return the inverse condition number of Jacobians.

    Parameters
    ----------
    jacobians : (n, 6, axes) array
        Jacobians in mm and rad.
    length : float
        Characteristic length that divides the translation rows, mm.

    Returns
    -------
    (n,) array
        sigma_min / sigma_max.

    Notes
    -----
    It uses the eigenvalues of J J^T, with an accuracy of about 1e-15 divided by the result.
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
        Characteristic length that divides the translation rows, mm.

    Returns
    -------
    (n,) array
        1 / (norm(J) norm(J^-1)) with Frobenius norms; 0 at a wrist singularity, where the block
        of the last three axes has no inverse.

    Notes
    -----
    The condition is at most 6 times the bound; for arms of usual proportions 1 to 2.5 times.
    """
    return _in_pieces(_frobenius, jacobians, length)


def condition_rate(jacobians: ArrayLike, rates: ArrayLike, length: float) -> Array:
    """Return the derivative of `condition` along joint rates.

    The Jacobian point moves with the last link. If the rates leave the point in place, as rotation
    about the tool axis does, the result also holds for a point fixed in base_link.

    Parameters
    ----------
    jacobians : (n, 6, 6) array
        Jacobians in mm and rad.
    rates : (n, 6) array
        Joint rates, rad per unit of the parameter.
    length : float
        Characteristic length that divides the translation rows, mm.

    Returns
    -------
    (n,) array
        Derivative with respect to the parameter; NaN where sigma_min is 0. For a double
        singular value it is one-sided and not unique.

    Notes
    -----
    It uses the singular vectors and the derivatives of the columns. Joint j rotates the columns
    after j, and moves the point of the columns before j.
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
    """Return the manipulability for Jacobians.

    Parameters
    ----------
    jacobians : (n, 6, 6) array
        Jacobians in mm and rad.
    length : float
        Characteristic length that divides the translation rows, mm.

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
    """Return the derivative of `manipulability` along joint rates.

    Parameters
    ----------
    jacobians : (n, 6, 6) array
        Jacobians in mm and rad.
    rates : (n, 6) array
        Joint rates, rad per unit of the parameter.
    length : float
        Characteristic length that divides the translation rows, mm.

    Returns
    -------
    (n,) array
        Derivative with respect to the parameter; NaN where J is singular.

    Notes
    -----
    It uses Jacobi's formula, d det J = det J tr(J^-1 dJ).
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
    """Apply `function` to scaled Jacobians (6, axes, m), in batches."""
    matrices = np.moveaxis(np.asarray(jacobians, float), 0, -1)
    result = np.empty(matrices.shape[2])
    for start in range(0, len(result), BATCH_SIZE):
        rows = slice(start, min(start + BATCH_SIZE, len(result)))
        scaled = np.array(matrices[:, :, rows], order="C")
        scaled[:3] *= 1.0 / length
        unknown = np.isnan(scaled).any(axis=(0, 1)) if np.isnan(scaled.max()) else None
        if unknown is not None:
            # LAPACK rejects NaN: replace NaN matrices by finite ones
            scaled[:, :, unknown] = np.eye(scaled.shape[0], scaled.shape[1])[:, :, None]
        result[rows] = function(scaled, rows) if with_slice else function(scaled)
        if unknown is not None:
            result[rows][unknown] = np.nan
    return result


def _rate(matrices: Array, rates: Array) -> Array:
    """Return the derivative (6, 6, n) of Jacobians along joint rates (6, n).

    d J_i / d q_j is (z_j x v_i, z_j x z_i) for j <= i and (z_i x v_j, 0) for j > i. v and z are the
    velocity and direction halves of the columns.
    """
    velocity, direction = matrices[:3], matrices[3:]
    turning = np.cumsum(direction * rates, axis=1)
    carried = velocity * rates
    carried = carried.sum(axis=1, keepdims=True) - np.cumsum(carried, axis=1)
    return np.concatenate(
        (_cross(turning, velocity) + _cross(direction, carried), _cross(turning, direction))
    )


def _frobenius(matrices: Array) -> Array:
    """Return 1 / (|J|_F |J^-1|_F) (n,) for J (6, 6, n) = [[A, B], [C, D]].

    The block inverse uses the inverses of D and of A - B D^-1 C.
    """
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
    """Return the sum of squared entries (n,) of matrices (k, k, n)."""
    result: Array = np.einsum("ijn,ijn->n", matrices, matrices)
    return result


def _product(a: Array, b: Array) -> Array:
    """Return the products (3, 3, n) of matrices (3, 3, n)."""
    result: Array = a[:, 0, None] * b[None, 0]
    spare = np.empty_like(result)
    for k in (1, 2):  # takes four fifths of the time of einsum
        result += np.multiply(a[:, k, None], b[None, k], out=spare)
    return result


def _inverse3(matrices: Array) -> Array:
    """Return the inverses of matrices (3, 3, n) by the adjugate.

    Cross products of the rows are the columns of the adjugate.
    """
    row_a, row_b, row_c = matrices
    adjugate = np.stack((_cross(row_b, row_c), _cross(row_c, row_a), _cross(row_a, row_b)), axis=1)
    adjugate *= 1.0 / np.einsum("in,in->n", row_a, adjugate[:, 0])
    return adjugate


def _cross(a: Array, b: Array) -> Array:
    """Return cross products (3, ...) along the first dimension."""
    result = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for row, (following, preceding) in enumerate(((1, 2), (2, 0), (0, 1))):
        np.multiply(a[following], b[preceding], out=result[row])
        result[row] -= a[preceding] * b[following]
    return result
