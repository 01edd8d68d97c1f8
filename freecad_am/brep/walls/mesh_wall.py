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
from .patch_wall import EQUAL, from_substrate, several_loops
from .substrate import Substrate

UPRIGHT = 0.7  # of a normal along Z; the floor of a cup looks down by more
FLOOR = 0.1  # layer heights over the lowest place; what lies no higher is a floor
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
    about = area / (EQUAL * height) / height
    if about > MAX_TRIANGLES:
        enough = at_least(float(np.sqrt(area / (EQUAL * MAX_TRIANGLES))))
        raise InputError(
            "TOO_FINE",
            "strategy.layer_height",
            "layers of {:g} mm ask for a mesh of the wall of about {} triangles, and "
            "more than {:,} cannot be worked with; give more than {:g} mm, or deposit the wall in parts",
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
        first, behind, issues = from_substrate(wall, substrate, rims, label)
        start = _Start(first, behind, issues)
    else:
        start = _from_platform(wall, height, label)
    _refuse_loose(wall, start, label)
    issues = [*wall.issues, *start.issues, *several_loops(start.first, label)]
    return replace(
        wall,
        first=tuple(start.first),
        behind=start.behind,
        rims=mark_ends(wall, rims, tuple(start.first), start.behind),
        issues=tuple(issues),
        ground=_lowest(wall) if substrate is None else None,
    )


class _Start(NamedTuple):
    first: list[FirstCurve]
    behind: Mask
    issues: list[Issue]


def _loops(wall: MeshWall) -> list[Array]:
    """The loops (n, 3) of the boundary, the first point not repeated, in the order of the heights of their middles."""
    ends, _ = boundary(wall.triangles)
    found = []
    if len(ends):
        for members, forward, _ in runs(wall.vertices, ends, np.pi):
            found.append(wall.vertices[np.where(forward, ends[members, 0], ends[members, 1])])
    return sorted(found, key=lambda loop: tuple(np.round(loop.mean(axis=0)[[2, 0, 1]], 6)))


def _curve(loop: Array) -> FirstCurve:
    before = loop - np.roll(loop, 1, axis=0)
    before /= np.maximum(np.linalg.norm(before, axis=1, keepdims=True), 1e-300)
    sharp = dot(before, np.roll(before, -1, axis=0)) < np.cos(CORNER)
    return FirstCurve(*fit_splines(loop, sharp, True), True)


def _from_edges(wall: MeshWall, names: Sequence[str], label: str) -> _Start:
    loops = _loops(wall)
    chosen = []
    for name in dict.fromkeys(names):
        number = int(name.removeprefix("Edge")) if name.removeprefix("Edge").isdigit() else 0
        if not 1 <= number <= len(loops):
            known = (
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
                "it has no {}; choose from the open ends of the mesh, by height: {}",
                name,
                known,
            )
        chosen.append(_curve(loops[number - 1]))
    return _Start(chosen, np.zeros(len(wall.vertices), dtype=bool), [])


def _lowest(wall: MeshWall) -> float:
    return float((wall.vertices if wall.samples is None else wall.samples)[:, 2].min())


def _from_platform(wall: MeshWall, height: float, label: str) -> _Start:
    """From the open ends that stand on the plane through its lowest place, else from about the floor that lies there, else
    from the lowest open end."""
    lowest = _lowest(wall)
    loops = _loops(wall)
    standing = [loop for loop in loops if loop[:, 2].max() < lowest + height]
    if standing:
        text = Text(
            "the first layer is the edge of {} at {}, which stands on the platform",
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
        first, _ = first_curves(wall, ground, value, find_rims(wall))
        text = Text(
            "the first layer runs {:g} mm over the floor of {}, which is not deposited",
            ABOVE * height,
            label,
        )
        if first:
            return _Start(first, value < 0.0, [Issue(NOTE, "FIRST_LAYER", text)])
    if not loops:
        raise InputError(
            "NO_START",
            label,
            "it stands on a point and has no open end to start from; give a substrate that it grows on, "
            "or turn it so that an end lies on the platform",
        )
    text = Text(
        "the first layer is the lowest open end of {}, Edge1 at {}, which does not lie on the platform",
        label,
        place(loops[0].mean(axis=0)),
    )
    return _Start(
        [_curve(loops[0])],
        np.zeros(len(wall.vertices), dtype=bool),
        [Issue(NOTE, "FIRST_LAYER", text)],
    )


def _refuse_loose(wall: MeshWall, start: _Start, label: str) -> None:
    """InputError GAP where a piece of the wall hangs together with nothing that layers start from."""
    number, part = connected_parts(wall, ~start.behind)
    if number < 2:
        return
    near = cKDTree(np.vstack([one.points for one in start.first]))
    reach = 2.0 * wall.mesh.longest_edge
    for k in range(number):
        mine = wall.vertices[part == k]
        away = near.query(mine)[0]
        if away.min() > reach and len(mine) > 2:
            raise InputError(
                "GAP",
                label,
                "it is {} pieces that do not hang together, and no layer starts on the one at {}, {:.4g} mm "
                "from where layers start; choose its edge to start from too, or deposit it by itself",
                number,
                place(mine[np.argmin(away)]),
                away.min(),
            )
