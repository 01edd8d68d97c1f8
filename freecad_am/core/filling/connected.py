# SPDX-License-Identifier: LGPL-2.1-or-later
"""All contours of a region in one closed bead: neighbours opened side by side and joined by two parallel links at 45 deg.

Two closed curves joined so are one closed curve again, whatever contours do: those that split, those round holes, and thin
loops about what would be beads in the middle. Nothing crosses; every second contour runs the other way.
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

# ---- Closed curves by arc length, and the places where two of them run side by side

MARK = 0.25  # of the reach, distance between samples of a ring in the search for adjacent rings


class AdjacentRings(NamedTuple):
    """Two rings by number, and arcs (n,) mm of the first that are near the second."""

    from_ring: int
    to_ring: int
    arcs: Array


class Ring:
    """A closed curve (n, 2), and its occupied intervals of arc length, mm."""

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
            Length of ring that a direction is the mean of, mm.

        Returns
        -------
        (n, 2) array
            Unit vectors along the ring.
        """
        ahead = self.points_at(arcs + 0.5 * step) - self.points_at(arcs - 0.5 * step)
        return np.asarray(ahead / np.maximum(np.hypot(*ahead.T), 1e-300)[:, None])

    def foot(self, points: Array) -> tuple[Array, Array]:
        """Find the places of the ring nearest to points.

        Parameters
        ----------
        points : (n, 2) array
            Points, mm.

        Returns
        -------
        arcs : (n,) array
            Arc lengths of the nearest places, mm.
        distances : (n,) array
            Distances of the points from them, mm.
        """
        feet = nearest(self.points, points, closed=True)
        return self.arc[feet.edge] + feet.share * np.diff(self.arc)[feet.edge], feet.distance

    def piece(self, start: float, end: float, sense: int) -> Array:
        """Return the points of the ring from one arc length to another.

        Parameters
        ----------
        start, end : float
            Arc lengths, mm, any number of times round.
        sense : int
            1 with the ring, -1 against it.

        Returns
        -------
        (m, 2) array
            Points in the order of travel, both ends included, mm.
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
        """Whether nothing of the arc from start to end is taken."""
        return not any(
            (low - start) % self.length < end - start or (start - low) % self.length < high - low
            for low, high in self._taken
        )

    def take(self, start: float, end: float) -> None:
        """Occupy the arc from start to end."""
        self._taken.append((start, end))


def side_by_side(rings: Sequence[Ring], reach: float) -> list[AdjacentRings]:
    """All pairs of rings that come nearer to each other than `reach` mm, both ways round."""
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
    """Return whether a straight line crosses a polyline.

    Parameters
    ----------
    line : (2, 2) array
        Ends of the line, mm.
    polyline : (n, 2) array
        An open polyline, mm.

    Returns
    -------
    bool
        True if an edge crosses the line, its ends included.
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


# ---- The contours, and the links that join them


@dataclass(frozen=True)
class Levels:
    """regions[k]: the regions whose borders are the contours k; gaps[k]: the open regions inside that have room for the allowed gap."""

    regions: tuple[tuple[Region, ...], ...]
    gaps: tuple[tuple[Region, ...], ...]
    thin: list[PlaneCurve]  # beads in regions narrower than a bead


