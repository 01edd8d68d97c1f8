# SPDX-License-Identifier: LGPL-2.1-or-later
"""Filling of less than the whole: walls, a pattern that leaves room inside of them, all of it near tops and bottoms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..geometry.curves.plane_curve import length
from ..geometry.regions.region import Region
from ..types import Array
from .centre import centre_beads, left_open, single_beads
from .curve import Beads, PlaneCurve, begun, long_enough
from .lattice import families, gyroid, honeycomb
from .lines import Frame, frame, rows
from .zigzag import LINK, linked

SPARSE = ("contours", "lines", "zigzag", "grid", "triangles", "honeycomb", "gyroid")
LEAST_HEIGHT = 2.0  # spacings; where less is between tops and bottoms beads cover the whole


@dataclass(frozen=True)
class Infill:
    """How much of the area inside of the walls is filled.

    density: share of it, length of beads times spacing. height: mm of the layer above the origin of a gyroid. angle: rad, of
    patterns that stand on those of the layer below: grid, triangles, honeycomb, gyroid. covered: what neither a top nor a
    bottom is near to; outside of it the whole is filled. None: there is neither.
    """

    density: float = 1.0
    height: float = 0.0
    angle: float = 0.0
    covered: Sequence[Region] | None = None


def sparse(
    region: Region, beads: Beads, pattern: str, angle: float, walls: int, longest_link: float, infill: Infill
) -> list[PlaneCurve]:
    """The walls of a region, the beads that close what these leave open between them, then what is inside, see `Infill`.

    angle (rad): of lines and zigzags, and of the lines where the whole is filled. InfeasibleError THIN_REGION.
    """
    place = frame(region, beads, walls)
    curves = single_beads(place.thin, beads) + place.curves
    inner = region.grown(-beads.inset, beads.chord_error)
    if place.curves:
        left = left_open([(curve.points, curve.closed) for curve in curves], inner, beads)
        between = [part for piece in left for part in (piece.without(place.ends) if place.ends else (piece,))]
        curves += centre_beads(
            [part for part in between if part.grown(-0.5 * beads.gap, beads.chord_error)], beads, walls, inner, "closing"
        )
    loose, whole = _divided(place.ends, infill.covered, beads)
    for part in whole:
        curves += _whole(part, beads, pattern, angle, walls, longest_link)
    for part in loose:
        curves += _pattern(part, beads, pattern, angle, walls, longest_link, infill)
    return long_enough(curves, beads.shortest)


def _divided(
    ends: Sequence[Region], covered: Sequence[Region] | None, beads: Beads
) -> tuple[list[Region], list[Region]]:
    """What of the inside of walls is filled in part, and what as a whole: that a spacing farther than it has to be, so that
    it ends on beads of the layer below."""
    if covered is None:
        return list(ends), []
    if not covered:
        return [], list(ends)
    near = [piece for part in ends for piece in part.without(covered)]
    near = [piece for part in near for piece in part.grown(beads.spacing, beads.chord_error)]
    loose = [piece for part in ends for piece in (part.without(near) if near else (part,))]
    loose = [part for part in loose if part.grown(-0.5 * LEAST_HEIGHT * beads.spacing, beads.chord_error)]
    return loose, [piece for part in ends for piece in (part.without(loose) if loose else (part,))]


def _whole(
    part: Region, beads: Beads, pattern: str, angle: float, ring: int, longest_link: float
) -> list[PlaneCurve]:
    """Lines, or zigzags, over all of a region that lines end on the border of, and beads in what they leave open."""
    area = part.grown(-0.5 * beads.spacing, beads.chord_error)
    cuts = rows(Frame([], area, (part,), ()), beads, angle)
    if pattern == "zigzag":
        found = linked(cuts, (part,), beads, ring, longest_link or LINK * beads.spacing)
    else:
        found = _alternating(cuts, beads, ring)
    left = left_open([(curve.points, curve.closed) for curve in found], area, beads) if area and found else []
    return found + centre_beads(left, beads, ring, area, "closing")


def _pattern(
    part: Region, beads: Beads, pattern: str, angle: float, ring: int, longest_link: float, infill: Infill
) -> list[PlaneCurve]:
    """The beads of a pattern in a region that they end on the border of."""
    spacing, density = beads.spacing, infill.density
    if pattern == "contours":
        apart = spacing / density
        return _rings(part, beads, ring, apart - 0.5 * spacing if ring else 0.5 * apart - beads.inset, apart)
    if pattern == "zigzag":
        cuts = next(iter(families(part, pattern, spacing, density, angle)))
        return linked(cuts, (part,), beads, ring, (longest_link or LINK * spacing) / density)
    if pattern in ("honeycomb", "gyroid"):
        across = honeycomb(part, spacing, density, infill.angle) if pattern == "honeycomb" else gyroid(
            part, spacing, density, infill.angle, infill.height, beads.chord_error,
        )
        return _alternating([part.pieces(line) for line in across], beads, ring)
    turn = angle if pattern == "lines" else infill.angle
    return [
        curve for cuts in families(part, pattern, spacing, density, turn) for curve in _alternating(cuts, beads, ring)
    ]


def _alternating(cuts: Sequence[Sequence[Array]], beads: Beads, ring: int) -> list[PlaneCurve]:
    """Lines row by row, every other row the other way."""
    return [
        PlaneCurve(cut[::-1] if row % 2 else cut, False, "line", ring)
        for row, some in enumerate(cuts) for cut in some if length(cut, False) >= beads.shortest
    ]


def _rings(part: Region, beads: Beads, ring: int, first: float, apart: float) -> list[PlaneCurve]:
    """Contours so far apart, the first so far inside of a region, mm."""
    found, k = [], 0
    while inner := part.grown(-first - k * apart, beads.chord_error):
        found += [begun(PlaneCurve(line, True, "contour", ring + k), beads) for piece in inner for line in piece.rings()]
        k += 1
    return found
