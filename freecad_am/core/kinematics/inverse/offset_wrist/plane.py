# SPDX-License-Identifier: LGPL-2.1-or-later
"""An arm with an offset wrist at angles of axis 6: the plane of its upper arm and forearm,
and the solution function.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ....types import Array, Index

TINY = 1e-150


@dataclass(frozen=True, eq=False)
class Curves:
    """Geometry of n poses, mm.

    `point` (3, 3, n) and `five` (3, 3, n) are constant, cosine and sine parts of the point
    where axes 4 and 5 meet, from axis 1 at the shoulder's height, and of the direction of
    axis 5, by components. `lean` is cosine and sine of the turn from the forearm to axis 4,
    `square` the cosine between axes 4 and 5; axis 2 is `ahead` of axis 1.
    """

    point: Array
    five: Array
    upper: float
    fore: float
    lean: tuple[float, float]
    square: float
    ahead: float = 0.0


class Spot(NamedTuple):
    """The arm for given angles of axis 6 (k,): sine and cosine of the plane, the point ahead and above in it, and the
    direction from elbow to point; axis 5 by its components; `value`: the function whose zeros are
    solutions; `along` (2, k): axis 4."""

    sine: Array
    cosine: Array
    ahead: Array
    above: Array
    fore_ahead: Array
    fore_above: Array
    five: list[Array]
    value: Array
    along: tuple[Array, Array]


class Plane(NamedTuple):
    """The values of `Spot` that do not depend on the elbow; `five` by its components."""

    sine: Array
    cosine: Array
    ahead: Array
    above: Array
    five: list[Array]


def geometry(curves: Curves, pose: Index, angle: Array, side: Array, bent: Array) -> Spot:
    """The arm at angles of axis 6 (k,), on a side, with sine and cosine (2, k) of the elbow's bend."""
    return spot_of(curves, plane_of(curves, pose, angle, side), bent)


def plane_of(curves: Curves, pose: Index, angle: Array, side: Array) -> Plane:
    """Return the arm at angles of axis 6 (k,) without its elbow."""
    cos, sin = np.cos(angle), np.sin(angle)
    x, y, above = (
        harmonics[0][pose] + cos * harmonics[1][pose] + sin * harmonics[2][pose]
        for harmonics in curves.point.transpose(1, 0, 2)
    )
    five = [
        harmonics[0][pose] + cos * harmonics[1][pose] + sin * harmonics[2][pose]
        for harmonics in curves.five.transpose(1, 0, 2)
    ]
    x = x + TINY
    ahead = side * np.sqrt(x * x + y * y)
    return Plane(y / ahead, x / ahead, ahead - curves.ahead, above, five)


def spot_of(curves: Curves, plane: Plane, bent: Array | tuple[Array, Array]) -> Spot:
    """The arm in its plane with sine and cosine (2, k) of the elbow's bend."""
    sine, cosine, ahead, above, five = plane
    # the forearm from the point: turned from the way to the shoulder by sine and cosine of the triangle
    squared = ahead * ahead + above * above + TINY
    common = (curves.fore + curves.upper * bent[1]) / squared
    turn = curves.upper * bent[0] / squared
    fore_ahead = common * ahead + turn * above
    fore_above = common * above - turn * ahead
    along = (
        fore_ahead * curves.lean[0] + fore_above * curves.lean[1],
        fore_above * curves.lean[0] - fore_ahead * curves.lean[1],
    )
    value = along[0] * (cosine * five[0] + sine * five[1]) + along[1] * five[2] - curves.square
    return Spot(sine, cosine, ahead, above, fore_ahead, fore_above, five, value, along)
