# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances between solids of revolution and convex hulls of a few points, for many pairs at once.

Method of Gilbert, Johnson and Keerthi (1988): the Minkowski difference of two convex solids is
convex. Simplices of its extreme points converge to its point nearest to the origin. Each step also
yields a lower bound, so the iteration can stop early for pairs that are clearly near or far.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..geometry.columns import columns, dots, lengths
from ..types import Array, Index, Mask
from .frustum import Frustum
from .tolerances import CONVERGED, ROUNDING

# subsets of a four-point simplex that contain the newest point: indices of its three edges, rows of
# the edge and face candidates, and the two edges of each face
_EDGE_IDS, _SIDE, _FACE = np.arange(3), np.arange(1, 4), np.arange(4, 7)
_FACE_EDGE_A, _FACE_EDGE_B = np.array([0, 0, 1]), np.array([1, 2, 2])
# factors of the required edge products: squares, then mixed products
_FACTOR_A, _FACTOR_B = (
    np.concatenate([_EDGE_IDS, _FACE_EDGE_A]),
    np.concatenate([_EDGE_IDS, _FACE_EDGE_B]),
)
# factors, among 9 components, of the cross product of the other two edges; positive terms first
_NEXT, _AFTER = np.array([[1], [2], [0]]), np.array([[2], [0], [1]])
_CROSS = np.array(
    [
        3 * one + part.ravel()
        for one, part in ((_NEXT, _NEXT), (_AFTER, _AFTER), (_NEXT, _AFTER), (_AFTER, _NEXT))
    ]
)
# corner indices by the sum of the active corners' codes: up to three active corners, padded with
# the first active corner
_CODE = np.array([1, 2, 4, 8])
_SIMPLEX_CORNERS = np.array(
    [
        (*having, *having[:1] * 3, 0, 0, 0)[:3]
        for having in (tuple(k for k in range(4) if code >> k & 1) for code in range(16))
    ]
)
BATCH = 500  # pairs; up to this number, one pass is as fast as two
MAX_STEPS = (
    64  # maximum steps of a pair; an unconverged pair is nearly grazing and keeps its bounds
)


class Hull(Protocol):
    """k convex shapes that support row selection and farthest points (k, 3) along directions."""

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
    """Return lower and upper bounds of the distance between solids and hulls.

    Both bounds of a pair agree within CONVERGED, unless the distance is certainly below `nearer`
    or above `farther`.

    Parameters
    ----------
    solid : Frustum
        The k solids.
    axis : (k, 3) array
        Unit axes.
    points : (k, c, 3) array or Hull
        Corners of the hulls from the tips, mm.
    nearer, farther : float or (k,) array, optional
        Thresholds, mm; the search stops when a distance is certainly below or above.
    start : (k, 3) array or None, optional
        Initial vectors from the hulls to the solids; None for `from_middles`.

    Returns
    -------
    low, high : (k,) array
        Bounds, mm; 0 where solid and hull meet.

    Notes
    -----
    Algorithm of Gilbert, Johnson and Keerthi on the Minkowski difference.
    """
    count = len(points)
    low = np.zeros(count)
    nearer, farther = np.broadcast_to(nearer, count), np.broadcast_to(farther, count)
    nearest_point = from_middles(solid, axis, np.asarray(points)) if start is None else start
    high = np.sqrt(dots(nearest_point, nearest_point))
    rows = np.flatnonzero(high > np.maximum(nearer, CONVERGED))
    nearest_point = nearest_point[rows]
    simplex: Array | None = None
    solid, axis, points = solid.rows(rows), axis[rows], points[rows]
    for _ in range(MAX_STEPS):
        if not len(rows):
            break
        newest = solid.farthest(-nearest_point, axis) - _farthest(points, nearest_point)
        size = high.take(rows)
        low[rows] = at_least = np.maximum(low.take(rows), dots(nearest_point, newest) / size)
        going = np.flatnonzero(at_least < np.minimum(farther.take(rows), size - CONVERGED))
        if len(going) < len(rows):
            if not len(going):
                break
            rows, size = rows.take(going), size.take(going)
            newest, nearest_point, axis = (
                rows_of.take(going, axis=0) for rows_of in (newest, nearest_point, axis)
            )
            solid, points = solid.rows(going), points[going]
            simplex = None if simplex is None else simplex.take(going, axis=0)
        nearest_point, simplex = (
            _nearest_on_segments(nearest_point, newest)
            if simplex is None
            else _nearest(simplex, newest)
        )
        now = np.sqrt(dots(nearest_point, nearest_point))
        # a step that does not reduce the distance is rounding error: keep the previous bound
        high[rows] = np.where(now > CONVERGED, np.minimum(now, size), 0.0)
        going = np.flatnonzero((now > np.maximum(nearer.take(rows), CONVERGED)) & (now < size))
        if len(going) < len(rows):
            rows = rows.take(going)
            simplex, nearest_point, axis = (
                rows_of.take(going, axis=0) for rows_of in (simplex, nearest_point, axis)
            )
            solid, points = solid.rows(going), points[going]
    return np.minimum(low, high), high