def levels(region: Region, inner: tuple[Region, ...], beads: Beads) -> Levels:
    """Return the contours of a region, level by level from outside in, with the gaps inside each.

    Each contour is parallel to the border, not to the contour before, so that errors do not add.
    Contours shorter than `beads.shortest` are left out, for the beads in the middle.

    Parameters
    ----------
    region : Region
        The region to fill, mm.
    inner : tuple of Region
        Allowed positions of bead middles: the region shrunk by `beads.inset`.
    beads : Beads
        Spacing, width, gap and chord error, mm.

    Returns
    -------
    Levels
        Regions bounded by contours and open regions of each level, and beads in thin places.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and a place is narrower than a bead.
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
    """Return closed contours from outside in, then the beads in their middle.

    Parameters
    ----------
    region : Region
        The region to fill, mm.
    inner : tuple of Region
        Allowed positions of bead middles: the region shrunk by `beads.inset`.
    beads : Beads
        Spacing, width, gap and chord error, mm.

    Returns
    -------
    list of PlaneCurve
        Beads in the plane of the region; short ones included.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and a place is narrower than a bead.
    """
    contour_levels = levels(region, inner, beads)
    return rounds(contour_levels, beads) + centres(contour_levels, beads)


def rounds(contour_levels: Levels, beads: Beads) -> list[PlaneCurve]:
    """The contours, from outside in."""
    return [
        curve
        for k, regions in enumerate(contour_levels.regions)
        for curve in contours_of(regions, beads, k)
    ]


def centres(contour_levels: Levels, beads: Beads) -> list[PlaneCurve]:
    """The beads in the gaps of contours, and in thin places."""
    curves = list(contour_levels.thin)
    for k, gaps in enumerate(contour_levels.gaps):
        curves += [
            start_curve(curve, beads)
            for curve in centre_beads(gaps, beads, k + 1, contour_levels.regions[0])
        ]
    return curves


REACH = 1.7  # spacings; contours farther apart are not joined
TRIES = 64  # places at which two contours may be joined
THINNEST = 0.3  # of the width; minimum width of a bead
LOOP = (
    0.05,
    0.25,
)  # of the spacing: half the width that a loop about a middle bead encloses, least and largest
LINK_LENGTH, SHARE = (
    0.8,
    0.2,
)  # of the width at which the allowed gap stays open next to links; of the length of a contour
INSIDE_SHARE = 1e-4  # of a link, cut off at its ends in the check


class Slant(NamedTuple):
    """Conditions for the position of a link.

    min_cosine: between the contours. straight: least straight share of an opening. ahead: how far
    ahead links end, as a share of the distance (1 is 45 deg). uneven: allowed deviation of the
    distance, as a share of the spacing. clearance: on either side of an opening. opening: share of
    the widest possible one. margin: between links and other contours.
    """

    min_cosine: float
    straight: float
    ahead: float
    uneven: float = 0.35
    clearance: float = 0.4
    opening: float = 1.0
    margin: float = 0.2


SLANTS = (  # the best first
    Slant(0.94, 0.985, 1.0),
    Slant(0.8, 0.95, 1.0),
    Slant(0.7, 0.9, 0.4),
    Slant(0.5, 0.8, 0.0),
    Slant(0.2, 0.6, 0.0, 0.8, 0.1),
    Slant(0.0, 0.4, 0.0, 1.2, 0.02, 0.5, 0.1),
    Slant(0.0, 0.3, 0.0, 1.6, 0.0, 0.25, 0.05),
)


class Link(NamedTuple):
    """An opening of a contour (from `leaves`, a stretch ahead) joined to another ring, entered at `enters` and left at `exits`, run
    with the given sense; arc lengths, mm.
    """

    leaves: float
    returns: float
    ring: int
    enters: float
    exits: float
    sense: int


class _Found(NamedTuple):
    """A link, the ring that it leaves, and what decides between links: how far off the spacing, how far along the ring."""

    rank: tuple[float, float]
    from_ring: int
    link: Link


def connect_contours(region: Region, inner: tuple[Region, ...], beads: Beads) -> list[PlaneCurve]:
    """Return one closed bead through the contours of a region.

    Curves without a position for links stay separate beads, as does the only bead of a region too
    narrow for contours.

    Parameters
    ----------
    region : Region
        The region to fill, mm.
    inner : tuple of Region
        Allowed positions of bead middles: the region shrunk by `beads.inset`.
    beads : Beads
        Spacing, width, gap and chord error, mm.

    Returns
    -------
    list of PlaneCurve
        The connected bead first, if any, then separate ones; none is shorter than `beads.shortest`.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and a place is narrower than a bead.
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
    """How far (mm) from a bead in the middle the sides of a loop about it run, so that each is in the middle of its half of
    the gap between contours; 0 where it is closed as it is."""
    if curve.closed:
        return 0.0
    distance = nearest_among([(contour.points, True) for contour in contours], curve.points)[1]
    half = 0.5 * (float(distance.mean()) / beads.spacing - 0.5)
    return beads.spacing * min(max(half, LOOP[0]), LOOP[1])


def _loop(curve: PlaneCurve, half: float, beads: Beads) -> PlaneCurve:
    """A closed curve, or a thin loop about an open one."""
    if curve.closed:
        return curve
    outlines = along([(curve.points, False)], half, beads.chord_error)
    return start_curve(PlaneCurve(outlines[0].borders()[0], True, curve.kind, curve.ring), beads)


def _join(rings: list[Ring], links: list[list[Link]], beads: Beads) -> set[int]:
    """Join rings to the first one, and to rings already joined, as long as positions remain; the numbers of the joined rings."""
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
    """The link from the first ring of a pair, run with `sense`, to the second: the nearest to the spacing and the first along its
    ring; None without any position. placed: the present links, (2, 2) each.
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
    if not slant.ahead:  # a corner of a small contour may be the nearest to both
        exits = np.where(span < 0.3 * wide, enters + turn * wide, exits)
        span = np.remainder(turn * (exits - enters), to_ring.length)
    good = (np.abs(lean) >= slant.min_cosine) & (distance > 0.15 * spacing)
    good &= (span < (1.0 + 2.0 * slant.uneven) * wide) & (span > 0.3 * wide)
    good &= np.abs(distance - distance_ahead) < slant.uneven * spacing
    good &= (
        np.hypot(*(second - first).T) > slant.straight * wide
    )  # an opening round a corner would leave it bare
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
    """The two lines (2, 2) of a link."""
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
    """Whether nothing comes between the lines of a link: no other ring, no other link, and neither of the rings it joins
    but where they are opened."""
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
    """The openings of a link are taken."""
    from_ring.take(min(link.leaves, link.returns), max(link.leaves, link.returns))
    span = (link.sense * (link.enters - link.exits)) % to_ring.length
    start = link.exits if link.sense > 0 else link.enters
    to_ring.take(start, start + span)


def _share(rings: list[Ring], number: int, half: float, beads: Beads) -> float:
    """The share of the usual width that the two sides of a loop, `half` mm from its middle, have between its neighbours."""
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
    """The whole, from the start of the first ring, each ring with its share of the width."""
    sections: list[Array] = []
    share: list[Array] = []

    def lay(number: int, start: float, end: float, sense: int) -> None:
        sections.append(rings[number].piece(start, end, sense))
        share.append(np.full(len(sections[-1]), shares[number]))

    def walk(number: int, start: float, distance: float, sense: int) -> None:
        """Along a ring for `distance` mm from an arc length, and through all that is joined to it."""
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
