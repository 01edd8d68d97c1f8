# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far places are off the faces or solids that were to be deposited: by triangles, and by the kernel where that is much.

Nothing of it is what slicing uses: no surface is inverted, and no wall or solid of a feature is asked.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD
import numpy as np
import Part

from freecad_am.core.types import Array, Integers, Mask

from ...core.collision.inside import inside_of
from ...core.geometry.columns import dots
from ...core.geometry.mesh.solid import Search, SolidMesh
from ...core.geometry.obstacles import Body
from ...core.issues import InputError
from ..kernel.process import in_kernel_process
from .tessellate import triangles_of

DEFLECTION, FINE = 0.05, 0.005  # mm
LARGE = 1e-4  # and this share of the size of what is larger than half a metre: the kernel's time grows faster than its area
ASKED = 200  # places that triangles are not sure of and the kernel is asked about, the farthest ones first
FAILURES = 3  # of the kernel; it is not asked on then
ALWAYS = 5  # and as many in any case
MOST_ON_EDGES = 500  # places that the kernel is asked about whose edges are the part
INSIDE = 1e-6  # mm
PIECE = 1000  # places done together; bounds the memory


def off_faces(shape: Any, names: Sequence[str], points: Array, allowed: float) -> Array:
    """Distances (n,) mm of points (n, 3) from faces of a shape, by their names, or from all; NaN without faces.

    Those over `allowed` mm are the kernel's, of the ASKED farthest; the others are by triangles less what these may be off,
    so that no place is told to be farther than it is.
    """
    known = {f"Face{number}": face for number, face in enumerate(shape.Faces, start=1)}
    chosen = [known[name] for name in dict.fromkeys(names) if name in known] or list(known.values())
    if not chosen:
        return np.full(len(points), np.nan)
    faces = Part.makeCompound([face.copy(False) for face in chosen])
    triangles = _Triangles(faces)
    return _exact(faces, points, triangles.away(points), allowed, triangles.deflection, False)


def off_edges(shape: Any, names: Sequence[str], points: Array) -> Array:
    """Distances (n,) mm of points (n, 3), as many as MOST_ON_EDGES spread over them and NaN at the others, from edges of a
    shape, by their names, or from all; by the kernel."""
    known = {f"Edge{number}": edge for number, edge in enumerate(shape.Edges, start=1)}
    edges = Part.makeCompound(
        [known[name] for name in dict.fromkeys(names) if name in known] or list(shape.Edges)
    )
    found = np.full(len(points), np.nan)
    for k in np.unique(
        np.linspace(0, len(points) - 1, min(len(points), MOST_ON_EDGES)).round().astype(int)
    ).tolist():
        try:
            found[k] = _by_kernel(edges, points[k], False)
        except (RuntimeError, Part.OCCError):  # nobody knows there
            continue
    return found


def off_solids(shape: Any, points: Array, allowed: float) -> Array:
    """Distances (n,) mm of points (n, 3) outside of the solids of a shape, 0 inside; as `off_faces`.

    Solids may touch, and be inside out. A place over `allowed` mm that the triangles of a solid wind around is inside,
    whatever side its nearest triangle, or the kernel, puts it on.
    """
    solids = [_right_side_out(solid) for solid in shape.Solids or [shape]]
    found, nearest = np.full(len(points), np.inf), np.zeros(len(points), dtype=np.intp)
    made: list[tuple[Any, _Triangles]] = []
    meshes: list[tuple[_Triangles, Any]] = []  # of each solid, and the solid that it is of
    for number, solid in enumerate(solids):
        first = next((entry for entry in made if _differs_by_place(entry[0], solid)), None)
        if first is None:
            mesh, seen = _Triangles(solid.copy(False)), points
            made.append((solid, mesh))
        else:
            mesh, seen = first[1], _seen_from(first[0], solid, points)
        meshes.append((mesh, solid if first is None else first[0]))
        mine = np.flatnonzero(mesh.box_off(seen) <= found)
        away = np.maximum(mesh.signed(seen[mine]), 0.0)
        closer = ~(away >= found[mine])  # NaN too: then nobody knows
        found[mine[closer]], nearest[mine[closer]] = away[closer], number
    for number, solid in enumerate(solids):
        mine = np.flatnonzero(nearest == number)
        found[mine] = _exact(
            solid.copy(False), points[mine], found[mine], allowed, _deflection(solid), True
        )
    for (mesh, first), solid in zip(meshes, solids, strict=True):
        over = np.flatnonzero(found > allowed)
        if len(over):
            found[over[mesh.winds_around(_seen_from(first, solid, points[over]))]] = 0.0
    return found


def _right_side_out(solid: Any) -> Any:
    """The solid with its faces looking outwards; some files have solids that are inside out."""
    return solid.reversed() if solid.ShapeType == "Solid" and solid.Volume < 0.0 else solid


