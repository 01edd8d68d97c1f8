# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces that close on the axis and come out of a STEP file without extent.

The geometry kernel writes a dome revolved from a circle or an ellipse with its rim as the only
edge, and on reading takes the rim for the whole face: area 0. The surface is still exact, and the
sense of the rim gives the side of the face. For a dome that is part of a turn, OpenCASCADE 7.8 and
later also lose the point on the axis and take the whole surface for the face; there the edges that
lead to the axis are the meridian.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.types import Array
from ..revolution.cylindrical import AxisFrame, pieces_of

SAMPLES = 721
ON_AXIS = 1e-6  # mm


def has_lost_pole(face: Any) -> bool:
    """Whether a face closes on its axis without the edge of no length that says so: it is bounded by one closed edge and
    yet has no area, or two of its edges meet on the axis."""
    edges = [edge for edge in face.Edges if not edge.Degenerated]
    if len(edges) == 1:
        return bool(edges[0].isClosed() and 2.0 * face.Area < 1e-3 * edges[0].Length)
    return len(edges) == len(face.Edges) and _to_axis(face) is not None


def edges_of(face: Any) -> list[Any]:
    """The edges of a face with a lost pole; the kernel adds the bounds of the whole surface, as wires of their own."""
    if _to_axis(face) is None:
        return list(face.Edges)
    return next(
        list(wire.Edges)
        for wire in face.Wires
        if any(_leads_to_axis(edge, face.Surface) for edge in wire.Edges)
    )


def restore_meridian(face: Any, frame: AxisFrame) -> list[tuple[Array, Array]] | None:
    """The meridian from the rim to the axis as samples (points (n, 2), tangents (n, 2)), or None if
    it is undetermined.
    """
    meridian = _to_axis(face)
    if meridian is not None:
        return pieces_of(meridian.Curve, frame, *meridian.ParameterRange)
    return _from_rim(face, frame)


def _to_axis(face: Any) -> Any:
    """An edge that leads to the axis of a surface of revolution and ends on it, or None."""
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
    # in the surface's parameters the face is left of its rim
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
