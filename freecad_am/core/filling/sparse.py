# SPDX-License-Identifier: LGPL-2.1-or-later
"""Partial filling: walls, an open pattern inside of them, and solid filling near tops and bottoms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..geometry.regions.region import Region
from ..geometry.regions.several import grow_regions, select_wider, shrink_region, subtract_regions
from .centre import closing_beads
from .curve import Beads, PlaneCurve, contours_of
from .lattice import families, gyroid, honeycomb
from .lines import Frame, rows
from .zigzag import in_rows

SPARSE = ("contours", "lines", "zigzag", "grid", "triangles", "honeycomb", "gyroid")
LEAST_HEIGHT = 2.0  # spacings; where less is between tops and bottoms beads cover the whole


@dataclass(frozen=True)
class Infill:
    """How much of the area inside of the walls is filled.

    density: its share, length of beads times spacing. height: mm of the layer above the origin of a gyroid. angle: rad, of
    patterns that rest on the layer below: grid, triangles, honeycomb, gyroid. buried: regions not near a top or a bottom; the
    rest is filled solid. None: there is neither.
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
    """The filling inside of walls, see `Infill`, and beads that close gaps between these.

    inner: allowed positions of bead middles. angle (rad): of lines and zigzags, and of the lines of solid regions. longest_link:
    as in `lines`.
    """
    curves = (
        closing_beads(inner, framed.thin + framed.curves, beads, walls, framed.ends)
        if framed.curves
        else []
    )
    loose, solid = _divided(framed.ends, infill.buried, beads)
    for region in solid:
        curves += _fill_solid(region, beads, angle, walls, longest_link)
    for region in loose:
        curves += _pattern(region, beads, pattern, angle, walls, longest_link, infill)
    return curves


def _divided(
    ends: Sequence[Region], buried: Sequence[Region] | None, beads: Beads
) -> tuple[Sequence[Region], Sequence[Region]]:
    """The partly filled and the solid regions inside of walls; solid ones extend by a spacing, so that they end on beads of the
    layer below.
    """
    if buried is None:
        return ends, ()
    if not buried:
        return (), ends
    skin = grow_regions(subtract_regions(ends, buried), beads.spacing, beads.chord_error)
    loose = select_wider(
        subtract_regions(ends, skin), LEAST_HEIGHT * beads.spacing, beads.chord_error
    )
    return loose, subtract_regions(ends, loose)


def _fill_solid(
    region: Region, beads: Beads, angle: float, ring: int, longest_link: float | None
) -> list[PlaneCurve]:
    """Lines, or zigzags, over a region whose border they end on, and beads in their gaps."""
    inner = region.grown(-0.5 * beads.spacing, beads.chord_error)
    curves = in_rows(
        rows(Frame([], inner, (region,), []), beads, angle), (region,), beads, ring, longest_link
    )
    return curves + (closing_beads(inner, curves, beads, ring) if inner and curves else [])


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
        pitch = spacing / density
        return _rounds(
            region, beads, ring, pitch - 0.5 * spacing if ring else 0.5 * pitch - beads.inset, pitch
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
    region: Region, beads: Beads, ring: int, inset: float, pitch: float
) -> list[PlaneCurve]:
    """Contours at a pitch, the first at an inset from the border of a region, mm."""
    curves, k = [], 0
    while inner := shrink_region(region, inset + k * pitch, beads.chord_error):
        curves += contours_of(inner, beads, ring + k)
        k += 1
    return curves
