# SPDX-License-Identifier: LGPL-2.1-or-later
"""A curved piece of a surface laid flat with as little distortion as there can be.

First conformally, with free borders (least squares conformal maps, Levy 2002): exact for whatever can be laid flat without
distortion. What cannot is made as rigid as possible from there (Liu 2008, a local/global approach to mesh parameterization).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import splu

from ...geometry.mesh.triangle_mesh import Mesh
from ...types import Array

FLAT = 1e-6  # of the extent; what lies so near to a plane is moved onto it
ENOUGH = 2e-3  # stretch that no bead tells; made no better
ROUNDS = 12
SMALLEST = 0.02  # weight of an edge in blunt triangles, whose own would be negative


class Flattened(NamedTuple):
    """points: (n, 2) mm of a mesh's vertices on the plane. least, most: (m,) by how much each triangle is stretched."""

    points: Array
    least: Array
    most: Array


def flattened(mesh: Mesh) -> Flattened:
    """A connected piece laid flat, counter-clockwise triangles staying so, of the same area as before."""
    middle = mesh.vertices.mean(axis=0)
    offset = mesh.vertices - middle
    axes = np.linalg.svd(offset, full_matrices=False)[2]
    normal = _area_vector(mesh)
    if np.abs(offset @ axes[2]).max() <= FLAT * float(np.ptp(offset, axis=0).max()):
        up = axes[2] * (1.0 if axes[2] @ normal > 0.0 else -1.0)
        x = axes[0]
        flat = offset @ np.stack([x, np.cross(up, x)], axis=1)
        return Flattened(flat, *stretched(mesh, flat))
    local = _corners(mesh)
    weights = _cotangents(local)
    flat = _of_size(mesh, _conformal(mesh, weights))
    least, most = stretched(mesh, flat)
    if max(float(most.max()) - 1.0, 1.0 - float(least.min())) > ENOUGH:
        flat = _rigid(mesh, local, np.maximum(weights, SMALLEST), flat)
    return Flattened(flat, *stretched(mesh, flat))


def turned(mesh: Mesh, flat: Array) -> Array:
    """The same flat points (n, 2), moved to be about the origin and turned so that x runs as the part's X does, as well as
    it can; as its Y does where the piece looks along X."""
    up = _area_vector(mesh)
    up /= max(float(np.linalg.norm(up)), 1e-300)
    x = np.eye(3)[0] - up[0] * up
    if np.linalg.norm(x) < 1e-3:
        x = np.eye(3)[1] - up[1] * up
    x /= np.linalg.norm(x)
    seen = (mesh.vertices - mesh.vertices.mean(axis=0)) @ np.stack([x, np.cross(up, x)], axis=1)
    own = flat - flat.mean(axis=0)
    along, across = (own * seen).sum(), (own[:, 0] * seen[:, 1] - own[:, 1] * seen[:, 0]).sum()
    angle = np.arctan2(across, along)
    cos, sin = np.cos(angle), np.sin(angle)
    moved: Array = own @ np.array([[cos, sin], [-sin, cos]])
    return moved


def stretched(mesh: Mesh, flat: Array) -> tuple[Array, Array]:
    """By how much each triangle is stretched by laying it flat, least and most (m,); below 0 where it is turned over."""
    local = _corners(mesh)
    here, there = _sides(local), _sides(flat[mesh.faces])
    area = here[:, 0, 0] * here[:, 1, 1] - here[:, 0, 1] * here[:, 1, 0]
    inverse = (
        np.stack(
            [
                np.stack([here[:, 1, 1], -here[:, 0, 1]], axis=1),
                np.stack([-here[:, 1, 0], here[:, 0, 0]], axis=1),
            ],
            axis=1,
        )
        / np.maximum(area, 1e-300)[:, None, None]
    )
    map_ = inverse @ there
    a, b, c, d = map_[:, 0, 0], map_[:, 0, 1], map_[:, 1, 0], map_[:, 1, 1]
    one, other = np.hypot(a + d, b - c), np.hypot(a - d, b + c)
    return 0.5 * (one - other), 0.5 * (one + other)


