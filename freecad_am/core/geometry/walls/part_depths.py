# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a part's volume is distributed about the surface that its beads follow.

It says how much of the part beads of some width deposit, and how much they miss. A bead
is as wide as its width and is on the side of the surface where the part is; on a surface
within the part, as in the middle of two walls, it is half on each side. The figures are
estimates from evenly spread samples, good to about a hundredth of the part.
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
    """Depths of a part under the surface that its beads follow.

    label: name of the part in messages. volume: mm3 of its solids, 0 without solids. area:
    mm2 that beads cover. depths: (k,) mm, sorted: bead width needed for each equal share of
    the part, inf for a share under no bead. thickness: (m,) mm, sorted: how far the part
    reaches under each equal share of the surface. faces: names of the faces that no bead
    follows, with face_depths (f,), as `depths` for the middle of each, and face_areas (f,)
    mm2. aside: names and mm3 of solids of which no face carries beads.
    """

    label: str
    volume: float
    area: float
    depths: Array
    thickness: Array
    faces: tuple[str, ...] = ()
    face_depths: tuple[float, ...] = ()
    face_areas: tuple[float, ...] = ()
    aside: tuple[tuple[str, float], ...] = ()

    def volume_within(self, width: float) -> float:
        """Return the volume of the part, mm3, that beads of a width, mm, deposit."""
        return self.volume * float(np.mean(self.depths <= width)) if len(self.depths) else 0.0

    def outside(self, width: float) -> float:
        """Volume of beads of a width, mm, that the part does not reach to, mm3."""
        return (
            self.area * float(np.maximum(width - self.thickness, 0.0).mean())
            if len(self.thickness)
            else 0.0
        )
