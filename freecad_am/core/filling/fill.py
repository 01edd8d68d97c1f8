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
Gaps = list[tuple[Array, float]]  # a place (2,) in each, and how wide it is, mm


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
        return tuple(long_enough(_fill_strip(region, beads, pattern, angle, walls, infill.density), beads.shortest))
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


def _fill_strip(
    strip: Strip, beads: Beads, pattern: str, angle: float, walls: float, density: float
) -> list[PlaneCurve]:
    inner = strip.grown(-beads.inset, beads.chord_error)
    if pattern in CURVED or not inner:
        return strip_contours(strip, inner, beads)
    upright = abs(math.sin(angle)) > abs(math.cos(angle))
    return (lines_along if upright else lines_round)(strip, inner, beads, int(walls), density)


def open_places(region: Region | Strip, curves: Sequence[PlaneCurve], beads: Beads) -> Gaps:
    """Places (2,) that beads leave open of what beads inside can reach, and how wide (mm) each is, more than the gap
    allowed."""
    if isinstance(region, Strip):
        return [
            (region.moved_back(window, gap.inside()[None])[0][0], gap.width)
            for window, gaps, _ in open_windows(region, curves, beads) for gap in gaps
        ]
    inner = region.grown(-beads.inset, beads.chord_error)
    return [(gap.inside(), gap.width) for gap in left_open(curves, inner, beads)] if inner else []


def open_at_slits(
    regions: Sequence[Region], curves: Sequence[PlaneCurve], beads: Beads
) -> Gaps | None:
    """As `open_places`, of all regions of a layer with their beads, where slits thinner than the gap allowed divide them:
    what beads leave open on both sides of a slit is one gap. None where no slits do."""
    whole = joined(regions, beads.gap)
    if whole == tuple(regions):
        return None
    return [gap for region in whole for gap in open_places(region, curves, beads)]
