# SPDX-License-Identifier: LGPL-2.1-or-later
"""Split a curved sheet into pieces that can be flattened, and flatten them.

A sheet stays whole, is cut open along a line, or is halved until each piece can be flattened.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from ..geometry.curves.plane_curve import doubled_area
from ..geometry.mesh.triangle_mesh import Mesh, chains
from ..geometry.regions.region import regions
from ..types import Array, Index, Mask

FLAT_SHARE = 1e-6  # fraction of the extent; a piece this close to a plane is projected onto it
GOOD_STRETCH = 2e-3  # negligible stretch for beads; a flattening this good is not improved further
ROUNDS = 12  # as-rigid-as-possible iterations
MIN_WEIGHT = 0.02  # minimum edge weight; obtuse triangles would have negative cotangent weights


class Flattened(NamedTuple):
    """Flattened mesh.

    points: (n, 2) vertices on the plane, mm. min_stretch, max_stretch: (m,) minimum and maximum
    ratio of lengths for each triangle.
    """

    points: Array
    min_stretch: Array
    max_stretch: Array


def flatten(mesh: Mesh) -> Flattened:
    """Flatten a connected piece; area and orientation of the piece are preserved."""
    middle = mesh.vertices.mean(axis=0)
    offset = mesh.vertices - middle
    axes = np.linalg.svd(offset, full_matrices=False)[2]
    normal = _area_vector(mesh)
    if np.abs(offset @ axes[2]).max() <= FLAT_SHARE * float(np.ptp(offset, axis=0).max()):
        up = axes[2] * (1.0 if axes[2] @ normal > 0.0 else -1.0)
        x = axes[0]
        flat = offset @ np.stack([x, np.cross(up, x)], axis=1)
        return Flattened(flat, *measure_stretch(mesh, flat))
    local = _corners(mesh)
    weights = _cotangents(local)
    flat = _scale_to_area(mesh, _map_conformally(mesh, weights))
    min_stretch, max_stretch = measure_stretch(mesh, flat)
    if max(float(max_stretch.max()) - 1.0, 1.0 - float(min_stretch.min())) > GOOD_STRETCH:
        flat = _make_rigid(mesh, local, np.maximum(weights, MIN_WEIGHT), flat)
    return Flattened(flat, *measure_stretch(mesh, flat))


def align_to_x(mesh: Mesh, flat: Array) -> Array:
    """Rotate flat points so that x is as close as possible to the part's X.

    If the piece is normal to X, the part's Y replaces X.

    Parameters
    ----------
    mesh : Mesh
        The piece in the part.
    flat : (n, 2) array
        Vertices of the piece on the plane, mm.

    Returns
    -------
    (n, 2) array
        The rotated points, centred at the origin, mm.
    """
    up = _area_vector(mesh)
    up /= max(float(np.linalg.norm(up)), 1e-300)
    x = np.eye(3)[0] - up[0] * up
    if np.linalg.norm(x) < 1e-3:
        x = np.eye(3)[1] - up[1] * up
    x /= np.linalg.norm(x)
    projected = (mesh.vertices - mesh.vertices.mean(axis=0)) @ np.stack(
        [x, np.cross(up, x)], axis=1
    )
    centred = flat - flat.mean(axis=0)
    along = (centred * projected).sum()
    across = (centred[:, 0] * projected[:, 1] - centred[:, 1] * projected[:, 0]).sum()
    angle = np.arctan2(across, along)
    cos, sin = np.cos(angle), np.sin(angle)
    moved: Array = centred @ np.array([[cos, sin], [-sin, cos]])
    return moved


def measure_stretch(mesh: Mesh, flat: Array) -> tuple[Array, Array]:
    """Measure how flattening stretches each triangle.

    Parameters
    ----------
    mesh : Mesh
        The piece in the part, m triangles.
    flat : (n, 2) array
        Vertices of the piece on the plane, mm.

    Returns
    -------
    low, high : (m,) array
        Minimum and maximum ratio of lengths; `low` is negative for flipped triangles.
    """
    local = _corners(mesh)
    sides_in_part, sides_flat = _sides(local), _sides(flat[mesh.faces])
    area = (
        sides_in_part[:, 0, 0] * sides_in_part[:, 1, 1]
        - sides_in_part[:, 0, 1] * sides_in_part[:, 1, 0]
    )
    inverse = (
        np.stack(
            [
                np.stack([sides_in_part[:, 1, 1], -sides_in_part[:, 0, 1]], axis=1),
                np.stack([-sides_in_part[:, 1, 0], sides_in_part[:, 0, 0]], axis=1),
            ],
            axis=1,
        )
        / np.maximum(area, 1e-300)[:, None, None]
    )
    map_ = inverse @ sides_flat
    a, b, c, d = map_[:, 0, 0], map_[:, 0, 1], map_[:, 1, 0], map_[:, 1, 1]
    sum_of_stretches, difference_of_stretches = np.hypot(a + d, b - c), np.hypot(a - d, b + c)
    return 0.5 * (sum_of_stretches - difference_of_stretches), 0.5 * (
        sum_of_stretches + difference_of_stretches
    )


def _area_vector(mesh: Mesh) -> Array:
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    vector: Array = np.cross(b - a, c - a).sum(axis=0)
    return vector


def _corners(mesh: Mesh) -> Array:
    """Return the corners (m, 3, 2) of each triangle in the plane of the triangle."""
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    along, third_edge = b - a, c - a
    length = np.linalg.norm(along, axis=1)
    x = (along * third_edge).sum(axis=1) / np.maximum(length, 1e-300)
    y = np.linalg.norm(np.cross(along, third_edge), axis=1) / np.maximum(length, 1e-300)
    zero = np.zeros(len(length))
    return np.stack(
        [np.stack([zero, zero], 1), np.stack([length, zero], 1), np.stack([x, y], 1)], axis=1
    )


def _sides(corners: Array) -> Array:
    """Return the two sides (m, 2, 2) of each triangle that start at the first corner."""
    return np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=1)


def _cotangents(local: Array) -> Array:
    """Return half the cotangents (m, 3) of the angles opposite to the sides from k to k + 1."""
    cotangents = []
    for k in range(3):
        apex = local[:, (k + 2) % 3]
        edge_a, edge_b = local[:, k] - apex, local[:, (k + 1) % 3] - apex
        cross = np.abs(edge_a[:, 0] * edge_b[:, 1] - edge_a[:, 1] * edge_b[:, 0])
        cotangents.append(0.5 * (edge_a * edge_b).sum(axis=1) / np.maximum(cross, 1e-12))
    return np.stack(cotangents, axis=1)


def _laplacian(mesh: Mesh, weights: Array) -> csc_matrix:
    a, b, w = mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel(), weights.ravel()
    n = len(mesh.vertices)
    rows, columns = np.r_[a, b, a, b], np.r_[a, b, b, a]
    return coo_matrix((np.r_[w, w, -w, -w], (rows, columns)), shape=(n, n)).tocsc()


def _map_conformally(mesh: Mesh, weights: Array) -> Array:
    """Compute the least squares conformal map (n, 2) of a piece, with two distant vertices pinned."""
    n = len(mesh.vertices)
    start, end = mesh.border_edges.T
    rows, columns = np.r_[start, end], np.r_[end, start]
    share = np.r_[np.full(len(start), 0.25 / 1j), np.full(len(start), -0.25 / 1j)]
    area = coo_matrix((share, (rows, columns)), shape=(n, n))
    energy = (0.5 * _laplacian(mesh, weights) - area).tocsc()
    far_vertex = int(np.argmax(np.linalg.norm(mesh.vertices - mesh.vertices.mean(axis=0), axis=1)))
    distance = np.linalg.norm(mesh.vertices - mesh.vertices[far_vertex], axis=1)
    pinned = np.array([far_vertex, int(np.argmax(distance))])
    free = np.setdiff1d(np.arange(n), pinned)
    z = np.zeros(n, dtype=complex)
    z[pinned[1]] = distance[pinned[1]]
    z[free] = splu(energy[free][:, free].tocsc()).solve(-(energy[free][:, pinned] @ z[pinned]))
    return np.stack([z.real, z.imag], axis=1)


def _scale_to_area(mesh: Mesh, flat: Array) -> Array:
    """Scale the flat points to the area of the piece."""
    sides_in_part, sides_flat = (_sides(corners) for corners in (_corners(mesh), flat[mesh.faces]))
    size = [
        0.5 * np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]).sum()
        for sides in (sides_in_part, sides_flat)
    ]
    scaled: Array = flat * np.sqrt(size[0] / max(float(size[1]), 1e-300))
    return scaled


def _make_rigid(mesh: Mesh, local: Array, weights: Array, flat: Array) -> Array:
    """Move the flat points as rigidly as possible: rotate triangles with minimum stretch."""
    n = len(flat)
    solver = splu(_laplacian(mesh, weights)[1:, 1:].tocsc())
    side = np.roll(local, -1, axis=1) - local
    start, end = mesh.faces, np.roll(mesh.faces, -1, axis=1)
    for _ in range(ROUNDS):
        now = flat[end] - flat[start]
        cos = (weights * (side * now).sum(axis=2)).sum(axis=1)
        sin = (weights * (side[..., 0] * now[..., 1] - side[..., 1] * now[..., 0])).sum(axis=1)
        size = np.maximum(np.hypot(cos, sin), 1e-300)
        cos, sin = (cos / size)[:, None], (sin / size)[:, None]
        target_sides = weights[..., None] * np.stack(
            [cos * side[..., 0] - sin * side[..., 1], sin * side[..., 0] + cos * side[..., 1]],
            axis=2,
        )
        right = np.zeros((n, 2))
        for axis in range(2):
            right[:, axis] = np.bincount(end.ravel(), target_sides[..., axis].ravel(), n)
            right[:, axis] -= np.bincount(start.ravel(), target_sides[..., axis].ravel(), n)
        flat = np.vstack([np.zeros((1, 2)), solver.solve(right[1:])])
    return flat


IGNORED_SHARE = 0.02  # fraction of the area whose stretch is ignored: slivers and tips of fans
MAX_OVERLAP_SHARE = 0.01  # fraction of the area; maximum overlap of a flattened piece with itself
HALVINGS = 8  # maximum number of successive halvings of a piece
# in typical edges; maximum distance of vertices that are snapped onto a cut, and minimum distance
# that other vertices, such as those of the border, are taken to have
SNAP_SHARE, MIN_OFFSET_SHARE = 0.3, 0.05


def stretch_of(flat: Flattened, weight: Array) -> float:
    """Return the stretch or compression that most triangles do not exceed.

    The worst triangles, with IGNORED_SHARE of the weight, do not count.

    Parameters
    ----------
    flat : Flattened
        The flattened triangles.
    weight : (m,) array
        Weights of the triangles, such as areas.

    Returns
    -------
    float
        Relative change of length; 0 without stretch.
    """
    stretch = np.maximum(flat.max_stretch - 1.0, 1.0 - flat.min_stretch)
    order = np.argsort(stretch, kind="stable")
    weight_below = np.cumsum(weight[order])
    return float(
        stretch[order[np.searchsorted(weight_below, (1.0 - IGNORED_SHARE) * weight_below[-1])]]
    )


def split_flattenable(mesh: Mesh, max_stretch: float, halvings: int = HALVINGS) -> Iterator[Mesh]:
    """Split a mesh into connected pieces that can be flattened.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    max_stretch : float
        Maximum relative stretch or compression by flattening.
    halvings : int, optional
        Maximum number of successive halvings; after them a piece is yielded unchecked.

    Yields
    ------
    Mesh
        The pieces.
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
    """Cut a mesh by a plane.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    middle : (3,) array
        A point of the plane, mm.
    across : (3,) array
        Unit normal of the plane.
    where : callable, optional
        Returns for points (k, 3) of the cut whether the cut separates the mesh there; None:
        everywhere.

    Returns
    -------
    Mesh
        The mesh with duplicate vertices along the cut.
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
    """Return a mask (n,) of the vertices that snap onto a cut.

    value: (n,) distances from the cut, mm. across: (3,) unit normal of the cut. Vertices close to
    the cut snap. If two vertices of an edge would nearly coincide on the cut, only the closer
    vertex snaps, because a triangle without area cannot be flattened.
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
    """Whether a piece can be flattened within `max_stretch` and without overlapping itself."""
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
    """Return the border loops of a mesh.

    Parameters
    ----------
    mesh : Mesh
        The mesh.

    Returns
    -------
    list of (k,) array of int
        Vertex indices of each loop, with the mesh on the left.
    """
    edges = mesh.border_edges
    following = np.full(len(mesh.vertices), -1, dtype=np.intp)
    following[edges[:, 0]] = edges[:, 1]
    return [chain for chain, closed in chains(following) if closed and len(chain) > 2]


def _open_ring(mesh: Mesh) -> Mesh | None:
    """Cut a piece that runs around an axis along a half plane through the axis.

    Returns None for any other piece.
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
    """Return the centroid (3,) of a piece and the unit vector (3,) along its longest extent."""
    areas = mesh.areas
    corners = mesh.vertices[mesh.faces].mean(axis=1)
    middle = (areas[:, None] * corners).sum(axis=0) / areas.sum()
    offsets = corners - middle
    axis: Array = np.linalg.eigh((areas[:, None] * offsets).T @ offsets)[1][:, -1]
    axis = axis * (1.0 if axis[int(np.argmax(np.abs(axis)))] > 0.0 else -1.0)
    return middle, axis
