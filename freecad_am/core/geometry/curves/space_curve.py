# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves in space with corners: cubic arcs through points with exact tangents, nearest points."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array, Index
from ..columns import lengths
from ..step_count import step_counts
from ..walls.surface import dot

CORNER = 1e-5  # rad; smaller angles between adjacent arcs are smooth joints
CANDIDATES = 4  # nearest samples at which the search for the nearest point starts
ADJACENT = 2.5  # samples next to a nearest point, to either side, that lead to this point
STEPS = 30  # maximum Newton steps; only points near a centre of curvature need many


class SpaceCurve:
    """A chain of cubic arcs between nodes. Closed curves repeat the first node as the last.

    w: (m,) rising parameters. points: (m, 3) mm. into, out: (m, 3) derivatives dC/dw where the
    curve arrives at and leaves a node; they differ only at corners. Arcs over a few degrees with
    exact tangents are accurate to 1e-7 of their length.
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
        # coefficients of powers of t in [0, 1] on each arc, (m - 1, 4, 3)
        self.cubics: Array = np.stack(
            [points[:-1], start, 3.0 * chord - 2.0 * start - end, start + end - 2.0 * chord], axis=1
        )
        self.span: Array = span[:, 0]

    @property
    def period(self) -> float:
        """Length of the parameter range."""
        return float(self.w[-1] - self.w[0])

    @cached_property
    def corners(self) -> Index:
        """Nodes at which the tangent jumps, without the repeated last node of a closed curve."""
        nodes: Index = np.flatnonzero(self.turns > CORNER)
        return nodes

    @cached_property
    def turns(self) -> Array:
        """Return the angle between both tangents at each node.

        Returns
        -------
        (m,) array
            Angles, rad; 0 at ends and at the repeated last node.
        """
        cross = np.linalg.norm(np.cross(self.into, self.out), axis=1)
        angle: Array = np.arctan2(cross, dot(self.into, self.out))
        angle[-1] = 0.0
        if not self.closed:
            angle[0] = 0.0
        return angle

    def started_at(self, node: int) -> SpaceCurve:
        """Start a closed curve at another node; the parameter continues across the old start."""
        if not self.closed:
            raise ValueError("only a closed curve can be started elsewhere")
        order = np.r_[node : len(self.w) - 1, 0 : node + 1]
        w = self.w[order] + np.where(
            np.arange(len(order)) >= len(self.w) - 1 - node, self.period, 0.0
        )
        return SpaceCurve(w, self.points[order], self.into[order], self.out[order], True)

    def stretch(self, start: int, end: int) -> SpaceCurve:
        """Return the open curve from node `start` to node `end`."""
        nodes = slice(start, end + 1)
        return SpaceCurve(
            self.w[nodes], self.points[nodes], self.into[nodes], self.out[nodes], False
        )

    def reversed(self) -> SpaceCurve:
        """Return the reversed curve over the same parameter range."""
        w = self.w[0] + self.w[-1] - self.w[::-1]
        return SpaceCurve(w, self.points[::-1], -self.out[::-1], -self.into[::-1], self.closed)

    def arcs(self, w: Array) -> Index:
        """Return the arcs that contain parameters.

        Parameters
        ----------
        w : (...) array
            Parameters.

        Returns
        -------
        (...) array of int
            Arc indices; at a node, the arc that starts there.
        """
        return self._arcs(self.wrap(w))

    def _arcs(self, w: Array) -> Index:
        """Return the arcs that contain parameters within the range of the nodes."""
        index = self.w.searchsorted(w, side="right") - 1
        # np.clip is many times slower for few values
        arcs: Index = np.minimum(np.maximum(index, 0), len(self.span) - 1)
        return arcs

    def wrap(self, w: Array) -> Array:
        """Wrap parameters of a closed curve into the range of its nodes.

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
        # just below the first node the remainder rounds to a full period, which is the first node
        return np.asarray(self.w[0] + np.where(past < period, past, 0.0))

    def evaluate_arcs(self, arc: Index, t: Array) -> tuple[Array, Array, Array]:
        """Evaluate arcs of the curve.

        Parameters
        ----------
        arc : (...) int array
            Arc indices.
        t : (...) array
            Fractions of the arcs, from 0 to 1.

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
        """Estimate the deviation of each arc from the curve on which the nodes are.

        Returns
        -------
        (m - 1,) array
            mm.

        Notes
        -----
        The error of a cubic with exact ends is span^4 / 384 times the fourth derivative. The
        fourth derivative is estimated from the change of the third derivative between arcs, except
        across corners.
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
        """Return the distances of points from the bounding box of the curve.

        The values are slightly too small, so that no point of the curve is nearer.

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
        """Bounds (3,), mm, of the nodes and Bezier control points, which enclose the curve."""
        nodes, third = self.points, self.span[:, None] / 3.0
        control_points = np.vstack(
            [nodes, nodes[:-1] + third * self.out[:-1], nodes[1:] - third * self.into[1:]]
        )
        return control_points.min(axis=0), control_points.max(axis=0)

    @cached_property
    def _samples(self) -> tuple[cKDTree, Index, Array]:
        """Samples at midpoints of cells of similar length, with arc indices and fractions."""
        chord = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        cells = step_counts(chord, chord.sum() / len(chord))
        arc: Index = np.repeat(np.arange(len(cells)), cells)
        t = (np.arange(len(arc)) - np.repeat(np.cumsum(cells) - cells, cells) + 0.5) / cells[arc]
        return cKDTree(self.evaluate_arcs(arc, t)[0]), arc, t

    def nearest(self, points: Array) -> tuple[Array, Array, Array]:
        """Return the curve points nearest to given points.

        Newton's method starts at the nearest samples and stays on their smooth pieces, but not at
        samples next to a result. The nearest result counts.

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
            Parameters of the nearest points.
        """
        tree, arcs, sample_t = self._samples
        count = min(CANDIDATES, len(arcs))
        candidates = tree.query(points, k=count)[1].reshape(len(points), count)
        samples = self.w[arcs] + sample_t * self.span[arcs]
        w = self.wrap(self.descend(points, samples[candidates[:, 0]]))
        foot = self.at(w)[0]
        distance = lengths(points - foot)
        # samples next to the foot, on its smooth piece, lead to the same foot
        apart = np.abs(candidates - (samples.searchsorted(w) - 0.5)[:, None])
        if self.closed:
            apart = np.minimum(apart, len(samples) - apart)
        piece = self._pieces[0][arcs[candidates]]
        row, column = np.nonzero((apart > ADJACENT) | (piece != piece[:, :1]))
        if len(row):
            other_w = self.descend(points[row], samples[candidates[row, column]])
            other_w = self.wrap(other_w)
            other_foot = self.at(other_w)[0]
            other_distance = lengths(points[row] - other_foot)
            # the nearest one of a point comes last
            order = np.argsort(-other_distance, kind="stable")
            order = order[other_distance[order] < distance[row[order]]]
            nearer = row[order]
            distance[nearer], foot[nearer] = other_distance[order], other_foot[order]
            w[nearer] = other_w[order]
        return distance, foot, w

    def descend(self, points: Array, w: Array) -> Array:
        """Descend along the curve to the points nearest to given points.

        Parameters
        ----------
        points : (..., 3) array
            Points, mm.
        w : (...) array
            Start parameters; the search stays on their smooth pieces.

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
        """Bounds of w (m - 1,) of each arc's smooth piece; infinite for a closed smooth curve."""
        breaks = self.w[self.corners]
        if self.closed and len(breaks):
            breaks = np.r_[breaks[-1] - self.period, breaks, breaks[0] + self.period]
        elif self.closed:
            breaks = np.array([-np.inf, np.inf])
        else:
            breaks = np.r_[self.w[0], breaks, self.w[-1]]
        interval = np.searchsorted(breaks, self.w[:-1] + 0.5 * self.span, side="right") - 1
        # end just before the corner, or the end would count as the start of the next arc
        return breaks[interval], breaks[interval + 1] - 1e-12 * self.period
