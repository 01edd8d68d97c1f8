# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls on a substrate, in the most exact representation that the faces allow."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import FreeCAD
import numpy as np
import Part
from scipy.spatial import cKDTree

from ...core.geometry.formatting import at_least, count, format_deviation, place
from ...core.geometry.mesh.coarsen import doubled_areas
from ...core.geometry.mesh.edge_runs import CORNER, runs
from ...core.geometry.mesh.refine import boundary
from ...core.geometry.obstacles import Body
from ...core.geometry.step_count import step_count
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
from ...core.geometry.walls.surface_wall import TABLE, TORUS, Placed, SurfaceWall
from ...core.issues import NOTE, InputError, Issue, Text
from ...core.types import Array, Mask
from ..kernel.limits import FAULTS, reported
from ..shapes.no_solid import no_solid
from .checks import CREASE, refuse_tight_tube
from .patch_wall import EQUILATERAL_AREA, find_patch_wall, from_substrate, several_loops, sound
from .sheet import Substrate, substrate_of
from .wall import Tube, faces_by_name, tubes

# ---- Intersection of wall and substrate by OpenCASCADE, ordered and projected onto both surfaces

TOUCH = 0.05  # mm; maximum gap between a wall and its substrate
ON_EDGE = 1e-3  # mm; tolerance of an edge at the end of the wall
END_SAMPLES = 12  # samples around an end that decide which end is in the substrate
POINTS = 480  # number of points of the first layer
STEPS = 12
EXACT = 1e-9  # mm


def find_wall(
    shape: Any,
    faces: Sequence[str],
    substrate: Any,
    label: str = "part",
    substrate_label: str = "substrate",
) -> SurfaceWall:
    """Build the wall of a Part.Shape on the solid `substrate`, both in part coordinates.

    The first layer is the uppermost loop of the intersection. An issue reports several loops.

    Raises the InputErrors of `brep.walls.wall.tubes`, and NO_SOLID, INSIDE_OUT, NO_CONTACT,
    OPEN_CONTACT, INSIDE, WALL_EDGE, SELF_INTERSECTION.
    """
    solid = _solid(substrate, substrate_label)
    named, tubes_both_ways = tubes(shape, faces, label)
    if tubes_both_ways[0].kind == TABLE:
        sound(named, label)  # the kernel may crash on self-intersecting faces
    tube = min(tubes_both_ways, key=lambda candidate: _distance_outside(candidate, solid))
    surface = tube.surface()
    loops = _intersection_loops(tube, named, solid)
    if not loops:
        gap = min(face.distToShape(solid)[0] for _, face in named)
        raise InputError(
            "NO_CONTACT",
            label,
            "the wall does not meet {} in a closed curve (nearest {:.4g} mm); extend the wall "
            "into the substrate all around",
            substrate_label,
            gap,
        )
    chains = sorted((_chain(loop, surface, solid) for loop in loops), key=lambda chain: chain[1])
    points, _, error = chains[-1]
    _refuse_inside(tube, solid, label, substrate_label)
    _refuse_edges(tube, points, named, label)
    message = Text(
        "the first layer follows the intersection of the wall and {} within {} mm",
        substrate_label,
        format_deviation(error),
    )
    issues = [Issue(NOTE, "FIRST_LAYER", message)]
    if len(chains) > 1:
        issues.append(
            Issue(
                NOTE,
                "SEVERAL_LOOPS",
                Text(
                    "{} meets {} in {} loops; layers start at the uppermost loop",
                    label,
                    substrate_label,
                    len(chains),
                ),
            )
        )
    return SurfaceWall(
        tube.kind,
        tube.sizes,
        tube.frame,
        tube.end,
        points,
        tube.u,
        tube.v,
        tube.table,
        tube.period,
        label,
        tube.faces,
        tuple(issues),
    )


def _solid(substrate: Any, label: str) -> Any:
    if substrate is None or substrate.isNull() or not substrate.Solids:
        raise no_solid(substrate, label, Text("choose a solid part for the wall to grow on"))
    if substrate.Volume <= 0.0:
        raise InputError(
            "INSIDE_OUT", label, "the solid is inside out; repair it (Part, Check geometry)"
        )
    return substrate


