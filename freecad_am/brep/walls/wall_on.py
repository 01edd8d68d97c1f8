# SPDX-License-Identifier: LGPL-2.1-or-later
"""The wall on a substrate, as the layers of the most exact kind that its faces allow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...core.geometry.formatting import at_least, count, place
from ...core.geometry.mesh.collapsed import doubled_areas
from ...core.geometry.mesh.edge_runs import CORNER, runs
from ...core.geometry.mesh.refined import boundary
from ...core.geometry.obstacles import Body
from ...core.geometry.walls.contact import PlaneGround, first_curves, fit_splines, ground_distances
from ...core.geometry.walls.mesh_wall import (
    MAX_TRIANGLES,
    MeshWall,
    connected_parts,
    find_rims,
    mark_ends,
    mesh_wall,
)
from ...core.geometry.walls.patch_wall import FirstCurve, PatchWall
from ...core.geometry.walls.surface import dot
from ...core.geometry.walls.surface_wall import SurfaceWall
from ...core.issues import NOTE, InputError, Issue, Text
from ...core.types import Array, Mask
from ..kernel.limits import FAULTS, reported
from .checks import CREASE, refuse_tight_tube
from .first_layer import find_wall
from .patch_wall import EQUILATERAL_AREA, find_patch_wall, from_substrate, several_loops
from .sheet import Substrate, substrate_of
from .wall import faces_by_name, tubes

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


PLANE_TYPE = "Part::GeomPlane"
MOST_NAMED = 8  # faces named in a message
BELOW = 9  # samples up the tube that decide whether it stays in the substrate's box
# a wall need not be a closed tube of one surface that starts in one loop
OTHER_KIND = frozenset(
    {"NOT_ONE_SURFACE", "NOT_CLOSED", "WALL_EDGE", "NO_WALL", "ROUGH_WALL", "NO_CONTACT", "INSIDE"}
)


def wall_on(
    shape: Any,
    faces: Sequence[str],
    substrate: Any,
    height: float,
    label: str = "part",
    substrate_label: str = "substrate",
    start_edges: Sequence[str] = (),
    mend: float = 0.0,
    fronts: bool = False,
) -> SurfaceWall | PatchWall:
    """The wall of a Part.Shape, or of a mesh (Body), for layers of `height` mm, in its coordinates. mend: the largest hole
    of a mesh that is closed, mm.

    substrate: a Part.Shape with solids, a mesh (Body or Mesh.Mesh), or None where layers start from
    edges of the part; from its edges on the platform if none are named. A SurfaceWall where the
    faces are one surface that closes around, its end straight across, and the first layer one loop;
    a PatchWall otherwise, and always for fronts. Raises InputErrors as in `find_patch_wall` and
    `substrate_of`, LAYER_HEIGHT, BAD_SHAPE.
    """
    with reported(substrate_label, substrate):
        carrier = None if substrate is None else substrate_of(substrate, substrate_label, mend)
    with reported(label, shape):
        wall = _wall_on(shape, faces, carrier, height, label, start_edges, mend, fronts)
    return wall if carrier is None else replace(wall, issues=(*carrier.issues, *wall.issues))


def _wall_on(
    shape: Any,
    faces: Sequence[str],
    carrier: Substrate | None,
    height: float,
    label: str,
    start_edges: Sequence[str],
    mend: float,
    fronts: bool,
) -> SurfaceWall | PatchWall:
    if isinstance(shape, Body):
        return find_mesh_wall(shape, carrier, height, label, start_edges, mend)
    if carrier is not None and carrier.shape is not None and not start_edges and not fronts:
        try:
            tube = find_wall(shape, faces, carrier.shape, label, carrier.label)
            if _starts_all_around(tube, carrier.shape):
                refuse_tight_tube(tube, height, label)
                return tube
        except InputError as error:
            if error.code not in OTHER_KIND:
                raise
        except FAULTS:
            pass  # the wall as a sheet asks less of the kernel
    named = named_faces(shape, faces, label)
    wall = find_patch_wall(shape, named, carrier, height, label, start_edges)
    if carrier is None or carrier.shape is not None or start_edges or fronts:
        return wall
    return _as_tube(wall, shape, faces, carrier, label) or wall


def _starts_all_around(tube: SurfaceWall, solid: Any) -> bool:
    """Whether the first layer runs around the tube, and the tube below stays within the box of the
    substrate, so that the wall's other loops are inside, such as in the bore of a pipe.
    """
    surface = tube.surface()
    u, v = surface.inverse(np.vstack([tube.first, tube.first[:1]]))
    turn = np.remainder(np.diff(v) + 0.5 * tube.period, tube.period) - 0.5 * tube.period
    if abs(abs(turn.sum()) - tube.period) > 1e-3 * tube.period:
        return False
    if not any(issue.code == "SEVERAL_LOOPS" for issue in tube.issues):
        return True
    below = surface.point(
        np.linspace(0.0, 1.0, BELOW)[:, None] * u, np.broadcast_to(v, (BELOW, len(v)))
    ).reshape(-1, 3)
    box = solid.BoundBox
    low, high = np.array([box.XMin, box.YMin, box.ZMin]), np.array([box.XMax, box.YMax, box.ZMax])
    return bool(((below > low - 1e-3) & (below < high + 1e-3)).all())


def named_faces(shape: Any, names: Sequence[str], label: str) -> list[tuple[str, Any]]:
    """The chosen faces: named ones, else every face of a shape without solids, else the curved
    faces of a solid if they connect and no flat face joins them smoothly.

    Raises InputError NO_WALL, UNKNOWN_FACE.
    """
    faces = faces_by_name(shape, names, label)
    if names:
        return [(name, faces[name]) for name in dict.fromkeys(names)]
    if not shape.Solids:
        return list(faces.items())
    curved = [(name, face) for name, face in faces.items() if face.Surface.TypeId != PLANE_TYPE]
    if not curved or not _one_piece([face for _, face in curved]):
        listed = (
            ", ".join(name for name, _ in curved[:MOST_NAMED])
            + (", ..." if len(curved) > MOST_NAMED else "")
            or "none"
        )
        raise InputError(
            "NO_WALL",
            label,
            "it is a solid whose curved faces ({}) do not form one wall; select the wall faces, "
            "or name them in part.faces of a job",
            listed,
        )
    flat = next(
        (
            name
            for name, face in faces.items()
            if face.Surface.TypeId == PLANE_TYPE
            and any(_runs_on(face, curved_face) for _, curved_face in curved)
        ),
        "",
    )
    if flat:
        raise InputError(
            "NO_WALL",
            label,
            "its curved faces are tangent to {}, which is flat; select the wall faces, or name "
            "them in part.faces of a job",
            flat,
        )
    return curved


def _one_piece(faces: list[Any]) -> bool:
    """Whether faces hang together by common edges."""
    edges = [{edge.hashCode() for edge in face.Edges} for face in faces]
    reached, unreached = edges[0], edges[1:]
    while unreached:
        adjacent = [codes for codes in unreached if codes & reached]
        if not adjacent:
            return False
        unreached = [codes for codes in unreached if not codes & reached]
        reached = reached.union(*adjacent)
    return True


def _runs_on(face: Any, other_face: Any) -> bool:
    """Whether two faces join smoothly along an edge."""
    codes = {edge.hashCode() for edge in other_face.Edges}
    for edge in face.Edges:
        if edge.hashCode() in codes:
            point = edge.valueAt(0.5 * (edge.FirstParameter + edge.LastParameter))
            normal, other_normal = (
                side.normalAt(*side.Surface.parameter(point)) for side in (face, other_face)
            )
            if normal.cross(other_normal).Length < np.sin(CREASE):
                return True
    return False


def _as_tube(
    wall: PatchWall, shape: Any, faces: Sequence[str], substrate: Substrate, label: str
) -> SurfaceWall | None:
    """A wall on a mesh as a tube of one surface that ends straight across, or None if it is not
    one.
    """
    ends = [rim for rim in wall.rims if rim.end]
    if len(wall.first) != 1 or not wall.first[0].closed or len(ends) != 1:
        return None
    try:
        _, tubes_both_ways = tubes(shape, faces, label)
    except InputError:
        return None
    search = substrate.solid.searched(wall.mesh.typical_edge)
    v = 2.0 * np.pi * np.arange(12) / 12
    lowest = [
        search.signed(candidate.surface().point(0.0 * v, v * candidate.period / (2.0 * np.pi)))[
            0
        ].mean()
        for candidate in tubes_both_ways
    ]
    tube = tubes_both_ways[int(np.argmin(lowest))]
    surface = tube.surface()
    u, v_end = surface.inverse(ends[0].points)
    rate = np.linalg.norm(surface.derivatives(u, v_end)[1], axis=1)
    if (
        np.abs((u - tube.end) * rate).max() > 1e-3
        or len([rim for rim in wall.rims if rim.closed]) != len(wall.rims)
        or len(wall.rims) > 2
    ):
        return None
    return SurfaceWall(
        tube.kind,
        tube.sizes,
        tube.frame,
        tube.end,
        wall.first[0].points,
        tube.u,
        tube.v,
        tube.table,
        tube.period,
        label,
        tube.faces,
        wall.issues,
    )
