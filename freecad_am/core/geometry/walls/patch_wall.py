# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wall of any connected smooth pieces on a substrate: exact pieces, a mesh over all of them, where it starts and ends."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...issues import Issue
from ...types import Array, Index, Mask
from ..curves.space_curve import SpaceCurve
from ..mesh.edge_runs import tangents
from ..mesh.triangle_mesh import Mesh
from ..mesh.triangles import closest
from ..obstacles import Body
from .part_depths import PartDepths
from .patch import TORUS, Patch
from .surface import dot

NEAREST = 8  # triangles, by their middles, among which the nearest one of a point is sought


@dataclass(frozen=True, eq=False)
class FirstCurve:
    """A loop or chain in which layers start.

    points: (k, 3) mm; a closed one does not repeat its first point. into, out: (k, 3) unit tangents where the curve arrives
    at and leaves each point; they differ at corners alone.
    """

    points: Array
    into: Array
    out: Array
    closed: bool

    def curve(self) -> SpaceCurve:
        """The curve through the points."""
        points, into, out = self.points, self.into, self.out
        if self.closed:
            points, into, out = (np.vstack([column, column[:1]]) for column in (points, into, out))
        chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
        bow = np.arccos(
            np.clip(dot(out[:-1], into[1:]), -1.0, 1.0)
        )  # the arcs are about circular: as long as they are
        w = np.r_[0.0, np.cumsum(chord / np.sinc(0.5 * np.minimum(bow, 1.0) / np.pi))]
        return SpaceCurve(w, points, into, out, self.closed)


@dataclass(frozen=True, eq=False)
class Rim:
    """A stretch of the wall's boundary, without corners.

    points: (k, 3) mm, at every vertex of the mesh; a closed one repeats its first point. end: True where layers finish, at
    an upper edge; False for a side (an end of a first curve lies on it), for the edge of an opening around which layers
    run on, and for what lies on or in the substrate.
    """

    points: Array
    end: bool

    @property
    def closed(self) -> bool:
        """Whether it is a loop."""
        return bool((self.points[0] == self.points[-1]).all())


