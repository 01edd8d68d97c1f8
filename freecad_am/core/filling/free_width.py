# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads narrower or wider than usual: so that contours come out even over the thickness of a region, and where others leave
them less than their usual room, so that layers do not get higher there."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.curves.plane_curve import arcs, dense, divided_by_step, nearest_among
from ..geometry.regions.region import DIGITS, WIDTH, Region
from ..geometry.regions.telling import select_significant
from ..types import Array, Index, Mask
from .curve import Beads, PlaneCurve

MORE = 1.002  # of the thickness, beside what the measure of it may be short of: a contour in the middle is not a thin loop
PLACES = 0.25  # of the spacing, mm between places at which widths are looked at
CENTRES = ("centre", "closing")  # kinds of beads that lie in what others leave
STEP = 0.2  # of the spacing, mm between places at which rooms are looked at
ROUND = 1.6  # arc over chord; a bead comes beside itself where it returns farther round than half a circle
SHARE_TOLERANCE = (
    0.04  # of the usual width; shares that a straight line tells as well need no point of their own
)
FIRST = {
    "contour": 0,
    "connected": 0,
    "spiral": 0,
    "line": 1,
    "zigzag": 1,
}  # who keeps its room; all others come last
LAST = 2
MOVED = ("contour", "connected", "spiral")
SMOOTHED = (
    1.0  # of the spacing, along a bead to either side, over which widths and moves are averaged
)
ALIKE = 0.95  # cosine of a turn; where a bead turns less it is moved by the mean of its edges
FARTHEST = 2.0  # times how far its edges move; no corner moves farther
ALONG = 0.02  # sine of the angle to the lines of a zigzag; what is turned more is a link


class _Edges(NamedTuple):
    """Short edges of all beads: their middles (n, 2), unit ways (n, 2), arc lengths (n,) mm, beads (n,) by their numbers;
    lengths (m,) mm of the beads that are closed, infinite of the others; half the length (n,) mm of each edge."""

    middles: Array
    ways: Array
    arcs: Array
    bead: Index
    around: Array
    halves: Array


def fitted(region: Region, beads: Beads, least: float, most: float) -> tuple[Beads, float]:
    """Beads of which a whole number fits into the thickest place of a region, and their share of the usual width, between
    least and most and as near to 1 as may be; the usual ones where there is no such number."""
    if least == most:
        return beads, 1.0
    width, thickness, share = 2.0 * beads.inset, MORE * (1.0 + WIDTH) * region.width, 1.0
    if thickness > width:
        count = int((thickness - width) / beads.spacing)  # more than one bead
        share = min(
            (
                thickness / (width + number * beads.spacing)
                for number in range(max(count - 1, 0), count + 3)
            ),
            key=lambda one: abs(math.log(one)),
        )
    if not least <= share <= most * MORE * (1.0 + WIDTH):
        share = 1.0
    return replace(
        beads, spacing=share * beads.spacing, width=share * width, gap=share * beads.gap
    ), share


def shared(
    region: Region,
    curves: Sequence[PlaneCurve],
    beads: Beads,
    share: float,
    least: float,
    most: float,
) -> Iterator[PlaneCurve]:
    """The curves with the share of the usual width that each of their points has: that of the fitted beads, of those in the
    middle what room their neighbours leave them. Between least and most."""
    others = [(curve.points, curve.closed) for curve in curves if curve.kind not in CENTRES]
    for curve in curves:
        if least == most or (share == 1.0 and (curve.kind not in CENTRES or curve.dot)):
            yield curve
        elif curve.kind in CENTRES and not curve.dot:
            points = _places(curve, PLACES * beads.spacing)
            distances = nearest_among(others, points)[1]
            yield replace(
                curve,
                points=points,
                share=np.clip(
                    share
                    * np.minimum(
                        region.nearest(points)[1] / beads.inset,
                        2.0 * distances / beads.spacing - 1.0,
                    ),
                    least,
                    most,
                ),
            )
        else:
            yield replace(
                curve,
                share=share * (np.ones(len(curve.points)) if curve.share is None else curve.share),
            )


def _places(curve: PlaneCurve, step: float) -> Array:
    """The points (n, 2) of a curve and more, at most `step` mm apart."""
    if curve.closed:
        return dense(curve.points, step)
    # an open one there and back is a ring, of which the way there is the first half
    points = dense(np.vstack([curve.points, curve.points[-2:0:-1]]), step)
    return points[: int(np.argmin(np.abs(points - curve.points[-1]).sum(axis=1))) + 1]


