# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pieces of meridian put together: chains in order, the walls of a closed contour, and the wall halfway between two.

Everything is in the half plane (radius, height) of the axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array
from .profile import Meridian, arc_lengths, turning

JOIN = 1e-4  # mm; ends closer than this are one point
BRIDGE = 0.2  # mm; wider gaps are not bridged
LEVEL = 1e-4  # mm; heights closer than this are the same
SQUARE = (np.radians(60.0), np.radians(120.0))  # corners between a wall and the rim that ends it
RIM = 1.0 / 6.0  # of the contour; a longer piece is a wall


@dataclass(frozen=True, eq=False)
class Piece:
    """A smooth stretch of meridian: samples points (n, 2) mm and unit tangents (n, 2). flat: all at one height."""

    name: str
    points: Array
    tangents: Array
    turn: tuple[float, float] | None = None

    @property
    def flat(self) -> bool:
        """True where the piece is straight across the axis."""
        return bool(np.ptp(self.points[:, 1]) < LEVEL)

    def reversed(self) -> Piece:
        """The same stretch run the other way."""
        return replace(self, points=self.points[::-1], tangents=-self.tangents[::-1])


Chain = list[Piece]


def ends(chain: Chain) -> tuple[Array, Array]:
    """First and last point (2,) of a chain."""
    return chain[0].points[0], chain[-1].points[-1]


def chains(pieces: Sequence[Piece]) -> tuple[list[Chain], float]:
    """The pieces joined end to end, nearest ends first, and the widest gap (mm) bridged.

    A closed contour is one chain whose last end meets its first.
    """
    parts: list[Chain] = [[piece] for piece in pieces]
    widest = 0.0
    while len(parts) > 1:
        near = _near(parts)
        if not near:
            break
        gap, i, j, turn_i, turn_j = min(near)
        one = _turned(parts[i]) if turn_i else parts[i]
        other = _turned(parts[j]) if turn_j else parts[j]
        parts[i] = one + other
        del parts[j]
        widest = max(widest, gap)
    return parts, widest