def _distance_outside(tube: Tube, solid: Any) -> float:
    """Return the mean distance, mm, of the tube's lower end from the solid; 0 for points inside."""
    return float(np.mean([_distance(point, solid) for point in _ring(tube, 0.0)]))


def _ring(tube: Tube, u: float) -> Array:
    v = tube.period * np.arange(END_SAMPLES) / END_SAMPLES
    return tube.surface().point(np.full(END_SAMPLES, u), v)


def _distance(point: Array, solid: Any) -> float:
    vector = FreeCAD.Vector(*point)
    if solid.isInside(vector, 1e-7, True):
        return 0.0
    return float(solid.distToShape(Part.Vertex(vector))[0])


def _intersection_loops(tube: Tube, named: list[tuple[str, Any]], solid: Any) -> list[list[Any]]:
    """Return closed edge loops of the wall, extended by TOUCH at its lower end, and the solid."""
    wall = _longer(tube) or Part.Shell([face for _, face in named])
    loops, is_complete = _closed(solid.section(wall).Edges)
    if is_complete:
        return loops
    # OpenCASCADE 7.8 and later may omit a piece with elementary surfaces, but not with B-splines
    again, _ = _closed(solid.section(wall.toNurbs()).Edges)
    return again if len(again) > len(loops) else loops


def _closed(edges: list[Any]) -> tuple[list[list[Any]], bool]:
    """Return the closed loops of edges, and whether all edges belong to closed loops."""
    wires = [Part.Wire(chain) for chain in Part.sortEdges(edges)] if edges else []
    loops = [wire.OrderedEdges for wire in wires if wire.isClosed()]
    return loops, len(loops) == len(wires)


def _longer(tube: Tube) -> Any:
    """Return the tube as a face extended at its lower end; None for a tabulated surface."""
    if tube.kind == TABLE:
        return None
    origin, x, y, z = (
        FreeCAD.Vector(*column) for column in (tube.frame[:3, 3], *tube.frame[:3, :3].T)
    )
    if tube.kind == TORUS:
        bend, radius = tube.sizes
        torus = Part.makeTorus(bend, radius)  # about Z, in the plane of X and Y
        surface = torus.Faces[0].Surface
        low = -TOUCH / (bend - radius) if bend > radius else -TOUCH / bend
        face = surface.toShape(low, tube.end, 0.0, 2.0 * np.pi)
        return _posed(face, origin - x * bend, x, z, -y)
    radius, slope = tube.sizes
    foot, height = -TOUCH * np.cos(slope), tube.end * np.cos(slope)
    line = Part.makeLine(
        FreeCAD.Vector(radius - TOUCH * np.sin(slope), 0, foot),
        FreeCAD.Vector(radius + tube.end * np.sin(slope), 0, height),
    )
    face = line.revolve(FreeCAD.Vector(0, 0, 0), FreeCAD.Vector(0, 0, 1), 360)
    return _posed(face, origin, x, y, z)


def _posed(face: Any, origin: Any, x: Any, y: Any, z: Any) -> Any:
    face.Placement = FreeCAD.Placement(
        FreeCAD.Matrix(
            x.x, y.x, z.x, origin.x, x.y, y.y, z.y, origin.y, x.z, y.z, z.z, origin.z, 0, 0, 0, 1
        )
    )
    return face


