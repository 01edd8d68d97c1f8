# SPDX-License-Identifier: LGPL-2.1-or-later
"""How sharply a bead turns within its wall."""

from __future__ import annotations

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.walls.surface import dot
from ...types import Array


def turns_in_wall(curve: SpaceCurve, normal: Array) -> Array:
    """Turn of the bead within the wall per length, (m - 1,) rad/mm, on each arc together with the corner it starts from.

    normal: (m, 3) of the wall at the nodes. The wall's own curvature is left out: the nozzle is normal to the bead in
    the wall and follows it anyway.
    """
    # both tangents of a turn brought into one plane, that of the normal between them
    middle = normal[:-1] + normal[1:]
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    turn = _angles(curve.out[:-1], curve.into[1:], middle)
    corner = _angles(curve.into[:-1], curve.out[:-1], normal[:-1])
    if not curve.closed:
        corner[0] = 0.0
    rate: Array = np.abs(turn + corner) / np.linalg.norm(np.diff(curve.points, axis=0), axis=1)
    return rate


def _angles(one: Array, other: Array, normal: Array) -> Array:
    """Angles (n,) rad about the normals from one vector to the other, both brought into the normal's plane."""
    one, other = (side - dot(side, normal)[:, None] * normal for side in (one, other))
    angle: Array = np.arctan2(dot(np.cross(one, other), normal), dot(one, other))
    return angle
