# SPDX-License-Identifier: LGPL-2.1-or-later
"""A front on a wall made exact: points brought onto the wall and to their distance, corners found, arcs refined."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.frames import unit
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from ...types import Array, Index

STEPS = 12
ROUNDS = 12
CONVERGED = 1e-6  # of the height; points off by more have not found their place
SAME_PLACE = 1e-5  # mm; of two nodes nearer than this one goes, and it is not the corner
SMOOTH = 1.0 - 1e-9  # cosine of the turn at a node that is not a corner
WITHIN = 5e-5  # mm; at INSIDE, where arcs are off by more than half of what they are anywhere between the nodes
# of each arc; where the wall's curvature jumps within it, its middle may be right by chance
INSIDE = np.array([1.0 / 3.0, 2.0 / 3.0])
SAME_FOOT = 1e-3  # of the height; branches whose nearest points lie closer than this are one


class Feet(NamedTuple):
    """Distances (n,) to the fronts below, unit vectors away from the nearest points (n, 3), and where these lie:
    front (n,), parameter w (n,), point (n, 3)."""

    distance: Array
    away: Array
    front: Index
    w: Array
    point: Array


def feet(fronts: list[SpaceCurve], points: Array) -> Feet:
    """The nearest of all places on the fronts for each point (n, 3)."""
    found = [front.nearest(points) for front in fronts]
    distances = np.stack([one[0] for one in found])
    which = np.argmin(distances, axis=0)
    row = np.arange(len(points))
    foot = np.stack([one[1] for one in found])[which, row]
    return _feet(points, foot, which, np.stack([one[2] for one in found])[which, row])


def _feet(points: Array, foot: Array, front: Index, w: Array) -> Feet:
    gap = points - foot
    distance = np.linalg.norm(gap, axis=1)
    return Feet(distance, gap / np.maximum(distance, 1e-300)[:, None], front, w, foot)


def inside(curve: SpaceCurve) -> Array:
    """The parameters at INSIDE of each arc, (2 (m - 1),), rising."""
    places: Array = (curve.w[:-1, None] + curve.span[:, None] * INSIDE).ravel()
    return places


def exact(
    wall: PatchWall, fronts: list[SpaceCurve], height: float, points: Array, closed: bool, rims: Array, ends: Array
) -> list[SpaceCurve]:
    """The front at `height` mm from the fronts below that runs near the chain of points (n, 3).

    A closed chain does not repeat its first point; the curve does. Nodes lie on the wall and at the height to rounding,
    arcs to WITHIN; corners are nodes. The deposit below lies on the curve's right as seen from where the wall's normals
    point to. ends: (2, 3) where an open front ends; where that is not known, not a number, its end moves along the wall's
    edge, whose directions there are the unit vectors rims (2, 3). None or several pieces where points of the chain do
    not find their distance: between fronts that meet.
    """
    start = points
    points, normal, below = _converged(wall, fronts, height, points, None if closed else rims)
    far = 2.0 * np.median(np.linalg.norm(np.diff(start, axis=0), axis=1))
    sound = (np.abs(below.distance - height) < CONVERGED * height) & (np.linalg.norm(points - start, axis=1) < 4.0 * far)
    known = np.flatnonzero(np.isfinite(ends).all(axis=1))
    if not closed and len(known):
        place = np.array([0, len(points) - 1])[known]
        points[place], normal[place] = ends[known], wall.project(ends[known])[1]
        below, sound[place] = feet(fronts, points), True
    if sound.sum() < (4 if closed else 2):
        return []
    points, normal = points[sound], normal[sound]
    below = _those(below, sound)
    tangent = unit(np.cross(below.away, normal))
    chord = np.diff(np.vstack([points, points[:1]]), axis=0)[: len(points) if closed else -1]
    nodes = _Nodes(points, tangent, tangent, below)
    if dot(tangent[: len(chord)], chord).sum() < 0.0:
        nodes = _Nodes(points[::-1], tangent[::-1], tangent[::-1], _those(below, np.arange(len(points))[::-1]))
    for _ in range(ROUNDS):
        nodes = _forward(nodes, closed)
        curve = _curve(nodes, closed)
        inner = curve.at(inside(curve))[0]
        on_wall = wall.project(inner)[0]
        off = np.maximum(np.abs(feet(fronts, on_wall).distance - height), np.linalg.norm(on_wall - inner, axis=1))
        bad = np.flatnonzero((off.reshape(-1, len(INSIDE)).max(axis=1) > WITHIN) & (curve.span > 1e-6 * curve.period))
        if not len(bad):
            return [curve]
        corner = _corners(wall, fronts, height, nodes, bad)
        rest = bad[~np.isin(bad, corner[0])]
        middle = curve.at(curve.w[rest] + 0.5 * curve.span[rest])[0]
        spot, spot_normal, spot_below = _converged(wall, fronts, height, middle, None)
        sound = np.abs(spot_below.distance - height) < CONVERGED * height
        rest, spot, spot_normal = rest[sound], spot[sound], spot_normal[sound]
        spot_below = _those(spot_below, sound)
        along = unit(np.cross(spot_below.away, spot_normal))
        nodes = _inserted(nodes, [corner, (rest, _Nodes(spot, along, along, spot_below))])
    return _without(curve, bad)


def _without(curve: SpaceCurve, bad: Index) -> list[SpaceCurve]:
    """What is left of a curve without some of its arcs: where fronts meet in a gap too narrow to be followed."""
    if curve.closed:
        curve = curve.started_at(int(bad[0]) + 1 if bad[0] + 1 < len(curve.span) else 0)
        bad = (bad - bad[0] - 1) % len(curve.span)
    ends = np.r_[-1, np.sort(bad), len(curve.span)]
    return [curve.stretch(int(one) + 1, int(other)) for one, other in zip(ends[:-1], ends[1:]) if other - one > 2]


class _Nodes(NamedTuple):
    points: Array
    into: Array
    out: Array
    below: Feet


def _converged(
    wall: PatchWall, fronts: list[SpaceCurve], height: float, points: Array, rims: Array | None
) -> tuple[Array, Array, Feet]:
    """Points moved within the wall, straight away from the front below, until their distance is the height; the ends of
    an open chain along the rims."""
    points, normal = wall.project(points)
    for _ in range(STEPS):
        below = feet(fronts, points)
        slope = below.away - dot(below.away, normal)[:, None] * normal
        error = height - below.distance
        if np.abs(error).max(initial=0.0) < 1e-11 * height:
            break
        step = (error / np.maximum(dot(slope, slope), 0.05))[:, None] * slope
        if rims is not None:
            rate = dot(below.away[[0, -1]], rims)
            least = np.where(rate < 0.0, -0.1, 0.1)
            step[[0, -1]] = (error[[0, -1]] / np.where(np.abs(rate) < 0.1, least, rate))[:, None] * rims
        points, normal = wall.project(points + step)
    return points, normal, feet(fronts, points)


def _corners(
    wall: PatchWall, fronts: list[SpaceCurve], height: float, nodes: _Nodes, arcs: Index
) -> tuple[Index, _Nodes]:
    """Corners on those of the arcs (k,) whose ends belong to two branches: the arcs that have one, and the corners."""
    n = len(nodes.points)
    ends = [arcs, (arcs + 1) % n]
    start = [nodes.below.w[end] for end in ends]
    front = [nodes.below.front[end] for end in ends]
    span = np.linalg.norm(nodes.points[ends[1]] - nodes.points[ends[0]], axis=1)
    middle = 0.5 * (nodes.points[ends[0]] + nodes.points[ends[1]])
    longest = np.maximum(span, 0.3 * height)
    point, normal = wall.project(middle)
    for _ in range(STEPS * 2):
        both = [_walked(fronts, point, front[k], start[k]) for k in (0, 1)]
        slopes = [one.away - dot(one.away, normal)[:, None] * normal for one in both]
        a, b, c = dot(slopes[0], slopes[0]), dot(slopes[0], slopes[1]), dot(slopes[1], slopes[1])
        p, q = (height - one.distance for one in both)
        determinant = a * c - b * b
        sharp = determinant > 1e-9
        safe = np.where(sharp, determinant, 1.0)
        step = ((c * p - b * q) / safe)[:, None] * slopes[0] + ((a * q - b * p) / safe)[:, None] * slopes[1]
        length = np.linalg.norm(step, axis=1)
        step *= (np.where(sharp, 1.0, 0.0) * np.minimum(1.0, longest / np.maximum(length, 1e-300)))[:, None]
        point, normal = wall.project(point + step)
        start = [one.w for one in both]
        if np.abs(step).max(initial=0.0) < 1e-12:
            break
    both = [_walked(fronts, point, front[k], start[k]) for k in (0, 1)]
    apart = np.linalg.norm(both[0].point - both[1].point, axis=1)
    right = apart > SAME_FOOT * height
    for one in both:
        right &= np.abs(one.distance - height) < 1e-8
    right &= np.linalg.norm(point - middle, axis=1) < np.maximum(1.5 * span, 4.0 * height)
    for end in ends:  # one of the ends may be that corner already
        known = dot(nodes.into[end], nodes.out[end]) < SMOOTH
        right &= ~known | (np.linalg.norm(point - nodes.points[end], axis=1) > SAME_PLACE)
    right[right] = np.abs(feet(fronts, point[right]).distance - height) < 1e-7
    into, out = (unit(np.cross(one.away, normal)) for one in both)
    return arcs[right], _Nodes(point[right], into[right], out[right], _those(both[0], right))


def _walked(fronts: list[SpaceCurve], points: Array, front: Index, w: Array) -> Feet:
    """The nearest points on the branches that the places (front, w) lie on."""
    new, foot = w.copy(), np.empty_like(points)
    for k in np.unique(front):
        one = front == k
        new[one] = fronts[k].walked(points[one], w[one])
        foot[one] = fronts[k].at(new[one])[0]
    return _feet(points, foot, front, new)


def _inserted(nodes: _Nodes, more: list[tuple[Index, _Nodes]]) -> _Nodes:
    """The nodes with others behind the nodes that begin the arcs named."""
    key = np.concatenate([np.arange(len(nodes.points))] + [arcs + 0.5 for arcs, _ in more])
    order = np.argsort(key, kind="stable")
    all_ = [nodes, *(one for _, one in more)]
    points, into, out = (np.concatenate([one[k] for one in all_])[order] for k in range(3))
    below = Feet(*(np.concatenate(parts)[order] for parts in zip(*(one.below for one in all_))))
    return _Nodes(points, into, out, below)


def _forward(nodes: _Nodes, closed: bool) -> _Nodes:
    """Without the nodes that lie behind their predecessor or on it: next to corners points may settle in a tangle."""
    while True:
        n = len(nodes.points)
        chord = np.roll(nodes.points, -1, axis=0) - nodes.points
        length = np.linalg.norm(chord, axis=1)
        turned = (dot(chord, nodes.out) <= 0.0) | (dot(chord, np.roll(nodes.into, -1, axis=0)) <= 0.0)
        alike = dot(nodes.out, np.roll(nodes.into, -1, axis=0)) > 0.5  # else a corner is still to be found between them
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
        nodes = _Nodes(nodes.points[~drop], nodes.into[~drop], nodes.out[~drop], _those(nodes.below, ~drop))


def _those(below: Feet, which: NDArray[np.bool_] | Index) -> Feet:
    return Feet(below.distance[which], below.away[which], below.front[which], below.w[which], below.point[which])


def _curve(nodes: _Nodes, closed: bool) -> SpaceCurve:
    points, into, out = nodes[:3]
    if closed:
        points, into, out = (np.vstack([column, column[:1]]) for column in (points, into, out))
    w = np.r_[0.0, np.cumsum(np.maximum(np.linalg.norm(np.diff(points, axis=0), axis=1), 1e-12))]
    return SpaceCurve(w, points, into, out, closed)
