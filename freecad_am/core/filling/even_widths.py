# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adjust bead widths.

Contours get a width such that a whole number of beads fits the thickness of a region. Beads closer
together than the spacing are narrowed, so that the layer does not get too high.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.curves.plane_curve import arcs, dense, divided_by_step, nearest_among
from ..geometry.regions.region import DIGITS, WIDTH, Region, select_significant
from ..types import Array, Index, Mask
from .centre import Beads, PlaneCurve

# factor on the thickness beyond its measurement error, so that the innermost contour does not
# become a thin loop
THICKNESS_MARGIN = 1.002
PLACES = 0.25  # in spacings; sample distance of widths
CENTRES = ("centre", "closing")  # kinds of beads that fill gaps between other beads
STEP = 0.2  # in spacings; sample distance of the free width
ROUND = 1.6  # minimum ratio of arc to chord; a bead this curved can be its own neighbour
SHARE_TOLERANCE = 0.04  # tolerance of bead shares in the linear interpolation between points
# priority of kinds; a bead of lower rank keeps its width, unlisted kinds have MIDDLE_RANK
KIND_RANKS = {
    "contour": 0,
    "connected": 0,
    "spiral": 0,
    "line": 1,
    "zigzag": 1,
}
MIDDLE_RANK = 2
MOVED = ("contour", "connected", "spiral")
# in spacings; length along a bead, to either side, over which widths and shifts are averaged
SMOOTHED = 1.0
# cosine of the angle between two edges; at smaller angles the point gets the mean shift of both
# edges
PARALLEL_COSINE = 0.95
MAX_MOVE_RATIO = 2.0  # maximum ratio of the shift of a corner to the shifts of its edges
ALONG = 0.02  # sine of the angle to the lines of a zigzag; edges at larger angles are links


class _Edges(NamedTuple):
    """Short edges of beads.

    middles: (n, 2) midpoints, mm. directions: (n, 2) unit vectors. arcs: (n,) arc lengths of the
    midpoints, mm. bead: (n,) bead index of each edge. around: (m,) lengths of the beads, mm,
    infinite for open beads. halves: (n,) half lengths of the edges, mm.
    """

    middles: Array
    directions: Array
    arcs: Array
    bead: Index
    around: Array
    halves: Array


def fit_beads(
    region: Region, beads: Beads, min_share: float, max_share: float
) -> tuple[Beads, float]:
    """Adjust the bead width so that a whole number of beads fits the maximum thickness of a region.

    Parameters
    ----------
    region : Region
        The region, mm.
    beads : Beads
        Beads of nominal width.
    min_share, max_share : float
        Minimum and maximum bead share; equal values disable the adjustment.

    Returns
    -------
    beads : Beads
        Beads with spacing, width and gap scaled by the bead share; unchanged if no number of beads
        fits.
    share : float
        Bead share closest to 1 that fits; 1 if none fits.
    """
    if min_share == max_share:
        return beads, 1.0
    width, thickness, share = (
        2.0 * beads.inset,
        THICKNESS_MARGIN * (1.0 + WIDTH) * region.width,
        1.0,
    )
    if thickness > width:
        count = int((thickness - width) / beads.spacing)  # more than one bead
        share = min(
            (
                thickness / (width + number * beads.spacing)
                for number in range(max(count - 1, 0), count + 3)
            ),
            key=lambda candidate: abs(math.log(candidate)),
        )
    if not min_share <= share <= max_share * THICKNESS_MARGIN * (1.0 + WIDTH):
        share = 1.0
    return replace(
        beads, spacing=share * beads.spacing, width=share * width, gap=share * beads.gap
    ), share


