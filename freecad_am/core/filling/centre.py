# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads in what other beads leave open: along the middle of it, until no gap is wider than stated."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..geometry.curves.plane_curve import length
from ..geometry.regions.medial import spine
from ..geometry.regions.region import Region, along, simplified
from ..geometry.regions.several import (
    HAIR_SHARE,
    grow_regions,
    select_longer,
    select_wider,
    subtract_regions,
)
from ..issues import InfeasibleError
from ..types import Array
from .curve import Beads, PlaneCurve

ROUNDS = 12  # of beads within one gap
FINE = 0.04  # of the spacing, mm between the places that the middle is found from
LONGER = 8  # attempts to make a bead long enough
COARSE = 0.01  # of the gap; what is open is found no finer
NETWORK = 12.0  # squares of half a bead's width: a region that large, without room for contours, is not a dot but ribs
RIB = 0.6  # of a bead's width; what stands out thicker than that in the mean is a rib
SLIVER = 1.0  # of the chord error; of what is narrower its border is as good as its middle, which takes long to find there
DOT = 5.0  # of half a bead's width; round regions narrower than a bead are no larger than that
LEAST_BARE = 0.01  # of the square of half a bead's width; rounding leaves thousands of smaller places between beads
ENDS = 0.5  # of the gap; a bead in it ends where it is that narrow


def centre_beads(
    gaps: Sequence[Region], beads: Beads, ring: int, inner: Sequence[Region], kind: str = "centre"
) -> list[PlaneCurve]:
    """Open beads along the middle of gaps, or closed ones where those go round; no gap stays wider than stated.

    inner: where the middles of beads may lie; beads are moved there, and those too short go on in there until they are long
    enough.
    """
    found: list[PlaneCurve] = []
    for _ in range(ROUNDS):
        gaps = select_wider(gaps, beads.gap, beads.chord_error)
        rest: list[Region] = []
        for region in gaps:
            points, closed = _spine(region, beads, 0.5 * ENDS * beads.gap)
            points = moved(points if len(points) > 1 else _dab(region, beads), inner)
            if not closed:
                points = _lengthened(points, beads, inner)
            found.append(PlaneCurve(points, closed, kind, ring))
            rest += region.without(
                along([(points, closed)], 0.5 * beads.spacing, beads.chord_error), beads.gap
            )
        gaps = rest
        if not gaps:
            break
    return found


def left_open(curves: Sequence[PlaneCurve], inner: Sequence[Region], beads: Beads) -> list[Region]:
    """What curves leave open, wider than the gap allowed, of what beads can reach with their middles in `inner`."""
    half, error = 0.5 * beads.spacing, max(beads.chord_error, COARSE * beads.gap)
    lines = [(simplified(curve.points, error, curve.closed), curve.closed) for curve in curves]
    return select_wider(
        subtract_regions(grow_regions(inner, half, error), along(lines, half, error), beads.gap),
        beads.gap,
        error,
    )


def closing(
    inner: Sequence[Region],
    curves: Sequence[PlaneCurve],
    beads: Beads,
    ring: int,
    ends: Sequence[Region] = (),
) -> list[PlaneCurve]:
    """Beads in what other beads leave open of what beads can reach with their middles in `inner`, and of that without the
    ends, `lines.Frame`, that lines fill."""
    gaps = left_open(curves, inner, beads)
    if ends:
        gaps = select_wider(subtract_regions(gaps, ends), beads.gap, beads.chord_error)
    return centre_beads(gaps, beads, ring, inner, "closing")


