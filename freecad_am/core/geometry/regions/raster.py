# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strokes of deposit and a section on a raster: missing deposit and double deposit.

A stroke is drawn with its effective width, volume / length / layer height, so that its area times
the layer height is the deposited volume:

- A segment is a rectangle of the local stroke width.
- An outer corner is mitred up to a turn angle of MITRED_TURN_RAD. The wedge outside has the area of
  the overlap inside, so that consecutive segments neither lack nor double material. A sharper
  corner is round outside, and its overlap counts.
- The ends of an open stroke are round. Each end is first shortened, at constant width by pi / 8 of
  the width, so that the round end adds no volume. A stroke shorter than both ends is a disc.

The raster is rotated against the coordinates, so that no edge of a part or stroke is parallel to
its rows. Pixel errors then average out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...types import Array, Index, Integers, Mask

TURN_RAD = math.atan(
    0.5 * (math.sqrt(5.0) - 1.0)
)  # raster angle; its tangent is far from all ratios of small integers
_TURN = np.array(
    [[math.cos(TURN_RAD), math.sin(TURN_RAD)], [-math.sin(TURN_RAD), math.cos(TURN_RAD)]]
)
MITRED_TURN_RAD = math.radians(95.0)  # includes right angles with the rounding of a G-code file
STRAIGHT_RAD = 1e-9  # a smaller turn angle leaves no wedge
ROUND_END = math.pi / 8.0  # of the width: a rectangle of that length has the area of a round end
ARC_SEGMENTS = 16  # segments of a round end
# maximum end gap of a loop, as fractions of stroke width and length; slicers leave gaps at seams
CLOSING, CLOSING_OF_LENGTH = 0.25, 0.08


class Stroke(NamedTuple):
    """Uninterrupted deposit: points (n, 2) and segment widths (n - 1,), mm.

    A loop repeats its first point.
    """

    points: Array
    widths: Array

    @property
    def area(self) -> float:
        """Sum of segment length times width, mm^2."""
        return float(lengths(self.points) @ self.widths)

    @property
    def closes(self) -> bool:
        """Whether the stroke is a loop, with at most the gap of a seam."""
        width = min(self.widths[0], self.widths[-1])
        gap = np.hypot(*(self.points[-1] - self.points[0]))
        longest_gap = min(CLOSING * width, CLOSING_OF_LENGTH * lengths(self.points).sum())
        return bool(gap <= longest_gap)

    @property
    def is_dot(self) -> bool:
        """Whether the stroke is shorter than both round ends together."""
        ends = ROUND_END * (self.widths[0] ** 2 + self.widths[-1] ** 2)
        return not self.closes and bool(self.area <= ends)

    def drop_repeats(self) -> Stroke:
        """Return the stroke without zero-length segments."""
        long = lengths(self.points) > 0.0
        return Stroke(self.points[np.concatenate([[True], long])], self.widths[long])


class Outline(NamedTuple):
    """Area that strokes cover, mm.

    quadrangles: (k, 4, 2) convex. fans: (m, ARC_SEGMENTS + 2, 2). discs: (d, 3) centre and radius.
    kites: (j, 4, 2) overlaps of consecutive quadrangles inside mitred corners.
    """

    quadrangles: Array
    fans: Array
    discs: Array
    kites: Array


