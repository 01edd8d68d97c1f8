# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a step of the joints from one cell of rotations to another takes at least."""

from __future__ import annotations

import numpy as np

from ...geometry.angles import shortest
from ...types import Array
from .cells import Cells

LEAST_SHARE, MOST_SHARE = 1e-5, 1.0


def least_steps(weights: Array, start: Cells, end: Cells, multiplier: tuple[float, float]) -> Array:
    """(n,) what sum over axes of weight (q_end - q_start)^2 + multiplier[0] s - multiplier[1] t cannot go below, for all
    rotations s of `start` and t of `end` within their cells, each from its middle; weights (axes,), n pairs of cells."""
    between = end.middle - start.middle
    between = shortest(between)
    off = start.off + end.off
    apart = np.maximum(0.0, np.abs(between) - start.half * np.abs(start.slope) - end.half * np.abs(end.slope) - off)
    alone = (apart * apart) @ weights - start.half * abs(multiplier[0]) - end.half * abs(multiplier[1])
    return np.maximum(alone, _together(weights, between, off, start, end, multiplier))


def _together(
    weights: Array, between: Array, off: Array, start: Cells, end: Cells, multiplier: tuple[float, float]
) -> Array:
    """The same by the least value of a parabola of s and t over the two cells, which knows that axes move together.

    For every share r: (|x| - off)^2 >= x^2 / (1 + r) - off^2 / r where |x| >= off, and 0 >= it elsewhere.
    """
    share = np.clip(off / np.maximum(np.abs(between) - off, 1e-300), LEAST_SHARE, MOST_SHARE)
    scaled = weights / (1.0 + share)
    constant = (between * between * scaled - off * off / share * weights).sum(axis=1)
    ss, tt = (start.slope**2 * scaled).sum(axis=1), (end.slope**2 * scaled).sum(axis=1)
    st = -(start.slope * end.slope * scaled).sum(axis=1)
    s = -2.0 * (between * start.slope * scaled).sum(axis=1) + multiplier[0]
    t = 2.0 * (between * end.slope * scaled).sum(axis=1) - multiplier[1]

    def value(at_s: Array | float, at_t: Array | float) -> Array:
        return np.asarray(constant + (ss * at_s + 2.0 * st * at_t + s) * at_s + (tt * at_t + t) * at_t)

    least = np.full(len(between), np.inf)
    for side in (-1.0, 1.0):
        at_s, at_t = side * start.half, side * end.half
        along_t = np.clip(-(t + 2.0 * st * at_s) / np.maximum(2.0 * tt, 1e-300), -end.half, end.half)
        along_s = np.clip(-(s + 2.0 * st * at_t) / np.maximum(2.0 * ss, 1e-300), -start.half, start.half)
        least = np.minimum(least, np.minimum(value(at_s, along_t), value(along_s, at_t)))
    determinant = ss * tt - st * st
    solved = np.maximum(determinant, 1e-300) * 2.0
    inner_s, inner_t = (st * t - tt * s) / solved, (st * s - ss * t) / solved
    inside = (determinant > 0.0) & (np.abs(inner_s) <= start.half) & (np.abs(inner_t) <= end.half)
    inner = value(np.where(inside, inner_s, 0.0), np.where(inside, inner_t, 0.0))
    return np.asarray(np.where(inside, np.minimum(least, inner), least))
