# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces that are to be covered with layers of beads, as smooth sheets whose outer side the layers grow to."""

from __future__ import annotations

from dataclasses import dataclass

from ...issues import Issue
from ..obstacles import Body
from .patch_wall import PatchWall


@dataclass(frozen=True, eq=False)
class CladFaces:
    """Faces of a part to be clad.

    label: of the part. faces: their names. sheets: smoothly connected faces, each group as
    one sheet; none of them starts or ends anywhere. surroundings: the part itself if it is a
    solid, substrate and fixtures. depths: None, a face has no volume.
    """

    label: str
    faces: tuple[str, ...]
    sheets: tuple[PatchWall, ...]
    surroundings: tuple[Body, ...] = ()
    issues: tuple[Issue, ...] = ()
    depths: None = None

    @property
    def area(self) -> float:
        """mm2 of the faces, by their triangles."""
        return float(sum(sheet.mesh.areas.sum() for sheet in self.sheets))

    @property
    def smoothing(self) -> float:
        """Maximum distance, mm, of the sheets from the faces to be covered: 0 for exact faces."""
        return max((getattr(sheet, "smoothing", 0.0) for sheet in self.sheets), default=0.0)
