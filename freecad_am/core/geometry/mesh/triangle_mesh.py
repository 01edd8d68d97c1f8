# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangle meshes of walls, and chained level lines of vertex functions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix, csgraph
from scipy.spatial import cKDTree

from ...issues import InputError
from ...types import Array, Index, Mask
from ..step_count import step_count
from ..walls.surface import dot


def closest(a: Array, b: Array, c: Array, points: Array) -> tuple[Array, Array]:
    """Return the distances between points and triangles.

    Parameters
    ----------
    a, b, c : (..., 3) array
        Corners of the triangles, mm.
    points : (..., 3) array
        Points, mm.

    Returns
    -------
    distance : (...) array
        Distances, mm.
    share : (..., 3) array
        Barycentric coordinates of the nearest point.
    """
    ab, ac, ap = b - a, c - a, points - a
    d00, d01, d11 = dot(ab, ab), dot(ab, ac), dot(ac, ac)
    d20, d21 = dot(ap, ab), dot(ap, ac)
    area = d00 * d11 - d01 * d01
    flat = area <= 1e-14 * d00 * d11  # collinear corners have no inside
    safe = np.where(flat, 1.0, area)
    v, w = (d11 * d20 - d01 * d21) / safe, (d00 * d21 - d01 * d20) / safe
    inside = (v >= 0.0) & (w >= 0.0) & (v + w <= 1.0) & ~flat
    # nearest points on the three sides, as (v, w)
    on_ab = np.clip(d20 / np.maximum(d00, 1e-300), 0.0, 1.0)
    on_ac = np.clip(d21 / np.maximum(d11, 1e-300), 0.0, 1.0)
    on_bc = np.clip((d21 - d20 + d00 - d01) / np.maximum(d00 - 2.0 * d01 + d11, 1e-300), 0.0, 1.0)
    zero = np.zeros_like(v)
    vs = np.stack([v, on_ab, zero, 1.0 - on_bc])
    ws = np.stack([w, zero, on_ac, on_bc])
    square = (
        dot(ap, ap)
        + vs * (vs * d00 - 2.0 * d20)
        + ws * (ws * d11 - 2.0 * d21)
        + 2.0 * vs * ws * d01
    )
    square[0] = np.where(inside, square[0], np.inf)
    best = np.argmin(square, axis=0)[None]
    v, w, min_square = (
        np.take_along_axis(candidates, best, axis=0)[0] for candidates in (vs, ws, square)
    )
    return np.sqrt(np.maximum(min_square, 0.0)), np.stack([1.0 - v - w, v, w], axis=-1)


def cut_evenly(corners: Array, longest: float) -> tuple[Array, Index]:
    """Divide triangles evenly so that all edges are within a limit.

    Parameters
    ----------
    corners : (m, 3, 3) array
        Triangles, mm.
    longest : float
        Maximum edge, mm.

    Returns
    -------
    points : (m, k, 3) array
        Points in each triangle, mm.
    parts : (l, 3) int array
        Point indices of the parts, the same for all triangles.
    """
    edge = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max()
    n = step_count(edge, longest)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
    i, j = i[i + j <= n], j[i + j <= n]
    number = np.full((n + 2, n + 2), -1)
    number[i, j] = np.arange(len(i))
    up, down = i + j < n, i + j < n - 1
    sub_triangles = np.vstack(
        [
            np.stack(
                [number[i[up], j[up]], number[i[up] + 1, j[up]], number[i[up], j[up] + 1]], axis=1
            ),
            np.stack(
                [
                    number[i[down] + 1, j[down]],
                    number[i[down] + 1, j[down] + 1],
                    number[i[down], j[down] + 1],
                ],
                axis=1,
            ),
        ]
    )
    share = np.stack([n - i - j, i, j], axis=1) / n
    return np.einsum("sk,mkc->msc", share, corners), sub_triangles.astype(np.intp)


DECIMALS = 6  # decimals of mm to which vertices of a finer mesh are merged