def narrowed(
    curves: Sequence[PlaneCurve], beads: Beads, angle: float, least: float
) -> tuple[PlaneCurve, ...]:
    """The curves with the share of their usual width that they have room for: halfway to others of their kind, and as far as
    those that come first reach, contours before lines before beads in the middle. Links of zigzags lay what their lines,
    which end before the contour, do not. angle: of the lines, rad. least: share that no bead is laid below."""
    dots = [curve for curve in curves if curve.dot]
    if dots:  # which are by themselves, as wide as they are to be
        rest = [curve for curve in curves if not curve.dot]
        return (*narrowed(rest, beads, angle, least), *dots) if rest else tuple(dots)
    lines, corners = zip(
        *(divided_by_step(curve.whole()[0], STEP * beads.spacing) for curve in curves)
    )
    edges = _edges(lines, [curve.closed for curve in curves])
    widths = _free_widths(
        edges,
        np.array([FIRST.get(curve.kind, LAST) for curve in curves], dtype=np.intp),
        beads.spacing,
    )
    share = widths.sum(axis=1) / beads.spacing
    aside = 0.5 * (widths[:, 0] - widths[:, 1])
    zigzags = np.array([curve.kind == "zigzag" for curve in curves])[edges.bead]
    turned = np.abs(edges.ways[:, 0] * np.sin(angle) - edges.ways[:, 1] * np.cos(angle)) > ALONG
    share = np.where(zigzags & turned, 2.0 * widths.min(axis=1) / beads.spacing, share)
    share = np.round(np.clip(share, least, 1.0), DIGITS)
    outer = 2.0 * beads.inset / beads.spacing  # the outermost keep their outer edge on the border
    factor = np.array(
        [(outer if curve.ring == 0 else 1.0) if _may_move(curve) else 0.0 for curve in curves]
    )
    aside = np.round(factor[edges.bead] * aside, DIGITS)
    cuts = np.searchsorted(edges.bead, np.arange(1, len(curves)))
    return tuple(
        _with(*one, beads.spacing)
        for one in zip(curves, lines, corners, np.split(share, cuts), np.split(aside, cuts))
    )


def _smoothed(line: Array, values: Array, closed: bool, reach: float) -> Array:
    """The values (n - 1,) of the edges of a line (n, 2), averaged over `reach` mm to either side: a bead whose width changes
    at once has a kink in its path, or a dent in its side."""
    way = arcs(line)
    length = way[-1]
    reach = min(reach, 0.5 * length)
    sums = np.r_[0.0, np.cumsum(values * np.diff(way))]
    if closed:
        ends = np.r_[way[:-1] - length, way, way[1:] + length]
        sums = np.r_[sums[:-1] - sums[-1], sums, sums[1:] + sums[-1]]
    else:
        ends = np.r_[-length, way, 2.0 * length]
        sums = np.r_[-length * values[0], sums, sums[-1] + length * values[-1]]
    middles = 0.5 * (way[1:] + way[:-1])
    rise = np.interp(middles + reach, ends, sums) - np.interp(middles - reach, ends, sums)
    return np.asarray(rise / (2.0 * reach))


def _may_move(curve: PlaneCurve) -> bool:
    """Whether a narrow bead is laid in the middle of its own room: not the lines of a zigzag, which its links join, nor
    lines that end on contours."""
    return curve.kind in MOVED or (curve.kind == "line" and curve.ring == 0)


def _edges(lines: Sequence[Array], closed: Sequence[bool]) -> _Edges:
    ways = [np.diff(line, axis=0) for line in lines]
    long = [np.hypot(*way.T) for way in ways]
    return _Edges(
        np.vstack([0.5 * (line[1:] + line[:-1]) for line in lines]),
        np.vstack([way / np.maximum(size, 1e-300)[:, None] for way, size in zip(ways, long)]),
        np.concatenate([np.cumsum(size) - 0.5 * size for size in long]),
        np.repeat(np.arange(len(lines)), [len(way) for way in ways]),
        np.array([size.sum() if is_closed else np.inf for size, is_closed in zip(long, closed)]),
        0.5 * np.concatenate(long),
    )


