# SPDX-License-Identifier: LGPL-2.1-or-later
"""Point-in-body tests for closed bodies: count the triangles that a ray from each point crosses.

If all triangles of a body are consistently oriented, a point is inside where the ray leaves the
body more often than it enters the body. Overlapping shells add up, and cavities count as outside.
If some triangles are reversed, an odd number of crossings decides. An open body has no inside.
"""

from __future__ import annotations

import numpy as np

from ..geometry.obstacles import Body
from ..types import Array, Mask
from . import tree

# direction of all rays; not parallel to usual edges and faces, so rays rarely hit an edge
RAY = np.array([0.5423261, 0.3190717, 0.7772039])
MERGED = 1e-6  # mm; vertices closer than this are merged
QUERIES = 16384  # points per batch


class Inside:
    """The inside of a closed body. low, high: (3,) corners of its bounding box, mm."""

    def __init__(self, body: Body, faces_one_way: bool) -> None:
        corners = body.corners()
        corners = corners[tree.packed(corners.mean(axis=1))]
        self.low, self.high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        self._faces_one_way = faces_one_way
        # corners in the ray frame: two coordinates across the ray, one along the ray
        ray = RAY / np.linalg.norm(RAY)
        across = np.cross(ray, [1.0, 0.0, 0.0])
        across /= np.linalg.norm(across)
        self._frame = np.stack([across, np.cross(ray, across), ray])
        self._seen = corners @ self._frame.T
        self._levels = [self._boxes(size) for size in tree.sizes(len(corners))]

    def _boxes(self, size: int) -> tuple[Array, Array]:
        """Return the ray-frame bounds (3, k) of groups of `size` triangles."""
        starts = np.arange(0, len(self._seen), size)
        low = np.minimum.reduceat(self._seen.min(axis=1), starts)
        high = np.maximum.reduceat(self._seen.max(axis=1), starts)
        return np.ascontiguousarray(low.T), np.ascontiguousarray(high.T)

    def holds(self, points: Array) -> Mask:
        """Return whether points are inside.

        Parameters
        ----------
        points : (n, 3) array
            Points in the frame of the body, mm.

        Returns
        -------
        (n,) array of bool
            True inside; undefined on the surface.
        """
        inside = np.zeros(len(points), dtype=bool)
        candidates = np.flatnonzero(self.may_hold(points))
        for rows in np.split(candidates, np.arange(QUERIES, len(candidates), QUERIES)):
            inside[rows] = self._test_inside(points[rows] @ self._frame.T)
        return inside

    def may_hold(self, points: Array) -> Mask:
        """Return whether points are in the bounding box of the body.

        Axis by axis, this takes a fraction of the time of a reduction.

        Parameters
        ----------
        points : (n, 3) array
            Points in the frame of the body, mm.

        Returns
        -------
        (n,) array of bool
            False on the faces of the box.
        """
        in_box: Mask = np.ones(len(points), dtype=bool)
        for coordinate, low, high in zip(points.T, self.low, self.high):
            in_box &= (coordinate > low) & (coordinate < high)
        return in_box

    def _test_inside(self, ray_points: Array) -> Mask:
        x, y, z = np.ascontiguousarray(ray_points.T)
        top = self._levels[-1][0].shape[1]
        query = np.repeat(np.arange(len(ray_points)), top)
        node = np.tile(np.arange(top), len(ray_points))
        for depth in range(len(self._levels) - 1, -1, -1):
            low, high = self._levels[depth]
            # one box side at a time: each test leaves fewer pairs
            for coordinate, bounds, below_high in (
                (x, high[0], True),
                (x, low[0], False),
                (y, high[1], True),
                (y, low[1], False),
                (z, high[2], True),
            ):
                in_bounds = (
                    coordinate[query] <= bounds[node]
                    if below_high
                    else coordinate[query] >= bounds[node]
                )
                query, node = query[in_bounds], node[in_bounds]
            if depth:
                query, node = tree.below(query, node, self._levels[depth - 1][0].shape[1])
        corners = self._seen[node]
        a, b, c = (
            (corners[:, k, 0] - x[query], corners[:, k, 1] - y[query], corners[:, k, 2] - z[query])
            for k in range(3)
        )
        # doubled areas between the ray and each edge: barycentric weights of opposite corners
        of_a, of_b, of_c = (u[0] * v[1] - u[1] * v[0] for u, v in ((b, c), (c, a), (a, b)))
        sense = np.where((of_a >= 0.0) & (of_b >= 0.0) & (of_c >= 0.0), 1, 0) - np.where(
            (of_a < 0.0) & (of_b < 0.0) & (of_c < 0.0), 1, 0
        )
        crossed = (sense != 0) & ((of_a * a[2] + of_b * b[2] + of_c * c[2]) * sense > 0.0)
        query, sense = query[crossed], sense[crossed]
        if self._faces_one_way:
            out: Mask = np.bincount(query, weights=sense, minlength=len(ray_points)) != 0.0
            return out
        odd: Mask = np.bincount(query, minlength=len(ray_points)) % 2 == 1
        return odd


def inside_of(body: Body) -> Inside | None:
    """Return the inside of a body; None if the body is open or has no triangles."""
    if not len(body.triangles):
        return None
    _, merged_ids = np.unique(
        np.round(body.vertices / MERGED).astype(np.int64), axis=0, return_inverse=True
    )
    corners = merged_ids.ravel()[body.triangles]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    edges = edges[edges[:, 0] != edges[:, 1]]
    forward = np.where(edges[:, 0] < edges[:, 1], 1, -1)
    _, edge = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    edge = edge.ravel()
    if (np.bincount(edge) % 2).any():
        return None
    return Inside(body, bool((np.bincount(edge, weights=forward) == 0.0).all()))
