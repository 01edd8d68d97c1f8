# SPDX-License-Identifier: LGPL-2.1-or-later
"""Filling of less than the whole: walls, a pattern that leaves room inside of them, all of it near tops and bottoms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..geometry.regions.region import Region
from ..geometry.regions.several import grow_regions, select_wider, shrink_region, subtract_regions
from .centre import closing
from .curve import Beads, PlaneCurve, contours_of
from .lattice import families, gyroid, honeycomb
from .lines import Frame, rows
from .zigzag import in_rows

SPARSE = ("contours", "lines", "zigzag", "grid", "triangles", "honeycomb", "gyroid")
LEAST_HEIGHT = 2.0  # spacings; where less is between tops and bottoms beads cover the whole


@dataclass(frozen=True)
class Infill:
    """How much of the area inside of the walls is filled.

    density: share of it, length of beads times spacing. height: mm of the layer above the origin of a gyroid. angle: rad, of
    patterns that stand on those of the layer below: grid, triangles, honeycomb, gyroid. buried: what neither a top nor a
    bottom is near to; outside of it the whole is filled. None: there is neither.
    """

    density: float = 1.0
    height: float = 0.0
    angle: float = 0.0
    buried: Sequence[Region] | None = None


def sparse(
    framed: Frame,
    inner: Sequence[Region],
    beads: Beads,
    pattern: str,
    angle: float,
    walls: int,
    longest_link: float | None,
    infill: Infill,
) -> list[PlaneCurve]:
    """What is inside of walls, see `Infill`, and beads that close gaps between these. inner: where the middles of beads may
    lie. angle (rad): of lines and zigzags, and of the lines where the whole is filled. longest_link: as of `lines`."""
    curves = (
        closing(inner, framed.thin + framed.curves, beads, walls, framed.ends)
        if framed.curves
        else []
    )
    loose, whole = _divided(framed.ends, infill.buried, beads)
    for part in whole:
        curves += _whole(part, beads, angle, walls, longest_link)
    for part in loose:
        curves += _pattern(part, beads, pattern, angle, walls, longest_link, infill)
    return curves


def _divided(
    ends: Sequence[Region], buried: Sequence[Region] | None, beads: Beads
) -> tuple[Sequence[Region], Sequence[Region]]:
    """What of the inside of walls is filled in part, and what as a whole: that a spacing farther than it has to be, so that
    it ends on beads of the layer below."""
    if buried is None:
        return ends, ()
    if not buried:
        return (), ends
    skin = grow_regions(subtract_regions(ends, buried), beads.spacing, beads.chord_error)
    loose = select_wider(
        subtract_regions(ends, skin), LEAST_HEIGHT * beads.spacing, beads.chord_error
    )
    return loose, subtract_regions(ends, loose)


def _whole(
    region: Region, beads: Beads, angle: float, ring: int, longest_link: float | None
) -> list[PlaneCurve]:
    """Lines, or zigzags, over all of a region that lines end on the border of, and beads in what they leave open."""
    inner = region.grown(-0.5 * beads.spacing, beads.chord_error)
    curves = in_rows(
        rows(Frame([], inner, (region,), []), beads, angle), (region,), beads, ring, longest_link
    )
    return curves + (closing(inner, curves, beads, ring) if inner and curves else [])


def _pattern(
    region: Region,
    beads: Beads,
    pattern: str,
    angle: float,
    ring: int,
    longest_link: float | None,
    infill: Infill,
) -> list[PlaneCurve]:
    """The beads of a pattern in a region that they end on the border of."""
    spacing, density = beads.spacing, infill.density
    if pattern == "contours":
        apart = spacing / density
        return _rounds(
            region, beads, ring, apart - 0.5 * spacing if ring else 0.5 * apart - beads.inset, apart
        )
    if pattern in ("honeycomb", "gyroid"):
        across = (
            honeycomb(region, spacing, density, infill.angle)
            if pattern == "honeycomb"
            else gyroid(
                region,
                spacing,
                density,
                infill.angle,
                infill.height,
                beads.chord_error,
            )
        )
        return in_rows([region.pieces(line) for line in across], (region,), beads, ring, None)
    turn = angle if pattern in ("lines", "zigzag") else infill.angle
    longest = None if longest_link is None else longest_link / density
    return [
        curve
        for lines in families(region, pattern, spacing, density, turn)
        for curve in in_rows(lines, (region,), beads, ring, longest)
    ]


def _rounds(
    region: Region, beads: Beads, ring: int, first: float, apart: float
) -> list[PlaneCurve]:
    """Contours so far apart, the first so far inside of a region, mm."""
    curves, k = [], 0
    while inner := shrink_region(region, first + k * apart, beads.chord_error):
        curves += contours_of(inner, beads, ring + k)
        k += 1
    return curves
