# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layer spacing: distance from each deposit point to the curve of the previous layer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields
from itertools import chain
from typing import Any

import numpy as np

from ...geometry.columns import columns, crosses, lengths, unit_rows
from ...geometry.curves.outline import derivatives
from ...toolpath import Bead, Layer, Toolpath
from ...types import Array, Index, Mask, NDArray

PLANE_TOLERANCE_MM = 1e-6  # mm; maximum height difference of the points of a planar layer


def between_layers(toolpath: Toolpath) -> tuple[Array, ...]:
    """Return the distances of points from the previous layer, by layer.

    In a spiral, which is one layer, they are the distances from the previous turn. In planar
    filled layers they are the distances of the planes, because the nearest bead below would give
    the spacing within a layer. Beads that close gaps, and layers without a layer of the feature
    below, are omitted. Several features follow each other.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.

    Returns
    -------
    tuple of (n,) array
        Distances of each layer after the first, mm.
    """
    if toolpath.features:
        return tuple(
            chain.from_iterable(
                between_layers(feature) for feature, _ in toolpath.parts if feature.layers
            )
        )
    toolpath = toolpath.deposited
    if is_spiral(toolpath):
        return between_turns(toolpath.layers[0].beads[0])
    heights = _planes(toolpath)
    if heights is not None:
        spacings = []
        for below, above, layer in zip(heights, heights[1:], toolpath.layers[1:]):
            point_count = sum(len(bead) for bead in layer.beads if not bead.role.closing)
            if point_count and not layer.first:
                spacings.append(np.full(point_count, above - below))
        return tuple(spacings)
    above = [
        [] if layer.first else [bead.points for bead in layer.beads if not bead.role.closing]
        for layer in toolpath.layers[1:]
    ]
    return tuple(
        distances(
            (np.concatenate(points), curve_of(below))
            for below, points in zip(toolpath.layers, above, strict=False)
            if points
        )
    )


def local_distances(toolpath: Toolpath) -> tuple[Array, ...]:
    """Return the distances of points from the previous layer, by bead.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.

    Returns
    -------
    tuple of (n,) array
        Distances of each bead in print order, mm; NaN in first layers and in the first turn of a
        spiral.
    """
    if toolpath.features:
        by_layer: list[list[Array]] = [[] for _ in toolpath.layers]
        for feature, numbers in toolpath.parts:
            bead_layers = (
                number
                for number, layer in zip(numbers.tolist(), feature.layers, strict=True)
                for _ in layer.beads
            )
            for number, values in zip(
                bead_layers, local_distances(feature) if feature.layers else (), strict=True
            ):
                by_layer[number].append(values)
        return tuple(chain.from_iterable(by_layer))
    toolpath = toolpath.deposited
    if is_spiral(toolpath):
        bead = toolpath.layers[0].beads[0]
        values_ = np.full(len(bead), np.nan)
        for quarter, stretch in _quarters(bead):
            values_[quarter] = distance(bead.points[quarter], stretch)
        return (values_,)
    heights = _planes(toolpath)
    if heights is not None:
        gap = np.where(
            [layer.first for layer in toolpath.layers], np.nan, np.diff(heights, prepend=np.nan)
        )
        return tuple(np.full(len(bead), gap[layer]) for layer, _, bead in toolpath)
    distances_ = [np.full(len(bead), np.nan) for bead in toolpath.layers[0].beads]
    for below, layer in zip(toolpath.layers, toolpath.layers[1:], strict=False):
        if layer.first:
            distances_ += [np.full(len(bead), np.nan) for bead in layer.beads]
            continue
        gap = distance(np.concatenate([bead.points for bead in layer.beads]), curve_of(below))
        distances_ += np.split(gap, np.cumsum([len(bead) for bead in layer.beads])[:-1])
    return tuple(distances_)


def between_turns(bead: Bead) -> tuple[Array, ...]:
    """Return the distances of a spiral from the previous turn, by quarter turn.

    The stretch of the previous turn is three quarters of a turn long, so that it contains the
    nearest point but no points adjacent along the spiral.

    Parameters
    ----------
    bead : Bead
        The spiral.

    Returns
    -------
    tuple of (n,) array
        Distances of each quarter turn after the first turn, mm.
    """
    return tuple(distance(bead.points[quarter], stretch) for quarter, stretch in _quarters(bead))


