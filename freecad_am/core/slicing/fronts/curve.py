# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fit fronts to the exact wall and distance, find their corners, and fit other curves to the wall."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.frames import unit
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from ...types import Array, Index, Mask
from .rims import Feet, Line, Rims, nearest_feet


@dataclass(frozen=True)
class Smoothing:
    """Smoothing of fronts.

    band: maximum deviation of the local distance, as a fraction of the layer height. limit: maximum
    turn rate within the wall, rad/mm, kept where the band allows.
    """

    band: float
    limit: float


@dataclass(frozen=True, eq=False)
class Slicing:
    """Wall, rims, layer height, mm, and optional smoothing of fronts."""

    wall: PatchWall
    rims: Rims
    height: float
    smoothing: Smoothing | None = None

    @property
    def widest(self) -> float:
        """Maximum distance between layers, in layer heights."""
        return 1.0 if self.smoothing is None else 1.0 + self.smoothing.band

    def left_of(self, curve: SpaceCurve) -> tuple[Array, Array]:
        """Return the direction to the left of a curve within the wall.

        Parameters
        ----------
        curve : SpaceCurve
            The curve, with n arcs.

        Returns
        -------
        points : (n, 3) array
            Midpoints of the arcs, mm.
        left : (n, 3) array
            Vectors within the wall to the left of the curve.
        """
        points, slope, _ = curve.at(curve.w[:-1] + 0.5 * curve.span)
        return points, np.cross(self.wall.project(points)[1], slope)


STEPS = 12  # maximum number of Newton steps
ROUNDS = 12  # maximum number of refinements
CONVERGED = 1e-6  # in layer heights; maximum distance error of converged points
SAME_PLACE = 1e-5  # mm; one of two closer nodes is dropped; corners stay
SMOOTH = 1.0 - 1e-9  # minimum cosine of the direction change at a node that is not a corner
TOLERANCE_MM = (
    5e-5  # mm; arc error at TEST_SHARES, more than half of the maximum error between nodes
)
# fractions of an arc; where the wall's curvature jumps, the midpoint may be exact by chance
TEST_SHARES = np.array([1.0 / 3.0, 2.0 / 3.0])
SAME_FOOT = 1e-3  # in layer heights; branches with closer nearest points are one branch


def fit_front(slicing: Slicing, below: list[SpaceCurve], line: Line) -> list[SpaceCurve]:
    """Compute the exact front at the layer height from the fronts below, near a line.

    The deposit below is on the right of the front, as seen against the normals of the wall. An
    unknown end of an open line moves along the edge of the wall.

    Parameters
    ----------
    slicing : Slicing
        Wall, rims and layer height.
    below : list of SpaceCurve
        The fronts of the layer below.
    line : Line
        A level line of the mesh near the front.

    Returns
    -------
    list of SpaceCurve
        One curve. If points between fronts that meet cannot reach the distance, there is no curve
        or there are several pieces. Nodes are on the wall and at the layer height to rounding
        errors, arcs to TOLERANCE_MM. Corners are nodes.
    """
    offset = _Offset(slicing.wall, below, slicing.height)
    nodes = offset.nodes_near(line)
    if nodes is None:
        return []
    measured: dict[bytes, float] = {}
    for _ in range(ROUNDS):
        nodes = nodes.forward()
        curve = nodes.curve()
        bad = _bad_arcs(curve, offset.error, measured)
        if not len(bad):
            return [curve]
        corners = offset.corners(nodes, bad)
        nodes = nodes.insert([corners, offset.middles(curve, bad[~np.isin(bad, corners[0])])])
    return _remove_arcs(curve, bad)


