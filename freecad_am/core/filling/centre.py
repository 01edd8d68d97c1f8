# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads in what other beads leave open: along the middle of it, until no gap is wider than stated."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..geometry.medial import spine
from ..geometry.plane_curve import Array
from ..geometry.region import Region, along, simplified
from ..issues import InfeasibleError
from .curve import Beads, PlaneCurve

ROUNDS = 12  # of beads within one gap
FINE = 0.04  # of the spacing, mm between the places that the middle is found from
ENDS = 0.5  # of the gap; a bead in it ends where it is that narrow


def centre_beads(left: Sequence[Region], beads: Beads, ring: int, inner: Sequence[Region] = ()) -> list[PlaneCurve]:
    """Open beads along the middle of regions left open, or closed ones where those go round; no gap stays wider than stated.

    inner: where the middles of beads may lie; beads are moved there. Without it anywhere in the regions.
    """
    found: list[PlaneCurve] = []
    for _ in range(ROUNDS):
        left = [region for region in left if region.grown(-0.5 * beads.gap, beads.chord_error)]
        rest: list[Region] = []
        for region in left:
            points, closed = _middle(region, beads, 0.5 * ENDS * beads.gap)
            if len(points) < 2:
                continue
            if inner:
                points = _moved(points, inner)
            found.append(PlaneCurve(points, closed, "centre", ring))
            rest += region.without(along([(points, closed)], 0.5 * beads.spacing, beads.chord_error))
        left = rest
        if not left:
            break
    return found


def single_beads(thin: Sequence[Region], beads: Beads) -> list[PlaneCurve]:
    """One bead along the middle of each region narrower than a bead. InfeasibleError THIN_REGION where none is wanted."""
    found = []
    for region in thin:
        if beads.thin == "refuse":
            raise InfeasibleError(
                "THIN_REGION", "filling", f"the region at {region.where()} is {region.width:.3g} mm wide, less than a bead "
                f"({beads.spacing:.3g} mm); choose thin = single, a smaller bead spacing or a margin",
            )
        points, closed = _middle(region, beads, 0.15 * region.width)
        if len(points) > 1:
            found.append(PlaneCurve(points, closed, "centre", 0))
    return found


def necks(region: Region, inner: Sequence[Region], beads: Beads) -> tuple[Region, ...]:
    """Pieces of a region that no bead inside of `inner` reaches and that join two places which beads do reach."""
    half, error = 0.5 * beads.spacing, beads.chord_error
    reached = [part for piece in inner for part in piece.grown(half, error)]
    if len(reached) < 2:
        return ()
    found = []
    for piece in region.without(reached):
        beside = [part for part in reached if part.distance(piece) < 2.0 * error]
        if len(beside) > 1:
            found.append(piece)
    return tuple(found)


def _middle(region: Region, beads: Beads, least: float) -> tuple[Array, bool]:
    step = min(FINE * beads.spacing, 0.4 * least)
    points, closed = spine(region, least, step)
    if len(points) > 1:
        points = _smooth(points, closed, 0.2 * beads.chord_error)
        if not closed and tuple(points[-1]) < tuple(points[0]):
            points = points[::-1]
    return points, closed


def _smooth(points: Array, closed: bool, tolerance: float) -> Array:
    """The path without the ripple that it has from single places."""
    line = np.vstack([points, points[:1]]) if closed else points
    if len(line) > 4:
        inner = (line[:-2] + 2.0 * line[1:-1] + line[2:]) / 4.0
        line = np.vstack([line[:1], inner, line[-1:]])
    line = simplified(line, tolerance)
    return line[:-1] if closed else line


def _moved(points: Array, inner: Sequence[Region]) -> Array:
    """Points (n, 2), those outside of all regions moved to the nearest of them."""
    inside = np.any([region.contains(points) for region in inner], axis=0)
    near = [region.nearest(points) for region in inner]
    best = np.argmin([away for _, away in near], axis=0)
    moved = np.stack([place for place, _ in near])[best, np.arange(len(points))]
    return np.where(inside[:, None], points, moved)
