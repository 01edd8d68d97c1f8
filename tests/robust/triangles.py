# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compute the distance of points from triangles pair by pair: no tree, no grid, no code of the
package."""

import numpy as np


def distance(points, triangles):
    """Return the distances (n,) of points (n, 3) from the nearest of triangles (m, 3, 3)."""
    middle = triangles.mean(axis=1)
    radius = np.linalg.norm(triangles - middle[:, None], axis=2).max(axis=1)
    distances = np.empty(len(points))
    for number, point in enumerate(points):
        to_middles = np.linalg.norm(middle - point, axis=1)
        candidates = triangles[to_middles - radius <= (to_middles + radius).min()]
        distances[number] = np.linalg.norm(_nearest(point, candidates) - point, axis=1).min()
    return distances


def inside(points, triangles):
    """Return whether points (n, 3) are inside closed triangles (m, 3, 3): then the triangles fill
    the full solid angle."""
    is_inside = np.empty(len(points), dtype=bool)
    for number, point in enumerate(points):
        a, b, c = (triangles[:, k] - point for k in range(3))
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        above = np.einsum("ij,ij->i", a, np.cross(b, c))
        below = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
        is_inside[number] = abs(2.0 * np.arctan2(above, below).sum()) > 2.0 * np.pi
    return is_inside


def _nearest(point, triangles):
    """Return the nearest point (m, 3) of each triangle: in its plane if that is within, else on its
    three sides."""
    a, b, c = (triangles[:, k] for k in range(3))
    normal = np.cross(b - a, c - a)
    square = np.maximum((normal**2).sum(1), 1e-300)
    foot = point - normal * (((point - a) * normal).sum(1) / square)[:, None]
    sides = [
        np.einsum("ij,ij->i", np.cross(q - p, foot - p), normal)
        for p, q in ((a, b), (b, c), (c, a))
    ]
    within = (np.min(sides, axis=0) >= 0.0) & (square > 1e-24)
    on_sides = np.stack([_nearest_on_side(point, p, q) for p, q in ((a, b), (b, c), (c, a))])
    nearest = np.linalg.norm(on_sides - point, axis=2).argmin(axis=0)
    return np.where(within[:, None], foot, on_sides[nearest, np.arange(len(triangles))])


def _nearest_on_side(point, start, end):
    along = end - start
    share = ((point - start) * along).sum(1) / np.maximum((along**2).sum(1), 1e-300)
    return start + np.clip(share, 0.0, 1.0)[:, None] * along