def _chain(edges: list[Any], surface: Placed, solid: Any) -> tuple[Array, float, float]:
    """Return points (m, 3) around a loop on both surfaces, their mean u, and the error, mm.

    The error is the maximum distance of the points from the substrate.
    """
    length = sum(edge.Length for edge in edges)
    point_runs, error = [], 0.0
    last_point = None
    for edge in edges:
        count = step_count(POINTS * edge.Length, length, 4) + 1
        points = np.array([tuple(point) for point in edge.discretize(Number=count)])
        if last_point is not None and np.linalg.norm(points[-1] - last_point) < np.linalg.norm(
            points[0] - last_point
        ):
            points = points[::-1]
        elif last_point is None and len(edges) > 1:
            following = np.array([tuple(vertex.Point) for vertex in edges[1].Vertexes])
            ahead, behind = (
                np.linalg.norm(following - end, axis=1).min() for end in (points[-1], points[0])
            )
            if behind < ahead:
                points = points[::-1]
        last_point = points[-1]
        points, off = _fit_to_both(points, surface, _face_under(edge, solid))
        point_runs.append(points[:-1])
        error = max(error, off)
    chain = np.concatenate(point_runs)
    return chain, float(surface.inverse(chain)[0].mean()), error


def _face_under(edge: Any, solid: Any) -> Any:
    """Return the face of the solid on which an intersection edge lies."""
    vertices = [Part.Vertex(point) for point in edge.discretize(Number=5)[1:4]]
    return min(
        solid.Faces, key=lambda face: max(face.distToShape(vertex)[0] for vertex in vertices)
    )


def _fit_to_both(points: Array, surface: Placed, face: Any) -> tuple[Array, float]:
    """Move points along the wall onto the face's surface; return the maximum remaining gap too."""
    u, v = surface.inverse(points)
    under = face.Surface
    for _ in range(STEPS):
        wall_points, along, _ = surface.derivatives(u, v)
        foot, normal = _feet(wall_points, under)
        gap, rate = dot(foot - wall_points, normal), dot(along, normal)
        steep = np.abs(rate) > 1e-3 * np.linalg.norm(along, axis=1)
        u = u + np.where(steep, gap / np.where(steep, rate, 1.0), 0.0)
        if np.abs(gap).max() < EXACT:
            break
    wall_points = surface.point(u, v)
    return wall_points, float(
        np.linalg.norm(_feet(wall_points, under)[0] - wall_points, axis=1).max()
    )


def _feet(points: Array, under: Any) -> tuple[Array, Array]:
    """Return the nearest points (n, 3) on a surface, and the surface normals there."""
    feet, normals = [], []
    for point in points:
        a, b = under.parameter(FreeCAD.Vector(*point))
        feet.append(tuple(under.value(a, b)))
        normals.append(tuple(under.normal(a, b)))
    return np.array(feet), np.array(normals)


def _refuse_inside(tube: Tube, solid: Any, label: str, substrate_label: str) -> None:
    inside = [
        solid.isInside(FreeCAD.Vector(*point), 1e-7, False) for point in _ring(tube, tube.end)
    ]
    if any(inside):
        raise InputError(
            "INSIDE",
            label,
            "both ends of the wall are inside {}; extend one end outside",
            substrate_label,
        )


def _refuse_edges(tube: Tube, points: Array, named: list[tuple[str, Any]], label: str) -> None:
    """Raise InputError WALL_EDGE if a wall edge above the first layer is not the straight end.

    points: first layer, (m, 3).
    """
    surface = tube.surface()
    first_u, first_v = surface.inverse(points)
    order = np.argsort(first_v)
    shared = Counter(edge.hashCode() for _, face in named for edge in face.Edges)
    for name, face in named:
        for edge in face.Edges:
            if edge.isSeam(face) or shared[edge.hashCode()] > 1 or edge.Degenerated:
                continue
            u, v = surface.inverse(np.array([tuple(point) for point in edge.discretize(Number=9)]))
            rate = np.linalg.norm(surface.derivatives(u, v)[1], axis=1)
            from_end = np.abs(u - tube.end) * rate
            above = (u - np.interp(v, first_v[order], first_u[order], period=tube.period)) * rate
            if from_end.max() > ON_EDGE and above.max() > TOUCH:
                raise InputError(
                    "WALL_EDGE",
                    f"{label} {name}",
                    "the face has an edge that is neither a straight end of the tube nor below "
                    "the first layer, which cannot be deposited yet; fill openings, and cut ends "
                    "straight",
                )


# ---- Wall representations that faces allow, the most exact first

