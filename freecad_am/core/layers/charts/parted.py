# SPDX-License-Identifier: LGPL-2.1-or-later
"""A curved sheet in pieces that can be flattened: whole, opened along a line, or halved
until each piece can.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ...geometry.curves.plane_curve import doubled_area
from ...geometry.mesh.triangle_mesh import Mesh, chains
from ...geometry.regions.region import regions
from ...types import Array, Index, Mask
from .flattening import Flattened, flatten

IGNORED_SHARE = (
    0.02  # share of the area whose stretch does not count: slivers, and the very corners of fans
)
MAX_OVERLAP_SHARE = 0.01  # share of the area by which a picture may overlap itself
HALVINGS = 8
SNAP_SHARE, MIN_OFFSET_SHARE = (
    0.3,
    0.05,
)  # typical edges; vertices this near to a cut are moved onto it, border vertices count as next to it


def stretch_of(flat: Flattened, weight: Array) -> float:
    """Return the stretch or squeeze that all triangles keep below, except for IGNORED_SHARE of
    their weight (m,).
    """
    stretch = np.maximum(flat.max_stretch - 1.0, 1.0 - flat.min_stretch)
    order = np.argsort(stretch, kind="stable")
    weight_below = np.cumsum(weight[order])
    return float(
        stretch[order[np.searchsorted(weight_below, (1.0 - IGNORED_SHARE) * weight_below[-1])]]
    )


def split_flattenable(mesh: Mesh, max_stretch: float, halvings: int = HALVINGS) -> Iterator[Mesh]:
    """Yield connected pieces of a mesh that flattening stretches or squeezes by at most a share
    `max_stretch`.

    After HALVINGS a piece is returned as it is.
    """
    for component in connected_components_of(mesh):
        if halvings == 0 or _is_flattenable(component, max_stretch):
            yield component
            continue
        opened = _open_ring(component)
        if opened is not None and _is_flattenable(opened, max_stretch):
            yield opened
            continue
        yield from split_flattenable(
            cut_mesh(component, *_longest_axis(component)), max_stretch, halvings - 1
        )


def connected_components_of(mesh: Mesh) -> Iterator[Mesh]:
    """Yield the connected components of a mesh."""
    pairs = mesh.edges
    n = len(mesh.vertices)
    label = connected_components(
        coo_matrix((np.ones(len(pairs)), pairs.T), shape=(n, n)), directed=False
    )[1]
    owner = label[mesh.faces[:, 0]]
    for component in np.unique(owner):
        yield mesh.part(np.flatnonzero(owner == component))[0]


def cut_mesh(
    mesh: Mesh, middle: Array, across: Array, where: Callable[[Array], Mask] | None = None
) -> Mesh:
    """Cut the mesh by the plane through a point (3,) with a unit normal (3,).

    With `where`(points (k, 3)) it stays connected at points of the cut for which that is
    False.
    """
    value = (mesh.vertices - middle) @ across
    border = np.zeros(len(value), dtype=bool)
    border[mesh.border_edges] = True
    on = _find_snapped(mesh, value, across, border)
    vertices = mesh.vertices - np.where(on, value, 0.0)[:, None] * across
    aside = MIN_OFFSET_SHARE * mesh.typical_edge
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
    start, end = edges.T  # from the low side to the high side
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
    low_rows, high_rows = (
        np.where(
            low[a][:, None],
            np.stack([low_points[ab], low_points[ac]], 1),
            np.stack([high_points[ab], high_points[ac]], 1),
        )
        for low_points, high_points in ((below, above), (above, below))
    )
    faces = np.vstack(
        [
            mesh.faces[~mixed],
            np.stack([a, low_rows[:, 0], low_rows[:, 1]], 1),
            np.stack([high_rows[:, 0], b, c], 1),
            np.stack([high_rows[:, 0], c, high_rows[:, 1]], 1),
        ]
    )
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    used, index = np.unique(faces, return_inverse=True)
    return Mesh(
        np.vstack([vertices, points, points, vertices])[used],
        np.ravel(index).reshape(-1, 3).astype(np.intp),
    )


def _find_snapped(mesh: Mesh, value: Array, across: Array, border: Mask) -> Mask:
    """Return which vertices (n,) are moved onto a cut, value (n,) mm from it along its normal
    (3,).

    They are near it; of two joined by an edge that would nearly coincide there, only the
    nearer one: a triangle without area cannot be flattened.
    """
    snap_distance = SNAP_SHARE * mesh.typical_edge
    on = (np.abs(value) < snap_distance) & ~border
    pairs = mesh.edges[on[mesh.edges].all(axis=1)]
    along = mesh.vertices[pairs[:, 1]] - mesh.vertices[pairs[:, 0]]
    along -= np.outer(along @ across, across)
    pairs = pairs[np.linalg.norm(along, axis=1) < snap_distance]
    farther = np.abs(value[pairs[:, 0]]) < np.abs(value[pairs[:, 1]])
    on[np.where(farther, pairs[:, 1], pairs[:, 0])] = False
    return on


def _is_flattenable(mesh: Mesh, max_stretch: float) -> bool:
    """Return whether a piece can be flattened within a share `max_stretch`, without overlapping
    itself.
    """
    if not len(mesh.border_edges):
        return False
    flat = flatten(mesh)
    if not np.isfinite(flat.points).all() or stretch_of(flat, mesh.areas) > max_stretch:
        return False
    loops = [flat.points[chain] for chain in borders(mesh)]
    bounded = 0.5 * sum(doubled_area(loop) for loop in loops)
    return abs(sum(region.area for region in regions(loops)) - bounded) <= MAX_OVERLAP_SHARE * max(
        bounded, 0.0
    )


def borders(mesh: Mesh) -> list[Index]:
    """The vertices (k,) of each loop of the border, the mesh on the left."""
    edges = mesh.border_edges
    following = np.full(len(mesh.vertices), -1, dtype=np.intp)
    following[edges[:, 0]] = edges[:, 1]
    return [chain for chain, closed in chains(following) if closed and len(chain) > 2]


def _open_ring(mesh: Mesh) -> Mesh | None:
    """Return a piece that runs around an axis, cut along a half plane of the axis; None for any
    other piece.
    """
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
    opened_mesh = cut_mesh(mesh, middle, across, lambda points: (points - middle) @ out < 0.0)
    components = list(connected_components_of(opened_mesh))
    return components[0] if len(components) == 1 else None


def _longest_axis(mesh: Mesh) -> tuple[Array, Array]:
    """Return the middle (3,) of a piece and the unit vector (3,) of its longest extent."""
    areas = mesh.areas
    corners = mesh.vertices[mesh.faces].mean(axis=1)
    middle = (areas[:, None] * corners).sum(axis=0) / areas.sum()
    offsets = corners - middle
    axis: Array = np.linalg.eigh((areas[:, None] * offsets).T @ offsets)[1][:, -1]
    axis = axis * (1.0 if axis[int(np.argmax(np.abs(axis)))] > 0.0 else -1.0)
    return middle, axis
