# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces that close on the axis and come out of a STEP file without extent.

The geometry kernel writes a dome revolved from a circle or an ellipse with its rim as the only edge, and on reading
takes the rim for the whole face: area 0. The surface is still exact, and the sense of the rim tells on which side of it
the face lies.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.geometry.profile import Array
from .cylindrical import AxisFrame, pieces_of

SAMPLES = 721


def has_lost_pole(face: Any) -> bool:
    """Whether a face is bounded by one closed edge and yet has no area."""
    edges = [edge for edge in face.Edges if not edge.Degenerated]
    return len(edges) == 1 and edges[0].isClosed() and 2.0 * face.Area < 1e-3 * edges[0].Length


def restored(face: Any, frame: AxisFrame) -> list[tuple[Array, Array]] | None:
    """The meridian from the rim to the axis as samples (points (n, 2), tangents (n, 2)), None where it cannot be told."""
    surface = face.Surface
    if surface.TypeId != "Part::GeomSurfaceOfRevolution":
        return None
    edge = next(edge for edge in face.Edges if not edge.Degenerated)
    first, last = edge.ParameterRange
    at = first + np.array([0.25, 0.26]) * (last - first)
    (u, start), (next_u, _) = (surface.parameter(edge.valueAt(t)) for t in at.tolist())
    # seen in the surface's parameters the face lies left of its rim
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
