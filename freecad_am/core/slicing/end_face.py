# SPDX-License-Identifier: LGPL-2.1-or-later
"""The upper end of a wall with a closed parameter: layers trimmed at a line u = const, or only whole ones kept."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..geometry.space_curve import SpaceCurve
from ..geometry.surface import Surface
from .wall_layer import WallLayer

Array = NDArray[np.float64]

HALVINGS = 52
SAME = 1e-9  # of the period; a node this near to the end line gives way to the point on it


def whole(layers: list[WallLayer], u_end: float) -> list[WallLayer]:
    """The layers that nowhere pass the end."""
    return [layer for layer in layers if layer.u.max() <= u_end]


def trimmed(surface: Surface, layer: WallLayer, u_end: float) -> list[SpaceCurve]:
    """The pieces of a layer below the end line: the closed curve, open curves that begin and end on the line, or none."""
    curve = layer.curve
    above = layer.u > u_end
    if not above.any():
        return [curve]
    crossed = np.flatnonzero(above[1:] != above[:-1])
    if not len(crossed):
        return []
    low, high = curve.w[crossed], curve.w[crossed + 1]
    start = above[crossed]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = (layer.heights(surface, middle)[0] > u_end) == start
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    at = 0.5 * (low + high)
    enter, leave = at[start], at[~start]
    pieces = []
    for v in enter:
        after = leave[leave > v]
        pieces.append(_piece(surface, curve, u_end, v, after[0] if len(after) else leave[0] + curve.period))
    return pieces


def _piece(surface: Surface, curve: SpaceCurve, u_end: float, start: float, end: float) -> SpaceCurve:
    """The curve from start to end, which may lie past the seam; both are brought onto the line u = u_end."""
    w = np.r_[curve.w[:-1], curve.w[:-1] + curve.period]
    inside = np.flatnonzero((w > start + SAME * curve.period) & (w < end - SAME * curve.period))
    node = inside % (len(curve.w) - 1)
    ends = np.array([start, end])
    points, slopes = surface.point(np.full(2, u_end), ends), curve.at(ends)[1]
    return SpaceCurve(
        np.r_[start, w[inside], end],
        np.vstack([points[:1], curve.points[node], points[1:]]),
        np.vstack([slopes[:1], curve.into[node], slopes[1:]]),
        np.vstack([slopes[:1], curve.out[node], slopes[1:]]),
        False,
    )