def off_mesh(vertices: Array, triangles: Integers, points: Array) -> Array:
    """Distances (n,) mm of points (n, 3) outside of a mesh, 0 inside of any piece of it, whatever triangles of others cross
    that, and of any that is inside out. Holes count as closed, however large: which are, the feature has told."""
    whole = inside_of(Body("", vertices, triangles))
    if whole is None:
        return _off_pieces(vertices, triangles, points)
    away = np.where(whole.holds(points), 0.0, _away(_searched(vertices, triangles), points))
    doubtful = (
        away > DEFLECTION
    )  # a piece inside out takes away from those that it cuts: its own side counts
    if doubtful.any():
        away[doubtful] = np.minimum(
            away[doubtful], _off_pieces(vertices, triangles, points[doubtful])
        )
    return away


def _off_pieces(vertices: Array, triangles: Integers, points: Array) -> Array:
    """The same, each piece of the mesh mended and looked at by itself."""
    from ...core.geometry.mesh.repair import repair_mesh  # few parts are meshes

    try:
        pieces = repair_mesh(vertices, triangles.astype(np.intp), "", np.inf, True).solids
    except InputError:  # the side of the nearest triangle is all there is
        return np.maximum(_signed(_searched(vertices, triangles), points), 0.0)
    away = np.min(
        [_away(_searched(piece.vertices, piece.triangles), points) for piece in pieces], axis=0
    )
    for piece in pieces:
        inside = inside_of(Body("", piece.vertices, piece.triangles.astype(np.int64)))
        if inside is not None:
            away[inside.holds(points)] = 0.0
    return away


def off_facets(vertices: Array, triangles: Integers, points: Array) -> Array:
    """Distances (n,) mm of points (n, 3) from the triangles of a mesh, open or closed."""
    found: Array = _away(_searched(vertices, triangles), points)
    return found


def _differs_by_place(first: Any, solid: Any) -> bool:
    return bool(first.isPartner(solid)) and first.Orientation == solid.Orientation


def _seen_from(first: Any, solid: Any, points: Array) -> Array:
    """Points (n, 3) at a solid, moved to where they are at the one that differs from it by its place alone."""
    way = np.array(first.Placement.multiply(solid.Placement.inverse()).toMatrix().A).reshape(4, 4)
    moved: Array = points @ way[:3, :3].T + way[:3, 3]
    return moved


def _deflection(shape: Any) -> float:
    """How far triangles may be off a shape, mm."""
    return max(DEFLECTION, LARGE * float(shape.BoundBox.DiagonalLength))


class _Triangles:
    """A shape as triangles, within `deflection` mm; distances are NaN where the kernel makes none of it."""

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

    def away(self, points: Array) -> Array:
        """Distances (n,) mm of points (n, 3)."""
        return np.full(len(points), np.nan) if self.search is None else _away(self.search, points)

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
    rest = la * lb * lc + dots(a, b) * lc + dots(b, c) * la + dots(c, a) * lb
    return float(2.0 * np.arctan2(volume, rest).sum())


def _searched(vertices: Array, triangles: Any) -> Search:
    return SolidMesh(vertices, triangles).searched(0.01 * float(np.ptp(vertices, axis=0).max()))


def _away(search: Search, points: Array) -> Array:
    return np.concatenate([search.distance(some) for some in _pieces(points)])


def _signed(search: Search, points: Array) -> Array:
    return np.concatenate([search.signed(some)[0] for some in _pieces(points)])


def _pieces(points: Array) -> list[Array]:
    return np.array_split(points, max(1, len(points) // PIECE))


def _exact(
    shape: Any, points: Array, found: Array, allowed: float, deflection: float, solid: bool
) -> Array:
    """The distances, found by triangles within `deflection` mm, with those of the farthest places, and of what is over what
    is allowed, as the kernel gives them; by finer triangles where it fails, as it does beside a surface of revolution. No
    other place is told to be farther than the farthest one asked about."""
    exact = np.maximum(found - deflection, 0.0)
    order = np.argsort(-found, kind="stable")
    asked = order[: max(ALWAYS, min(ASKED, int((found > allowed + deflection).sum())))]
    unsure = []
    for k in asked.tolist():
        if len(unsure) > FAILURES:
            unsure.append(k)
            continue
        try:
            exact[k] = _by_kernel(shape, points[k], solid)
        except (RuntimeError, Part.OCCError):
            unsure.append(k)
    if unsure:
        finer = _Triangles(shape, fine=True)
        away = finer.signed(points[unsure]) if solid else finer.away(points[unsure])
        exact[unsure] = np.maximum(away - 2.0 * finer.deflection, 0.0)
    return np.minimum(exact, np.fmax.reduce(exact[asked], initial=0.0))


def _by_kernel(shape: Any, place: Array, solid: bool) -> float:
    point = FreeCAD.Vector(*place.tolist())
    return (
        0.0
        if solid and shape.isInside(point, INSIDE, True)
        else float(shape.distToShape(Part.Vertex(point))[0])
    )
