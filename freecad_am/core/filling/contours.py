# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parallel contours: the border's parallel curves, half a bead inside and then at the spacing, and their middle."""

from __future__ import annotations

from dataclasses import dataclass

from ..geometry.curves.plane_curve import length
from ..geometry.regions.region import Region
from .centre import centre_beads, necks, outermost, single_beads
from .curve import Beads, PlaneCurve, begun, long_enough


@dataclass(frozen=True)
class Levels:
    """rings[k]: the regions whose borders are the contours k; left[k]: what stays open inside of them, where it has room
    for the gap allowed."""

    rings: tuple[tuple[Region, ...], ...]
    left: tuple[tuple[Region, ...], ...]
    thin: tuple[Region, ...]  # the region, or necks of it, narrower than a bead


def levels(region: Region, beads: Beads) -> Levels:
    """The contours of a region, each parallel to its border, not to the contour before, so that errors do not add. Contours
    too short are left open, for the beads in the middle."""
    half, error = 0.5 * beads.spacing, beads.chord_error
    inner = outermost(region, beads)
    if not inner:
        return Levels((), (), (region,))
    thin = necks(region, inner, beads)
    rings, left = [], []
    k = 0
    while inner:
        rings.append(inner)
        open_ = region.grown(-beads.inset - (2 * k + 1) * half, error)
        inner = tuple(
            part for part in region.grown(-beads.inset - (2 * k + 2) * half, error)
            if length(part.rings()[0], True) >= beads.shortest
        )
        covered = [part for piece in inner for part in piece.grown(half, error)]
        left.append(tuple(part for piece in open_ for part in (piece.without(covered, beads.gap) if covered else (piece,))))
        k += 1
    return Levels(tuple(rings), tuple(left), thin)


def contours(region: Region, beads: Beads) -> list[PlaneCurve]:
    """Closed contours from outside in, then the beads in their middle. InfeasibleError THIN_REGION, see `Beads`."""
    found = levels(region, beads)
    curves = [
        begun(PlaneCurve(ring, True, "contour", k), beads)
        for k, parts in enumerate(found.rings) for part in parts for ring in part.rings()
    ]
    curves += middles(found, beads)
    return long_enough(curves, beads.shortest)


def middles(found: Levels, beads: Beads) -> list[PlaneCurve]:
    """The beads in what contours leave open, and in thin places."""
    curves = single_beads(found.thin, beads)
    for k, left in enumerate(found.left):
        curves += [begun(curve, beads) for curve in centre_beads(left, beads, k + 1, found.rings[0])]
    return curves
