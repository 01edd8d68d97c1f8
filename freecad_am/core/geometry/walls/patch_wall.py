# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls of connected smooth pieces on a substrate: exact pieces, a mesh, start and end curves."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...issues import Issue
from ...types import Array, Index, Mask
from ..curves.space_curve import SpaceCurve
from ..mesh.edge_runs import tangents
from ..mesh.triangle_mesh import Mesh, closest
from ..obstacles import Body
from .part_depths import PartDepths
from .patch import TORUS, Patch
from .surface import dot

NEIGHBOUR_COUNT = 8  # triangles with the nearest centroids to search for the nearest triangle


@dataclass(frozen=True, eq=False)
class FirstCurve:
    """A loop or chain in which layers start.

    points: (k, 3) mm; a closed curve does not repeat its first point. into, out: (k, 3) unit
    tangents where the curve arrives at and leaves each point; they differ only at corners.
    """

    points: Array
    into: Array
    out: Array
    closed: bool

    def curve(self) -> SpaceCurve:
        """Return the curve through the points."""
        points, into, out = self.points, self.into, self.out
        if self.closed:
            points, into, out = (np.vstack([column, column[:1]]) for column in (points, into, out))
        chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
        bow = np.arccos(
            np.clip(dot(out[:-1], into[1:]), -1.0, 1.0)
        )  # parameter: arc length of approximately circular arcs
        w = np.r_[0.0, np.cumsum(chord / np.sinc(0.5 * np.minimum(bow, 1.0) / np.pi))]
        return SpaceCurve(w, points, into, out, self.closed)


@dataclass(frozen=True, eq=False)
class Rim:
    """A part of the wall's boundary without corners.

    points: (k, 3) mesh vertices, mm; a closed rim repeats its first point. end: whether layers
    finish at the rim, an upper edge. `end` is False for a side (which contains an end of a first
    curve), for the edge of an opening around which layers continue, and for a rim on or in the
    substrate.
    """

    points: Array
    end: bool

    @property
    def closed(self) -> bool:
        """Whether the rim is a loop."""
        return bool((self.points[0] == self.points[-1]).all())


