# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether points are inside closed bodies: by the triangles that a ray from each point crosses.

Where all triangles of a body face one way, a point is inside where the ray leaves the body more often than it enters it:
shells that overlap add up, cavities count as outside. Where some are turned over, an odd number of crossings decides. A
body whose triangles leave an opening has no inside.
"""

from __future__ import annotations

import numpy as np

from ..geometry.obstacles import Body
from ..types import Array, Mask
from . import tree

# of all rays; along no edge or face that anyone draws, so that none runs through an edge but by chance
RAY = np.array([0.5423261, 0.3190717, 0.7772039])
MERGED = 1e-6  # mm; vertices that lie closer are one
QUERIES = 16384  # worked on at once


class Inside:
    """The inside of one closed body. low, high: (3,) mm, the box about it."""

    def __init__(self, body: Body, faces_one_way: bool) -> None:
        corners = body.corners()
        corners = corners[tree.packed(corners.mean(axis=1))]
        self.low, self.high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        self._faces_one_way = faces_one_way
        # as seen along the ray: across it (m, 3, 2), and along it (m, 3)
        ray = RAY / np.linalg.norm(RAY)
        one = np.cross(ray, [1.0, 0.0, 0.0])
        one /= np.linalg.norm(one)
        self._frame = np.stack([one, np.cross(ray, one), ray])
        self._seen = corners @ self._frame.T
        self._levels = [self._boxes(size) for size in tree.sizes(len(corners))]

    def _boxes(self, size: int) -> tuple[Array, Array]:
        """Lowest and highest places (3, k), as seen along the ray, of so many triangles each."""
        starts = np.arange(0, len(self._seen), size)
        low, high = (
            np.minimum.reduceat(self._seen.min(axis=1), starts),
            np.maximum.reduceat(self._seen.max(axis=1), starts),
        )
        return np.ascontiguousarray(low.T), np.ascontiguousarray(high.T)

    def holds(self, points: Array) -> Mask:
        """Whether points (n, 3) are inside; on the surface itself it may be either."""
        found = np.zeros(len(points), dtype=bool)
        some = np.flatnonzero(self.may_hold(points))
        for part in np.split(some, np.arange(QUERIES, len(some), QUERIES)):
            found[part] = self._held(points[part] @ self._frame.T)
        return found

    def may_hold(self, points: Array) -> Mask:
        """Whether points (n, 3) are in the box about it; axis by axis, in a fraction of the time of a reduction."""
        found: Mask = np.ones(len(points), dtype=bool)
        for at, low, high in zip(points.T, self.low, self.high):
            found &= (at > low) & (at < high)
        return found

    def _held(self, seen: Array) -> Mask:
        x, y, z = np.ascontiguousarray(seen.T)
        top = self._levels[-1][0].shape[1]
        query, node = np.repeat(np.arange(len(seen)), top), np.tile(np.arange(top), len(seen))
        for depth in range(len(self._levels) - 1, -1, -1):
            low, high = self._levels[depth]
            # one side of the boxes after the other: each leaves fewer to be looked at
            for at, bounds, before in (
                (x, high[0], True),
                (x, low[0], False),
                (y, high[1], True),
                (y, low[1], False),
                (z, high[2], True),
            ):
                near = at[query] <= bounds[node] if before else at[query] >= bounds[node]
                query, node = query[near], node[near]
            if depth:
                query, node = tree.below(query, node, self._levels[depth - 1][0].shape[1])
        corners = self._seen[node]
        a, b, c = (
            (corners[:, k, 0] - x[query], corners[:, k, 1] - y[query], corners[:, k, 2] - z[query])
            for k in range(3)
        )
        # twice the areas of the ray's end with each edge: the shares of the corners opposite
        of_a, of_b, of_c = (u[0] * v[1] - u[1] * v[0] for u, v in ((b, c), (c, a), (a, b)))
        way = np.where((of_a >= 0.0) & (of_b >= 0.0) & (of_c >= 0.0), 1, 0) - np.where(
            (of_a < 0.0) & (of_b < 0.0) & (of_c < 0.0), 1, 0
        )
        crossed = (way != 0) & ((of_a * a[2] + of_b * b[2] + of_c * c[2]) * way > 0.0)
        query, way = query[crossed], way[crossed]
        if self._faces_one_way:
            out: Mask = np.bincount(query, weights=way, minlength=len(seen)) != 0.0
            return out
        odd: Mask = np.bincount(query, minlength=len(seen)) % 2 == 1
        return odd


def inside_of(body: Body) -> Inside | None:
    """The inside of a body; None where its triangles leave an opening, or are none."""
    if not len(body.triangles):
        return None
    _, first = np.unique(
        np.round(body.vertices / MERGED).astype(np.int64), axis=0, return_inverse=True
    )
    corners = first.ravel()[body.triangles]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    edges = edges[edges[:, 0] != edges[:, 1]]
    forward = np.where(edges[:, 0] < edges[:, 1], 1, -1)
    _, edge = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    edge = edge.ravel()
    if (np.bincount(edge) % 2).any():
        return None
    return Inside(body, bool((np.bincount(edge, weights=forward) == 0.0).all()))
