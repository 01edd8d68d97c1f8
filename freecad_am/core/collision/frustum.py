# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nozzles and links as solids of revolution, with exact tests of points, segments and triangles.

A frustum about the tool axis t has the radius a + k x at height x above the tip plane, from x = low
to x = high. The function |y| - k x - a is convex, where y is the component of a point's offset
normal to the axis. Its minimum along a segment has a closed form. If all edges of a triangle miss a
convex solid, the triangle meets the solid only where it contains the whole section of the solid by
its plane. One point of the section therefore decides.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..geometry.columns import columns, dots, lengths
from ..types import Array, Index, Mask
from .tolerances import ALONG, ROUNDING


def side_height(radius: float, slope: float) -> float:
    """Return the height, mm, at which a nozzle's side is one tip diameter from the deposit point.

    The height is above the tip plane. Below it, the nozzle touches its support and the bead that
    it prints.
    """
    return float(
        radius
        * (np.sqrt(slope * slope + 3.0 * (1.0 + slope * slope)) - slope)
        / (1.0 + slope * slope)
    )


@dataclass(frozen=True, eq=False)
class Frustum:
    """A frustum about the tool axis.

    radius: a, mm, at the tip plane. slope: k. low, high: mm above the tip plane; low is a scalar
    or has one value per row. Methods take offsets from the tip and unit tool axes, row by row.
    """

    radius: float
    slope: float
    low: float | Array
    high: float

    @property
    def reach(self) -> float:
        """Maximum distance between the tip and a point of the solid, mm."""
        return float(np.hypot(self.high, self.radius + self.slope * self.high))

    def rows(self, index: Index) -> Frustum:
        """Return the solids of selected rows.

        Parameters
        ----------
        index : (r,) array of int
            Rows.

        Returns
        -------
        Frustum
            This solid itself if `low` is a scalar.
        """
        if not isinstance(self.low, np.ndarray):
            return self
        return Frustum(self.radius, self.slope, self.low[index], self.high)

    def near_box(self, offset: Array, axis: Array, half: Array, rounding: Array) -> Mask:
        """Return whether boxes may meet the solid.

        A box misses the solid if it is past one end of the solid, or beyond the tangent plane of
        the side nearest to the box centre. Columns take half the time of rows.

        Parameters
        ----------
        offset : (3, k) array
            Centres of the boxes from the tips, mm.
        axis : (3, k) array
            Tool axes, unit vectors.
        half : (3, k) array
            Half sizes of the boxes, mm.
        rounding : (k,) array
            Rounding radii of the boxes, mm.

        Returns
        -------
        (k,) bool array
            False for boxes that certainly miss the solid.
        """
        x = _column_sums(offset * axis)
        across: Array = offset - x * axis
        side = np.sqrt(_column_sums(across * across))
        size = _column_sums(np.abs(axis) * half) + rounding
        may_meet: Mask = (x > self.low - size) & (x < self.high + size)
        lean = np.hypot(1.0, self.slope)
        across -= (self.slope * side) * axis
        reach = _column_sums(np.abs(across, out=across) * half)
        # the tangent plane with the normal across / (side lean) bounds the frustum; the normal is
        # undefined on the axis
        may_meet &= side * (side - self.radius - self.slope * x) <= reach + lean * side * (
            rounding + ROUNDING
        )
        return may_meet

    def nearest(self, offset: Array, axis: Array) -> Array:
        """Return the points of the solid nearest to given points.

        Parameters
        ----------
        offset : (k, 3) array
            Points from the tips, mm.
        axis : (k, 3) array
            Tool axes, unit vectors.

        Returns
        -------
        (k, 3) array
            Nearest points from the tips, mm; the given points themselves if inside.
        """
        x = dots(offset, axis)
        across = offset - x[:, None] * axis
        side = np.sqrt(dots(across, across))
        low: float | Array = self.low
        low_radius = self.radius + self.slope * low
        high_radius = self.radius + self.slope * self.high
        inside = (x >= low) & (x <= self.high) & (side <= self.radius + self.slope * x)
        # in the meridian half-plane: candidates on the side, on the lower and on the upper disc
        tall, wide = self.high - low, high_radius - low_radius
        along = ((x - low) * tall + (side - low_radius) * wide) / (tall * tall + wide * wide)
        along = np.minimum(
            np.maximum(along, 0.0), 1.0
        )  # np.clip is many times slower for few values
        height, out = low + along * tall, low_radius + along * wide
        squared_distance = np.square(x - height) + np.square(side - out)
        for disc, size in ((low, low_radius), (self.high, high_radius)):
            on_disc = np.minimum(side, size)
            to_disc = np.square(x - disc) + np.square(side - on_disc)
            nearer = to_disc < squared_distance
            height = np.where(nearer, disc, height)
            out = np.where(nearer, on_disc, out)
            squared_distance = np.minimum(to_disc, squared_distance)
        height, out = np.where(inside, x, height), np.where(inside, side, out)
        points: Array = (
            height[:, None] * axis + (out / np.where(side > 0.0, side, 1.0))[:, None] * across
        )
        return points

    def gap(self, offset: Array, axis: Array) -> Array:
        """Return the distances between points and the solid.

        Parameters
        ----------
        offset : (k, 3) array
            Points from the tips, mm.
        axis : (k, 3) array
            Tool axes, unit vectors.

        Returns
        -------
        (k,) array
            Distances, mm; 0 inside.
        """
        gap: Array = lengths(self.nearest(offset, axis) - offset)
        return gap

    def farthest(self, direction: Array, axis: Array) -> Array:
        """Return the points of the solid farthest along directions.

        Parameters
        ----------
        direction : (k, 3) array
            Direction vectors of any length.
        axis : (k, 3) array
            Tool axes, unit vectors.

        Returns
        -------
        (k, 3) array
            Points from the tips, mm.
        """
        rise = dots(direction, axis)
        across = direction - rise[:, None] * axis
        size = np.sqrt(dots(across, across))
        low = np.asarray(self.low, dtype=float)
        up = rise * self.high + size * (
            self.radius + self.slope * self.high
        ) > rise * low + size * (self.radius + self.slope * low)
        height = np.where(up, self.high, low)
        # along the axis all points of a disc are equally far: a lateral component is rounding error
        leaning = size > ALONG * np.abs(rise)
        out = np.where(leaning, self.radius + self.slope * height, 0.0) / np.where(
            leaning, size, 1.0
        )
        points: Array = height[:, None] * axis + out[:, None] * across
        return points

    def crossed(self, normal: Array, level: Array, axis: Array) -> Mask:
        """Return whether planes cut the solid.

        Parameters
        ----------
        normal : (k, 3) array
            Unit normals of the planes.
        level : (k,) array
            Distances of the planes from the tips along the normals, mm.
        axis : (k, 3) array
            Tool axes, unit vectors.

        Returns
        -------
        (k,) bool array
            True where a plane cuts the solid.
        """
        rise = dots(normal, axis)
        lean = np.sqrt(np.maximum(1.0 - rise * rise, 0.0))
        low, high = self.low * rise, self.high * rise
        small = (self.radius + self.slope * self.low) * lean
        large = (self.radius + self.slope * self.high) * lean
        above = np.maximum(low + small, high + large)
        below = np.minimum(low - small, high - large)
        cut: Mask = (level < above) & (level > below)
        return cut

    def holds(self, offset: Array, axis: Array) -> Mask:
        """Return whether points are inside the solid.

        Parameters
        ----------
        offset : (k, 3) array
            Points from the tip, mm.
        axis : (k, 3) array
            Unit tool axes, in the frame of the offsets.

        Returns
        -------
        (k,) array of bool
            False within ROUNDING of the surface.
        """
        x = dots(offset, axis)
        margin = self.radius + self.slope * x - ROUNDING
        square = dots(offset, offset) - x * x
        inside: Mask = (
            (x > self.low + ROUNDING)
            & (x < self.high - ROUNDING)
            & (margin > 0.0)
            & (square < margin * margin)
        )
        return inside

    def meets_segments(self, start: Array, end: Array, axis: Array) -> Mask:
        """Return whether segments reach into the solid.

        Parameters
        ----------
        start, end : (k, 3) array
            Ends of the segments from the tips, mm.
        axis : (k, 3) array
            Tool axes, unit vectors.

        Returns
        -------
        (k,) bool array
            True where a segment reaches in by more than ROUNDING.
        """
        x, rise = dots(start, axis), dots(end - start, axis)
        across = start - x[:, None] * axis
        along = end - start - rise[:, None] * axis
        steep = np.abs(rise) > 1e-12
        safe = np.where(steep, rise, 1.0)
        at_low, at_high = (self.low + ROUNDING - x) / safe, (self.high - ROUNDING - x) / safe
        within = (x > self.low + ROUNDING) & (x < self.high - ROUNDING)
        begin = np.where(
            steep, np.maximum(np.minimum(at_low, at_high), 0.0), np.where(within, 0.0, 2.0)
        )
        stop = np.where(steep, np.minimum(np.maximum(at_low, at_high), 1.0), 1.0)
        square, mixed = dots(along, along), dots(across, along)
        squared = dots(across, across)
        pull = self.slope * rise
        bent = square - pull * pull > 1e-24
        with np.errstate(divide="ignore", invalid="ignore"):
            nearest = -mixed / square
            off = np.maximum(squared - mixed * mixed / square, 0.0)
            vertex = nearest + pull * np.sqrt(off / (square * (square - pull * pull)))
        # where the cone opens faster than the segment leaves the axis, the upper end is deepest
        deepest = np.where(
            bent,
            np.clip(np.where(bent, vertex, 0.0), begin, stop),
            np.where(rise > 0.0, stop, begin),
        )
        side = np.linalg.norm(across + deepest[:, None] * along, axis=1)
        meets: Mask = (begin <= stop) & (
            side - self.radius - self.slope * (x + deepest * rise) < -ROUNDING
        )
        return meets

    def meets_triangles(self, corners: Array, axis: Array) -> Mask:
        """Return whether triangles reach into the solid.

        Parameters
        ----------
        corners : (k, 3, 3) array
            Corners of the triangles from the tip, mm.
        axis : (k, 3) array
            Unit tool axes, in the frame of the corners.

        Returns
        -------
        (k,) array of bool
            True where a triangle reaches in.
        """
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        meets = self.meets_segments(a, b, axis)
        for start, end in ((b, c), (c, a)):
            remaining = np.flatnonzero(~meets)
            meets[remaining] = self.rows(remaining).meets_segments(
                start[remaining], end[remaining], axis[remaining]
            )
        remaining = np.flatnonzero(~meets)
        meets[remaining] = self.rows(remaining)._section_inside(corners[remaining], axis[remaining])
        return meets

    def _section_inside(self, corners: Array, axis: Array) -> Mask:
        """Return whether each triangle contains a point of its plane's section of the solid.

        The plane cuts the axis between the end discs, or else one of the disc diameters that reach
        farthest towards the plane.
        """
        base = corners[:, 0]
        side_a = corners[:, 1] - corners[:, 0]
        side_b = corners[:, 2] - corners[:, 0]
        normal = np.cross(side_a, side_b)
        square = dots(normal, normal)
        level = dots(normal, base)
        lean = normal - dots(normal, axis)[:, None] * axis
        size = lengths(lean)
        lean = lean / np.where(size > 0.0, size, 1.0)[:, None]
        inside: Mask = np.zeros(len(corners), dtype=bool)
        base_height = np.broadcast_to(np.asarray(self.low, dtype=float), size.shape)[:, None]
        lines = [(base_height * axis, (self.high - base_height) * axis)]
        for height in (base_height, self.high):
            margin = self.radius + self.slope * height
            lines.append((height * axis - margin * lean, 2.0 * margin * lean))
        for start, step in lines:
            climb = dots(normal, step)
            crossing = climb != 0.0
            share = (level - dots(normal, start)) / np.where(crossing, climb, 1.0)
            point = start + share[:, None] * step - base
            u = dots(np.cross(point, side_b), normal)
            v = dots(np.cross(side_a, point), normal)
            inside |= (
                crossing
                & (share > 1e-12)
                & (share < 1.0 - 1e-12)
                & (u >= 0.0)
                & (v >= 0.0)
                & (u + v <= square)
            )
        inside &= square > 0.0
        return inside


