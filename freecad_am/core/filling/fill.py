# SPDX-License-Identifier: LGPL-2.1-or-later
"""One way into all patterns."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..geometry.plane_curve import Array
from ..geometry.region import Region, joined
from ..geometry.strip import Strip
from ..issues import InputError
from .centre import left_open
from .contours import contours
from .curve import Beads, PlaneCurve
from .lines import lines
from .spiral import spiral
from .strip_closing import strip_left_open
from .strip_lines import lines_along, lines_round
from .strips import strip_contours
from .zigzag import zigzag

PATTERNS = ("contours", "lines", "spiral", "zigzag")


def fill(
    region: Region | Strip, beads: Beads, pattern: str = "contours", angle: float = 0.0, ring: bool = False,
    longest_link: float = 0.0,
) -> tuple[PlaneCurve, ...]:
    """The beads that fill a region in one of PATTERNS, from outside in.

    angle (rad) and ring (a contour first) are for lines and zigzags, longest_link (mm, by default 3 spacings) is for these.
    Round a hub, lines run round it where the angle is nearer to that and along it otherwise; spirals are contours there and
    zigzags lines. InputError PATTERN for another pattern, InfeasibleError THIN_REGION, InputError MISSING_LIBRARY.
    """
    if pattern not in PATTERNS:
        raise InputError("PATTERN", "filling", f"there is no pattern {pattern!r}; use one of {', '.join(PATTERNS)}")
    straight = pattern in ("lines", "zigzag")
    if isinstance(region, Strip):
        if not straight:
            return tuple(strip_contours(region, beads))
        upright = abs(math.sin(angle)) > abs(math.cos(angle))
        return tuple((lines_along if upright else lines_round)(region, beads, ring))
    if pattern == "lines":
        return tuple(lines(region, beads, angle, ring))
    if pattern == "zigzag":
        return tuple(zigzag(region, beads, angle, ring, longest_link))
    return tuple((contours if pattern == "contours" else spiral)(region, beads))


def open_places(region: Region | Strip, curves: Sequence[PlaneCurve], beads: Beads) -> list[tuple[Array, float]]:
    """Places (2,) that beads leave open of what beads inside can reach, and how wide (mm) each is, more than the gap
    allowed."""
    if isinstance(region, Strip):
        return strip_left_open(region, curves, beads)
    inner = region.grown(-beads.inset, beads.chord_error)
    left = left_open([(curve.points, curve.closed) for curve in curves], inner, beads) if inner else []
    return [(part.inside(), part.width) for part in left]


def open_at_slits(
    parts: Sequence[Region], curves: Sequence[PlaneCurve], beads: Beads
) -> list[tuple[Array, float]] | None:
    """As `open_places`, of all regions of a layer with their beads, where slits thinner than the gap allowed divide them:
    what beads leave open on both sides of a slit is one place. None where there are no such slits."""
    whole = joined(parts, beads.gap)
    if whole == tuple(parts):
        return None
    return [found for region in whole for found in open_places(region, curves, beads)]
