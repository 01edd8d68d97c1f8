# SPDX-License-Identifier: LGPL-2.1-or-later
"""How sharply a bead turns within its wall."""

from __future__ import annotations

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.walls.surface import dot
from ...types import Array

SHORT_ARC = 1e-3  # of the typical arc length; a shorter arc has no turn of its own


def turns_in_wall(curve: SpaceCurve, normal: Array) -> Array:
    """Return the turn of the bead within the wall per length, (m - 1,) rad/mm, of each arc with
    its starting corner.

    normal: (m, 3) of the wall at the nodes. The wall's own curvature does not count: the
    nozzle is normal to the bead in the wall and follows it anyway. A very short arc has the
    turn of the stretch around it, as long as a typical arc: its own turn would be rounding
    over no length.
    """
    # both tangents of a turn projected onto the plane of the normal between them
    middle = normal[:-1] + normal[1:]
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    turn = _angles(curve.out[:-1], curve.into[1:], middle)
    corner = _angles(curve.into[:-1], curve.out[:-1], normal[:-1])
    if not curve.closed:
        corner[0] = 0.0
    length = np.linalg.norm(np.diff(curve.points, axis=0), axis=1)
    typical = float(np.median(length))
    short = length < SHORT_ARC * typical
    rate: Array = np.abs(turn + corner) / np.where(short, typical, length)
    if short.any():
        rate[short] = _turn_per_stretch(turn + corner, length, typical)[short]
    return rate


def _turn_per_stretch(turned: Array, length: Array, stretch: float) -> Array:
    """Return the turn per length (n,) of the stretch about the middle of each arc, from signed
    turns (n,) and lengths (n,).
    """
    s, total = np.r_[0.0, np.cumsum(length)], np.r_[0.0, np.cumsum(turned)]
    middle = 0.5 * (s[1:] + s[:-1])
    low, high = np.maximum(middle - 0.5 * stretch, 0.0), np.minimum(middle + 0.5 * stretch, s[-1])
    rate: Array = np.abs(np.interp(high, s, total) - np.interp(low, s, total)) / (high - low)
    return rate


def _angles(a: Array, b: Array, normal: Array) -> Array:
    """Return angles (n,) rad about the normals from vectors a to b, both projected onto the
    normal's plane.
    """
    a, b = (side - dot(side, normal)[:, None] * normal for side in (a, b))
    angle: Array = np.arctan2(dot(np.cross(a, b), normal), dot(a, b))
    return angle
