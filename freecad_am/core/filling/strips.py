# SPDX-License-Identifier: LGPL-2.1-or-later
"""Filling of regions that run all the way round a hub: contours from both borders, and beads in their middle.

Closed beads that go round close over the period of the plane: `PlaneCurve.turns` tells which way.
"""

from __future__ import annotations

import math

import numpy as np

from ..geometry.regions.medial import spine
from ..geometry.regions.region import Region, simplified
from ..geometry.regions.several import grown
from ..geometry.regions.strip import Strip
from ..issues import InfeasibleError
from .centre import FINE, centre_beads
from .curve import Beads, PlaneCurve, begun, contours_of, long_enough
from .strip_closing import strip_closing

AFRESH = 4  # contours made from the same borders; farther in, windows would get too narrow and errors are small yet


def strip_contours(strip: Strip, inner: tuple[Strip | Region, ...], beads: Beads) -> list[PlaneCurve]:
    """As `contours`: from both borders and from the holes inwards, then what they leave open."""
    half, error = 0.5 * beads.spacing, beads.chord_error
    curves: list[PlaneCurve] = []
    start: tuple[Strip | Region, ...] = (strip,)
    k = first = 0
    while inner:
        curves += contours_of(inner, beads, k)
        if k - first == AFRESH:
            start, first = grown(inner, -half, error), k + 1
        k += 1
        before, inner = inner, grown(start, -(half if first else beads.inset) - 2 * (k - first) * half, error)
    for part in grown(before, -half, error):
        if isinstance(part, Strip) and part.grown(-0.5 * beads.gap, error):
            curves += _centre(part, beads, k)
    curves = long_enough(curves, beads.shortest)
    return curves + [begun(curve, beads) for curve in strip_closing(strip, curves, beads, k, "centre")]


def _centre(strip: Strip, beads: Beads, ring: int) -> list[PlaneCurve]:
    """A bead round the hub in the middle of a thin strip."""
    turn = strip.period.around
    width = strip.levels[1] - strip.levels[0]
    margin = min(2.0 * width + beads.spacing, 0.5 * turn)
    largest = max(strip.between(-0.5 * turn - margin, 0.5 * turn + margin), key=lambda part: part.area)
    points, _ = spine(largest, 0.25 * beads.gap, FINE * beads.spacing)
    if len(points) and points[0, 0] > points[-1, 0]:
        points = points[::-1]
    if not len(points) or points[0, 0] > -0.5 * turn or points[-1, 0] < 0.5 * turn:  # somewhere too narrow for a bead
        halves = [part for k in (-0.5, 0.0) for part in strip.flat(k * turn, (k + 0.5) * turn)]
        return centre_beads(halves, beads, ring, ())
    points = simplified(points, 0.2 * beads.chord_error)
    v = np.interp(-0.5 * turn, points[:, 0], points[:, 1])
    within = points[(points[:, 0] > -0.5 * turn) & (points[:, 0] < 0.5 * turn)]
    if not math.isinf(strip.period.apex):  # what is straight in (u, v) is an arc on the plane
        count = strip.period.points_round(0.5 * sum(strip.levels), beads.chord_error, beads.spacing)
        u = np.union1d(within[:, 0], -0.5 * turn + turn / count * np.arange(1, count))
        within = np.stack([u, np.interp(u, points[:, 0], points[:, 1])], axis=1)
    flat = strip.period.unroll(np.vstack([[[-0.5 * turn, v]], within]))
    sense = -1 if beads.clockwise else 1
    return [PlaneCurve(flat[::-1] if beads.clockwise else flat, True, "centre", ring, sense)]


def single(strip: Strip, beads: Beads) -> list[PlaneCurve]:
    """One bead in the middle of a strip narrower than a bead. InfeasibleError THIN_REGION where none is wanted."""
    if beads.thin == "refuse":
        raise InfeasibleError(
            "THIN_REGION", "filling", "a region round the hub is nowhere as wide as a bead ({:.3g} mm); choose thin = "
            "single, a narrower bead or a margin", 2.0 * beads.inset,
        )
    return _centre(strip, beads, 0)
