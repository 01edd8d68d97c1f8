# SPDX-License-Identifier: LGPL-2.1-or-later
"""Filling of regions that run all the way round a hub: contours from both borders, and beads in their middle.

Closed beads that go round close over the period of the plane: `PlaneCurve.turns` gives the sense.
"""

from __future__ import annotations

from ..geometry.regions.medial import spine_round
from ..geometry.regions.region import Region
from ..geometry.regions.several import grow_regions, halves
from ..geometry.regions.strip import Strip
from ..issues import InfeasibleError
from .centre import FINE, centre_beads
from .curve import Beads, PlaneCurve, contours_of, long_enough, start_curve
from .strip_closing import strip_closing

AFRESH = 4  # contours made from the same borders; farther in, windows would get too narrow and errors are small yet


def strip_contours(
    strip: Strip, inner: tuple[Strip | Region, ...], beads: Beads
) -> list[PlaneCurve]:
    """Contours as in `contours`: from both borders and from the holes inwards, then beads in the gaps; one bead in the middle of a
    strip narrower than a bead. InfeasibleError THIN_REGION if beads refuse thin regions.
    """
    if not inner and beads.thin == "refuse":
        raise InfeasibleError(
            "THIN_REGION",
            "filling",
            "a region around the hub is narrower than a bead ({:.3g} mm) everywhere; use thin = "
            "single, a narrower bead or a margin",
            2.0 * beads.inset,
        )
    if not inner:
        return _centre(strip, beads, 0)
    half, error = 0.5 * beads.spacing, beads.chord_error
    curves: list[PlaneCurve] = []
    start: tuple[Strip | Region, ...] = (strip,)
    k = first_ring = 0
    while inner:
        curves += contours_of(inner, beads, k)
        if k - first_ring == AFRESH:
            start, first_ring = grow_regions(inner, -half, error), k + 1
        k += 1
        last_inner, inner = (
            inner,
            grow_regions(
                start, -(half if first_ring else beads.inset) - 2 * (k - first_ring) * half, error
            ),
        )
    for region in grow_regions(last_inner, -half, error):
        if isinstance(region, Strip) and region.grown(-0.5 * beads.gap, error):
            curves += _centre(region, beads, k)
    curves = long_enough(curves, beads.shortest)
    return curves + [
        start_curve(curve, beads) for curve in strip_closing(strip, curves, beads, k, "centre")
    ]


def _centre(strip: Strip, beads: Beads, ring: int) -> list[PlaneCurve]:
    """A bead round the hub in the middle of a thin strip."""
    points = spine_round(
        strip, 0.25 * beads.gap, FINE * beads.spacing, beads.chord_error, beads.spacing
    )
    if points is None:  # somewhere too narrow for a bead
        return centre_beads(halves(strip), beads, ring, ())
    return [
        PlaneCurve(
            points[:: -1 if beads.clockwise else 1],
            True,
            "centre",
            ring,
            -1 if beads.clockwise else 1,
        )
    ]
