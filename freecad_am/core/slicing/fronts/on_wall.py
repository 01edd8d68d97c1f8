# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves near a wall brought onto it between their nodes too."""

from __future__ import annotations

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from .curve import INSIDE, WITHIN, inside

ROUNDS = 12


def on_wall(wall: PatchWall, curve: SpaceCurve) -> SpaceCurve:
    """The curve with further nodes where its arcs are off the wall between the nodes, by WITHIN at INSIDE."""
    for _ in range(ROUNDS):
        points = curve.at(inside(curve))[0]
        off = np.linalg.norm(wall.project(points)[0] - points, axis=1).reshape(-1, len(INSIDE)).max(axis=1)
        bad = np.flatnonzero((off > WITHIN) & (curve.span > 1e-6 * curve.period))
        if not len(bad):
            break
        middle = curve.w[bad] + 0.5 * curve.span[bad]
        points, slope, _ = curve.at(middle)
        places, normal = wall.project(points)
        slope = slope - dot(slope, normal)[:, None] * normal
        curve = SpaceCurve(
            np.insert(curve.w, bad + 1, middle), np.insert(curve.points, bad + 1, places, axis=0),
            np.insert(curve.into, bad + 1, slope, axis=0), np.insert(curve.out, bad + 1, slope, axis=0), curve.closed,
        )
    return curve
