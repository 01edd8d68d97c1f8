# SPDX-License-Identifier: LGPL-2.1-or-later
"""A solid bounded by triangles: whether it is one, and how far points are from it, inside of it with a minus."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...issues import InputError
from ...types import Array, Index, Mask
from ..columns import sides
from ..formatting import place
from ..walls.surface import dot
from .crossing import crossings
from .refined import Edges
from .triangles import closest

NEAREST = 12
SHARP = np.radians(20.0)  # facets that meet at more do not stand for something round
PARALLEL = 1e-6  # of the cosine between the normals of triangles that lie the same way


@dataclass(frozen=True, eq=False)
class SolidMesh:
    """vertices (n, 3) mm, triangles (m, 3) counter-clockwise seen from outside."""

    vertices: Array
    triangles: Index

    @property
    def volume(self) -> float:
        """Volume, mm3; negative when the mesh is turned inside out."""
        a, b, c = (
            self.vertices[self.triangles[:, k]] - self.vertices[self.triangles[0, 0]]
            for k in range(3)
        )
        return float(dot(a, np.cross(b, c)).sum() / 6.0)

    def refuse_unsound(self, label: str, of_shape: bool = False, touching: bool = False) -> None:
        """InputError OPEN_MESH, NON_MANIFOLD or INSIDE_OUT with a place, unless the mesh bounds a solid. of_shape: it stands
        for a solid with exact faces, so that there is no mesh to repair. touching: it may touch itself along edges."""
        edges = Edges(self.triangles)
        several = (edges.count > 2) & ~(touching & (edges.count % 2 == 0))
        for wrong, code, what, cure in (
            (
                (edges.count == 1) & of_shape,
                "OPEN_MESH",
                "faces of the solid do not meet along their edges",
                "check it "
                "where it was drawn (Part, Check geometry), and draw those faces again or sew them",
            ),
            (
                edges.count == 1,
                "OPEN_MESH",
                "the mesh has a hole",
                "fill holes (Mesh, Close holes) or export it again",
            ),
            (
                several & of_shape,
                "NON_MANIFOLD",
                "the solid touches itself along an edge, so that its inside is not known",
                "draw it apart there, or let it overlap there and fuse it (Part, Boolean)",
            ),
            (
                several,
                "NON_MANIFOLD",
                "three or more triangles share an edge",
                "repair the mesh (Mesh, Analyze)",
            ),
        ):
            if wrong.any():
                where = place(self.vertices[edges.ends[np.argmax(wrong)]].mean(axis=0))
                raise InputError(
                    code,
                    label,
                    "{}: {} edges, the first at {}; {}",
                    what,
                    int(wrong.sum()),
                    where,
                    cure,
                )
        half = np.stack([self.triangles, np.roll(self.triangles, -1, axis=1)], axis=2)
        sense = np.where(half[..., 0] < half[..., 1], 1, -1)
        total = np.bincount(edges.of.ravel(), weights=sense.ravel(), minlength=len(edges.ends))
        if (total != 0).any():
            where = place(self.vertices[edges.ends[np.argmax(total != 0)]].mean(axis=0))
            raise InputError(
                "INSIDE_OUT",
                label,
                "neighbouring triangles face opposite ways, for instance at {}; turn them alike (Mesh, "
                "Harmonize normals)",
                where,
            )
        if self.volume <= 0.0:
            raise InputError(
                "INSIDE_OUT",
                label,
                "the solid is turned inside out (volume {:.4g} mm3, near {}); flip its normals (Mesh, "
                "Flip normals)",
                self.volume,
                place(self.vertices.mean(axis=0)),
            )

    def refuse_crossing(self, label: str, least: float) -> None:
        """InputError SELF_CROSSING with a place where the mesh cuts itself by more than `least` mm."""
        found = crossings(self.vertices, self.triangles, least)
        if len(found.pairs):
            where = place(found.places[found.length.argmax()])
            raise InputError(
                "SELF_CROSSING",
                label,
                "it cuts itself: {} pairs of its triangles cross, for instance at {}, so that what "
                "is inside is not known; fuse what overlaps where the part was drawn, or repair the mesh (Mesh, Analyze, "
                "Self-intersections)",
                len(found.pairs),
                where,
            )

    def searched(self, edge: float) -> Search:
        """Prepared for points about as far apart as `edge` mm."""
        area = 0.5 * np.linalg.norm(self.normals, axis=1).sum()
        return Search(self, max(2.0 * edge, float(np.sqrt(area / 20000.0))))

    @cached_property
    def normals(self) -> Array:
        """Twice the area of each triangle along its outer normal, (m, 3)."""
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        normals: Array = np.cross(b - a, c - a)
        return normals

    @cached_property
    def sagitta(self) -> Array:
        """How far (m,), about, each triangle lies off the round surface that it and its neighbours stand for: an eighth of
        its width across each edge times the turn there; edges that turn by more than SHARP are meant."""
        edges = Edges(self.triangles)
        two = edges.count == 2
        turn = np.zeros(len(edges.ends))
        one, other = (self.units[edges.faces[two, side]] for side in (0, 1))
        turn[two] = np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), dot(one, other))
        turn[turn > SHARP] = 0.0
        length = np.linalg.norm(
            self.vertices[edges.ends[:, 1]] - self.vertices[edges.ends[:, 0]], axis=1
        )
        width = np.linalg.norm(self.normals, axis=1)[:, None] / np.maximum(length[edges.of], 1e-300)
        sagitta: Array = (0.125 * width * turn[edges.of]).max(axis=1)
        return sagitta

    @cached_property
    def units(self) -> Array:
        """Outer unit normals (m, 3), nothing for triangles without an area."""
        length = np.linalg.norm(self.normals, axis=1, keepdims=True)
        units: Array = np.where(length > 1e-10, self.normals / np.maximum(length, 1e-300), 0.0)
        return units


class Search:
    """Nearest triangles of a solid, from the middles of their parts no longer than `longest` mm. The side is told by
    pseudo-normals (Baerentzen 2005)."""

    def __init__(self, solid: SolidMesh, longest: float) -> None:
        self.vertices, self.longest = solid.vertices, longest
        vertices = solid.vertices
        sound = np.flatnonzero(np.linalg.norm(solid.normals, axis=1) > 1e-10)
        self.triangles, self.owner, self.units = solid.triangles[sound], sound, solid.units[sound]
        middles, self.of = _spread(vertices[self.triangles], longest)
        self.tree = cKDTree(middles)

    @cached_property
    def flat(self) -> bool:
        """Whether all triangles are parallel: there is no inside then."""
        return bool((np.abs(self.units @ self.units[0]) > 1.0 - PARALLEL).all())

    def away(self, points: Array) -> Array:
        """Distance (k,) of points (k, 3) from the triangles."""
        return self._nearest(points)[0]

    def signed(self, points: Array) -> tuple[Array, Array, Index]:
        """Distance (k,) of points (k, 3), negative inside, the nearest points (k, 3) and triangles (k,) of the solid."""
        distance, triangle, share = self._nearest(points)
        foot = np.einsum("nk,nkc->nc", share, self.vertices[self.triangles[triangle]])
        at_vertex, at_edge, edge_of = self._pseudo_normals
        small = share < 1e-9
        normal = self.units[triangle].copy()
        on_edge = np.flatnonzero(small.sum(axis=1) == 1)
        normal[on_edge] = at_edge[
            edge_of[triangle[on_edge], (np.argmax(small[on_edge], axis=1) + 1) % 3]
        ]
        on_vertex = np.flatnonzero(small.sum(axis=1) == 2)
        normal[on_vertex] = at_vertex[
            self.triangles[triangle[on_vertex], np.argmin(small[on_vertex], axis=1)]
        ]
        side = np.where(dot(points - foot, normal) < 0.0, -1.0, 1.0)
        return side * distance, foot, self.owner[triangle]

    def _nearest(self, points: Array) -> tuple[Array, Index, Array]:
        """Distance (k,) of points (k, 3), the nearest of the sound triangles (k,), and the shares (k, 3) of its corners."""
        count = min(NEAREST, len(self.of))
        # about the middle of something round all is equally near: far points are content with a little farther
        far = np.flatnonzero(self.tree.query(points, eps=0.3)[0] > 4.0 * self.longest)
        close = np.setdiff1d(np.arange(len(points)), far)
        near = np.zeros((len(points), count), dtype=np.intp)
        for which, slack in ((far, 0.3), (close, 0.0)):
            if len(which):
                near[which] = self.of[
                    np.asarray(self.tree.query(points[which], k=count, eps=slack)[1]).reshape(
                        -1, count
                    )
                ]
        fresh = np.ones(
            near.shape, dtype=bool
        )  # most parts next to a point are of the same few triangles
        for k in range(1, count):
            fresh[:, k] = (near[:, :k] != near[:, k : k + 1]).all(axis=1)
        corner, owner = self.vertices[self.triangles[near[fresh]]], np.nonzero(fresh)[0]
        apart, shares = closest(corner[:, 0], corner[:, 1], corner[:, 2], points[owner])
        distance, place = np.full(near.shape, np.inf), np.zeros(near.shape, dtype=np.intp)
        distance[fresh], place[fresh] = apart, np.arange(len(apart))
        row, best = np.arange(len(points)), np.argmin(distance, axis=1)
        return distance[row, best], near[row, best], shares[place[row, best]]

    @cached_property
    def _pseudo_normals(self) -> tuple[Array, Array, Index]:
        """At each vertex (n, 3) and edge (e, 3), and the edges (m, 3) of each sound triangle."""
        corner = self.vertices[self.triangles]
        at_vertex = np.zeros_like(self.vertices)
        for k in range(3):
            one, other = (
                corner[:, (k + 1) % 3] - corner[:, k],
                corner[:, (k + 2) % 3] - corner[:, k],
            )
            angle = np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), dot(one, other))
            np.add.at(at_vertex, self.triangles[:, k], angle[:, None] * self.units)
        edges = Edges(self.triangles)
        at_edge = np.zeros((len(edges.ends), 3))
        for k in range(3):
            np.add.at(at_edge, edges.of[:, k], self.units)
        return at_vertex, at_edge, edges.of


def spread(
    corners: Array, longest: float, kept: Callable[[Array], Mask] | None = None
) -> tuple[Array, Index]:
    """Middles (k, 3) of the parts of triangles (m, 3, 3), none with a side beyond `longest` mm; the triangle of each.
    kept: says of triangles (n, 3, 3), whole ones and parts, which (n,) are parted further; the others are left out."""
    return (
        _spread(corners, longest, kept)
        if len(corners)
        else (np.zeros((0, 3)), np.zeros(0, dtype=np.intp))
    )


def _spread(
    corner: Array, longest: float, kept: Callable[[Array], Mask] | None = None
) -> tuple[Array, Index]:
    """Middles (k, 3) of the parts of triangles (m, 3, 3) with no side longer than `longest`, and the triangle of each."""
    of, done = np.arange(len(corner)), []
    while len(corner):
        if kept is not None:
            here = kept(corner)
            corner, of = corner[here], of[here]
        side = sides(corner)
        top = np.argmax(side, axis=1)
        small = side[np.arange(len(top)), top] <= longest
        a, b, c = (corner[small, k] for k in range(3))
        done.append(((a + b + c) / 3.0, of[small]))
        corner, of, top = corner[~small], of[~small], top[~small]
        a, b, c = (corner[np.arange(len(top)), (top + k) % 3] for k in range(3))
        middle = 0.5 * (a + b)
        corner = np.concatenate(
            [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        )
        of = np.r_[of, of]
    return np.concatenate([one for one, _ in done]), np.concatenate([one for _, one in done])
