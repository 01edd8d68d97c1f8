# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangle meshes made coarser: short edges are collapsed where that keeps the mesh's shape (Hoppe et al. 1993)."""

from __future__ import annotations

import numpy as np

from ...types import Array, Index, Mask
from ..walls.surface import dot
from .facets import doubled_areas
from .refined import Edges

ROUNDS = 4
STRAIGHT = np.cos(np.radians(25.0))  # of a turn of a curve at a vertex that may go
UPRIGHT = np.cos(np.radians(30.0))  # of a turn of a triangle when a corner moves


def collapsed(
    vertices: Array, triangles: Index, owner: Index, shortest: float, longest: float
) -> tuple[Index, Index]:
    """The triangles and owners that are left when edges shorter than `shortest` mm are drawn together, none becoming longer
    than `longest`. Vertices on boundaries and between owners move along those curves alone; vertices are not renumbered."""
    for _ in range(ROUNDS):
        edges = Edges(triangles)
        length = np.linalg.norm(vertices[edges.ends[:, 0]] - vertices[edges.ends[:, 1]], axis=1)
        gone, stays = _candidates(vertices, triangles, owner, edges, length < shortest)
        if not len(gone):
            break
        into = np.arange(len(vertices))
        rank = np.full(len(vertices), len(gone), dtype=np.intp)
        order = np.argsort(np.linalg.norm(vertices[gone] - vertices[stays], axis=1), kind="stable")
        gone, first = np.unique(
            gone[order], return_index=True
        )  # one way for each vertex, the shortest
        stays = stays[order][first]
        target = np.full(len(vertices), -1, dtype=np.intp)
        target[gone] = stays
        allowed = _allowed(vertices, triangles, edges, target, longest)
        mixed = np.random.default_rng(0).permutation(
            np.flatnonzero(allowed[gone])
        )  # or long rows wait for each other
        gone, stays = gone[mixed], stays[mixed]
        # no two next to each other: of those that touch a triangle only the first goes
        place = np.full(len(vertices), len(gone), dtype=np.intp)
        place[gone] = np.arange(len(gone))
        least = np.full(len(triangles), len(gone), dtype=np.intp)
        np.minimum(place[triangles].min(axis=1), least, out=least)
        np.minimum.at(rank, triangles.ravel(), np.repeat(least, 3))
        # rank: the first among all that a vertex's triangles touch; a collapse is free when it is so all over its ring
        wide = np.full(len(vertices), len(gone), dtype=np.intp)
        np.minimum.at(wide, triangles.ravel(), np.repeat(rank[triangles].min(axis=1), 3))
        free = wide[gone] == np.arange(len(gone))
        if not free.any():
            break
        into[gone[free]] = stays[free]
        triangles = into[triangles]
        whole = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
        triangles, owner = triangles[whole], owner[whole]
    return triangles, owner


def _candidates(
    vertices: Array, triangles: Index, owner: Index, edges: Edges, short: Mask
) -> tuple[Index, Index]:
    """Vertices that may go and the neighbours that they may go to."""
    adjacent = owner[edges.faces]
    curve = (edges.count != 2) | (adjacent[:, 0] != adjacent[:, 1])
    on_curve = np.bincount(edges.ends[curve].ravel(), minlength=len(vertices))
    along = np.zeros((len(vertices), 3))
    unit = vertices[edges.ends[curve, 1]] - vertices[edges.ends[curve, 0]]
    unit /= np.maximum(np.linalg.norm(unit, axis=1, keepdims=True), 1e-300)
    np.add.at(along, edges.ends[curve, 0], unit)
    np.add.at(along, edges.ends[curve, 1], -unit)
    straight = np.linalg.norm(along, axis=1) < np.sqrt(2.0 - 2.0 * STRAIGHT)
    gone = np.concatenate([edges.ends[short, 0], edges.ends[short, 1]])
    stays = np.concatenate([edges.ends[short, 1], edges.ends[short, 0]])
    bound = np.tile(curve[short], 2)
    free = (on_curve[gone] == 0) | ((on_curve[gone] == 2) & straight[gone] & bound)
    return gone[free], stays[free]


def _allowed(
    vertices: Array, triangles: Index, edges: Edges, target: Index, longest: float
) -> Mask:
    """Vertices (n,) whose move to their target (n,), -1 for none, turns no triangle over and makes no edge too long."""
    allowed = target >= 0
    normal = _normals(vertices[triangles])
    for k in range(3):
        tip, following, other = (
            triangles[:, k],
            triangles[:, (k + 1) % 3],
            triangles[:, (k + 2) % 3],
        )
        to = target[tip]
        moved = (to >= 0) & (to != following) & (to != other)
        new = _normals(
            np.stack(
                [vertices[to[moved]], vertices[following[moved]], vertices[other[moved]]], axis=1
            )
        )
        far = np.linalg.norm(vertices[to[moved]] - vertices[following[moved]], axis=1)
        far = np.maximum(far, np.linalg.norm(vertices[to[moved]] - vertices[other[moved]], axis=1))
        bad = (dot(new, normal[moved]) < UPRIGHT) | (far > longest)
        allowed[tip[moved][bad]] = False
    # the two ends may share no neighbours but those of their own triangles
    ends = np.concatenate([edges.ends, edges.ends[:, ::-1]])
    order = np.argsort(ends[:, 0], kind="stable")
    begin = np.searchsorted(ends[order, 0], np.arange(len(vertices) + 1))
    chosen = np.flatnonzero(allowed)
    count = begin[chosen + 1] - begin[chosen]
    each = np.repeat(chosen, count)
    at = np.repeat(begin[chosen] - np.r_[0, np.cumsum(count)[:-1]], count) + np.arange(count.sum())
    neighbour = ends[order[at], 1]
    base = len(vertices)
    keys = np.sort(ends[:, 0] * base + ends[:, 1])
    asked = neighbour * base + target[each]
    spot = np.minimum(np.searchsorted(keys, asked), len(keys) - 1)
    common = np.bincount(each, weights=(keys[spot] == asked), minlength=len(vertices))
    pair = np.sort(np.stack([chosen, target[chosen]], axis=1), axis=1)
    known, wanted = (ends[:, 0] * base + ends[:, 1] for ends in (edges.ends, pair))
    number = np.searchsorted(known, wanted)
    allowed[chosen[common[chosen] != edges.count[number]]] = False
    return allowed


def _normals(corners: Array) -> Array:
    normal = doubled_areas(corners)
    unit: Array = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    return unit
