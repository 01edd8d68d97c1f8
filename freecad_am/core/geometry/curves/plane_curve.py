# SPDX-License-Identifier: LGPL-2.1-or-later
"""Polylines in the plane: area, winding number, nearest places, cuts by arc length."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...types import Array, Index, Mask
from ..step_count import step_counts

AT_ONCE = 4_000_000  # pairs of points and edges


class Nearest(NamedTuple):
    """Places (n, 2) on a polyline, their edges (n,), shares along those (n,) and distances (n,) mm."""

    points: Array
    edge: Index
    share: Array
    distance: Array


def doubled_area(ring: Array) -> float:
    """Twice the area (mm^2) a ring (n, 2) encloses, positive when it runs counter-clockwise."""
    x, y = (
        ring - ring[0]
    ).T.copy()  # the first point is the origin: the edge back to it adds nothing
    return float(x[:-1] @ y[1:] - x[1:] @ y[:-1])


def length(points: Array, closed: bool) -> float:
    """mm."""
    return float(np.hypot(*steps(points, closed).T).sum())


def steps(points: Array, closed: bool) -> Array:
    """Edges of a polyline as vectors, (n, 2) when closed and (n - 1, 2) when open."""
    return np.roll(points, -1, axis=0) - points if closed else np.diff(points, axis=0)


def arcs(points: Array, closed: bool = False) -> Array:
    """How far (n,) mm along a polyline (n, 2) its points are; (n + 1,) of a closed one, whose last is its first again."""
    return np.asarray(np.r_[0.0, np.cumsum(np.hypot(*steps(points, closed).T))])


def sines(vectors: Array, others: Array) -> Array:
    """Sines (n,) of the angles from vectors (n, 2) to others (n, 2): positive for those to the left."""
    cross = vectors[:, 0] * others[:, 1] - vectors[:, 1] * others[:, 0]
    return np.asarray(cross / np.maximum(np.hypot(*vectors.T) * np.hypot(*others.T), 1e-300))


def winding(rings: Sequence[Array], points: Array) -> Index:
    """How often rings (n, 2) go round each of points (k, 2), counted with their sense."""
    count = np.zeros(len(points), dtype=np.intp)
    for ring in rings:
        low, high = ring.min(axis=0), ring.max(axis=0)
        near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
        if not len(near):  # most holes of a region, of a few places
            continue
        near = near[np.argsort(points[near, 1], kind="stable")]
        following = np.roll(ring, -1, axis=0)
        # the points that an edge is beside are neighbours in the order of y
        span = np.searchsorted(
            points[near, 1], np.sort(np.stack([ring[:, 1], following[:, 1]]), axis=0)
        )
        many = span[1] - span[0]
        ends = np.cumsum(many)
        for some in np.split(np.arange(len(ring)), np.flatnonzero(np.diff(ends // AT_ONCE)) + 1):
            edge = np.repeat(some, many[some])
            row = near[
                np.arange(len(edge))
                - np.repeat(ends[some] - many[some] - span[0][some], many[some])
                + (ends[some[0]] - many[some[0]])
            ]
            a, b = ring[edge], following[edge]
            side = (b[:, 0] - a[:, 0]) * (points[row, 1] - a[:, 1]) - (points[row, 0] - a[:, 0]) * (
                b[:, 1] - a[:, 1]
            )
            up = a[:, 1] < b[:, 1]
            turned = np.where(up, (side > 0.0).astype(int), -(side < 0.0).astype(int))
            count += np.bincount(row, weights=turned, minlength=len(count)).astype(np.intp)
    return count


def nearest(curve: Array, points: Array, closed: bool) -> Nearest:
    """The places of a polyline (m, 2) nearest to points (k, 2)."""
    way = steps(curve, closed)
    start = curve[: len(way)]
    square = np.maximum((way**2).sum(axis=1), 1e-300)
    size = max(AT_ONCE // max(len(way), 1), 1)
    edges, shares = [], []
    for some in (points[k : k + size] for k in range(0, len(points), size)):
        x, y = some[:, :1] - start[:, 0], some[:, 1:] - start[:, 1]
        share = np.clip((x * way[:, 0] + y * way[:, 1]) / square, 0.0, 1.0)
        away = (x - share * way[:, 0]) ** 2 + (y - share * way[:, 1]) ** 2
        best = np.argmin(away, axis=1)
        edges.append(best)
        shares.append(share[np.arange(len(some)), best])
    edge = np.concatenate(edges) if edges else np.zeros(0, dtype=np.intp)
    part = np.concatenate(shares) if shares else np.zeros(0)
    place = start[edge] + part[:, None] * way[edge]
    return Nearest(place, edge, part, np.hypot(*(points - place).T))


def nearest_among(lines: Sequence[tuple[Array, bool]], points: Array) -> tuple[Array, Array]:
    """The places (n, 2) on polylines (points (m, 2), whether closed) nearest to points (n, 2), and how far (n,) mm they are;
    the points themselves, infinitely far, where there are no lines."""
    places, distance = points, np.full(len(points), np.inf)
    for line, closed in lines:
        found = nearest(line, points, closed)
        nearer = found.distance < distance
        places, distance = (
            np.where(nearer[:, None], found.points, places),
            np.where(nearer, found.distance, distance),
        )
    return places, distance


def nearest_of(
    rings: Sequence[Array], boxes: tuple[Array, Array], points: Array
) -> tuple[Array, Array]:
    """The places (n, 2) on rings nearest to points (n, 2), and how far they are (n,), mm. boxes: lowest and highest
    coordinates (r, 2) of each ring."""
    low, high = boxes
    beyond = np.maximum(np.maximum(low - points[:, None], points[:, None] - high), 0.0)
    least = np.hypot(beyond[..., 0], beyond[..., 1])
    one = int(least.sum(axis=0).argmin())
    first = nearest(rings[one], points, closed=True).distance
    near = (least <= first[:, None] * (1.0 + 1e-9)).any(
        axis=0
    )  # no place of others is nearer than their box
    near[one] = True
    found = [
        nearest(ring, points, closed=True) for ring, is_near in zip(rings, near.tolist()) if is_near
    ]
    away = np.stack([one.distance for one in found])
    best, row = np.argmin(away, axis=0), np.arange(len(points))
    return np.stack([one.points for one in found])[best, row], away[best, row]


def fractions(points: Array) -> Array:
    """How far (n,) along an open polyline (n, 2) its points are, of its length."""
    way = arcs(points)
    return np.asarray(way / way[-1])


def divided(points: Array, count: Index) -> tuple[Array, Mask]:
    """An open polyline (n, 2), or (n, 3) in space, with its edges in so many (n - 1,) equal parts each, and which points (m,)
    it had before."""
    edge = np.repeat(np.arange(len(count)), count)
    number = np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)
    inner = points[edge] + (number / count[edge])[:, None] * np.diff(points, axis=0)[edge]
    return np.vstack([inner, points[-1:]]), np.r_[number == 0, True]


def divided_by_step(points: Array, step: float) -> tuple[Array, Mask]:
    """An open polyline (n, 2) with points at most `step` mm apart, and which points (m,) it had before."""
    lengths = np.hypot(*np.diff(points, axis=0).T)
    return divided(points, step_counts(lengths, step))


def dense(ring: Array, step: float) -> Array:
    """A ring (n, 2) with points at most `step` mm apart."""
    return divided_by_step(np.vstack([ring, ring[:1]]), step)[0][:-1]


def begun_at(ring: Array, point: Array) -> Array:
    """A ring (n, 2) that begins where it is nearest to a point (2,); that place becomes one of its points."""
    found = nearest(ring, point[None], closed=True)
    edge, place = int(found.edge[0]), found.points[0]
    rest = np.roll(ring, -(edge + 1), axis=0)
    close = 1e-9 * float(np.abs(steps(ring, True)[edge]).max())
    if np.abs(rest[0] - place).max() <= close:
        return rest
    if np.abs(rest[-1] - place).max() <= close:
        return np.roll(rest, 1, axis=0)
    return np.vstack([place[None], rest])


def up_to(points: Array, way: float) -> Array:
    """The first `way` mm of an open polyline (n, 2)."""
    at = np.r_[0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T))]
    if way >= at[-1]:
        return points
    k = int(np.searchsorted(at, way, side="right"))
    share = (way - at[k - 1]) / max(at[k] - at[k - 1], 1e-300)
    end = points[k - 1] + share * (points[k] - points[k - 1])
    return np.vstack([points[:k], end[None]]) if share > 1e-9 else points[:k]


def turned(points: Array, angle: float) -> Array:
    """Points (..., 2) turned about the origin by an angle, rad."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack(
        [points[..., 0] * cos - points[..., 1] * sin, points[..., 0] * sin + points[..., 1] * cos],
        axis=-1,
    )
