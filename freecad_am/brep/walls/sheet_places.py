# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the vertices of a sheet's mesh belong: on the surfaces of its faces, and on their common edges."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from freecad_am.core.types import Array, Index, Mask

from ...core.geometry.step_count import step_count
from ...core.geometry.walls.patch import SPLINE, Patch
from ...core.geometry.walls.surface import dot

STEPS = 8
NODE_MM = 1e-4  # mm between a vertex and the node of a tessellation that it came from
ASTRAY = 0.7  # of half an edge; its middle is not moved farther than this on a smooth surface


class Places:
    """Moves the new middles of edges onto their faces and edges, and keeps the parameters of all vertices on spline
    faces: where a surface comes near itself the nearest place may be the wrong one, so each is sought from its neighbours'.

    nodes: for each face the parameters (k, 2) of the first vertices (n, 3), in any order.
    """

    def __init__(
        self, shape: Any, patches: list[Patch], nodes: list[Array], vertices: Array, edge: float
    ) -> None:
        self.patches, self.curves = patches, _Curves(shape, edge)
        self.uv: dict[int, Array] = {}
        for k, patch in enumerate(patches):
            if patch.kind != SPLINE:
                continue
            self.uv[k] = np.full((len(vertices), 2), np.nan)
            if len(nodes[k]):
                off, near = cKDTree(patch.at(nodes[k])[0]).query(vertices)
                self.uv[k][off < NODE_MM] = nodes[k][near[off < NODE_MM]]

    def middles(self, points: Array, adjacent: Index, ends: Index) -> Array:
        """The middles (n, 3) of the edges between the vertices `ends` (n, 2), moved; they become the next vertices.

        adjacent: the faces (n, 2) on either side, -1 for none.
        """
        inner = adjacent[:, 0] == adjacent[:, 1]
        placed = points.copy()
        placed[~inner] = self.curves.nearest(points[~inner])
        for k in np.unique(adjacent[inner, 0]):
            mine = np.flatnonzero(inner & (adjacent[:, 0] == k))
            if k not in self.uv:
                placed[mine] = self.patches[k].at(self.patches[k].inverse(points[mine]))[0]
        for k, uv in self.uv.items():
            found = np.full((len(points), 2), np.nan)
            mine = np.flatnonzero((adjacent == k).any(axis=1))
            found[mine] = self._near(k, placed[mine], ends[mine], inner[mine])
            on_face = mine[inner[mine]]
            placed[on_face] = self.patches[k].at(found[on_face])[0]
            self.uv[k] = np.vstack([uv, found])
        return placed

    def _near(self, k: int, points: Array, ends: Index, inner: Mask) -> Array:
        """Parameters of the points on patch k, next to those of the ends of their edges; inner: which are to be moved."""
        patch, (one, other) = self.patches[k], (self.uv[k][ends[:, side]] for side in (0, 1))
        for axis, period in enumerate(patch.periods):
            if period > 0.0:
                other[:, axis] -= period * np.round((other[:, axis] - one[:, axis]) / period)
        start = 0.5 * (one + other)
        known = np.isfinite(start).all(axis=1)
        found = np.empty_like(start)
        found[known] = patch.inverse(points[known], start[known])
        half = 0.5 * np.linalg.norm(patch.at(one)[0] - patch.at(other)[0], axis=1)
        lost = ~known
        lost[known] = ~(
            np.linalg.norm(patch.at(found[known])[0] - points[known], axis=1) < ASTRAY * half[known]
        )
        found[lost] = patch.inverse(points[lost])
        # an edge across a narrow tube: the nearest place to its middle may be an end, and no halving would end
        tips = [patch.at(side[lost])[0] for side in (one, other)]
        farther = [
            np.max([np.linalg.norm(patch.at(place)[0] - tip, axis=1) for tip in tips], axis=0)
            for place in (found[lost], start[lost])
        ]
        halfway = (inner & known)[lost] & (farther[1] < farther[0])
        found[np.flatnonzero(lost)[halfway]] = start[lost][halfway]
        return found

    def parameters(self, k: int, vertices: Array, used: Index) -> Array:
        """Parameters (n, 2) on patch k of the vertices `used` (n,) of all vertices."""
        patch = self.patches[k]
        if k not in self.uv:
            return patch.inverse(vertices[used])
        found = self.uv[k][used]
        lost = ~np.isfinite(found).all(axis=1)
        found[lost] = patch.inverse(vertices[used[lost]])
        return found


class _Curves:
    """The edges of a shape as splines, for the nearest points on them."""

    def __init__(self, shape: Any, edge: float) -> None:
        self.splines, points, which, at = [], [], [], []
        for curve in shape.Edges:
            if curve.Degenerated or curve.Length < 1e-9:
                continue
            low, high = curve.ParameterRange
            count = min(step_count(4.0 * curve.Length, edge, 32), 4000) + 1
            t = np.linspace(low, high, count)
            own = np.array([tuple(curve.valueAt(one)) for one in t.tolist()])
            which.append(np.full(count, len(self.splines)))
            self.splines.append(CubicSpline(t, own))
            points.append(own)
            at.append(t)
        self.tree = cKDTree(np.vstack(points))
        self.which, self.at = np.concatenate(which), np.concatenate(at)

    def nearest(self, points: Array) -> Array:
        """Nearest points (n, 3) of all edges."""
        if not len(points):
            return points
        near = self.tree.query(points)[1]
        found = np.empty_like(points)
        for k in np.unique(self.which[near]):
            mine = self.which[near] == k
            spline, t, p = self.splines[k], self.at[near[mine]], points[mine]
            for _ in range(STEPS):
                place, slope, bend = (spline(t, order) for order in range(3))
                rate = dot(slope, slope)
                t = t + dot(p - place, slope) / np.maximum(rate - dot(p - place, bend), 0.1 * rate)
                t = np.clip(t, spline.x[0], spline.x[-1])
            found[mine] = spline(t)
        return found
