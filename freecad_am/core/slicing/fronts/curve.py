# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves made exact: fronts brought onto the wall and to their distance, corners found, arcs refined; other curves brought
onto the wall."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.frames import unit
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from ...types import Array, Index, Mask
from .feet import Feet, feet
from .rims import Line
from .slicing import Slicing

STEPS = 12
ROUNDS = 12
CONVERGED = 1e-6  # of the height; points off by more have not found their place
SAME_PLACE = 1e-5  # mm; of two nodes nearer than this one goes, and it is not the corner
SMOOTH = 1.0 - 1e-9  # cosine of the turn at a node that is not a corner
WITHIN = 5e-5  # mm; at INSIDE, where arcs are off by more than half of what they are anywhere between the nodes
# of each arc; where the wall's curvature jumps within it, its middle may be right by chance
INSIDE = np.array([1.0 / 3.0, 2.0 / 3.0])
SAME_FOOT = 1e-3  # of the height; branches whose nearest points lie closer than this are one


def exact(slicing: Slicing, below: list[SpaceCurve], line: Line) -> list[SpaceCurve]:
    """The front at the layer height from those below that runs near a line.

    Nodes lie on the wall and at the height to rounding, arcs to WITHIN; corners are nodes. The deposit below lies on the
    curve's right as seen from where the wall's normals point to. Where the end of an open line is not known, that of the
    front moves along the wall's edge. None or several pieces where points of the line do not find their distance: between
    fronts that meet.
    """
    offset = _Offset(slicing.wall, below, slicing.height)
    nodes = offset.nodes_near(line)
    if nodes is None:
        return []
    for _ in range(ROUNDS):
        nodes = nodes.forward()
        curve = nodes.curve()
        bad = _bad_arcs(curve, offset.off)
        if not len(bad):
            return [curve]
        corners = offset.corners(nodes, bad)
        nodes = nodes.inserted([corners, offset.middles(curve, bad[~np.isin(bad, corners[0])])])
    return _without(curve, bad)


def on_wall(wall: PatchWall, curve: SpaceCurve) -> SpaceCurve:
    """The curve with further nodes where its arcs are off the wall between the nodes."""
    for _ in range(ROUNDS):
        bad = _bad_arcs(
            curve, lambda points: np.linalg.norm(wall.project(points)[0] - points, axis=1)
        )
        if not len(bad):
            break
        w = curve.w[bad] + 0.5 * curve.span[bad]
        points, slope, _ = curve.at(w)
        points, normal = wall.project(points)
        slope = slope - dot(slope, normal)[:, None] * normal
        curve = SpaceCurve(
            np.insert(curve.w, bad + 1, w),
            np.insert(curve.points, bad + 1, points, axis=0),
            np.insert(curve.into, bad + 1, slope, axis=0),
            np.insert(curve.out, bad + 1, slope, axis=0),
            curve.closed,
        )
    return curve


def _bad_arcs(curve: SpaceCurve, off: Callable[[Array], Array]) -> Index:
    """The arcs of which points (n, 3) at INSIDE are off (n,) by more than WITHIN, and that are not too short to be cut."""
    w = (curve.w[:-1, None] + curve.span[:, None] * INSIDE).ravel()
    most = off(curve.at(w)[0]).reshape(-1, len(INSIDE)).max(axis=1)
    return np.flatnonzero((most > WITHIN) & (curve.span > 1e-6 * curve.period))


def _without(curve: SpaceCurve, bad: Index) -> list[SpaceCurve]:
    """What is left of a curve without some of its arcs: where fronts meet in a gap too narrow to be followed."""
    if curve.closed:
        curve = curve.started_at(int(bad[0]) + 1 if bad[0] + 1 < len(curve.span) else 0)
        bad = (bad - bad[0] - 1) % len(curve.span)
    ends = np.r_[-1, np.sort(bad), len(curve.span)]
    return [
        curve.stretch(int(one) + 1, int(other))
        for one, other in zip(ends[:-1], ends[1:])
        if other - one > 2
    ]