def share_widths(
    region: Region,
    curves: Sequence[PlaneCurve],
    beads: Beads,
    share: float,
    min_share: float,
    max_share: float,
) -> Iterator[PlaneCurve]:
    """Yield curves with the bead share at each point.

    Contours get the fitted bead share. Centreline beads get the width of the space between their
    neighbours.

    Parameters
    ----------
    region : Region
        The filled region, mm.
    curves : sequence of PlaneCurve
        Beads that fill the region.
    beads : Beads
        The fitted beads, see `fit_beads`.
    share : float
        Bead share of the fitted beads.
    min_share, max_share : float
        Minimum and maximum bead share of centreline beads; equal values disable the adjustment.

    Yields
    ------
    PlaneCurve
        The curves in the given order; centreline beads get points at most PLACES spacings apart.
    """
    other_lines = [(curve.points, curve.closed) for curve in curves if curve.kind not in CENTRES]
    for curve in curves:
        if min_share == max_share or (share == 1.0 and (curve.kind not in CENTRES or curve.dot)):
            yield curve
        elif curve.kind in CENTRES and not curve.dot:
            points = _places(curve, PLACES * beads.spacing)
            distances = nearest_among(other_lines, points)[1]
            yield replace(
                curve,
                points=points,
                share=np.clip(
                    share
                    * np.minimum(
                        region.nearest(points)[1] / beads.inset,
                        2.0 * distances / beads.spacing - 1.0,
                    ),
                    min_share,
                    max_share,
                ),
            )
        else:
            yield replace(
                curve,
                share=share * (np.ones(len(curve.points)) if curve.share is None else curve.share),
            )


def _places(curve: PlaneCurve, step: float) -> Array:
    """Return the points of a curve with points added, (n, 2), at most `step` mm apart."""
    if curve.closed:
        return dense(curve.points, step)
    # `dense` takes rings: an open curve traversed forwards and back is a ring; keep its forward
    # half
    points = dense(np.vstack([curve.points, curve.points[-2:0:-1]]), step)
    return points[: int(np.argmin(np.abs(points - curve.points[-1]).sum(axis=1))) + 1]


def narrow_beads(
    curves: Sequence[PlaneCurve], beads: Beads, angle: float, min_share: float
) -> tuple[PlaneCurve, ...]:
    """Narrow beads to the space between their neighbours.

    A bead extends halfway to neighbours of equal priority, and up to the edge of neighbours of
    higher priority. Contours have the highest priority, then lines, then centreline beads. Links of
    zigzags fill the area beyond the line ends.

    Parameters
    ----------
    curves : sequence of PlaneCurve
        Beads of one region, at least one.
    beads : Beads
        Spacing and width, mm.
    angle : float
        Direction of the lines of zigzags from x of the plane, rad.
    min_share : float
        Minimum bead share.

    Returns
    -------
    tuple of PlaneCurve
        The curves with bead shares of at most 1. Contours, and lines that do not end on contours,
        are centred between their neighbours. Dots come last, unchanged.
    """
    dots = [curve for curve in curves if curve.dot]
    if dots:  # dots are isolated and already have their width
        other_curves = [curve for curve in curves if not curve.dot]
        return (
            (*narrow_beads(other_curves, beads, angle, min_share), *dots)
            if other_curves
            else tuple(dots)
        )
    lines, corners = zip(
        *(divided_by_step(curve.closed_points()[0], STEP * beads.spacing) for curve in curves)
    )
    edges = _edges(lines, [curve.closed for curve in curves])
    widths = _free_widths(
        edges,
        np.array([KIND_RANKS.get(curve.kind, MIDDLE_RANK) for curve in curves], dtype=np.intp),
        beads.spacing,
    )
    share = widths.sum(axis=1) / beads.spacing
    aside = 0.5 * (widths[:, 0] - widths[:, 1])
    zigzags = np.array([curve.kind == "zigzag" for curve in curves])[edges.bead]
    turned = (
        np.abs(edges.directions[:, 0] * np.sin(angle) - edges.directions[:, 1] * np.cos(angle))
        > ALONG
    )
    share = np.where(zigzags & turned, 2.0 * widths.min(axis=1) / beads.spacing, share)
    share = np.round(np.clip(share, min_share, 1.0), DIGITS)
    outer = 2.0 * beads.inset / beads.spacing  # keeps the edge of outermost beads on the border
    factor = np.array(
        [(outer if curve.ring == 0 else 1.0) if _may_move(curve) else 0.0 for curve in curves]
    )
    aside = np.round(factor[edges.bead] * aside, DIGITS)
    cuts = np.searchsorted(edges.bead, np.arange(1, len(curves)))
    return tuple(
        _with(*row, beads.spacing)
        for row in zip(curves, lines, corners, np.split(share, cuts), np.split(aside, cuts))
    )


