# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes as triangles, for clearance, measurement and cuts."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...core.geometry.mesh.refine import Edges, quarter_triangles
from ...core.geometry.mesh.solid import Search, SolidMesh
from ...core.geometry.obstacles import Body
from ...core.issues import InputError
from ...core.types import Array, Index
from ..kernel.process import in_kernel_process

DEFLECTION = 0.1  # mm; maximum distance of triangles from a curved face
WELDED = 1e-5  # mm; maximum distance of vertices of two faces to merge
ANGLE = 0.35  # rad; maximum angle between neighbouring triangles of the first, coarse mesh


def body(source: Any, name: str) -> Body:
    """Return the triangles of a Part.Shape or Mesh.Mesh in the coordinates of the source.

    Raises InputError NO_FACES.
    """
    mesh = hasattr(source, "Topology")
    vertices, triangles = (
        _rows(*source.Topology) if mesh else in_kernel_process(triangles_of, source, DEFLECTION)
    )
    if not len(triangles):
        raise InputError(
            "NO_FACES",
            name,
            "the object has no faces for the clearance check; choose a solid or a mesh",
        )
    return Body(name, vertices, triangles)


def triangles_of(shape: Any, deflection: float) -> tuple[Array, Index]:
    """Return points (n, 3) and triangles (m, 3) of a Part.Shape, within `deflection` mm."""
    return _rows(*shape.tessellate(deflection))


def _rows(points: Any, triangles: Any) -> tuple[Array, Index]:
    return np.array([tuple(point) for point in points], dtype=np.float64), np.array(
        triangles, dtype=np.int64
    )


class Tessellation(NamedTuple):
    """Triangles of a shape.

    vertices: (n, 3), mm. triangles: (m, 3). owner: face index (m,) of each triangle. nodes: for
    each face, the parameters (k, 2) of its vertices.
    """

    vertices: Array
    triangles: Index
    owner: Index
    nodes: list[Array]


def tessellated(shape: Any, chord: float, angle: float = ANGLE) -> Tessellation:
    """Tessellate a shape within `chord` mm, with shared vertices on common edges.

    Faces on which the kernel fails have no triangles.
    """
    import MeshPart  # slow to import

    # mesh all faces in one call, so that shared edges get the same points; coarser than per face
    MeshPart.meshFromShape(
        Shape=shape, LinearDeflection=chord, AngularDeflection=angle, Relative=False
    )
    points, corners, owner, nodes, count = [], [], [], [], 0
    for k, face in enumerate(shape.Faces):
        face_points, triangles = face.tessellate(chord) if divided(face) else ([], [])
        points.append(np.array([tuple(point) for point in face_points]).reshape(-1, 3))
        corners.append(np.array(triangles, dtype=np.intp).reshape(-1, 3) + count)
        owner.append(np.full(len(triangles), k, dtype=np.intp))
        nodes.append(np.array(face.getUVNodes() if triangles else [], dtype=float).reshape(-1, 2))
        count += len(face_points)
    return Tessellation(
        *welded(np.vstack(points), np.vstack(corners), np.concatenate(owner)), nodes
    )


def divided(face: Any) -> bool:
    """Whether the kernel made triangles for a face when it meshed the shape.

    Meshing a failed face separately may take minutes, cannot be cancelled, and gives few triangles
    that do not meet their neighbours.
    """
    try:
        face.getUVNodes()
    except RuntimeError:
        return False
    return True


def welded(points: Array, triangles: Index, owner: Index) -> tuple[Array, Index, Index]:
    """Merge vertices closer than WELDED and drop triangles that lose a corner."""
    tree = cKDTree(points)
    representative = np.arange(len(points))
    pairs = tree.query_pairs(WELDED, output_type="ndarray")
    np.minimum.at(representative, pairs.max(axis=1), pairs.min(axis=1))
    while (representative[representative] != representative).any():
        representative = representative[representative]
    used_points, index = np.unique(representative, return_inverse=True)
    triangles = np.ravel(index)[triangles]
    proper = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    triangles, owner = triangles[proper], owner[proper]
    used, index = np.unique(triangles, return_inverse=True)
    return points[used_points][used], np.ravel(index).reshape(-1, 3).astype(np.intp), owner


SLOW_TRIANGLES, QUICK_TRIANGLES = (
    150_000,
    40_000,
)  # triangle counts of a face that take the kernel 8 s and 0.5 s
PLACES = 7  # number of samples along u and along v on a face
SHARE = 0.75  # ratio of the kernel's triangle count to area / (chord error * mean radius)
NEARER = 0.7  # factor on the requested chord error, which some coarse triangles exceed by a quarter


def fine(shape: Any, chord: float) -> Tessellation:
    """Tessellate a shape within `chord` mm, as `tessellated`, faster and for more faces.

    Large faces are refined by quartering. Splines replace faces on which the kernel fails, such as
    some countersinks. In both cases, the result has no nodes.
    """
    tessellation = _fine(shape, chord)
    if len(np.unique(tessellation.owner)) == len(shape.Faces):
        return tessellation
    splines = shape.toNurbs()
    if len(splines.Faces) != len(shape.Faces):
        return tessellation
    return tessellated(splines, chord)._replace(nodes=[])