def single_beads(thin: Sequence[Region], beads: Beads) -> list[PlaneCurve]:
    """Beads along the middle of all branches of regions narrower than a bead, of each the longest first; none begins inside
    of others. InfeasibleError THIN_REGION where none is wanted."""
    found: list[PlaneCurve] = []
    for region in thin:
        if beads.thin == "refuse":
            raise InfeasibleError(
                "THIN_REGION",
                "filling",
                "the region at {} is {:.3g} mm wide, less than a bead ({:.3g} mm); choose thin = "
                "single, a narrower bead or a margin",
                beads.where(region.inside()),
                region.width,
                2.0 * beads.inset,
            )
        before = len(found)
        rest: Sequence[Region] = (region,)
        if region.width >= beads.thinnest and region.extent < DOT * beads.inset:
            points, closed = _spine(region, beads, 0.15 * region.width)
            if len(points) < 2 or length(points, closed) < beads.shortest:
                found.append(dot(region, beads))
                continue
        for _ in range(ROUNDS):
            parts, rest = rest, []
            for part in parts:
                sliver = part.width < SLIVER * beads.chord_error
                points, closed = (
                    _along_border(part) if sliver else _spine(part, beads, 0.15 * part.width)
                )
                if len(points) > 1 and (
                    len(found) == before or length(points, closed) >= beads.shortest
                ):
                    found.append(PlaneCurve(points, closed, "centre", 0))
                    rest += part.without(
                        along([(points, closed)], beads.inset, beads.chord_error), beads.gap
                    )
            # what a bead has ended in, as it narrows, is narrower than the narrowest bead by far; a
            # threshold that it may lie about would give equal sections different beads
            rest = select_wider(rest, max(beads.gap, beads.thinnest), beads.chord_error)
    return found


def dot(region: Region, beads: Beads) -> PlaneCurve:
    """A short bead in the middle of a region narrower than a bead and about as long as wide: its length, and its width where
    it would be too short, are such that the region is filled."""
    long = max(region.area / (2.0 * beads.inset), beads.shortest)
    share = region.area / (2.0 * beads.inset * long)
    share = min(max(share, beads.narrowest), 1.0)
    middle = region.middle if region.contains(region.middle[None])[0] else region.inside()
    reach = 0.5 * long * region.axis()
    points = np.stack([middle - reach, middle + reach])
    return PlaneCurve(
        points, False, "centre", 0, share=None if share == 1.0 else np.full(2, share), dot=True
    )


def bare_parts(
    region: Region, curves: Sequence[PlaneCurve], beads: Beads
) -> list[tuple[Region, float]]:
    """Parts of a region in which no bead lies, as they are too narrow, and how far (mm) each reaches from the beads: more
    than a bead is wide. All of a region without beads is one."""
    if not curves:
        return [(region, region.extent)]
    lines = [(curve.points, curve.closed) for curve in curves]
    if region.extent < 2.0 * beads.inset or curves[0].dot:
        return []
    reached = along(lines, beads.inset, max(beads.chord_error, COARSE * beads.inset))
    parts = []
    for part in region.without(reached, least_area=LEAST_BARE * beads.inset**2):
        if part.extent <= 2.0 * beads.inset:
            continue
        border = part.borders()[0]
        out = float(np.min([near.nearest(border)[1] for near in reached], axis=0).max())
        if out > 2.0 * beads.inset:
            parts.append((part, out))
    return parts


def outermost(
    region: Region, inner: tuple[Region, ...], beads: Beads
) -> tuple[tuple[Region, ...], list[PlaneCurve]]:
    """What of `inner`, where middles of beads may lie, the outermost bead goes round, and beads in what is too thin for
    that: necks of the region, or all of it. Places that are hardly wider than a bead, as where ribs meet, are left to the
    beads along the middle of the ribs. InfeasibleError THIN_REGION where none are wanted there."""
    if beads.thin != "refuse":
        long = select_longer(inner, beads.shortest)
        inner = long if long or region.area > NETWORK * beads.inset**2 else inner
    if not inner:
        return (), single_beads((region,), beads)
    reached = grow_regions(inner, beads.inset, beads.chord_error)
    parts, hair = region.without(reached), HAIR_SHARE * beads.chord_error
    if any(part.extent > beads.inset and len(part.grown(-hair, hair)) > 1 for part in parts):
        # beads touch the border, where rounding leaves slits that join corners in one section and not
        # in an equal one
        reached = grow_regions(inner, beads.inset + hair, beads.chord_error)
        parts = region.without(reached)
    return inner, single_beads([part for part in parts if _is_neck(part, reached, beads)], beads)