@dataclass(frozen=True, eq=False)
class PatchWall:
    """A wall in part coordinates, mm.

    vertices (n, 3) on the wall and triangles (m, 3), counter-clockwise seen from the wall's outer side, of the whole wall.
    patch: (m,) the number in `patches` of each triangle's own; uv: (m, 3, 2) the parameters of its corners there.
    first: where layers start. behind: (n,) True for vertices on the substrate's side of that, which are not deposited.
    surroundings: bodies to keep the nozzle clear of, the substrate first. depths: how the part lies about the wall.
    ground: mm along Z of the plane that it stands on, through its lowest place, where nothing carries it but the platform.
    """

    vertices: Array
    triangles: Index
    patch: Index
    uv: Array
    patches: tuple[Patch, ...]
    first: tuple[FirstCurve, ...]
    behind: Mask
    rims: tuple[Rim, ...]
    label: str = "wall"
    faces: tuple[str, ...] = ()
    issues: tuple[Issue, ...] = ()
    surroundings: tuple[Body, ...] = ()
    depths: PartDepths | None = None
    ground: float | None = None

    @property
    def frame(self) -> Array:
        """(4, 4) the wall's own frame in part coordinates: that of the part, raised to what the wall stands on."""
        frame = np.eye(4)
        frame[2, 3] = 0.0 if self.ground is None else self.ground
        return frame

    @property
    def symmetry_normal(self) -> Array | None:
        """Unit normal (3,) of the plane of the bend of a torus that closes around; other walls are not known to have one."""
        whole = (
            len(self.patches) == 1
            and self.patches[0].kind == TORUS
            and all(rim.closed for rim in self.rims)
        )
        return np.array(self.patches[0].frame[:3, 2]) if whole else None

    @property
    def mesh_vertices(self) -> int:
        """How many vertices the mesh has that stands for it; 0 of exact pieces."""
        return 0

    @property
    def folds(self) -> float:
        """Length of places, mm, at which it bends more sharply than its mesh can follow; exact pieces have none."""
        return 0.0

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh, for level lines."""
        return Mesh(self.vertices, self.triangles)

    def project(self, points: Array) -> tuple[Array, Array]:
        """Nearest points of the wall and unit normals to its outer side, each (k, 3); beyond an edge of the wall those of
        the surface that ends there."""
        points, normals, _ = self.located(points)
        return points, normals

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """As `project`, and the number of the patch (k,) that each lies on."""
        triangle, share = self._nearest(points)
        patch = self._across_joints(points, triangle)
        feet, normals = np.empty_like(points), np.empty_like(points)
        for k in np.unique(patch):
            mine = np.flatnonzero(patch == k)
            one = self.patches[k]
            own = self.patch[triangle[mine]] == k
            start = np.einsum("nk,nkc->nc", share[mine], self.uv[triangle[mine]])
            uv = np.empty((len(mine), 2))
            uv[own] = one.inverse(points[mine[own]], start[own])
            if not own.all():
                uv[~own] = one.inverse(points[mine[~own]])
            feet[mine], normals[mine] = one.at(uv)
        return feet, normals, patch

    # ---- the nearest triangle

    @cached_property
    def _corners(self) -> Array:
        return self.vertices[self.triangles]

    @cached_property
    def _middles(self) -> cKDTree:
        return cKDTree(self._corners.mean(axis=1))

    def _nearest(self, points: Array) -> tuple[Index, Array]:
        """The nearest triangle (k,) of each point and the shares (k, 3) of its corners in the foot."""
        count = min(NEAREST, len(self.triangles))
        near = np.asarray(self._middles.query(points, k=count)[1]).reshape(len(points), count)
        corner = self._corners[near]
        distance, share = closest(
            corner[:, :, 0], corner[:, :, 1], corner[:, :, 2], points[:, None]
        )
        best = np.argmin(distance, axis=1)
        row = np.arange(len(points))
        return near[row, best].astype(np.intp), share[row, best]

    # ---- the side of the joints between patches, which the mesh tells only to its chord error

    def _across_joints(self, points: Array, triangle: Index) -> Index:
        """The patch (k,) of each point, given its nearest triangle: next to a joint, that on the point's side of it."""
        patch = self.patch[triangle]
        joints = self._joints
        if joints is None:
            return patch
        near = np.flatnonzero(joints.touched[triangle])
        if not len(near):
            return patch
        p = points[near]
        arc = np.asarray(joints.tree.query(p, k=min(3, len(joints.start)))[1]).reshape(
            len(near), -1
        )
        start, end = joints.start[arc], joints.end[arc]
        t = np.clip(
            dot(p[:, None] - start, end - start)
            / np.maximum(dot(end - start, end - start), 1e-300),
            0.0,
            1.0,
        )
        off = np.linalg.norm(start + t[..., None] * (end - start) - p[:, None], axis=-1)
        row, best = np.arange(len(near)), np.argmin(off, axis=1)
        arc, t = arc[row, best], t[row, best]
        for _ in range(3):
            at, slope, bend = joints.at(arc, t)
            rate = dot(slope, slope) - dot(p - at, bend)
            t = np.clip(
                t + dot(p - at, slope) / np.maximum(rate, 0.1 * dot(slope, slope)), 0.0, 1.0
            )
        at, slope, _ = joints.at(arc, t)
        normal = (1.0 - t)[:, None] * joints.start_normal[arc] + t[:, None] * joints.end_normal[arc]
        left = dot(p - at, np.cross(normal, slope)) > 0.0
        # only between the two patches that meet there: beyond a corner of the joints the triangle is right
        pair = joints.pair[arc]
        joined = (pair == patch[near][:, None]).any(axis=1)
        patch = patch.copy()
        patch[near[joined]] = np.where(left, pair[:, 0], pair[:, 1])[joined]
        return patch

    @cached_property
    def _joints(self) -> _Joints | None:
        half = self.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        owner = np.repeat(self.patch, 3)
        order = np.lexsort((np.arange(len(half)), half.max(axis=1), half.min(axis=1)))
        low, high = half.min(axis=1)[order], half.max(axis=1)[order]
        twin = np.flatnonzero((low[1:] == low[:-1]) & (high[1:] == high[:-1]))
        one, other = order[twin], order[twin + 1]
        apart = owner[one] != owner[other]
        one, other = one[apart], other[apart]
        if not len(one):
            return None
        edge = half[one]
        slopes = tangents(self.vertices, edge)
        length = np.linalg.norm(self.vertices[edge[:, 1]] - self.vertices[edge[:, 0]], axis=1)[
            :, None
        ]
        on_joint = np.zeros(len(self.vertices), dtype=bool)
        on_joint[edge] = True
        start, end = self.vertices[edge[:, 0]], self.vertices[edge[:, 1]]
        normals = np.empty((2, len(edge), 3))
        for k in np.unique(owner[one]):
            mine = owner[one] == k
            for side, points in enumerate((start, end)):
                normals[side, mine] = self.patches[k].at(self.patches[k].inverse(points[mine]))[1]
        touched: Mask = np.asarray(on_joint[self.triangles].any(axis=1))
        return _Joints(
            start,
            end,
            slopes[:, 0] * length,
            slopes[:, 1] * length,
            normals[0],
            normals[1],
            np.stack([owner[one], owner[other]], axis=1),
            cKDTree(0.5 * (start + end)),
            touched,
        )


class _Joints(NamedTuple):
    """Edges (k,) between triangles of two patches as cubic arcs: ends, slopes there, outer normals there; the patch on the
    left and on the right, seen from outside; the triangles (m,) that touch one."""

    start: Array
    end: Array
    start_slope: Array
    end_slope: Array
    start_normal: Array
    end_normal: Array
    pair: Index
    tree: cKDTree
    touched: Mask

    def at(self, arc: Index, t: Array) -> tuple[Array, Array, Array]:
        """Points, first and second derivatives (n, 3) of arcs at t in [0, 1]."""
        t = t[:, None]
        start, end, a, b = (
            self.start[arc],
            self.end[arc],
            self.start_slope[arc],
            self.end_slope[arc],
        )
        chord = end - start
        square, cube = 3.0 * chord - 2.0 * a - b, a + b - 2.0 * chord
        slope = a + t * (2.0 * square + 3.0 * t * cube)
        return start + t * (a + t * (square + t * cube)), slope, 2.0 * square + 6.0 * t * cube
