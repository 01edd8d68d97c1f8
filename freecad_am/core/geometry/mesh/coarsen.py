# SPDX-License-Identifier: LGPL-2.1-or-later
"""Mesh coarsening: collapse short edges if the shape is kept (Hoppe et al. 1993). Smooth meshes."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array, Index, Mask
from ..columns import lengths
from ..walls.surface import dot
from .refine import Edges


def doubled_areas(corners: Array) -> Array:
    """Return vectors normal to triangles, with twice the area as length.

    Parameters
    ----------
    corners : (n, 3, 3) array
        Triangles, counter-clockwise seen from outside, mm.

    Returns
    -------
    (n, 3) array
        Outward vectors, mm2.
    """
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normals: Array = np.cross(a, b)
    return normals


NEIGHBOUR_COUNT = 28  # nearest samples that influence a point
REACH = 2.2  # typical sample distances; radius of influence of a sample
STEPS = 12
MIN_MOVE_MM = 1e-11  # mm; a shorter move has converged


class SmoothMesh:
    """A smooth surface through the vertices of a mesh.

    samples: (n, 3) mm, vertices of triangles (m, 3), about `spacing` mm apart. Normals point to the
    side from which the triangles are counter-clockwise.
    """

    def __init__(self, samples: Array, triangles: Index, spacing: float) -> None:
        self.samples, self.triangles, self.reach = samples, triangles, REACH * spacing

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.samples)

    @cached_property
    def _facets(self) -> tuple[Array, Array]:
        """Return the unit normals (n, 3) and areas (n,) of the samples, from their triangles."""
        corner = self.samples[self.triangles]
        normal, area = np.zeros_like(self.samples), np.zeros(len(self.samples))
        double = doubled_areas(corner)
        size = np.linalg.norm(double, axis=1)
        unit = double / np.maximum(size, 1e-300)[:, None]
        for k in range(3):
            edge_a = corner[:, (k + 1) % 3] - corner[:, k]
            edge_b = corner[:, (k + 2) % 3] - corner[:, k]
            angle = np.arctan2(
                np.linalg.norm(np.cross(edge_a, edge_b), axis=1), dot(edge_a, edge_b)
            )
            np.add.at(normal, self.triangles[:, k], angle[:, None] * unit)
            np.add.at(area, self.triangles[:, k], size / 6.0)
        return normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300), area

    def project(self, points: Array) -> tuple[Array, Array]:
        """Project points onto the smooth surface.

        Parameters
        ----------
        points : (k, 3) array
            Points near the surface, mm.

        Returns
        -------
        points : (k, 3) array
            Points on the surface, mm.
        normals : (k, 3) array
            Unit normals at these points.
        """
        feet = points.astype(np.float64, copy=True)
        normals = np.zeros_like(feet)
        busy = np.arange(len(feet))
        neighbours = self._neighbours(feet)
        for step in range(STEPS):
            value, slope = self._level(feet[busy], neighbours)
            size = np.maximum((slope * slope).sum(axis=1), 0.04)
            most = 4.0 * self.reach
            move = np.minimum(np.maximum(value / size, -most), most)[:, None] * slope
            feet[busy] -= move
            normals[busy] = slope
            still = np.abs(move).max(axis=1) < MIN_MOVE_MM
            if step == 0:  # far from the surface, the first step changes the neighbours
                stale = np.flatnonzero(neighbours.may_change(lengths(move), self.reach))
                neighbours.replace(stale, self._neighbours(feet[stale]))
            if step == 0 or not still.any():
                continue
            busy, neighbours = busy[~still], neighbours.select(~still)
            if not len(busy):
                break
        return feet, normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)

    def _neighbours(self, points: Array) -> _Neighbours:
        """Return the samples nearest to points (k, 3)."""
        count = min(NEIGHBOUR_COUNT, len(self.samples))
        distances, nearest = (
            np.asarray(column).reshape(len(points), count)
            for column in self._tree.query(points, k=count)
        )
        normals, areas = self._facets
        ends = distances[:, [0, -1]]
        if count == len(self.samples):
            ends[:, 1] = np.inf
        return _Neighbours(self.samples[nearest], normals[nearest], areas[nearest], ends)

    def _level(self, points: Array, neighbours: _Neighbours) -> tuple[Array, Array]:
        """Return approximate heights (k,) of points above the surface, and gradients (k, 3)."""
        samples, normal, area, _ = neighbours
        offset = points[:, None] - samples
        square = np.einsum("klc,klc->kl", offset, offset)
        reach = np.maximum(self.reach**2, 2.0 * square.min(axis=1))[:, None]
        inner = np.maximum(1.0 - square / reach, 0.0)
        weight = area * inner**4
        pull = -8.0 / reach * area * inner**3  # times `offset`: gradient of the weight
        total = weight.sum(axis=1)
        weight, pull = weight / total[:, None], pull / total[:, None]
        mean = np.einsum("kl,klc->kc", weight, normal)
        length = np.maximum(np.linalg.norm(mean, axis=1), 1e-9)
        unit = mean / length[:, None]
        above = np.einsum("klc,klc->kl", normal, offset)
        middle = np.einsum("kl,klc->kc", weight, offset)
        height = dot(unit, middle)
        value = 0.5 * ((weight * above).sum(axis=1) + height)
        turned = (middle - height[:, None] * unit) / length[:, None]
        change = (
            above
            + np.einsum("klc,kc->kl", normal, turned)
            + np.einsum("klc,kc->kl", offset, unit)
            - 2.0 * value[:, None]
        )
        slope = 0.5 * (np.einsum("kl,klc->kc", pull * change, offset) + mean + unit)
        return value, slope


class _Neighbours(NamedTuple):
    """Samples near points (k, l, 3), their normals (k, l, 3) and areas (k, l).

    ends: (k, 2) distances of the nearest and the farthest sample, mm; infinite if there are no others.
    """

    sample: Array
    normal: Array
    area: Array
    ends: Array

    def may_change(self, moved: Array, reach: float) -> Mask:
        """Return whether other samples may influence points after moves (k,), mm."""
        nearest, farthest = self.ends.T
        needed = np.maximum(reach, np.sqrt(2.0) * (nearest + moved))
        changed: Mask = farthest - moved < needed
        return changed

    def replace(self, rows: Index, others: _Neighbours) -> None:
        """Replace the neighbours of some points."""
        for column, new in zip(self, others, strict=True):
            column[rows] = new

    def select(self, rows: Mask) -> _Neighbours:
        """Return the neighbours of selected points."""
        return _Neighbours(*(column[rows] for column in self))


ROUNDS = 4
MIN_STRAIGHT_COSINE = np.cos(
    np.radians(25.0)
)  # minimum cosine of the turn angle of a curve at a removed vertex
MIN_NORMAL_COSINE = np.cos(
    np.radians(30.0)
)  # minimum cosine of the rotation of a triangle when a corner moves


def collapse_edges(
    vertices: Array, triangles: Index, owner: Index, shortest: float, longest: float
) -> tuple[Index, Index]:
    """Collapse short edges of a mesh.

    Vertices on boundaries and between owners move only along these curves. Vertices keep their
    indices.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles.
    owner : (m,) int array
        Owner of each triangle.
    shortest : float
        Edges shorter than this are collapsed, mm.
    longest : float
        Maximum length of new edges, mm.

    Returns
    -------
    triangles : (k, 3) int array
        Remaining triangles.
    owner : (k,) int array
        Owners of the triangles.

    References
    ----------
    Hoppe et al. 1993.
    """
    for _ in range(ROUNDS):
        edges = Edges(triangles)
        length = np.linalg.norm(vertices[edges.ends[:, 0]] - vertices[edges.ends[:, 1]], axis=1)
        removed, stays = _candidates(vertices, triangles, owner, edges, length < shortest)
        if not len(removed):
            break
        into = np.arange(len(vertices))
        rank = np.full(len(vertices), len(removed), dtype=np.intp)
        order = np.argsort(
            np.linalg.norm(vertices[removed] - vertices[stays], axis=1), kind="stable"
        )
        removed, shortest_edge = np.unique(
            removed[order], return_index=True
        )  # for each vertex only the shortest collapse
        stays = stays[order][shortest_edge]
        target = np.full(len(vertices), -1, dtype=np.intp)
        target[removed] = stays
        allowed = _find_allowed_collapses(vertices, triangles, edges, target, longest)
        mixed = np.random.default_rng(0).permutation(
            np.flatnonzero(allowed[removed])
        )  # random order, or long rows of vertices wait for each other
        removed, stays = removed[mixed], stays[mixed]
        # no adjacent collapses: collapse only the first vertex of a triangle
        number = np.full(len(vertices), len(removed), dtype=np.intp)
        number[removed] = np.arange(len(removed))
        lowest_number = np.full(len(triangles), len(removed), dtype=np.intp)
        np.minimum(number[triangles].min(axis=1), lowest_number, out=lowest_number)
        np.minimum.at(rank, triangles.ravel(), np.repeat(lowest_number, 3))
        # rank: first collapse among the triangles at a vertex; a collapse is free if it is first
        # everywhere on its ring
        ring_rank = np.full(len(vertices), len(removed), dtype=np.intp)
        np.minimum.at(ring_rank, triangles.ravel(), np.repeat(rank[triangles].min(axis=1), 3))
        free = ring_rank[removed] == np.arange(len(removed))
        if not free.any():
            break
        into[removed[free]] = stays[free]
        triangles = into[triangles]
        has_area = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
        triangles, owner = triangles[has_area], owner[has_area]
    return triangles, owner


def _candidates(
    vertices: Array, triangles: Index, owner: Index, edges: Edges, short: Mask
) -> tuple[Index, Index]:
    """Return vertices that may be removed, and the neighbours into which they collapse."""
    adjacent = owner[edges.faces]
    curve = (edges.count != 2) | (adjacent[:, 0] != adjacent[:, 1])
    on_curve = np.bincount(edges.ends[curve].ravel(), minlength=len(vertices))
    along = np.zeros((len(vertices), 3))
    unit = vertices[edges.ends[curve, 1]] - vertices[edges.ends[curve, 0]]
    unit /= np.maximum(np.linalg.norm(unit, axis=1, keepdims=True), 1e-300)
    np.add.at(along, edges.ends[curve, 0], unit)
    np.add.at(along, edges.ends[curve, 1], -unit)
    straight = np.linalg.norm(along, axis=1) < np.sqrt(2.0 - 2.0 * MIN_STRAIGHT_COSINE)
    gone = np.concatenate([edges.ends[short, 0], edges.ends[short, 1]])
    stays = np.concatenate([edges.ends[short, 1], edges.ends[short, 0]])
    bound = np.tile(curve[short], 2)
    free = (on_curve[gone] == 0) | ((on_curve[gone] == 2) & straight[gone] & bound)
    return gone[free], stays[free]


def _find_allowed_collapses(
    vertices: Array, triangles: Index, edges: Edges, target: Index, longest: float
) -> Mask:
    """Return which vertices (n,) may move to their target (n,), -1 for none.

    A move must not reverse a triangle or make an edge too long.
    """
    allowed = target >= 0
    normal = _normals(vertices[triangles])
    for k in range(3):
        tip = triangles[:, k]
        following = triangles[:, (k + 1) % 3]
        third = triangles[:, (k + 2) % 3]
        to = target[tip]
        moved = (to >= 0) & (to != following) & (to != third)
        new = _normals(
            np.stack(
                [vertices[to[moved]], vertices[following[moved]], vertices[third[moved]]], axis=1
            )
        )
        new_length = np.linalg.norm(vertices[to[moved]] - vertices[following[moved]], axis=1)
        new_length = np.maximum(
            new_length, np.linalg.norm(vertices[to[moved]] - vertices[third[moved]], axis=1)
        )
        bad = (dot(new, normal[moved]) < MIN_NORMAL_COSINE) | (new_length > longest)
        allowed[tip[moved][bad]] = False
    # the ends may share only neighbours in common triangles
    ends = np.concatenate([edges.ends, edges.ends[:, ::-1]])
    order = np.argsort(ends[:, 0], kind="stable")
    begin = np.searchsorted(ends[order, 0], np.arange(len(vertices) + 1))
    candidates = np.flatnonzero(allowed)
    count = begin[candidates + 1] - begin[candidates]
    candidate = np.repeat(candidates, count)
    position = np.repeat(begin[candidates] - np.r_[0, np.cumsum(count)[:-1]], count) + np.arange(
        count.sum()
    )
    neighbour = ends[order[position], 1]
    base = len(vertices)
    keys = np.sort(ends[:, 0] * base + ends[:, 1])
    keys_asked = neighbour * base + target[candidate]
    spot = np.minimum(np.searchsorted(keys, keys_asked), len(keys) - 1)
    common = np.bincount(candidate, weights=(keys[spot] == keys_asked), minlength=len(vertices))
    pair = np.sort(np.stack([candidates, target[candidates]], axis=1), axis=1)
    known_keys, pair_keys = (ends[:, 0] * base + ends[:, 1] for ends in (edges.ends, pair))
    number = np.searchsorted(known_keys, pair_keys)
    allowed[candidates[common[candidates] != edges.count[number]]] = False
    return allowed


def _normals(corners: Array) -> Array:
    normal = doubled_areas(corners)
    unit: Array = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    return unit
