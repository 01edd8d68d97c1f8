# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contact and distance of solids with points, segments, triangles and bead pieces in a box tree."""

from __future__ import annotations

import copy
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..geometry.columns import columns, dots, lengths, unit_rows
from ..geometry.mesh.coarsen import doubled_areas
from ..types import Array, Index, Mask
from . import frustum, separation, tree
from .frustum import Frustum
from .tolerances import CONVERGED, ROUNDING


class Slabs(NamedTuple):
    """Oriented boxes with rounding, mm.

    centre: (n, 3). sides: (n, 3, 3) three orthogonal half-edge vectors. rounding: (n,) radii.
    """

    centre: Array
    sides: Array
    rounding: Array


def build_slabs(corners: Array, radius: Array, size: int) -> Slabs:
    """Build oriented boxes about groups of consecutive pieces.

    Parameters
    ----------
    corners : (m, 4, 3) array
        Corners of the pieces, start before end, mm.
    radius : (m,) array
        Rounding radii of the pieces, mm.
    size : int
        Number of pieces in a group.

    Returns
    -------
    Slabs
        One box per group.
    """
    starts = np.arange(0, len(corners), size)
    ends = np.minimum(starts + size, len(corners)) - 1
    along = _directions(
        corners[ends, 2:].sum(axis=1) - corners[starts, :2].sum(axis=1), np.array([1.0, 0.0, 0.0])
    )
    flat = corners[starts, 1] - corners[starts, 0]
    flat -= dots(flat, along)[:, None] * along
    spare = np.zeros_like(
        flat
    )  # normal to the direction; for pieces whose section has no straight part
    spare[np.arange(len(along)), np.abs(along).argmin(axis=1)] = 1.0
    spare -= dots(spare, along)[:, None] * along
    flat = _directions(flat, unit_rows(spare))
    frames = np.stack([along, flat, np.cross(along, flat)], axis=1)
    number = np.arange(len(corners)) // size
    values = np.einsum("mij,mcj->mci", frames[number], corners)
    corner_values = [values[:, k] for k in range(values.shape[1])]
    low = np.minimum.reduceat(np.minimum.reduce(corner_values), starts)
    high = np.maximum.reduceat(np.maximum.reduce(corner_values), starts)
    centre = np.einsum("nij,ni->nj", frames, 0.5 * (low + high))
    return Slabs(
        centre, (0.5 * (high - low))[:, :, None] * frames, np.maximum.reduceat(radius, starts)
    )


def select_close(slabs: Slabs, solid: Frustum, node: Index, tip: Array, axis: Array) -> Index:
    """Return which pairs of a solid and a box may meet.

    The plane through the solid's point nearest to the box centre supports the solid. A box
    entirely beyond this plane misses the solid.

    Parameters
    ----------
    slabs : Slabs
        The boxes.
    solid : Frustum
        The k solids.
    node : (k,) int array
        Box index of each pair.
    tip : (k, 3) array
        Tips, mm.
    axis : (k, 3) array
        Unit axes.

    Returns
    -------
    int array
        Indices of the remaining pairs.
    """
    centre = slabs.centre.take(node, axis=0) - tip
    direction = solid.nearest(centre, axis) - centre
    gap = lengths(direction)
    extent_a, extent_b, extent_c = np.abs(
        np.einsum("kij,kj->ik", slabs.sides.take(node, axis=0), direction)
    )
    return np.flatnonzero(
        gap * (gap - slabs.rounding.take(node) - ROUNDING) <= extent_a + extent_b + extent_c
    )


def _directions(vectors: Array, otherwise: Array) -> Array:
    """Return unit vectors (n, 3) of vectors; `otherwise` for zero vectors."""
    directions: Array = np.where((lengths(vectors) > 0.0)[:, None], unit_rows(vectors), otherwise)
    return directions


QUERIES = 16384  # queries per batch
SLABS = 40  # pieces per query below which oriented boxes save time
ALWAYS, NEVER = -1, np.iinfo(np.intp).max
NONE = -1  # no obstacle


class _Level(NamedTuple):
    """Nodes (n,) of one tree level: box rounding, earliest moments, bounds of path lines."""

    rounding: Array
    since: Index
    lines: frustum.Lines | None


