# SPDX-License-Identifier: LGPL-2.1-or-later
"""How sharply a bead turns within its wall."""

from __future__ import annotations

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.walls.surface import dot
from ...types import Array

SHORT_ARC = 1e-3  # of the length of most arcs; what is shorter has no turn of its own


def turns_in_wall(curve: SpaceCurve, normal: Array) -> Array:
    """Turn of the bead within the wall per length, (m - 1,) rad/mm, on each arc together with the corner it starts from.

    normal: (m, 3) of the wall at the nodes. The wall's own curvature is left out: the nozzle is normal to the bead in
    the wall and follows it anyway. An arc next to nothing long has the turn of the stretch about it, as long as most arcs
    are: its own would be that of rounding over a length of nothing.
    """
    # both tangents of a turn brought into one plane, that of the normal between them
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
        rate[short] = _about(turn + corner, length, typical)[short]
    return rate


def _about(turned: Array, length: Array, stretch: float) -> Array:
    """Turn per length (n,) of the stretch about the middle of each arc, of signed turns (n,) of arcs of such lengths."""
    way, total = np.r_[0.0, np.cumsum(length)], np.r_[0.0, np.cumsum(turned)]
    middle = 0.5 * (way[1:] + way[:-1])
    low, high = np.maximum(middle - 0.5 * stretch, 0.0), np.minimum(middle + 0.5 * stretch, way[-1])
    rate: Array = np.abs(np.interp(high, way, total) - np.interp(low, way, total)) / (high - low)
    return rate


def _angles(one: Array, other: Array, normal: Array) -> Array:
    """Angles (n,) rad about the normals from one vector to the other, both brought into the normal's plane."""
    one, other = (side - dot(side, normal)[:, None] * normal for side in (one, other))
    angle: Array = np.arctan2(dot(np.cross(one, other), normal), dot(one, other))
    return angle