def shortest_vectors(
    solid: Frustum, axis: Array, points: Array | Hull, middle: Array
) -> tuple[Array, Array]:
    """Return the shortest vectors from hulls to solids.

    Parameters
    ----------
    solid : Frustum
        The k solids.
    axis : (k, 3) array
        Unit axes.
    points : (k, c, 3) array or Hull
        Corners of the hulls from the tips, mm.
    middle : (k, 3) array
        A start point in each hull, from the tips, mm.

    Returns
    -------
    points : (k, 3) array
        Points of the hulls, from the tips, mm.
    vectors : (k, 3) array
        Vectors from these points to the solids; zero for pairs that meet.
    """
    vectors = np.concatenate([solid.nearest(middle, axis) - middle, middle], axis=1)
    rows = np.flatnonzero(dots(vectors[:, :3], vectors[:, :3]) > CONVERGED**2)
    nearest_point, simplex = vectors[rows], None
    solid, axis, points = solid.rows(rows), axis[rows], points[rows]
    for _ in range(MAX_STEPS):
        if not len(rows):
            break
        direction = nearest_point[:, :3]
        hull_points = _farthest(points, direction)
        newest = np.concatenate(
            [solid.farthest(-direction, axis) - hull_points, hull_points], axis=1
        )
        size = np.sqrt(dots(direction, direction))
        going = np.flatnonzero(dots(direction, newest[:, :3]) < size * (size - CONVERGED))
        rows = rows[going]
        newest = newest[going]
        nearest_point = nearest_point[going]
        size = size[going]
        solid, axis, points = solid.rows(going), axis[going], points[going]
        nearest_point, simplex = (
            _nearest_on_segments(nearest_point, newest)
            if simplex is None
            else _nearest(simplex[going], newest)
        )
        now = np.sqrt(dots(nearest_point[:, :3], nearest_point[:, :3]))
        nearer = now < size
        vectors[rows[nearer]] = nearest_point[nearer]
        vectors[rows[now <= CONVERGED], :3] = 0.0
        going = np.flatnonzero((now > CONVERGED) & nearer)
        rows, nearest_point, simplex = rows[going], nearest_point[going], simplex[going]
        solid, axis, points = solid.rows(going), axis[going], points[going]
    return vectors[:, 3:], vectors[:, :3]


def _farthest(points: Array | Hull, direction: Array) -> Array:
    """Return the hull points (k, 3) farthest along directions (k, 3)."""
    if not isinstance(points, np.ndarray):
        return points.farthest(direction)
    corner_ids = np.einsum("kcj,kj->kc", points, direction).argmax(axis=1)
    corners: Array = points[np.arange(len(points)), corner_ids]
    return corners


