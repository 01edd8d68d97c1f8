# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strokes of deposit and a section on a raster: where deposit is missing, and where it is twice.

A stroke is drawn with its effective width, volume / length / layer height, so that its area times the layer height is the
deposited volume:

- A segment is a rectangle as wide as the stroke there.
- An outer corner is mitred up to a turn of MITRED_TURN_RAD. The wedge outside has the area of the overlap inside, so that
  consecutive segments neither lack nor double material. A sharper corner is round outside, and its overlap counts.
- The ends of an open stroke are round. Each end moves back first, at a constant width by pi / 8 of it, so that the round end
  adds no volume.
  A stroke shorter than both ends together is a disc.

The raster is turned against the coordinates: no edge of a part or stroke runs along its rows, and errors of pixels average out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...types import Array, Index, Integers, Mask

TURN_RAD = math.atan(
    0.5 * (math.sqrt(5.0) - 1.0)
)  # of the raster; far from every ratio of small numbers
_TURN = np.array(
    [[math.cos(TURN_RAD), math.sin(TURN_RAD)], [-math.sin(TURN_RAD), math.cos(TURN_RAD)]]
)
MITRED_TURN_RAD = math.radians(95.0)  # right angles with the rounding of a G-code file included
STRAIGHT_RAD = 1e-9  # a smaller turn leaves no wedge
ROUND_END = math.pi / 8.0  # of the width: a rectangle of that length has the area of a round end
ARC_SEGMENTS = 16  # of a round end
# a stroke is a loop if its ends are nearer than a share of its width and of its length; slicers leave gaps at seams
CLOSING, CLOSING_OF_LENGTH = 0.25, 0.08


class Stroke(NamedTuple):
    """An uninterrupted deposit: points (n, 2) mm, widths (n - 1,) mm of its segments. A loop repeats its first point."""

    points: Array
    widths: Array

    @property
    def area(self) -> float:
        """Length times width, mm^2."""
        return float(lengths(self.points) @ self.widths)

    @property
    def closes(self) -> bool:
        """Whether it comes back to its start, up to the gap of a seam."""
        width = min(self.widths[0], self.widths[-1])
        gap = np.hypot(*(self.points[-1] - self.points[0]))
        longest_gap = min(CLOSING * width, CLOSING_OF_LENGTH * lengths(self.points).sum())
        return bool(gap <= longest_gap)

    @property
    def is_dot(self) -> bool:
        """Whether it is shorter than its round ends together."""
        ends = ROUND_END * (self.widths[0] ** 2 + self.widths[-1] ** 2)
        return not self.closes and bool(self.area <= ends)

    def drop_repeats(self) -> Stroke:
        """The stroke without segments of no length."""
        long = lengths(self.points) > 0.0
        return Stroke(self.points[np.concatenate([[True], long])], self.widths[long])


class Outline(NamedTuple):
    """What strokes cover: convex quadrangles (k, 4, 2) and fans (m, ARC_SEGMENTS + 2, 2), mm, and discs (d, 3), middle and
    radius in mm. kites: (j, 4, 2) mm, where two consecutive quadrangles overlap inside of a mitred corner.
    """

    quadrangles: Array
    fans: Array
    discs: Array
    kites: Array


