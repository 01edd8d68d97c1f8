# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plane curves sampled until cubic Hermite arcs between the samples are as good as the curve itself."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from ...types import Array, ArrayLike, Mask
from .profile import arc_lengths

Curve = Callable[[Array], tuple[Array, Array]]

TANGENT_TOLERANCE = 8e-9  # before the last halving, which brings it to 1e-9
POINT_TOLERANCE = 1e-8  # mm
ROUNDS = (
    14  # halvings; a curve that needs more has a corner inside, which `breaks` should have named
)


def sample_curve(curve: Curve, breaks: ArrayLike) -> tuple[Array, Array]:
    """Sample points (n, 2) and unit tangents (n, 2) along the curve from the first break to the
    last.

    curve: parameters (n,) -> points (n, 2), tangents (n, 2) of any length. breaks: rising
    parameters between which the curve is smooth. Intervals are halved until the middle of the
    Hermite arc over the whole interval meets the curve, so the halves are better still (by 8
    in the tangent, 16 in the point). Raises ValueError if the curve has no speed.
    """
    t = _initial(np.asarray(breaks, dtype=np.float64))
    points, tangents = _evaluate(curve, t)
    rough = np.ones(len(t) - 1, dtype=bool)
    for _ in range(ROUNDS):
        middle = 0.5 * (t[:-1] + t[1:])[rough]
        new_points, new_tangents = _evaluate(curve, middle)
        i = np.flatnonzero(rough)
        fine = _agrees(
            points[i], tangents[i], points[i + 1], tangents[i + 1], new_points, new_tangents
        )
        t, points, tangents = (
            np.insert(have, i + 1, new, axis=0)
            for have, new in ((t, middle), (points, new_points), (tangents, new_tangents))
        )
        rough = np.repeat(rough, np.where(rough, 2, 1))
        rough[rough] = ~np.repeat(fine, 2)
        if not rough.any():
            break
    return points, tangents


def _initial(breaks: Array) -> Array:
    inner = [np.linspace(a, b, 5)[:-1] for a, b in pairwise(breaks)]
    start: Array = np.concatenate([*inner, breaks[-1:]])
    return start


def _evaluate(curve: Curve, t: Array) -> tuple[Array, Array]:
    points, tangents = curve(t)
    size = np.linalg.norm(tangents, axis=1, keepdims=True)
    if not size.min() > 0.0:
        raise ValueError("the curve has no direction at one of its points")
    return points, tangents / size


def _agrees(p: Array, a: Array, q: Array, b: Array, middle: Array, tangent: Array) -> Mask:
    start_length = _lengths(p, a, middle, tangent)
    length = start_length + _lengths(middle, tangent, q, b)
    u = (start_length / length)[:, None]
    a, b, d = a * length[:, None], b * length[:, None], q - p
    point = p + u * (a + u * (3.0 * d - 2.0 * a - b + u * (a + b - 2.0 * d)))
    off = np.linalg.norm(point - middle, axis=1)
    # the error of a cubic's slope is largest off the middle, 3.1 times its largest position error over its length
    good: Mask = (off < POINT_TOLERANCE) & (3.1 * off < TANGENT_TOLERANCE * length + 1e-12)
    return good


def _lengths(p: Array, a: Array, q: Array, b: Array) -> Array:
    pairs = np.stack([p, q], axis=1).reshape(-1, 2)
    return arc_lengths(pairs, np.stack([a, b], axis=1).reshape(-1, 2))[::2]


def line(start: ArrayLike, end: ArrayLike) -> tuple[Array, Array]:
    """Samples of a straight segment: its two ends with the tangent between them."""
    points = np.array([start, end], dtype=np.float64)
    along = points[1] - points[0]
    return points, np.tile(along / np.linalg.norm(along), (2, 1))


def arc(centre: ArrayLike, radius: float, start: float, end: float) -> tuple[Array, Array]:
    """Samples of a circular arc from the angle start to the angle end (rad, either may be larger)."""
    middle = np.asarray(centre, dtype=np.float64)
    sign = 1.0 if end > start else -1.0

    def circle(t: Array) -> tuple[Array, Array]:
        around = np.stack([np.cos(t), np.sin(t)], axis=1)
        return middle + radius * around, sign * np.stack([-around[:, 1], around[:, 0]], axis=1)

    low, high = sorted((start, end))
    points, tangents = sample_curve(circle, [low, high])
    return (points, tangents) if sign > 0.0 else (points[::-1], tangents[::-1])