def _column_sums(values: Array) -> Array:
    """Return the column sums (k,) of values (3, k)."""
    total: Array = values[0] + values[1]
    total += values[2]
    return total


class Lines(NamedTuple):
    """Bounds of the bead path lines in n tree nodes, mm.

    low, high: (3, n) box corners. foot: (n,) smallest distance from the tip within which a piece
    of the node counts as a line.
    """

    low: Array
    high: Array
    foot: Array

    def merge(self, starts: Index) -> Lines:
        """Merge consecutive nodes.

        Parameters
        ----------
        starts : (r,) array of int
            First node of each group, rising; a group ends before the next group.

        Returns
        -------
        Lines
            Bounds of the groups.
        """
        low = np.minimum.reduceat(self.low, starts, axis=1)
        high = np.maximum.reduceat(self.high, starts, axis=1)
        return Lines(low, high, np.minimum.reduceat(self.foot, starts))


def build_lines(line: Array, foot: Array) -> Lines:
    """Return the bounds of lines, one node per line.

    Parameters
    ----------
    line : (m, 2, 3) array
        Ends of the lines, mm.
    foot : (m,) array
        Distance from the tip within which each bead piece counts as a line, mm.

    Returns
    -------
    Lines
        Bounds of m nodes.
    """
    begin, end = columns(line[:, 0]), columns(line[:, 1])
    return Lines(np.minimum(begin, end), np.maximum(begin, end), foot)