class LevelLine(NamedTuple):
    """A chain of points (n, 3) with the lower side on its left.

    A closed line does not repeat its first point. rims: (2, 3) unit vectors along the mesh edges on
    which an open line starts and ends.
    """

    points: Array
    closed: bool
    rims: Array


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh: vertices (n, 3) mm, faces (m, 3) with consistent orientation."""

    vertices: Array
    faces: Index

    @cached_property
    def edges(self) -> Index:
        """All edges (k, 2), each once, lower vertex index first."""
        return np.column_stack(np.divmod(np.unique(self._sides), len(self.vertices)))

    @cached_property
    def border_edges(self) -> Index:
        """Border edges (k, 2): they have a single face, on their left."""
        _, edge_number, count = np.unique(self._sides, return_inverse=True, return_counts=True)
        edges: Index = self._half_edges[count[edge_number] == 1]
        return edges

    @property
    def _half_edges(self) -> Index:
        """Sides (3 m, 2) of all faces, with the face on the left."""
        return self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)

    @property
    def _sides(self) -> Index:
        """Sides (3 m,) as integers, equal for both faces at an edge and sorted by its vertices.

        Integers sort faster than rows of two, and without blocking other threads.
        """
        low, high = np.sort(self._half_edges, axis=1).astype(np.int64).T
        sides: Index = low * len(self.vertices) + high
        return sides

    @cached_property
    def area_vectors(self) -> Array:
        """Return the normals of the faces, with the area as length.

        Returns
        -------
        (m, 3) array
            mm2.
        """
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        vectors: Array = 0.5 * np.cross(b - a, c - a)
        return vectors

    @cached_property
    def areas(self) -> Array:
        """Return the areas of the faces.

        Returns
        -------
        (m,) array
            mm2.
        """
        areas: Array = np.linalg.norm(self.area_vectors, axis=1)
        return areas

    @cached_property
    def longest_edge(self) -> float:
        """Maximum edge length, mm."""
        a, b = self.vertices[self.edges].transpose(1, 0, 2)
        return float(np.linalg.norm(a - b, axis=1).max())

    @cached_property
    def typical_edge(self) -> float:
        """Median edge length, mm."""
        a, b = self.vertices[self.edges].transpose(1, 0, 2)
        return float(np.median(np.linalg.norm(a - b, axis=1)))

    def folded(self, angle: float) -> float:
        """Return the total length, mm, of edges whose faces meet at more than `angle` rad."""
        order = np.argsort(self._sides, kind="stable")
        sides, face = self._sides[order], order // 3
        paired = np.flatnonzero(sides[1:] == sides[:-1])
        normal_a, normal_b = self.area_vectors[face[paired]], self.area_vectors[face[paired + 1]]
        along = self.vertices[self._half_edges[order[paired]]]
        turn = np.arctan2(
            np.linalg.norm(np.cross(normal_a, normal_b), axis=1),
            np.einsum("ij,ij->i", normal_a, normal_b),
        )
        return float(np.linalg.norm(along[:, 1] - along[:, 0], axis=1)[turn > angle].sum())

    @cached_property
    def tree(self) -> cKDTree:
        """Search tree of the vertices."""
        return cKDTree(self.vertices)

    @cached_property
    def _faces_of(self) -> tuple[Index, Index]:
        """Faces sorted by vertex, and the start of each vertex's faces."""
        order = np.argsort(self.faces.ravel(), kind="stable")
        counts = np.bincount(self.faces.ravel(), minlength=len(self.vertices))
        return (order // 3).astype(np.intp), np.r_[0, np.cumsum(counts)].astype(np.intp)

    def faces_at(self, vertices: Index) -> Index:
        """Return the faces that touch vertices.

        Parameters
        ----------
        vertices : (v,) array of int
            Vertex indices.

        Returns
        -------
        (k,) array of int
            Face indices, rising.
        """
        faces, begin = self._faces_of
        count = begin[vertices + 1] - begin[vertices]
        index = np.repeat(begin[vertices] - np.r_[0, np.cumsum(count)[:-1]], count) + np.arange(
            count.sum()
        )
        touched: Index = np.unique(faces[index])
        return touched

    def connected_members(self, members: Mask, seeds: Mask) -> Mask:
        """Return the vertices connected to a seed by edges between members.

        Parameters
        ----------
        members : (n,) array of bool
            Vertices to pass through.
        seeds : (n,) array of bool
            Start vertices; they count as members.

        Returns
        -------
        (n,) array of bool
            Connected vertices, including the seeds.
        """
        inside = members | seeds
        pairs = self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        pairs = pairs[inside[pairs].all(axis=1)]
        links = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(inside), len(inside)))
        count, label = csgraph.connected_components(links, directed=False)
        linked = np.zeros(count, dtype=bool)
        linked[label[seeds]] = True
        reached: Mask = inside & linked[label]
        return reached

    def part(self, faces: Index) -> tuple[Mesh, Index]:
        """Return the mesh of selected faces.

        Parameters
        ----------
        faces : (k,) int array
            Face indices.

        Returns
        -------
        mesh : Mesh
            Mesh of the faces.
        vertices : (m,) int array
            Indices in this mesh of the new mesh's vertices.
        """
        vertices, corners = np.unique(self.faces[faces], return_inverse=True)
        return Mesh(
            self.vertices[vertices], np.ravel(corners).reshape(-1, 3).astype(np.intp)
        ), vertices

    def finer(self, longest: float) -> Mesh:
        """Return the mesh divided evenly so that all edges are within `longest` mm."""
        points, sub_triangles = cut_evenly(self.vertices[self.faces], longest)
        corners = (
            np.arange(len(self.faces))[:, None, None] * points.shape[1] + sub_triangles[None]
        ).reshape(-1, 3)
        points = points.reshape(-1, 3)
        _, representative, same = np.unique(
            np.round(points, DECIMALS) + 0.0, axis=0, return_index=True, return_inverse=True
        )
        return Mesh(points[representative], np.ravel(same)[corners].astype(np.intp))

    def level_lines(self, values: Array, faces: Index) -> list[LevelLine]:
        """Return the lines of zero value, interpolated along edges.

        Parameters
        ----------
        values : (n,) array
            Values of the vertices.
        faces : (k,) array of int
            Indices of the faces to search.

        Returns
        -------
        list of LevelLine
            Chains with the lower side on their left, mm.

        Raises
        ------
        InputError
            MESH if adjacent faces have opposite orientations, so that lines have no sides.
        """
        corners = self.faces[faces]
        low = values[corners] < 0.0
        count = low.sum(axis=1)
        mixed = (count == 1) | (count == 2)
        corners, low, single = corners[mixed], low[mixed], (count == 1)[mixed]
        if not len(corners):
            return []
        odd = np.argmax(low == single[:, None], axis=1)
        row = np.arange(len(corners))
        a, b, c = corners[row, odd], corners[row, (odd + 1) % 3], corners[row, (odd + 2) % 3]
        ab, ac = np.sort(np.stack([a, b], 1), axis=1), np.sort(np.stack([a, c], 1), axis=1)
        start, end = np.where(single[:, None], ab, ac), np.where(single[:, None], ac, ab)
        # integers sort faster than rows of two
        low_vertex, high_vertex = np.vstack([start, end]).astype(np.int64).T
        keys, node = np.unique(low_vertex * len(self.vertices) + high_vertex, return_inverse=True)
        edges = np.column_stack(np.divmod(keys, len(self.vertices)))
        following = np.full(len(edges), -1, dtype=np.intp)
        following[node[: len(row)]] = node[len(row) :]
        arrives = np.bincount(node[len(row) :], minlength=len(edges))
        if np.bincount(node[: len(row)]).max() > 1 or arrives.max() > 1:
            raise InputError(
                "MESH",
                "wall",
                "faces of the wall mesh have opposite orientations; orient all faces consistently",
            )
        start_value, end_value = values[edges].T
        t = np.clip(start_value / (start_value - end_value), 1e-6, 1.0 - 1e-6)[:, None]
        points = (1.0 - t) * self.vertices[edges[:, 0]] + t * self.vertices[edges[:, 1]]
        rims = self.vertices[edges[:, 1]] - self.vertices[edges[:, 0]]
        rims /= np.linalg.norm(rims, axis=1, keepdims=True)
        return [
            LevelLine(points[chain], closed, rims[chain[[0, -1]]])
            for chain, closed in chains(following)
        ]