class _Nodes(NamedTuple):
    """Nodes of a front: points (n, 3), unit tangents (n, 3) that arrive and leave, the nearest places below. Those of a
    closed one do not repeat the first."""

    points: Array
    into: Array
    out: Array
    foot: Feet
    closed: bool

    def of(self, which: Mask | Index | slice) -> _Nodes:
        """Some of them."""
        return _Nodes(
            self.points[which], self.into[which], self.out[which], self.foot.of(which), self.closed
        )

    def inserted(self, more: list[tuple[Index, _Nodes]]) -> _Nodes:
        """The nodes with others behind those that begin the arcs named."""
        order = np.argsort(
            np.concatenate([np.arange(len(self.points))] + [arcs + 0.5 for arcs, _ in more]),
            kind="stable",
        )
        every = [self, *(nodes for _, nodes in more)]
        points, into, out = (np.concatenate([nodes[k] for nodes in every]) for k in range(3))
        foot = Feet(*(np.concatenate(columns) for columns in zip(*(nodes.foot for nodes in every))))
        return _Nodes(points, into, out, foot, self.closed).of(order)

    def forward(self) -> _Nodes:
        """Without the nodes that lie behind their predecessor or on it: next to corners points may settle in a tangle."""
        nodes, closed = self, self.closed
        while True:
            n = len(nodes.points)
            chord = np.roll(nodes.points, -1, axis=0) - nodes.points
            length = np.linalg.norm(chord, axis=1)
            turned = (dot(chord, nodes.out) <= 0.0) | (
                dot(chord, np.roll(nodes.into, -1, axis=0)) <= 0.0
            )
            alike = (
                dot(nodes.out, np.roll(nodes.into, -1, axis=0)) > 0.5
            )  # else a corner is still to be found between them
            bad = (turned & alike) | (length < SAME_PLACE)
            if not closed:
                bad[-1] = False
            corner = dot(nodes.into, nodes.out) < SMOOTH
            drop = np.zeros(n, dtype=bool)
            at = np.flatnonzero(bad)
            after = (at + 1) % n
            # of the two ends of an arc that runs backwards a corner stays, and the ends of an open front stay
            kept = corner[after] | ((after == n - 1) & (not closed))
            loser = np.where(kept, at, after)
            drop[loser[~(corner[loser])]] = True
            if not closed:
                drop[[0, -1]] = False
            if not drop.any() or n - drop.sum() < 4:
                return nodes
            nodes = nodes.of(~drop)

    def curve(self) -> SpaceCurve:
        """The curve through them."""
        points, into, out = self[:3]
        if self.closed:
            points, into, out = (np.vstack([column, column[:1]]) for column in (points, into, out))
        w = np.r_[
            0.0, np.cumsum(np.maximum(np.linalg.norm(np.diff(points, axis=0), axis=1), 1e-12))
        ]
        return SpaceCurve(w, points, into, out, self.closed)


