# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wire or sketch as pieces of meridian."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.geometry.curves.contour import Piece
from ...core.issues import InputError
from .cylindrical import AxisFrame, edge_points, pieces_of

ACROSS = 1e-3  # mm an edge may leave the half plane of the wire


def pieces_of_edges(shape: Any, frame: AxisFrame, label: str) -> list[Piece]:
    """The edges as meridian pieces, each a full turn. Edges along the axis itself are left out.

    Raises InputError 'NOT_REVOLUTION' where the edges cross the axis or are not in one plane with it, 'NO_WALL' where
    none is left.
    """
    edges = [
        (f"Edge{i}", edge) for i, edge in enumerate(shape.Edges, start=1) if not edge.Degenerated
    ]
    points = {name: frame.local(edge_points(edge, 17)) for name, edge in edges}
    off_axis = [
        (name, edge) for name, edge in edges if np.hypot(*points[name][:, :2].T).max() > ACROSS
    ]
    if not off_axis:
        raise InputError("NO_WALL", label, "its edges coincide with the axis; choose another axis")
    everything = np.vstack([points[name] for name, _ in off_axis])
    outward = everything[np.argmax(np.hypot(everything[:, 0], everything[:, 1])), :2]
    outward = outward / np.linalg.norm(outward)
    for name, _ in off_axis:
        across = np.abs(points[name][:, 0] * outward[1] - points[name][:, 1] * outward[0]).max()
        if across > ACROSS:
            raise InputError(
                "NOT_REVOLUTION",
                f"{label} {name}",
                "it is {:.4g} mm off the plane of the wire and the axis; draw the wire in a "
                "plane through the axis",
                across,
            )
        behind = float((points[name][:, :2] @ outward).min())
        if behind < -ACROSS:
            raise InputError(
                "NOT_REVOLUTION",
                f"{label} {name}",
                "it crosses the axis by {:.4g} mm; keep it on one side",
                -behind,
            )
    return [
        Piece(name, samples, tangents)
        for name, edge in off_axis
        for samples, tangents in pieces_of(edge.Curve, frame, *edge.ParameterRange)
    ]
