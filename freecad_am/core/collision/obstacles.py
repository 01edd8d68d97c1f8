# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points, segments, triangles and pieces of beads in a tree of boxes: which solids they reach into, how far off they are."""

from __future__ import annotations

import copy
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..geometry.columns import columns, dots, lengths
from ..geometry.mesh.facets import doubled_areas
from ..types import Array, Index, Mask
from . import own_layer, separation, slabs, tree
from .frustum import Frustum
from .tolerances import CONVERGED

QUERIES = 16384  # worked on at once
SLABS = 40  # pieces for each of as many queries as make it worth to find boxes that lie as these do
ALWAYS, NEVER = -1, np.iinfo(np.intp).max
NONE = -1  # no obstacle


class _Level(NamedTuple):
    """Nodes (n,) of the tree: the rounding about their boxes, and the earliest moments."""

    rounding: Array
    since: Index
    lines: own_layer.Lines | None


class Obstacles:
    """Convex things (m, c, 3), the hulls of c points each, in an order of their own: points, segments, triangles, or pieces
    of beads, the hulls of four points with a rounding of `radius` (m,) mm about them.

    since: (m,) the moment from which each is there; none, then always. line: (m, 2, 3) the segments along which the pieces
    of beads are laid, which they count as where they are of the layer being laid, no farther from the tip than `foot`
    (m,) mm. chained: they are short, and those that follow each other mostly touch.
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
        self._levels = self._of_nodes()
        self._lay(corners)

    def moved(self, corners: Array) -> Obstacles:
        """The same with other corners (m, c, 3) that lie nearly where theirs do: to find an order of these takes most of the
        time."""
        other = copy.copy(self)
        for name in ("_rows", "_radii", "_slabs"):
            other.__dict__.pop(name, None)
        other._lay(corners)
        return other

    def _lay(self, corners: Array) -> None:
        """Have the corners in order, and the boxes about them: of each level centres and half sizes by columns (3, n)."""
        self.corners = corners[self.order]
        self._sample = np.ascontiguousarray(self.corners[:, 0])
        by_column = np.ascontiguousarray(self.corners.transpose(1, 2, 0))
        low, high = np.minimum.reduce(by_column), np.maximum.reduce(by_column)
        self._boxes = [(0.5 * (low + high), 0.5 * (high - low))]
        for level in self._levels[:-1]:
            starts = np.arange(0, len(level.since), tree.BRANCH)
            low, high = (
                np.minimum.reduceat(low, starts, axis=1),
                np.maximum.reduceat(high, starts, axis=1),
            )
            self._boxes.append((0.5 * (low + high), 0.5 * (high - low)))
        if corners.shape[1] == 3:
            normal = doubled_areas(self.corners)
            size = lengths(normal)
            self._normal = normal / np.where(size > 0.0, size, 1.0)[:, None]

    def _of_nodes(self) -> list[_Level]:
        """The levels of the tree, each from the one below it."""
        rounding, since = (
            np.zeros(len(self.since)) if self.radius is None else self.radius,
            self.since,
        )
        lines = (
            None
            if self.line is None or self.foot is None
            else own_layer.of_lines(self.line, self.foot)
        )
        found = [_Level(rounding, since, lines)]
        for _ in self._sizes[1:]:
            starts = np.arange(0, len(since), tree.BRANCH)
            lines = None if lines is None else lines.joined(starts)
            rounding, since = (
                np.maximum.reduceat(rounding, starts),
                np.minimum.reduceat(since, starts),
            )
            found.append(_Level(rounding, since, lines))
        return found

    @cached_property
    def _rows(self) -> list[tuple[Array, Array]]:
        """Centres and half sizes (n, 3) of the boxes of each level row by row, which distances are looked for by."""
        return [
            (np.ascontiguousarray(centre.T), np.ascontiguousarray(half.T))
            for centre, half in self._boxes
        ]

    @cached_property
    def _radii(self) -> list[Array]:
        """Of balls about the same centres as the boxes of each level, which distances alone are looked for by."""
        found = []
        for size, (centre, _) in zip(self._sizes, self._rows):
            apart = self.corners - centre[np.arange(len(self.corners)) // size][:, None]
            away = np.sqrt(separation.largest(np.einsum("ijk,ijk->ij", apart, apart)))
            if self.radius is not None:
                away += self.radius
            found.append(np.maximum.reduceat(away, np.arange(0, len(away), size)))
        return found

    @cached_property
    def _slabs(self) -> slabs.Slabs:
        """About the pieces of beads of the lowest nodes, as these lie."""
        assert self.radius is not None
        return slabs.of_pieces(self.corners, self.radius, tree.BRANCH)

    def touched(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        own: Index | None = None,
    ) -> Mask:
        """(k,) whether solids with the tip (k, 3) and the unit axis (k, 3) meet an obstacle there before the moment (k,).

        own: (k,) the moment at which the layer being laid began.
        """
        found = np.zeros(len(tip), dtype=bool)
        if not len(self.corners) or not np.any(solid.high > solid.low):
            return found
        for first in range(0, len(tip), QUERIES):
            rows = np.arange(first, min(first + QUERIES, len(tip)))
            when = np.zeros(len(rows), dtype=np.intp) if moment is None else moment[rows]
            layer = np.full(len(rows), NEVER) if own is None else own[rows]
            found[rows] = self._touched(solid.rows(rows), tip[rows], axis[rows], when, layer)
        return found

    def _touched(self, solid: Frustum, tip: Array, axis: Array, moment: Index, own: Index) -> Mask:
        found = np.zeros(len(tip), dtype=bool)
        waiting = [
            (len(self._levels) - 1, *tree.each_with_each(len(tip), len(self._levels[-1].since)))
        ]
        ready: list[tuple[Index, Index]] = []
        tips, axes = columns(tip), columns(axis)
        layered = bool((own < NEVER).any())
        lying = self.line is not None and len(tip) * SLABS > len(self.corners)
        while waiting:
            depth, query, node = waiting.pop()
            level = self._levels[depth]
            left = np.flatnonzero(
                (level.since.take(node) < moment.take(query)) & ~found.take(query)
            )
            query, node = query.take(left), node.take(left)
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
                left = own_layer.matter(
                    level.lines, level.since, solid, query, node, tips, axes, own
                )
                query, node = query.take(left), node.take(left)
            if depth == 1:
                # before all single ones are looked at: most that meet any hold the first corner of one
                found[
                    query[self._sampled(solid, query, node * tree.BRANCH, tip, axis, moment, own)]
                ] = True
                left = np.flatnonzero(~found.take(query))
                if lying:
                    q, n = query.take(left), node.take(left)
                    left = left[
                        slabs.near(
                            self._slabs, solid.rows(q), n, tip.take(q, axis=0), axis.take(q, axis=0)
                        )
                    ]
                query, node = query.take(left), node.take(left)
            if depth:
                query, node = tree.below(query, node, len(self._levels[depth - 1].since))
                waiting += [(depth - 1, *some) for some in tree.parts(query, node)]
                continue
            ready.append((query, node))
            if sum(len(query) for query, _ in ready) > tree.PAIRS:  # many: that costs less each
                self._look(solid, tip, axis, own, ready, found)
                ready = []
        self._look(solid, tip, axis, own, ready, found)
        return found

    def _sampled(
        self,
        solid: Frustum,
        query: Index,
        sample: Index,
        tip: Array,
        axis: Array,
        moment: Index,
        own: Index,
    ) -> Mask:
        """(k,) whether the first corner of an obstacle is inside, which settles the matter without all the rest."""
        offset = self._sample.take(sample, axis=0) - tip.take(query, axis=0)
        inside: Mask = solid.rows(query).holds(offset, axis.take(query, axis=0))
        since = self.since.take(sample)
        inside &= (since < moment.take(query)) & (since < own.take(query))
        return inside

    def _look(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        own: Index,
        ready: list[tuple[Index, Index]],
        found: Mask,
    ) -> None:
        """Mark the queries that meet one of their single obstacles."""
        if ready:
            for query, node in tree.parts(*(np.concatenate(column) for column in zip(*ready))):
                left = np.flatnonzero(~found.take(query))
                q, n = query.take(left), node.take(left)
                found[q[self._meets(q, solid.rows(q), tip[q], axis[q], n, own[q])]] = True

    def _meets(
        self, query: Index, solid: Frustum, tip: Array, axis: Array, node: Index, own: Index
    ) -> Mask:
        """Whether obstacles (k,) reach into solids, those of queries (k,); of pieces of beads, whether any of a query do."""
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
        # most are below the solid's lower end, and so are the lines that they are laid along: a box about a piece that lies
        # across the axes tells it less well
        high = separation.largest(np.einsum("kcj,kj->kc", offset, axis)) + self.radius.take(node)
        rows = np.flatnonzero(high > solid.low)
        node = node.take(rows)
        laying = np.flatnonzero(self.since.take(node) >= own.take(rows))
        line = self.line.take(node[laying], axis=0) - tip.take(rows[laying], axis=0)[:, None]
        near = separation.from_origin(line) < self.foot.take(node[laying])
        as_line, line = laying[near], line[near]
        lines = rows[as_line]
        meets[lines] = solid.rows(lines).meets_segments(line[:, 0], line[:, 1], axis[lines])
        rows, node = np.delete(rows, as_line), np.delete(node, as_line)
        meets[rows] = separation.any_within(
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
        """(k,) mm from solids to the nearest obstacle there before the moment (k,), 0 where they meet, at most `reach`; no
        more than the true distance, and less by no more than what tolerances.CONVERGED says."""
        return self.nearest(solid, tip, axis, moment, reach)[0]

    def nearest(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        reach: float = np.inf,
    ) -> tuple[Array, Index]:
        """(k,) the same, and (k,) which obstacle that is, of those in their own order; NONE where none is within reach."""
        found, which = np.full(len(tip), reach), np.full(len(tip), NONE, dtype=np.intp)
        for first in range(0, len(tip) if len(self.corners) else 0, QUERIES // 8):
            rows = np.arange(first, min(first + QUERIES // 8, len(tip)))
            when = np.zeros(len(rows), dtype=np.intp) if moment is None else moment[rows]
            found[rows], which[rows] = self._nearest(
                solid.rows(rows), tip[rows], axis[rows], when, reach
            )
        return found, which

    def _nearest(
        self, solid: Frustum, tip: Array, axis: Array, moment: Index, reach: float
    ) -> tuple[Array, Index]:
        low, best = np.full((2, len(tip)), reach)  # bounds of the least distance yet
        which = np.full(len(tip), NONE, dtype=np.intp)
        top = len(self._levels[-1].since)
        query, node = tree.each_with_each(len(tip), top)
        for depth in range(len(self._levels) - 1, -1, -1):
            level, (centre, half) = self._levels[depth], self._rows[depth]
            kept: list[tuple[Index, Index, Array]] = [(query[:0], node[:0], np.zeros(0))]
            for q, n in tree.parts(query, node):
                there = level.since[n] < moment[q]
                q, n = q[there], n[there]
                offset = centre[n] - tip[q]
                apart = offset - solid.rows(q).nearest(offset, axis[q])
                gap = np.sqrt(dots(apart, apart))
                wide = dots(np.abs(apart), half[n]) / np.where(gap > 0.0, gap, 1.0)
                least = gap - np.minimum(wide + level.rounding[n], self._radii[depth][n])
                near = least < best[q]
                q, n, least = q[near], n[near], least[near]
                sample = n * self._sizes[depth]
                known = self.since[sample] < moment[q]
                a, b = q[known], sample[known]
                most = solid.rows(a).gap(self.corners[b, 0] - tip[a], axis[a])
                _lower(
                    best,
                    which,
                    a,
                    b,
                    most if self.radius is None else np.maximum(most - self.radius[b], 0.0),
                )
                kept.append((q, n, least))
            query, node = (np.concatenate([some[i] for some in kept]) for i in range(2))
            away = np.concatenate([some[2] for some in kept])
            near = away < np.maximum(best[query], CONVERGED)
            query, node, away = query[near], node[near], away[near]
            if depth:
                query, node = tree.below(query, node, len(self._levels[depth - 1].since))
        # the nearest by their balls first: most of the others are then known to be farther
        order = np.lexsort((away, query))
        query, node, away = query[order], node[order], away[order]
        share = 1
        while len(query):
            now = np.arange(len(query)) - np.searchsorted(query, query) < share
            self._bring_nearer(solid, tip, axis, query[now], node[now], low, best, which)
            left = ~now & (away < best[query])
            query, node, away, share = query[left], node[left], away[left], 4 * share
        return np.where(best <= CONVERGED, 0.0, np.minimum(low, best)), which

    def _bring_nearer(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        query: Index,
        node: Index,
        low: Array,
        best: Array,
        which: Index,
    ) -> None:
        """Lower the bounds of queries (n,) by their obstacles."""
        for q, n in tree.parts(query, node):
            round_ = np.zeros(len(n)) if self.radius is None else self.radius[n]
            points = self.corners[n] - tip[q, None]
            bottom, top = separation.bounds(
                solid.rows(q), axis[q], points, round_, best[q] + round_
            )
            bottom, top = np.maximum(bottom - round_, 0.0), np.maximum(top - round_, 0.0)
            np.minimum.at(low, q, np.where(top > CONVERGED, bottom, 0.0))
            _lower(best, which, q, n, top)


def _lower(best: Array, which: Index, query: Index, node: Index, most: Array) -> None:
    """Lower what is best of queries (n,) to what nodes (n,) have at most, and note which has it."""
    np.minimum.at(best, query, most)
    has = most <= best[query]
    which[query[has]] = node[has]
