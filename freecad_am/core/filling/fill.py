# SPDX-License-Identifier: LGPL-2.1-or-later
"""One way into all patterns, and what they share: where the middles of beads may lie, what is too thin for that, walls,
beads that close gaps, none too short."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..geometry.regions.region import Region, joined
from ..geometry.regions.strip import Strip
from ..issues import InputError
from ..types import Array
from .centre import closing, left_open
from .connected import connected
from .contours import contours
from .curve import Beads, PlaneCurve, long_enough
from .lines import frame, lines
from .sparse import Infill, sparse
from .spiral import spiral
from .strip_closing import open_windows
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
        space = region.grown(-beads.inset, beads.chord_error)
        upright = abs(math.sin(angle)) > abs(math.cos(angle))
        if pattern in CURVED or not space:
            curves = strip_contours(region, space, beads)
        else:
            curves = (lines_along if upright else lines_round)(region, space, beads, int(walls), infill.density)
        return tuple(long_enough(curves, beads.shortest))
    inner = region.grown(-beads.inset, beads.chord_error)
    if pattern in CURVED and infill.density == 1.0:
        curves = {"contours": contours, "connected": connected, "spiral": spiral}[pattern](region, inner, beads)
    else:
        link = (longest_link or LINK * beads.spacing) if pattern == "zigzag" else None
        rounds = 0 if math.isinf(walls) else int(walls)
        framed = frame(region, inner, beads, rounds)
        curves = framed.thin + framed.curves
        if infill.density == 1.0:
            curves += lines(framed, beads, angle, rounds, link)
            curves += closing(inner, curves, beads, rounds)
        else:
            curves += closing(inner, curves, beads, rounds, framed.ends) if framed.curves else []
            curves += sparse(framed, beads, pattern, angle, rounds, link, infill)
    return tuple(long_enough(curves, beads.shortest))


def open_places(region: Region | Strip, curves: Sequence[PlaneCurve], beads: Beads) -> list[tuple[Array, float]]:
    """Places (2,) that beads leave open of what beads inside can reach, and how wide (mm) each is, more than the gap
    allowed."""
    if isinstance(region, Strip):
        return [
            (region.period.unroll(region.unrolled(window, part.inside()[None]))[0], part.width)
            for window, left, _ in open_windows(region, curves, beads) for part in left
        ]
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
