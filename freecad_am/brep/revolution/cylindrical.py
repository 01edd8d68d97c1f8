# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kernel curves and surfaces in cylindrical coordinates about an axis, and lost poles of faces."""

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
    """A frame with Z along an axis, in part coordinates.

    origin: (3,), mm. rotation: (3, 3) with X, Y, Z as columns.
    """

    origin: Array
    rotation: Array

    def local(self, points: Any) -> Array:
        """Convert points (n, 3) or kernel vectors from part coordinates to this frame, mm."""
        moved: Array = (as_array(points) - self.origin) @ self.rotation
        return moved

    def cylindrical(self, points: Any) -> tuple[Array, Array, Array]:
        """Return radius (n,), mm, height (n,), mm, and azimuth (n,), rad."""
        p = self.local(points)
        return np.hypot(p[:, 0], p[:, 1]), p[:, 2], np.arctan2(p[:, 1], p[:, 0])


def as_array(points: Any) -> Array:
    """Convert a sequence of kernel vectors or triples to an array (n, 3)."""
    return np.array([tuple(point) for point in points], dtype=np.float64).reshape(-1, 3)


def axis_frame(origin: Any, direction: Any) -> AxisFrame:
    """Return the frame of an axis: the feature frame (interface.md, `mount`) except for its height.

    Z has a positive component along the part's Z, else X, else Y. X is the projection of the part's
    X, or of Y if X is along the axis. The origin is the axis point nearest to the part's origin.
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
    """Return `count` points (count, 3) along an edge including its ends.

    For a degenerate edge, return its vertices.
    """
    if edge.Degenerated:
        return as_array([vertex.Point for vertex in edge.Vertexes])
    t_start, t_end = edge.ParameterRange
    return as_array([edge.valueAt(t) for t in np.linspace(t_start, t_end, count)])


def projected(curve: Any, frame: AxisFrame, t_start: float, t_end: float) -> Curve:
    """Return a function of parameters (n,) that gives (radius, height) and their derivatives."""
    middle = 0.5 * (t_start + t_end)

    def evaluate(t: Array) -> tuple[Array, Array]:
        values = np.array([(*p, *d) for p, d in (curve.getD1(value) for value in t.tolist())])
        p = (values[:, :3] - frame.origin) @ frame.rotation
        return flattened(p, values[:, 3:] @ frame.rotation, t > middle)

    return evaluate


def flattened(p: Array, d: Array, ending: Any) -> tuple[Array, Array]:
    """Convert points p and derivatives d (n, 3) of the axis frame to (radius, height), (n, 2) each.

    ending: (n,) bool, whether a point on the axis is a curve end, where the radius decreases, or a
    start.
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
    """Sample a curve between two parameters; return points and tangents (n, 2) per smooth piece."""
    evaluate = projected(curve, frame, t_start, t_end)
    corners, knots = _breaks(curve, t_start, t_end)
    return smooth_pieces(evaluate, corners, knots)


def smooth_pieces(
    evaluate: Curve, corners: Sequence[float], knots: Sequence[float]
) -> list[tuple[Array, Array]]:
    """Sample a curve between successive corners.

    The slope at a corner is evaluated at a small distance from the corner. knots: other breaks.
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
    """Return the parameters of corners, including both ends, and of other B-spline knots."""
    corners, knots = [], []
    if curve.TypeId == "Part::GeomBSplineCurve":
        span = t_end - t_start
        for knot, times in zip(curve.getKnots(), curve.getMultiplicities(), strict=True):
            if t_start + 1e-9 * span < knot < t_end - 1e-9 * span:
                (corners if times >= curve.Degree else knots).append(knot)
    return [t_start, *corners, t_end], knots


# ---- Faces closed on the axis that have no area after STEP import
#
# The geometry kernel writes a dome revolved from a circle or an ellipse with its rim as the only
# edge. On reading, it takes the rim for the whole face, with area 0. The surface is still exact,
# and the orientation of the rim gives the side of the face. For a partly revolved dome, OpenCASCADE
# 7.8 and later also lose the point on the axis and use the whole surface as the face. In this case,
# the edges that lead to the axis are the meridian.

SAMPLES = 721
ON_AXIS = 1e-6  # mm


def has_lost_pole(face: Any) -> bool:
    """Whether a face is closed on its axis but lacks the degenerate edge there.

    Such a face has one closed edge but no area, or two edges that meet on the axis.
    """
    edges = [edge for edge in face.Edges if not edge.Degenerated]
    if len(edges) == 1:
        return bool(edges[0].isClosed() and 2.0 * face.Area < 1e-3 * edges[0].Length)
    return len(edges) == len(face.Edges) and _to_axis(face) is not None


def edges_of(face: Any) -> list[Any]:
    """Return the edges of a face with a lost pole, without surface bounds added by the kernel."""
    if _to_axis(face) is None:
        return list(face.Edges)
    return next(
        list(wire.Edges)
        for wire in face.Wires
        if any(_leads_to_axis(edge, face.Surface) for edge in wire.Edges)
    )


def restore_meridian(face: Any, frame: AxisFrame) -> list[tuple[Array, Array]] | None:
    """Return the meridian from rim to axis as samples (points (n, 2), tangents (n, 2)).

    None if the meridian cannot be determined.
    """
    meridian = _to_axis(face)
    if meridian is not None:
        return pieces_of(meridian.Curve, frame, *meridian.ParameterRange)
    return _from_rim(face, frame)


def _to_axis(face: Any) -> Any:
    """Return an edge that ends on the axis of its surface of revolution, or None."""
    surface = face.Surface
    if surface.TypeId != "Part::GeomSurfaceOfRevolution":
        return None
    return next((edge for edge in face.Edges if _leads_to_axis(edge, surface)), None)


def _leads_to_axis(edge: Any, surface: Any) -> bool:
    distances = [
        (vertex.Point - surface.Location).cross(surface.Direction).Length
        for vertex in edge.Vertexes
    ]
    return bool(distances and min(distances) < ON_AXIS < max(distances))


def _from_rim(face: Any, frame: AxisFrame) -> list[tuple[Array, Array]] | None:
    surface = face.Surface
    if surface.TypeId != "Part::GeomSurfaceOfRevolution":
        return None
    edge = next(edge for edge in face.Edges if not edge.Degenerated)
    t_start, t_end = edge.ParameterRange
    parameters = t_start + np.array([0.25, 0.26]) * (t_end - t_start)
    (u, start), (next_u, _) = (surface.parameter(edge.valueAt(t)) for t in parameters.tolist())
    # in surface parameters, the face is left of its rim
    rising = (np.mod(next_u - u + np.pi, 2.0 * np.pi) - np.pi) > 0.0
    sense = 1.0 if rising == (edge.Orientation == face.Orientation) else -1.0
    curve = surface.uIso(u)
    span = surface.bounds()[3] - surface.bounds()[2]
    t = start + sense * span * np.linspace(0.0, 1.0, SAMPLES)
    p = frame.local([curve.value(value) for value in t.tolist()])
    outward = p[0, :2] / np.hypot(*p[0, :2])
    radius = p[:, :2] @ outward
    through = np.flatnonzero((radius[1:] <= 0.0) & (radius[:-1] > 0.0))
    if len(through) == 0:
        return None
    low, high = float(t[through[0]]), float(t[through[0] + 1])
    for _ in range(60):
        middle = 0.5 * (low + high)
        inside = float(frame.local([curve.value(middle)])[0, :2] @ outward) > 0.0
        low, high = (middle, high) if inside else (low, middle)
    a, b = sorted((float(start), 0.5 * (low + high)))
    return pieces_of(curve, frame, a, b)
