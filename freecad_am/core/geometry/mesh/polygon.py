# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles of a polygon in space that is nearly flat and may be concave."""

from __future__ import annotations

import numpy as np

from ...types import Array, Index


def triangulated(corners: Array) -> Index:
    """Triangles (n - 2, 3) of a polygon with the corners (n, 3), n >= 3, by their numbers, turning as it does: ear after ear
    is cut off along the plane of its mean normal, the least drawn out first. One that crosses itself is cut too."""
    after = np.roll(corners, -1, axis=0)
    normal = np.cross(corners, after).sum(axis=0)  # Newell's
    drop = int(np.argmax(np.abs(normal)))
    flat = np.delete(corners, drop, axis=1)
    if (normal[drop] < 0.0) != (drop == 1):  # so that it turns left
        flat = flat[:, ::-1]
    left, found = list(range(len(corners))), []
    while len(left) > 3:
        ear = _ear(flat[left])
        found.append((left[ear - 1], left[ear], left[(ear + 1) % len(left)]))
        left.pop(ear)
    return np.array([*found, tuple(left)], dtype=np.intp)


def _ear(ring: Array) -> int:
    """The corner of a polygon (n, 2) that turns left, with no other corner in its triangle; of several the one whose
    triangle is the least drawn out, and of none the one that turns left most."""
    before, after = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
    turn = _cross(ring - before, after - ring)
    longest = np.maximum.reduce(
        [((a - b) ** 2).sum(axis=1) for a, b in ((ring, before), (after, ring), (before, after))]
    )
    shape = turn / np.maximum(longest, 1e-300)
    inside = np.ones((len(ring), len(ring)), dtype=bool)  # triangle, corner
    for a, b in ((before, ring), (ring, after), (after, before)):
        inside &= _cross((b - a)[:, None], ring[None] - a[:, None]) >= 0.0
    for own in (before, ring, after):
        inside &= (ring[None] != own[:, None]).any(axis=2)
    clear = (turn > 0.0) & ~inside.any(axis=1)
    return int(np.argmax(np.where(clear, shape, -np.inf) if clear.any() else shape))


def _cross(one: Array, other: Array) -> Array:
    found: Array = one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]
    return found
