# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is done to each of several regions: grown, without others, left out where it is too narrow."""

from __future__ import annotations

from collections.abc import Sequence
from typing import overload

from ..curves.plane_curve import length
from .region import Region
from .strip import Strip, Window

HAIR = 0.01  # of the chord error


@overload
def grown(regions: Sequence[Region], distance: float, chord_error: float) -> tuple[Region, ...]: ...


@overload
def grown(
    regions: Sequence[Strip | Region], distance: float, chord_error: float
) -> tuple[Strip | Region, ...]: ...


def grown(
    regions: Sequence[Strip | Region], distance: float, chord_error: float
) -> tuple[Strip | Region, ...]:
    """As `Region.grown` and `Strip.grown`."""
    return tuple(part for region in regions for part in region.grown(distance, chord_error))


def without(
    regions: Sequence[Region], others: Sequence[Region], wide: float = 0.0
) -> tuple[Region, ...]:
    """As `Region.without`; the same regions where there are no others."""
    return (
        tuple(part for region in regions for part in region.without(others, wide))
        if others
        else tuple(regions)
    )


def common(regions: Sequence[Region], others: Sequence[Region]) -> tuple[Region, ...]:
    """As `Region.common`."""
    return tuple(part for region in regions for part in region.common(others))


def halves(strip: Strip) -> list[Region]:
    """A strip cut in two, half a turn each way from where it is laid flat about."""
    half = 0.5 * strip.period.around
    return [
        part
        for low, high in ((-half, 0.0), (0.0, half))
        for part in strip.flat(Window(0.0, low, high, 0.0))
    ]


def wider(regions: Sequence[Region], width: float, chord_error: float) -> list[Region]:
    """Those of regions that a circle of a diameter (mm) has room in."""
    return [region for region in regions if region.grown(-0.5 * width, chord_error)]


def longer(regions: Sequence[Region], least: float) -> tuple[Region, ...]:
    """Those of regions whose outer border is at least so long, mm."""
    return tuple(region for region in regions if length(region.borders()[0], True) >= least)


def shrunk(region: Region, distance: float, chord_error: float) -> tuple[Region, ...]:
    """`region.grown(-distance)` without necks that only rounding leaves.

    Where a region is exactly twice `distance` wide, rounding decides whether what stays hangs together by a neck of no
    width, and decides otherwise once the region is turned. Necks narrower than two HAIRS of the chord error are taken away.
    """
    parts, hair = region.grown(-distance, chord_error), HAIR * chord_error
    within = region.grown(-distance - hair, chord_error)
    if _loops(parts) == _loops(within):
        return parts
    return grown(within, hair, chord_error)


def _loops(regions: Sequence[Region]) -> list[int]:
    """How many borders each of regions has, sorted."""
    return sorted(len(region.borders()) for region in regions)
