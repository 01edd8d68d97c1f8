# SPDX-License-Identifier: LGPL-2.1-or-later
"""The smooth curve through points, and how far others are from it.

The points of a bead lie on its curve, the chords between them do not: on a circle they run inside by up to the chord
error, which would show as spacing. So the curve is a smooth one through the points - in each segment a cubic that is a
circular arc to sixth order in the angle it turns - and keeps corners as they are. Its tangents are the bead's own where it
has them, else those of parabolas.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields
from itertools import chain
from typing import Any

import numpy as np

from ...geometry.columns import columns, crosses, lengths, unit_rows
from ...geometry.curves.outline import derivatives
from ...types import Array, Index, Mask, NDArray

CORNER = np.radians(
    50.0
)  # a bead that turns by more at a point has a corner there; the sparsest circle turns by less
SLIGHT = np.radians(
    10.0
)  # a lesser turn is a corner too where it is more than SUDDEN times the turns beside it
SUDDEN = 3.0
SMOOTH = 1e-3  # rad; where the tangents of a bead are known, a corner is a point at which they differ by more
_ALL = 15_000  # pairs of points and segments that are looked at one by one: of more a tree finds the near ones sooner
_CHUNK = 400_000  # point-segment pairs handled at once; bounds the memory
_TIE = 1e-9  # mm; where two chords meet both are the nearest: rounding does not choose between them
_TOGETHER = 4096  # points whose cubics are looked at together, about
_FIRST_TRIED = 5  # segments that are tried first
_BEYOND = 0.25  # how far the cubic of a segment serves past its ends, where the next one's would be nearer by a hair


@dataclass(frozen=True, eq=False)
class Curve:
    """Segments start, end (m, 3) with the derivatives (m, 3) of their cubics there; `low` and `high` (m,) bound the
    cubics' variable, which is 0 at the start and 1 at the end."""

    start: Array
    end: Array
    start_slope: Array
    end_slope: Array
    low: Array
    high: Array


def distance(points: Array, curve: Curve) -> Array:
    """(n,) distance from points (n, 3) to the curve, in their unit.

    The nearest vertex bounds the distance from above, so only segments whose middle is nearer than this bound plus half
    the longest segment can hold the nearest point of the chords; all of those are tried. Of all segments whose cubic may be
    the nearest, as far as it bows from its chord, the foot is moved along the cubic: beside a corner that is not always the
    one with the nearest chord.
    """
    return _together([(points, curve)])[0]


def distances(asked: Iterable[tuple[Array, Curve]]) -> Iterator[Array]:
    """`distance` of points to a curve, one after the other; several of them together, for of a few points calls take longer
    than the work."""
    some: list[tuple[Array, Curve]] = []
    for one in asked:
        some.append(one)
        if sum(len(points) for points, _ in some) >= _TOGETHER:
            yield from _together(some)
            some = []
    if some:
        yield from _together(some)


def _together(asked: Sequence[tuple[Array, Curve]]) -> list[Array]:
    points = np.concatenate([points for points, _ in asked])
    curve = Curve(
        *(
            np.concatenate([getattr(curve, field.name) for _, curve in asked])
            for field in fields(Curve)
        )
    )
    first = np.cumsum([0, *(len(points) for points, _ in asked)])
    before = np.cumsum([0, *(len(curve.start) for _, curve in asked)])
    pairs = [
        (which + first[k], segment + before[k], own)
        for k, one in enumerate(asked)
        for which, segment, own in _near(*one)
    ]
    which, segment, own = (np.concatenate(column) for column in zip(*pairs, strict=True))
    return np.split(_to_cubic(points, which, segment, own, curve), first[1:-1])


def _near(points: Array, curve: Curve) -> Iterator[tuple[Index, Index, Mask]]:
    """Pairs (k,) of a point and a segment that may be nearest to it, those of each point together, and whether its chord
    is."""
    bow = _bow(curve)
    if len(points) * len(curve.start) <= _ALL:
        yield _nearest_of_all(points, curve, bow)
        return
    from scipy.spatial import cKDTree  # slow to import, and the beads of most jobs are short

    reach = 0.5 * float(lengths(curve.end - curve.start).max()) + 2.0 * float(bow.max())
    middles = cKDTree(0.5 * (curve.start + curve.end))
    apart, near = middles.query(points, _FIRST_TRIED)
    radius: Array = (apart[:, 0] + reach) * (1.0 + 1e-9)
    # where all that may be nearest are among those few, as nearly everywhere, no others need be looked for
    few = apart[:, -1] > radius
    which, column = np.nonzero((apart <= radius[:, None]) & few[:, None])
    if few.any():
        yield _nearest_chords(points, which, near[which, column], curve, bow)
    rest = np.flatnonzero(~few)
    for some in (
        np.array_split(rest, _parts(middles, points[rest], radius[rest])) if len(rest) else ()
    ):
        which, segment = _within(middles, points[some], radius[some])
        yield _nearest_chords(points, some[which], segment, curve, bow)


