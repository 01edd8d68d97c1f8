# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances between solids of revolution and the convex hulls of few points, many pairs at once.

After Gilbert, Johnson and Keerthi (1988): the set of differences of both solids' points is convex, and its point nearest
to the origin is approached by simplices of its extreme points. With each comes a lower bound, so that a pair that is
farther apart, or nearer, than matters is done at once.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ..geometry.columns import columns, dots, lengths
from ..types import Array, Index, Mask
from .frustum import Frustum
from .tolerances import CONVERGED, ROUNDING

# of the edges from the newest point of a simplex of four: each, the sides of the simplex that they are, and its faces, by
# the two edges that they lie between
_EACH, _SIDE, _FACE = np.arange(3), np.arange(1, 4), np.arange(4, 7)
_FIRST, _SECOND = np.array([0, 0, 1]), np.array([1, 2, 2])
# products of edges that are asked for: squares, then those of two
_ONE, _OTHER = np.concatenate([_EACH, _FIRST]), np.concatenate([_EACH, _SECOND])
# of cross products of the two other edges: the components (of 9) that are multiplied, first those that are added
_NEXT, _AFTER = np.array([[1], [2], [0]]), np.array([[2], [0], [1]])
_CROSS = np.array(
    [
        3 * one + part.ravel()
        for one, part in ((_NEXT, _NEXT), (_AFTER, _AFTER), (_NEXT, _AFTER), (_AFTER, _NEXT))
    ]
)
# of four points, by which of them have a share (the sum of their codes), three: those that have first, and then one of them
_CODE = np.array([1, 2, 4, 8])
_KEPT = np.array(
    [
        (*having, *having[:1] * 3, 0, 0, 0)[:3]
        for having in (tuple(k for k in range(4) if code >> k & 1) for code in range(16))
    ]
)
BATCH = 500  # pairs that are done as soon together as in two parts
MAX_STEPS = 64  # steps of a pair; what is not settled then is near to grazing and keeps its bounds


class Hull(Protocol):
    """Convex things, k of them, of which some can be taken, and the points (k, 3) that lie farthest along directions."""

    def __len__(self) -> int: ...
    def __getitem__(self, rows: Index) -> Hull: ...
    def farthest(self, direction: Array) -> Array: ...


def bounds(
    solid: Frustum,
    axis: Array,
    points: Array | Hull,
    nearer: Array | float = 0.0,
    farther: Array | float = np.inf,
    start: Array | None = None,
) -> tuple[Array, Array]:
    """Lower and upper bounds (k,) mm of the distance between solids about unit axes (k, 3) and the hulls of points
    (k, c, 3), seen from the tips; they agree within CONVERGED, unless the distance is surely below `nearer`, or above
    `farther`, both (k,) mm. 0 where the two meet. start: ways (k, 3) to begin with, `from_middles` by default."""
    count = len(points)
    low = np.zeros(count)
    nearer, farther = np.broadcast_to(nearer, count), np.broadcast_to(farther, count)
    place = from_middles(solid, axis, np.asarray(points)) if start is None else start
    high = np.sqrt(dots(place, place))
    rows = np.flatnonzero(high > np.maximum(nearer, CONVERGED))
    place = place[rows]
    simplex: Array | None = None
    solid, axis, points = solid.rows(rows), axis[rows], points[rows]
    for _ in range(MAX_STEPS):
        if not len(rows):
            break
        newest = solid.farthest(-place, axis) - _farthest(points, place)
        size = high.take(rows)
        low[rows] = at_least = np.maximum(low.take(rows), dots(place, newest) / size)
        going = np.flatnonzero(at_least < np.minimum(farther.take(rows), size - CONVERGED))
        if len(going) < len(rows):
            if not len(going):
                break
            rows, size = rows.take(going), size.take(going)
            newest, place, axis = (each.take(going, axis=0) for each in (newest, place, axis))
            solid, points = solid.rows(going), points[going]
            simplex = None if simplex is None else simplex.take(going, axis=0)
        place, simplex = _of_two(place, newest) if simplex is None else _nearest(simplex, newest)
        now = np.sqrt(dots(place, place))
        # no nearer than before: rounding has the last word
        high[rows] = np.where(now > CONVERGED, np.minimum(now, size), 0.0)
        going = np.flatnonzero((now > np.maximum(nearer.take(rows), CONVERGED)) & (now < size))
        if len(going) < len(rows):
            rows = rows.take(going)
            simplex, place, axis = (each.take(going, axis=0) for each in (simplex, place, axis))
            solid, points = solid.rows(going), points[going]
    return np.minimum(low, high), high


