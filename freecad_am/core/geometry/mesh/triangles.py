# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles: their nearest points, and the points of parts that they are cut into."""

from __future__ import annotations

import numpy as np

from ...types import Array, Index
from ..step_count import step_count
from ..walls.surface import dot


def closest(a: Array, b: Array, c: Array, points: Array) -> tuple[Array, Array]:
    """Return the distance (...,) of points (..., 3) to triangles with the corners a, b, c (...,
    3).

    Also returns the shares (..., 3) of the corners in the nearest point.
    """
    ab, ac, ap = b - a, c - a, points - a
    d00, d01, d11 = dot(ab, ab), dot(ab, ac), dot(ac, ac)
    d20, d21 = dot(ap, ab), dot(ap, ac)
    area = d00 * d11 - d01 * d01
    flat = area <= 1e-14 * d00 * d11  # corners in a line have no inside
    safe = np.where(flat, 1.0, area)
    v, w = (d11 * d20 - d01 * d21) / safe, (d00 * d21 - d01 * d20) / safe
    inside = (v >= 0.0) & (w >= 0.0) & (v + w <= 1.0) & ~flat
    # the nearest of the three sides, as (v, w)
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
    """Cut triangles (m, 3, 3) evenly so that no edge is longer than `longest` mm.

    Returns the points (m, k, 3) in each triangle, and the corner numbers (l, 3) of the parts,
    the same for all triangles.
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
