# SPDX-License-Identifier: LGPL-2.1-or-later
"""A region hardly wider than a bead: one ring that feeds as much as the region holds.

A contour half a bead inside the border of such a region is so short that its bead overlaps itself in the middle: it covers
the region and feeds too little. A ring nearer to the border is longer. The filling takes the one that feeds the region's
area, as wide as a bead; its deposit flows to the middle.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from scipy.optimize import brentq

from ..geometry.curves.plane_curve import length
from ..geometry.regions.region import Region
from ..types import Array
from .centre import dot
from .curve import Beads, PlaneCurve, start_curve

LESS = 0.98  # of the area of a region; what feeds less is not enough
EXACT = 1e-4  # of half a bead's width


def balanced(region: Region, curves: Sequence[PlaneCurve], beads: Beads) -> list[PlaneCurve]:
    """The curves that fill a region, or one ring instead of a single curve no farther from the middle than it is wide that feeds too
    little; a dot if that ring is too short for a bead.
    """
    if len(curves) > 1 or any(curve.dot for curve in curves) or len(region.borders()) > 1:
        return list(curves)
    fed = sum(2.0 * beads.inset * length(curve.points, curve.closed) for curve in curves)
    if region.area > math.pi * (2.0 * beads.inset) ** 2 or fed >= LESS * region.area:
        return list(curves)
    if not region.grown(-beads.inset, beads.chord_error):
        return list(curves)  # narrower than a bead, which has rules of its own
    ring = _ring(region, beads)
    if ring is None:
        return list(curves)
    if length(ring, True) < beads.shortest:
        return [dot(region, beads)]
    return [start_curve(PlaneCurve(ring, True, "contour", 0, dot=True), beads)]


def _ring(region: Region, beads: Beads) -> Array | None:
    """The parallel curve (n, 2) inside the border of a region that feeds its area; None unless it is one piece."""

    def inside(depth: float) -> Array | None:
        regions = region.grown(-depth, beads.chord_error)
        return regions[0].borders()[0] if len(regions) == 1 else None

    def lacking(depth: float) -> float:
        border = inside(depth)
        return 0.0 if border is None else region.area - 2.0 * beads.inset * length(border, True)

    if not lacking(0.0) < 0.0 < lacking(beads.inset):
        return None
    return inside(float(brentq(lacking, 0.0, beads.inset, xtol=EXACT * beads.inset)))
