# SPDX-License-Identifier: LGPL-2.1-or-later
"""All contours of a region in one closed bead: neighbours opened side by side and joined by two parallel links at 45 deg.

Two closed curves joined so are one closed curve again, whatever contours do: those that split, those round holes, and thin
loops about what would be beads in the middle. Nothing crosses; every second contour runs the other way.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..geometry.curves.plane_curve import nearest_among
from ..geometry.regions.region import Region, along
from ..types import Array, Mask
from .contours import centres, levels, rounds
from .curve import Beads, PlaneCurve, begun, long_enough
from .rings import AdjacentRings, Ring, crossed, side_by_side

REACH = 1.7  # spacings; contours farther apart are not joined
TRIES = 64  # places at which two contours may be joined
THINNEST = 0.3  # of the width; no bead is narrower
LOOP = (
    0.05,
    0.25,
)  # of the spacing: half of what a loop about a bead in the middle encloses, at least and at most
OPEN, SHARE = (
    0.8,
    0.2,
)  # of the width at which the gap allowed stays open beside links; of the length of a contour
INSIDE = 1e-4  # of a link, cut off at its ends when it is looked at


class Slant(NamedTuple):
    """What is asked of the place of a link: least cosine between the contours, least share of an opening that is straight,
    how far ahead links end, of the distance: 1 is 45 deg; by what share of the spacing the distance may differ, and what is
    kept on either side of an opening; the opening, of the widest there may be; and what links keep from other contours."""

    least: float
    straight: float
    ahead: float
    uneven: float = 0.35
    clearance: float = 0.4
    opening: float = 1.0
    near: float = 0.2


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
    """Where a contour is opened (from `leaves`, a stretch ahead) and joined to another, entered at `enters` and left at
    `parts`, run with the sense given; arc lengths, mm."""

    leaves: float
    returns: float
    other: int
    enters: float
    parts: float
    sense: int


class _Found(NamedTuple):
    """A link, the ring that it leaves, and what decides between links: how far off the spacing, how far along the ring."""

    rank: tuple[float, float]
    one: int
    link: Link


def connected(region: Region, inner: tuple[Region, ...], beads: Beads) -> list[PlaneCurve]:
    """One closed bead through all contours of a region; what has no place for links stays a bead of its own, as does the one
    bead of a region too narrow for contours. InfeasibleError THIN_REGION, see `Beads`."""
    found = levels(region, inner, beads)
    loose = centres(found, beads)
    curves = long_enough(rounds(found, beads), beads.shortest)
    if not curves:
        return long_enough(loose, beads.shortest)
    loose = long_enough(loose, beads.shortest)
    alone = [*curves, *loose]
    wide = [_half(curve, curves, beads) for curve in loose]
    curves += [_loop(curve, half, beads) for curve, half in zip(loose, wide)]
    rings = [Ring(curve.points) for curve in curves]
    rings[0].take(-0.1 * beads.spacing, 0.1 * beads.spacing)
    links: list[list[Link]] = [[] for _ in rings]
    joined = _joined(rings, links, beads)
    if len(joined) == 1:
        made = [replace(curves[0], kind="connected")]
    else:
        loops = len(rings) - len(loose)
        shares = [1.0] * loops + [
            _share(rings, loops + k, half, beads) for k, half in enumerate(wide)
        ]
        made = [_walked(rings, links, shares)]
    return made + [curve for number, curve in enumerate(alone) if number not in joined]


def _half(curve: PlaneCurve, contours: list[PlaneCurve], beads: Beads) -> float:
    """How far (mm) from a bead in the middle the sides of a loop about it run, so that each is in the middle of its half of
    the gap between contours; 0 where it is closed as it is."""
    if curve.closed:
        return 0.0
    away = nearest_among([(contour.points, True) for contour in contours], curve.points)[1]
    half = 0.5 * (float(away.mean()) / beads.spacing - 0.5)
    return beads.spacing * min(max(half, LOOP[0]), LOOP[1])


def _loop(curve: PlaneCurve, half: float, beads: Beads) -> PlaneCurve:
    """A closed curve, or a thin loop about an open one."""
    if curve.closed:
        return curve
    parts = along([(curve.points, False)], half, beads.chord_error)
    return begun(PlaneCurve(parts[0].borders()[0], True, curve.kind, curve.ring), beads)


def _joined(rings: list[Ring], links: list[list[Link]], beads: Beads) -> set[int]:
    """Joins rings to the first one, and to those joined to it, as long as there are places; the numbers of all."""
    joined, entered = {0}, {0: 1}
    near: dict[int, list[AdjacentRings]] = {}
    for pair in side_by_side(rings, REACH * beads.spacing):
        near.setdefault(pair.other, []).append(pair)
    placed: list[Array] = []
    for slant in SLANTS:
        waiting = [number for number in range(len(rings)) if number not in joined]
        while waiting:
            done = []
            for number in waiting:
                pairs = [pair for pair in near.get(number, ()) if pair.one in joined]
                found = [
                    made
                    for pair in pairs
                    if (made := _place(rings, pair, beads, slant, entered[pair.one], placed))
                ]
                if not found:
                    continue
                one, link = min(found, key=lambda item: item.rank)[1:]
                links[one].append(link)
                placed += _lines(rings[one], rings[number], link)
                _take(rings[one], rings[number], link)
                joined.add(number)
                entered[number] = link.sense
                done.append(number)
            if not done:
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
    """Where the first ring of a pair, run with `sense`, is joined to the second: the nearest to the spacing and the first on
    its way; None where there is no place. laid: the links there are, (2, 2) each."""
    one, other = rings[pair.one], rings[pair.other]
    spacing, gap = beads.spacing, slant.clearance * beads.spacing
    wide = (
        min(
            OPEN * 2.0 * math.sqrt(spacing * beads.gap),
            math.sqrt(2.0) * spacing,
            SHARE * one.length,
            SHARE * other.length,
        )
        * slant.opening
    )
    arcs = pair.arcs[np.unique(np.linspace(0, len(pair.arcs) - 1, TRIES).astype(int))]
    first, second = one.at(arcs), one.at(arcs + sense * wide)
    feet, away = other.foot(first)
    feet_ahead, away_ahead = other.foot(second)
    lean = (sense * one.way(arcs + 0.5 * sense * wide, wide) * other.way(feet, wide)).sum(axis=1)
    turn = np.where(lean >= 0.0, 1, -1)
    shift = np.minimum(slant.ahead * 0.5 * (away + away_ahead), SHARE * other.length)
    enters, parts = feet + turn * shift, feet_ahead + turn * shift
    span = np.remainder(turn * (parts - enters), other.length)
    if not slant.ahead:  # a corner of a small contour may be the nearest to both
        parts = np.where(span < 0.3 * wide, enters + turn * wide, parts)
        span = np.remainder(turn * (parts - enters), other.length)
    good = (np.abs(lean) >= slant.least) & (away > 0.15 * spacing)
    good &= (span < (1.0 + 2.0 * slant.uneven) * wide) & (span > 0.3 * wide)
    good &= np.abs(away - away_ahead) < slant.uneven * spacing
    good &= (
        np.hypot(*(second - first).T) > slant.straight * wide
    )  # an opening round a corner would leave it bare
    good &= np.hypot(*(other.at(parts) - other.at(enters)).T) > slant.straight * span
    for k in np.lexsort((arcs, np.round(np.abs(away - spacing) / spacing, 1))):
        if not good[k]:
            continue
        low = min(arcs[k], arcs[k] + sense * wide)
        start = enters[k] if turn[k] > 0 else enters[k] - float(span[k])
        if not one.is_free(low - gap, low + wide + gap) or not other.is_free(
            start - gap, start + float(span[k]) + gap
        ):
            continue
        link = Link(
            float(arcs[k]),
            float(arcs[k] + sense * wide),
            pair.other,
            float(enters[k]),
            float(parts[k]),
            -int(turn[k]),
        )
        if _is_clear(rings, pair, link, sense, placed, slant.near * spacing):
            return _Found(
                (float(np.round(abs(away[k] - spacing) / spacing, 1)), float(arcs[k])),
                pair.one,
                link,
            )
    return None


def _lines(one: Ring, other: Ring, link: Link) -> list[Array]:
    """The two lines (2, 2) of a link."""
    ends = other.at(np.array([link.enters, link.parts]))
    own = one.at(np.array([link.leaves, link.returns]))
    return [np.stack([own[0], ends[0]]), np.stack([ends[1], own[1]])]


def _is_clear(
    rings: list[Ring], pair: AdjacentRings, link: Link, sense: int, placed: list[Array], near: float
) -> bool:
    """Whether nothing comes between the lines of a link: no other ring, no other link, and neither of the rings it joins
    but where they are opened."""
    one, other = rings[pair.one], rings[pair.other]
    lines = _lines(one, other, link)
    share = np.linspace(0.0, 1.0, 7)[:, None]
    places = np.vstack([line[0] + share * (line[1] - line[0]) for line in lines])
    low, high = places.min(axis=0) - near, places.max(axis=0) + near
    rests = [
        one.piece(link.returns, link.leaves, sense),
        other.piece(link.enters, link.parts, link.sense),
        *placed,
    ]
    for line in lines:
        inner = line + INSIDE * np.array([[1.0], [-1.0]]) * (line[1] - line[0])
        if any(crossed(inner, rest) for rest in rests) or crossed(
            inner, lines[0] if line is lines[1] else lines[1]
        ):
            return False
    for number, ring in enumerate(rings):
        if number in (pair.one, pair.other):
            continue
        apart = (ring.points.min(axis=0) > high).any() or (ring.points.max(axis=0) < low).any()
        if not apart and ring.foot(places)[1].min() < near:
            return False
    return True


def _take(one: Ring, other: Ring, link: Link) -> None:
    """The openings of a link are taken."""
    one.take(min(link.leaves, link.returns), max(link.leaves, link.returns))
    span = (link.sense * (link.enters - link.parts)) % other.length
    start = link.parts if link.sense > 0 else link.enters
    other.take(start, start + span)


def _share(rings: list[Ring], number: int, half: float, beads: Beads) -> float:
    """What of their usual width the two sides of a loop, so far (mm) from its middle, have between its neighbours."""
    ring = rings[number]
    places = ring.at(np.linspace(0.0, ring.length, TRIES, endpoint=False))
    low, high = places.min(axis=0) - beads.spacing, places.max(axis=0) + beads.spacing
    near = [
        other.foot(places)[1]
        for k, other in enumerate(rings)
        if k != number and ((other.points > low) & (other.points < high)).all(axis=1).any()
    ]
    away = (
        np.minimum(np.min(near, axis=0), beads.spacing) if near else np.full(TRIES, beads.spacing)
    )
    if half == 0.0:  # a closed bead with neighbours on both sides
        return float(np.clip((2.0 * away / beads.spacing - 1.0).mean(), THINNEST, 1.0))
    return float(np.clip(((away + half) / beads.spacing - 0.5).mean(), THINNEST, 1.0))


def _walked(rings: list[Ring], links: list[list[Link]], shares: list[float]) -> PlaneCurve:
    """The whole, from the start of the first ring, each ring with its share of the width."""
    pieces: list[Array] = []
    share: list[Array] = []

    def lay(number: int, start: float, end: float, sense: int) -> None:
        pieces.append(rings[number].piece(start, end, sense))
        share.append(np.full(len(pieces[-1]), shares[number]))

    def walk(number: int, start: float, way: float, sense: int) -> None:
        """Along a ring for `way` mm from an arc length, and through all that is joined to it."""
        ring, at = rings[number], start
        for link in sorted(
            links[number], key=lambda link: (sense * (link.leaves - start)) % ring.length
        ):
            lay(number, at, link.leaves, sense)
            other = rings[link.other]
            opened = (link.sense * (link.enters - link.parts)) % other.length
            walk(link.other, link.enters, other.length - opened, link.sense)
            at = link.returns
        lay(number, at, start + sense * way, sense)

    walk(0, 0.0, rings[0].length, 1)
    whole, wide = np.vstack(pieces), np.concatenate(share)
    apart: Mask = np.r_[True, np.abs(np.diff(whole, axis=0)).max(axis=1) > 1e-9]
    if np.abs(whole[0] - whole[-1]).max() < 1e-9:
        apart[-1] = False
    return PlaneCurve(
        whole[apart], True, "connected", 0, share=None if wide.min() == 1.0 else wide[apart]
    )
