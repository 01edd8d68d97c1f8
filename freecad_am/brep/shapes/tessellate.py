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

DEFLECTION = 0.1  # mm, largest distance of the triangles from a curved face
WELDED = 1e-5  # mm; vertices of the tessellations of two faces
ANGLE = 0.35  # rad between neighbouring triangles of the first, coarse mesh


def body(source: Any, name: str) -> Body:
    """The triangles of a Part.Shape with faces, or of a Mesh.Mesh, in its coordinates; raises InputError 'NO_FACES'."""
    mesh = hasattr(source, "Topology")
    vertices, triangles = (
        _rows(*source.Topology) if mesh else in_kernel_process(triangles_of, source, DEFLECTION)
    )
    if not len(triangles):
        raise InputError(
            "NO_FACES",
            name,
            "it has no faces for the clearance check; choose a solid or a mesh",
        )
    return Body(name, vertices, triangles)


def triangles_of(shape: Any, deflection: float) -> tuple[Array, Index]:
    """Points (n, 3) and triangles (m, 3) of a Part.Shape, within `deflection` mm."""
    return _rows(*shape.tessellate(deflection))


def _rows(points: Any, triangles: Any) -> tuple[Array, Index]:
    return np.array([tuple(point) for point in points], dtype=np.float64), np.array(
        triangles, dtype=np.int64
    )


class Tessellation(NamedTuple):
    """Vertices (n, 3), triangles (m, 3), the face (m,) of each, and for each face the parameters
    (k, 2) of its vertices.
    """

    vertices: Array
    triangles: Index
    owner: Index
    nodes: list[Array]


def tessellated(shape: Any, chord: float, angle: float = ANGLE) -> Tessellation:
    """Triangles within `chord` mm of the shape; faces share the vertices of their common edges.
    Faces on which the kernel fails have no triangles.
    """
    import MeshPart  # slow to import

    # all faces at once, so that shared edges are divided alike; coarser than a call per face
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
    """Whether the kernel made triangles of a face when it meshed the shape. Meshing a single face
    that failed before may take minutes without a way to end it, for a few triangles that do not
    meet the neighbours'.
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
)  # triangles of a face that take the kernel eight seconds, and half a second
PLACES = 7  # samples along u and along v on a face
SHARE = 0.75  # triangles of the kernel, of the area over the distance and the mean radius
NEARER = 0.7  # share of the requested chord error, as some of the few triangles are a quarter farther off


def fine(shape: Any, chord: float) -> Tessellation:
    """Triangles within `chord` mm of the shape, as `tessellated` has them; without nodes after
    quartering, or if splines replace faces on which the kernel fails, such as some countersinks.
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
    # not above: it imports splines, which parts of revolution do without
    from ..walls.surface_patch import Places, patch_of

    try:
        patches = [patch_of(face, "") for face in shape.Faces]
    except InputError:  # only the kernel knows this kind of face
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
    """Estimated number of triangles that the kernel makes of a face; 0 for one that is curved in
    one direction only.
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
            except Exception:  # a place at which the surface has no curvature
                continue
    return SHARE * float(face.Area) * float(np.mean(bends or [0.0])) / chord


# ---- Exact distances of points from the faces of a shape, their place on it found by triangles

MIN_DEFLECTION_MM, DEFLECTION_SHARE = (
    0.02,
    2e-4,
)  # mm, and of the extent: deflection of the triangles
MAX_FOOT_GAP_DEFLECTIONS = 4.0  # deflections between the two feet of a point on a bent face, beyond which it is past the edge of the face,
TURNED = 0.1  # and this share of its distance: triangles are turned against the face


@dataclass(frozen=True, eq=False)
class Skin:
    """Triangles of a shape, vertices (n, 3) mm and corners (m, 3), within `deflection` mm; `exact`
    gives distances (k,) of points (k, 3), outside with a plus, and the unit normals (k, 3) along
    which they count.
    """

    vertices: Array
    triangles: Index
    deflection: float
    exact: Callable[[Array], tuple[Array, Array]]


def skin(shape: Any, label: str) -> Skin:
    """The faces of a Part.Shape, to measure from. Raises InputError NO_FACES."""
    if not shape.Faces:
        raise InputError(
            "NO_FACES", label, "it has no faces to compare points with; choose a solid or a surface"
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
    """Vertices (n, 3), triangles (m, 3), and the number of the face (m,) of each."""
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
    if closed:  # what is past the edge of its face is nearest to the edge
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
