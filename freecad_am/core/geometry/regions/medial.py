# SPDX-License-Identifier: LGPL-2.1-or-later
"""Centrelines of thin regions: paths on the medial axis, from a Voronoi diagram of border points.

A Voronoi vertex is equidistant from three border points, so the vertices inside follow the medial
axis. A Voronoi edge belongs to two border points. The spread of an edge is the distance between
these points relative to the diameter of the circle through both: 1 for an edge between two walls,
and small for an edge into a corner.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import chain
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import QhullError, Voronoi

from ...types import Array, Index, Mask
from ..curves.plane_curve import winding
from .region import Region, simplified
from .strip import Strip

MIN_WALL_SPREAD, MIN_SPREAD = 0.75, 0.3  # minimum spread of an edge of the axis
# of the region's size; random displacement of points. For points exactly on parallel lines or on a
# circle, the time grows with the square of their number, and Qhull may fail
MOVE_SHARE, LARGER_MOVE_SHARE = 1e-11, 1e-9
PLACES = 9  # decimals of mm; gaps with equal rounded corners share a cached spine
SHAPES = 512  # number of cached spines
JOIN_SHARE = 1e-8  # of the region's size; closer vertices differ only by the displacement


class _Axis(NamedTuple):
    """Medial axis: points (n, 2), clearance (n,) from the border, mm, links (m, 2), spread (m,)."""

    points: Array
    clearance: Array
    links: Index
    spread: Array


def spine(region: Region, min_clearance: float, step: float) -> tuple[Array, bool]:
    """Return the longest centreline path of a region where the region is wide enough.

    Parameters
    ----------
    region : Region
        The region, mm.
    min_clearance : float
        Minimum distance of the path from the border, mm.
    step : float
        Distance between samples of the border, mm.

    Returns
    -------
    path : (n, 2) array
        Points, mm; (0, 2) if the region is nowhere wide enough.
    closed : bool
        True if the path surrounds the only hole of a region.
    """
    borders = region.borders()
    origin = borders[0][0]
    shape = tuple(np.round(border - origin, PLACES).tobytes() for border in borders)
    path, closed = _spine(shape, min_clearance, step)
    return path + origin, closed


@lru_cache(maxsize=SHAPES)
def _spine(shape: tuple[bytes, ...], min_clearance: float, step: float) -> tuple[Array, bool]:
    """Return `spine` of borders given as bytes, cached: layers and islands have equal gaps."""
    borders = tuple(np.frombuffer(border).reshape(-1, 2) for border in shape)
    axis = _axis(borders, min_clearance, step)
    for spread in (MIN_WALL_SPREAD, MIN_SPREAD):
        links = axis.links[
            (axis.spread >= spread) & (axis.clearance[axis.links] >= min_clearance).all(axis=1)
        ]
        if not len(links):
            continue
        ring = _find_cycle(axis.points, links) if len(borders) > 1 else None
        if ring is not None:
            return axis.points[ring], True
        path = _find_longest_path(axis.points, links)
        length = float(np.hypot(*np.diff(axis.points[path], axis=0).T).sum())
        if spread == MIN_SPREAD or length > 2.0 * float(axis.clearance[path].max()):
            return axis.points[path], False
    return np.zeros((0, 2)), False


def spine_round(
    strip: Strip, min_clearance: float, step: float, chord_error: float, aside: float
) -> Array | None:
    """Return the centreline path once around an unrolled strip, from half a turn before 0 on.

    Parameters
    ----------
    strip : Strip
        The strip.
    min_clearance : float
        Minimum distance of the path from the borders, mm.
    step : float
        Distance between samples of the border, mm.
    chord_error : float
        Chord error, mm, for lines straight in (u, v) that become arcs when unrolled.
    aside : float
        Length beyond a turn to consider, mm, in addition to the width of the strip.

    Returns
    -------
    (n, 2) array or None
        Points on the unrolled plane, mm; None if the strip is too thin somewhere.
    """
    half = 0.5 * strip.period.u_period
    end = half + min(2.0 * (strip.levels[1] - strip.levels[0]) + aside, half)
    points, _ = spine(
        max(strip.between(-end, end), key=lambda region: region.area), min_clearance, step
    )
    points = points[::-1] if len(points) and points[0, 0] > points[-1, 0] else points
    if not len(points) or points[0, 0] > -half or points[-1, 0] < half:
        return None
    points = simplified(points, 0.2 * chord_error)
    v = np.interp(-half, points[:, 0], points[:, 1])
    within = points[(points[:, 0] > -half) & (points[:, 0] < half)]
    if not math.isinf(strip.period.apex):
        count = strip.period.points_round(0.5 * sum(strip.levels), chord_error, aside)
        u = np.union1d(within[:, 0], -half + strip.period.u_period / count * np.arange(1, count))
        within = np.stack([u, np.interp(u, points[:, 0], points[:, 1])], axis=1)
    return strip.period.from_uv(np.vstack([[[-half, v]], within]))


def _axis(borders: tuple[Array, ...], min_clearance: float, step: float) -> _Axis:
    """Return the medial axis with at least `min_clearance` mm, without branches into corners."""
    border_points, follows = _sample_border(borders, step)
    middle = border_points.mean(axis=0)
    size = max(float(np.hypot(*np.ptp(borders[0], axis=0))), 1e-300)
    scaled = (border_points - middle) / size
    moves = np.random.default_rng(0).uniform(-1.0, 1.0, scaled.shape)
    try:
        diagram = Voronoi(scaled + MOVE_SHARE * moves)
    except QhullError:
        diagram = Voronoi(scaled + LARGER_MOVE_SHARE * moves)
    corners = diagram.vertices * size + middle
    pairs = diagram.ridge_points
    ends = np.fromiter(
        chain.from_iterable(diagram.ridge_vertices), dtype=np.intp, count=2 * len(pairs)
    ).reshape(-1, 2)
    adjacent = (follows[pairs[:, 0]] == pairs[:, 1]) | (follows[pairs[:, 1]] == pairs[:, 0])
    use = (ends >= 0).all(axis=1)
    ends[use], is_long = _join_vertices(diagram.vertices, ends[use])
    use[use] = is_long
    use &= ~adjacent
    pairs, ends = pairs[use], ends[use]
    radius = np.hypot(*(corners[ends] - border_points[pairs[:, :1]]).transpose(2, 0, 1))
    pair_distance = np.hypot(*(border_points[pairs[:, 0]] - border_points[pairs[:, 1]]).T)
    spread = pair_distance / np.maximum(2.0 * radius.mean(axis=1), 1e-300)
    use = (spread >= MIN_SPREAD) & (radius >= min_clearance).all(
        axis=1
    )  # before the test for inside points, which takes the most time
    ends, radius, spread = ends[use], radius[use], spread[use]
    members = np.unique(ends)
    inside = np.zeros(len(corners), dtype=bool)
    inside[members] = winding(borders, corners[members]) > 0
    use = inside[ends].all(axis=1)
    ends = ends[use]
    clearance = np.zeros(len(corners))
    clearance[ends] = radius[use]
    return _Axis(corners, clearance, ends, spread[use])


def _join_vertices(vertices: Array, ends: Index) -> tuple[Index, Mask]:
    """Join vertices (n, 2) up to JOIN_SHARE apart; return the new edge ends (m, 2).

    Also return the mask of the longer edges.
    """
    is_long = np.hypot(*(vertices[ends[:, 0]] - vertices[ends[:, 1]]).T) > JOIN_SHARE
    joints = ends[~is_long]
    graph = coo_matrix((np.ones(len(joints)), joints.T), shape=(len(vertices), len(vertices)))
    label = connected_components(graph, directed=False)[1]
    first = np.unique(label, return_index=True)[1]
    return first[label[ends]], is_long


def _sample_border(rings: tuple[Array, ...], step: float) -> tuple[Array, Index]:
    """Return ring points at most `step` mm apart, with corners, and the index of each successor."""
    points, follows, start = [], [], 0
    for ring in rings:
        chord = np.roll(ring, -1, axis=0) - ring
        count = np.maximum(np.ceil(np.hypot(*chord.T) / step - 1e-9), 1.0).astype(np.intp)
        edge = np.repeat(np.arange(len(ring)), count)
        share = (np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)) / count[edge]
        points.append(ring[edge] + share[:, None] * chord[edge])
        follows.append(start + np.roll(np.arange(len(edge)), -1))
        start += len(edge)
    return np.vstack(points), np.concatenate(follows)


def _find_cycle(points: Array, links: Index) -> Index | None:
    """Return the ordered members of the only cycle in the graph; None without a unique cycle."""
    for _ in range(len(links)):
        degree = np.bincount(links.ravel(), minlength=len(points))
        keep = (degree[links] > 1).all(axis=1)
        if keep.all():
            break
        links = links[keep]
    if not len(links) or (np.bincount(links.ravel()) > 2).any():
        return None
    neighbours: dict[int, list[int]] = {}
    for a, b in links.tolist():
        neighbours.setdefault(a, []).append(b)
        neighbours.setdefault(b, []).append(a)
    path = [min(neighbours)]
    ahead = min(neighbours[path[0]])
    while ahead != path[0]:
        previous, current = path[-1], ahead
        path.append(current)
        ahead = next(
            (neighbour for neighbour in neighbours[current] if neighbour != previous), path[0]
        )
    return np.array(path) if len(path) == len(neighbours) else None


def _find_longest_path(points: Array, links: Index) -> Index:
    """Return the members of the longest shortest path in the graph, by two sweeps."""
    members, number = np.unique(links, return_inverse=True)
    number = number.reshape(-1, 2)
    size = np.hypot(*(points[links[:, 0]] - points[links[:, 1]]).T)
    graph = coo_matrix(
        (np.maximum(size, 1e-300), number.T), shape=(len(members), len(members))
    ).tocsr()
    count, label = connected_components(graph, directed=False)
    total = np.bincount(label[number[:, 0]], weights=size, minlength=count)
    start = int(np.flatnonzero(label == int(np.argmax(total)))[0])
    for _ in range(2):
        path_length = dijkstra(graph, directed=False, indices=np.array([start]))[0]
        path_length[~np.isfinite(path_length)] = -1.0
        start = int(np.argmax(path_length))
    path_length, predecessor = (
        rows[0]
        for rows in dijkstra(
            graph, directed=False, indices=np.array([start]), return_predecessors=True
        )
    )
    path_length[~np.isfinite(path_length)] = -1.0
    path = [int(np.argmax(path_length))]
    while path[-1] != start:
        path.append(int(predecessor[path[-1]]))
    return np.asarray(members[path[::-1]], dtype=np.intp)
