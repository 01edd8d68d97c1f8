# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links as tested: solids of revolution around their cylinders, and balls around these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...collision.frustum import Frustum
from ...geometry.cylinders import Cylinder
from ...types import Array

NONE = -1  # no link


@dataclass(frozen=True, eq=False)
class Solid:
    """A solid of revolution, a link or a piece of one: tip and unit axis (3,) in the frame of
    the link, and the ball around it.
    """

    solid: Frustum
    tip: Array
    axis: Array
    centre: Array
    radius: float


def round_solid(cylinder: Cylinder, growth: float) -> Solid:
    """Return a cylinder enlarged by `growth` mm on all sides."""
    centre, axis = (
        0.5 * (cylinder.start + cylinder.end),
        (cylinder.end - cylinder.start) / cylinder.length,
    )
    solid = Frustum(cylinder.radius + growth, 0.0, -growth, cylinder.length + growth)
    return Solid(
        solid,
        cylinder.start,
        axis,
        centre,
        float(np.hypot(0.5 * cylinder.length + growth, cylinder.radius + growth)),
    )


def about_link(link: Sequence[Solid]) -> tuple[Array, float]:
    """Return centre and radius of a ball around the solids of a link."""
    if not link:
        return np.zeros(3), 0.0
    centre, _ = ball(np.array([solid.centre for solid in link]))
    return centre, max(
        float(np.linalg.norm(solid.centre - centre)) + solid.radius for solid in link
    )


def ball(points: Array) -> tuple[Array, float]:
    """Centre and radius of a ball about points (n, 3)."""
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return centre, float(np.linalg.norm(points - centre, axis=1).max())