def fit_to_wall(wall: PatchWall, curve: SpaceCurve) -> SpaceCurve:
    """Add nodes to a curve where its arcs deviate from the wall by more than TOLERANCE_MM."""
    measured: dict[bytes, float] = {}
    for _ in range(ROUNDS):
        bad = _bad_arcs(
            curve,
            lambda points: np.linalg.norm(wall.project(points)[0] - points, axis=1),
            measured,
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


def _bad_arcs(
    curve: SpaceCurve, off: Callable[[Array], Array], measured: dict[bytes, float]
) -> Index:
    """Return arcs with errors above TOLERANCE_MM at TEST_SHARES, except arcs too short to divide.

    off: returns the errors of points, mm. measured: cache of arc errors by arc ends, updated in
    place.
    """
    ends = np.hstack([curve.points[:-1], curve.points[1:], curve.out[:-1], curve.into[1:]])
    keys = [row.tobytes() for row in ends]
    new = np.array([k for k, key in enumerate(keys) if key not in measured], dtype=np.intp)
    if len(new):
        w = (curve.w[new, None] + curve.span[new, None] * TEST_SHARES).ravel()
        errors = off(curve.at(w)[0]).reshape(-1, len(TEST_SHARES)).max(axis=1)
        measured.update((keys[k], error) for k, error in zip(new.tolist(), errors.tolist()))
    max_error = np.array([measured[key] for key in keys])
    return np.flatnonzero((max_error > TOLERANCE_MM) & (curve.span > 1e-6 * curve.period))


def _remove_arcs(curve: SpaceCurve, bad: Index) -> list[SpaceCurve]:
    """Remove arcs from a curve and return the remaining stretches.

    The removed arcs are where fronts meet in a gap too narrow to resolve.
    """
    if curve.closed:
        curve = curve.started_at(int(bad[0]) + 1 if bad[0] + 1 < len(curve.span) else 0)
        bad = (bad - bad[0] - 1) % len(curve.span)
    ends = np.r_[-1, np.sort(bad), len(curve.span)]
    return [
        curve.stretch(int(previous_cut) + 1, int(next_cut))
        for previous_cut, next_cut in zip(ends[:-1], ends[1:])
        if next_cut - previous_cut > 2
    ]


class _Nodes(NamedTuple):
    """Nodes of a front; a closed front does not repeat its first node.

    points: (n, 3), mm. into, out: (n, 3) unit tangents before and after each node. foot: nearest
    points on the fronts below.
    """

    points: Array
    into: Array
    out: Array
    foot: Feet
    closed: bool

    def select(self, rows: Mask | Index | slice) -> _Nodes:
        """Return selected nodes."""
        return _Nodes(
            self.points[rows], self.into[rows], self.out[rows], self.foot.select(rows), self.closed
        )

    def insert(self, additions: list[tuple[Index, _Nodes]]) -> _Nodes:
        """Insert nodes into arcs; additions: arc indices and nodes."""
        order = np.argsort(
            np.concatenate([np.arange(len(self.points))] + [arcs + 0.5 for arcs, _ in additions]),
            kind="stable",
        )
        sources = [self, *(nodes for _, nodes in additions)]
        points, into, out = (np.concatenate([nodes[k] for nodes in sources]) for k in range(3))
        foot = Feet(
            *(np.concatenate(columns) for columns in zip(*(nodes.foot for nodes in sources)))
        )
        return _Nodes(points, into, out, foot, self.closed).select(order)

    def forward(self) -> _Nodes:
        """Drop nodes on or behind their predecessor, as can occur next to corners."""
        nodes, closed = self, self.closed
        while True:
            n = len(nodes.points)
            chord = np.roll(nodes.points, -1, axis=0) - nodes.points
            length = np.linalg.norm(chord, axis=1)
            turned = (dot(chord, nodes.out) <= 0.0) | (
                dot(chord, np.roll(nodes.into, -1, axis=0)) <= 0.0
            )
            # nodes with very different tangents have a corner in between that is still to be found
            alike = dot(nodes.out, np.roll(nodes.into, -1, axis=0)) > 0.5
            bad = (turned & alike) | (length < SAME_PLACE)
            if not closed:
                bad[-1] = False
            corner = dot(nodes.into, nodes.out) < SMOOTH
            drop = np.zeros(n, dtype=bool)
            bad_nodes = np.flatnonzero(bad)
            next_node = (bad_nodes + 1) % n
            # drop one end of a reversed arc, but neither a corner nor an end of an open front
            keep_next = corner[next_node] | ((next_node == n - 1) & (not closed))
            loser = np.where(keep_next, bad_nodes, next_node)
            drop[loser[~(corner[loser])]] = True
            if not closed:
                drop[[0, -1]] = False
            if not drop.any() or n - drop.sum() < 4:
                return nodes
            nodes = nodes.select(~drop)

    def curve(self) -> SpaceCurve:
        """Return the curve through the nodes."""
        points, into, out = self[:3]
        if self.closed:
            points, into, out = (np.vstack([column, column[:1]]) for column in (points, into, out))
        w = np.r_[
            0.0, np.cumsum(np.maximum(np.linalg.norm(np.diff(points, axis=0), axis=1), 1e-12))
        ]
        return SpaceCurve(w, points, into, out, self.closed)


class _Offset(NamedTuple):
    """Offset front: all points of a wall at `height` mm from the fronts below."""

    wall: PatchWall
    below: list[SpaceCurve]
    height: float

    def nodes_near(self, line: Line) -> _Nodes | None:
        """Return nodes near the points of a line, in the direction of the front.

        Returns None if too few points reach the distance.
        """
        points, normal, foot = self._converged(line.points, None if line.closed else line.rims)
        typical = np.median(np.linalg.norm(np.diff(line.points, axis=0), axis=1))
        is_valid = self._has_converged(foot) & (
            np.linalg.norm(points - line.points, axis=1) < 8.0 * typical
        )
        known_ends = np.flatnonzero(np.isfinite(line.ends).all(axis=1))
        if not line.closed and len(known_ends):
            end = np.array([0, len(points) - 1])[known_ends]
            points[end], normal[end] = (
                line.ends[known_ends],
                self.wall.project(line.ends[known_ends])[1],
            )
            foot, is_valid[end] = nearest_feet(self.below, points), True
        if is_valid.sum() < (4 if line.closed else 2):
            return None
        nodes = _smooth_nodes(
            points[is_valid], normal[is_valid], foot.select(is_valid), line.closed
        )
        chord = np.diff(np.vstack([nodes.points, nodes.points[:1]]), axis=0)[
            : len(nodes.points) if line.closed else -1
        ]
        return (
            nodes.select(slice(None, None, -1))
            if dot(nodes.out[: len(chord)], chord).sum() < 0.0
            else nodes
        )

    def error(self, points: Array) -> Array:
        """Return the maximum (n,), mm, of wall distance and height error of points (n, 3)."""
        foot = self.wall.project(points)[0]
        off: Array = np.abs(nearest_feet(self.below, foot).distance - self.height)
        return np.asarray(np.maximum(off, np.linalg.norm(foot - points, axis=1)))

    def middles(self, curve: SpaceCurve, arcs: Index) -> tuple[Index, _Nodes]:
        """Return the arcs (k,) whose midpoint reaches the distance, and these midpoints as nodes."""
        points, normal, foot = self._converged(
            curve.at(curve.w[arcs] + 0.5 * curve.span[arcs])[0], None
        )
        is_valid = self._has_converged(foot)
        return arcs[is_valid], _smooth_nodes(
            points[is_valid], normal[is_valid], foot.select(is_valid), curve.closed
        )

    def corners(self, nodes: _Nodes, arcs: Index) -> tuple[Index, _Nodes]:
        """Find corners on arcs whose ends belong to two branches.

        Returns the arcs with a corner (k,), and the corners as nodes.
        """
        ends = [nodes.select(arcs), nodes.select((arcs + 1) % len(nodes.points))]
        middle, _ = self.wall.project(0.5 * (ends[0].points + ends[1].points))
        feet = [self._walked(middle, end.foot).point for end in ends]
        has_branches = np.linalg.norm(feet[0] - feet[1], axis=1) > SAME_PLACE
        arcs, ends = arcs[has_branches], [end.select(has_branches) for end in ends]
        if not len(arcs):
            return arcs, ends[0]
        end_feet = [end.foot for end in ends]
        chord = np.linalg.norm(ends[1].points - ends[0].points, axis=1)
        middle = 0.5 * (ends[0].points + ends[1].points)
        points, normal = self.wall.project(middle)
        for _ in range(STEPS * 2):
            end_feet = [self._walked(points, foot) for foot in end_feet]
            slopes = [foot.away - dot(foot.away, normal)[:, None] * normal for foot in end_feet]
            step = _solve_step(
                slopes,
                [self.height - foot.distance for foot in end_feet],
                np.maximum(chord, 0.3 * self.height),
            )
            points, normal = self.wall.project(points + step)
            if np.abs(step).max(initial=0.0) < 1e-12:
                break
        end_feet = [self._walked(points, foot) for foot in end_feet]
        is_valid = (
            np.linalg.norm(end_feet[0].point - end_feet[1].point, axis=1) > SAME_FOOT * self.height
        )
        for foot in end_feet:
            is_valid &= np.abs(foot.distance - self.height) < 1e-8
        is_valid &= np.linalg.norm(points - middle, axis=1) < np.maximum(
            1.5 * chord, 4.0 * self.height
        )
        for end in ends:  # an end may already be the corner
            corner = dot(end.into, end.out) < SMOOTH
            is_valid &= ~corner | (np.linalg.norm(points - end.points, axis=1) > SAME_PLACE)
        is_valid[is_valid] = (
            np.abs(nearest_feet(self.below, points[is_valid]).distance - self.height) < 1e-7
        )
        into, out = (unit(np.cross(foot.away, normal)) for foot in end_feet)
        return arcs[is_valid], _Nodes(points, into, out, end_feet[0], nodes.closed).select(is_valid)

    def _has_converged(self, foot: Feet) -> Mask:
        reached: Mask = np.abs(foot.distance - self.height) < CONVERGED * self.height
        return reached

    def _converged(self, points: Array, rims: Array | None) -> tuple[Array, Array, Feet]:
        """Move points within the wall, away from the front below, until their distance is the height.

        rims: directions of the rims at the ends of an open line; these ends move along the rims.
        """
        points, normal = self.wall.project(points)
        foot = nearest_feet(self.below, points)
        for _ in range(STEPS):
            off = self.height - foot.distance
            moving = np.flatnonzero(np.abs(off) >= 1e-11 * self.height)
            if not len(moving):
                break
            slope = foot.away - dot(foot.away, normal)[:, None] * normal
            step = (off / np.maximum(dot(slope, slope), 0.05))[:, None] * slope
            if rims is not None:
                rate = dot(foot.away[[0, -1]], rims)
                min_rate = np.where(rate < 0.0, -0.1, 0.1)
                step[[0, -1]] = (off[[0, -1]] / np.where(np.abs(rate) < 0.1, min_rate, rate))[
                    :, None
                ] * rims
            points[moving], normal[moving] = self.wall.project(points[moving] + step[moving])
            for column, new in zip(foot, nearest_feet(self.below, points[moving]), strict=True):
                column[moving] = new
        return points, normal, foot

    def _walked(self, points: Array, foot: Feet) -> Feet:
        """Return the feet of points on given branches; foot: nearby feet that define the branches."""
        w, nearest = foot.w.copy(), np.empty_like(points)
        for k in np.unique(foot.front):
            on_front = foot.front == k
            w[on_front] = self.below[k].descend(points[on_front], w[on_front])
            nearest[on_front] = self.below[k].at(w[on_front])[0]
        return Feet.between(points, nearest, foot.front, w)


def _smooth_nodes(points: Array, normal: Array, foot: Feet, closed: bool) -> _Nodes:
    """Build smooth nodes with the front below on the right, as seen against the normals (n, 3)."""
    tangent = unit(np.cross(foot.away, normal))
    return _Nodes(points, tangent, tangent, foot, closed)


def _solve_step(slopes: list[Array], off: list[Array], longest: Array) -> Array:
    """Return the steps (k, 3) that correct two distances, limited to `longest` mm.

    slopes: (k, 3) gradients of each distance. off: (k,) corrections of each distance, mm. Steps are
    zero where the gradients are nearly parallel.
    """
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