@dataclass(frozen=True, eq=False)
class PatchWall:
    """A wall in part coordinates, mm.

    vertices (n, 3) and triangles (m, 3) of the whole wall, counter-clockwise seen from its outer
    side. patch: (m,) index into `patches` for each triangle. uv: (m, 3, 2) patch parameters of the
    triangle corners. first: curves in which layers start. behind: (n,) True for vertices on the
    substrate side of the start curves, which are not deposited. surroundings: obstacles for the
    nozzle, the substrate first. depths: distribution of the part about the wall. ground: z of the
    plane through the lowest point of the wall, mm, if only the platform carries the wall.
    closes_around: whether a surface parameter closes around the wall. own: None, because a wall has
    no hub.
    """

    kind: ClassVar[str] = "patches"
    closes_around: ClassVar[Literal[False]] = False
    own: ClassVar[None] = None

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
        """Return the wall's frame: the part frame, raised to the ground of the wall.

        Returns
        -------
        (4, 4) array
            Pose in part coordinates, mm.
        """
        frame = np.eye(4)
        frame[2, 3] = 0.0 if self.ground is None else self.ground
        return frame

    @property
    def symmetry_normal(self) -> Array | None:
        """Return the normal of the bend plane of a torus that closes around.

        Returns
        -------
        (3,) array or None
            Unit normal; None for other walls.
        """
        is_full_torus = (
            len(self.patches) == 1
            and self.patches[0].kind == TORUS
            and all(rim.closed for rim in self.rims)
        )
        return np.array(self.patches[0].frame[:3, 2]) if is_full_torus else None

    @property
    def mesh_vertices(self) -> int:
        """Number of vertices of the mesh that approximates the wall; 0 for exact pieces."""
        return 0

    @property
    def folds(self) -> float:
        """Total length of bends too sharp for the mesh, mm; 0 for exact pieces."""
        return 0.0

    @cached_property
    def mesh(self) -> Mesh:
        """Mesh of the wall, for level lines."""
        return Mesh(self.vertices, self.triangles)

    def project(self, points: Array) -> tuple[Array, Array]:
        """Project points onto the wall.

        Beyond an edge of the wall, points are projected onto the extended surface.

        Parameters
        ----------
        points : (k, 3) array
            Points, mm.

        Returns
        -------
        feet : (k, 3) array
            Nearest points, mm.
        normals : (k, 3) array
            Unit normals to the outer side.
        """
        points, normals, _ = self.located(points)
        return points, normals

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """Project points onto the wall, as `project`, and return their patches.

        Parameters
        ----------
        points : (k, 3) array
            Points, mm.

        Returns
        -------
        feet : (k, 3) array
            Nearest points, mm.
        normals : (k, 3) array
            Unit normals to the outer side.
        patch : (k,) int array
            Patch index of each point.
        """
        triangle, share = self._nearest(points)
        patch = self._across_joints(points, triangle)
        feet, normals = np.empty_like(points), np.empty_like(points)
        for k in np.unique(patch):
            rows = np.flatnonzero(patch == k)
            surface = self.patches[k]
            same_patch = self.patch[triangle[rows]] == k
            start = np.einsum("nk,nkc->nc", share[rows], self.uv[triangle[rows]])
            uv = np.empty((len(rows), 2))
            uv[same_patch] = surface.inverse(points[rows[same_patch]], start[same_patch])
            if not same_patch.all():
                uv[~same_patch] = surface.inverse(points[rows[~same_patch]])
            feet[rows], normals[rows] = surface.at(uv)
        return feet, normals, patch

    # ---- the nearest triangle

    @cached_property
    def _corners(self) -> Array:
        return self.vertices[self.triangles]

    @cached_property
    def _middles(self) -> cKDTree:
        return cKDTree(self._corners.mean(axis=1))

    def _nearest(self, points: Array) -> tuple[Index, Array]:
        """Return nearest triangles (k,) of points, and barycentric coordinates (k, 3) of feet."""
        count = min(NEIGHBOUR_COUNT, len(self.triangles))
        candidates = np.asarray(self._middles.query(points, k=count)[1]).reshape(len(points), count)
        corner = self._corners[candidates]
        distance, share = closest(
            corner[:, :, 0], corner[:, :, 1], corner[:, :, 2], points[:, None]
        )
        best = np.argmin(distance, axis=1)
        row = np.arange(len(points))
        return candidates[row, best].astype(np.intp), share[row, best]

    # ---- side of the joints between patches, which the mesh gives only within its chord error

    def _across_joints(self, points: Array, triangle: Index) -> Index:
        """Return the patch (k,) of each point, given the nearest triangle.

        Near a joint, return the patch on the point's side.
        """
        patch = self.patch[triangle]
        joints = self._joints
        if joints is None:
            return patch
        near_joint = np.flatnonzero(joints.touched[triangle])
        if not len(near_joint):
            return patch
        p = points[near_joint]
        arc = np.asarray(joints.tree.query(p, k=min(3, len(joints.start)))[1]).reshape(
            len(near_joint), -1
        )
        start, end = joints.start[arc], joints.end[arc]
        t = np.clip(
            dot(p[:, None] - start, end - start)
            / np.maximum(dot(end - start, end - start), 1e-300),
            0.0,
            1.0,
        )
        off = np.linalg.norm(start + t[..., None] * (end - start) - p[:, None], axis=-1)
        row, best = np.arange(len(near_joint)), np.argmin(off, axis=1)
        arc, t = arc[row, best], t[row, best]
        for _ in range(3):
            foot, slope, bend = joints.evaluate(arc, t)
            rate = dot(slope, slope) - dot(p - foot, bend)
            t = np.clip(
                t + dot(p - foot, slope) / np.maximum(rate, 0.1 * dot(slope, slope)), 0.0, 1.0
            )
        foot, slope, _ = joints.evaluate(arc, t)
        normal = (1.0 - t)[:, None] * joints.start_normal[arc] + t[:, None] * joints.end_normal[arc]
        on_left = dot(p - foot, np.cross(normal, slope)) > 0.0
        # only between the two patches of the joint: beyond a corner, the triangle decides
        pair = joints.pair[arc]
        joined = (pair == patch[near_joint][:, None]).any(axis=1)
        patch = patch.copy()
        patch[near_joint[joined]] = np.where(on_left, pair[:, 0], pair[:, 1])[joined]
        return patch

    @cached_property
    def _joints(self) -> _Joints | None:
        half = self.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        owner = np.repeat(self.patch, 3)
        order = np.lexsort((np.arange(len(half)), half.max(axis=1), half.min(axis=1)))
        low, high = half.min(axis=1)[order], half.max(axis=1)[order]
        twin = np.flatnonzero((low[1:] == low[:-1]) & (high[1:] == high[:-1]))
        side_a, side_b = order[twin], order[twin + 1]
        between_patches = owner[side_a] != owner[side_b]
        side_a, side_b = side_a[between_patches], side_b[between_patches]
        if not len(side_a):
            return None
        edge = half[side_a]
        slopes = tangents(self.vertices, edge)
        length = np.linalg.norm(self.vertices[edge[:, 1]] - self.vertices[edge[:, 0]], axis=1)[
            :, None
        ]
        on_joint = np.zeros(len(self.vertices), dtype=bool)
        on_joint[edge] = True
        start, end = self.vertices[edge[:, 0]], self.vertices[edge[:, 1]]
        normals = np.empty((2, len(edge), 3))
        for k in np.unique(owner[side_a]):
            on_patch = owner[side_a] == k
            for side, points in enumerate((start, end)):
                normals[side, on_patch] = self.patches[k].at(
                    self.patches[k].inverse(points[on_patch])
                )[1]
        touched: Mask = np.asarray(on_joint[self.triangles].any(axis=1))
        return _Joints(
            start,
            end,
            slopes[:, 0] * length,
            slopes[:, 1] * length,
            normals[0],
            normals[1],
            np.stack([owner[side_a], owner[side_b]], axis=1),
            cKDTree(0.5 * (start + end)),
            touched,
        )


