# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls that come as meshes: where they start, on a substrate, on edges of their own, or on the platform."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from freecad_am.core.types import Array, Mask

from ...core.geometry.formatting import at_least, count, place
from ...core.geometry.mesh.edge_runs import CORNER, runs
from ...core.geometry.mesh.facets import doubled_areas
from ...core.geometry.mesh.refined import boundary
from ...core.geometry.obstacles import Body
from ...core.geometry.walls.contact import first_curves, fit_splines, ground_distances
from ...core.geometry.walls.ground import PlaneGround
from ...core.geometry.walls.mesh_wall import MAX_TRIANGLES, MeshWall, mesh_wall
from ...core.geometry.walls.patch_wall import FirstCurve
from ...core.geometry.walls.rims import connected_parts, find_rims, mark_ends
from ...core.geometry.walls.surface import dot
from ...core.issues import NOTE, InputError, Issue, Text
from .patch_wall import EQUILATERAL_AREA, from_substrate, several_loops
from .substrate import Substrate

UPRIGHT = 0.7  # Z share of a normal; the floor of a cup faces down by more
FLOOR = 0.1  # layer heights over the lowest point; surfaces up to this height are a floor
ABOVE = 0.5  # layer heights over a floor at which the wall about it begins


def find_mesh_wall(
    body: Body,
    substrate: Substrate | None,
    height: float,
    label: str,
    start_edges: Sequence[str],
    mend: float,
) -> MeshWall:
    """The wall of a mesh for layers of `height` mm, on a substrate, from the edges named, or from the platform under its
    lowest place along Z. Its edges are the loops of its boundary, Edge1 and on, the lowest middle first.

    InputErrors of `core.geometry.walls.mesh_wall`, and NO_CONTACT, INSIDE, NO_START, UNKNOWN_EDGE, GAP.
    """
    corner = body.corners()
    area = 0.5 * float(np.linalg.norm(doubled_areas(corner), axis=1).sum())
    about = area / (EQUILATERAL_AREA * height) / height
    if about > MAX_TRIANGLES:
        enough = at_least(float(np.sqrt(area / (EQUILATERAL_AREA * MAX_TRIANGLES))))
        raise InputError(
            "TOO_FINE",
            "strategy.layer_height",
            "layers of {:g} mm need a mesh of about {} triangles, but the limit is {:,}; use "
            "layers above {:g} mm, or deposit the wall in parts",
            height,
            count(about),
            MAX_TRIANGLES,
            enough,
        )
    wall = mesh_wall(body.vertices, body.triangles.astype(np.intp), height, label, mend)
    rims = find_rims(wall)
    if start_edges:
        start = _from_edges(wall, start_edges, label)
    elif substrate is not None:
        first_curves_found, behind, issues = from_substrate(wall, substrate, rims, label)
        start = _Start(first_curves_found, behind, issues)
    else:
        start = _from_platform(wall, height, label)
    _refuse_loose(wall, start, label)
    issues = [*wall.issues, *start.issues, *several_loops(start.curves, label)]
    return replace(
        wall,
        first=tuple(start.curves),
        behind=start.behind,
        rims=mark_ends(wall, rims, tuple(start.curves), start.behind),
        issues=tuple(issues),
        ground=_lowest(wall) if substrate is None else None,
    )


class _Start(NamedTuple):
    curves: list[FirstCurve]
    behind: Mask
    issues: list[Issue]


def _loops(wall: MeshWall) -> list[Array]:
    """The loops (n, 3) of the boundary, the first point not repeated, in the order of the heights of their middles."""
    ends, _ = boundary(wall.triangles)
    loops = []
    if len(ends):
        for members, forward, _ in runs(wall.vertices, ends, np.pi):
            loops.append(wall.vertices[np.where(forward, ends[members, 0], ends[members, 1])])
    return sorted(loops, key=lambda loop: tuple(np.round(loop.mean(axis=0)[[2, 0, 1]], 6)))