class Raster(NamedTuple):
    """Rows of square pixels on coordinates turned by TURN_RAD; `low` (2,) mm is the centre of the first pixel."""

    low: Array
    pixel: float
    rows: int
    columns: int

    @classmethod
    def around(cls, points: Array, reach: float, pixel: float) -> Raster:
        """Return a raster that holds the surroundings of points, with an empty pixel around.

        Parameters
        ----------
        points : (n, 2) array
            Points of the plane, mm.
        reach : float
            Distance to hold around them, mm.
        pixel : float
            Size of a pixel, mm.

        Returns
        -------
        Raster
            The raster, turned by TURN_RAD.
        """
        points, reach = turn_points(points), reach + pixel
        low, high = points.min(axis=0) - reach, points.max(axis=0) + reach
        columns, rows = np.ceil((high - low) / pixel).astype(int) + 1
        return cls(low, pixel, int(rows), int(columns))

    def inside(self, edges: Array) -> Mask:
        """(rows, columns) mask of the pixels that edges (k, 2, 2), from start to end, wind around."""
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
            How many shapes of strokes cover each pixel, and how many times deposit is there.
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
            Numbers of the pixels, fractions allowed.

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
            mm: at the first pixel, the end of its row, the last pixel and the start of the last
            row.
        """
        columns = np.array([-0.5, self.columns - 0.5, self.columns - 0.5, -0.5])
        rows = np.array([-0.5, -0.5, self.rows - 0.5, self.rows - 0.5])
        return self.to_plane(rows, columns)

    def _covered(self, spans: Array) -> Integers:
        """(rows, columns) number of spans (3, n), rows, left and right ends, over each pixel."""
        row, left, right = spans
        first, past = np.ceil(left), np.floor(right) + 1.0
        used = past > first
        return self._sums(row[used], first[used], row[used], past[used])

    def _sums(self, row: Array, column: Array, less_row: Array, less_column: Array) -> Integers:
        """(rows, columns) numbers of places (n,) at or left of each pixel, within its row, less those of other places (m,)."""
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
        """Rows, and left and right ends there, of convex polygons (k, c, 2) mm of either sense."""
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
        """Rows, and left and right ends there, of discs (k, 3): middle and radius, mm."""
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
    """Return shapes whose union is the area that strokes cover, of each stroke without the inside of its mitred corners."""
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
    """Which joints (n, 2) between the segments `before` and `after` (n,) are mitred, the mitres (k, 4, 2) outside of them, and
    fans (m, ARC_SEGMENTS + 2, 2) outside of sharper corners."""
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
    """Sectors (n, ARC_SEGMENTS + 2, 2) about middles (n, 2) that begin in unit directions (n, 2) and turn by (n,) rad."""
    start = np.arctan2(first[:, 1], first[:, 0])
    angle = start[:, None] + sweep[:, None] * np.linspace(0.0, 1.0, ARC_SEGMENTS + 1)
    arc = middle[:, None] + radius[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=2)
    return np.concatenate([middle[:, None], arc], axis=1)


def _disc_of(stroke: Stroke) -> Array:
    """The disc (1, 3) with the middle and the volume of a short stroke."""
    long, area = lengths(stroke.points), stroke.area
    middle = (long * stroke.widths) @ (0.5 * (stroke.points[1:] + stroke.points[:-1])) / area
    return np.array([[*middle, math.sqrt(area / math.pi)]])


def _shortened(stroke: Stroke) -> Stroke:
    """The stroke without the lengths of its round ends, each of which has the area of what it replaces."""
    points, widths = stroke
    for _ in range(2):
        long = lengths(points)
        area = np.cumsum(long * widths) - long * widths  # before each segment
        replaced = np.clip((ROUND_END * widths**2 - area) / (long * widths), 0.0, None)
        # a segment that goes up to rounding goes as a whole: it would be left without a direction
        segment = int(np.argmax(np.r_[replaced[:-1] < 1.0 - 1e-9, True]))
        share = min(float(replaced[segment]), 1.0 - 1e-9)
        start = points[segment] + share * (points[segment + 1] - points[segment])
        points = np.vstack([start, points[segment + 1 :]])[::-1]
        widths = widths[segment:][::-1]
    return Stroke(points, widths)


def _pairs(first: Index, past: Index) -> tuple[Index, Index]:
    """Numbers of shapes and of the rows from `first` (k,) to before `past` (k,), a pair for each."""
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
    """Turn points into the coordinates of the raster.

    Parameters
    ----------
    points : (..., 2) array
        Points of the plane, mm.

    Returns
    -------
    (..., 2) array
        Along the columns and rows of the raster, mm.
    """
    return np.asarray(points @ _TURN)
