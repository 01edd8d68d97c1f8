# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operations on several regions: grow, subtract, intersect, select by size."""

from __future__ import annotations

from collections.abc import Sequence
from typing import overload

import numpy as np

from ..curves.plane_curve import length
from ..obstacles import meeting_boxes
from .region import Region
from .strip import Strip, Window

PAIRED_COUNT = 8  # regions; fewer are compared in pairs
HAIR_SHARE = 0.01  # of the chord error; half the width of a neck that comes from rounding


@overload
def grow_regions(
    regions: Sequence[Region], distance: float, chord_error: float
) -> tuple[Region, ...]: ...


@overload
def grow_regions(
    regions: Sequence[Strip | Region], distance: float, chord_error: float
) -> tuple[Strip | Region, ...]: ...


def grow_regions(
    regions: Sequence[Strip | Region], distance: float, chord_error: float
) -> tuple[Strip | Region, ...]:
    """Grow regions, as `Region.grown` and `Strip.grown`.

    Parameters
    ----------
    regions : sequence of Strip or Region
        The regions.
    distance : float
        Distance, mm; negative to shrink.
    chord_error : float
        Chord error of arcs, mm.

    Returns
    -------
    tuple of Strip or Region
        Parts of each region in turn; parts of different regions may overlap.
    """
    return tuple(part for region in regions for part in region.grown(distance, chord_error))


def subtract_regions(
    regions: Sequence[Region], subtracted: Sequence[Region], wide: float = 0.0
) -> tuple[Region, ...]:
    """Subtract regions, as `Region.without`.

    Parameters
    ----------
    regions : sequence of Region
        The regions.
    subtracted : sequence of Region
        Regions to subtract; if empty, `regions` are returned.
    wide : float, optional
        Diameter, mm; pieces too small for a circle of this diameter may be dropped.

    Returns
    -------
    tuple of Region
        Remaining parts of each region in turn.
    """
    return (
        tuple(
            result
            for region, nearby in zip(regions, _nearby(regions, subtracted))
            for result in region.without(nearby, wide)
        )
        if subtracted
        else tuple(regions)
    )


def intersect_regions(
    regions: Sequence[Region], counterparts: Sequence[Region]
) -> tuple[Region, ...]:
    """Intersect regions, as `Region.common`."""
    return tuple(
        result
        for region, nearby in zip(regions, _nearby(regions, counterparts))
        for result in (region.common(nearby) if nearby else ())
    )


def _nearby(
    regions: Sequence[Region], counterparts: Sequence[Region]
) -> Sequence[Sequence[Region]]:
    """Return for each region the counterparts whose bounding boxes meet its own."""
    if min(len(regions), len(counterparts)) < PAIRED_COUNT:
        return [counterparts] * len(regions)
    low, high = (
        np.array([region.bounds[k] for region in (*regions, *counterparts)]) for k in (0, 1)
    )
    return [
        [counterparts[number - len(regions)] for number in met.tolist() if number >= len(regions)]
        for met in meeting_boxes(low, high)[: len(regions)]
    ]


def halves(strip: Strip) -> list[Region]:
    """Cut a strip into two half turns, on both sides of the generatrix where u = 0."""
    half = 0.5 * strip.period.u_period
    return [
        half_region
        for low, high in ((-half, 0.0), (0.0, half))
        for half_region in strip.flat(Window(0.0, low, high, 0.0))
    ]


def select_wider(regions: Sequence[Region], width: float, chord_error: float) -> list[Region]:
    """Return the regions that can contain a circle.

    Parameters
    ----------
    regions : sequence of Region
        The regions.
    width : float
        Diameter of the circle, mm.
    chord_error : float
        Chord error of arcs, mm.

    Returns
    -------
    list of Region
        Selected regions in the given order.
    """
    return [region for region in regions if region.has_room(width, chord_error)]


def select_longer(regions: Sequence[Region], min_length: float) -> tuple[Region, ...]:
    """Return the regions whose outer border is at least `min_length` mm long."""
    return tuple(region for region in regions if length(region.borders()[0], True) >= min_length)


def shrink_region(region: Region, distance: float, chord_error: float) -> tuple[Region, ...]:
    """Return `region.grown(-distance)` without necks that come from rounding errors.

    Where a region is exactly twice `distance` wide, rounding decides whether a neck of zero width
    connects the result. The decision may differ for a rotated region. Necks narrower than two
    HAIR_SHARE of the chord error are removed.

    Parameters
    ----------
    region : Region
        The region.
    distance : float
        Distance, mm.
    chord_error : float
        Chord error of arcs, mm.

    Returns
    -------
    tuple of Region
        The parts that remain.
    """
    shrunk_parts, hair = region.grown(-distance, chord_error), HAIR_SHARE * chord_error
    within = region.grown(-distance - hair, chord_error)
    if _loops(shrunk_parts) == _loops(within):
        return shrunk_parts
    return grow_regions(within, hair, chord_error)


def _loops(regions: Sequence[Region]) -> list[int]:
    """Return the number of borders of each region, sorted."""
    return sorted(len(region.borders()) for region in regions)