def _smoothed(line: Array, values: Array, closed: bool, reach: float) -> Array:
    """Average the edge values (n - 1,) of a line (n, 2) over `reach` mm to either side.

    An abrupt change of width would cause a kink in the path or a dent in the side of the bead.
    """
    arc = arcs(line)
    length = arc[-1]
    reach = min(reach, 0.5 * length)
    sums = np.r_[0.0, np.cumsum(values * np.diff(arc))]
    if closed:
        ends = np.r_[arc[:-1] - length, arc, arc[1:] + length]
        sums = np.r_[sums[:-1] - sums[-1], sums, sums[1:] + sums[-1]]
    else:
        ends = np.r_[-length, arc, 2.0 * length]
        sums = np.r_[-length * values[0], sums, sums[-1] + length * values[-1]]
    middles = 0.5 * (arc[1:] + arc[:-1])
    rise = np.interp(middles + reach, ends, sums) - np.interp(middles - reach, ends, sums)
    return np.asarray(rise / (2.0 * reach))


def _may_move(curve: PlaneCurve) -> bool:
    """Whether a narrowed bead may shift to be centred between its neighbours.

    Lines of zigzags stay because links join them, and lines that end on contours stay.
    """
    return curve.kind in MOVED or (curve.kind == "line" and curve.ring == 0)


def _edges(lines: Sequence[Array], closed: Sequence[bool]) -> _Edges:
    chords = [np.diff(line, axis=0) for line in lines]
    long = [np.hypot(*chord.T) for chord in chords]
    return _Edges(
        np.vstack([0.5 * (line[1:] + line[:-1]) for line in lines]),
        np.vstack([chord / np.maximum(size, 1e-300)[:, None] for chord, size in zip(chords, long)]),
        np.concatenate([np.cumsum(size) - 0.5 * size for size in long]),
        np.repeat(np.arange(len(lines)), [len(chord) for chord in chords]),
        np.array([size.sum() if is_closed else np.inf for size, is_closed in zip(long, closed)]),
        0.5 * np.concatenate(long),
    )


def _free_widths(edges: _Edges, rank: Index, spacing: float) -> Array:
    """Return the free half width (n, 2), mm, left and right of edges, at most half the spacing.

    rank: (m,) priority of each bead, see `KIND_RANKS`.
    """
    half = 0.5 * spacing
    free = np.full((len(edges.middles), 2), half)
    i, j = _neighbours(edges, spacing).T
    gap = edges.middles[j] - edges.middles[i]
    foot = np.clip(
        -np.einsum("ni,ni->n", gap, edges.directions[j]), -edges.halves[j], edges.halves[j]
    )
    gap += foot[:, None] * edges.directions[j]  # to the nearest point of edge j
    aside = edges.directions[i, 0] * gap[:, 1] - edges.directions[i, 1] * gap[:, 0]
    side = (aside < 0.0).astype(np.intp)
    # radius of the circle that touches both edges
    radius = (gap**2).sum(axis=1) / np.maximum(2.0 * np.abs(aside), 1e-9 * spacing)
    lot = rank[edges.bead]
    for level in range(MIDDLE_RANK + 1):
        in_rank = lot[i] == level
        equal = np.flatnonzero(in_rank & (lot[j] == level))
        np.minimum.at(free, (i[equal], side[equal]), radius[equal])
        earlier = np.flatnonzero(in_rank & (lot[j] < level))
        used = free[j[earlier]].mean(axis=1)
        np.minimum.at(
            free, (i[earlier], side[earlier]), np.maximum(2.0 * radius[earlier] - used, 0.0)
        )
    return free