UPRIGHT = 0.7  # minimum Z component of the normal of a floor
FLOOR = 0.1  # layer heights; maximum height of a floor above the lowest point
ABOVE = 0.5  # layer heights; height above a floor at which the wall begins


def find_mesh_wall(
    body: Body,
    substrate: Substrate | None,
    height: float,
    label: str,
    start_edges: Sequence[str],
    mend: float,
) -> MeshWall:
    """Build the wall of a mesh, for layers of `height` mm.

    The wall starts from `start_edges`, or else where it leaves the substrate, or without a
    substrate from the platform below its lowest point. Edges are the boundary loops, named Edge1
    and so on, sorted by the height of their centres. mend: maximum size of a hole to close, mm.

    Raises the InputErrors of `core.geometry.walls.mesh_wall`, and NO_CONTACT, INSIDE, NO_START,
    UNKNOWN_EDGE, GAP.
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
    """Return the boundary loops (n, 3), sorted by the height of their centres.

    The first point is not repeated.
    """
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
                "the mesh has no {}; choose from the open ends of the mesh, sorted by height: {}",
                name,
                available,
            )
        selected.append(_curve(loops[number - 1]))
    return _Start(selected, np.zeros(len(wall.vertices), dtype=bool), [])


def _lowest(wall: MeshWall) -> float:
    return float((wall.vertices if wall.samples is None else wall.samples)[:, 2].min())


def _from_platform(wall: MeshWall, height: float, label: str) -> _Start:
    """Start from open ends on the platform, else around a floor, else from the lowest open end.

    The platform is the plane through the lowest point.
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
    """Raise InputError GAP if no layer starts on a separate piece of the wall."""
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
                "the wall has {} separate pieces, and no layer starts on the piece at {}, {:.4g} "
                "mm from the start of the layers; choose a start edge of this piece too, or "
                "deposit the piece as a separate feature",
                number,
                place(piece_points[np.argmin(distance)]),
                distance.min(),
            )


PLANE_TYPE = "Part::GeomPlane"
MOST_NAMED = 8  # maximum number of face names in a message
BELOW = 9  # samples along the tube that decide whether it stays in the substrate's bounding box
# errors after which the wall is tried as a patch wall, which need not be a closed tube
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
    """Build the wall of a Part.Shape or mesh (Body), for layers of `height` mm.

    The result is a SurfaceWall if the faces form one closed surface with a straight end and the
    first layer is one loop. Otherwise, and always with `fronts`, it is a PatchWall. Coordinates are
    those of the shape.

    substrate: a Part.Shape with solids, a mesh (Body or Mesh.Mesh), or None if layers start from
    `start_edges`, or without names from edges on the platform. mend: maximum size of a mesh hole to
    close, mm. fronts: whether layers are offset fronts.

    Raises InputErrors as in `find_patch_wall` and `substrate_of`, LAYER_HEIGHT, BAD_SHAPE.
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
            pass  # a patch wall needs fewer kernel operations
    named = named_faces(shape, faces, label)
    wall = find_patch_wall(shape, named, carrier, height, label, start_edges)
    if carrier is None or carrier.shape is not None or start_edges or fronts:
        return wall
    return _as_tube(wall, shape, faces, carrier, label) or wall


def _starts_all_around(tube: SurfaceWall, solid: Any) -> bool:
    """Whether the first layer runs around the tube and all other loops are inside the substrate.

    Other loops are inside, such as in the bore of a pipe, if the tube below the first layer stays
    in the substrate's bounding box.
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
    """Return the wall faces of a shape as (name, face).

    These are the named faces. Without names, use all faces of a shape without solids, or the curved
    faces of a solid if they are connected and no flat face is tangent to them.

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
            "the object is a solid whose curved faces ({}) do not form one wall; select the wall "
            "faces, or name them in part.faces of a job",
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
            "the curved faces of the object are tangent to {}, which is flat; select the wall "
            "faces, or name them in part.faces of a job",
            flat,
        )
    return curved


def _one_piece(faces: list[Any]) -> bool:
    """Whether faces are connected by common edges."""
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
    """Convert a wall on a mesh substrate to a tube of one surface with a straight end, or None."""
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
