# SPDX-License-Identifier: LGPL-2.1-or-later
"""The judge of `bench infill`: how well the strokes of a layer fill its section, measured on a raster.

A stroke is drawn with its effective width, volume / length / layer height, so that its area times the layer height is the
deposited volume:

- A segment is a rectangle as wide as the stroke there.
- An outer corner is mitred up to a turn of MITRED_TURN_RAD. The wedge outside has the area of the overlap inside, so that
  consecutive segments neither lack nor double material. A sharper corner is round outside, and its overlap counts.
- The ends of an open stroke are round. Each end moves back by pi / 8 of the width first, so that the round end adds no volume.
  A stroke shorter than both ends together is a disc.

The raster is turned against the coordinates: no edge of a part or stroke runs along its rows, and errors of pixels average out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

PIXELS_ACROSS = 40  # of a nominal bead
TURN_RAD = math.atan(
    0.5 * (math.sqrt(5.0) - 1.0)
)  # of the raster; far from every ratio of small numbers
MITRED_TURN_RAD = math.radians(95.0)  # right angles with the rounding of a G-code file included
STRAIGHT_RAD = 1e-9  # a smaller turn leaves no wedge
ROUND_END = math.pi / 8.0  # of the width: a rectangle of that length has the area of a round end
# a stroke is a loop if its ends are nearer than a share of its width and of its length; slicers leave gaps at seams
CLOSING, CLOSING_OF_LENGTH = 0.25, 0.08


class Stroke(NamedTuple):
    """An uninterrupted deposit: points (n, 2) mm, widths (n - 1,) mm of its segments. A loop repeats its first point."""

    points: np.ndarray
    widths: np.ndarray


class Verdict(NamedTuple):
    """Shares of the area of a section.

    void: without deposit, where the narrowest bead could reach. over: deposit beyond the covered area. outside: covered area
    outside of the section.
    """

    void: float
    over: float
    outside: float


def judge(
    section: np.ndarray, strokes: Sequence[Stroke], width: float, narrowest: float = 0.0
) -> Verdict:
    """Judge the strokes of a layer.

    Parameters
    ----------
    section
        (k, 2, 2) mm, edges of the section's border from start to end, in any order, with the material on the same side of all.
    strokes
        Deposit of the layer; may be empty.
    width
        mm of a nominal bead, for the size of pixels.
    narrowest
        mm, the narrowest bead: void only counts where the section is that wide.
    """
    strokes = [_without_repeats(stroke) for stroke in strokes]
    strokes = [stroke for stroke in strokes if len(stroke.widths)]
    raster = Raster.around(section, strokes, width / PIXELS_ACROSS)
    inside = raster.inside(section)
    covered = raster.cover(strokes)
    area = np.count_nonzero(inside)
    if not area:
        raise ValueError("the section has no area")
    reachable = opened(inside, 0.5 * narrowest / raster.pixel)
    deposit = sum(float(lengths(stroke.points) @ stroke.widths) for stroke in strokes)
    excess = deposit / raster.pixel**2 - np.count_nonzero(covered)
    return Verdict(
        np.count_nonzero(reachable & ~covered) / area,
        max(excess, 0.0) / area,
        np.count_nonzero(covered & ~inside) / area,
    )


class Raster(NamedTuple):
    """Rows of square pixels on coordinates turned by TURN_RAD; `low` (2,) mm is the centre of the first pixel."""

    low: np.ndarray
    pixel: float
    rows: int
    columns: int

    @classmethod
    def around(cls, section: np.ndarray, strokes: Sequence[Stroke], pixel: float) -> Raster:
        """Return a raster that holds a section and strokes, with an empty pixel around."""
        points = turned(np.vstack([section.reshape(-1, 2), *(stroke.points for stroke in strokes)]))
        reach = max((float(stroke.widths.max()) for stroke in strokes), default=0.0) + pixel
        low, high = points.min(axis=0) - reach, points.max(axis=0) + reach
        columns, rows = np.ceil((high - low) / pixel).astype(int) + 1
        return cls(low, pixel, int(rows), int(columns))

    def inside(self, section: np.ndarray) -> np.ndarray:
        """(rows, columns) mask of the pixels that edges (k, 2, 2) wind around."""
        edges = (turned(section) - self.low) / self.pixel
        start, end = edges[:, 0], edges[:, 1]
        first = np.ceil(np.minimum(start[:, 1], end[:, 1])).astype(int)
        past = np.ceil(np.maximum(start[:, 1], end[:, 1])).astype(int)
        edge, row = _pairs(first, past)
        step = end[edge] - start[edge]
        crossing = start[edge, 0] + (row - start[edge, 1]) / step[:, 1] * step[:, 0]
        up = step[:, 1] > 0.0
        column = np.ceil(crossing)
        return self._sums(row[up], column[up], row[~up], column[~up]) != 0

    def cover(self, strokes: Sequence[Stroke]) -> np.ndarray:
        """(rows, columns) mask of the pixels with deposit."""
        outlines = [outline(stroke) for stroke in strokes]
        polygons = np.concatenate([np.zeros((0, 4, 2)), *(entry.polygons for entry in outlines)])
        discs = np.concatenate([np.zeros((0, 3)), *(entry.discs for entry in outlines)])
        row, left, right = np.hstack([self._polygon_spans(polygons), self._disc_spans(discs)])
        first, past = np.ceil(left), np.floor(right) + 1.0
        used = past > first
        return self._sums(row[used], first[used], row[used], past[used]) > 0

    def _sums(
        self, row: np.ndarray, column: np.ndarray, less_row: np.ndarray, less_column: np.ndarray
    ) -> np.ndarray:
        """(rows, columns) numbers of places (n,) at or left of each pixel, within its row, less those of other places (m,)."""
        more, less = (
            np.bincount(
                rows.astype(int) * (self.columns + 1) + columns.astype(int),
                minlength=self.rows * (self.columns + 1),
            )
            for rows, columns in ((row, column), (less_row, less_column))
        )
        change = (more - less).reshape(self.rows, -1)
        return np.cumsum(change, axis=1, dtype=np.int32)[:, :-1]

    def _polygon_spans(self, polygons: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rows, and left and right ends there, of convex polygons (k, c, 2) mm of either sense."""
        corners = (turned(polygons) - self.low) / self.pixel
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
            row,
            np.where(crosses, crossing, np.inf).min(axis=1, initial=np.inf),
            np.where(crosses, crossing, -np.inf).max(axis=1, initial=-np.inf),
        )

    def _disc_spans(self, discs: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rows, and left and right ends there, of discs (k, 3): middle and radius, mm."""
        middle, radius = (
            (turned(discs[:, :2]) - self.low) / self.pixel,
            discs[:, 2] / self.pixel,
        )
        disc, row = _pairs(
            np.ceil(middle[:, 1] - radius).astype(int),
            np.floor(middle[:, 1] + radius).astype(int) + 1,
        )
        half = np.sqrt(np.maximum(radius[disc] ** 2 - (row - middle[disc, 1]) ** 2, 0.0))
        return row, middle[disc, 0] - half, middle[disc, 0] + half


class Outline(NamedTuple):
    """What a stroke covers: convex polygons (k, 4, 2) mm and discs (m, 3), middle and radius in mm."""

    polygons: np.ndarray
    discs: np.ndarray


def outline(stroke: Stroke) -> Outline:
    """Return polygons and discs whose union is the area that a stroke covers."""
    points, widths = stroke
    closed = is_loop(stroke)
    ends = np.zeros((0, 3))
    if not closed:
        if float(lengths(points) @ widths) <= ROUND_END * (widths[0] ** 2 + widths[-1] ** 2):
            return Outline(np.zeros((0, 4, 2)), _disc_of(stroke))
        points, widths = _shortened(*_shortened(points, widths, ROUND_END * widths[0]))
        ends = np.array([[*points[0], 0.5 * widths[0]], [*points[-1], 0.5 * widths[-1]]])
    start, end = points[:-1], points[1:]
    along = (end - start) / lengths(points)[:, None]
    aside = 0.5 * widths[:, None] * np.stack([-along[:, 1], along[:, 0]], axis=1)
    bodies = np.stack([start + aside, end + aside, end - aside, start - aside], axis=1)
    before = np.arange(len(widths)) if closed else np.arange(len(widths) - 1)
    wedges, discs = _corners(points[before + 1], along, widths, before)
    return Outline(np.concatenate([bodies, wedges]), np.concatenate([ends, discs]))


def is_loop(stroke: Stroke) -> bool:
    """Whether a stroke comes back to its start, up to the gap of a seam."""
    width = min(stroke.widths[0], stroke.widths[-1])
    gap = np.hypot(*(stroke.points[-1] - stroke.points[0]))
    longest_gap = min(CLOSING * width, CLOSING_OF_LENGTH * lengths(stroke.points).sum())
    return bool(gap <= longest_gap)


def _corners(
    joint: np.ndarray, along: np.ndarray, widths: np.ndarray, before: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Mitres (k, 4, 2) and discs (m, 3) outside of the corners at joints (n, 2) that follow the segments `before` (n,)."""
    after = (before + 1) % len(along)
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
    return wedges[mitred], np.column_stack([joint, radius])[sharp]


def _disc_of(stroke: Stroke) -> np.ndarray:
    """The disc (1, 3) with the middle and the volume of a short stroke."""
    long = lengths(stroke.points)
    area = float(long @ stroke.widths)
    middle = (long * stroke.widths) @ (0.5 * (stroke.points[1:] + stroke.points[:-1])) / area
    return np.array([[*middle, math.sqrt(area / math.pi)]])


def _shortened(
    points: np.ndarray, widths: np.ndarray, by: float | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """A polyline and its widths, the other way round and without its first `by` mm; None: by its round end."""
    by = ROUND_END * widths[0] if by is None else by
    arc = np.r_[0.0, np.cumsum(lengths(points))]
    by = min(by, arc[-1] * (1.0 - 1e-9))
    segment = int(np.searchsorted(arc, by, side="right")) - 1
    share = (by - arc[segment]) / (arc[segment + 1] - arc[segment])
    start = points[segment] + share * (points[segment + 1] - points[segment])
    return np.vstack([start, points[segment + 1 :]])[::-1], widths[segment:][::-1]


def _without_repeats(stroke: Stroke) -> Stroke:
    """The stroke without segments of no length."""
    long = lengths(stroke.points) > 0.0
    return Stroke(stroke.points[np.r_[True, long]], stroke.widths[long])


def _pairs(first: np.ndarray, past: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of shapes and of the rows from `first` (k,) to before `past` (k,), a pair for each."""
    count = np.maximum(past - first, 0)
    shape = np.repeat(np.arange(len(count)), count)
    return shape, np.arange(len(shape)) - np.repeat(np.cumsum(count) - count - first, count)


def opened(mask: np.ndarray, radius: float) -> np.ndarray:
    """The part of a mask that discs of a radius, pixels, reach without leaving it."""
    return mask & grown(~grown(~mask, radius), radius)


def grown(mask: np.ndarray, radius: float) -> np.ndarray:
    """A mask with all pixels within a radius, pixels, of its own."""
    result, wide = mask.copy(), mask.copy()
    rows = np.arange(-math.floor(radius), math.floor(radius) + 1)
    half_widths = np.floor(np.sqrt(radius**2 - rows**2)).astype(int)
    for half_width in range(half_widths.max() + 1):
        if half_width > 0:
            narrower = wide.copy()
            wide[:, 1:] |= narrower[:, :-1]
            wide[:, :-1] |= narrower[:, 1:]
        for row in rows[half_widths == half_width]:
            count = len(mask) - abs(row)
            result[max(row, 0) :][:count] |= wide[max(-row, 0) :][:count]
    return result


def lengths(points: np.ndarray) -> np.ndarray:
    """(n - 1,) mm of the segments of a polyline (n, 2)."""
    return np.hypot(*np.diff(points, axis=0).T)


def turned(points: np.ndarray) -> np.ndarray:
    """Points (..., 2) in the coordinates of the raster."""
    cos, sin = math.cos(TURN_RAD), math.sin(TURN_RAD)
    return points @ np.array([[cos, sin], [-sin, cos]])
