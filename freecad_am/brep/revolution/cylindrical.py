# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves and surfaces of the geometry kernel in cylindrical coordinates about an axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from ...core.geometry.curves.profile import Curve, sample_curve
from ...core.types import Array


@dataclass(frozen=True, eq=False)
class AxisFrame:
    """A frame whose Z is an axis: origin (3,) mm, rotation (3, 3) with X Y Z as columns, in part coordinates."""

    origin: Array
    rotation: Array

    def local(self, points: Any) -> Array:
        """(n, 3) mm in this frame from points (n, 3), or kernel vectors, in part coordinates."""
        moved: Array = (as_array(points) - self.origin) @ self.rotation
        return moved

    def cylindrical(self, points: Any) -> tuple[Array, Array, Array]:
        """Radius, height (n,) mm and azimuth (n,) rad."""
        p = self.local(points)
        return np.hypot(p[:, 0], p[:, 1]), p[:, 2], np.arctan2(p[:, 1], p[:, 0])


def as_array(points: Any) -> Array:
    """(n, 3) from a sequence of kernel vectors or of triples."""
    return np.array([tuple(point) for point in points], dtype=np.float64).reshape(-1, 3)


def axis_frame(origin: Any, direction: Any) -> AxisFrame:
    """The frame of an axis as the feature frame wants it (interface.md, `mount`), except the height
    of its origin.

    Z points the way with a positive component along the part's Z, else X, else Y. X is the part's X projected, Y if X
    is along the axis. The origin is the axis point nearest to the part's origin.
    """
    z = np.asarray(tuple(direction), dtype=np.float64)
    z = z / np.linalg.norm(z)
    z = np.where(np.abs(z) < 1e-12, 0.0, z)
    leading = next(component for component in (z[2], z[0], z[1]) if abs(component) > 1e-9)
    z = z / np.linalg.norm(z) * np.sign(leading)
    x = np.array([1.0, 0.0, 0.0])
    if np.linalg.norm(np.cross(x, z)) < 1e-6:
        x = np.array([0.0, 1.0, 0.0])
    x = x - (x @ z) * z
    x = x / np.linalg.norm(x)
    point = np.asarray(tuple(origin), dtype=np.float64)
    point = point - (point @ z) * z
    point = np.where(np.abs(point) < 1e-11, 0.0, point)
    return AxisFrame(point, np.column_stack([x, np.cross(z, x), z]))


def edge_points(edge: Any, count: int) -> Array:
    """(count, 3) points along an edge, its ends included; (0, 3) for a degenerate one."""
    if edge.Degenerated:
        return as_array([vertex.Point for vertex in edge.Vertexes])
    t_start, t_end = edge.ParameterRange
    return as_array([edge.valueAt(t) for t in np.linspace(t_start, t_end, count)])


def projected(curve: Any, frame: AxisFrame, t_start: float, t_end: float) -> Curve:
    """The curve in (radius, height) with its derivative, as a callable on parameters (n,)."""
    middle = 0.5 * (t_start + t_end)

    def evaluate(t: Array) -> tuple[Array, Array]:
        values = np.array([(*p, *d) for p, d in (curve.getD1(value) for value in t.tolist())])
        p = (values[:, :3] - frame.origin) @ frame.rotation
        return flattened(p, values[:, 3:] @ frame.rotation, t > middle)

    return evaluate


def flattened(p: Array, d: Array, ending: Any) -> tuple[Array, Array]:
    """Points p and derivatives d (n, 3) of the axis' frame in (radius, height), (n, 2) each. ending: (n,) bool, whether
    a point on the axis is an end, where the radius falls, or a start.
    """
    r = np.hypot(p[:, 0], p[:, 1])
    on_axis = r < 1e-7
    slope = np.hypot(d[:, 0], d[:, 1]) * np.where(ending, -1.0, 1.0)
    rate = np.where(
        on_axis, slope, (p[:, 0] * d[:, 0] + p[:, 1] * d[:, 1]) / np.where(on_axis, 1.0, r)
    )
    return np.stack([r, p[:, 2]], axis=1), np.stack([rate, d[:, 2]], axis=1)


def pieces_of(
    curve: Any, frame: AxisFrame, t_start: float, t_end: float
) -> list[tuple[Array, Array]]:
    """The curve between two parameters as samples (points (n, 2), tangents (n, 2)), one piece per smooth stretch."""
    evaluate = projected(curve, frame, t_start, t_end)
    corners, knots = _breaks(curve, t_start, t_end)
    return smooth_pieces(evaluate, corners, knots)


def smooth_pieces(
    evaluate: Curve, corners: Sequence[float], knots: Sequence[float]
) -> list[tuple[Array, Array]]:
    """Samples between neighbouring corners; the slope at a corner is taken at a small distance from
    it. knots: other breaks.
    """
    result = []
    for a, b in pairwise(corners):
        inside = [knot for knot in knots if a < knot < b]
        offset = 1e-10 * (b - a)
        low, high = a + offset * (a != corners[0]), b - offset * (b != corners[-1])

        def one_sided(t: Array, low: float = low, high: float = high) -> tuple[Array, Array]:
            return evaluate(np.clip(t, low, high))

        result.append(sample_curve(one_sided, [a, *inside, b]))
    return result


def _breaks(curve: Any, t_start: float, t_end: float) -> tuple[list[float], list[float]]:
    """Parameters of corners, the two ends included, and of the other knots of a B-spline."""
    corners, knots = [], []
    if curve.TypeId == "Part::GeomBSplineCurve":
        span = t_end - t_start
        for knot, times in zip(curve.getKnots(), curve.getMultiplicities(), strict=True):
            if t_start + 1e-9 * span < knot < t_end - 1e-9 * span:
                (corners if times >= curve.Degree else knots).append(knot)
    return [t_start, *corners, t_end], knots