def find_overlaps(
    solid: Frustum, axis: Array, points: Array, radius: Array, start: Array | None = None
) -> Mask:
    """Return whether rounded hulls reach into solids.

    Parameters
    ----------
    solid : Frustum
        The k solids.
    axis : (k, 3) array
        Unit axes.
    points : (k, c, 3) array
        Corners of the hulls from the tips, mm.
    radius : (k,) array
        Rounding radii of the hulls, mm.
    start : (k, 3) array or None, optional
        Initial vectors, as for `bounds`.

    Returns
    -------
    (k,) bool array
        True for pairs that overlap.
    """
    deep = np.maximum(radius - CONVERGED, 0.0)
    _, high = bounds(solid, axis, points, deep, np.maximum(deep, CONVERGED), start)
    overlaps: Mask = (high < deep) | (high == 0.0)
    return overlaps


def find_any_overlap(
    query: Index, solid: Frustum, axis: Array, points: Array, radius: Array
) -> Mask:
    """Find at least one overlapping hull for each query that has an overlap.

    Closed-form distances from centroids and corners are tested first. Then each query's closest
    hull is tested, and its other hulls only if this hull does not overlap. Up to BATCH pairs are
    tested in one pass.

    Parameters
    ----------
    query : (k,) int array
        Query index of each pair.
    solid : Frustum
        The k solids.
    axis : (k, 3) array
        Unit axes.
    points : (k, c, 3) array
        Corners of the hulls from the tips, mm.
    radius : (k,) array
        Rounding radii of the hulls, mm.

    Returns
    -------
    (k,) bool array
        True for overlaps found; at least one for each query with an overlap.
    """
    deep = np.maximum(radius - CONVERGED, 0.0)
    middle = middles(points)
    vectors = solid.nearest(middle, axis) - middle
    gap = np.sqrt(dots(vectors, vectors))
    overlaps: Mask = (gap < deep) | (gap == 0.0)
    met = np.zeros(query.max(initial=-1) + 1, dtype=bool)
    met[query[overlaps]] = True
    # the plane through the solid's point nearest to the centroid supports the solid: the corner
    # nearest to this plane bounds the distance from below
    offsets = points - middle[:, None]
    nearer = largest(np.einsum("kcj,kj->kc", offsets, vectors)) / np.where(gap > 0.0, gap, 1.0)
    remaining = np.flatnonzero(
        ~met[query] & (gap - nearer < np.maximum(deep, CONVERGED) + ROUNDING)
    )
    vectors[remaining] = corner_vectors = _from_corners(
        solid.rows(remaining), axis[remaining], points[remaining], vectors[remaining]
    )
    gap[remaining] = np.sqrt(dots(corner_vectors, corner_vectors))
    touching = remaining[gap[remaining] < deep[remaining]]
    overlaps[touching] = True
    met[query[touching]] = True
    remaining = remaining[~met[query[remaining]]]
    remaining = remaining[np.lexsort(((gap - deep)[remaining], query[remaining]))]
    is_first = np.diff(query[remaining], prepend=-1) != 0
    for rows in (
        (remaining[is_first], remaining[~is_first]) if len(remaining) > BATCH else (remaining,)
    ):
        now = rows[~met[query[rows]]]
        overlaps[now] = find_overlaps(
            solid.rows(now), axis[now], points[now], radius[now], vectors[now]
        )
        met[query[now[overlaps[now]]]] = True
    return overlaps


def from_middles(solid: Frustum, axis: Array, points: Array) -> Array:
    """Return the vectors from hull centroids to the nearest points of solids.

    Parameters
    ----------
    solid : Frustum
        The k solids.
    axis : (k, 3) array
        Unit axes.
    points : (k, c, 3) array
        Corners of the hulls from the tips, mm.

    Returns
    -------
    (k, 3) array
        Vectors, mm.
    """
    middle = middles(points)
    vectors: Array = solid.nearest(middle, axis) - middle
    return vectors