def _bow(curve: Curve) -> Array:
    """(m,) how far the cubic of each segment may be from its chord, at most."""
    chord = curve.end - curve.start
    ends = lengths(curve.start_slope - chord) + lengths(curve.end_slope - chord)
    bow: Array = 4.0 / 27.0 * ends
    return bow


def _nearest_of_all(points: Array, curve: Curve, bow: Array) -> tuple[Index, Index, Mask]:
    """Pairs (k,) of a point and a segment that may be nearest to it, rising, every chord tried, and whether the chord is."""
    centre = curve.start.mean(axis=0)
    start, along, at = curve.start - centre, curve.end - curve.start, points - centre
    length = (along * along).sum(axis=1)
    forward = at @ along.T - (start * along).sum(axis=1)
    share = _between(forward / np.maximum(length, 1e-300), 0.0, 1.0)
    squared = (at * at).sum(axis=1)[:, None] - 2.0 * at @ start.T + (start * start).sum(axis=1)
    squared += share * (share * length - 2.0 * forward)
    nearest, row = squared.argmin(axis=1), np.arange(len(points))
    apart = np.sqrt(np.maximum(squared, 0.0))
    least = apart[row, nearest]
    own = apart <= (least + _TIE)[:, None]
    which, segment = np.nonzero(own | (apart - bow <= (least + bow[nearest])[:, None]))
    return which, segment, own[which, segment]