def _fine(shape: Any, chord: float) -> Tessellation:
    about = max((_about(face, chord) for face in shape.Faces), default=0.0)
    if about < SLOW_TRIANGLES:
        return tessellated(shape, chord)
    # import here, because parts of revolution do not need splines
    from ..walls.surface_patch import Places, patch_of

    try:
        patches = [patch_of(face, "") for face in shape.Faces]
    except InputError:  # only the kernel supports this surface type
        return tessellated(shape, chord)
    times = math.ceil(math.log(about / QUICK_TRIANGLES, 4.0))
    vertices, triangles, owner, nodes = tessellated(shape, NEARER * chord * 4.0**times)
    ends = Edges(triangles).ends
    edge = (
        float(np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1).mean())
        * 0.5**times
    )
    sheet_places = Places(shape, patches, nodes, vertices, edge)
    for _ in range(times):
        vertices, triangles, owner = quarter_triangles(
            vertices, triangles, owner, sheet_places.middles
        )
    return Tessellation(vertices, triangles, owner, [])


def _about(face: Any, chord: float) -> float:
    """Estimate the number of triangles that the kernel makes for a face.

    The estimate is 0 for a face that is curved in one direction only.
    """
    low_u, high_u, low_v, high_v = face.ParameterRange
    if not all(map(math.isfinite, (low_u, high_u, low_v, high_v))):
        return 0.0
    share = (np.arange(PLACES) + 0.5) / PLACES
    bends = []
    for u in low_u + share * (high_u - low_u):
        for v in low_v + share * (high_v - low_v):
            try:
                bends.append(math.sqrt(abs(math.prod(face.curvatureAt(float(u), float(v))))))
            except Exception:  # the surface has no curvature at this point
                continue
    return SHARE * float(face.Area) * float(np.mean(bends or [0.0])) / chord


# ---- Exact distances of points from the faces of a shape, with triangles for the initial search

MIN_DEFLECTION_MM, DEFLECTION_SHARE = (
    0.02,
    2e-4,
)  # mm, and of the extent: deflection of the triangles
MAX_FOOT_GAP_DEFLECTIONS = 4.0  # deflections between the two feet of a point on a bent face, beyond which it is past the edge of the face,
TURNED = 0.1  # and this share of its distance: triangles are turned against the face


@dataclass(frozen=True, eq=False)
class Skin:
    """Triangles of a shape within `deflection` mm: vertices (n, 3), mm, and triangles (m, 3).

    exact: function of points (k, 3) that returns signed distances (k,), positive outside, and unit
    normals (k, 3) along which the distances are measured.
    """

    vertices: Array
    triangles: Index
    deflection: float
    exact: Callable[[Array], tuple[Array, Array]]


def skin(shape: Any, label: str) -> Skin:
    """Return the faces of a Part.Shape for distance measurement. Raises InputError NO_FACES."""
    if not shape.Faces:
        raise InputError(
            "NO_FACES",
            label,
            "the object has no faces to compare points with; choose a solid or a surface",
        )
    deflection = max(MIN_DEFLECTION_MM, DEFLECTION_SHARE * shape.BoundBox.DiagonalLength)
    vertices, triangles, face = in_kernel_process(_by_face, shape, deflection)
    mesh = SolidMesh(vertices, triangles)
    search = mesh.searched(0.02 * float(np.ptp(vertices, axis=0).max()))
    closed = bool(shape.Solids)
    faces = shape.Faces

    def exact(queries: Array) -> tuple[Array, Array]:
        return _exact(queries, faces, face, mesh, search, deflection, closed)

    return Skin(vertices, triangles, deflection, exact)


def _by_face(shape: Any, deflection: float) -> tuple[Array, Index, Index]:
    """Return vertices (n, 3), triangles (m, 3) and face indices (m,)."""
    points, corners = shape.tessellate(deflection)
    counts = [
        len(one_face.tessellate(deflection)[1]) if divided(one_face) else 0
        for one_face in shape.Faces
    ]
    face = np.repeat(np.arange(len(shape.Faces)), counts)
    return np.array([tuple(point) for point in points]), np.array(corners, dtype=np.intp), face


def _exact(
    points: Array,
    faces: list[Any],
    face: Index,
    mesh: SolidMesh,
    search: Search,
    deflection: float,
    closed: bool,
) -> tuple[Array, Array]:
    import FreeCAD

    rough, mesh_foot, triangle = search.signed(points)
    foot, normal = np.empty_like(points), np.empty_like(points)
    for k, point in enumerate(points.tolist()):
        nearest_face = faces[face[triangle[k]]]
        u, v = nearest_face.Surface.parameter(FreeCAD.Vector(*point))
        foot[k], normal[k] = (
            tuple(nearest_face.Surface.value(u, v)),
            tuple(nearest_face.normalAt(u, v)),
        )
    distance = ((points - foot) * normal).sum(axis=1)
    if closed:  # a point beyond the edge of its face is nearest to the edge
        flat = np.array([one.Surface.TypeId == "Part::GeomPlane" for one in faces])[face[triangle]]
        slack = np.where(flat, 1e-6, MAX_FOOT_GAP_DEFLECTIONS * deflection + TURNED * np.abs(rough))
        past = np.linalg.norm(foot - mesh_foot, axis=1) > slack
        offset = points[past] - mesh_foot[past]
        size = np.maximum(np.abs(rough[past]), 1e-12)[:, None]
        normal[past] = np.where(
            size > 1e-9, np.sign(rough[past])[:, None] * offset / size, mesh.units[triangle[past]]
        )
        distance[past] = rough[past]
    return distance, normal