def _area_vector(mesh: Mesh) -> Array:
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    vector: Array = np.cross(b - a, c - a).sum(axis=0)
    return vector


def _corners(mesh: Mesh) -> Array:
    """The corners (m, 3, 2) of each triangle in its own plane."""
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    along, other = b - a, c - a
    length = np.linalg.norm(along, axis=1)
    x = (along * other).sum(axis=1) / np.maximum(length, 1e-300)
    y = np.linalg.norm(np.cross(along, other), axis=1) / np.maximum(length, 1e-300)
    zero = np.zeros(len(length))
    return np.stack(
        [np.stack([zero, zero], 1), np.stack([length, zero], 1), np.stack([x, y], 1)], axis=1
    )


def _sides(corners: Array) -> Array:
    """The two sides (m, 2, 2) from the first corner."""
    return np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=1)


def _cotangents(local: Array) -> Array:
    """Half the cotangent (m, 3) of the angle opposite to the side from corner k to the next."""
    found = []
    for k in range(3):
        at = local[:, (k + 2) % 3]
        one, other = local[:, k] - at, local[:, (k + 1) % 3] - at
        cross = np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
        found.append(0.5 * (one * other).sum(axis=1) / np.maximum(cross, 1e-12))
    return np.stack(found, axis=1)


def _laplacian(mesh: Mesh, weights: Array) -> csc_matrix:
    a, b, w = mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel(), weights.ravel()
    n = len(mesh.vertices)
    rows, columns = np.r_[a, b, a, b], np.r_[a, b, b, a]
    return coo_matrix((np.r_[w, w, -w, -w], (rows, columns)), shape=(n, n)).tocsc()


def _conformal(mesh: Mesh, weights: Array) -> Array:
    """The least squares conformal map (n, 2) of a piece; two far vertices stay where they are told."""
    n = len(mesh.vertices)
    start, end = mesh.border_edges.T
    rows, columns = np.r_[start, end], np.r_[end, start]
    share = np.r_[np.full(len(start), 0.25 / 1j), np.full(len(start), -0.25 / 1j)]
    area = coo_matrix((share, (rows, columns)), shape=(n, n))
    energy = (0.5 * _laplacian(mesh, weights) - area).tocsc()
    first = int(np.argmax(np.linalg.norm(mesh.vertices - mesh.vertices.mean(axis=0), axis=1)))
    away = np.linalg.norm(mesh.vertices - mesh.vertices[first], axis=1)
    pinned = np.array([first, int(np.argmax(away))])
    free = np.setdiff1d(np.arange(n), pinned)
    z = np.zeros(n, dtype=complex)
    z[pinned[1]] = away[pinned[1]]
    z[free] = splu(energy[free][:, free].tocsc()).solve(-(energy[free][:, pinned] @ z[pinned]))
    return np.stack([z.real, z.imag], axis=1)


def _of_size(mesh: Mesh, flat: Array) -> Array:
    """The flat points scaled to the area that the piece has."""
    here, there = (_sides(corners) for corners in (_corners(mesh), flat[mesh.faces]))
    size = [
        0.5 * np.abs(one[:, 0, 0] * one[:, 1, 1] - one[:, 0, 1] * one[:, 1, 0]).sum()
        for one in (here, there)
    ]
    scaled: Array = flat * np.sqrt(size[0] / max(float(size[1]), 1e-300))
    return scaled


def _rigid(mesh: Mesh, local: Array, weights: Array, flat: Array) -> Array:
    """The flat points moved until each triangle is as nearly turned, not stretched, as all of them allow."""
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
        wanted = weights[..., None] * np.stack(
            [cos * side[..., 0] - sin * side[..., 1], sin * side[..., 0] + cos * side[..., 1]],
            axis=2,
        )
        right = np.zeros((n, 2))
        for axis in range(2):
            right[:, axis] = np.bincount(end.ravel(), wanted[..., axis].ravel(), n)
            right[:, axis] -= np.bincount(start.ravel(), wanted[..., axis].ravel(), n)
        flat = np.vstack([np.zeros((1, 2)), solver.solve(right[1:])])
    return flat
