# SPDX-License-Identifier: LGPL-2.1-or-later
"""A curved sheet in pieces that can be laid flat: as it is, opened along a line, or halved until each can."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ...geometry.curves.plane_curve import doubled_area
from ...geometry.mesh.triangle_mesh import Mesh, chains
from ...geometry.regions.region import regions
from ...types import Array, Index, Mask
from .flattening import Flattened, flattened

OUTER = (
    0.02  # share of the area whose stretch does not count: slivers, and the very corners of fans
)
OVERLAID = 0.01  # share of the area by which a picture may lie on itself
HALVINGS = 8
ONTO, ASIDE = (
    0.3,
    0.05,
)  # typical edges; vertices so near to a cut are moved onto it, those of the border count as beside it


def stretch_of(flat: Flattened, weight: Array) -> float:
    """The stretch or squeeze that all triangles but OUTER of their weight (m,) keep below."""
    each = np.maximum(flat.most - 1.0, 1.0 - flat.least)
    order = np.argsort(each, kind="stable")
    done = np.cumsum(weight[order])
    return float(each[order[np.searchsorted(done, (1.0 - OUTER) * done[-1])]])


def parted(mesh: Mesh, most: float, halvings: int = HALVINGS) -> Iterator[Mesh]:
    """The connected pieces of a mesh, each such that laying it flat stretches or squeezes it by no more than a share `most`,
    after HALVINGS as it is."""
    for one in connected(mesh):
        if halvings == 0 or _lies_flat(one, most):
            yield one
            continue
        opened = _opened(one)
        if opened is not None and _lies_flat(opened, most):
            yield opened
            continue
        yield from parted(split(one, *_longest(one)), most, halvings - 1)


def connected(mesh: Mesh) -> Iterator[Mesh]:
    """The pieces of a mesh that hang together."""
    pairs = mesh.edges
    n = len(mesh.vertices)
    label = connected_components(
        coo_matrix((np.ones(len(pairs)), pairs.T), shape=(n, n)), directed=False
    )[1]
    owner = label[mesh.faces[:, 0]]
    for one in np.unique(owner):
        yield mesh.part(np.flatnonzero(owner == one))[0]


def split(
    mesh: Mesh, middle: Array, across: Array, where: Callable[[Array], Mask] | None = None
) -> Mesh:
    """The mesh cut by the plane through a point (3,) with a unit normal (3,); with `where`(points (k, 3)) it hangs together
    at places of the cut for which that is not true."""
    value = (mesh.vertices - middle) @ across
    border = np.zeros(len(value), dtype=bool)
    border[mesh.border_edges] = True
    on = _onto(mesh, value, across, border)
    vertices = mesh.vertices - np.where(on, value, 0.0)[:, None] * across
    aside = ASIDE * mesh.typical_edge
    value = np.where(np.abs(value) < aside, np.where(value < 0.0, -aside, aside), value)
    low = (value < 0.0) | on
    count = low[mesh.faces].sum(axis=1)
    mixed = (count == 1) | (count == 2)
    corners, single = mesh.faces[mixed], count[mixed] == 1
    odd = np.argmax(low[corners] == single[:, None], axis=1)
    row = np.arange(len(corners))
    a, b, c = corners[row, odd], corners[row, (odd + 1) % 3], corners[row, (odd + 2) % 3]
    pairs = np.vstack([np.stack([a, b], 1), np.stack([a, c], 1)])
    edges, index = np.unique(
        np.where(low[pairs[:, :1]], pairs, pairs[:, ::-1]), axis=0, return_inverse=True
    )
    ab, ac = np.split(np.ravel(index), 2)
    start, end = edges.T  # from the low side to the other
    share = (
        np.where(on[start], 0.0, value[start])
        / (np.where(on[start], 0.0, value[start]) - value[end])
    )[:, None]
    points = (1.0 - share) * vertices[start] + share * vertices[end]
    n, k = len(vertices), len(points)
    below = np.where(on[start], start, n + np.arange(k))
    above = np.where(on[start], n + 2 * k + start, n + k + np.arange(k))
    if where is not None:
        above = np.where(where(points), above, below)
    own, rest = (
        np.where(
            low[a][:, None], np.stack([one[ab], one[ac]], 1), np.stack([other[ab], other[ac]], 1)
        )
        for one, other in ((below, above), (above, below))
    )
    faces = np.vstack(
        [
            mesh.faces[~mixed],
            np.stack([a, own[:, 0], own[:, 1]], 1),
            np.stack([rest[:, 0], b, c], 1),
            np.stack([rest[:, 0], c, rest[:, 1]], 1),
        ]
    )
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    used, index = np.unique(faces, return_inverse=True)
    return Mesh(
        np.vstack([vertices, points, points, vertices])[used],
        np.ravel(index).reshape(-1, 3).astype(np.intp),
    )


def _onto(mesh: Mesh, value: Array, across: Array, border: Mask) -> Mask:
    """The vertices (n,) that are moved onto a cut, value (n,) mm from it along its normal (3,): those near it, but of two
    that an edge joins and that would meet there, or nearly, the nearer one: what has no area cannot be laid flat."""
    near = ONTO * mesh.typical_edge
    on = (np.abs(value) < near) & ~border
    pairs = mesh.edges[on[mesh.edges].all(axis=1)]
    along = mesh.vertices[pairs[:, 1]] - mesh.vertices[pairs[:, 0]]
    along -= np.outer(along @ across, across)
    pairs = pairs[np.linalg.norm(along, axis=1) < near]
    farther = np.abs(value[pairs[:, 0]]) < np.abs(value[pairs[:, 1]])
    on[np.where(farther, pairs[:, 1], pairs[:, 0])] = False
    return on


def _lies_flat(mesh: Mesh, most: float) -> bool:
    """Whether a piece can be laid flat within a share `most`, and does not lie on itself then."""
    if not len(mesh.border_edges):
        return False
    flat = flattened(mesh)
    if not np.isfinite(flat.points).all() or stretch_of(flat, mesh.areas) > most:
        return False
    loops = [flat.points[chain] for chain in borders(mesh)]
    bounded = 0.5 * sum(doubled_area(loop) for loop in loops)
    return abs(sum(one.area for one in regions(loops)) - bounded) <= OVERLAID * max(bounded, 0.0)


def borders(mesh: Mesh) -> list[Index]:
    """The vertices (k,) of each loop of the border, the mesh on the left."""
    edges = mesh.border_edges
    following = np.full(len(mesh.vertices), -1, dtype=np.intp)
    following[edges[:, 0]] = edges[:, 1]
    return [chain for chain, closed in chains(following) if closed and len(chain) > 2]


def _opened(mesh: Mesh) -> Mesh | None:
    """A piece that runs round an axis cut along one half plane of that; None where it is no such piece."""
    if len(borders(mesh)) < 2:
        return None
    areas = mesh.areas
    middle = (areas[:, None] * mesh.vertices[mesh.faces].mean(axis=1)).sum(axis=0) / areas.sum()
    units = mesh.area_vectors / np.maximum(areas, 1e-300)[:, None]
    mean = (areas[:, None] * units).sum(axis=0) / areas.sum()
    axis = np.linalg.eigh((areas[:, None] * (units - mean)).T @ (units - mean))[1][:, 0]
    aside = np.eye(3)[int(np.argmin(np.abs(axis)))]
    out = aside - (aside @ axis) * axis
    out /= np.linalg.norm(out)
    across = np.cross(axis, out)
    made = split(mesh, middle, across, lambda points: (points - middle) @ out < 0.0)
    found = list(connected(made))
    return found[0] if len(found) == 1 else None


def _longest(mesh: Mesh) -> tuple[Array, Array]:
    """The middle (3,) of a piece and the unit vector (3,) that it is longest along."""
    areas = mesh.areas
    corners = mesh.vertices[mesh.faces].mean(axis=1)
    middle = (areas[:, None] * corners).sum(axis=0) / areas.sum()
    away = corners - middle
    axis: Array = np.linalg.eigh((areas[:, None] * away).T @ away)[1][:, -1]
    axis = axis * (1.0 if axis[int(np.argmax(np.abs(axis)))] > 0.0 else -1.0)
    return middle, axis