def _from_corners(solid: Frustum, axis: Array, points: Array, vectors: Array) -> Array:
    """Return start vectors (k, 3) for `bounds` from hulls of points (k, c, 3) to solids.

    The vector of the nearest corner replaces a longer vector of `vectors` (k, 3). `bounds` then
    takes half as many steps.
    """
    rows, hull_ids = np.arange(len(points)), np.repeat(np.arange(len(points)), points.shape[1])
    corners = points.reshape(-1, 3)
    corner_vectors = (solid.rows(hull_ids).nearest(corners, axis[hull_ids]) - corners).reshape(
        points.shape
    )
    square = np.einsum("kcj,kcj->kc", corner_vectors, corner_vectors)
    nearest = square.argmin(axis=1)
    shorter = square[rows, nearest] < dots(vectors, vectors)
    return np.where(shorter[:, None], corner_vectors[rows, nearest], vectors)


def from_origin(segment: Array) -> Array:
    """Return the distances between segments and the origin.

    Parameters
    ----------
    segment : (k, 2, 3) array
        Ends of the segments, mm.

    Returns
    -------
    (k,) array
        Distances, mm.
    """
    start, along = segment[:, 0], segment[:, 1] - segment[:, 0]
    square = dots(along, along)
    share = np.clip(-dots(start, along) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    distances: Array = lengths(start + share[:, None] * along)
    return distances


def middles(points: Array) -> Array:
    """Return the centroids of groups of a few points.

    Column by column, this is many times as fast as a reduction along a short axis.

    Parameters
    ----------
    points : (k, c, 3) array
        The points, mm.

    Returns
    -------
    (k, 3) array
        The centroids.
    """
    middle = points[:, 0].copy()
    for column in range(1, points.shape[1]):
        middle += points[:, column]
    middle /= points.shape[1]
    return middle


def largest(values: Array) -> Array:
    """Return the row maxima of an array with few columns.

    Parameters
    ----------
    values : (k, c) array
        The values.

    Returns
    -------
    (k,) array
        The maxima.
    """
    maxima: Array = values[:, 0]
    for column in range(1, values.shape[1]):
        maxima = np.maximum(maxima, values[:, column])
    return maxima


def _nearest_on_segments(points: Array, newest: Array) -> tuple[Array, Array]:
    """Return the results of `_nearest` for segments from `points` (k, 3) to `newest` (k, 3)."""
    edge = points - newest
    along, origin = edge[:, :3], newest[:, :3]
    square, pull, square_norm = dots(along, along), -dots(origin, along), dots(origin, origin)
    parameter = np.clip(pull / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    share = np.where(
        square_norm - 2.0 * parameter * pull + parameter * parameter * square < square_norm,
        parameter,
        0.0,
    )[:, None]
    return newest + share * edge, np.stack(
        [
            np.where(share > 0.0, points, newest),
            np.where(share < 1.0, newest, points),
            np.where(share > 0.0, points, newest),
        ],
        axis=1,
    )


def _nearest(simplex: Array, newest: Array) -> tuple[Array, Array]:
    """Return the hull points (k, 3) nearest to the origin, and the active corners (k, 3, 3).

    Each hull has the three points of `simplex` (k, 3, 3), which may coincide, and the `newest`
    point (k, 3), which is always active. Columns after the three coordinates are interpolated with
    the same weights.
    """
    edges, origin = simplex - newest[:, None], columns(newest[:, :3])
    # axes: edge, component, row. All vertices, edges and faces with the newest point are evaluated
    # at once, because most calls have only a few simplices
    edge = np.ascontiguousarray(edges[:, :, :3].transpose(1, 2, 0))
    squares = _summed(edge.take(_FACTOR_A, axis=0) * edge.take(_FACTOR_B, axis=0))
    square = squares[:3]
    b = squares[3:]
    pull = -_summed(edge * origin)
    square_norm = _summed((origin * origin)[None])[0]
    shares, value = np.zeros((7, 3, len(newest))), np.empty((7, len(newest)))
    value[0] = square_norm
    with np.errstate(divide="ignore", invalid="ignore"):
        parameter = np.minimum(
            np.maximum(np.where(square > 0.0, pull / square, 0.0), 0.0), 1.0
        )  # np.clip is many times slower
        shares[_SIDE, _EDGE_IDS] = parameter
        value[1:4] = square_norm - 2.0 * parameter * pull + parameter * parameter * square
        a, c, pull_a, pull_c = (
            values.take(edge_ids, axis=0)
            for values in (square, pull)
            for edge_ids in (_FACE_EDGE_A, _FACE_EDGE_B)
        )
        wide = a * c - b * b
        share_a, share_b = (pull_a * c - pull_c * b) / wide, (pull_c * a - pull_a * b) / wide
        holds = (
            (wide > 1e-12 * a * c) & (share_a > 0.0) & (share_b > 0.0) & (share_a + share_b < 1.0)
        )
        shares[_FACE, _FACE_EDGE_A], shares[_FACE, _FACE_EDGE_B] = share_a, share_b
        value[4:] = np.where(holds, square_norm - share_a * pull_a - share_b * pull_c, np.inf)
        # for each edge, the normal of the face that the other two edges span
        one_way, other_way, back, other_back = edge.reshape(9, -1).take(_CROSS, axis=0)
        normal = one_way * other_way - back * other_back
        volume = _summed((edge[0] * normal[0])[None])[0]
        face_shares = -_summed(normal * origin) / volume
        inside = np.abs(volume) > 1e-12 * np.sqrt(square[0] * square[1] * square[2])
        inside &= (face_shares > 0.0).all(axis=0) & (
            face_shares[0] + face_shares[1] + face_shares[2] < 1.0
        )
    rows = np.arange(len(newest))
    share = shares[value.argmin(axis=0), :, rows]
    nearest_point = newest + np.einsum("ki,kij->kj", share, edges)
    nearest_point[inside, :3] = 0.0
    corners = np.concatenate([simplex, newest[:, None]], axis=1)
    weight = np.concatenate([share, 1.0 - share.sum(axis=1, keepdims=True)], axis=1)
    order = _SIMPLEX_CORNERS[(weight > 0.0) @ _CODE]
    return nearest_point, corners.reshape(-1, corners.shape[2]).take(
        4 * rows[:, None] + order, axis=0
    )


def _summed(products: Array) -> Array:
    """Sum the components of products (m, 3, k) to (m, k), in the order of `dots`."""
    total: Array = products[:, 0] + products[:, 2]
    total += products[:, 1]
    return total


PARALLEL = 1e-9  # squared sine of the angle up to which axes count as parallel


@dataclass(frozen=True, eq=False)
class PlacedCylinders:
    """A cylinder in k positions.

    start: (k, 3) centres of the first end, mm. axis: (k, 3) unit vectors. length, radius: mm.
    """

    start: Array
    axis: Array
    length: float
    radius: float

    def of(self, rows: Index) -> PlacedCylinders:
        """Return the cylinders of `rows`."""
        return PlacedCylinders(self.start[rows], self.axis[rows], self.length, self.radius)

    @property
    def solid(self) -> Frustum:
        """Return the cylinder as a frustum with the tip at `start`."""
        return Frustum(self.radius, 0.0, 0.0, self.length)


@dataclass(frozen=True)
class _Pairs:
    """The second cylinders as a `Hull` for `bounds`, relative to the starts of the first."""

    cylinders: PlacedCylinders

    def __len__(self) -> int:
        return len(self.cylinders.start)

    def __getitem__(self, rows: Index) -> _Pairs:
        return _Pairs(self.cylinders.of(rows))

    def farthest(self, direction: Array) -> Array:
        """Return the cylinder points (k, 3) farthest along directions (k, 3)."""
        points: Array = self.cylinders.start + self.cylinders.solid.farthest(
            direction, self.cylinders.axis
        )
        return points


def nearer(cylinders: PlacedCylinders, others_at: PlacedCylinders, gap: float) -> Mask:
    """Return whether pairs of cylinders are closer than a gap.

    Parameters
    ----------
    cylinders, others_at : PlacedCylinders
        Cylinders in k positions each.
    gap : float
        The gap, mm; must be positive.

    Returns
    -------
    (k,) bool array
        True for cylinders that are closer than the gap or meet.
    """
    distances = axes_apart(cylinders, others_at)
    are_nearer: Mask = distances < gap  # the axes are inside the cylinders
    doubtful = np.flatnonzero(~are_nearer & (distances < gap + cylinders.radius + others_at.radius))
    if len(doubtful):
        first_cylinders, second_cylinders = cylinders.of(doubtful), others_at.of(doubtful)
        adjacent = _Pairs(
            PlacedCylinders(
                second_cylinders.start - first_cylinders.start,
                second_cylinders.axis,
                second_cylinders.length,
                second_cylinders.radius,
            )
        )
        middle = adjacent.cylinders.start + 0.5 * second_cylinders.length * second_cylinders.axis
        start = first_cylinders.solid.nearest(middle, first_cylinders.axis) - middle
        # cylinders intersect if the midpoint of the second is inside the first
        inside = dots(start, start) <= CONVERGED**2
        are_nearer[doubtful[inside]] = True
        rows = np.flatnonzero(~inside)
        low, _ = bounds(
            first_cylinders.solid, first_cylinders.axis[rows], adjacent[rows], gap, gap, start[rows]
        )
        are_nearer[doubtful[rows]] = low < gap  # unresolved pairs count as near
    return are_nearer


def axes_apart(cylinders: PlacedCylinders, others_at: PlacedCylinders) -> Array:
    """Return the distances between the axes of cylinders.

    Parameters
    ----------
    cylinders, others_at : PlacedCylinders
        Cylinders in k positions each.

    Returns
    -------
    (k,) array
        Distances between the axis segments, mm.
    """
    off = cylinders.start - others_at.start
    lean = dots(cylinders.axis, others_at.axis)
    first_offset = dots(cylinders.axis, off)
    second_offset = dots(others_at.axis, off)
    square = 1.0 - lean * lean
    crossing = square > PARALLEL
    along = np.where(
        crossing, (lean * second_offset - first_offset) / np.where(crossing, square, 1.0), 0.0
    )
    along = np.minimum(
        np.maximum(along, 0.0), cylinders.length
    )  # np.clip is many times slower for few values
    along_other = np.minimum(np.maximum(lean * along + second_offset, 0.0), others_at.length)
    along = np.minimum(np.maximum(lean * along_other - first_offset, 0.0), cylinders.length)
    distances: Array = lengths(
        off + along[:, None] * cylinders.axis - along_other[:, None] * others_at.axis
    )
    return distances


def nearest(cylinders: PlacedCylinders, others_at: PlacedCylinders) -> tuple[Array, Array]:
    """Return the shortest vectors between cylinders.

    Parameters
    ----------
    cylinders, others_at : PlacedCylinders
        Cylinders in k positions each.

    Returns
    -------
    points : (k, 3) array
        Points of the second cylinders, mm.
    vectors : (k, 3) array
        Vectors from these points to the first cylinders; zero for pairs that meet.
    """
    adjacent = _Pairs(
        PlacedCylinders(
            others_at.start - cylinders.start, others_at.axis, others_at.length, others_at.radius
        )
    )
    middle = adjacent.cylinders.start + 0.5 * others_at.length * others_at.axis
    points, offsets = shortest_vectors(cylinders.solid, cylinders.axis, adjacent, middle)
    return cylinders.start + points, offsets
