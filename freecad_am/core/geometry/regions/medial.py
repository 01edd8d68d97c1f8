# SPDX-License-Identifier: LGPL-2.1-or-later
"""The middle of thin regions: paths along the medial axis, from the Voronoi diagram of places on the border.

A Voronoi vertex is equally far from three places of the border, so that those inside follow the medial axis. An edge between
two of them belongs to two places of the border; how far these are apart, compared with the circle that touches both, is 1
where the edge runs between two walls and small where it runs into a corner.
"""

from __future__ import annotations

import math
from itertools import chain
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import QhullError, Voronoi

from ...types import Array, Index
from ..curves.plane_curve import winding
from .region import Region, simplified
from .strip import Strip

BETWEEN_WALLS, ANYWHERE = 0.75, 0.3  # least spread of an edge of the axis
# places, beyond which they are moved by so much of the region's size: the diagram of many on parallel lines or a circle,
# exactly, takes a time that grows with more than their square
MANY, MOVED = 12_000, 1e-9


class _Axis(NamedTuple):
    """points (n, 2), clearance (n,) mm from the border, links (m, 2) between points and their spread (m,)."""

    points: Array
    clearance: Array
    links: Index
    spread: Array


def spine(region: Region, least: float, step: float) -> tuple[Array, bool]:
    """The longest path (n, 2) in the middle of a region where it is wider than 2 `least` mm, and whether it is closed.

    step: mm between places on the border. A region with a single hole that the axis goes round has a closed path. Empty,
    (0, 2), where the region is nowhere that wide.
    """
    axis = _axis(region, least, step)
    for spread in (BETWEEN_WALLS, ANYWHERE):
        links = axis.links[
            (axis.spread >= spread) & (axis.clearance[axis.links] >= least).all(axis=1)
        ]
        if not len(links):
            continue
        ring = _cycle(axis.points, links) if len(region.borders()) > 1 else None
        if ring is not None:
            return axis.points[ring], True
        path = _longest(axis.points, links)
        way = float(np.hypot(*np.diff(axis.points[path], axis=0).T).sum())
        if spread == ANYWHERE or way > 2.0 * float(axis.clearance[path].max()):
            return axis.points[path], False
    return np.zeros((0, 2)), False


def spine_round(
    strip: Strip, least: float, step: float, chord_error: float, aside: float
) -> Array | None:
    """The path (n, 2) once round in the middle of a strip, laid flat, from half a turn before 0 on; None where the strip is
    somewhere thinner than 2 `least` mm. step: as of `spine`. chord_error: mm, of what is straight in (u, v) and an arc when
    laid flat. aside: mm that are looked at beyond a turn, beside the breadth of the strip."""
    half = 0.5 * strip.period.around
    end = half + min(2.0 * (strip.levels[1] - strip.levels[0]) + aside, half)
    points, _ = spine(max(strip.between(-end, end), key=lambda part: part.area), least, step)
    points = points[::-1] if len(points) and points[0, 0] > points[-1, 0] else points
    if not len(points) or points[0, 0] > -half or points[-1, 0] < half:
        return None
    points = simplified(points, 0.2 * chord_error)
    v = np.interp(-half, points[:, 0], points[:, 1])
    within = points[(points[:, 0] > -half) & (points[:, 0] < half)]
    if not math.isinf(strip.period.apex):
        count = strip.period.points_round(0.5 * sum(strip.levels), chord_error, aside)
        u = np.union1d(within[:, 0], -half + strip.period.around / count * np.arange(1, count))
        within = np.stack([u, np.interp(u, points[:, 0], points[:, 1])], axis=1)
    return strip.period.unroll(np.vstack([[[-half, v]], within]))


def _axis(region: Region, least: float, step: float) -> _Axis:
    """The axis inside of a region where it is wider than 2 `least` mm, without what runs into corners."""
    places, follows = _places(region.borders(), step)
    middle, size = places.mean(axis=0), max(region.extent, 1e-300)
    scaled = (places - middle) / size
    moved = scaled + MOVED * np.random.default_rng(0).uniform(-1.0, 1.0, scaled.shape)
    try:
        diagram = Voronoi(moved if len(scaled) > MANY else scaled)
    except QhullError:  # places exactly on lines and circles may be more than it can tell apart
        diagram = Voronoi(moved)
    corners = diagram.vertices * size + middle
    pairs = diagram.ridge_points
    ends = np.fromiter(
        chain.from_iterable(diagram.ridge_vertices), dtype=np.intp, count=2 * len(pairs)
    ).reshape(-1, 2)
    adjacent = (follows[pairs[:, 0]] == pairs[:, 1]) | (follows[pairs[:, 1]] == pairs[:, 0])
    use = (ends >= 0).all(axis=1) & ~adjacent
    pairs, ends = pairs[use], ends[use]
    away = np.hypot(*(corners[ends] - places[pairs[:, :1]]).transpose(2, 0, 1))
    apart = np.hypot(*(places[pairs[:, 0]] - places[pairs[:, 1]]).T)
    spread = apart / np.maximum(2.0 * away.mean(axis=1), 1e-300)
    use = (spread >= ANYWHERE) & (away >= least).all(
        axis=1
    )  # before it is asked what is inside, which takes longest
    ends, away, spread = ends[use], away[use], spread[use]
    members = np.unique(ends)
    inside = np.zeros(len(corners), dtype=bool)
    inside[members] = winding(region.borders(), corners[members]) > 0
    use = inside[ends].all(axis=1)
    ends = ends[use]
    clearance = np.zeros(len(corners))
    clearance[ends] = away[use]
    return _Axis(corners, clearance, ends, spread[use])


def _places(rings: tuple[Array, ...], step: float) -> tuple[Array, Index]:
    """Places on the rings at most `step` mm apart, corners among them, and the number of the one that follows each."""
    places, follows, first = [], [], 0
    for ring in rings:
        way = np.roll(ring, -1, axis=0) - ring
        count = np.maximum(np.ceil(np.hypot(*way.T) / step - 1e-9), 1.0).astype(np.intp)
        edge = np.repeat(np.arange(len(ring)), count)
        share = (np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)) / count[edge]
        places.append(ring[edge] + share[:, None] * way[edge])
        follows.append(first + np.roll(np.arange(len(edge)), -1))
        first += len(edge)
    return np.vstack(places), np.concatenate(follows)


def _cycle(points: Array, links: Index) -> Index | None:
    """The members in order of the only closed path in the graph; None where there is none, or more."""
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
        before, here = path[-1], ahead
        path.append(here)
        ahead = next((other for other in neighbours[here] if other != before), path[0])
    return np.array(path) if len(path) == len(neighbours) else None


def _longest(points: Array, links: Index) -> Index:
    """The members of the longest of the shortest paths, as two sweeps find it."""
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
        away = dijkstra(graph, directed=False, indices=np.array([start]))[0]
        away[~np.isfinite(away)] = -1.0
        start = int(np.argmax(away))
    away, before = (
        rows[0]
        for rows in dijkstra(
            graph, directed=False, indices=np.array([start]), return_predecessors=True
        )
    )
    away[~np.isfinite(away)] = -1.0
    path = [int(np.argmax(away))]
    while path[-1] != start:
        path.append(int(before[path[-1]]))
    return np.asarray(members[path[::-1]], dtype=np.intp)