def _near(parts: Sequence[Chain]) -> list[tuple[float, int, int, int, int]]:
    """Gaps (mm) of no more than BRIDGE between the ends of two chains, the numbers of the two, and whether each is to be
    turned for the first to run on into the second."""
    tips = np.array([ends(part) for part in parts]).reshape(-1, 2)  # first and last by turns
    pairs = cKDTree(tips).query_pairs(1.01 * BRIDGE, output_type="ndarray")
    rows = np.sort(pairs, axis=1)
    gaps = np.hypot(*(tips[rows[:, 0]] - tips[rows[:, 1]]).T)
    return [
        (gap, a // 2, b // 2, 1 - a % 2, b % 2)
        for gap, (a, b) in zip(gaps.tolist(), rows.tolist(), strict=True)
        if a // 2 != b // 2 and gap <= BRIDGE
    ]


def _turned(chain: Chain) -> Chain:
    return [piece.reversed() for piece in reversed(chain)]


def opening(chain: Chain) -> float:
    """The way from the last end of a chain to its first, mm."""
    first, last = ends(chain)
    return float(np.hypot(*(last - first)))


def is_closed(chain: Chain, whole: bool = False) -> bool:
    """True when the chain bounds a section: it meets itself, or starts and ends on the axis. whole: it is all of a closed
    surface, so it meets itself across a gap too, the widest one of its pieces, whose nearest ends are joined first."""
    meets = len(chain) > 1 or len(chain[0].points) > 2
    return (
        (meets and opening(chain) < JOIN)
        or _on_axis(chain)
        or (whole and meets and opening(chain) <= BRIDGE)
    )


def _on_axis(chain: Chain) -> bool:
    first, last = ends(chain)
    return bool(first[0] < JOIN and last[0] < JOIN)


def upright(chain: Chain) -> Chain:
    """The chain run from its lower end up; of two ends at one height, from the one with the larger radius."""
    first, last = ends(chain)
    if abs(first[1] - last[1]) < LEVEL:
        return chain if first[0] >= last[0] else _turned(chain)
    return chain if first[1] < last[1] else _turned(chain)


def walls(chain: Chain) -> list[Chain]:
    """The walls of a closed contour, the one at the larger radius first.

    The contour is cut at its lowest and highest points; flat pieces there, short rims square to both walls there, and
    flat pieces at the ends of what is left, are end faces and no wall. A contour of a full part has one wall, of a
    hollow part two.
    """
    level = np.vstack([piece.points for piece in chain])[:, 1]
    low, high = float(level.min()), float(level.max())
    meets = opening(chain) < JOIN or (opening(chain) <= BRIDGE and not _on_axis(chain))
    rims = _rims(chain, meets, low, high)
    runs: list[Chain] = [[]]
    for index, piece in enumerate(chain):
        if index in rims or (piece.flat and _at_extreme(piece.points[0], low, high)):
            runs.append([])
            continue
        for part in _cut_at(piece, low, high):
            if runs[-1] and _at_extreme(part.points[0], low, high):
                runs.append([])
            runs[-1].append(part)
    if (
        meets
        and len(runs) > 1
        and runs[0]
        and runs[-1]
        and not _at_extreme(runs[0][0].points[0], low, high)
    ):
        runs[0] = runs.pop() + runs[0]
    found = [stripped for run in runs if (stripped := _without_flat_ends(run))]
    return [upright(run) for run in sorted(found, key=_mean_radius, reverse=True)]


def _rims(chain: Chain, meets: bool, low: float, high: float) -> set[int]:
    """Indices of slanted end faces: straight pieces that reach the lowest or highest level, where no flat piece is,
    square to both neighbours, which they join to each other, and shorter than RIM of the contour.
    """
    lengths = [float(arc_lengths(piece.points, piece.tangents).sum()) for piece in chain]
    flat_levels = [piece.points[0, 1] for piece in chain if piece.flat]
    found = set()
    for index, piece in enumerate(chain):
        if not meets and index in (0, len(chain) - 1):
            continue
        before, after = chain[index - 1].tangents[-1], chain[(index + 1) % len(chain)].tangents[0]
        turns = turning(before, piece.tangents[0]), turning(piece.tangents[-1], after)
        square = turns[0] * turns[1] > 0.0 and all(
            SQUARE[0] < abs(turn) < SQUARE[1] for turn in turns
        )
        straight = float(np.abs(piece.tangents - piece.tangents[0]).max()) < 1e-6
        levels = [z for z in (low, high) if np.abs(piece.points[[0, -1], 1] - z).min() < LEVEL]
        ends_wall = any(all(abs(flat - z) > LEVEL for flat in flat_levels) for z in levels)
        if straight and square and ends_wall and lengths[index] < RIM * sum(lengths):
            found.add(index)
    return found


def _at_extreme(point: Array, low: float, high: float) -> bool:
    return bool(min(abs(point[1] - low), abs(point[1] - high)) < LEVEL)


def _cut_at(piece: Piece, low: float, high: float) -> list[Piece]:
    """The piece cut at inner samples where it touches the lowest or highest level."""
    rise = piece.tangents[:, 1]
    turning = np.flatnonzero(rise[1:] * rise[:-1] <= 0.0)
    if piece.flat or len(turning) == 0:
        return [piece]
    curve = Meridian(
        np.r_[0.0, np.cumsum(arc_lengths(piece.points, piece.tangents))],
        piece.points,
        piece.tangents,
    )
    cuts = [0.0, curve.length]
    for i in turning:
        a, b = float(curve.s[i]), float(curve.s[i + 1])
        for _ in range(60):
            middle = 0.5 * (a + b)
            a, b = (
                (middle, b) if float(curve.at([middle])[2][0, 1]) * rise[i] > 0.0 else (a, middle)
            )
        inside = 10.0 * JOIN < b < curve.length - 10.0 * JOIN
        if inside and _at_extreme(np.array([0.0, curve.at([b])[1][0]]), low, high):
            cuts.append(b)
    cuts = sorted(cuts)
    return [_stretch(piece, curve, a, b) for a, b in pairwise(cuts)] if len(cuts) > 2 else [piece]


def _stretch(piece: Piece, curve: Meridian, a: float, b: float) -> Piece:
    """The piece from arc length a to b of its own curve."""
    inner = (curve.s > a + 1e-6) & (curve.s < b - 1e-6)
    r, h, t = curve.at([a, b])
    points = np.vstack([[r[0], h[0]], curve.points[inner], [r[1], h[1]]])
    return replace(piece, points=points, tangents=np.vstack([t[:1], curve.tangents[inner], t[1:]]))


def _without_flat_ends(chain: Chain) -> Chain:
    first, last = 0, len(chain)
    while first < last and chain[first].flat:
        first += 1
    while last > first and chain[last - 1].flat:
        last -= 1
    return chain[first:last]


def _mean_radius(chain: Chain) -> float:
    meridian = meridian_of(chain)
    return float(meridian.at(np.linspace(0.0, meridian.length, 101))[0].mean())


def meridian_of(chain: Chain) -> Meridian:
    """The chain as one curve."""
    return Meridian.chained([(piece.points, piece.tangents) for piece in chain])


def halfway(outer: Chain, inner: Chain) -> list[tuple[Array, Array]]:
    """The wall in the middle: halfway between the points of the two that lie at the same share of their lengths.

    Where both have as many pieces, shares count from piece to piece, else from kink to kink, else over the whole.
    Between parallel walls this is the parallel curve in the middle. Returns pieces (points, tangents).
    """
    curves = meridian_of(outer), meridian_of(inner)
    if len(outer) == len(inner):
        bounds = [
            _piece_ends(chain, curve) for chain, curve in zip((outer, inner), curves, strict=True)
        ]
    else:
        bounds = [np.r_[0.0, curve.kinks, curve.length] for curve in curves]
    if len(bounds[0]) != len(bounds[1]):
        ends = [at / at[-1] for at in bounds]
        shares = np.union1d(*ends)
        shares = shares[np.r_[True, np.diff(shares) > 1e-9]]
        bounds = [shares * curve.length for curve in curves]
    return [
        _between(curves, (bounds[0][i], bounds[1][i]), (bounds[0][i + 1], bounds[1][i + 1]))
        for i in range(len(bounds[0]) - 1)
    ]


def _piece_ends(chain: Chain, curve: Meridian) -> Array:
    lengths = [float(arc_lengths(piece.points, piece.tangents).sum()) for piece in chain]
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
        # just inside, so that a kink at the start gives the tangent above it
        _, _, t = curve.at(np.clip(a + share * (b - a), a + 2e-9, b))
        points += 0.5 * np.stack([r, h], axis=1)
        tangents += 0.5 * (b - a) * t
    size = np.linalg.norm(tangents, axis=1)
    # where the two walls run against each other, as at the crest of a torus, the points alone tell the way
    along = np.gradient(points, axis=0)
    tangents = np.where((size > 1e-4 * size.max())[:, None], tangents, along)
    return points, tangents / np.linalg.norm(tangents, axis=1, keepdims=True)
