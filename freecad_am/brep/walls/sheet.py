# SPDX-License-Identifier: LGPL-2.1-or-later
"""Connected faces as one sheet: one patch per face and one watertight mesh, uniformly oriented."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import FreeCAD  # noqa: F401  Part crashes the process if imported before FreeCAD
import numpy as np
import Part

from ...core.geometry.formatting import place
from ...core.geometry.mesh.coarsen import collapse_edges, doubled_areas
from ...core.geometry.mesh.refine import Edges, count_halved, flip_edges, refine_mesh
from ...core.geometry.mesh.repair import repair_mesh
from ...core.geometry.mesh.solid import SolidMesh
from ...core.geometry.obstacles import Body
from ...core.geometry.walls.contact import ExactGround, FacetGround, Ground
from ...core.geometry.walls.patch import Patch
from ...core.geometry.walls.patch_wall import PatchWall
from ...core.geometry.walls.surface import dot
from ...core.issues import InputError, Issue, Text
from ...core.types import Array, Index
from ..kernel.limits import refuse_bare
from ..kernel.process import in_kernel_process
from ..shapes.no_solid import no_solid
from ..shapes.tessellate import ANGLE, Tessellation, body, tessellated, welded
from .surface_patch import Places, patch_of

SEWN = 0.01  # mm; maximum distance of face edges to merge
MAX_TRIANGLES = 1_500_000  # triangles
SECOND_TRY = 15000  # triangles; smaller meshes are accepted at the first attempt
EDGE_SHARES = (1.0, 0.84, 0.71, 0.59)  # factors on the edge length of successive first meshes
SIDE_SAMPLES = 200  # maximum number of triangles that decide the side of a face
COLLAPSE = 0.55  # fraction of the maximum edge length; shorter edges are collapsed


def sheet(named: Sequence[tuple[str, Any]], edge: float, label: str) -> PatchWall:
    """Mesh the faces as a wall without start and ends, with edges of at most `edge` mm.

    Triangles are oriented as the faces, all to the same side. Raises InputError ROUGH_WALL,
    NOT_ORIENTABLE, TOO_FINE, and the errors of `kernel.refuse_bare`.
    """
    names, faces = [name for name, _ in named], [face for _, face in named]
    shape, order = _sewn(faces)
    names = [names[k] for k in order]
    faces = shape.Faces
    patches = [patch_of(face, f"{label} {name}") for name, face in zip(names, faces)]
    (vertices, triangles, owner, nodes), about = in_kernel_process(tessellated_for, shape, edge)
    refuse_bare(list(zip(names, faces)), owner, label)
    triangles = _orient_triangles(triangles, owner, names, label)
    sheet_places = Places(shape, patches, nodes, vertices, edge)
    mesh = (
        refine_mesh(vertices, triangles, owner, edge, sheet_places.middles, MAX_TRIANGLES)
        if about < 2 * MAX_TRIANGLES
        else None
    )
    if (
        mesh is None and about < MAX_TRIANGLES
    ):  # long needles, as on slanted tubes, where flipped edges reach from side to side
        sheet_places = Places(shape, patches, nodes, vertices, edge)
        mesh = refine_mesh(
            vertices, triangles, owner, edge, sheet_places.middles, MAX_TRIANGLES, flip=False
        )
    if mesh is None:
        raise _too_fine(edge, about, label)
    vertices, triangles, owner = mesh
    triangles, owner = collapse_edges(vertices, triangles, owner, COLLAPSE * edge, edge)
    triangles = flip_edges(vertices, triangles, owner)
    uv = np.empty((len(triangles), 3, 2))
    turned = []
    for k, patch in enumerate(patches):
        on_face = owner == k
        used, index = np.unique(triangles[on_face], return_inverse=True)
        parameters = sheet_places.parameters(k, vertices, used)
        uv[on_face] = patch.unwrap(parameters[np.ravel(index)].reshape(-1, 3, 2))
        turned.append(facing(patch, vertices[triangles[on_face]]))
    used, index = np.unique(triangles, return_inverse=True)
    vertices, triangles = vertices[used], np.ravel(index).reshape(-1, 3).astype(np.intp)
    return PatchWall(
        vertices,
        triangles,
        owner,
        uv,
        tuple(turned),
        (),
        np.zeros(len(vertices), dtype=bool),
        (),
        label,
        tuple(names),
    )


def _too_fine(edge: float, about: float, label: str) -> InputError:
    if about >= MAX_TRIANGLES:
        return InputError(
            "TOO_FINE",
            label,
            "with edges of {:.3g} mm, from the layer height and the smallest radius, the wall "
            "mesh needs more than {} triangles, about {:.2g}; use a larger layer height, larger "
            "bend radii, or deposit the wall in parts",
            edge,
            MAX_TRIANGLES,
            about,
        )
    return InputError(
        "TOO_FINE",
        label,
        "refining the wall mesh to edges of {:.3g} mm, from the layer height and the smallest "
        "radius, does not converge, though about {:.2g} triangles should suffice; strongly "
        "twisted faces such as coils cause this: split the face, or deposit the wall in parts or "
        "as a solid",
        edge,
        about,
    )


def facing(patch: Patch, corners: Array) -> Patch:
    """Orient a patch so that triangles `corners` (m, 3, 3) are counter-clockwise from outside."""
    corners = corners[:: max(1, len(corners) // SIDE_SAMPLES)]
    facets = doubled_areas(corners)
    normals = patch.at(patch.inverse(corners.mean(axis=1)))[1]
    return replace(patch, sign=patch.sign if dot(facets, normals).sum() > 0.0 else -patch.sign)


def _sewn(faces: list[Any]) -> tuple[Any, list[int]]:
    """Sew faces to one shape; return the shape and the index of each of its faces in `faces`."""
    shape = Part.Compound(faces)
    if len(faces) > 1:
        shape.sewShape(SEWN)
    if len(shape.Faces) != len(faces):
        shape = Part.Compound(faces)
    keys = [(face.CenterOfMass, face.Area) for face in faces]
    order = []
    for face in shape.Faces:
        middle, area = face.CenterOfMass, face.Area
        order.append(
            min(
                range(len(faces)),
                key=lambda k: keys[k][0].distanceToPoint(middle) + abs(keys[k][1] - area),
            )
        )
    return shape, order if len(set(order)) == len(order) else list(range(len(faces)))


def tessellated_for(shape: Any, edge: float) -> tuple[Tessellation, float]:
    """Return the best of several tessellations, and the estimated number of triangles.

    The best tessellation needs the fewest triangles after halving edges to at most `edge` mm:
    halves of slightly too long edges are much too short.
    """
    candidates: list[tuple[float, Tessellation]] = []
    for share in EDGE_SHARES:
        tessellation = tessellated(shape, max(0.1 * edge * share**2, 1e-3), ANGLE * share)
        candidates.append((count_halved(tessellation[0][tessellation[1]], edge), tessellation))
        if candidates[0][0] < SECOND_TRY or candidates[0][0] > 4 * MAX_TRIANGLES:
            break
    about, best = min(candidates, key=lambda tessellation: tessellation[0])
    return best, about


def _orient_triangles(triangles: Index, owner: Index, names: list[str], label: str) -> Index:
    """Flip faces so that neighbouring triangles agree. Raises InputError NOT_ORIENTABLE."""
    edges = Edges(triangles)
    half = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2)
    forward = half[:, :, 0] < half[:, :, 1]
    two = np.flatnonzero(edges.count == 2)
    face_a, face_b = edges.faces[two].T
    directions = [
        forward[face, np.argmax(edges.of_triangle[face] == two[:, None], axis=1)]
        for face in (face_a, face_b)
    ]
    against = directions[0] == directions[1]
    count = len(names)
    links: dict[int, list[tuple[int, bool]]] = {k: [] for k in range(count)}
    pairs = np.sort(owner[np.stack([face_a, face_b], axis=1)], axis=1)
    for a, b in np.unique(pairs, axis=0):
        share = float(against[(pairs == (a, b)).all(axis=1)].mean())
        if (a == b and share > 0.0) or 0.02 < share < 0.98:
            raise _twisted(label, names[a], names[b])
        turn = share > 0.5
        links[int(a)].append((int(b), turn))
        links[int(b)].append((int(a), turn))
    turned = np.full(count, -1)
    for start in range(count):
        if turned[start] >= 0:
            continue
        turned[start], waiting = 0, [start]
        while waiting:
            current = waiting.pop()
            for neighbour, turn in links[current]:
                target = int(turned[current]) ^ int(turn)
                if turned[neighbour] < 0:
                    turned[neighbour] = target
                    waiting.append(neighbour)
                elif turned[neighbour] != target:
                    raise _twisted(label, names[current], names[neighbour])
    triangles = triangles.copy()
    flip = turned[owner] == 1
    triangles[flip] = triangles[flip][:, ::-1]
    return triangles


def _twisted(label: str, face_name: str, other_name: str) -> InputError:
    named = face_name if face_name == other_name else f"{face_name} and {other_name}"
    return InputError(
        "NOT_ORIENTABLE",
        label,
        "{} has no consistent side, like a twisted band; divide the band, or remove one of its "
        "faces",
        named,
    )


CHORD = 0.1  # mm; chord error of a solid's triangles
WELD_MM = 1e-5  # mm; maximum distance of mesh vertices to merge
CROSSED = 0.01  # mm; maximum overlap of a mesh that counts as touching itself


@dataclass(frozen=True)
class Substrate:
    """A substrate.

    shape: a Part.Shape with solids, None for a mesh. solid: the mesh, or the triangles of the shape
    within CHORD. face: (m,) face index of each triangle of a shape. issues: notes on mesh repairs.
    """

    label: str
    shape: Any
    solid: SolidMesh
    face: Any = None
    issues: tuple[Issue, ...] = ()

    def ground(self, edge: float) -> Ground:
        """Return the ground for a wall whose mesh has edges of `edge` mm."""
        if self.shape is None:
            return FacetGround(self.solid, edge)
        corners = self.solid.vertices[self.solid.triangles]
        patches = tuple(
            facing(patch_of(face, f"{self.label} Face{index + 1}"), corners[self.face == index])
            for index, face in enumerate(self.shape.Faces)
        )
        return ExactGround(self.solid, self.face, patches, CHORD, edge)


def substrate_of(source: Any, label: str, mend: float = 0.0) -> Substrate:
    """Return the substrate of a Part.Shape or a mesh (Body or Mesh.Mesh), in part coordinates.

    mend: maximum size of a mesh hole to close, mm.

    Raises InputError NO_SOLID, INSIDE_OUT, OPEN_MESH, NON_MANIFOLD, NOT_ORIENTABLE, SELF_CROSSING.
    """
    if isinstance(source, Body) or hasattr(source, "Topology"):
        mesh = source if isinstance(source, Body) else body(source, label)
        solid, issues = mesh_solid(mesh.vertices, mesh.triangles, label, mend)
        return Substrate(label, None, solid, None, issues)
    if source is None or source.isNull() or not source.Solids:
        raise no_solid(
            source, label, Text("choose a solid part or a closed mesh as substrate of the wall")
        )
    for solid in source.Solids:
        if solid.Volume <= 0.0:
            raise InputError(
                "INSIDE_OUT",
                label,
                "the solid around {} is inside out (volume {:.4g} mm3); repair it (Part, Check "
                "geometry), or reverse it (Part, Reverse shapes)",
                place(solid.BoundBox.Center),
                solid.Volume,
            )
    source = _as_one(source)
    tessellation = in_kernel_process(tessellated, source.copy(), CHORD)
    refuse_bare(
        [(f"Face{number + 1}", face) for number, face in enumerate(source.Faces)],
        tessellation.owner,
        label,
    )
    return Substrate(
        label, source, SolidMesh(tessellation.vertices, tessellation.triangles), tessellation.owner
    )


def _as_one(shape: Any) -> Any:
    """Return the shape with touching solids fused, because their contact is not an outer face."""
    solids = shape.Solids
    boxes = [solid.BoundBox for solid in solids]
    box_overlaps = [
        box.intersect(other_box) for k, box in enumerate(boxes) for other_box in boxes[:k]
    ]
    fused = solids[0].multiFuse(solids[1:]).removeSplitter() if any(box_overlaps) else shape
    return fused if fused.Solids else shape


def mesh_solid(
    points: Any, triangles: Any, label: str, mend: float = 0.0
) -> tuple[SolidMesh, tuple[Issue, ...]]:
    """Return the solid of a mesh with points (n, 3) and triangles (m, 3), and notes on repairs.

    Points closer than WELD_MM are merged, and degenerate triangles removed. An unsound mesh is
    repaired. Raises InputError NO_SOLID, BAD_FILE, OPEN_MESH, NON_MANIFOLD, NOT_ORIENTABLE,
    SELF_CROSSING.
    """
    if not len(triangles):
        raise InputError(
            "NO_SOLID", label, "the mesh has no triangles; choose a closed mesh or a solid part"
        )
    if not np.isfinite(points).all():
        raise InputError(
            "BAD_FILE", label, "the mesh has points with invalid coordinates; export it again"
        )
    vertices, corners, _ = welded(
        np.asarray(points, dtype=np.float64),
        np.asarray(triangles, dtype=np.intp),
        np.zeros(len(triangles), dtype=np.intp),
    )
    solid = SolidMesh(vertices, corners)
    try:
        solid.refuse_unsound(label)
    except InputError:
        result = repair_mesh(
            np.asarray(points, dtype=np.float64), np.asarray(triangles, dtype=np.intp), label, mend
        )
        begin = np.cumsum([0, *(len(mesh.vertices) for mesh in result.solids)])
        corners = np.vstack([mesh.triangles + offset for mesh, offset in zip(result.solids, begin)])
        return SolidMesh(
            np.vstack([mesh.vertices for mesh in result.solids]), corners
        ), result.issues
    solid.refuse_crossing(label, CROSSED)
    return solid, ()