def _parts(middles: Any, points: Array, radius: Array) -> int:
    sample = slice(None, None, max(1, len(points) // 16))
    per_point = float(
        np.mean(middles.query_ball_point(points[sample], radius[sample], return_length=True))
    )
    return min(len(points), 1 + int(per_point * len(points) / _CHUNK))


def _within(middles: Any, points: Array, radius: Array) -> tuple[Index, Index]:
    """Pairs (k,) of a point, rising, and a segment whose middle is within the radius (n,) about it."""
    found = middles.query_ball_point(points, radius, return_sorted=False)
    count = np.fromiter(map(len, found), dtype=np.intp, count=len(found))
    segment = np.fromiter(chain.from_iterable(found), dtype=np.intp, count=int(count.sum()))
    return np.repeat(np.arange(len(points)), count), segment


def _nearest_chords(
    points: Array, which: Index, segment: Index, curve: Curve, bow: Array
) -> tuple[Index, Index, Mask]:
    """The same as `_nearest_of_all`, of pairs (k,) of a point, rising, and a segment."""
    start = columns(curve.start)[:, segment]
    along = columns(curve.end)[:, segment] - start
    offset = columns(points)[:, which] - start
    offset -= _share(offset, along) * along
    apart = _size(offset)
    begins = np.flatnonzero(np.diff(which, prepend=-1))
    of = np.repeat(np.arange(len(begins)), np.diff(np.append(begins, len(which))))
    least = np.minimum.reduceat(apart, begins)
    hits = np.flatnonzero(apart == least[of])
    first = hits[np.unique(of[hits], return_index=True)[1]]
    own = apart <= (least + _TIE)[of]
    maybe = own | (apart - bow[segment] <= (least + bow[segment[first]])[of])
    return which[maybe], segment[maybe], own[maybe]


def _share(offset: Array, along: Array) -> Array:
    """(k,) where the foot of points `offset` (3, k) from the start of segments `along` (3, k) is, as a share of these."""
    squared = _dot(along, along)
    return _between(_dot(offset, along) / np.where(squared > 0.0, squared, 1.0), 0.0, 1.0)


def _dot(one: Array, other: Array) -> Array:
    """(k,) scalar products of vectors (3, k), added up in the order in which einsum does it of rows."""
    product = one * other
    found: Array = product[0] + product[2]
    found += product[1]
    return found


def _size(vectors: Array) -> Array:
    """(k,) lengths of vectors (3, k)."""
    return lengths(vectors.T)


def _between(values: Array, low: Array | float, high: Array | float) -> Array:
    """As np.clip, which takes many times as long for a few."""
    held: Array = np.minimum(np.maximum(values, low), high)
    return held


def _to_cubic(points: Array, which: Index, segment: Index, own: Mask, curve: Curve) -> Array:
    """(n,) the least distance of points to the cubics of the segments (k,) paired with those numbered `which`, by Newton's
    steps from the foot on the chord. Only a point's own segment, its chord the nearest, serves past its ends."""
    # axis by axis: rows of three take several times as long
    at = columns(points)[:, which]
    p, q, a, b = (
        columns(of)[:, segment]
        for of in (curve.start, curve.end, curve.start_slope, curve.end_slope)
    )
    low, high = np.where(own, curve.low[segment], 0.0), np.where(own, curve.high[segment], 1.0)
    d = q - p
    square, cube = 3.0 * d - 2.0 * a - b, a + b - 2.0 * d
    u = _share(at - p, d)
    for _ in range(3):
        away = p + u * (a + u * (square + u * cube)) - at
        slope = a + u * (2.0 * square + 3.0 * u * cube)
        bend = 2.0 * square + 6.0 * u * cube
        rate = _dot(slope, slope) + _dot(away, bend)
        u = _between(u - _dot(away, slope) / np.where(rate > 0.0, rate, np.inf), low, high)
    apart = _size(p + u * (a + u * (square + u * cube)) - at)
    found, begins = np.empty(len(points)), np.flatnonzero(np.diff(which, prepend=-1))
    found[which[begins]] = np.minimum.reduceat(apart, begins)
    return found


def columns_of(points: Array, closed: bool, tangents: Array | None = None) -> tuple[Array, ...]:
    """The columns of `Curve` for the points (n, 3) of one bead or a part of it, and its unit tangents (n, 2, 3) where they
    are known."""
    step = np.diff(points, axis=0)
    length = lengths(step)
    if tangents is not None:
        turn = np.arccos(np.clip(np.einsum("ij,ij->i", tangents[:, 0], tangents[:, 1]), -1.0, 1.0))
        smooth = turn < SMOOTH
        smooth[[0, -1]] &= closed
        return _arcs(points, tangents[:-1, 1], tangents[1:, 0], smooth[:-1], smooth[1:])
    chord = step / np.where(length > 0.0, length, 1.0)[:, None]
    before, after = _before(chord), chord
    smooth = ~_corners(before, after, closed)  # at the start of each segment
    smooth[0] &= closed
    # the tangent of the parabola through three points: the nearer neighbour counts more
    tangent = unit_rows(before * length[:, None] + after * _before(length)[:, None])
    at_start, at_end = tangent, _after(tangent)
    smooth_end = _after(smooth)
    # where the curve ends or has a corner, the arc through both points that has the tangent of the other end
    start = np.where(
        smooth[:, None], at_start, np.where(smooth_end[:, None], _mirrored(at_end, chord), chord)
    )
    end = np.where(
        smooth_end[:, None], at_end, np.where(smooth[:, None], _mirrored(at_start, chord), chord)
    )
    return _arcs(points, start, end, smooth, smooth_end)


def _arcs(
    points: Array, start: Array, end: Array, smooth: Mask, smooth_end: Mask
) -> tuple[Array, ...]:
    """The columns for segments with the unit tangents (n - 1, 3) at their ends, which go on smoothly or do not."""
    return (
        points[:-1],
        points[1:],
        *derivatives(points, start, end),
        np.where(smooth, -_BEYOND, 0.0),
        np.where(smooth_end, 1.0 + _BEYOND, 1.0),
    )


def _corners(before: Array, after: Array, closed: bool) -> Mask:
    """(n,) whether the path of segments with the unit directions (n, 3) has a corner at the start of each of them."""
    turn = np.arctan2(lengths(crosses(before, after)), np.einsum("ij,ij->i", before, after))
    if not closed:
        turn[0] = 0.0
    adjacent = np.maximum(_before(turn), _after(turn))
    corners: Mask = (turn >= CORNER) | ((turn > SLIGHT) & (turn > SUDDEN * adjacent))
    return corners


def _before(rows: NDArray[Any]) -> NDArray[Any]:
    """The row before each, round again; np.roll takes many times as long for a few."""
    return np.concatenate((rows[-1:], rows[:-1]))


def _after(rows: NDArray[Any]) -> NDArray[Any]:
    """The row after each, round again."""
    return np.concatenate((rows[1:], rows[:1]))


def _mirrored(tangent: Array, chord: Array) -> Array:
    """The tangent at the other end of the arc with this chord."""
    other: Array = 2.0 * np.einsum("ij,ij->i", tangent, chord)[:, None] * chord - tangent
    return other
