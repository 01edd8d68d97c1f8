# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles of a solid that enclose what the solid does: the kernel's may close and yet lack a part of a long twisted face
at one deflection, and have it at the next."""

from __future__ import annotations

from typing import Any

from ..core.geometry.mesh.solid import SolidMesh
from ..core.issues import WARNING, Issue, Text
from .kernel.process import in_kernel_process
from .sections_agree import sections_agree
from .shapes.fine_mesh import fine
from .shapes.tessellate import Tessellation

FINER = (1.0, 0.8, 1.2, 0.5)  # of the deflection asked for, in the order in which they are tried
MAX_DEFLECTIONS = (
    1.5  # deflections between triangles and shape, on average over its area, that are not fault
)


def complete_mesh(solid: Any, chord: float, label: str) -> tuple[Tessellation, tuple[Issue, ...]]:
    """Triangles within about `chord` mm of a Part.Solid, whose volume equals the solid's within its
    area times a few chords; with a warning MESH_VOLUME if no attempt does and the sections differ
    from the solid's, too.
    """
    exact, area = abs(float(solid.Volume)), float(solid.Area)
    attempts: list[tuple[float, Tessellation]] = []
    for share in FINER:
        tessellation = in_kernel_process(fine, solid.copy(), share * chord)
        volume = abs(SolidMesh(tessellation.vertices, tessellation.triangles).volume)
        if abs(volume - exact) <= MAX_DEFLECTIONS * max(share, 1.0) * chord * area:
            return tessellation, ()
        attempts.append((volume, tessellation))
    volume, tessellation = attempts[0]
    if sections_agree(
        solid, tessellation.vertices, tessellation.triangles, chord, abs(volume - exact)
    ):
        return tessellation, ()  # it is the kernel's integral of the volume that is off
    volume, tessellation = min(attempts, key=lambda attempt: abs(attempt[0] - exact))
    message = Text(
        "{}: its triangles enclose {:.4g} cm3 but its faces {:.4g} cm3; check the part and "
        "export it again, or deposit it from a mesh",
        label,
        1e-3 * volume,
        1e-3 * exact,
    )
    return tessellation, (Issue(WARNING, "MESH_VOLUME", message),)