def ways(solid: Frustum, axis: Array, points: Array | Hull, middle: Array) -> tuple[Array, Array]:
    """Where hulls of points (k, c, 3) are nearest to solids about unit axes (k, 3), and the ways (k, 3) from there to these,
    seen from the tips; none where the two meet. middle: (k, 3) a point of each hull."""
    found = np.concatenate([solid.nearest(middle, axis) - middle, middle], axis=1)
    rows = np.flatnonzero(dots(found[:, :3], found[:, :3]) > CONVERGED**2)
    place, simplex = found[rows], None
    solid, axis, points = solid.rows(rows), axis[rows], points[rows]
    for _ in range(MAX_STEPS):
        if not len(rows):
            break
        way = place[:, :3]
        there = _farthest(points, way)
        newest = np.concatenate([solid.farthest(-way, axis) - there, there], axis=1)
        size = np.sqrt(dots(way, way))
        going = np.flatnonzero(dots(way, newest[:, :3]) < size * (size - CONVERGED))
        rows, newest, place, size = rows[going], newest[going], place[going], size[going]
        solid, axis, points = solid.rows(going), axis[going], points[going]
        place, simplex = (
            _of_two(place, newest) if simplex is None else _nearest(simplex[going], newest)
        )
        now = np.sqrt(dots(place[:, :3], place[:, :3]))
        nearer = now < size
        found[rows[nearer]] = place[nearer]
        found[rows[now <= CONVERGED], :3] = 0.0
        going = np.flatnonzero((now > CONVERGED) & nearer)
        rows, place, simplex = rows[going], place[going], simplex[going]
        solid, axis, points = solid.rows(going), axis[going], points[going]
    return found[:, 3:], found[:, :3]


def _farthest(points: Array | Hull, direction: Array) -> Array:
    """The points (k, 3) of hulls that lie farthest along directions (k, 3)."""
    if not isinstance(points, np.ndarray):
        return points.farthest(direction)
    own = np.einsum("kcj,kj->kc", points, direction).argmax(axis=1)
    found: Array = points[np.arange(len(points)), own]
    return found


def within(
    solid: Frustum, axis: Array, points: Array, radius: Array, start: Array | None = None
) -> Mask:
    """(k,) whether hulls of points (k, c, 3) with a rounding of the radius (k,) mm about them reach into solids. start: as
    for `bounds`."""
    deep = np.maximum(radius - CONVERGED, 0.0)
    _, high = bounds(solid, axis, points, deep, np.maximum(deep, CONVERGED), start)
    found: Mask = (high < deep) | (high == 0.0)
    return found


def any_within(query: Index, solid: Frustum, axis: Array, points: Array, radius: Array) -> Mask:
    """(k,) as `within`, but of the hulls asked for by one query (k,) no more than needed to know whether any does: those
    with the nearest middle are looked at first, and the others where that does not, unless there are few."""
    deep = np.maximum(radius - CONVERGED, 0.0)
    middle = middles(points)
    place = solid.nearest(middle, axis) - middle
    gap = np.sqrt(dots(place, place))
    found: Mask = (gap < deep) | (gap == 0.0)
    met = np.zeros(query.max(initial=-1) + 1, dtype=bool)
    met[query[found]] = True
    # where the point nearest to a middle is, a plane touches the solid: the hull is no nearer than its corners are to that
    away = points - middle[:, None]
    nearer = largest(np.einsum("kcj,kj->kc", away, place)) / np.where(gap > 0.0, gap, 1.0)
    left = np.flatnonzero(~met[query] & (gap - nearer < np.maximum(deep, CONVERGED) + ROUNDING))
    place[left] = ways = _from_corners(solid.rows(left), axis[left], points[left], place[left])
    gap[left] = np.sqrt(dots(ways, ways))
    touching = left[gap[left] < deep[left]]
    found[touching] = True
    met[query[touching]] = True
    left = left[~met[query[left]]]
    left = left[np.lexsort(((gap - deep)[left], query[left]))]
    first = np.diff(query[left], prepend=-1) != 0
    for some in (left[first], left[~first]) if len(left) > BATCH else (left,):
        now = some[~met[query[some]]]
        found[now] = within(solid.rows(now), axis[now], points[now], radius[now], place[now])
        met[query[now[found[now]]]] = True
    return found


def from_middles(solid: Frustum, axis: Array, points: Array) -> Array:
    """The ways (k, 3) from the middles of points (k, c, 3) to the nearest points of solids about unit axes (k, 3)."""
    middle = middles(points)
    ways: Array = solid.nearest(middle, axis) - middle
    return ways


def _from_corners(solid: Frustum, axis: Array, points: Array, place: Array) -> Array:
    """Ways (k, 3) from hulls of points (k, c, 3) to solids, to start from: those from the nearest points where they are
    shorter than others, `place` (k, 3). From there `bounds` takes half of the steps."""
    rows, own = np.arange(len(points)), np.repeat(np.arange(len(points)), points.shape[1])
    corners = points.reshape(-1, 3)
    ways = (solid.rows(own).nearest(corners, axis[own]) - corners).reshape(points.shape)
    square = np.einsum("kcj,kcj->kc", ways, ways)
    nearest = square.argmin(axis=1)
    shorter = square[rows, nearest] < dots(place, place)
    return np.where(shorter[:, None], ways[rows, nearest], place)