class Raster(NamedTuple):
    """Square pixels on coordinates rotated by TURN_RAD.

    low: (2,) centre of the first pixel, mm.
    """

    low: Array
    pixel: float
    rows: int
    columns: int

    @classmethod
    def around(cls, points: Array, reach: float, pixel: float) -> Raster:
        """Return a raster over the surroundings of points, with an empty pixel at each edge.

        Parameters
        ----------
        points : (n, 2) array
            Points of the plane, mm.
        reach : float
            Distance to include around the points, mm.
        pixel : float
            Size of a pixel, mm.

        Returns
        -------
        Raster
            The raster, rotated by TURN_RAD.
        """
        points, reach = turn_points(points), reach + pixel
        low, high = points.min(axis=0) - reach, points.max(axis=0) + reach
        columns, rows = np.ceil((high - low) / pixel).astype(int) + 1
        return cls(low, pixel, int(rows), int(columns))

    def inside(self, edges: Array) -> Mask:
        """Return the mask (rows, columns) of pixels inside closed loops of edges (k, 2, 2)."""
        edges = (turn_points(edges) - self.low) / self.pixel
        start, end = edges[:, 0], edges[:, 1]
        first = np.ceil(np.minimum(start[:, 1], end[:, 1])).astype(int)
        past = np.ceil(np.maximum(start[:, 1], end[:, 1])).astype(int)
        edge, row = _pairs(first, past)
        step = end[edge] - start[edge]
        crossing = start[edge, 0] + (row - start[edge, 1]) / step[:, 1] * step[:, 0]
        up = step[:, 1] > 0.0
        column = np.ceil(crossing)
        return np.asarray(
            self._sums(row[up].astype(float), column[up], row[~up].astype(float), column[~up]) != 0
        )

    def counts(self, strokes: Sequence[Stroke]) -> tuple[Integers, Integers]:
        """Count shapes and deposit on each pixel.

        Parameters
        ----------
        strokes : sequence of Stroke
            The strokes, mm.

        Returns
        -------
        shapes, deposits : (rows, columns) array
            Number of stroke shapes and number of deposits over each pixel.
        """
        quadrangles, fans, discs, kites = outline(strokes)
        covering = np.hstack(
            [
                self._polygon_spans(quadrangles),
                self._polygon_spans(fans),
                self._disc_spans(discs),
            ]
        )
        shapes = self._covered(covering)
        return shapes, shapes - self._covered(np.asarray(self._polygon_spans(kites)))

    def to_plane(self, rows: Array, columns: Array) -> Array:
        """Return the centres of pixels.

        Parameters
        ----------
        rows, columns : (n,) array
            Pixel indices, which may be fractional.

        Returns
        -------
        (n, 2) array
            Points of the plane, mm.
        """
        places = self.low + self.pixel * np.column_stack([columns, rows])
        return np.asarray(places @ _TURN.T)

    def corners(self) -> Array:
        """Return the corners of the raster.

        Returns
        -------
        (4, 2) array
            Corners, mm: at the first pixel, the end of its row, the last pixel and the start of
            the last row.
        """
        columns = np.array([-0.5, self.columns - 0.5, self.columns - 0.5, -0.5])
        rows = np.array([-0.5, -0.5, self.rows - 0.5, self.rows - 0.5])
        return self.to_plane(rows, columns)

    def _covered(self, spans: Array) -> Integers:
        """Count the spans (3, n), given by row, left and right end, over each pixel."""
        row, left, right = spans
        first, past = np.ceil(left), np.floor(right) + 1.0
        used = past > first
        return self._sums(row[used], first[used], row[used], past[used])

    def _sums(self, row: Array, column: Array, less_row: Array, less_column: Array) -> Integers:
        """Count positions (n,) at or left of each pixel in its row, minus those of `less` (m,).

        Returns (rows, columns).
        """
        more, less = (
            np.bincount(
                rows.astype(int) * (self.columns + 1) + columns.astype(int),
                minlength=self.rows * (self.columns + 1),
            )
            for rows, columns in ((row, column), (less_row, less_column))
        )
        change = (more - less).reshape(self.rows, -1)
        return np.asarray(np.cumsum(change, axis=1)[:, :-1])

    def _polygon_spans(self, polygons: Array) -> tuple[Array, Array, Array]:
        """Return rows, left and right ends of spans of convex polygons (k, c, 2), mm."""
        corners = (turn_points(polygons) - self.low) / self.pixel
        heights = corners[:, :, 1]
        polygon, row = _pairs(
            np.ceil(heights.min(axis=1)).astype(int), np.floor(heights.max(axis=1)).astype(int) + 1
        )
        start = corners[polygon]
        step = np.roll(corners, -1, axis=1)[polygon] - start
        above = row[:, None] - start[:, :, 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            share = above / step[:, :, 1]
            crossing = start[:, :, 0] + share * step[:, :, 0]
        crosses = (share >= 0.0) & (share <= 1.0)
        return (
            row.astype(float),
            np.where(crosses, crossing, np.inf).min(axis=1, initial=np.inf),
            np.where(crosses, crossing, -np.inf).max(axis=1, initial=-np.inf),
        )

    def _disc_spans(self, discs: Array) -> tuple[Array, Array, Array]:
        """Return rows, left and right ends of spans of discs (k, 3): centre and radius, mm."""
        middle = (turn_points(discs[:, :2]) - self.low) / self.pixel
        radius = discs[:, 2] / self.pixel
        disc, row = _pairs(
            np.ceil(middle[:, 1] - radius).astype(int),
            np.floor(middle[:, 1] + radius).astype(int) + 1,
        )
        half = np.sqrt(np.maximum(radius[disc] ** 2 - (row - middle[disc, 1]) ** 2, 0.0))
        return row.astype(float), middle[disc, 0] - half, middle[disc, 0] + half


_NO_QUADRANGLES, _NO_FANS = np.zeros((0, 4, 2)), np.zeros((0, ARC_SEGMENTS + 2, 2))
_EMPTY = Outline(_NO_QUADRANGLES, _NO_FANS, np.zeros((0, 3)), _NO_QUADRANGLES)


def outline(strokes: Sequence[Stroke]) -> Outline:
    """Return the shapes that strokes cover, and the overlaps inside their mitred corners."""
    discs = [_disc_of(stroke) for stroke in strokes if stroke.is_dot]
    lines = [
        stroke if stroke.closes else _shortened(stroke) for stroke in strokes if not stroke.is_dot
    ]
    if not lines:
        return _EMPTY._replace(discs=np.concatenate([_EMPTY.discs, *discs]))
    start = np.concatenate([line.points[:-1] for line in lines])
    end = np.concatenate([line.points[1:] for line in lines])
    widths = np.concatenate([line.widths for line in lines])
    along = (end - start) / np.hypot(*(end - start).T)[:, None]
    past = np.cumsum([len(line.widths) for line in lines])
    first, last = np.r_[0, past[:-1]], past - 1
    after = np.arange(1, len(widths) + 1)
    after[last] = first
    closed = np.array([stroke.closes for stroke in strokes if not stroke.is_dot], dtype=bool)
    left = np.stack([-along[:, 1], along[:, 0]], axis=1)
    aside = 0.5 * widths[:, None] * left
    bodies = np.stack([start + aside, end + aside, end - aside, start - aside], axis=1)
    joined = np.ones(len(widths), dtype=bool)
    joined[last[~closed]] = False
    before = np.flatnonzero(joined)
    joint = end[before]
    mitred, wedges, fans = _corners(joint, along, widths, before, after[before])
    first, last = first[~closed], last[~closed]
    ends = _fans(
        np.concatenate([start[first], end[last]]),
        0.5 * np.concatenate([widths[first], widths[last]]),
        np.concatenate([left[first], -left[last]]),
        np.full(2 * len(first), math.pi),
    )
    return Outline(
        np.concatenate([bodies, wedges]),
        np.concatenate([ends, fans]),
        np.concatenate([_EMPTY.discs, *discs]),
        2.0 * joint[mitred, None] - wedges,
    )


def _corners(
    joint: Array, along: Array, widths: Array, before: Index, after: Index
) -> tuple[Mask, Array, Array]:
    """Return which joints (n, 2) of segments `before` and `after` (n,) are mitred.

    Also return the mitres (k, 4, 2), and the fans (m, ARC_SEGMENTS + 2, 2) of sharper corners.
    """
    u, v = along[before], along[after]
    turn = np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], np.sum(u * v, axis=1))
    bent = np.abs(turn) > STRAIGHT_RAD
    mitred = bent & (np.abs(turn) <= MITRED_TURN_RAD)
    outwards = -np.sign(turn)[:, None]
    first = outwards * np.stack([-u[:, 1], u[:, 0]], axis=1)
    second = outwards * np.stack([-v[:, 1], v[:, 0]], axis=1)
    half = 0.25 * (widths[before] + widths[after])
    with np.errstate(divide="ignore", invalid="ignore"):
        tip = joint + (half / (1.0 + np.cos(turn)))[:, None] * (first + second)
    wedges = np.stack(
        [
            joint,
            joint + 0.5 * widths[before, None] * first,
            tip,
            joint + 0.5 * widths[after, None] * second,
        ],
        axis=1,
    )
    sharp = bent & ~mitred
    radius = 0.5 * np.minimum(widths[before], widths[after])
    fans = _fans(joint[sharp], radius[sharp], first[sharp], turn[sharp])
    return mitred, wedges[mitred], fans


