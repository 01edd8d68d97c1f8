# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids for tests of layers, as closed triangle meshes."""

from __future__ import annotations

import numpy as np


def extrude_squares(cells, unit, depth):
    """Extrude squares of the xz plane, given by their numbers (x, z), along y: vertices (n, 3) and
    triangles (m, 3)."""
    quads = []
    for x, z in cells:
        front = [(x, 0, z), (x + 1, 0, z), (x + 1, 0, z + 1), (x, 0, z + 1)]
        quads += [front, [(a, depth, c) for a, _, c in front[::-1]]]
        for (dx, dz), (start, end) in (
            ((1, 0), ((x + 1, z), (x + 1, z + 1))),
            ((-1, 0), ((x, z + 1), (x, z))),
            ((0, 1), ((x + 1, z + 1), (x, z + 1))),
            ((0, -1), ((x, z), (x + 1, z))),
        ):
            if (x + dx, z + dz) not in cells:
                (a, c), (b, d) = start, end
                quads.append([(a, 0, c), (a, depth, c), (b, depth, d), (b, 0, d)])
    corners = np.array(quads, dtype=float) * [unit, 1.0, unit]
    vertices, number = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    number = np.ravel(number).reshape(-1, 4)
    return vertices, np.concatenate([number[:, [0, 1, 2]], number[:, [0, 2, 3]]]).astype(np.intp)


def tee():
    """A T: a stem of 10 x 20 x 20 mm under a beam of 45 x 20 x 10 mm, standing on z = 0."""
    stem = {(x, z) for x in (0, 1) for z in range(6)}
    return extrude_squares(stem | {(x, z) for x in range(-3, 6) for z in (4, 5)}, 5.0, 20.0)


def box(size, pose=None):
    """A box from the origin, moved by a pose (4, 4)."""
    vertices, triangles = extrude_squares({(0, 0)}, 1.0, 1.0)
    vertices = vertices * size
    return (vertices if pose is None else vertices @ pose[:3, :3].T + pose[:3, 3]), triangles


def icosphere(radius, rounds=4):
    """A triangulated ball about the origin with its vertices on the sphere."""
    g = (1.0 + 5.0**0.5) / 2.0
    vertices = np.array(
        [
            (-1, g, 0),
            (1, g, 0),
            (-1, -g, 0),
            (1, -g, 0),
            (0, -1, g),
            (0, 1, g),
            (0, -1, -g),
            (0, 1, -g),
            (g, 0, -1),
            (g, 0, 1),
            (-g, 0, -1),
            (-g, 0, 1),
        ]
    )
    faces = np.array(
        [
            (0, 11, 5),
            (0, 5, 1),
            (0, 1, 7),
            (0, 7, 10),
            (0, 10, 11),
            (1, 5, 9),
            (5, 11, 4),
            (11, 10, 2),
            (10, 7, 6),
            (7, 1, 8),
            (3, 9, 4),
            (3, 4, 2),
            (3, 2, 6),
            (3, 6, 8),
            (3, 8, 9),
            (4, 9, 5),
            (2, 4, 11),
            (6, 2, 10),
            (8, 6, 7),
            (9, 8, 1),
        ]
    )
    for _ in range(rounds):
        n = len(vertices)
        edges, edge_index = np.unique(
            np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1),
            axis=0,
            return_inverse=True,
        )
        vertices = np.vstack([vertices, vertices[edges].mean(axis=1)])
        a, b, c = (np.ravel(edge_index).reshape(-1, 3) + n).T
        u, v, w = faces.T
        faces = np.vstack(
            [np.stack(t, axis=1) for t in ((u, a, c), (a, v, b), (c, b, w), (a, b, c))]
        )
    return radius * vertices / np.linalg.norm(vertices, axis=1, keepdims=True), faces.astype(
        np.intp
    )
