# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces that are to be covered with layers of beads, as smooth sheets whose outer side the layers grow to."""

from __future__ import annotations

from dataclasses import dataclass

from ...issues import Issue
from ..obstacles import Body
from .patch_wall import PatchWall


@dataclass(frozen=True, eq=False)
class CladFaces:
    """label: of the part. faces: their names. sheets: connected faces that run on smoothly, each as one; none of them starts
    or ends anywhere. surroundings: the part itself where it is a solid, substrate and fixtures. depths: None, a face has no
    volume."""

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
        """How far, mm, the sheets are off what is to be covered, at most: 0 of exact faces."""
        return max((getattr(sheet, "smoothing", 0.0) for sheet in self.sheets), default=0.0)
