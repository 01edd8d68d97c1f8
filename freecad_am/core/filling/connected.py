# SPDX-License-Identifier: LGPL-2.1-or-later
"""Connect all contours of a region to one closed bead.

Neighbouring contours are opened side by side and joined by two parallel links at 45 deg. Two closed
curves joined in this way form one closed curve. This also holds for contours that split, contours
around holes, and thin loops that replace centreline beads. Links do not cross; every second contour
is reversed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.curves.plane_curve import arcs, nearest, nearest_among
from ..geometry.regions.region import Region, along
from ..geometry.regions.several import grow_regions, select_longer, shrink_region, subtract_regions
from ..types import Array, Index, Mask
from .centre import (
    Beads,
    PlaneCurve,
    centre_beads,
    contours_of,
    long_enough,
    outermost,
    start_curve,
)

# ---- Closed curves by arc length, and where two closed curves run side by side

MARK = 0.25  # fraction of the reach; sample distance on rings in the search for adjacent rings


class AdjacentRings(NamedTuple):
    """Indices of two rings, and arc lengths (n,), mm, at which the first is near the second."""

    from_ring: int
    to_ring: int
    arcs: Array


class Ring:
    """Closed curve (n, 2), mm, with the arc-length intervals that openings occupy."""

    def __init__(self, points: Array) -> None:
        self.points = points
        self.arc = arcs(points, True)
        self.length = float(self.arc[-1])
        self._whole = np.vstack([points, points[:1]])
        self._taken: list[tuple[float, float]] = []

    def points_at(self, arcs: Array) -> Array:
        """Return the points at arc lengths.

        Parameters
        ----------
        arcs : (n,) array
            Arc lengths from the first point, mm; they wrap around the ring.

        Returns
        -------
        (n, 2) array
            Points, mm.
        """
        arcs = np.remainder(arcs, self.length)
        return np.stack([np.interp(arcs, self.arc, self._whole[:, k]) for k in (0, 1)], axis=1)

    def way(self, arcs: Array, step: float) -> Array:
        """Return the directions of the ring at arc lengths.

        Parameters
        ----------
        arcs : (n,) array
            Arc lengths, mm.
        step : float
            Length over which directions are averaged, mm.

        Returns
        -------
        (n, 2) array
            Unit vectors along the ring.
        """
        ahead = self.points_at(arcs + 0.5 * step) - self.points_at(arcs - 0.5 * step)
        return np.asarray(ahead / np.maximum(np.hypot(*ahead.T), 1e-300)[:, None])

    def foot(self, points: Array) -> tuple[Array, Array]:
        """Project points onto the ring.

        Parameters
        ----------
        points : (n, 2) array
            Points, mm.

        Returns
        -------
        arcs : (n,) array
            Arc lengths of the projections, mm.
        distances : (n,) array
            Distances of the points from the ring, mm.
        """
        feet = nearest(self.points, points, closed=True)
        return self.arc[feet.edge] + feet.share * np.diff(self.arc)[feet.edge], feet.distance

    def piece(self, start: float, end: float, sense: int) -> Array:
        """Return the points of the ring from one arc length to another.

        Parameters
        ----------
        start, end : float
            Arc lengths, mm; they wrap around the ring.
        sense : int
            1 in the direction of the ring, -1 against it.

        Returns
        -------
        (m, 2) array
            Points in the order of motion, including both ends, mm.
        """
        if sense < 0:
            return self.piece(end, start, 1)[::-1]
        span = (end - start) % self.length
        inner = np.remainder(self.arc[:-1] - start, self.length)
        order = np.argsort(inner, kind="stable")
        between = order[
            (inner[order] > 1e-9 * self.length) & (inner[order] < span - 1e-9 * self.length)
        ]
        return np.vstack(
            [
                self.points_at(np.array([start])),
                self.points[between],
                self.points_at(np.array([end])),
            ]
        )

    def is_free(self, start: float, end: float) -> bool:
        """Whether the arc from start to end, mm, overlaps no occupied interval."""
        return not any(
            (low - start) % self.length < end - start or (start - low) % self.length < high - low
            for low, high in self._taken
        )

    def take(self, start: float, end: float) -> None:
        """Mark the arc from start to end, mm, as occupied."""
        self._taken.append((start, end))


def side_by_side(rings: Sequence[Ring], reach: float) -> list[AdjacentRings]:
    """Find all pairs of rings that are locally closer than `reach` mm, in both orders."""
    marks = [np.arange(0.0, ring.length, MARK * reach) for ring in rings]
    points = np.vstack([ring.points_at(arcs) for ring, arcs in zip(rings, marks)])
    number: Index = np.repeat(np.arange(len(rings)), [len(arcs) for arcs in marks])
    pairs = cKDTree(points).query_pairs(reach, output_type="ndarray")
    pairs = pairs[number[pairs[:, 0]] != number[pairs[:, 1]]]
    pairs = np.vstack([pairs, pairs[:, ::-1]])
    key = np.unique(
        np.stack([number[pairs[:, 0]], number[pairs[:, 1]], pairs[:, 0]], axis=1), axis=0
    )
    all_arcs = np.concatenate(marks)
    cuts = np.flatnonzero((np.diff(key[:, :2], axis=0) != 0).any(axis=1)) + 1
    return [
        AdjacentRings(int(lot[0, 0]), int(lot[0, 1]), all_arcs[lot[:, 2]])
        for lot in np.split(key, cuts)
        if len(lot)
    ]


def crossed(line: Array, polyline: Array) -> bool:
    """Whether a straight line crosses a polyline.

    Parameters
    ----------
    line : (2, 2) array
        Ends of the line, mm.
    polyline : (n, 2) array
        An open polyline, mm.

    Returns
    -------
    bool
        True if an edge of the polyline crosses the line or touches an end of the line.
    """
    direction = line[1] - line[0]
    side = direction[0] * (polyline[:, 1] - line[0, 1]) - direction[1] * (
        polyline[:, 0] - line[0, 0]
    )
    k = np.flatnonzero((side[:-1] > 0.0) != (side[1:] > 0.0))
    points = polyline[k] + (side[k] / (side[k] - side[k + 1]))[:, None] * (
        polyline[k + 1] - polyline[k]
    )
    share = (points - line[0]) @ direction / max(float(direction @ direction), 1e-300)
    return bool(((share >= 0.0) & (share <= 1.0)).any())


# ---- Contours, and the links that join them


@dataclass(frozen=True)
class Levels:
    """Contours of a region, level by level.

    regions[k]: regions whose borders are the contours of level k. gaps[k]: open regions inside
    these contours that are wider than the allowed gap.
    """

    regions: tuple[tuple[Region, ...], ...]
    gaps: tuple[tuple[Region, ...], ...]
    thin: list[PlaneCurve]  # beads in regions narrower than a bead


def levels(region: Region, inner: tuple[Region, ...], beads: Beads) -> Levels:
    """Compute the contours of a region, level by level from outside in, and the gaps inside them.

    Each contour is offset from the border, not from the previous contour, so that errors do not
    accumulate. Contours shorter than `beads.shortest` are dropped; centreline beads fill their
    area.

    Parameters
    ----------
    region : Region
        The region to fill, mm.
    inner : tuple of Region
        The region shrunk by `beads.inset`, mm; bead centrelines stay inside.
    beads : Beads
        Spacing, width, gap and chord error, mm.

    Returns
    -------
    Levels
        Regions bounded by contours and open regions of each level, and beads in thin regions.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and the region is locally narrower than a bead.
    """
    half, error = 0.5 * beads.spacing, beads.chord_error
    inner, thin = outermost(region, inner, beads)
    regions, gaps = [], []
    k = 0
    while inner:
        regions.append(inner)
        open_ = region.grown(-beads.inset - (2 * k + 1) * half, error)
        inner = select_longer(
            shrink_region(region, beads.inset + (2 * k + 2) * half, error), beads.shortest
        )
        gaps.append(subtract_regions(open_, grow_regions(inner, half, error), beads.gap))
        k += 1
    return Levels(tuple(regions), tuple(gaps), thin)


def contours(region: Region, inner: tuple[Region, ...], beads: Beads) -> list[PlaneCurve]:
    """Fill a region with closed contours from outside in, then with centreline beads in the gaps.

    Parameters
    ----------
    region : Region
        The region to fill, mm.
    inner : tuple of Region
        The region shrunk by `beads.inset`, mm; bead centrelines stay inside.
    beads : Beads
        Spacing, width, gap and chord error, mm.

    Returns
    -------
    list of PlaneCurve
        Beads in the plane of the region, including beads shorter than `beads.shortest`.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and the region is locally narrower than a bead.
    """
    contour_levels = levels(region, inner, beads)
    return rounds(contour_levels, beads) + centres(contour_levels, beads)


def rounds(contour_levels: Levels, beads: Beads) -> list[PlaneCurve]:
    """Return the contours, from outside in."""
    return [
        curve
        for k, regions in enumerate(contour_levels.regions)
        for curve in contours_of(regions, beads, k)
    ]


def centres(contour_levels: Levels, beads: Beads) -> list[PlaneCurve]:
    """Return the beads in thin regions and in the gaps between contours."""
    curves = list(contour_levels.thin)
    for k, gaps in enumerate(contour_levels.gaps):
        curves += [
            start_curve(curve, beads)
            for curve in centre_beads(gaps, beads, k + 1, contour_levels.regions[0])
        ]
    return curves


REACH = 1.7  # in spacings; maximum distance of contours to join
TRIES = 64  # number of candidate positions for a link between two contours
THINNEST = 0.3  # minimum bead share
# in spacings; minimum and maximum half width of a loop that replaces a centreline bead
LOOP = (0.05, 0.25)
# width of an opening: fraction of the width at which links leave the allowed gap open, and maximum
# fraction of the contour length
LINK_LENGTH, SHARE = 0.8, 0.2
INSIDE_SHARE = 1e-4  # fraction of a link that is excluded at each end in the crossing check


class Slant(NamedTuple):
    """Conditions for the position of a link.

    min_cosine: minimum cosine of the angle between the contours. straight: minimum ratio of chord
    to length of an opening. ahead: advance of links along the contour as a fraction of the contour
    distance (1 is 45 deg). uneven: maximum change of the contour distance along an opening, in
    spacings. clearance: clearance on either side of an opening, in spacings. opening: width of the
    opening as a fraction of the maximum. margin: distance between links and other contours, in
    spacings.
    """

    min_cosine: float
    straight: float
    ahead: float
    uneven: float = 0.35
    clearance: float = 0.4
    opening: float = 1.0
    margin: float = 0.2


SLANTS = (  # from the best to the last resort
    Slant(0.94, 0.985, 1.0),
    Slant(0.8, 0.95, 1.0),
    Slant(0.7, 0.9, 0.4),
    Slant(0.5, 0.8, 0.0),
    Slant(0.2, 0.6, 0.0, 0.8, 0.1),
    Slant(0.0, 0.4, 0.0, 1.2, 0.02, 0.5, 0.1),
    Slant(0.0, 0.3, 0.0, 1.6, 0.0, 0.25, 0.05),
)


class Link(NamedTuple):
    """Two parallel link lines that join an opening of a contour to an opening of another ring.

    leaves, returns: arc lengths, mm, on the contour, where the path leaves and returns. ring: index
    of the other ring. enters, exits: arc lengths, mm, on the other ring. sense: direction of motion
    along the other ring, 1 or -1.
    """

    leaves: float
    returns: float
    ring: int
    enters: float
    exits: float
    sense: int


class _Found(NamedTuple):
    """Candidate link from the ring `from_ring`.

    rank: deviation of the contour distance from the spacing, then arc length along the ring, mm;
    the candidate with the lowest rank wins.
    """

    rank: tuple[float, float]
    from_ring: int
    link: Link


def connect_contours(region: Region, inner: tuple[Region, ...], beads: Beads) -> list[PlaneCurve]:
    """Connect the contours of a region to one closed bead.

    Curves without a valid link position stay separate beads. A region too narrow for contours gets
    separate centreline beads only.

    Parameters
    ----------
    region : Region
        The region to fill, mm.
    inner : tuple of Region
        The region shrunk by `beads.inset`, mm; bead centrelines stay inside.
    beads : Beads
        Spacing, width, gap and chord error, mm.

    Returns
    -------
    list of PlaneCurve
        The connected bead, if any, then separate beads; none is shorter than `beads.shortest`.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and the region is locally narrower than a bead.
    """
    contour_levels = levels(region, inner, beads)
    loose = centres(contour_levels, beads)
    curves = long_enough(rounds(contour_levels, beads), beads.shortest)
    if not curves:
        return long_enough(loose, beads.shortest)
    loose = long_enough(loose, beads.shortest)
    alone = [*curves, *loose]
    wide = [_half(curve, curves, beads) for curve in loose]
    curves += [_loop(curve, half, beads) for curve, half in zip(loose, wide)]
    rings = [Ring(curve.points) for curve in curves]
    rings[0].take(-0.1 * beads.spacing, 0.1 * beads.spacing)
    links: list[list[Link]] = [[] for _ in rings]
    joined = _join(rings, links, beads)
    if len(joined) == 1:
        joined_curves = [replace(curves[0], kind="connected")]
    else:
        loops = len(rings) - len(loose)
        shares = [1.0] * loops + [
            _share(rings, loops + k, half, beads) for k, half in enumerate(wide)
        ]
        joined_curves = [_walked(rings, links, shares)]
    return joined_curves + [curve for number, curve in enumerate(alone) if number not in joined]


def _half(curve: PlaneCurve, contours: list[PlaneCurve], beads: Beads) -> float:
    """Return the half width, mm, of a loop that replaces a centreline bead.

    Each side of the loop is centred in one half of the gap between contours. A closed bead needs no
    loop and gets a half width of 0.
    """
    if curve.closed:
        return 0.0
    distance = nearest_among([(contour.points, True) for contour in contours], curve.points)[1]
    half = 0.5 * (float(distance.mean()) / beads.spacing - 0.5)
    return beads.spacing * min(max(half, LOOP[0]), LOOP[1])


def _loop(curve: PlaneCurve, half: float, beads: Beads) -> PlaneCurve:
    """Return a thin loop around an open curve; return a closed curve unchanged."""
    if curve.closed:
        return curve
    outlines = along([(curve.points, False)], half, beads.chord_error)
    return start_curve(PlaneCurve(outlines[0].borders()[0], True, curve.kind, curve.ring), beads)


def _join(rings: list[Ring], links: list[list[Link]], beads: Beads) -> set[int]:
    """Join rings to the first ring and to joined rings while valid link positions remain.

    Adds the links to `links` and returns the indices of the joined rings.
    """
    joined, entered = {0}, {0: 1}
    adjacent_pairs: dict[int, list[AdjacentRings]] = {}
    for pair in side_by_side(rings, REACH * beads.spacing):
        adjacent_pairs.setdefault(pair.to_ring, []).append(pair)
    placed: list[Array] = []
    for slant in SLANTS:
        waiting = [number for number in range(len(rings)) if number not in joined]
        while waiting:
            newly_joined = []
            for number in waiting:
                pairs = [
                    pair for pair in adjacent_pairs.get(number, ()) if pair.from_ring in joined
                ]
                candidates = [
                    candidate
                    for pair in pairs
                    if (
                        candidate := _place(
                            rings, pair, beads, slant, entered[pair.from_ring], placed
                        )
                    )
                ]
                if not candidates:
                    continue
                from_ring, link = min(candidates, key=lambda item: item.rank)[1:]
                links[from_ring].append(link)
                placed += _lines(rings[from_ring], rings[number], link)
                _take(rings[from_ring], rings[number], link)
                joined.add(number)
                entered[number] = link.sense
                newly_joined.append(number)
            if not newly_joined:
                break
            waiting = [number for number in waiting if number not in joined]
    return joined


def _place(
    rings: list[Ring],
    pair: AdjacentRings,
    beads: Beads,
    slant: Slant,
    sense: int,
    placed: list[Array],
) -> _Found | None:
    """Find the best link from the first ring of a pair, traversed with `sense`, to the second ring.

    The best link has the contour distance closest to the spacing, then the lowest arc length.
    Returns None if no position is valid. placed: lines (2, 2) of existing links.
    """
    from_ring, to_ring = rings[pair.from_ring], rings[pair.to_ring]
    spacing, gap = beads.spacing, slant.clearance * beads.spacing
    wide = (
        min(
            LINK_LENGTH * 2.0 * math.sqrt(spacing * beads.gap),
            math.sqrt(2.0) * spacing,
            SHARE * from_ring.length,
            SHARE * to_ring.length,
        )
        * slant.opening
    )
    arcs = pair.arcs[np.unique(np.linspace(0, len(pair.arcs) - 1, TRIES).astype(int))]
    first, second = from_ring.points_at(arcs), from_ring.points_at(arcs + sense * wide)
    feet, distance = to_ring.foot(first)
    feet_ahead, distance_ahead = to_ring.foot(second)
    lean = (sense * from_ring.way(arcs + 0.5 * sense * wide, wide) * to_ring.way(feet, wide)).sum(
        axis=1
    )
    turn = np.where(lean >= 0.0, 1, -1)
    shift = np.minimum(slant.ahead * 0.5 * (distance + distance_ahead), SHARE * to_ring.length)
    enters, exits = feet + turn * shift, feet_ahead + turn * shift
    span = np.remainder(turn * (exits - enters), to_ring.length)
    if not slant.ahead:  # both ends may project to one corner of a small contour
        exits = np.where(span < 0.3 * wide, enters + turn * wide, exits)
        span = np.remainder(turn * (exits - enters), to_ring.length)
    good = (np.abs(lean) >= slant.min_cosine) & (distance > 0.15 * spacing)
    good &= (span < (1.0 + 2.0 * slant.uneven) * wide) & (span > 0.3 * wide)
    good &= np.abs(distance - distance_ahead) < slant.uneven * spacing
    # an opening across a corner would leave the corner bare
    good &= np.hypot(*(second - first).T) > slant.straight * wide
    good &= (
        np.hypot(*(to_ring.points_at(exits) - to_ring.points_at(enters)).T) > slant.straight * span
    )
    for k in np.lexsort((arcs, np.round(np.abs(distance - spacing) / spacing, 1))):
        if not good[k]:
            continue
        low = min(arcs[k], arcs[k] + sense * wide)
        start = enters[k] if turn[k] > 0 else enters[k] - float(span[k])
        if not from_ring.is_free(low - gap, low + wide + gap) or not to_ring.is_free(
            start - gap, start + float(span[k]) + gap
        ):
            continue
        link = Link(
            float(arcs[k]),
            float(arcs[k] + sense * wide),
            pair.to_ring,
            float(enters[k]),
            float(exits[k]),
            -int(turn[k]),
        )
        if _is_clear(rings, pair, link, sense, placed, slant.margin * spacing):
            return _Found(
                (float(np.round(abs(distance[k] - spacing) / spacing, 1)), float(arcs[k])),
                pair.from_ring,
                link,
            )
    return None


def _lines(from_ring: Ring, to_ring: Ring, link: Link) -> list[Array]:
    """Return the two lines (2, 2) of a link."""
    ends = to_ring.points_at(np.array([link.enters, link.exits]))
    from_points = from_ring.points_at(np.array([link.leaves, link.returns]))
    return [np.stack([from_points[0], ends[0]]), np.stack([ends[1], from_points[1]])]


def _is_clear(
    rings: list[Ring],
    pair: AdjacentRings,
    link: Link,
    sense: int,
    placed: list[Array],
    margin: float,
) -> bool:
    """Whether the lines of a link cross neither each other, other links nor the joined rings.

    The openings of the joined rings do not count. All other rings must be at least `margin` mm
    away.
    """
    from_ring, to_ring = rings[pair.from_ring], rings[pair.to_ring]
    lines = _lines(from_ring, to_ring, link)
    share = np.linspace(0.0, 1.0, 7)[:, None]
    points = np.vstack([line[0] + share * (line[1] - line[0]) for line in lines])
    low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
    rests = [
        from_ring.piece(link.returns, link.leaves, sense),
        to_ring.piece(link.enters, link.exits, link.sense),
        *placed,
    ]
    for line in lines:
        inner = line + INSIDE_SHARE * np.array([[1.0], [-1.0]]) * (line[1] - line[0])
        if any(crossed(inner, obstacle) for obstacle in rests) or crossed(
            inner, lines[0] if line is lines[1] else lines[1]
        ):
            return False
    for number, ring in enumerate(rings):
        if number in (pair.from_ring, pair.to_ring):
            continue
        is_separate = (ring.points.min(axis=0) > high).any() or (
            ring.points.max(axis=0) < low
        ).any()
        if not is_separate and ring.foot(points)[1].min() < margin:
            return False
    return True


def _take(from_ring: Ring, to_ring: Ring, link: Link) -> None:
    """Mark the openings of a link as occupied on both rings."""
    from_ring.take(min(link.leaves, link.returns), max(link.leaves, link.returns))
    span = (link.sense * (link.enters - link.exits)) % to_ring.length
    start = link.exits if link.sense > 0 else link.enters
    to_ring.take(start, start + span)


def _share(rings: list[Ring], number: int, half: float, beads: Beads) -> float:
    """Return the bead share with which a ring fits between the neighbouring rings.

    half: half width of the loop, mm; 0 for a closed bead that needs no loop.
    """
    ring = rings[number]
    points = ring.points_at(np.linspace(0.0, ring.length, TRIES, endpoint=False))
    low, high = points.min(axis=0) - beads.spacing, points.max(axis=0) + beads.spacing
    distances = [
        neighbour.foot(points)[1]
        for k, neighbour in enumerate(rings)
        if k != number and ((neighbour.points > low) & (neighbour.points < high)).all(axis=1).any()
    ]
    distance = (
        np.minimum(np.min(distances, axis=0), beads.spacing)
        if distances
        else np.full(TRIES, beads.spacing)
    )
    if half == 0.0:  # a closed bead with neighbours on both sides
        return float(np.clip((2.0 * distance / beads.spacing - 1.0).mean(), THINNEST, 1.0))
    return float(np.clip(((distance + half) / beads.spacing - 0.5).mean(), THINNEST, 1.0))


def _walked(rings: list[Ring], links: list[list[Link]], shares: list[float]) -> PlaneCurve:
    """Build the connected bead from the start of the first ring; shares: bead share of each ring."""
    sections: list[Array] = []
    share: list[Array] = []

    def lay(number: int, start: float, end: float, sense: int) -> None:
        sections.append(rings[number].piece(start, end, sense))
        share.append(np.full(len(sections[-1]), shares[number]))

    def walk(number: int, start: float, distance: float, sense: int) -> None:
        """Follow a ring for `distance` mm from arc length `start`, including its joined rings."""
        ring, position = rings[number], start
        for link in sorted(
            links[number], key=lambda link: (sense * (link.leaves - start)) % ring.length
        ):
            lay(number, position, link.leaves, sense)
            next_ring = rings[link.ring]
            opened = (link.sense * (link.enters - link.exits)) % next_ring.length
            walk(link.ring, link.enters, next_ring.length - opened, link.sense)
            position = link.returns
        lay(number, position, start + sense * distance, sense)

    walk(0, 0.0, rings[0].length, 1)
    points, wide = np.vstack(sections), np.concatenate(share)
    is_separate: Mask = np.r_[True, np.abs(np.diff(points, axis=0)).max(axis=1) > 1e-9]
    if np.abs(points[0] - points[-1]).max() < 1e-9:
        is_separate[-1] = False
    return PlaneCurve(
        points[is_separate],
        True,
        "connected",
        0,
        share=None if wide.min() == 1.0 else wide[is_separate],
    )
