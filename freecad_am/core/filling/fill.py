# SPDX-License-Identifier: LGPL-2.1-or-later
"""One way into all patterns."""

from __future__ import annotations

import math

from ..geometry.region import Region
from ..geometry.strip import Strip
from ..issues import InputError
from .contours import contours
from .curve import Beads, PlaneCurve
from .lines import lines
from .spiral import spiral
from .strips import lines_along, lines_round, strip_contours
from .zigzag import zigzag

PATTERNS = ("contours", "lines", "spiral", "zigzag")


def fill(
    region: Region | Strip, beads: Beads, pattern: str = "contours", angle: float = 0.0, ring: bool = False
) -> tuple[PlaneCurve, ...]:
    """The beads that fill a region in one of PATTERNS, from outside in.

    angle (rad) and ring (a contour first) are for lines and zigzags. Round a hub, lines run round it where the angle is
    nearer to that and along it otherwise; spirals are contours there and zigzags lines. InputError PATTERN for another
    pattern, InfeasibleError THIN_REGION, InputError MISSING_LIBRARY.
    """
    if pattern not in PATTERNS:
        raise InputError("PATTERN", "filling", f"there is no pattern {pattern!r}; use one of {', '.join(PATTERNS)}")
    straight = pattern in ("lines", "zigzag")
    if isinstance(region, Strip):
        if not straight:
            return tuple(strip_contours(region, beads))
        upright = abs(math.sin(angle)) > abs(math.cos(angle))
        return tuple(lines_along(region, beads) if upright else lines_round(region, beads))
    if straight:
        return tuple((lines if pattern == "lines" else zigzag)(region, beads, angle, ring))
    return tuple((contours if pattern == "contours" else spiral)(region, beads))
