# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges of the part chosen as the first layer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import Part

from ...core.geometry.formatting import place
from ...core.geometry.step_count import step_count
from ...core.geometry.walls.patch_wall import FirstCurve, PatchWall
from ...core.issues import InputError
from ...core.types import Array

ON_WALL = 1e-3  # mm
NODE_TOLERANCE_MM = 1e-5  # mm between nodes, at the THIRDS of each arc
THIRDS = np.array([1.0 / 3.0, 2.0 / 3.0])
ROUNDS = 12
SMOOTH = np.radians(1.0)  # smaller turns from edge to edge are not corners


def curves_of(shape: Any, names: Sequence[str], wall: PatchWall, label: str) -> list[FirstCurve]:
    """The chains and loops that the edges form, on the wall.
    Raises InputError UNKNOWN_EDGE, NO_START (off the wall)."""
    edges = []
    for name in dict.fromkeys(names):
        number = int(name.removeprefix("Edge")) if name.removeprefix("Edge").isdigit() else 0
        if not 1 <= number <= len(shape.Edges):
            raise InputError(
                "UNKNOWN_EDGE",
                label,
                "it has no {}; choose from Edge1 to Edge{}",
                name,
                len(shape.Edges),
            )
        edge = shape.Edges[number - 1]
        points = np.array([tuple(edge.valueAt(t)) for t in np.linspace(*edge.ParameterRange, 9)])
        off = np.linalg.norm(wall.project(points)[0] - points, axis=1)
        if off.max() > ON_WALL:
            raise InputError(
                "NO_START",
                f"{label} {name}",
                "the edge is {:.4g} mm off the wall at {}; choose edges of the wall faces",
                off.max(),
                place(points[np.argmax(off)]),
            )
        edges.append(edge)
    return curves_along(edges, wall)


def curves_along(edges: Sequence[Any], wall: PatchWall) -> list[FirstCurve]:
    """The chains and loops that edges of the wall's faces form."""
    return [_curve(chain, wall) for chain in Part.sortEdges(list(edges))]


def _curve(chain: list[Any], wall: PatchWall) -> FirstCurve:
    wire = Part.Wire(chain)
    closed = bool(wire.isClosed())
    rows = [sampled(edge, wall.mesh.typical_edge) for edge in wire.OrderedEdges]
    nodes = np.vstack([points[:-1] for points, _ in rows])
    departures = np.vstack([along[:-1] for _, along in rows])
    arrivals = [along[-1:] for _, along in rows]
    starts = [arrivals[-1] if closed else rows[0][1][:1], *arrivals[:-1]]
    incoming = np.vstack(
        [np.vstack([start, along[1:-1]]) for start, (_, along) in zip(starts, rows)]
    )
    if not closed:
        nodes = np.vstack([nodes, rows[-1][0][-1:]])
        incoming, departures = (
            np.vstack([incoming, arrivals[-1]]),
            np.vstack([departures, arrivals[-1]]),
        )
    smooth = np.einsum("ij,ij->i", incoming, departures) > np.cos(SMOOTH)
    incoming[smooth] = departures[smooth]
    return FirstCurve(wall.project(nodes)[0], incoming, departures, closed)


def sampled(edge: Any, step: float) -> tuple[Array, Array]:
    """Points and unit tangents (n, 3) of an edge the way it runs, so dense that the arcs between
    them stay within NODE_TOLERANCE_MM; about `step` mm apart at most.
    """
    low, high = edge.ParameterRange
    count = step_count(edge.Length, step, 8) + 1
    t = np.linspace(low, high, count)
    if edge.Orientation == "Reversed":
        t = t[::-1]
    for _ in range(ROUNDS):
        points, along = _nodes(edge, t)
        between = (t[:-1, None] + np.diff(t)[:, None] * THIRDS).ravel()
        inner = np.array([tuple(edge.valueAt(parameter)) for parameter in between.tolist()])
        off = (
            FirstCurve(points, along, along, False)
            .curve()
            .nearest(inner)[0]
            .reshape(-1, len(THIRDS))
            .max(axis=1)
        )
        bad = np.flatnonzero(off > NODE_TOLERANCE_MM)
        if not len(bad):
            break
        t = np.insert(t, bad + 1, 0.5 * (t[bad] + t[bad + 1]))
    return _nodes(edge, t)


def _nodes(edge: Any, t: Array) -> tuple[Array, Array]:
    """Points and unit tangents (n, 3) at the parameters (n,), the tangents the way these run."""
    points = np.array([tuple(edge.valueAt(parameter)) for parameter in t.tolist()])
    along = np.array([tuple(edge.Curve.tangent(parameter)[0]) for parameter in t.tolist()])
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return points, -along if (points[1] - points[0]) @ along[0] < 0.0 else along