class Obstacles:
    """Convex obstacles (m, c, 3), each the hull of c points, sorted into a box tree.

    Obstacles are points, segments, triangles or bead pieces. A bead piece is the hull of four
    points with the rounding `radius` (m,) mm. since: (m,) moment from which each obstacle exists;
    None: always. line: (m, 2, 3) path lines, which replace pieces of the current layer within
    `foot` (m,) mm of the tip. chained: pieces are short, and consecutive pieces mostly touch.
    """

    def __init__(
        self,
        corners: Array,
        since: Index | None = None,
        radius: Array | None = None,
        line: Array | None = None,
        foot: Array | None = None,
        chained: bool = False,
    ) -> None:
        middles = separation.middles(corners)
        self.order = order = tree.chained(middles) if chained else tree.packed(middles)
        self.since = np.full(len(corners), ALWAYS, dtype=np.intp) if since is None else since[order]
        self.radius = None if radius is None else radius[order]
        self.line = None if line is None else line[order]
        self.foot = None if foot is None else foot[order]
        self._sizes = tree.sizes(len(corners))
        self._levels = self._build_levels()
        self._lay(corners)

    def replace_corners(self, corners: Array) -> Obstacles:
        """Return a copy with other corners, close to the present corners.

        The copy keeps the order, because sorting takes most of the time.

        Parameters
        ----------
        corners : (m, c, 3) array
            Corners of the obstacles in the original order, mm.

        Returns
        -------
        Obstacles
            The copy.
        """
        copied = copy.copy(self)
        for name in ("_rows", "_radii", "_slabs"):
            copied.__dict__.pop(name, None)
        copied._lay(corners)
        return copied

    def _lay(self, corners: Array) -> None:
        """Store the corners, and the box centres and half sizes (3, n) of each level."""
        self.corners = corners[self.order]
        self._sample = np.ascontiguousarray(self.corners[:, 0])
        by_column = np.ascontiguousarray(self.corners.transpose(1, 2, 0))
        low, high = np.minimum.reduce(by_column), np.maximum.reduce(by_column)
        self._boxes = [(0.5 * (low + high), 0.5 * (high - low))]
        for level in self._levels[:-1]:
            starts = np.arange(0, len(level.since), tree.BRANCH)
            low = np.minimum.reduceat(low, starts, axis=1)
            high = np.maximum.reduceat(high, starts, axis=1)
            self._boxes.append((0.5 * (low + high), 0.5 * (high - low)))
        if corners.shape[1] == 3:
            normal = doubled_areas(self.corners)
            size = lengths(normal)
            self._normal = normal / np.where(size > 0.0, size, 1.0)[:, None]

    def _build_levels(self) -> list[_Level]:
        """Build the tree levels from the lowest up."""
        rounding = np.zeros(len(self.since)) if self.radius is None else self.radius
        since = self.since
        lines = (
            None
            if self.line is None or self.foot is None
            else frustum.build_lines(self.line, self.foot)
        )
        levels = [_Level(rounding, since, lines)]
        for _ in self._sizes[1:]:
            starts = np.arange(0, len(since), tree.BRANCH)
            lines = None if lines is None else lines.merge(starts)
            rounding = np.maximum.reduceat(rounding, starts)
            since = np.minimum.reduceat(since, starts)
            levels.append(_Level(rounding, since, lines))
        return levels

    @cached_property
    def _rows(self) -> list[tuple[Array, Array]]:
        """Box centres and half sizes of each level as rows (n, 3), for distance queries."""
        return [
            (np.ascontiguousarray(centre.T), np.ascontiguousarray(half.T))
            for centre, half in self._boxes
        ]

    @cached_property
    def _radii(self) -> list[Array]:
        """Bounding-ball radii about the box centres of each level, for distance queries."""
        level_radii = []
        for size, (centre, _) in zip(self._sizes, self._rows):
            offsets = self.corners - centre[np.arange(len(self.corners)) // size][:, None]
            radii = np.sqrt(separation.largest(np.einsum("ijk,ijk->ij", offsets, offsets)))
            if self.radius is not None:
                radii += self.radius
            level_radii.append(np.maximum.reduceat(radii, np.arange(0, len(radii), size)))
        return level_radii

    @cached_property
    def _slabs(self) -> Slabs:
        """Oriented boxes about the bead pieces of each lowest node."""
        assert self.radius is not None
        return build_slabs(self.corners, self.radius, tree.BRANCH)

    def find_touching(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        layer_start: Index | None = None,
    ) -> Mask:
        """Return whether solids meet an obstacle.

        Parameters
        ----------
        solid : Frustum
            The k solids.
        tip : (k, 3) array
            Tips, mm.
        axis : (k, 3) array
            Unit axes.
        moment : (k,) int array or None, optional
            Moment of each solid; only earlier obstacles count. None: permanent obstacles only.
        layer_start : (k,) int array or None, optional
            Moment at which the current layer of each solid began; None without layers.

        Returns
        -------
        (k,) bool array
            True on contact.
        """
        hits = np.zeros(len(tip), dtype=bool)
        if not len(self.corners) or not np.any(solid.high > solid.low):
            return hits
        for begin in range(0, len(tip), QUERIES):
            rows = np.arange(begin, min(begin + QUERIES, len(tip)))
            when = np.zeros(len(rows), dtype=np.intp) if moment is None else moment[rows]
            layer = np.full(len(rows), NEVER) if layer_start is None else layer_start[rows]
            hits[rows] = self._find_touching(solid.rows(rows), tip[rows], axis[rows], when, layer)
        return hits

    def _find_touching(
        self, solid: Frustum, tip: Array, axis: Array, moment: Index, layer_start: Index
    ) -> Mask:
        hits = np.zeros(len(tip), dtype=bool)
        waiting = [
            (len(self._levels) - 1, *tree.each_with_each(len(tip), len(self._levels[-1].since)))
        ]
        ready: list[tuple[Index, Index]] = []
        tips, axes = columns(tip), columns(axis)
        layered = bool((layer_start < NEVER).any())
        lying = self.line is not None and len(tip) * SLABS > len(self.corners)
        while waiting:
            depth, query, node = waiting.pop()
            level = self._levels[depth]
            remaining = np.flatnonzero(
                (level.since.take(node) < moment.take(query)) & ~hits.take(query)
            )
            query, node = query.take(remaining), node.take(remaining)
            centre, half = (column.take(node, axis=1) for column in self._boxes[depth])
            centre -= tips.take(query, axis=1)
            round_ = level.rounding.take(node)
            close = np.flatnonzero(
                solid.rows(query).near_box(centre, axes.take(query, axis=1), half, round_)
            )
            if not len(close):
                continue
            query, node = query.take(close), node.take(close)
            if level.lines is not None and layered:
                remaining = frustum.select_pairs(
                    level.lines, level.since, solid, query, node, tips, axes, layer_start
                )
                query, node = query.take(remaining), node.take(remaining)
            if depth:
                # cheap test first: most solids in contact contain the first corner of a node
                sample = node * self._sizes[depth]
                hits[query[self._sampled(solid, query, sample, tip, axis, moment, layer_start)]] = (
                    True
                )
                remaining = np.flatnonzero(~hits.take(query))
                if depth == 1 and lying:
                    q, n = query.take(remaining), node.take(remaining)
                    remaining = remaining[
                        select_close(
                            self._slabs, solid.rows(q), n, tip.take(q, axis=0), axis.take(q, axis=0)
                        )
                    ]
                query, node = query.take(remaining), node.take(remaining)
            if depth:
                query, node = tree.below(query, node, len(self._levels[depth - 1].since))
                waiting += [(depth - 1, *pairs) for pairs in tree.parts(query, node)]
                continue
            ready.append((query, node))
            if (
                sum(len(query) for query, _ in ready) > tree.PAIRS
            ):  # large batches cost less per pair
                self._look(solid, tip, axis, layer_start, ready, hits)
                ready = []
        self._look(solid, tip, axis, layer_start, ready, hits)
        return hits

    def _sampled(
        self,
        solid: Frustum,
        query: Index,
        sample: Index,
        tip: Array,
        axis: Array,
        moment: Index,
        layer_start: Index,
    ) -> Mask:
        """Return whether solids contain the first corner of an obstacle, (k,), and so touch it."""
        offset = self._sample.take(sample, axis=0) - tip.take(query, axis=0)
        inside: Mask = solid.rows(query).holds(offset, axis.take(query, axis=0))
        since = self.since.take(sample)
        inside &= since < moment.take(query)
        if self.line is not None and self.foot is not None:
            laying = np.flatnonzero(inside & (since >= layer_start.take(query)))
            inside[laying] = ~self._as_line(sample[laying], tip.take(query[laying], axis=0))
        return inside

    def _as_line(self, node: Index, tip: Array) -> Mask:
        """Return whether pieces (k,) of the current layer are so close to the tips (k, 3) that only their lines count."""
        assert self.line is not None and self.foot is not None
        line = self.line.take(node, axis=0) - tip[:, None]
        as_line: Mask = separation.from_origin(line) < self.foot.take(node)
        return as_line

    def _look(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        layer_start: Index,
        ready: list[tuple[Index, Index]],
        hits: Mask,
    ) -> None:
        """Mark the queries whose solid meets one of the paired obstacles."""
        if ready:
            for query, node in tree.parts(*(np.concatenate(column) for column in zip(*ready))):
                remaining = np.flatnonzero(~hits.take(query))
                q, n = query.take(remaining), node.take(remaining)
                hits[q[self._meets(q, solid.rows(q), tip[q], axis[q], n, layer_start[q])]] = True

    def _meets(
        self, query: Index, solid: Frustum, tip: Array, axis: Array, node: Index, layer_start: Index
    ) -> Mask:
        """Return whether obstacles (k,) reach into the solids of their queries (k,).

        For bead pieces, at least one contact of each query is found.
        """
        kind = self.corners.shape[1]
        offset = self.corners.take(node, axis=0) - tip[:, None]
        if kind == 1:
            return solid.holds(offset[:, 0], axis)
        if kind == 2:
            return solid.meets_segments(offset[:, 0], offset[:, 1], axis)
        meets = np.zeros(len(node), dtype=bool)
        if kind == 3:
            normal = self._normal[node]
            cut = np.flatnonzero(solid.crossed(normal, dots(normal, offset[:, 0]), axis))
            meets[cut] = solid.rows(cut).meets_triangles(offset[cut], axis[cut])
            return meets
        assert self.radius is not None and self.line is not None and self.foot is not None
        # most pieces and their path lines are below the solid's lower end; the axis-aligned boxes
        # of oblique pieces do not show it
        high = separation.largest(np.einsum("kcj,kj->kc", offset, axis)) + self.radius.take(node)
        rows = np.flatnonzero(high > solid.low)
        node = node.take(rows)
        laying = np.flatnonzero(self.since.take(node) >= layer_start.take(rows))
        as_line = laying[self._as_line(node[laying], tip.take(rows[laying], axis=0))]
        lines = rows[as_line]
        line = self.line.take(node[as_line], axis=0) - tip.take(lines, axis=0)[:, None]
        meets[lines] = solid.rows(lines).meets_segments(line[:, 0], line[:, 1], axis[lines])
        rows, node = np.delete(rows, as_line), np.delete(node, as_line)
        meets[rows] = separation.find_any_overlap(
            query[rows], solid.rows(rows), axis[rows], offset[rows], self.radius[node]
        )
        return meets

    def distance(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        reach: float = np.inf,
    ) -> Array:
        """Return the distances from solids to the nearest obstacle.

        Parameters
        ----------
        solid : Frustum
            The k solids.
        tip : (k, 3) array
            Tips, mm.
        axis : (k, 3) array
            Unit axes.
        moment : (k,) int array or None, optional
            Moment of each solid; only earlier obstacles count. None: permanent obstacles only.
        reach : float, optional
            Maximum distance of interest, mm.

        Returns
        -------
        (k,) array
            Distances, mm; 0 on contact, at most `reach`. Never above the true distance,
            and below by at most tolerances.CONVERGED.
        """
        return self.nearest(solid, tip, axis, moment, reach)[0]

    def nearest(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        reach: float = np.inf,
    ) -> tuple[Array, Index]:
        """Return the distances from solids to the nearest obstacle, and its index.

        Parameters
        ----------
        solid : Frustum
            The k solids.
        tip : (k, 3) array
            Tips, mm.
        axis : (k, 3) array
            Unit axes.
        moment : (k,) int array or None, optional
            Moment of each solid; only earlier obstacles count. None: permanent obstacles only.
        reach : float, optional
            Maximum distance of interest, mm.

        Returns
        -------
        distance : (k,) array
            Distances, mm, as `distance` returns.
        obstacle : (k,) int array
            Indices in the sorted order; NONE without an obstacle in reach.
        """
        gaps, nearest_ids = np.full(len(tip), reach), np.full(len(tip), NONE, dtype=np.intp)
        for begin in range(0, len(tip) if len(self.corners) else 0, QUERIES // 8):
            rows = np.arange(begin, min(begin + QUERIES // 8, len(tip)))
            when = np.zeros(len(rows), dtype=np.intp) if moment is None else moment[rows]
            gaps[rows], nearest_ids[rows] = self._nearest(
                solid.rows(rows), tip[rows], axis[rows], when, reach
            )
        return gaps, nearest_ids

    def _nearest(
        self, solid: Frustum, tip: Array, axis: Array, moment: Index, reach: float
    ) -> tuple[Array, Index]:
        low, best = np.full((2, len(tip)), reach)  # bounds of the minimum distance so far
        nearest_ids = np.full(len(tip), NONE, dtype=np.intp)
        top = len(self._levels[-1].since)
        query, node = tree.each_with_each(len(tip), top)
        for depth in range(len(self._levels) - 1, -1, -1):
            level, (centre, half) = self._levels[depth], self._rows[depth]
            candidates: list[tuple[Index, Index, Array]] = [(query[:0], node[:0], np.zeros(0))]
            for q, n in tree.parts(query, node):
                present = level.since[n] < moment[q]
                q, n = q[present], n[present]
                offset = centre[n] - tip[q]
                separations = offset - solid.rows(q).nearest(offset, axis[q])
                gap = np.sqrt(dots(separations, separations))
                wide = dots(np.abs(separations), half[n]) / np.where(gap > 0.0, gap, 1.0)
                lower_bound = gap - np.minimum(wide + level.rounding[n], self._radii[depth][n])
                close = lower_bound < best[q]
                q, n, lower_bound = q[close], n[close], lower_bound[close]
                sample = n * self._sizes[depth]
                is_present = self.since[sample] < moment[q]
                a, b = q[is_present], sample[is_present]
                upper_bound = solid.rows(a).gap(self.corners[b, 0] - tip[a], axis[a])
                _lower_bounds(
                    best,
                    nearest_ids,
                    a,
                    b,
                    upper_bound
                    if self.radius is None
                    else np.maximum(upper_bound - self.radius[b], 0.0),
                )
                candidates.append((q, n, lower_bound))
            query, node = (np.concatenate([block[i] for block in candidates]) for i in range(2))
            bounds_below = np.concatenate([block[2] for block in candidates])
            close = bounds_below < np.maximum(best[query], CONVERGED)
            query, node, bounds_below = query[close], node[close], bounds_below[close]
            if depth:
                query, node = tree.below(query, node, len(self._levels[depth - 1].since))
        # obstacles with the lowest bounds first: their distances exclude most other obstacles
        order = np.lexsort((bounds_below, query))
        query, node, bounds_below = query[order], node[order], bounds_below[order]
        share = 1
        while len(query):
            now = np.arange(len(query)) - np.searchsorted(query, query) < share
            self._bring_nearer(solid, tip, axis, query[now], node[now], low, best, nearest_ids)
            remaining = ~now & (bounds_below < best[query])
            query = query[remaining]
            node = node[remaining]
            bounds_below = bounds_below[remaining]
            share = 4 * share
        return np.where(best <= CONVERGED, 0.0, np.minimum(low, best)), nearest_ids

    def _bring_nearer(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        query: Index,
        node: Index,
        low: Array,
        best: Array,
        nearest_ids: Index,
    ) -> None:
        """Lower the distance bounds of queries (n,) to the distances of paired obstacles."""
        for q, n in tree.parts(query, node):
            round_ = np.zeros(len(n)) if self.radius is None else self.radius[n]
            points = self.corners[n] - tip[q, None]
            bottom, top = separation.bounds(
                solid.rows(q), axis[q], points, round_, best[q] + round_
            )
            bottom, top = np.maximum(bottom - round_, 0.0), np.maximum(top - round_, 0.0)
            np.minimum.at(low, q, np.where(top > CONVERGED, bottom, 0.0))
            _lower_bounds(best, nearest_ids, q, n, top)


def _lower_bounds(
    best: Array, nearest_ids: Index, query: Index, node: Index, upper_bound: Array
) -> None:
    """Lower `best` of queries (n,) to upper bounds of nodes (n,), and store node indices."""
    np.minimum.at(best, query, upper_bound)
    has = upper_bound <= best[query]
    nearest_ids[query[has]] = node[has]