def chains(following: Index) -> list[tuple[Index, bool]]:
    """Return chains of successors, in the order of their lowest members.

    Parameters
    ----------
    following : (n,) int array
        Index of the successor of each member, -1 for none.

    Returns
    -------
    list of ((k,) int array, bool)
        Members in order and whether the chain is closed. Closed chains begin with their
        lowest member.
    """
    ahead = following.tolist()
    arrives = np.zeros(len(ahead), dtype=bool)
    arrives[following[following >= 0]] = True
    ordered: list[tuple[int, list[int], bool]] = []
    unseen = bytearray(b"\x01") * len(ahead)
    starts = np.flatnonzero(~arrives).tolist()[::-1]
    # at any length, iteration over lists is faster than pointer doubling with arrays
    while (start := starts.pop() if starts else unseen.find(1)) >= 0:
        chain, node = [], start
        while node >= 0 and unseen[node]:
            unseen[node] = 0
            chain.append(node)
            node = ahead[node]
        if chain:
            ordered.append((min(chain), chain, node >= 0))
    return [(np.array(chain, dtype=np.intp), closed) for _, chain, closed in sorted(ordered)]


def thin_points(points: Array, closed: bool, min_step: float) -> Array:
    """Drop points of a chain that are too close to the previous point.

    Parameters
    ----------
    points : (n, 3) array
        The chain, mm.
    closed : bool
        Whether the chain is closed; the ends of an open chain stay.
    min_step : float
        Minimum distance, mm.

    Returns
    -------
    (k, 3) array
        Remaining points.
    """
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    keep = np.r_[True, np.diff(np.floor(length / min_step)) > 0]
    if not closed:
        keep[-1] = True
    elif length[-1] > min_step and np.linalg.norm(points[-1] - points[0]) < min_step:
        keep[-1] = False
    remaining: Array = points[keep]
    return remaining
