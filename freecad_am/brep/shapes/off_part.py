# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances of points from the faces or solids to be deposited: by triangles, and by the kernel for
large ones.

Slicing code is not used here: no surface is inverted, and no wall or solid of a feature takes part.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD
import numpy as np
import Part

from ...core.collision.inside import inside_of
from ...core.geometry.columns import dots
from ...core.geometry.mesh.solid import Search, SolidMesh
from ...core.geometry.obstacles import Body
from ...core.issues import InputError
from ...core.types import Array, Integers, Mask
from ..kernel.process import in_kernel_process
from .tessellate import triangles_of

DEFLECTION, FINE = 0.05, 0.005  # mm
DEFLECTION_SHARE = 1e-4  # share of the size of shapes larger than half a metre: the kernel's time grows faster than the area
# places at which the triangles are not conclusive, so that the kernel is called; farthest first
MAX_KERNEL_POINTS = 200
FAILURES = 3  # kernel failures after which it is not called again
ALWAYS = 5  # and as many in any case
MAX_EDGE_POINTS = 500  # places for kernel calls on parts that consist of edges
INSIDE_DEPTH = 1e-6  # mm
PIECE = 1000  # places done together; bounds the memory


def off_faces(shape: Any, names: Sequence[str], points: Array, allowed: float) -> Array:
    """Distances (n,) mm of points (n, 3) from faces of a shape, by their names, or from all; NaN without faces.

    Distances over `allowed` mm come from the kernel for the MAX_KERNEL_POINTS farthest points; the
    others come from triangles less their possible error, so that no distance is overestimated.
    """
    faces_by_name = {f"Face{number}": face for number, face in enumerate(shape.Faces, start=1)}
    selected = [
        faces_by_name[name] for name in dict.fromkeys(names) if name in faces_by_name
    ] or list(faces_by_name.values())
    if not selected:
        return np.full(len(points), np.nan)
    faces = Part.makeCompound([face.copy(False) for face in selected])
    triangles = _Triangles(faces)
    return _exact(faces, points, triangles.distances(points), allowed, triangles.deflection, False)


def off_edges(shape: Any, names: Sequence[str], points: Array) -> Array:
    """Distances (n,) mm of points (n, 3) from edges of a shape, by their names, or from all; by the
    kernel for up to MAX_EDGE_POINTS spread points, NaN at the others.
    """
    edges_by_name = {f"Edge{number}": edge for number, edge in enumerate(shape.Edges, start=1)}
    edges = Part.makeCompound(
        [edges_by_name[name] for name in dict.fromkeys(names) if name in edges_by_name]
        or list(shape.Edges)
    )
    distances = np.full(len(points), np.nan)
    for k in np.unique(
        np.linspace(0, len(points) - 1, min(len(points), MAX_EDGE_POINTS)).round().astype(int)
    ).tolist():
        try:
            distances[k] = _by_kernel(edges, points[k], False)
        except (RuntimeError, Part.OCCError):  # unknown there
            continue
    return distances


def off_solids(shape: Any, points: Array, allowed: float) -> Array:
    """Distances (n,) mm of points (n, 3) outside of the solids of a shape, 0 inside; as `off_faces`.

    Solids may touch, and be inside out. A place over `allowed` mm that the triangles of a solid wind around is inside,
    whatever side its nearest triangle, or the kernel, puts it on.
    """
    solids = [_right_side_out(solid) for solid in shape.Solids or [shape]]
    distances, nearest = np.full(len(points), np.inf), np.zeros(len(points), dtype=np.intp)
    meshed: list[tuple[Any, _Triangles]] = []
    meshes: list[tuple[_Triangles, Any]] = []  # of each solid, and the solid that it is of
    for number, solid in enumerate(solids):
        twin = next((entry for entry in meshed if _differs_by_place(entry[0], solid)), None)
        if twin is None:
            mesh, local_points = _Triangles(solid.copy(False)), points
            meshed.append((solid, mesh))
        else:
            mesh, local_points = twin[1], _seen_from(twin[0], solid, points)
        meshes.append((mesh, solid if twin is None else twin[0]))
        members = np.flatnonzero(mesh.box_off(local_points) <= distances)
        distance = np.maximum(mesh.signed(local_points[members]), 0.0)
        closer = ~(distance >= distances[members])  # NaN too: then it is unknown
        distances[members[closer]], nearest[members[closer]] = distance[closer], number
    for number, solid in enumerate(solids):
        members = np.flatnonzero(nearest == number)
        distances[members] = _exact(
            solid.copy(False),
            points[members],
            distances[members],
            allowed,
            _deflection(solid),
            True,
        )
    for (mesh, twin), solid in zip(meshes, solids, strict=True):
        over = np.flatnonzero(distances > allowed)
        if len(over):
            distances[over[mesh.winds_around(_seen_from(twin, solid, points[over]))]] = 0.0
    return distances


