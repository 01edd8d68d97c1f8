# SPDX-License-Identifier: LGPL-2.1-or-later
"""One way into all patterns."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..geometry.regions.region import Region, joined
from ..geometry.regions.strip import Strip
from ..issues import InputError
from ..types import Array
from .centre import left_open
from .connected import connected
from .contours import contours
from .curve import Beads, PlaneCurve
from .lines import lines
from .sparse import Infill, sparse
from .spiral import spiral
from .strip_closing import strip_left_open
from .strip_lines import lines_along, lines_round
from .strips import strip_contours

PATTERNS = ("contours", "connected", "lines", "spiral", "zigzag", "grid", "triangles", "honeycomb", "gyroid")
CURVED = ("contours", "connected", "spiral")  # without walls: the border's parallel curves are all they have
WHOLE = Infill()
LINK = 3.0  # of the spacing


def fill(
    region: Region | Strip, beads: Beads, pattern: str = "contours", angle: float = 0.0, walls: float = 0,
    longest_link: float = 0.0, infill: Infill = WHOLE,
) -> tuple[PlaneCurve, ...]:
    """The beads that fill a region in one of PATTERNS, from outside in.

    angle (rad) is for lines and zigzags, longest_link (mm, by default 3 spacings) for these; walls: how many contours lie
    round the others, infinity for contours alone. Grid, triangles, honeycomb and gyroid are lines where the whole is filled.
    Round a hub, lines run round it where the angle is nearer to that and along it otherwise; all that is not contours or
    spirals, which are contours there, is lines. InputError PATTERN for another pattern, InfeasibleError THIN_REGION,
    InputError MISSING_LIBRARY.
    """
    if pattern not in PATTERNS:
        raise InputError("PATTERN", "filling", "there is no pattern {!r}; use one of {}", pattern, ", ".join(PATTERNS))
    if pattern not in CURVED and math.isinf(walls):
        pattern, infill = "contours", WHOLE
    if isinstance(region, Strip):
        if pattern in CURVED:
            return tuple(strip_contours(region, beads))
        upright = abs(math.sin(angle)) > abs(math.cos(angle))
        return tuple((lines_along if upright else lines_round)(region, beads, int(walls), infill.density))
    link = (longest_link or LINK * beads.spacing) if pattern == "zigzag" else None
    if infill.density < 1.0:
        return tuple(sparse(region, beads, pattern, angle, 0 if math.isinf(walls) else int(walls), link, infill))
    if pattern in CURVED:
        return tuple({"contours": contours, "connected": connected, "spiral": spiral}[pattern](region, beads))
    return tuple(lines(region, beads, angle, int(walls), link))


def open_places(region: Region | Strip, curves: Sequence[PlaneCurve], beads: Beads) -> list[tuple[Array, float]]:
    """Places (2,) that beads leave open of what beads inside can reach, and how wide (mm) each is, more than the gap
    allowed."""
    if isinstance(region, Strip):
        return strip_left_open(region, curves, beads)
    inner = region.grown(-beads.inset, beads.chord_error)
    return [(part.inside(), part.width) for part in left_open(curves, inner, beads)] if inner else []


def open_at_slits(
    regions: Sequence[Region], curves: Sequence[PlaneCurve], beads: Beads
) -> list[tuple[Array, float]] | None:
    """As `open_places`, of all regions of a layer with their beads, where slits thinner than the gap allowed divide them:
    what beads leave open on both sides of a slit is one place. None where there are no such slits."""
    whole = joined(regions, beads.gap)
    if whole == tuple(regions):
        return None
    return [left for region in whole for left in open_places(region, curves, beads)]
