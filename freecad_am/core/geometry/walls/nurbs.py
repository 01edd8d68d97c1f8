# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tensor product B-spline surfaces, rational ones too, evaluated at many places at once (Piegl and Tiller, The NURBS Book,
algorithms A2.2 and A3.6). Beyond their knots they go on straight, so that a point may pass the surface's edge."""

from __future__ import annotations

import numpy as np

from ...types import Array, Index


def derivatives(
    knots: tuple[Array, Array], poles: Array, u: Array, v: Array
) -> tuple[Array, Array, Array]:
    """Return points and derivatives along u and v, each (n, 3), at the parameters u, v (n,).

    knots: for both directions, with the ends repeated. poles: (k, l, 4) as w x, w y, w z, w.
    """
    inside = [
        np.clip(parameter, *bounds(knot, poles.shape[axis]))
        for axis, (knot, parameter) in enumerate(zip(knots, (u, v)))
    ]
    point, along, around, twist = _rational(knots, poles, *inside)
    du, dv = (u - inside[0])[:, None], (v - inside[1])[:, None]
    if du.any() or dv.any():
        point = point + du * along + dv * around + du * dv * twist
        along, around = along + dv * twist, around + du * twist
    return point, along, around


def bounds(knots: Array, count: int) -> tuple[float, float]:
    """The range of the parameter of a direction with `count` poles."""
    degree = len(knots) - count - 1
    return float(knots[degree]), float(knots[count])


def _rational(
    knots: tuple[Array, Array], poles: Array, u: Array, v: Array
) -> tuple[Array, Array, Array, Array]:
    first_u, basis_u = _basis(knots[0], poles.shape[0], u)
    first_v, basis_v = _basis(knots[1], poles.shape[1], v)
    rows = first_u[:, None] + np.arange(basis_u.shape[2])
    columns = first_v[:, None] + np.arange(basis_v.shape[2])
    local = poles[rows[:, :, None], columns[:, None, :]]
    rows_summed = np.einsum("nap,npqk->naqk", basis_u.transpose(1, 0, 2), local)
    all_ = np.einsum("nbq,naqk->nabk", basis_v.transpose(1, 0, 2), rows_summed)
    weight = all_[:, 0, 0, 3:]
    point = all_[:, 0, 0, :3] / weight
    along = (all_[:, 1, 0, :3] - all_[:, 1, 0, 3:] * point) / weight
    around = (all_[:, 0, 1, :3] - all_[:, 0, 1, 3:] * point) / weight
    twist = (
        all_[:, 1, 1, :3]
        - all_[:, 1, 1, 3:] * point
        - all_[:, 1, 0, 3:] * around
        - all_[:, 0, 1, 3:] * along
    ) / weight
    return point, along, around, twist


def _basis(knots: Array, count: int, parameter: Array) -> tuple[Index, Array]:
    """Return the first of the degree + 1 relevant poles for each parameter (n,), and their
    shares.

    Shares are (2, n, degree + 1): for the point, for the derivative.
    """
    degree = len(knots) - count - 1
    span = np.clip(np.searchsorted(knots, parameter, side="right") - 1, degree, count - 1)
    values = np.ones((len(parameter), 1))
    lower = values
    for p in range(1, degree + 1):
        steps = np.arange(1, p + 1)
        to_left, right = (
            parameter[:, None] - knots[span[:, None] + 1 - steps],
            knots[span[:, None] + steps] - parameter[:, None],
        )
        share = values / (right + to_left[:, ::-1])
        lower = values
        values = np.zeros((len(parameter), p + 1))
        values[:, :-1] += right * share
        values[:, 1:] += to_left[:, ::-1] * share
    slopes = np.zeros_like(values)
    if degree:
        steps = np.arange(1, degree + 1)
        width = knots[span[:, None] + steps] - knots[span[:, None] + steps - degree]
        share = degree * lower / width
        slopes[:, 1:] += share
        slopes[:, :-1] -= share
    return span - degree, np.stack([values, slopes])
