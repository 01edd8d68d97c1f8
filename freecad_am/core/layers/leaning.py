# SPDX-License-Identifier: LGPL-2.1-or-later
"""By how much the facets of a part lean out over nothing, before it is cut."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.curves.guide import Guide
from ..geometry.obstacles import Body
from ..geometry.on_hub import Base
from ..types import Array
from .planes.stacking import facets

LEAST = 1e-9  # rad; what leans by less is a wall


class Leaning(NamedTuple):
    """Facets that lean out: corners (m, 3, 3) mm, by how much (m,) rad, the least first, and areas (m,) mm2. whole: mm2 of
    the part."""

    corners: Array
    lean: Array
    area: Array
    whole: float

    def beyond(self, angle: float) -> tuple[Array, float]:
        """Corners (k, 3, 3) of what leans out by more than an angle, rad, and its area, mm2."""
        first = int(np.searchsorted(self.lean, angle + LEAST, side="right"))
        return self.corners[first:], float(self.area[first:].sum())


def leaning(
    bodies: Sequence[Body], base: Base, standing: float, slit: float | None = None
) -> Leaning:
    """The facets of bodies that face against the way in which layers follow one another on a base, along a guide that there:
    0 is a wall, a right angle a ceiling. What lies no more than `standing` mm above the lowest place is carried by what the
    part stands on. slit: as of `stacking.facets`."""
    corners, normals, areas = facets(bodies, slit)
    inside = base.inside(corners)
    heights = np.asarray(base.surface.distance(inside))
    ways = base.frame[:3, 2]
    if isinstance(base.surface, Guide):
        middles = base.surface.distance(inside.mean(axis=1))
        ways = base.rotate_to_part(base.surface.at(middles)[1])
    lean = np.arcsin(np.clip(-(normals * ways).sum(axis=1), -1.0, 1.0))
    out = np.flatnonzero(
        (lean > LEAST) & (areas > 0.0) & (heights.max(axis=1) > heights.min() + standing)
    )
    order = out[np.argsort(lean[out], kind="stable")]
    return Leaning(corners[order], lean[order], areas[order], float(areas.sum()))
