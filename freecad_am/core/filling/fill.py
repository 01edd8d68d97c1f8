# SPDX-License-Identifier: LGPL-2.1-or-later
"""One entry to all patterns, with their common steps: room for bead middles, thin regions, walls, gap-closing beads, short beads."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..geometry.regions.region import Region
from ..geometry.regions.strip import Strip
from ..issues import InputError
from ..types import Array
from .balanced_ring import balanced
from .centre import closing_beads, open_regions
from .connected import connect_contours
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
SOLID = Infill()
LINK = 3.0  # of the spacing
Gaps = list[tuple[Array, float]]  # a place (2,) in each, and how wide it is, mm


def fill(
    region: Region | Strip,
    beads: Beads,
    pattern: str = "contours",
    angle: float = 0.0,
    walls: float = 0,
    longest_link: float = 0.0,
    infill: Infill = SOLID,
) -> tuple[PlaneCurve, ...]:
    """The beads that fill a region in one of PATTERNS, from outside in.

    Grid, triangles, honeycomb and gyroid are lines if the whole is filled. Round a hub, lines run round it if the angle is nearer
    to that and along it otherwise; spirals are contours there, and every other pattern is lines.

    Parameters
    ----------
    angle
        rad, of lines and zigzags.
    walls
        Number of contours round the others, infinity for contours only.
    longest_link
        mm, of lines and zigzags, by default 3 spacings.

    Raises
    ------
    InputError
        PATTERN for another pattern, MISSING_LIBRARY.
    InfeasibleError
        THIN_REGION.
    """
    if pattern not in PATTERNS:
        raise InputError(
            "PATTERN",
            "filling",
            "unknown pattern {!r}; use one of {}",
            pattern,
            ", ".join(PATTERNS),
        )
    if pattern not in CURVED and math.isinf(walls):
        pattern, infill = "contours", SOLID
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
        curves = {"contours": contours, "connected": connect_contours, "spiral": spiral}[pattern](
            region, inner, beads
        )
    else:
        link = (longest_link or LINK * beads.spacing) if pattern == "zigzag" else None
        rounds = 0 if math.isinf(walls) else int(walls)
        framed = frame(region, inner, beads, rounds)
        curves = framed.thin + framed.curves
        if infill.density == 1.0:
            curves += lines(framed, beads, angle, rounds, link)
            curves += closing_beads(inner, curves, beads, rounds)
        else:
            curves += sparse(framed, inner, beads, pattern, angle, rounds, link, infill)
    curves = long_enough(curves, beads.shortest)
    return tuple(balanced(region, curves, beads) if infill.density == 1.0 else curves)


def open_places(region: Region | Strip, curves: Sequence[PlaneCurve], beads: Beads) -> Gaps:
    """Points (2,) left open within reach of the beads inside, and the width (mm) of each gap, more than the allowed one."""
    if isinstance(region, Strip):
        return [
            (region.moved_back(window, gap.inside()[None])[0][0], gap.width)
            for window, gaps, _ in open_windows(region, curves, beads)
            for gap in gaps
        ]
    inner = region.grown(-beads.inset, beads.chord_error)
    return (
        [(gap.inside(), gap.width) for gap in open_regions(curves, inner, beads)] if inner else []
    )
