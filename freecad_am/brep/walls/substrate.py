# SPDX-License-Identifier: LGPL-2.1-or-later
"""The part that a wall grows on: a solid of faces or of triangles, checked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.geometry.formatting import place
from ...core.geometry.mesh.repair import repair_mesh
from ...core.geometry.mesh.solid import SolidMesh
from ...core.geometry.obstacles import Body
from ...core.geometry.walls.ground import ExactGround, FacetGround, Ground
from ...core.issues import InputError, Issue, Text
from ..kernel.limits import refuse_bare
from ..kernel.process import in_kernel_process
from ..shapes.no_solid import no_solid
from ..shapes.tessellate import body, tessellated, welded
from .sheet import facing
from .surface_patch import patch_of

CHORD = 0.1  # mm between a solid and its triangles
WELD_MM = 1e-5  # mm; closer vertices of a mesh are merged
CROSSED = 0.01  # mm; a mesh that cuts itself by no more only touches itself


@dataclass(frozen=True)
class Substrate:
    """shape: a Part.Shape with solids, None for a mesh. solid: the mesh, or the solid's triangles
    within CHORD; then face: (m,) the face of each, from 0. issues: notes on repairs of a mesh.
    """

    label: str
    shape: Any
    solid: SolidMesh
    face: Any = None
    issues: tuple[Issue, ...] = ()

    def ground(self, edge: float) -> Ground:
        """Prepared for a wall whose mesh has edges of `edge` mm."""
        if self.shape is None:
            return FacetGround(self.solid, edge)
        corners = self.solid.vertices[self.solid.triangles]
        patches = tuple(
            facing(patch_of(face, f"{self.label} Face{index + 1}"), corners[self.face == index])
            for index, face in enumerate(self.shape.Faces)
        )
        return ExactGround(self.solid, self.face, patches, CHORD, edge)


def substrate_of(source: Any, label: str, mend: float = 0.0) -> Substrate:
    """The substrate of a Part.Shape or of a mesh (a Body, or a Mesh.Mesh), in part coordinates. mend: the largest hole of a
    mesh that is closed, mm.

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
    """The shape with touching solids fused, as the contact between them is not an outside."""
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
    """The solid of a mesh's points (n, 3) and triangles (m, 3), points closer than WELD_MM merged,
    triangles that then lack a corner left out; else the mesh as `mesh_repair` repairs it, with
    notes. InputError NO_SOLID, BAD_FILE, OPEN_MESH, NON_MANIFOLD, NOT_ORIENTABLE, SELF_CROSSING.
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
