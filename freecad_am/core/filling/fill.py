# SPDX-License-Identifier: LGPL-2.1-or-later
"""One way into all patterns, and what they share: where the middles of beads may lie, what is too thin for that, walls,
beads that close gaps, none too short."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..geometry.regions.region import Region
from ..geometry.regions.strip import Strip
from ..issues import InputError
from ..types import Array
from .balanced_ring import balanced
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

PATTERNS = (
    "contours",
    "connected",
    "lines",
    "spiral",
    "zigzag",
    "grid",
    "triangles",
    "honeycomb",
    "gyroid",
)
CURVED = (
    "contours",
    "connected",
    "spiral",
)  # without walls: the border's parallel curves are all they have
WHOLE = Infill()
LINK = 3.0  # of the spacing
Gaps = list[tuple[Array, float]]  # a place (2,) in each, and how wide it is, mm


def fill(
    region: Region | Strip,
    beads: Beads,
    pattern: str = "contours",
    angle: float = 0.0,
    walls: float = 0,
    longest_link: float = 0.0,
    infill: Infill = WHOLE,
) -> tuple[PlaneCurve, ...]:
    """The beads that fill a region in one of PATTERNS, from outside in.

    angle (rad) is for lines and zigzags, longest_link (mm, by default 3 spacings) for these; walls: how many contours lie
    round the others, infinity for contours alone. Grid, triangles, honeycomb and gyroid are lines where the whole is filled.
    Round a hub, lines run round it where the angle is nearer to that and along it otherwise; all that is not contours or
    spirals, which are contours there, is lines. InputError PATTERN for another pattern, InfeasibleError THIN_REGION,
    InputError MISSING_LIBRARY.
    """
    if pattern not in PATTERNS:
        raise InputError(
            "PATTERN",
            "filling",
            "there is no pattern {!r}; use one of {}",
            pattern,
            ", ".join(PATTERNS),
        )
    if pattern not in CURVED and math.isinf(walls):
        pattern, infill = "contours", WHOLE
    if isinstance(region, Strip):
        inner = region.grown(-beads.inset, beads.chord_error)
        if pattern in CURVED or not inner:
            curves = strip_contours(region, inner, beads)
        else:
            upright = abs(math.sin(angle)) > abs(math.cos(angle))
            curves = (lines_along if upright else lines_round)(
                region, inner, beads, int(walls), infill.density
            )
        return tuple(long_enough(curves, beads.shortest))
    inner = region.grown(-beads.inset, beads.chord_error)
    if pattern in CURVED and infill.density == 1.0:
        curves = {"contours": contours, "connected": connected, "spiral": spiral}[pattern](
            region, inner, beads
        )
    else:
        link = (longest_link or LINK * beads.spacing) if pattern == "zigzag" else None
        rounds = 0 if math.isinf(walls) else int(walls)
        framed = frame(region, inner, beads, rounds)
        curves = framed.thin + framed.curves
        if infill.density == 1.0:
            curves += lines(framed, beads, angle, rounds, link)
            curves += closing(inner, curves, beads, rounds)
        else:
            curves += sparse(framed, inner, beads, pattern, angle, rounds, link, infill)
    curves = long_enough(curves, beads.shortest)
    return tuple(balanced(region, curves, beads) if infill.density == 1.0 else curves)


def open_places(region: Region | Strip, curves: Sequence[PlaneCurve], beads: Beads) -> Gaps:
    """Places (2,) that beads leave open of what beads inside can reach, and how wide (mm) each is, more than the gap
    allowed."""
    if isinstance(region, Strip):
        return [
            (region.moved_back(window, gap.inside()[None])[0][0], gap.width)
            for window, gaps, _ in open_windows(region, curves, beads)
            for gap in gaps
        ]
    inner = region.grown(-beads.inset, beads.chord_error)
    return [(gap.inside(), gap.width) for gap in left_open(curves, inner, beads)] if inner else []