def _fans(middle: Array, radius: Array, first: Array, sweep: Array) -> Array:
    """Return sectors (n, ARC_SEGMENTS + 2, 2) about centres (n, 2).

    first: (n, 2) unit start directions. sweep: (n,) angles, rad.
    """
    start = np.arctan2(first[:, 1], first[:, 0])
    angle = start[:, None] + sweep[:, None] * np.linspace(0.0, 1.0, ARC_SEGMENTS + 1)
    arc = middle[:, None] + radius[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=2)
    return np.concatenate([middle[:, None], arc], axis=1)


def _disc_of(stroke: Stroke) -> Array:
    """Return the disc (1, 3) with the centroid and the area of a short stroke."""
    long, area = lengths(stroke.points), stroke.area
    middle = (long * stroke.widths) @ (0.5 * (stroke.points[1:] + stroke.points[:-1])) / area
    return np.array([[*middle, math.sqrt(area / math.pi)]])


def _shortened(stroke: Stroke) -> Stroke:
    """Return the stroke shortened by its round ends, each with the area that it replaces."""
    points, widths = stroke
    for _ in range(2):
        long = lengths(points)
        area = np.cumsum(long * widths) - long * widths  # area before each segment
        replaced = np.clip((ROUND_END * widths**2 - area) / (long * widths), 0.0, None)
        # drop a segment that is removed up to rounding, or its direction is undefined
        segment = int(np.argmax(np.r_[replaced[:-1] < 1.0 - 1e-9, True]))
        share = min(float(replaced[segment]), 1.0 - 1e-9)
        start = points[segment] + share * (points[segment + 1] - points[segment])
        points = np.vstack([start, points[segment + 1 :]])[::-1]
        widths = widths[segment:][::-1]
    return Stroke(points, widths)


def _pairs(first: Index, past: Index) -> tuple[Index, Index]:
    """Return pairs of shape and row index, for rows from `first` (k,) to before `past` (k,)."""
    count = np.maximum(past - first, 0)
    shape = np.repeat(np.arange(len(count)), count)
    return shape, np.arange(len(shape)) - np.repeat(np.cumsum(count) - count - first, count)


def lengths(points: Array) -> Array:
    """Return the lengths of the segments of a polyline.

    Parameters
    ----------
    points : (n, 2) array
        The polyline, mm.

    Returns
    -------
    (n - 1,) array
        mm.
    """
    return np.asarray(np.hypot(*np.diff(points, axis=0).T))


def turn_points(points: Array) -> Array:
    """Rotate points into raster coordinates.

    Parameters
    ----------
    points : (..., 2) array
        Points of the plane, mm.

    Returns
    -------
    (..., 2) array
        Coordinates along the columns and rows of the raster, mm.
    """
    return np.asarray(points @ _TURN)
