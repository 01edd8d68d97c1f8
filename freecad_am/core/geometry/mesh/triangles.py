# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points and triangles: the nearest of the one to the other."""

from __future__ import annotations

import numpy as np

from ...types import Array
from ..walls.surface import dot


def closest(a: Array, b: Array, c: Array, points: Array) -> tuple[Array, Array]:
    """Distance (...,) of points (..., 3) to triangles with the corners a, b, c (..., 3), and the corners' shares (..., 3) in
    the nearest point."""
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
    square = dot(ap, ap) + vs * (vs * d00 - 2.0 * d20) + ws * (ws * d11 - 2.0 * d21) + 2.0 * vs * ws * d01
    square[0] = np.where(inside, square[0], np.inf)
    best = np.argmin(square, axis=0)[None]
    v, w, least = (np.take_along_axis(each, best, axis=0)[0] for each in (vs, ws, square))
    return np.sqrt(np.maximum(least, 0.0)), np.stack([1.0 - v - w, v, w], axis=-1)