class _Joints(NamedTuple):
    """Edges (k,) between triangles of two patches, as cubic arcs.

    start, end, slopes and outer normals: (k, 3). pair: (k, 2) patches on the left and on the right,
    seen from outside. tree: midpoints. touched: (m,) whether a triangle touches a joint.
    """

    start: Array
    end: Array
    start_slope: Array
    end_slope: Array
    start_normal: Array
    end_normal: Array
    pair: Index
    tree: cKDTree
    touched: Mask

    def evaluate(self, arc: Index, t: Array) -> tuple[Array, Array, Array]:
        """Return points and first and second derivatives (n, 3) of arcs at t in [0, 1]."""
        t = t[:, None]
        start = self.start[arc]
        end = self.end[arc]
        a = self.start_slope[arc]
        b = self.end_slope[arc]
        chord = end - start
        square, cube = 3.0 * chord - 2.0 * a - b, a + b - 2.0 * chord
        slope = a + t * (2.0 * square + 3.0 * t * cube)
        return start + t * (a + t * (square + t * cube)), slope, 2.0 * square + 6.0 * t * cube


# ---- Faces to be covered with layers of beads, as smooth sheets; layers grow on the outer side


@dataclass(frozen=True, eq=False)
class CladFaces:
    """Faces of a part to be clad.

    label: name of the part. faces: names of the faces. sheets: a sheet without start and end curves
    for each group of smoothly connected faces. surroundings: the part itself if it is a solid,
    substrate and fixtures. depths: None, because a face has no volume. own: None, because faces
    have no hub.
    """

    own: ClassVar[None] = None

    label: str
    faces: tuple[str, ...]
    sheets: tuple[PatchWall, ...]
    surroundings: tuple[Body, ...] = ()
    issues: tuple[Issue, ...] = ()
    depths: None = None

    @property
    def area(self) -> float:
        """Area of the faces, mm2, from their triangles."""
        return float(sum(sheet.mesh.areas.sum() for sheet in self.sheets))

    @property
    def smoothing(self) -> float:
        """Maximum distance between sheets and faces, mm; 0 for exact faces."""
        return max((getattr(sheet, "smoothing", 0.0) for sheet in self.sheets), default=0.0)
