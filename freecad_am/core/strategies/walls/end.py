# SPDX-License-Identifier: LGPL-2.1-or-later
"""The front below the end of a wall: entire, or open stretches that end flush with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.walls.surface_wall import Placed
from ...slicing.tubes.smooth_spacing import WallLayer
from ...types import Array, Mask

SAME_END = 1e-6  # mm; a point above the end by no more than this is on it
FINER = 8  # samples per arc that distinguish above and below
HALVINGS = 48


@dataclass(frozen=True)
class Stretch:
    """A part of a front between two of its parameters; the closed one is the whole front."""

    front: WallLayer
    low: float
    high: float
    closed: bool

    def length(self, curve: SpaceCurve) -> float:
        """Its length, mm."""
        points = curve.at(np.linspace(self.low, self.high, 200))[0]
        return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def trimmed(surface: Placed, front: WallLayer, end: float) -> list[Stretch]:
    """The stretches of a front below u = end, in the order of their parameter; empty if the front is above."""
    curve = front.curve
    w = curve.refined(FINER)
    inside = _below(surface, front, w, end)
    if inside.all():
        return [Stretch(front, float(w[0]), float(w[-1]), True)]
    if not inside.any():
        return []
    start = int(np.flatnonzero(~inside)[0])
    count = len(w) - 1
    order = np.r_[start:count, 0 : start + 1]
    w = w[order] + np.where(np.arange(count + 1) >= count - start, curve.period, 0.0)
    inside = inside[order]
    enters, leaves = (
        np.flatnonzero(~inside[:-1] & inside[1:]),
        np.flatnonzero(inside[:-1] & ~inside[1:]),
    )
    low = _crossing(surface, front, w[enters], w[enters + 1], end, True)
    high = _crossing(surface, front, w[leaves], w[leaves + 1], end, False)
    return [Stretch(front, float(a), float(b), False) for a, b in zip(low, high, strict=True)]


def _below(surface: Placed, front: WallLayer, w: Array, end: float) -> Mask:
    """Mask of the positions (n,) of a front below the end. Where u is an angle, as along a bend, the front decides the turn of a
    position: a surface knows its own points only up to whole turns.
    """
    u, v = surface.inverse(front.curve.at(w)[0])
    rate = np.linalg.norm(surface.derivatives(u, v)[1], axis=1)
    if surface.rise_period is not None:
        about = front.heights(surface, front.curve.wrap(w))[0]
        u = u + surface.rise_period * np.round((about - u) / surface.rise_period)
    below: Mask = (u - end) * rate <= SAME_END
    return below


def _crossing(
    surface: Placed, front: WallLayer, low: Array, high: Array, end: float, entering: bool
) -> Array:
    """Where the front passes the end between two parameters, on the side below it."""
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        below = _below(surface, front, middle, end) == entering
        low, high = np.where(below, low, middle), np.where(below, middle, high)
    return high if entering else low
