# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves in space with corners: cubic arcs through points with exact tangents, and the nearest point on them."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array, Index
from ..columns import lengths
from ..step_count import step_counts
from ..walls.surface import dot

CORNER = 1e-5  # rad; smaller turns between two arcs are a smooth join
CANDIDATES = 4  # nearest samples from which the nearest point is sought
STEPS = 30  # Newton steps; few are taken but near a centre of curvature


class SpaceCurve:
    """A chain of cubic arcs between nodes. Closed curves repeat the first node as the last.

    w: (m,) rising parameters. points: (m, 3) mm. into, out: (m, 3) derivatives dC/dw where
    the curve arrives at and leaves a node; they differ only at corners. Arcs with turns of a
    few degrees and exact tangents are accurate to 1e-7 of their length.
    """

    def __init__(self, w: Array, points: Array, into: Array, out: Array, closed: bool) -> None:
        m = len(w)
        if m < 2 or points.shape != (m, 3) or into.shape != (m, 3) or out.shape != (m, 3):
            raise ValueError(
                "a curve needs at least two nodes, each with a point and two derivatives"
            )
        if not (np.diff(w) > 0.0).all():
            raise ValueError("the parameter of a curve must rise")
        self.w, self.points, self.into, self.out, self.closed = (
            w,
            points,
            into.copy(),
            out.copy(),
            closed,
        )
        if closed:
            self.into[0], self.out[-1] = self.into[-1], self.out[0]
        span = np.diff(w)[:, None]
        chord = np.diff(points, axis=0)
        start, end = self.out[:-1] * span, self.into[1:] * span
        # powers of t in [0, 1] on each arc, (m - 1, 4, 3)
        self.cubics: Array = np.stack(
            [points[:-1], start, 3.0 * chord - 2.0 * start - end, start + end - 2.0 * chord], axis=1
        )
        self.span: Array = span[:, 0]

    @property
    def period(self) -> float:
        """Length of the parameter's range."""
        return float(self.w[-1] - self.w[0])

    @cached_property
    def corners(self) -> Index:
        """Nodes at which the tangent jumps; the last node of a closed curve, equal to the first, is
        not listed.
        """
        nodes: Index = np.flatnonzero(self.turns > CORNER)
        return nodes

    @cached_property
    def turns(self) -> Array:
        """Return the angle by which the tangent turns at each node.

        Returns
        -------
        (m,) array
            rad; 0 at ends and at the repeated last node.
        """
        cross = np.linalg.norm(np.cross(self.into, self.out), axis=1)
        angle: Array = np.arctan2(cross, dot(self.into, self.out))
        angle[-1] = 0.0
        if not self.closed:
            angle[0] = 0.0
        return angle

    def started_at(self, node: int) -> SpaceCurve:
        """Return the closed curve started at another node; the parameter continues across the old
        start.
        """
        if not self.closed:
            raise ValueError("only a closed curve can be started elsewhere")
        order = np.r_[node : len(self.w) - 1, 0 : node + 1]
        w = self.w[order] + np.where(
            np.arange(len(order)) >= len(self.w) - 1 - node, self.period, 0.0
        )
        return SpaceCurve(w, self.points[order], self.into[order], self.out[order], True)

    def stretch(self, start: int, end: int) -> SpaceCurve:
        """Return the open curve from one node to another."""
        nodes = slice(start, end + 1)
        return SpaceCurve(
            self.w[nodes], self.points[nodes], self.into[nodes], self.out[nodes], False
        )

    def reversed(self) -> SpaceCurve:
        """The same curve run the other way, over the same range of the parameter."""
        w = self.w[0] + self.w[-1] - self.w[::-1]
        return SpaceCurve(w, self.points[::-1], -self.out[::-1], -self.into[::-1], self.closed)

    def arcs(self, w: Array) -> Index:
        """Return the arcs that hold parameters.

        Parameters
        ----------
        w : (...) array
            Parameters.

        Returns
        -------
        (...) array of int
            Numbers of the arcs; at a node the arc that leaves it.
        """
        return self._arcs(self.wrap(w))

    def _arcs(self, w: Array) -> Index:
        """The arcs that hold parameters within the range of the nodes."""
        index = self.w.searchsorted(w, side="right") - 1
        # np.clip takes many times that for a few
        arcs: Index = np.minimum(np.maximum(index, 0), len(self.span) - 1)
        return arcs

    def wrap(self, w: Array) -> Array:
        """Bring parameters of a closed curve into the range of its nodes.

        Parameters
        ----------
        w : (n,) array
            Parameters.

        Returns
        -------
        (n,) array
            Parameters; unchanged for an open curve.
        """
        if not self.closed:
            return w
        period = self.period
        past = np.mod(w - self.w[0], period)
        # a hair below the first node the remainder rounds to the whole period, which is the first node again
        return np.asarray(self.w[0] + np.where(past < period, past, 0.0))

    def evaluate_arcs(self, arc: Index, t: Array) -> tuple[Array, Array, Array]:
        """Evaluate arcs of the curve.

        Parameters
        ----------
        arc : (...) int array
            Numbers of the arcs.
        t : (...) array
            Shares of the arcs, from 0 to 1.

        Returns
        -------
        point : (..., 3) array
            Points, mm.
        slope : (..., 3) array
            First derivatives along w.
        bend : (..., 3) array
            Second derivatives along w.
        """
        c, t = self.cubics[arc], t[..., None]
        span = self.span[arc][..., None]
        a, b, d = c[..., 1, :], c[..., 2, :], c[..., 3, :]
        point = c[..., 0, :] + t * (a + t * (b + t * d))
        return (
            point,
            (a + t * (2.0 * b + 3.0 * t * d)) / span,
            (2.0 * b + 6.0 * t * d) / (span * span),
        )

    def at(self, w: Array) -> tuple[Array, Array, Array]:
        """Evaluate the curve.

        Parameters
        ----------
        w : (n,) array
            Parameters.

        Returns
        -------
        point : (n, 3) array
            Points, mm.
        slope : (n, 3) array
            First derivatives along w.
        bend : (n, 3) array
            Second derivatives along w.
        """
        w = self.wrap(w)
        arc = self._arcs(w)
        return self.evaluate_arcs(arc, (w - self.w[arc]) / self.span[arc])

    def interpolation_error(self) -> Array:
        """Estimate the error of each arc against the curve from which the nodes were taken.

        Returns
        -------
        (m - 1,) array
            mm.

        Notes
        -----
        A cubic with exact ends has an error of span^4 / 384 times the fourth derivative,
        which is the change of the third derivative from arc to arc. Changes across corners
        do not count.
        """
        third = 6.0 * self.cubics[:, 3] / self.span[:, None] ** 3
        following = np.roll(third, -1, axis=0)
        between = 0.5 * (self.span + np.roll(self.span, -1))
        fourth = np.linalg.norm(following - third, axis=1) / between
        fourth[np.roll(self.turns[:-1] > CORNER, -1)] = 0.0
        if not self.closed:
            fourth[-1] = 0.0
        error: Array = np.maximum(fourth, np.roll(fourth, 1)) * self.span**4 / 384.0
        return error

    def refined(self, times: int) -> Array:
        """Return the parameters of the nodes and of equal subdivisions of each arc.

        Parameters
        ----------
        times : int
            Number of parts of each arc.

        Returns
        -------
        (n,) array
            Rising parameters.
        """
        t = np.arange(times) / times
        parameters: Array = np.r_[(self.w[:-1, None] + self.span[:, None] * t).ravel(), self.w[-1]]
        return parameters

    @cached_property
    def length(self) -> float:
        """Length, mm."""
        x, weight = np.polynomial.legendre.leggauss(4)
        arc = np.arange(len(self.span))[:, None]
        _, slope, _ = self.evaluate_arcs(arc, np.broadcast_to(0.5 * (x + 1.0), (len(self.span), 4)))
        return float((np.linalg.norm(slope, axis=-1) * 0.5 * weight * self.span[:, None]).sum())

    def beyond_box(self, points: Array) -> Array:
        """Return how far points are outside a box about the curve.

        The value is slightly less than the distance, so no point of the curve is nearer.

        Parameters
        ----------
        points : (n, 3) array
            Points, mm.

        Returns
        -------
        (n,) array
            mm.
        """
        low, high = self._box
        return (1.0 - 1e-9) * lengths(
            np.maximum(np.maximum(low - points, points - high), 0.0)
        ) - 1e-9

    @cached_property
    def _box(self) -> tuple[Array, Array]:
        """The lowest and highest coordinates (3,), mm, of the nodes and the handles of the arcs,
        which enclose the curve.
        """
        nodes, third = self.points, self.span[:, None] / 3.0
        control_points = np.vstack(
            [nodes, nodes[:-1] + third * self.out[:-1], nodes[1:] - third * self.into[1:]]
        )
        return control_points.min(axis=0), control_points.max(axis=0)

    @cached_property
    def _samples(self) -> tuple[cKDTree, Index, Array]:
        """Samples in the middle of about equally long cells, with their arcs and places on them."""
        chord = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        cells = step_counts(chord, chord.sum() / len(chord))
        arc: Index = np.repeat(np.arange(len(cells)), cells)
        t = (np.arange(len(arc)) - np.repeat(np.cumsum(cells) - cells, cells) + 0.5) / cells[arc]
        return cKDTree(self.evaluate_arcs(arc, t)[0]), arc, t

    def nearest(self, points: Array) -> tuple[Array, Array, Array]:
        """Return the points of the curve nearest to points.

        Newton's method starts at the nearest samples and stays on their smooth pieces; the
        nearest result is chosen.

        Parameters
        ----------
        points : (n, 3) array
            Points, mm.

        Returns
        -------
        distance : (n,) array
            Distances, mm.
        foot : (n, 3) array
            Nearest points, mm.
        w : (n,) array
            Their parameters.
        """
        tree, arcs, sample_t = self._samples
        count = min(CANDIDATES, len(arcs))
        candidates = tree.query(points, k=count)[1].reshape(len(points), count)
        start = self.w[arcs[candidates]] + sample_t[candidates] * self.span[arcs[candidates]]
        w = self.descend(np.broadcast_to(points[:, None], start.shape + (3,)), start)
        foot = self.at(w)[0]
        distance = lengths((points[:, None] - foot).reshape(-1, 3)).reshape(w.shape)
        best = np.argmin(distance, axis=1)
        row = np.arange(len(points))
        return distance[row, best], foot[row, best], self.wrap(w[row, best])

    def descend(self, points: Array, w: Array) -> Array:
        """Descend along the curve to the points nearest to others.

        Parameters
        ----------
        points : (..., 3) array
            Points, mm.
        w : (...) array
            Parameters to start from; the search stays on their smooth pieces.

        Returns
        -------
        (...) array
            Parameters.
        """
        shape = w.shape
        result, goal = self.wrap(w).ravel(), points.reshape(-1, 3)
        arc = self._arcs(result)
        low, high = (bound[arc] for bound in self._pieces)
        farthest, least = self.period / 50.0, 1e-13 * self.period
        w, on = result, np.arange(len(result))  # parameters that have not converged
        for _ in range(STEPS):
            foot, slope, bend = self.at(w)
            gap = goal - foot
            rate = dot(slope, slope)
            curvature = rate - dot(gap, bend)
            step = dot(gap, slope) / np.maximum(np.abs(curvature), 1e-4 * rate)  # always downhill
            step = np.minimum(np.maximum(step, -farthest), farthest)
            new = np.minimum(np.maximum(w + step, low), high)
            moving = np.abs(new - w) >= least
            result[on] = w = new
            if not moving.any():
                break
            if not moving.all():
                on = on[moving]
                w = w[moving]
                goal = goal[moving]
                low = low[moving]
                high = high[moving]
        return result.reshape(shape)

    @cached_property
    def _pieces(self) -> tuple[Array, Array]:
        """Bounds of w (m - 1,) of the smooth piece of each arc; infinite on a closed smooth curve."""
        breaks = self.w[self.corners]
        if self.closed and len(breaks):
            breaks = np.r_[breaks[-1] - self.period, breaks, breaks[0] + self.period]
        elif self.closed:
            breaks = np.array([-np.inf, np.inf])
        else:
            breaks = np.r_[self.w[0], breaks, self.w[-1]]
        interval = np.searchsorted(breaks, self.w[:-1] + 0.5 * self.span, side="right") - 1
        # an end is just short of the corner, or it would count as the start of the next arc
        return breaks[interval], breaks[interval + 1] - 1e-12 * self.period