def _is_neck(part: Region, reached: Sequence[Region], beads: Beads) -> bool:
    """Whether a part that beads do not reach joins two places which they do reach, or stands out from one as ribs and blades
    do: for longer than a bead is wide it is wider than the narrowest bead, or nearly as thick as a bead all along. A corner
    is shorter."""
    adjacent = [other for other in reached if other.distance(part) < 2.0 * beads.chord_error]
    width = 2.0 * beads.inset
    if len(adjacent) != 1:
        return len(adjacent) > 1
    if part.extent <= width:
        return False
    out = float(adjacent[0].nearest(part.borders()[0])[1].max())
    if out <= width:
        return False
    if part.area > RIB * width * max(out, width):
        return True
    wide = part.grown(-0.5 * beads.thinnest, beads.chord_error)
    return any(float(adjacent[0].nearest(core.borders()[0])[1].max()) > width for core in wide)


def _along_border(region: Region) -> tuple[Array, bool]:
    """The border (n, 2) of a sliver from one of its ends to the other, and whether it is closed: the way round a hole."""
    border, *holes = region.borders()
    if holes:
        return border, True
    end = 0
    for _ in range(2):
        start, end = end, int(np.argmax(np.hypot(*(border - border[end]).T)))
    ways = [
        np.roll(border, -a, axis=0)[: (b - a) % len(border) + 1]
        for a, b in ((start, end), (end, start))
    ]
    return min(ways, key=lambda way: length(way, False)), False


def _spine(region: Region, beads: Beads, least: float) -> tuple[Array, bool]:
    step = min(FINE * beads.spacing, 0.4 * least)
    points, closed = spine(region, least, step)
    if len(points) > 1:
        points = _smooth(points, closed, 0.2 * beads.chord_error)
        if not closed and tuple(points[-1]) < tuple(points[0]):
            points = points[::-1]
    return points, closed


def _smooth(points: Array, closed: bool, tolerance: float) -> Array:
    """The path without the ripple that it has from single places."""
    line = np.vstack([points, points[:1]]) if closed else points
    if len(line) > 4:
        inner = (line[:-2] + 2.0 * line[1:-1] + line[2:]) / 4.0
        line = np.vstack([line[:1], inner, line[-1:]])
    line = simplified(line, tolerance)
    return line[:-1] if closed else line


def _dab(region: Region, beads: Beads) -> Array:
    """Two places (2, 2) in the middle of a region too round for a path, along it."""
    core = max(region.grown(-0.5 * beads.gap, beads.chord_error), key=lambda part: part.area)
    border = region.borders()[0]
    way = np.linalg.svd(border - border.mean(axis=0), full_matrices=False)[2][0]
    reach = 0.5 * ENDS * beads.gap * way
    ends: Array = core.inside() + np.stack([-reach, reach])
    return ends


def _lengthened(points: Array, beads: Beads, inner: Sequence[Region]) -> Array:
    """An open bead gone on at both ends, along itself and then along the border of its room, until it is long enough; as it
    is where the room is too small."""
    for _ in range(LONGER):
        lack = beads.shortest - length(points, False)
        if lack <= 0.0:
            break
        share = np.linspace(0.0, 0.6 * lack, 5)[1:, None]
        ways = [
            out / max(float(np.hypot(*out)), 1e-300)
            for out in (points[0] - points[1], points[-1] - points[-2])
        ]
        ends = [moved(end + share * way, inner) for end, way in zip((points[0], points[-1]), ways)]
        longer = simplified(np.vstack([ends[0][::-1], points, ends[1]]), 0.2 * beads.chord_error)
        if length(longer, False) <= length(points, False):
            break
        points = longer
    return points


def moved(points: Array, inner: Sequence[Region]) -> Array:
    """Points (n, 2), those outside of all regions moved to the nearest of them; as they are where there are none."""
    if not inner:
        return points
    outside = np.flatnonzero(~np.any([region.contains(points) for region in inner], axis=0))
    if not len(outside):
        return points
    near = [region.nearest(points[outside]) for region in inner]
    best = np.argmin([away for _, away in near], axis=0)
    moved = points.copy()
    moved[outside] = np.stack([place for place, _ in near])[best, np.arange(len(outside))]
    return moved