class _Offset(NamedTuple):
    """What an offset front is: all that lies at `height` mm from the fronts below, on a wall."""

    wall: PatchWall
    below: list[SpaceCurve]
    height: float

    def nodes_near(self, line: Line) -> _Nodes | None:
        """Nodes near the points of a line, in the front's sense of direction; none where too few find their distance."""
        points, normal, foot = self._converged(line.points, None if line.closed else line.rims)
        typical = np.median(np.linalg.norm(np.diff(line.points, axis=0), axis=1))
        found = self._reached(foot) & (np.linalg.norm(points - line.points, axis=1) < 8.0 * typical)
        known = np.flatnonzero(np.isfinite(line.ends).all(axis=1))
        if not line.closed and len(known):
            end = np.array([0, len(points) - 1])[known]
            points[end], normal[end] = line.ends[known], self.wall.project(line.ends[known])[1]
            foot, found[end] = feet(self.below, points), True
        if found.sum() < (4 if line.closed else 2):
            return None
        nodes = _smooth_nodes(points[found], normal[found], foot.of(found), line.closed)
        chord = np.diff(np.vstack([nodes.points, nodes.points[:1]]), axis=0)[
            : len(nodes.points) if line.closed else -1
        ]
        return (
            nodes.of(slice(None, None, -1))
            if dot(nodes.out[: len(chord)], chord).sum() < 0.0
            else nodes
        )

    def off(self, points: Array) -> Array:
        """How far points (n, 3) are off the wall, or off the height, whichever is more, mm."""
        foot = self.wall.project(points)[0]
        off: Array = np.abs(feet(self.below, foot).distance - self.height)
        return np.asarray(np.maximum(off, np.linalg.norm(foot - points, axis=1)))

    def middles(self, curve: SpaceCurve, arcs: Index) -> tuple[Index, _Nodes]:
        """The middles of arcs (k,) of a curve: the arcs whose middle finds its distance, and these as nodes."""
        points, normal, foot = self._converged(
            curve.at(curve.w[arcs] + 0.5 * curve.span[arcs])[0], None
        )
        found = self._reached(foot)
        return arcs[found], _smooth_nodes(
            points[found], normal[found], foot.of(found), curve.closed
        )

    def corners(self, nodes: _Nodes, arcs: Index) -> tuple[Index, _Nodes]:
        """Corners on those of the arcs (k,) whose ends belong to two branches: the arcs that have one, and the corners."""
        ends = [nodes.of(arcs), nodes.of((arcs + 1) % len(nodes.points))]
        both = [end.foot for end in ends]
        chord = np.linalg.norm(ends[1].points - ends[0].points, axis=1)
        middle = 0.5 * (ends[0].points + ends[1].points)
        points, normal = self.wall.project(middle)
        for _ in range(STEPS * 2):
            both = [self._walked(points, foot) for foot in both]
            slopes = [foot.away - dot(foot.away, normal)[:, None] * normal for foot in both]
            step = _step(
                slopes,
                [self.height - foot.distance for foot in both],
                np.maximum(chord, 0.3 * self.height),
            )
            points, normal = self.wall.project(points + step)
            if np.abs(step).max(initial=0.0) < 1e-12:
                break
        both = [self._walked(points, foot) for foot in both]
        found = np.linalg.norm(both[0].point - both[1].point, axis=1) > SAME_FOOT * self.height
        for foot in both:
            found &= np.abs(foot.distance - self.height) < 1e-8
        found &= np.linalg.norm(points - middle, axis=1) < np.maximum(
            1.5 * chord, 4.0 * self.height
        )
        for end in ends:  # one of the ends may be that corner already
            corner = dot(end.into, end.out) < SMOOTH
            found &= ~corner | (np.linalg.norm(points - end.points, axis=1) > SAME_PLACE)
        found[found] = np.abs(feet(self.below, points[found]).distance - self.height) < 1e-7
        into, out = (unit(np.cross(foot.away, normal)) for foot in both)
        return arcs[found], _Nodes(points, into, out, both[0], nodes.closed).of(found)

    def _reached(self, foot: Feet) -> Mask:
        reached: Mask = np.abs(foot.distance - self.height) < CONVERGED * self.height
        return reached

    def _converged(self, points: Array, rims: Array | None) -> tuple[Array, Array, Feet]:
        """Points moved within the wall, straight away from the front below, until their distance is the height; the ends of
        an open line along the rims."""
        points, normal = self.wall.project(points)
        for _ in range(STEPS):
            foot = feet(self.below, points)
            slope = foot.away - dot(foot.away, normal)[:, None] * normal
            off = self.height - foot.distance
            if np.abs(off).max(initial=0.0) < 1e-11 * self.height:
                break
            step = (off / np.maximum(dot(slope, slope), 0.05))[:, None] * slope
            if rims is not None:
                rate = dot(foot.away[[0, -1]], rims)
                least = np.where(rate < 0.0, -0.1, 0.1)
                step[[0, -1]] = (off[[0, -1]] / np.where(np.abs(rate) < 0.1, least, rate))[
                    :, None
                ] * rims
            points, normal = self.wall.project(points + step)
        return points, normal, feet(self.below, points)

    def _walked(self, points: Array, foot: Feet) -> Feet:
        """The nearest points on the branches that the feet of other points lie on."""
        w, nearest = foot.w.copy(), np.empty_like(points)
        for k in np.unique(foot.front):
            own = foot.front == k
            w[own] = self.below[k].descend(points[own], w[own])
            nearest[own] = self.below[k].at(w[own])[0]
        return Feet.between(points, nearest, foot.front, w)


def _smooth_nodes(points: Array, normal: Array, foot: Feet, closed: bool) -> _Nodes:
    """Nodes with the front below on their right, seen against the normals (n, 3)."""
    tangent = unit(np.cross(foot.away, normal))
    return _Nodes(points, tangent, tangent, foot, closed)


def _step(slopes: list[Array], off: list[Array], longest: Array) -> Array:
    """The steps (k, 3) that change two distances with these slopes (k, 3) by what they are off (k,), no longer than
    `longest`; none where the slopes are too much alike to tell."""
    a, b, c = dot(slopes[0], slopes[0]), dot(slopes[0], slopes[1]), dot(slopes[1], slopes[1])
    p, q = off
    determinant = a * c - b * b
    sharp = determinant > 1e-9
    safe = np.where(sharp, determinant, 1.0)
    step: Array = ((c * p - b * q) / safe)[:, None] * slopes[0] + ((a * q - b * p) / safe)[
        :, None
    ] * slopes[1]
    length = np.linalg.norm(step, axis=1)
    step *= (np.where(sharp, 1.0, 0.0) * np.minimum(1.0, longest / np.maximum(length, 1e-300)))[
        :, None
    ]
    return step
