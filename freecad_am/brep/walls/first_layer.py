# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a wall leaves its substrate: the intersection by OpenCASCADE, in order, brought onto both surfaces."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import FreeCAD
import numpy as np
import Part

from ...core.geometry.formatting import format_deviation
from ...core.geometry.step_count import step_count
from ...core.geometry.walls.surface import dot
from ...core.geometry.walls.surface_wall import TABLE, TORUS, Placed, SurfaceWall
from ...core.issues import NOTE, InputError, Issue, Text
from ...core.types import Array
from ..shapes.no_solid import no_solid
from .patch_wall import sound
from .wall import Tube, tubes

TOUCH = 0.05  # mm; a wall that ends this short of its substrate counts as touching
ON_EDGE = 1e-3  # mm; tolerance of an edge on the end of the wall
END_SAMPLES = 12  # samples around an end that decide which end is in the substrate
POINTS = 480  # points of the first layer
STEPS = 12
EXACT = 1e-9  # mm


def find_wall(
    shape: Any,
    faces: Sequence[str],
    substrate: Any,
    label: str = "part",
    substrate_label: str = "substrate",
) -> SurfaceWall:
    """The wall of a Part.Shape on the solid `substrate`, in the coordinates of both.

    The first layer is the loop in which the wall leaves the substrate for good; an issue reports
    several loops. Raises the InputErrors of `brep.wall.tubes`, and NO_SOLID, INSIDE_OUT,
    NO_CONTACT, OPEN_CONTACT, INSIDE, WALL_EDGE, SELF_INTERSECTION.
    """
    solid = _solid(substrate, substrate_label)
    named, tubes_both_ways = tubes(shape, faces, label)
    if tubes_both_ways[0].kind == TABLE:
        sound(named, label)  # the kernel may crash on faces that cut themselves
    tube = min(tubes_both_ways, key=lambda candidate: _distance_outside(candidate, solid))
    surface = tube.surface()
    loops = _loops(tube, named, solid)
    if not loops:
        gap = min(face.distToShape(solid)[0] for _, face in named)
        raise InputError(
            "NO_CONTACT",
            label,
            "the wall does not meet {} in a closed curve (nearest {:.4g} mm); extend it into the "
            "substrate all around",
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
                    "{} meets {} in {} loops; layers start at the uppermost",
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
    """Mean distance (mm) of the tube's lower end from the solid; 0 for points inside."""
    return float(np.mean([_distance(point, solid) for point in _ring(tube, 0.0)]))


def _ring(tube: Tube, u: float) -> Array:
    v = tube.period * np.arange(END_SAMPLES) / END_SAMPLES
    return tube.surface().point(np.full(END_SAMPLES, u), v)


def _distance(point: Array, solid: Any) -> float:
    vector = FreeCAD.Vector(*point)
    if solid.isInside(vector, 1e-7, True):
        return 0.0
    return float(solid.distToShape(Part.Vertex(vector))[0])


def _loops(tube: Tube, named: list[tuple[str, Any]], solid: Any) -> list[list[Any]]:
    """Closed loops of edges in which the wall, made TOUCH longer at its lower end, meets the solid."""
    wall = _longer(tube) or Part.Shell([face for _, face in named])
    loops, is_complete = _closed(solid.section(wall).Edges)
    if is_complete:
        return loops
    # of elementary surfaces OpenCASCADE 7.8 and later leave out a piece at times; of B-splines they do not
    again, _ = _closed(solid.section(wall.toNurbs()).Edges)
    return again if len(again) > len(loops) else loops


def _closed(edges: list[Any]) -> tuple[list[list[Any]], bool]:
    """The closed loops among edges, and whether there are no others."""
    wires = [Part.Wire(chain) for chain in Part.sortEdges(edges)] if edges else []
    loops = [wire.OrderedEdges for wire in wires if wire.isClosed()]
    return loops, len(loops) == len(wires)


def _longer(tube: Tube) -> Any:
    """The tube as a face, a little longer below; None for a table, whose face is taken as it is."""
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
    """Points (m, 3) around a loop on both surfaces, their mean u, and how far they are off the substrate, mm."""
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
    """The face of the solid that carries an edge of the intersection."""
    vertices = [Part.Vertex(point) for point in edge.discretize(Number=5)[1:4]]
    return min(
        solid.Faces, key=lambda face: max(face.distToShape(vertex)[0] for vertex in vertices)
    )


def _fit_to_both(points: Array, surface: Placed, face: Any) -> tuple[Array, float]:
    """Points moved up or down the wall onto the face's surface, and the largest remaining distance."""
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
    """Nearest points (n, 3) of a surface and its normals there."""
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
    """InputError where an edge of the wall above the first layer, points (m, 3), is not its end across the tube."""
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
                    "it has an edge that is neither a straight end of the tube nor below the "
                    "first layer, which cannot be deposited yet; fill openings, and cut ends "
                    "straight",
                )