def _right_side_out(solid: Any) -> Any:
    """The solid with its faces looking outwards; some files have solids that are inside out."""
    return solid.reversed() if solid.ShapeType == "Solid" and solid.Volume < 0.0 else solid


def off_mesh(vertices: Array, triangles: Integers, points: Array) -> Array:
    """Distances (n,) mm of points (n, 3) outside of a mesh, 0 inside any of its pieces, even pieces
    that are crossed by others or inside out. Holes count as closed at any size; the feature has
    reported them.
    """
    inside = inside_of(Body("", vertices, triangles))
    if inside is None:
        return _off_pieces(vertices, triangles, points)
    distance = np.where(
        inside.holds(points), 0.0, _distances(_searched(vertices, triangles), points)
    )
    doubtful = (
        distance > DEFLECTION
    )  # a piece inside out takes away from those that it cuts: its own side counts
    if doubtful.any():
        distance[doubtful] = np.minimum(
            distance[doubtful], _off_pieces(vertices, triangles, points[doubtful])
        )
    return distance


def _off_pieces(vertices: Array, triangles: Integers, points: Array) -> Array:
    """The same as `off_mesh`, with each piece of the mesh repaired and measured separately."""
    from ...core.geometry.mesh.repair import repair_mesh  # few parts are meshes

    try:
        components = repair_mesh(vertices, triangles.astype(np.intp), "", np.inf, True).solids
    except InputError:  # the side of the nearest triangle is all there is
        return np.maximum(_signed(_searched(vertices, triangles), points), 0.0)
    distance = np.min(
        [
            _distances(_searched(component.vertices, component.triangles), points)
            for component in components
        ],
        axis=0,
    )
    for component in components:
        inside = inside_of(Body("", component.vertices, component.triangles.astype(np.int64)))
        if inside is not None:
            distance[inside.holds(points)] = 0.0
    return distance


def off_facets(vertices: Array, triangles: Integers, points: Array) -> Array:
    """Distances (n,) mm of points (n, 3) from the triangles of a mesh, open or closed."""
    distance: Array = _distances(_searched(vertices, triangles), points)
    return distance


def _differs_by_place(other_solid: Any, solid: Any) -> bool:
    return bool(other_solid.isPartner(solid)) and other_solid.Orientation == solid.Orientation


def _seen_from(twin: Any, solid: Any, points: Array) -> Array:
    """Points (n, 3) at a solid, moved along to its twin, which differs only by its placement."""
    transform = np.array(twin.Placement.multiply(solid.Placement.inverse()).toMatrix().A).reshape(
        4, 4
    )
    moved: Array = points @ transform[:3, :3].T + transform[:3, 3]
    return moved


def _deflection(shape: Any) -> float:
    """How far triangles may be off a shape, mm."""
    return max(DEFLECTION, DEFLECTION_SHARE * float(shape.BoundBox.DiagonalLength))