def is_spiral(toolpath: Toolpath) -> bool:
    """Whether a toolpath is a part of revolution deposited as one rising bead."""
    beads = toolpath.layers[0].beads
    return (
        len(toolpath.layers) == 1
        and len(beads) == 1
        and not beads[0].closed
        and toolpath.traits.has_axis
    )


def is_plane(toolpath: Toolpath) -> bool:
    """Whether every feature has planar filled layers, whose plane distance is reported."""
    return all(_planes(feature) is not None for feature, _ in toolpath.parts)


def _planes(toolpath: Toolpath) -> Array | None:
    """Return the heights of filled planar layers along Z of the frame, (layers,) mm; None for other layers."""
    toolpath = toolpath.deposited
    if not toolpath.traits.stacks_layers:
        return None
    up = toolpath.frame[:3, 2]
    rows = []
    for layer in toolpath.layers:
        heights = np.concatenate([bead.points for bead in layer.beads]) @ up
        rows.append([heights.min(), heights.max()])
    ends = np.array(rows)
    return ends.mean(axis=1) if (np.ptp(ends, axis=1) <= PLANE_TOLERANCE_MM).all() else None


def turns_of(bead: Bead) -> Index:
    """Return the turn index of each point of a spiral.

    Parameters
    ----------
    bead : Bead
        The spiral, n points, with angles as parameter.

    Returns
    -------
    (n,) array of int
        Turn indices from 0.
    """
    turned = np.abs(bead.parameter - bead.parameter[0]) / (2.0 * np.pi)
    last_turn = max(int(np.ceil(turned[-1] - 1e-6)) - 1, 0)
    turns: Index = np.minimum((turned + 1e-9).astype(np.intp), last_turn)
    return turns


def _quarters(bead: Bead) -> Iterator[tuple[Mask, Curve]]:
    """Yield, for each quarter turn after the first turn, the mask of its points (n,) and the previous turn's stretch."""
    angle = np.abs(bead.parameter - bead.parameter[0])
    quarter = 0.5 * np.pi
    for start in np.arange(4.0 * quarter, np.nextafter(angle[-1], np.inf), quarter):
        in_quarter = (angle >= start) & (angle < start + quarter)
        start_row, end_row = np.searchsorted(angle, (start - 5.0 * quarter, start - 2.0 * quarter))
        start_row = max(int(start_row) - 1, 0)
        if in_quarter.any() and end_row - start_row > 1:
            yield (
                in_quarter,
                Curve(*columns_of(bead.points[start_row : int(end_row) + 1], closed=False)),
            )


def curve_of(layer: Layer) -> Curve:
    """Return the smooth curve through the points of a layer's beads."""
    segments = [columns_of(bead.points, bead.closed, bead.tangents) for bead in layer.beads]
    return Curve(*(np.concatenate(columns) for columns in zip(*segments, strict=True)))


# ---- Distance of points from the smooth curve through a bead's points
#
# The points of a bead are on its curve, but the chords between them are not: on a circle the chords
# are inside by up to the chord error, which would show as spacing. The curve is therefore smooth
# between corners. Each segment is a cubic that matches a circular arc to sixth order in the turn
# angle. The tangents are the bead's tangents if known, else the tangents of parabolas.

CORNER = np.radians(50.0)  # minimum turn at a corner; the sparsest circle turns by less
SLIGHT = np.radians(
    10.0
)  # minimum turn at a corner whose turn exceeds SUDDEN times the adjacent turns
SUDDEN = 3.0
SMOOTH = 1e-3  # rad; maximum difference of known tangents at a point without a corner
_ALL = 15_000  # maximum number of point-segment pairs for brute force; above, a tree is faster
_CHUNK = 400_000  # point-segment pairs handled at once; bounds the memory
_TIE = 1e-9  # mm; tolerance of ties, so that both chords at a common vertex are nearest
_BATCH_POINTS = 4096  # approximate number of points in a batch
_FIRST_TRIED = 5  # number of segments tried first
_OVERRUN_SHARE = 0.25  # fraction of a segment; maximum extrapolation of its cubic past the ends


