# SPDX-License-Identifier: LGPL-2.1-or-later
"""Polylines in the plane: area, winding number, nearest points, cuts by arc length."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...types import Array, Index, Mask
from ..step_count import step_counts

BLOCK_SIZE = 4_000_000  # pairs of points and edges per batch


class Nearest(NamedTuple):
    """Nearest points (n, 2) on a polyline; edges, edge fractions and distances (n,), mm."""

    points: Array
    edge: Index
    share: Array
    distance: Array


def doubled_area(ring: Array) -> float:
    """Return twice the area that a ring encloses.

    Parameters
    ----------
    ring : (n, 2) array
        Points, mm, first point not repeated.

    Returns
    -------
    float
        mm^2, positive for counter-clockwise rings.
    """
    x, y = (
        ring - ring[0]
    ).T.copy()  # with the first point as origin, the closing edge adds nothing
    return float(x[:-1] @ y[1:] - x[1:] @ y[:-1])


def length(points: Array, closed: bool) -> float:
    """Return the length of a polyline.

    Parameters
    ----------
    points : (n, 2) array
        Points, mm.
    closed : bool
        Whether the polyline is closed; the first point is not repeated.

    Returns
    -------
    float
        Length, mm.
    """
    return float(np.hypot(*steps(points, closed).T).sum())


def steps(points: Array, closed: bool) -> Array:
    """Return the edges of a polyline as vectors.

    Parameters
    ----------
    points : (n, 2) array
        The polyline.
    closed : bool
        Whether the polyline is closed.

    Returns
    -------
    (n, 2) or (n - 1, 2) array
        Vectors; one more for a closed polyline.
    """
    return np.roll(points, -1, axis=0) - points if closed else np.diff(points, axis=0)


def arcs(points: Array, closed: bool = False) -> Array:
    """Return the arc lengths of the points of a polyline.

    Parameters
    ----------
    points : (n, 2) array
        The polyline, mm.
    closed : bool, optional
        Whether the polyline is closed.

    Returns
    -------
    (n,) or (n + 1,) array
        Arc lengths, mm; the last value of a closed polyline is its total length.
    """
    return running_sums(np.hypot(*steps(points, closed).T))


def running_sums(lengths: Array) -> Array:
    """Return the running sums of lengths, beginning with 0.

    Parameters
    ----------
    lengths : (n,) array
        Lengths in any unit.

    Returns
    -------
    (n + 1,) array
        Sums in the unit of the lengths.
    """
    sums = np.zeros(len(lengths) + 1)
    np.cumsum(lengths, out=sums[1:])
    return sums


def sines(vectors: Array, references: Array) -> Array:
    """Return the sines of the angles from vectors to references.

    Parameters
    ----------
    vectors, references : (n, 2) array
        Vectors and references.

    Returns
    -------
    (n,) array
        Sines, positive if the reference is to the left.
    """
    cross = vectors[:, 0] * references[:, 1] - vectors[:, 1] * references[:, 0]
    return np.asarray(cross / np.maximum(np.hypot(*vectors.T) * np.hypot(*references.T), 1e-300))


def winding(rings: Sequence[Array], points: Array) -> Index:
    """Return the winding number of rings about points.

    Parameters
    ----------
    rings : sequence of (n, 2) array
        Rings, mm, first points not repeated.
    points : (k, 2) array
        mm.

    Returns
    -------
    (k,) array of int
        Sum over the rings; a counter-clockwise ring counts 1.
    """
    count = np.zeros(len(points), dtype=np.intp)
    for ring in rings:
        low, high = ring.min(axis=0), ring.max(axis=0)
        candidates = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
        if not len(candidates):  # true for most holes of a region if there are few points
            continue
        candidates = candidates[np.argsort(points[candidates, 1], kind="stable")]
        following = np.roll(ring, -1, axis=0)
        # points in the y range of an edge are consecutive in the order of y
        span = np.searchsorted(
            points[candidates, 1], np.sort(np.stack([ring[:, 1], following[:, 1]]), axis=0)
        )
        point_counts = span[1] - span[0]
        ends = np.cumsum(point_counts)
        for block in np.split(
            np.arange(len(ring)), np.flatnonzero(np.diff(ends // BLOCK_SIZE)) + 1
        ):
            edge = np.repeat(block, point_counts[block])
            row = candidates[
                np.arange(len(edge))
                - np.repeat(ends[block] - point_counts[block] - span[0][block], point_counts[block])
                + (ends[block[0]] - point_counts[block[0]])
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
    """Return the polyline points nearest to given points.

    Parameters
    ----------
    curve : (m, 2) array
        The polyline, mm.
    points : (k, 2) array
        The points, mm.
    closed : bool
        Whether the polyline is closed.

    Returns
    -------
    Nearest
        Nearest points, edges, fractions and distances.
    """
    step = steps(curve, closed)
    start = curve[: len(step)]
    square = np.maximum((step**2).sum(axis=1), 1e-300)
    size = max(BLOCK_SIZE // max(len(step), 1), 1)
    edges, shares = [], []
    for block in (points[k : k + size] for k in range(0, len(points), size)):
        x, y = block[:, :1] - start[:, 0], block[:, 1:] - start[:, 1]
        share = np.clip((x * step[:, 0] + y * step[:, 1]) / square, 0.0, 1.0)
        square_distance = (x - share * step[:, 0]) ** 2 + (y - share * step[:, 1]) ** 2
        best = np.argmin(square_distance, axis=1)
        edges.append(best)
        shares.append(share[np.arange(len(block)), best])
    edge = np.concatenate(edges) if edges else np.zeros(0, dtype=np.intp)
    fraction = np.concatenate(shares) if shares else np.zeros(0)
    feet = start[edge] + fraction[:, None] * step[edge]
    return Nearest(feet, edge, fraction, np.hypot(*(points - feet).T))


def nearest_among(lines: Sequence[tuple[Array, bool]], points: Array) -> tuple[Array, Array]:
    """Return the nearest points on several polylines.

    Parameters
    ----------
    lines : Sequence[tuple[Array, bool]]
        Points (m, 2) of each polyline and whether it is closed.
    points : (n, 2) array
        The points, mm.

    Returns
    -------
    feet : (n, 2) array
        Nearest points; the given points if there are no lines.
    distance : (n,) array
        Distances, mm; infinite if there are no lines.
    """
    feet, distance = points, np.full(len(points), np.inf)
    for line, closed in lines:
        candidate = nearest(line, points, closed)
        nearer = candidate.distance < distance
        feet = np.where(nearer[:, None], candidate.points, feet)
        distance = np.where(nearer, candidate.distance, distance)
    return feet, distance


def nearest_on_rings(
    rings: Sequence[Array], boxes: tuple[Array, Array], points: Array
) -> tuple[Array, Array]:
    """Return the nearest points on rings.

    Parameters
    ----------
    rings : sequence of Array
        Points (m, 2) of each ring, mm.
    boxes : tuple of (r, 2) array
        Lowest and highest coordinates of each ring.
    points : (n, 2) array
        The points, mm.

    Returns
    -------
    feet : (n, 2) array
        Nearest points, mm.
    distance : (n,) array
        Distances, mm.
    """
    low, high = boxes
    beyond = np.maximum(np.maximum(low - points[:, None], points[:, None] - high), 0.0)
    box_distance = np.hypot(beyond[..., 0], beyond[..., 1])
    ring_number = int(box_distance.sum(axis=0).argmin())
    first_distance = nearest(rings[ring_number], points, closed=True).distance
    is_candidate = (box_distance <= first_distance[:, None] * (1.0 + 1e-9)).any(
        axis=0
    )  # a ring is no nearer than its box
    is_candidate[ring_number] = True
    candidates = [
        nearest(ring, points, closed=True)
        for ring, is_near in zip(rings, is_candidate.tolist())
        if is_near
    ]
    distances = np.stack([ring_number.distance for ring_number in candidates])
    best, row = np.argmin(distances, axis=0), np.arange(len(points))
    return np.stack([ring_number.points for ring_number in candidates])[best, row], distances[
        best, row
    ]


def fractions(points: Array) -> Array:
    """Return the arc lengths of points as fractions of the polyline length.

    Parameters
    ----------
    points : (n, 2) array
        The open polyline.

    Returns
    -------
    (n,) array
        From 0 to 1.
    """
    s = arcs(points)
    return np.asarray(s / s[-1])


def divide_edges(points: Array, count: Index) -> tuple[Array, Mask]:
    """Divide each edge of an open polyline into equal parts.

    Parameters
    ----------
    points : (n, 2) or (n, 3) array
        The polyline.
    count : (n - 1,) int array
        Number of parts of each edge.

    Returns
    -------
    points : (m, 2) or (m, 3) array
        All points.
    original : (m,) bool array
        True for original points.
    """
    edge = np.repeat(np.arange(len(count)), count)
    number = np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)
    inner = points[edge] + (number / count[edge])[:, None] * np.diff(points, axis=0)[edge]
    return np.concatenate([inner, points[-1:]]), np.concatenate([number == 0, [True]])


def divided_by_step(points: Array, step: float) -> tuple[Array, Mask]:
    """Divide the edges of an open polyline down to a maximum length.

    Parameters
    ----------
    points : (n, 2) array
        The polyline, mm.
    step : float
        Maximum edge length, mm.

    Returns
    -------
    points : (m, 2) array
        All points.
    original : (m,) bool array
        True for original points.
    """
    lengths = np.hypot(*np.diff(points, axis=0).T)
    return divide_edges(points, step_counts(lengths, step))


def dense(ring: Array, step: float) -> Array:
    """Divide the edges of a ring down to a maximum length.

    Parameters
    ----------
    ring : (n, 2) array
        The ring, mm.
    step : float
        Maximum edge length, mm.

    Returns
    -------
    (m, 2) array
        Points of the ring.
    """
    return divided_by_step(np.vstack([ring, ring[:1]]), step)[0][:-1]


def start_at(ring: Array, point: Array) -> Array:
    """Start a ring at the position nearest to a point.

    Parameters
    ----------
    ring : (n, 2) array
        The ring, mm.
    point : (2,) array
        The point.

    Returns
    -------
    (m, 2) array
        Ring whose first point is the nearest position.
    """
    foot = nearest(ring, point[None], closed=True)
    edge, start = int(foot.edge[0]), foot.points[0]
    rotated = np.roll(ring, -(edge + 1), axis=0)
    close = 1e-9 * float(np.abs(steps(ring, True)[edge]).max())
    if np.abs(rotated[0] - start).max() <= close:
        return rotated
    if np.abs(rotated[-1] - start).max() <= close:
        return np.roll(rotated, 1, axis=0)
    return np.vstack([start[None], rotated])


def cut_at_length(points: Array, length: float) -> Array:
    """Return the beginning of an open polyline.

    Parameters
    ----------
    points : (n, 2) array
        The polyline, mm.
    length : float
        Length to keep, mm.

    Returns
    -------
    (m, 2) array
        Beginning of the polyline; all points if the polyline is shorter.
    """
    s = arcs(points)
    if length >= s[-1]:
        return points
    k = int(np.searchsorted(s, length, side="right"))
    share = (length - s[k - 1]) / max(s[k] - s[k - 1], 1e-300)
    end = points[k - 1] + share * (points[k] - points[k - 1])
    return np.vstack([points[:k], end[None]]) if share > 1e-9 else points[:k]


def shorten_end(points: Array, values: Array, by: float) -> tuple[Array, Array]:
    """Shorten a polyline at its end.

    Parameters
    ----------
    points : (n, 2) array
        The polyline, mm.
    values : (n,) array
        Values at the points.
    by : float
        Length to remove, mm.

    Returns
    -------
    points : (m, 2) array
        Shorter polyline; only the first point if nothing remains.
    values : (m,) array
        Values at the points, interpolated at the new end.
    """
    arc = arcs(points)
    end = arc[-1] - by
    if end <= 0.0:
        return points[:1], values[:1]
    keep = arc < end
    last = np.array([np.interp(end, arc, points[:, k]) for k in (0, 1)])
    return np.vstack([points[keep], last]), np.r_[values[keep], np.interp(end, arc, values)]


def rotate_points(points: Array, angle: float) -> Array:
    """Rotate points about the origin.

    Parameters
    ----------
    points : (..., 2) array
        Points.
    angle : float
        Angle, counter-clockwise, rad.

    Returns
    -------
    (..., 2) array
        Rotated points.
    """
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack(
        [points[..., 0] * cos - points[..., 1] * sin, points[..., 0] * sin + points[..., 1] * cos],
        axis=-1,
    )