def _curve(loop: Array) -> FirstCurve:
    arrivals = loop - np.roll(loop, 1, axis=0)
    arrivals /= np.maximum(np.linalg.norm(arrivals, axis=1, keepdims=True), 1e-300)
    sharp = dot(arrivals, np.roll(arrivals, -1, axis=0)) < np.cos(CORNER)
    return FirstCurve(*fit_splines(loop, sharp, True), True)


def _from_edges(wall: MeshWall, names: Sequence[str], label: str) -> _Start:
    loops = _loops(wall)
    selected = []
    for name in dict.fromkeys(names):
        number = int(name.removeprefix("Edge")) if name.removeprefix("Edge").isdigit() else 0
        if not 1 <= number <= len(loops):
            available = (
                Text.joined(
                    ", ",
                    (
                        Text("Edge{} at {}", k + 1, place(loop.mean(axis=0)))
                        for k, loop in enumerate(loops[:8])
                    ),
                )
                or "none"
            )
            raise InputError(
                "UNKNOWN_EDGE",
                label,
                "it has no {}; choose from the open ends of the mesh, sorted by height: {}",
                name,
                available,
            )
        selected.append(_curve(loops[number - 1]))
    return _Start(selected, np.zeros(len(wall.vertices), dtype=bool), [])


def _lowest(wall: MeshWall) -> float:
    return float((wall.vertices if wall.samples is None else wall.samples)[:, 2].min())


def _from_platform(wall: MeshWall, height: float, label: str) -> _Start:
    """Start from the open ends on the plane through the lowest point, else around a floor in that
    plane, else from the lowest open end.
    """
    lowest = _lowest(wall)
    loops = _loops(wall)
    standing = [loop for loop in loops if loop[:, 2].max() < lowest + height]
    if standing:
        text = Text(
            "the first layer follows the edge of {} at {}, on the platform",
            label,
            place(standing[0].mean(axis=0)),
        )
        return _Start(
            [_curve(loop) for loop in standing],
            np.zeros(len(wall.vertices), dtype=bool),
            [Issue(NOTE, "FIRST_LAYER", text)],
        )
    corner = wall.vertices[wall.triangles]
    normal = doubled_areas(corner)
    flat = np.abs(normal[:, 2]) > UPRIGHT * np.linalg.norm(normal, axis=1)
    if (flat & (corner[:, :, 2] < lowest + FLOOR * height).all(axis=1)).any():
        ground = PlaneGround(lowest + ABOVE * height)
        value = ground_distances(wall, ground)
        curves, _ = first_curves(wall, ground, value, find_rims(wall))
        text = Text(
            "the first layer starts {:g} mm above the floor of {}, which is not deposited",
            ABOVE * height,
            label,
        )
        if curves:
            return _Start(curves, value < 0.0, [Issue(NOTE, "FIRST_LAYER", text)])
    if not loops:
        raise InputError(
            "NO_START",
            label,
            "the part touches the platform at a point and has no open end to start from; choose "
            "a substrate, or turn the part so that an open end is on the platform",
        )
    text = Text(
        "the first layer follows the lowest open end of {}, Edge1 at {}, which is not on the "
        "platform",
        label,
        place(loops[0].mean(axis=0)),
    )
    return _Start(
        [_curve(loops[0])],
        np.zeros(len(wall.vertices), dtype=bool),
        [Issue(NOTE, "FIRST_LAYER", text)],
    )


def _refuse_loose(wall: MeshWall, start: _Start, label: str) -> None:
    """InputError GAP where a piece of the wall has no connection to a start of layers."""
    number, component = connected_parts(wall, ~start.behind)
    if number < 2:
        return
    start_tree = cKDTree(np.vstack([curve.points for curve in start.curves]))
    reach = 2.0 * wall.mesh.longest_edge
    for k in range(number):
        piece_points = wall.vertices[component == k]
        distance = start_tree.query(piece_points)[0]
        if distance.min() > reach and len(piece_points) > 2:
            raise InputError(
                "GAP",
                label,
                "it has {} separate pieces, and no layer starts on the piece at {}, {:.4g} mm "
                "from the start of the layers; choose its start edge too, or deposit it as a "
                "separate feature",
                number,
                place(piece_points[np.argmin(distance)]),
                distance.min(),
            )
