# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parallel contours: the border's parallel curves, half a bead inside and then at the spacing, and their middle."""

from __future__ import annotations

from dataclasses import dataclass

from ..geometry.regions.region import Region
from ..geometry.regions.several import grow_regions, select_longer, shrink_region, subtract_regions
from .centre import centre_beads, outermost
from .curve import Beads, PlaneCurve, begun, contours_of


@dataclass(frozen=True)
class Levels:
    """regions[k]: those whose borders are the contours k; gaps[k]: what stays open inside of them, where it has room for the
    gap allowed."""

    regions: tuple[tuple[Region, ...], ...]
    gaps: tuple[tuple[Region, ...], ...]
    thin: list[PlaneCurve]  # beads in what is narrower than a bead


def levels(region: Region, inner: tuple[Region, ...], beads: Beads) -> Levels:
    """The contours of a region, each parallel to its border, not to the contour before, so that errors do not add. Contours
    too short are left open, for the beads in the middle. inner: where the middles of beads may lie."""
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
    found = levels(region, inner, beads)
    return rounds(found, beads) + centres(found, beads)


def rounds(found: Levels, beads: Beads) -> list[PlaneCurve]:
    """The contours, from outside in."""
    return [
        curve for k, regions in enumerate(found.regions) for curve in contours_of(regions, beads, k)
    ]


def centres(found: Levels, beads: Beads) -> list[PlaneCurve]:
    """The beads in what contours leave open, and in thin places."""
    curves = list(found.thin)
    for k, gaps in enumerate(found.gaps):
        curves += [
            begun(curve, beads) for curve in centre_beads(gaps, beads, k + 1, found.regions[0])
        ]
    return curves
