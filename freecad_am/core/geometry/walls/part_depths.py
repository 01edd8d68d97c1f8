# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a part's volume lies about the surface that its beads run on: what beads of some width deposit of it, and beside it.

A bead is as wide as its width says and lies on the side of the surface where the part is; on a surface within the part, as
the middle of two walls, it lies half on each side. What is measured at places spread evenly is an estimate, good to about
a hundredth of the part.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...types import Array


@dataclass(frozen=True, eq=False)
class Surface:
    """Places (n, 3) spread over a surface, unit normals (n, 3) there to either side, and the area (n,) mm2 of each."""

    points: Array
    normals: Array
    areas: Array


@dataclass(frozen=True, eq=False)
class PartDepths:
    """label: what messages call the part. volume: mm3 of its solids, 0 of a part without. area: mm2 that beads run on.
    depths: (k,) mm, sorted: how wide a bead must be for each equal share of the part, inf for what lies under no bead.
    thickness: (m,) mm, sorted: how far the part reaches under each equal share of the surface. faces: names of the faces
    that no bead runs on, with face_depths (f,), as `depths` for the middle of each, and face_areas (f,) mm2. aside: names
    and mm3 of solids that beads run on no face of."""

    label: str
    volume: float
    area: float
    depths: Array
    thickness: Array
    faces: tuple[str, ...] = ()
    face_depths: tuple[float, ...] = ()
    face_areas: tuple[float, ...] = ()
    aside: tuple[tuple[str, float], ...] = ()

    def within(self, width: float) -> float:
        """Volume of the part, mm3, that beads of a width, mm, deposit."""
        return self.volume * float(np.mean(self.depths <= width)) if len(self.depths) else 0.0

    def outside(self, width: float) -> float:
        """Volume of beads of a width, mm, that the part does not reach to, mm3."""
        return (
            self.area * float(np.maximum(width - self.thickness, 0.0).mean())
            if len(self.thickness)
            else 0.0
        )
