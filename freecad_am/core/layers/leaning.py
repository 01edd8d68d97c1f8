# SPDX-License-Identifier: LGPL-2.1-or-later
"""Overhang of the facets of a part, before it is cut."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.curves.guide import Guide
from ..geometry.obstacles import Body
from ..geometry.on_hub import Base
from ..types import Array
from .planes.stacking import facets

MIN_LEAN_RAD = 1e-9  # rad; what leans by less is a wall


class Leaning(NamedTuple):
    """Overhanging facets: corners (m, 3, 3) mm, overhang (m,) rad, rising, and areas (m,) mm2.
    total_area: mm2 of the part.
    """

    corners: Array
    lean: Array
    area: Array
    total_area: float

    def steeper_than(self, angle: float) -> tuple[Array, float]:
        """Return the corners (k, 3, 3) of facets that overhang by more than an angle, rad, and their
        area, mm2.
        """
        first_steeper = int(np.searchsorted(self.lean, angle + MIN_LEAN_RAD, side="right"))
        return self.corners[first_steeper:], float(self.area[first_steeper:].sum())


def find_leaning(
    bodies: Sequence[Body], base: Base, standing: float, slit: float | None = None
) -> Leaning:
    """Return the facets of bodies that face against the stacking direction of layers on a base,
    or along a guide.

    The overhang of a wall is 0, of a ceiling a right angle. Facets at most `standing` mm
    above the lowest point are carried by the surface under the part. slit: as in
    `stacking.facets`.
    """
    corners, normals, areas = facets(bodies, slit)
    inside = base.inside(corners)
    heights = np.asarray(base.surface.distance(inside))
    directions = base.frame[:3, 2]
    if isinstance(base.surface, Guide):
        middles = base.surface.distance(inside.mean(axis=1))
        directions = base.rotate_to_part(base.surface.at(middles)[1])
    lean = np.arcsin(np.clip(-(normals * directions).sum(axis=1), -1.0, 1.0))
    out = np.flatnonzero(
        (lean > MIN_LEAN_RAD) & (areas > 0.0) & (heights.max(axis=1) > heights.min() + standing)
    )
    order = out[np.argsort(lean[out], kind="stable")]
    return Leaning(corners[order], lean[order], areas[order], float(areas.sum()))
