# SPDX-License-Identifier: LGPL-2.1-or-later
"""A curved piece of a surface flattened with minimal distortion.

First conformally, with free borders (least squares conformal maps, Levy 2002): exact for
a surface that can be flattened without distortion. Other surfaces are made as rigid as
possible from there (Liu 2008, a local/global approach to mesh parameterization).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import splu

from ...geometry.mesh.triangle_mesh import Mesh
from ...types import Array

FLAT_SHARE = 1e-6  # of the extent; a piece this near to a plane is projected onto it
GOOD_STRETCH = 2e-3  # stretch that is irrelevant for beads; not improved further
ROUNDS = 12
MIN_WEIGHT = 0.02  # weight of an edge in blunt triangles, whose own would be negative


class Flattened(NamedTuple):
    """points: (n, 2) mm of a mesh's vertices on the plane. min_stretch, max_stretch: (m,) of
    each triangle.
    """

    points: Array
    min_stretch: Array
    max_stretch: Array


def flatten(mesh: Mesh) -> Flattened:
    """Return a connected piece flattened, with counter-clockwise triangles kept
    counter-clockwise, of the same area.
    """
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
    """Return flat points (n, 2) moved about the origin and turned so that x runs as the part's X
    does, as well as possible.

    Where the piece is normal to X, the part's Y replaces X.
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
    along, across = (
        (centred * projected).sum(),
        (centred[:, 0] * projected[:, 1] - centred[:, 1] * projected[:, 0]).sum(),
    )
    angle = np.arctan2(across, along)
    cos, sin = np.cos(angle), np.sin(angle)
    moved: Array = centred @ np.array([[cos, sin], [-sin, cos]])
    return moved


def measure_stretch(mesh: Mesh, flat: Array) -> tuple[Array, Array]:
    """Return the minimum and maximum stretch (m,) of each triangle by flattening; negative where
    it is turned over.
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
    """Return the corners (m, 3, 2) of each triangle in its own plane."""
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
    """The two sides (m, 2, 2) from the first corner."""
    return np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=1)


def _cotangents(local: Array) -> Array:
    """Return half the cotangent (m, 3) of the angle opposite to the side from corner k to the
    next.
    """
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
    """Return the least squares conformal map (n, 2) of a piece; two distant vertices are pinned."""
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
    """Return the flat points scaled to the area of the piece."""
    sides_in_part, sides_flat = (_sides(corners) for corners in (_corners(mesh), flat[mesh.faces]))
    size = [
        0.5 * np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]).sum()
        for sides in (sides_in_part, sides_flat)
    ]
    scaled: Array = flat * np.sqrt(size[0] / max(float(size[1]), 1e-300))
    return scaled


def _make_rigid(mesh: Mesh, local: Array, weights: Array, flat: Array) -> Array:
    """Return the flat points moved until each triangle is as nearly rotated, not stretched, as
    the whole allows.
    """
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