@dataclass(frozen=True, eq=False)
class Curve:
    """Cubic segments.

    start, end: (m, 3) end points. start_slope, end_slope: (m, 3) derivatives at the end points. low, high: (m,) bounds of
    the variable, which is 0 at the start and 1 at the end.
    """

    start: Array
    end: Array
    start_slope: Array
    end_slope: Array
    low: Array
    high: Array


def distance(points: Array, curve: Curve) -> Array:
    """Return the distances of points from a smooth curve.

    The nearest vertex bounds the distance from above. Only segments whose midpoint is nearer than
    this bound plus half the longest segment can contain the nearest point of the chords, and all of
    them are tried. Near a corner, the segment with the nearest chord may not have the nearest
    cubic. The foot point is therefore refined on the cubic of every segment that may be nearest
    within the bow of its cubic.

    Parameters
    ----------
    points : (n, 3) array
        Points.
    curve : Curve
        The curve.

    Returns
    -------
    (n,) array
        Distances, in the unit of the points.
    """
    return _batch_distances([(points, curve)])[0]


def distances(queries: Iterable[tuple[Array, Curve]]) -> Iterator[Array]:
    """Yield the `distance` of points from a curve for each query.

    Queries are handled in batches, because the call overhead dominates for a few points.

    Parameters
    ----------
    queries : Iterable[tuple[Array, Curve]]
        Points (n, 3) and curve of each query.

    Yields
    ------
    (n,) array
        Distances of a query.
    """
    batch: list[tuple[Array, Curve]] = []
    for query in queries:
        batch.append(query)
        if sum(len(points) for points, _ in batch) >= _BATCH_POINTS:
            yield from _batch_distances(batch)
            batch = []
    if batch:
        yield from _batch_distances(batch)


def _batch_distances(queries: Sequence[tuple[Array, Curve]]) -> list[Array]:
    points = np.concatenate([points for points, _ in queries])
    curve = Curve(
        *(
            np.concatenate([getattr(curve, field.name) for _, curve in queries])
            for field in fields(Curve)
        )
    )
    point_offsets = np.cumsum([0, *(len(points) for points, _ in queries)])
    segment_offsets = np.cumsum([0, *(len(curve.start) for _, curve in queries)])
    pairs = [
        (point + point_offsets[k], segment + segment_offsets[k], nearest_chord)
        for k, query in enumerate(queries)
        for point, segment, nearest_chord in _near(*query)
    ]
    point, segment, nearest_chord = (np.concatenate(column) for column in zip(*pairs, strict=True))
    return np.split(_to_cubic(points, point, segment, nearest_chord, curve), point_offsets[1:-1])


def _near(points: Array, curve: Curve) -> Iterator[tuple[Index, Index, Mask]]:
    """Yield pairs (k,) of points and possibly nearest segments, grouped by point, and which chords are nearest."""
    bow = _bow(curve)
    if len(points) * len(curve.start) <= _ALL:
        yield _nearest_of_all(points, curve, bow)
        return
    from scipy.spatial import cKDTree  # slow to import, and the beads of most jobs are short

    reach = 0.5 * float(lengths(curve.end - curve.start).max()) + 2.0 * float(bow.max())
    middles = cKDTree(0.5 * (curve.start + curve.end))
    distance, segment_rows = middles.query(points, _FIRST_TRIED)
    radius: Array = (distance[:, 0] + reach) * (1.0 + 1e-9)
    # the first few segments almost always include all candidates, so that no radius search is needed
    is_complete = distance[:, -1] > radius
    point, column = np.nonzero((distance <= radius[:, None]) & is_complete[:, None])
    if is_complete.any():
        yield _nearest_chords(points, point, segment_rows[point, column], curve, bow)
    remaining = np.flatnonzero(~is_complete)
    for chunk in (
        np.array_split(remaining, _parts(middles, points[remaining], radius[remaining]))
        if len(remaining)
        else ()
    ):
        point, segment = _segments_in_radius(middles, points[chunk], radius[chunk])
        yield _nearest_chords(points, chunk[point], segment, curve, bow)


def _bow(curve: Curve) -> Array:
    """Return an upper bound (m,) of the distance of the cubic of each segment from its chord."""
    chord = curve.end - curve.start
    ends = lengths(curve.start_slope - chord) + lengths(curve.end_slope - chord)
    bow: Array = 4.0 / 27.0 * ends
    return bow