def select_pairs(
    lines: Lines,
    since: Index,
    solid: Frustum,
    query: Index,
    node: Index,
    tips: Array,
    axes: Array,
    layer_start: Index,
) -> Index:
    """Select the pairs of queries and nodes that need a test.

    Drop nodes whose pieces all count as lines and are below the solid's lower end.

    Parameters
    ----------
    lines : Lines
        Bounds of the lines of each node.
    since : int array
        Earliest moment of each node.
    solid : Frustum
        The solids of the queries.
    query, node : (k,) int array
        The pairs.
    tips, axes : (3, queries) array
        Tips (mm) and unit axes of the queries.
    layer_start : (queries,) int array
        Moment at which the layer of each query began.

    Returns
    -------
    int array
        Rows of the remaining pairs.
    """
    in_layer = np.flatnonzero(since.take(node) >= layer_start.take(query))
    if not len(in_layer):
        return np.arange(len(node))
    q, n = query.take(in_layer), node.take(in_layer)
    tip, axis = tips.take(q, axis=1), axes.take(q, axis=1)
    low, high = lines.low.take(n, axis=1) - tip, lines.high.take(n, axis=1) - tip
    top = np.maximum(low * axis, high * axis).sum(axis=0)
    square_distance = np.maximum(np.square(low), np.square(high)).sum(
        axis=0
    )  # to the box corner farthest from the tip
    keep = np.ones(len(node), dtype=bool)
    keep[in_layer] = (top > solid.rows(q).low) | (square_distance >= np.square(lines.foot.take(n)))
    return np.flatnonzero(keep)