def _free_widths(edges: _Edges, rank: Index, spacing: float) -> Array:
    """Room (n, 2) in mm to the left and to the right of edges, at most half the spacing."""
    half = 0.5 * spacing
    free = np.full((len(edges.middles), 2), half)
    one, other = _neighbours(edges, spacing).T
    gap = edges.middles[other] - edges.middles[one]
    near = np.clip(
        -np.einsum("ni,ni->n", gap, edges.ways[other]), -edges.halves[other], edges.halves[other]
    )
    gap += near[:, None] * edges.ways[other]  # the nearest place of the other edge
    aside = edges.ways[one, 0] * gap[:, 1] - edges.ways[one, 1] * gap[:, 0]
    side = (aside < 0.0).astype(np.intp)
    radius = (gap**2).sum(axis=1) / np.maximum(
        2.0 * np.abs(aside), 1e-9 * spacing
    )  # of the circle that touches both
    lot = rank[edges.bead]
    for level in range(LAST + 1):
        mine = lot[one] == level
        equal = np.flatnonzero(mine & (lot[other] == level))
        np.minimum.at(free, (one[equal], side[equal]), radius[equal])
        before = np.flatnonzero(mine & (lot[other] < level))
        taken = free[other[before]].mean(axis=1)
        np.minimum.at(
            free, (one[before], side[before]), np.maximum(2.0 * radius[before] - taken, 0.0)
        )
    return free


def _neighbours(edges: _Edges, spacing: float) -> Index:
    """Pairs (m, 2), both ways, of edges nearer to each other than the spacing, but for those that follow one another."""
    pairs = cKDTree(edges.middles).query_pairs(spacing, output_type="ndarray")
    one, other = pairs.T
    chord = np.hypot(*(edges.middles[one] - edges.middles[other]).T)
    arc = np.abs(edges.arcs[one] - edges.arcs[other])
    arc = np.minimum(arc, edges.around[edges.bead[one]] - arc)
    pairs = pairs[(edges.bead[one] != edges.bead[other]) | (arc > ROUND * chord)]
    return np.asarray(np.vstack([pairs, pairs[:, ::-1]]), dtype=np.intp)


def _with(
    curve: PlaneCurve, line: Array, corners: Mask, share: Array, aside: Array, spacing: float
) -> PlaneCurve:
    """A curve with the shares (n - 1,) of the edges of its points (n, 2), moved to the left by `aside` (n - 1,) mm, and of
    these points no more than its corners (n,) and what tells the shares and how far it moves."""
    if share.min() > 1.0 - SHARE_TOLERANCE:
        return replace(curve, share=None)
    if aside.any():
        for _ in range(2):  # twice, so that the way has no kinks where an average begins
            share = _smoothed(line, share, curve.closed, SMOOTHED * spacing)
            aside = _smoothed(line, aside, curve.closed, SMOOTHED * spacing)
    ends = (
        np.r_[share[-1:], share, share[:1]] if curve.closed else np.r_[share[:1], share, share[-1:]]
    )
    wide = 0.5 * (ends[1:] + ends[:-1])
    kept = corners | select_significant(arcs(line), wide, SHARE_TOLERANCE)
    if aside.any():
        ways = _moves(line, aside, curve.closed)
        kept |= select_significant(arcs(line), np.hypot(*ways.T) / spacing, 0.25 * SHARE_TOLERANCE)
        line = line + ways
    if curve.closed:
        line, wide, kept = line[:-1], wide[:-1], kept[:-1]
    return replace(curve, points=line[kept], share=wide[kept])


def _moves(line: Array, aside: Array, closed: bool) -> Array:
    """How (n, 2) mm the points of a line (n, 2) move, so that its edges move to the left by `aside` (n - 1,) mm."""
    way = np.diff(line, axis=0)
    way /= np.maximum(np.hypot(*way.T), 1e-300)[:, None]
    left = np.stack([-way[:, 1], way[:, 0]], axis=1)
    ends = (left[-1:], left[:1]) if closed else (left[:1], left[-1:])
    before, after = np.vstack([ends[0], left]), np.vstack([left, ends[1]])
    sides = (aside[-1:], aside[:1]) if closed else (aside[:1], aside[-1:])
    first, second = np.r_[sides[0], aside], np.r_[aside, sides[1]]
    cosine = np.einsum("ni,ni->n", before, after)
    sine = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    both = before + after
    mean = (0.5 * (first + second))[:, None] * both / np.maximum(1.0 + cosine, 0.1)[:, None]
    # where both edges move square to themselves by their own amounts
    turned = np.where(np.abs(sine) > 1e-9, sine, 1.0)
    x = (first * after[:, 1] - second * before[:, 1]) / turned
    y = (second * before[:, 0] - first * after[:, 0]) / turned
    moves = np.where((cosine > ALIKE)[:, None], mean, np.stack([x, y], axis=1))
    far, most = np.hypot(*moves.T), FARTHEST * np.maximum(np.abs(first), np.abs(second))
    return np.asarray(moves * np.minimum(1.0, most / np.maximum(far, 1e-300))[:, None])