def from_origin(segment: Array) -> Array:
    """Distances (k,) mm of segments (k, 2, 3) from the origin."""
    start, along = segment[:, 0], segment[:, 1] - segment[:, 0]
    square = dots(along, along)
    share = np.clip(-dots(start, along) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    away: Array = lengths(start + share[:, None] * along)
    return away


def middles(points: Array) -> Array:
    """(k, 3) the means of points (k, c, 3): column by column many times as fast as along an axis of so few."""
    middle = points[:, 0].copy()
    for column in range(1, points.shape[1]):
        middle += points[:, column]
    middle /= points.shape[1]
    return middle


def largest(values: Array) -> Array:
    """(k,) the largest of values (k, c), column by column as well."""
    found: Array = values[:, 0]
    for column in range(1, values.shape[1]):
        found = np.maximum(found, values[:, column])
    return found


def _of_two(one: Array, newest: Array) -> tuple[Array, Array]:
    """As `_nearest`, of the segments from points (k, 3) to the newest ones."""
    edge = one - newest
    along, at = edge[:, :3], newest[:, :3]
    square, pull, own = dots(along, along), -dots(at, along), dots(at, at)
    part = np.clip(pull / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    share = np.where(own - 2.0 * part * pull + part * part * square < own, part, 0.0)[:, None]
    return newest + share * edge, np.stack(
        [
            np.where(share > 0.0, one, newest),
            np.where(share < 1.0, newest, one),
            np.where(share > 0.0, one, newest),
        ],
        axis=1,
    )


def _nearest(simplex: Array, newest: Array) -> tuple[Array, Array]:
    """The point (k, 3) nearest to the origin of the hulls of three points (k, 3, 3), of which some may be one, and a fourth
    (k, 3) that has a share in it; and the up to three points (k, 3, 3) that have. Columns beside the three of a point are
    taken by the same shares."""
    edges, at = simplex - newest[:, None], columns(newest[:, :3])
    # by edges, components, rows; all corners, sides and faces that hold the newest point at once: most calls are about a
    # handful of simplices
    edge = np.ascontiguousarray(edges[:, :, :3].transpose(1, 2, 0))
    squares = _summed(edge.take(_ONE, axis=0) * edge.take(_OTHER, axis=0))
    square, b, pull, own = (
        squares[:3],
        squares[3:],
        -_summed(edge * at),
        _summed((at * at)[None])[0],
    )
    shares, value = np.zeros((7, 3, len(newest))), np.empty((7, len(newest)))
    value[0] = own
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.minimum(
            np.maximum(np.where(square > 0.0, pull / square, 0.0), 0.0), 1.0
        )  # np.clip takes many times that
        shares[_SIDE, _EACH] = part
        value[1:4] = own - 2.0 * part * pull + part * part * square
        a, c, pull_a, pull_c = (
            each.take(some, axis=0) for each in (square, pull) for some in (_FIRST, _SECOND)
        )
        wide = a * c - b * b
        one, two = (pull_a * c - pull_c * b) / wide, (pull_c * a - pull_a * b) / wide
        holds = (wide > 1e-12 * a * c) & (one > 0.0) & (two > 0.0) & (one + two < 1.0)
        shares[_FACE, _FIRST], shares[_FACE, _SECOND] = one, two
        value[4:] = np.where(holds, own - one * pull_a - two * pull_c, np.inf)
        # normals of the faces opposite to each edge: the cross products of the two after it
        one_way, other_way, back, other_back = edge.reshape(9, -1).take(_CROSS, axis=0)
        normal = one_way * other_way - back * other_back
        volume = _summed((edge[0] * normal[0])[None])[0]
        parts = -_summed(normal * at) / volume
        inside = np.abs(volume) > 1e-12 * np.sqrt(square[0] * square[1] * square[2])
        inside &= (parts > 0.0).all(axis=0) & (parts[0] + parts[1] + parts[2] < 1.0)
    rows = np.arange(len(newest))
    share = shares[value.argmin(axis=0), :, rows]
    place = newest + np.einsum("ki,kij->kj", share, edges)
    place[inside, :3] = 0.0
    kept = np.concatenate([simplex, newest[:, None]], axis=1)
    weight = np.concatenate([share, 1.0 - share.sum(axis=1, keepdims=True)], axis=1)
    order = _KEPT[(weight > 0.0) @ _CODE]
    return place, kept.reshape(-1, kept.shape[2]).take(4 * rows[:, None] + order, axis=0)


def _summed(products: Array) -> Array:
    """(m, k) sums of the components of products (m, 3, k), added up in the order of `dots`."""
    total: Array = products[:, 0] + products[:, 2]
    total += products[:, 1]
    return total