def _neighbours(edges: _Edges, spacing: float) -> Index:
    """Find pairs (m, 2) of edges closer than the spacing, in both orders.

    Edges of the same bead count only if the bead turns back between them (`ROUND`).
    """
    pairs = cKDTree(edges.middles).query_pairs(spacing, output_type="ndarray")
    i, j = pairs.T
    chord = np.hypot(*(edges.middles[i] - edges.middles[j]).T)
    arc = np.abs(edges.arcs[i] - edges.arcs[j])
    arc = np.minimum(arc, edges.around[edges.bead[i]] - arc)
    pairs = pairs[(edges.bead[i] != edges.bead[j]) | (arc > ROUND * chord)]
    return np.asarray(np.vstack([pairs, pairs[:, ::-1]]), dtype=np.intp)


def _with(
    curve: PlaneCurve, line: Array, corners: Mask, share: Array, aside: Array, spacing: float
) -> PlaneCurve:
    """Return a curve with the bead shares (n - 1,) of the edges of a line (n, 2).

    Edges shift to the left by `aside` (n - 1,) mm. The result keeps the corners (n,) of the line
    and the points that resolve bead shares and shifts.
    """
    if share.min() > 1.0 - SHARE_TOLERANCE:
        return replace(curve, share=None)
    if aside.any():
        for _ in range(2):  # a single moving average would leave kinks in the path
            share = _smoothed(line, share, curve.closed, SMOOTHED * spacing)
            aside = _smoothed(line, aside, curve.closed, SMOOTHED * spacing)
    ends = (
        np.r_[share[-1:], share, share[:1]] if curve.closed else np.r_[share[:1], share, share[-1:]]
    )
    wide = 0.5 * (ends[1:] + ends[:-1])
    is_kept = corners | select_significant(arcs(line), wide, SHARE_TOLERANCE)
    if aside.any():
        moves = _moves(line, aside, curve.closed)
        is_kept |= select_significant(
            arcs(line), np.hypot(*moves.T) / spacing, 0.25 * SHARE_TOLERANCE
        )
        line = line + moves
    if curve.closed:
        line, wide, is_kept = line[:-1], wide[:-1], is_kept[:-1]
    return replace(curve, points=line[is_kept], share=wide[is_kept])


def _moves(line: Array, aside: Array, closed: bool) -> Array:
    """Return the point shifts (n, 2), mm, that move the edges of a line left by `aside` (n - 1,) mm."""
    direction = np.diff(line, axis=0)
    direction /= np.maximum(np.hypot(*direction.T), 1e-300)[:, None]
    normal = np.stack([-direction[:, 1], direction[:, 0]], axis=1)
    ends = (normal[-1:], normal[:1]) if closed else (normal[:1], normal[-1:])
    left_in, left_out = np.vstack([ends[0], normal]), np.vstack([normal, ends[1]])
    sides = (aside[-1:], aside[:1]) if closed else (aside[:1], aside[-1:])
    aside_in, second = np.r_[sides[0], aside], np.r_[aside, sides[1]]
    cosine = np.einsum("ni,ni->n", left_in, left_out)
    sine = left_in[:, 0] * left_out[:, 1] - left_in[:, 1] * left_out[:, 0]
    sum_ = left_in + left_out
    mean = (0.5 * (aside_in + second))[:, None] * sum_ / np.maximum(1.0 + cosine, 0.1)[:, None]
    # intersection of both edges, each shifted along its normal
    turned = np.where(np.abs(sine) > 1e-9, sine, 1.0)
    x = (aside_in * left_out[:, 1] - second * left_in[:, 1]) / turned
    y = (second * left_in[:, 0] - aside_in * left_out[:, 0]) / turned
    moves = np.where((cosine > PARALLEL_COSINE)[:, None], mean, np.stack([x, y], axis=1))
    distance, limit = (
        np.hypot(*moves.T),
        MAX_MOVE_RATIO * np.maximum(np.abs(aside_in), np.abs(second)),
    )
    return np.asarray(moves * np.minimum(1.0, limit / np.maximum(distance, 1e-300))[:, None])
