# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parallel contours: the border's parallel curves, half a bead inside and then at the spacing, and their middle."""

from __future__ import annotations

from dataclasses import dataclass

from ..geometry.regions.region import Region
from ..geometry.regions.several import grow_regions, select_longer, shrink_region, subtract_regions
from .centre import centre_beads, outermost
from .curve import Beads, PlaneCurve, contours_of, start_curve


@dataclass(frozen=True)
class Levels:
    """regions[k]: the regions whose borders are the contours k; gaps[k]: the open regions inside that have room for the allowed gap."""

    regions: tuple[tuple[Region, ...], ...]
    gaps: tuple[tuple[Region, ...], ...]
    thin: list[PlaneCurve]  # beads in regions narrower than a bead


def levels(region: Region, inner: tuple[Region, ...], beads: Beads) -> Levels:
    """The contours of a region, each parallel to its border, not to the contour before, so that errors do not add. Short contours are
    left out, for the beads in the middle. inner: allowed positions of bead middles.
    """
    half, error = 0.5 * beads.spacing, beads.chord_error
    inner, thin = outermost(region, inner, beads)
    regions, gaps = [], []
    k = 0
    while inner:
        regions.append(inner)
        open_ = region.grown(-beads.inset - (2 * k + 1) * half, error)
        inner = select_longer(
            shrink_region(region, beads.inset + (2 * k + 2) * half, error), beads.shortest
        )
        gaps.append(subtract_regions(open_, grow_regions(inner, half, error), beads.gap))
        k += 1
    return Levels(tuple(regions), tuple(gaps), thin)


def contours(region: Region, inner: tuple[Region, ...], beads: Beads) -> list[PlaneCurve]:
    """Closed contours from outside in, then the beads in their middle. InfeasibleError THIN_REGION, see `Beads`."""
    contour_levels = levels(region, inner, beads)
    return rounds(contour_levels, beads) + centres(contour_levels, beads)


def rounds(contour_levels: Levels, beads: Beads) -> list[PlaneCurve]:
    """The contours, from outside in."""
    return [
        curve
        for k, regions in enumerate(contour_levels.regions)
        for curve in contours_of(regions, beads, k)
    ]


def centres(contour_levels: Levels, beads: Beads) -> list[PlaneCurve]:
    """The beads in the gaps of contours, and in thin places."""
    curves = list(contour_levels.thin)
    for k, gaps in enumerate(contour_levels.gaps):
        curves += [
            start_curve(curve, beads)
            for curve in centre_beads(gaps, beads, k + 1, contour_levels.regions[0])
        ]
    return curves
