# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads narrower or wider than usual, so that contours come out even over the thickness of a region."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..geometry.curves.plane_curve import dense, nearest
from ..geometry.regions.region import WIDTH, Region
from .curve import Beads, PlaneCurve

MORE = 1.002  # of the thickness, beside what the measure of it may be short of: a contour in the middle is not a thin loop
PLACES = 0.25  # of the spacing, mm between places at which widths are looked at
MIDDLE = ("centre", "closing")  # kinds of beads that lie in what others leave


def fitted(region: Region, beads: Beads, least: float, most: float) -> tuple[Beads, float]:
    """Beads of which a whole number fits into the thickest place of a region, and their share of the usual width, between
    least and most and as near to 1 as may be; the usual ones where there is no such number."""
    if least == most:
        return beads, 1.0
    width, thickness = 2.0 * beads.inset, MORE * (1.0 + WIDTH) * region.width
    excess = (thickness - width) / beads.spacing  # so many more than one
    share = 1.0
    if excess > 0.0:
        count = np.arange(max(int(excess) - 1, 0), int(excess) + 3)
        shares = thickness / (width + count * beads.spacing)
        share = float(shares[np.argmin(np.abs(np.log(shares)))])
    if not least <= share <= most * MORE * (1.0 + WIDTH):
        share = 1.0
    return replace(beads, spacing=share * beads.spacing, width=share * width, gap=share * beads.gap), share


def shared(
    region: Region, curves: Sequence[PlaneCurve], beads: Beads, share: float, least: float, most: float
) -> tuple[PlaneCurve, ...]:
    """The curves with the share of the usual width that each of their points has: that of the fitted beads, of those in the
    middle what room their neighbours leave them. Between least and most."""
    if least == most:
        return tuple(curves)
    others = [curve for curve in curves if curve.kind not in MIDDLE]
    found = []
    for curve in curves:
        if curve.kind in MIDDLE:
            curve = _within_width(curve, others, region, beads, share, least, most)
        elif share != 1.0:
            curve = replace(curve, share=share * (np.ones(len(curve.points)) if curve.share is None else curve.share))
        found.append(curve)
    return tuple(found)


def _within_width(
    curve: PlaneCurve, others: Sequence[PlaneCurve], region: Region, beads: Beads, share: float, least: float, most: float
) -> PlaneCurve:
    """A bead with points as dense as its width may change, as wide as the room about it."""
    step = PLACES * beads.spacing
    if curve.closed:
        points = dense(curve.points, step)
    else:  # there and back is a ring, of which the way there is the first half
        points = dense(np.vstack([curve.points, curve.points[-2:0:-1]]), step)
        points = points[: int(np.argmin(np.abs(points - curve.points[-1]).sum(axis=1))) + 1]
    free = region.nearest(points)[1] / beads.inset
    for other in others:
        free = np.minimum(free, 2.0 * nearest(other.points, points, other.closed).distance / beads.spacing - 1.0)
    return replace(curve, points=points, share=np.clip(share * free, least, most))
