# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links as they are looked at: solids of revolution about their cylinders, and balls about these."""

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
    """A solid of revolution that a link is, or a piece of it: tip and unit axis (3,) in the frame of the link, and the ball
    about it."""

    solid: Frustum
    tip: Array
    axis: Array
    centre: Array
    radius: float


def of_cylinder(cylinder: Cylinder, more: float) -> Solid:
    """A rod, larger by so many mm on all sides."""
    centre, axis = (
        0.5 * (cylinder.start + cylinder.end),
        (cylinder.end - cylinder.start) / cylinder.length,
    )
    solid = Frustum(cylinder.radius + more, 0.0, -more, cylinder.length + more)
    return Solid(
        solid,
        cylinder.start,
        axis,
        centre,
        float(np.hypot(0.5 * cylinder.length + more, cylinder.radius + more)),
    )


def about_link(link: Sequence[Solid]) -> tuple[Array, float]:
    """Centre and radius of a ball about the solids of a link."""
    if not link:
        return np.zeros(3), 0.0
    centre, _ = ball(np.array([one.centre for one in link]))
    return centre, max(float(np.linalg.norm(one.centre - centre)) + one.radius for one in link)


def ball(points: Array) -> tuple[Array, float]:
    """Centre and radius of a ball about points (n, 3)."""
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return centre, float(np.linalg.norm(points - centre, axis=1).max())
