# SPDX-License-Identifier: LGPL-2.1-or-later
"""Chains of meridian pieces, walls of a closed contour, and the wall midway between two walls.

All coordinates are in the half-plane (radius, height) of the axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array
from .profile import Meridian, arc_lengths, turning_angle

JOIN_MM = 1e-4  # mm; ends closer than this coincide
BRIDGE_MM = 0.2  # mm; wider gaps are not bridged
LEVEL_MM = 1e-4  # mm; heights closer than this are equal
SQUARE_RANGE_RAD = (
    np.radians(60.0),
    np.radians(120.0),
)  # angles of a right corner between a wall and its rim
MAX_RIM_SHARE = 1.0 / 6.0  # of the contour length; a longer piece is a wall


@dataclass(frozen=True, eq=False)
class Piece:
    """A smooth piece of a meridian: points (n, 2) mm and unit tangents (n, 2)."""

    name: str
    points: Array
    tangents: Array
    turn: tuple[float, float] | None = None

    @property
    def flat(self) -> bool:
        """Whether all points have the same height."""
        return bool(np.ptp(self.points[:, 1]) < LEVEL_MM)

    def reversed(self) -> Piece:
        """Return the reversed piece."""
        return replace(self, points=self.points[::-1], tangents=-self.tangents[::-1])


Chain = list[Piece]


def ends(chain: Chain) -> tuple[Array, Array]:
    """Return the ends of a chain.

    Parameters
    ----------
    chain : Chain
        The pieces in order.

    Returns
    -------
    first, last : (2,) array
        Points, mm.
    """
    return chain[0].points[0], chain[-1].points[-1]


def chains(segments: Sequence[Piece]) -> tuple[list[Chain], float]:
    """Join segments end to end, nearest ends first.

    A closed contour is a chain whose last end meets its first end.

    Parameters
    ----------
    segments : sequence of Piece
        The segments.

    Returns
    -------
    chains : list of Chain
        The chains.
    gap : float
        Maximum bridged gap, mm.
    """
    chains_so_far: list[Chain] = [[segment] for segment in segments]
    widest = 0.0
    while len(chains_so_far) > 1:
        gaps = _find_gaps(chains_so_far)
        if not gaps:
            break
        gap, i, j, turn_i, turn_j = min(gaps)
        start_chain = _reverse(chains_so_far[i]) if turn_i else chains_so_far[i]
        end_chain = _reverse(chains_so_far[j]) if turn_j else chains_so_far[j]
        chains_so_far[i] = start_chain + end_chain
        del chains_so_far[j]
        widest = max(widest, gap)
    return chains_so_far, widest


def _find_gaps(open_chains: Sequence[Chain]) -> list[tuple[float, int, int, int, int]]:
    """Return gaps (mm) of at most BRIDGE_MM between the ends of two chains.

    Each gap has the indices of both chains and whether each chain must be reversed so that the
    first chain continues into the second.
    """
    tips = np.array([ends(chain) for chain in open_chains]).reshape(
        -1, 2
    )  # first and last ends alternate
    pairs = cKDTree(tips).query_pairs(1.01 * BRIDGE_MM, output_type="ndarray")
    rows = np.sort(pairs, axis=1)
    gaps = np.hypot(*(tips[rows[:, 0]] - tips[rows[:, 1]]).T)
    return [
        (gap, a // 2, b // 2, 1 - a % 2, b % 2)
        for gap, (a, b) in zip(gaps.tolist(), rows.tolist(), strict=True)
        if a // 2 != b // 2 and gap <= BRIDGE_MM
    ]


def _reverse(chain: Chain) -> Chain:
    return [segment.reversed() for segment in reversed(chain)]


def opening(chain: Chain) -> float:
    """Return the distance between the two ends of a chain, mm."""
    start, end = ends(chain)
    return float(np.hypot(*(end - start)))


def is_closed(chain: Chain, is_whole: bool = False) -> bool:
    """Return whether a chain bounds a section: its ends meet, or both are on the axis.

    is_whole: whether the chain is a complete closed surface; its ends may then be up to BRIDGE_MM
    apart.
    """
    meets = len(chain) > 1 or len(chain[0].points) > 2
    return (
        (meets and opening(chain) < JOIN_MM)
        or _starts_and_ends_on_axis(chain)
        or (is_whole and meets and opening(chain) <= BRIDGE_MM)
    )


def _starts_and_ends_on_axis(chain: Chain) -> bool:
    start, end = ends(chain)
    return bool(start[0] < JOIN_MM and end[0] < JOIN_MM)


def upright(chain: Chain) -> Chain:
    """Return the chain in the sense from its lower to its upper end.

    If both ends have the same height, the chain starts at the end with the larger radius.
    """
    start, end = ends(chain)
    if abs(start[1] - end[1]) < LEVEL_MM:
        return chain if start[0] >= end[0] else _reverse(chain)
    return chain if start[1] < end[1] else _reverse(chain)


def walls(chain: Chain) -> list[Chain]:
    """Return the walls of a closed contour, larger radius first.

    The contour is cut at its lowest and highest points. End faces are removed: flat pieces and
    short rims normal to both walls at these points, and flat pieces at the ends of the remaining
    runs. The contour of a solid part has one wall, the contour of a hollow part two.
    """
    level = np.vstack([segment.points for segment in chain])[:, 1]
    low, high = float(level.min()), float(level.max())
    meets = opening(chain) < JOIN_MM or (
        opening(chain) <= BRIDGE_MM and not _starts_and_ends_on_axis(chain)
    )
    rims = _rims(chain, meets, low, high)
    runs: list[Chain] = [[]]
    for index, segment in enumerate(chain):
        if index in rims or (segment.flat and _at_extreme(segment.points[0], low, high)):
            runs.append([])
            continue
        for cut_segment in _cut_at(segment, low, high):
            if runs[-1] and _at_extreme(cut_segment.points[0], low, high):
                runs.append([])
            runs[-1].append(cut_segment)
    if (
        meets
        and len(runs) > 1
        and runs[0]
        and runs[-1]
        and not _at_extreme(runs[0][0].points[0], low, high)
    ):
        runs[0] = runs.pop() + runs[0]
    stripped_runs = [stripped for run in runs if (stripped := _strip_flat_ends(run))]
    return [upright(run) for run in sorted(stripped_runs, key=_mean_radius, reverse=True)]


def _rims(chain: Chain, meets: bool, low: float, high: float) -> set[int]:
    """Return the indices of slanted end faces.

    A slanted end face is a straight piece, shorter than MAX_RIM_SHARE of the contour. It reaches
    the lowest or highest level, where there is no flat piece, and joins both neighbours at about
    right angles.
    """
    lengths = [float(arc_lengths(segment.points, segment.tangents).sum()) for segment in chain]
    flat_levels = [segment.points[0, 1] for segment in chain if segment.flat]
    rims = set()
    for index, segment in enumerate(chain):
        if not meets and index in (0, len(chain) - 1):
            continue
        tangent_before = chain[index - 1].tangents[-1]
        tangent_after = chain[(index + 1) % len(chain)].tangents[0]
        turns = (
            turning_angle(tangent_before, segment.tangents[0]),
            turning_angle(segment.tangents[-1], tangent_after),
        )
        square = turns[0] * turns[1] > 0.0 and all(
            SQUARE_RANGE_RAD[0] < abs(turn) < SQUARE_RANGE_RAD[1] for turn in turns
        )
        straight = float(np.abs(segment.tangents - segment.tangents[0]).max()) < 1e-6
        levels = [z for z in (low, high) if np.abs(segment.points[[0, -1], 1] - z).min() < LEVEL_MM]
        ends_wall = any(all(abs(flat - z) > LEVEL_MM for flat in flat_levels) for z in levels)
        if straight and square and ends_wall and lengths[index] < MAX_RIM_SHARE * sum(lengths):
            rims.add(index)
    return rims


def _at_extreme(point: Array, low: float, high: float) -> bool:
    return bool(min(abs(point[1] - low), abs(point[1] - high)) < LEVEL_MM)


def _cut_at(segment: Piece, low: float, high: float) -> list[Piece]:
    """Cut a piece at inner points where it touches the lowest or highest level."""
    rise = segment.tangents[:, 1]
    turning = np.flatnonzero(rise[1:] * rise[:-1] <= 0.0)
    if segment.flat or len(turning) == 0:
        return [segment]
    curve = Meridian(
        np.r_[0.0, np.cumsum(arc_lengths(segment.points, segment.tangents))],
        segment.points,
        segment.tangents,
    )
    cuts = [0.0, curve.length]
    for i in turning:
        a, b = float(curve.s[i]), float(curve.s[i + 1])
        for _ in range(60):
            middle = 0.5 * (a + b)
            a, b = (
                (middle, b) if float(curve.at([middle])[2][0, 1]) * rise[i] > 0.0 else (a, middle)
            )
        inside = 10.0 * JOIN_MM < b < curve.length - 10.0 * JOIN_MM
        if inside and _at_extreme(np.array([0.0, curve.at([b])[1][0]]), low, high):
            cuts.append(b)
    cuts = sorted(cuts)
    return (
        [_stretch(segment, curve, a, b) for a, b in pairwise(cuts)] if len(cuts) > 2 else [segment]
    )


def _stretch(segment: Piece, curve: Meridian, a: float, b: float) -> Piece:
    """Return the part of a piece from arc length a to b of its curve."""
    inner = (curve.s > a + 1e-6) & (curve.s < b - 1e-6)
    r, h, t = curve.at([a, b])
    points = np.vstack([[r[0], h[0]], curve.points[inner], [r[1], h[1]]])
    return replace(
        segment, points=points, tangents=np.vstack([t[:1], curve.tangents[inner], t[1:]])
    )


def _strip_flat_ends(chain: Chain) -> Chain:
    start, end = 0, len(chain)
    while start < end and chain[start].flat:
        start += 1
    while end > start and chain[end - 1].flat:
        end -= 1
    return chain[start:end]


def _mean_radius(chain: Chain) -> float:
    meridian = meridian_of(chain)
    return float(meridian.at(np.linspace(0.0, meridian.length, 101))[0].mean())


def meridian_of(chain: Chain) -> Meridian:
    """Return the chain as a single meridian."""
    return Meridian.chained([(segment.points, segment.tangents) for segment in chain])


def halfway(outer: Chain, inner: Chain) -> list[tuple[Array, Array]]:
    """Return the wall midway between two walls.

    Points at equal length fractions of both walls correspond. Fractions count per piece if both
    walls have the same number of pieces, otherwise per section between kinks, otherwise over the
    full length. Between parallel walls, the result is the parallel curve midway.

    Parameters
    ----------
    outer, inner : Chain
        The walls.

    Returns
    -------
    list of ((n, 2) array, (n, 2) array)
        Points (mm) and tangents of each piece.
    """
    curves = meridian_of(outer), meridian_of(inner)
    if len(outer) == len(inner):
        bounds = [
            _piece_ends(chain, curve) for chain, curve in zip((outer, inner), curves, strict=True)
        ]
    else:
        bounds = [np.r_[0.0, curve.kinks, curve.length] for curve in curves]
    if len(bounds[0]) != len(bounds[1]):
        ends = [breaks / breaks[-1] for breaks in bounds]
        shares = np.union1d(*ends)
        shares = shares[np.r_[True, np.diff(shares) > 1e-9]]
        bounds = [shares * curve.length for curve in curves]
    return [
        _between(curves, (bounds[0][i], bounds[1][i]), (bounds[0][i + 1], bounds[1][i + 1]))
        for i in range(len(bounds[0]) - 1)
    ]


def _piece_ends(chain: Chain, curve: Meridian) -> Array:
    lengths = [float(arc_lengths(segment.points, segment.tangents).sum()) for segment in chain]
    ends = np.r_[0.0, np.cumsum(lengths)]
    return np.asarray(ends * (curve.length / ends[-1]))


def _between(
    curves: tuple[Meridian, Meridian], start: tuple[float, float], end: tuple[float, float]
) -> tuple[Array, Array]:
    nodes = [
        (curve.s[(curve.s > a + 1e-6) & (curve.s < b - 1e-6)] - a) / (b - a)
        for curve, a, b in zip(curves, start, end, strict=True)
    ]
    share = np.union1d(np.concatenate(nodes), [0.0, 1.0])
    share = share[np.r_[True, np.diff(share) > 1e-6]]
    share[-1] = 1.0
    points, tangents = np.zeros((len(share), 2)), np.zeros((len(share), 2))
    for curve, a, b in zip(curves, start, end, strict=True):
        r, h, _ = curve.at(a + share * (b - a))
        # slightly inside, so that a kink at the start gives the upper tangent
        _, _, t = curve.at(np.clip(a + share * (b - a), a + 2e-9, b))
        points += 0.5 * np.stack([r, h], axis=1)
        tangents += 0.5 * (b - a) * t
    size = np.linalg.norm(tangents, axis=1)
    # where the walls run in opposite directions, as at the crest of a torus, use the points
    along = np.gradient(points, axis=0)
    tangents = np.where((size > 1e-4 * size.max())[:, None], tangents, along)
    return points, tangents / np.linalg.norm(tangents, axis=1, keepdims=True)