def _nearest_of_all(points: Array, curve: Curve, bow: Array) -> tuple[Index, Index, Mask]:
    """Return pairs (k,) of points and possibly nearest segments, ascending, and which chords are nearest.

    All pairs are tried.
    """
    centre = curve.start.mean(axis=0)
    start, along, offset = curve.start - centre, curve.end - curve.start, points - centre
    length = (along * along).sum(axis=1)
    forward = offset @ along.T - (start * along).sum(axis=1)
    share = _between(forward / np.maximum(length, 1e-300), 0.0, 1.0)
    squared = (
        (offset * offset).sum(axis=1)[:, None]
        - 2.0 * offset @ start.T
        + (start * start).sum(axis=1)
    )
    squared += share * (share * length - 2.0 * forward)
    nearest, row = squared.argmin(axis=1), np.arange(len(points))
    distance = np.sqrt(np.maximum(squared, 0.0))
    shortest = distance[row, nearest]
    nearest_chord = distance <= (shortest + _TIE)[:, None]
    point, segment = np.nonzero(
        nearest_chord | (distance - bow <= (shortest + bow[nearest])[:, None])
    )
    return point, segment, nearest_chord[point, segment]


def _parts(middles: Any, points: Array, radius: Array) -> int:
    sample = slice(None, None, max(1, len(points) // 16))
    per_point = float(
        np.mean(middles.query_ball_point(points[sample], radius[sample], return_length=True))
    )
    return min(len(points), 1 + int(per_point * len(points) / _CHUNK))


def _segments_in_radius(middles: Any, points: Array, radius: Array) -> tuple[Index, Index]:
    """Return pairs (k,) of points, ascending, and segments whose midpoint is within the point's radius (n,)."""
    neighbours = middles.query_ball_point(points, radius, return_sorted=False)
    count = np.fromiter(map(len, neighbours), dtype=np.intp, count=len(neighbours))
    segment = np.fromiter(chain.from_iterable(neighbours), dtype=np.intp, count=int(count.sum()))
    return np.repeat(np.arange(len(points)), count), segment


def _nearest_chords(
    points: Array, point: Index, segment: Index, curve: Curve, bow: Array
) -> tuple[Index, Index, Mask]:
    """Return the result of `_nearest_of_all` for pairs (k,) of points, ascending, and segments."""
    start = columns(curve.start)[:, segment]
    along = columns(curve.end)[:, segment] - start
    offset = columns(points)[:, point] - start
    offset -= _share(offset, along) * along
    distance = _size(offset)
    begins = np.flatnonzero(np.diff(point, prepend=-1))
    group = np.repeat(np.arange(len(begins)), np.diff(np.append(begins, len(point))))
    shortest = np.minimum.reduceat(distance, begins)
    hits = np.flatnonzero(distance == shortest[group])
    first_hit = hits[np.unique(group[hits], return_index=True)[1]]
    nearest_chord = distance <= (shortest + _TIE)[group]
    maybe = nearest_chord | (distance - bow[segment] <= (shortest + bow[segment[first_hit]])[group])
    return point[maybe], segment[maybe], nearest_chord[maybe]


def _share(offset: Array, along: Array) -> Array:
    """Return the foot points (k,) of points on segments, as a fraction of the segment.

    offset: (3, k) points relative to the segments' starts. along: (3, k) segment vectors.
    """
    squared = _dot(along, along)
    return _between(_dot(offset, along) / np.where(squared > 0.0, squared, 1.0), 0.0, 1.0)


def _dot(a: Array, b: Array) -> Array:
    """Return the scalar products (k,) of vectors (3, k), summed in the order of einsum by rows."""
    product = a * b
    result: Array = product[0] + product[2]
    result += product[1]
    return result


def _size(vectors: Array) -> Array:
    """Return the lengths (k,) of vectors (3, k)."""
    return lengths(vectors.T)


def _between(values: Array, low: Array | float, high: Array | float) -> Array:
    """Clip values; np.clip is many times slower for small arrays."""
    clipped: Array = np.minimum(np.maximum(values, low), high)
    return clipped


def _to_cubic(
    points: Array, point: Index, segment: Index, nearest_chord: Mask, curve: Curve
) -> Array:
    """Return the minimum distance (n,) of points to the cubics of their paired segments (k,).

    Newton's method starts at the foot point on the chord. Only a segment with the nearest chord extends past its ends.
    """
    # axis by axis, because rows of three components are several times slower
    target = columns(points)[:, point]
    p, q, a, b = (
        columns(column)[:, segment]
        for column in (curve.start, curve.end, curve.start_slope, curve.end_slope)
    )
    low = np.where(nearest_chord, curve.low[segment], 0.0)
    high = np.where(nearest_chord, curve.high[segment], 1.0)
    d = q - p
    square, cube = 3.0 * d - 2.0 * a - b, a + b - 2.0 * d
    u = _share(target - p, d)
    for _ in range(3):
        residual = p + u * (a + u * (square + u * cube)) - target
        slope = a + u * (2.0 * square + 3.0 * u * cube)
        bend = 2.0 * square + 6.0 * u * cube
        rate = _dot(slope, slope) + _dot(residual, bend)
        u = _between(u - _dot(residual, slope) / np.where(rate > 0.0, rate, np.inf), low, high)
    distance = _size(p + u * (a + u * (square + u * cube)) - target)
    shortest, begins = np.empty(len(points)), np.flatnonzero(np.diff(point, prepend=-1))
    shortest[point[begins]] = np.minimum.reduceat(distance, begins)
    return shortest


def columns_of(points: Array, closed: bool, tangents: Array | None = None) -> tuple[Array, ...]:
    """Return the columns of `Curve` for points of a bead or a section.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.
    closed : bool
        Whether the curve is closed. A closed curve repeats its first point.
    tangents : (n, 2, 3) array or None, optional
        Unit tangents on arrival at and departure from each point; None if unknown.

    Returns
    -------
    tuple of array
        One entry for each field of `Curve`.
    """
    step = np.diff(points, axis=0)
    length = lengths(step)
    if tangents is not None:
        turn = np.arccos(np.clip(np.einsum("ij,ij->i", tangents[:, 0], tangents[:, 1]), -1.0, 1.0))
        smooth = turn < SMOOTH
        smooth[[0, -1]] &= closed
        return _arcs(points, tangents[:-1, 1], tangents[1:, 0], smooth[:-1], smooth[1:])
    chord = step / np.where(length > 0.0, length, 1.0)[:, None]
    incoming, outgoing = _before(chord), chord
    smooth = ~_corners(incoming, outgoing, closed)  # at the start of each segment
    smooth[0] &= closed
    # tangent of the parabola through three points; the nearer adjacent point counts more
    tangent = unit_rows(incoming * length[:, None] + outgoing * _before(length)[:, None])
    at_start, at_end = tangent, _after(tangent)
    smooth_end = _after(smooth)
    # at an end or corner, use the arc through both points with the tangent of the other end
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
    """Return the columns for segments with unit tangents (n - 1, 3) at smooth or sharp ends."""
    return (
        points[:-1],
        points[1:],
        *derivatives(points, start, end),
        np.where(smooth, -_OVERRUN_SHARE, 0.0),
        np.where(smooth_end, 1.0 + _OVERRUN_SHARE, 1.0),
    )


def _corners(incoming: Array, outgoing: Array, closed: bool) -> Mask:
    """Return whether the path has a corner at the start of each segment, (n,); unit directions (n, 3)."""
    turn = np.arctan2(
        lengths(crosses(incoming, outgoing)), np.einsum("ij,ij->i", incoming, outgoing)
    )
    if not closed:
        turn[0] = 0.0
    adjacent = np.maximum(_before(turn), _after(turn))
    corners: Mask = (turn >= CORNER) | ((turn > SLIGHT) & (turn > SUDDEN * adjacent))
    return corners


def _before(rows: NDArray[Any]) -> NDArray[Any]:
    """Return the previous row of each row, cyclically; np.roll is many times slower for small arrays."""
    return np.concatenate((rows[-1:], rows[:-1]))


def _after(rows: NDArray[Any]) -> NDArray[Any]:
    """Return the next row of each row, cyclically."""
    return np.concatenate((rows[1:], rows[:1]))


def _mirrored(tangent: Array, chord: Array) -> Array:
    """Return the tangent at the other end of the arc with this chord."""
    mirrored: Array = 2.0 * np.einsum("ij,ij->i", tangent, chord)[:, None] * chord - tangent
    return mirrored