class _Triangles:
    """A shape as triangles, within `deflection` mm; distances are NaN if the kernel makes no
    triangles.
    """

    def __init__(self, shape: Any, fine: bool = False) -> None:
        self.deflection = _deflection(shape) * (FINE / DEFLECTION if fine else 1.0)
        vertices, triangles = in_kernel_process(triangles_of, shape, self.deflection)
        self.corners = vertices[np.asarray(triangles, dtype=np.intp)] if len(triangles) else None
        self.search = _searched(vertices, triangles) if len(triangles) else None
        self.box = (vertices.min(axis=0), vertices.max(axis=0)) if len(triangles) else None

    def box_off(self, points: Array) -> Array:
        """Distances (n,) mm of points (n, 3) from the box around the triangles, which are no nearer."""
        if self.box is None:
            return np.zeros(len(points))
        low, high = self.box
        off: Array = np.linalg.norm(
            np.maximum(np.maximum(low - points, points - high), 0.0), axis=1
        )
        return off

    def distances(self, points: Array) -> Array:
        """Distances (n,) mm of points (n, 3)."""
        return (
            np.full(len(points), np.nan) if self.search is None else _distances(self.search, points)
        )

    def signed(self, points: Array) -> Array:
        """Distances (n,) mm of points (n, 3), negative inside."""
        return np.full(len(points), np.nan) if self.search is None else _signed(self.search, points)

    def winds_around(self, points: Array) -> Mask:
        """Whether the triangles go round points (n, 3) once or more, by the sum of their solid angles."""
        if self.corners is None:
            return np.zeros(len(points), dtype=bool)
        inside = [abs(_solid_angle(self.corners - point)) > 2.0 * np.pi for point in points]
        return np.array(inside, dtype=bool)


def _solid_angle(corners: Array) -> float:
    """The solid angle, sr, under which triangles (n, 3, 3) are seen from the origin (van Oosterom and Strackee 1983)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    denominator = la * lb * lc + dots(a, b) * lc + dots(b, c) * la + dots(c, a) * lb
    return float(2.0 * np.arctan2(volume, denominator).sum())


def _searched(vertices: Array, triangles: Any) -> Search:
    return SolidMesh(vertices, triangles).searched(0.01 * float(np.ptp(vertices, axis=0).max()))


def _distances(search: Search, points: Array) -> Array:
    return np.concatenate([search.distance(chunk) for chunk in _pieces(points)])


def _signed(search: Search, points: Array) -> Array:
    return np.concatenate([search.signed(chunk)[0] for chunk in _pieces(points)])


def _pieces(points: Array) -> list[Array]:
    return np.array_split(points, max(1, len(points) // PIECE))


def _exact(
    shape: Any, points: Array, coarse: Array, allowed: float, deflection: float, solid: bool
) -> Array:
    """The distances `coarse`, from triangles within `deflection` mm, improved by the kernel at the
    farthest points and at points over the allowance; by finer triangles if the kernel fails, as it
    does next to a surface of revolution. No other distance exceeds the largest improved one.
    """
    exact = np.maximum(coarse - deflection, 0.0)
    order = np.argsort(-coarse, kind="stable")
    checked = order[
        : max(ALWAYS, min(MAX_KERNEL_POINTS, int((coarse > allowed + deflection).sum())))
    ]
    unsure = []
    for k in checked.tolist():
        if len(unsure) > FAILURES:
            unsure.append(k)
            continue
        try:
            exact[k] = _by_kernel(shape, points[k], solid)
        except (RuntimeError, Part.OCCError):
            unsure.append(k)
    if unsure:
        finer = _Triangles(shape, fine=True)
        finer_distance = finer.signed(points[unsure]) if solid else finer.distances(points[unsure])
        exact[unsure] = np.maximum(finer_distance - 2.0 * finer.deflection, 0.0)
    return np.minimum(exact, np.fmax.reduce(exact[checked], initial=0.0))


def _by_kernel(shape: Any, position: Array, solid: bool) -> float:
    point = FreeCAD.Vector(*position.tolist())
    return (
        0.0
        if solid and shape.isInside(point, INSIDE_DEPTH, True)
        else float(shape.distToShape(Part.Vertex(point))[0])
    )
