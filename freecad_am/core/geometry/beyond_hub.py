# SPDX-License-Identifier: LGPL-2.1-or-later
"""Volume of a solid outside a cylinder or cone, without cutting the solid there.

By Gauss's theorem: a field along the normals of the equidistant surfaces, zero inside the
hub, has a flux out of the solid's surface equal to the volume of the solid outside. Where
rho is the distance from the axis and rho0 the distance of the foot on the hub, a layer
has rho / rho0 times its area on the hub; so (rho^2 - rho0^2) / (2 rho cos a) has the
divergence 1.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from ..types import Array, Integers
from .columns import dots
from .developable import Developable
from .mesh.facets import doubled_areas
from .mesh.solid import SolidMesh
from .obstacles import Body
from .on_hub import SolidsOnHub

PLACES = 10_000  # of the solid's surface, if its triangles were squares


def volume_beyond(surface: Developable, vertices: Array, triangles: Integers) -> float:
    """Return the volume, mm3, of a closed mesh (n, 3), (m, 3) outside a hub, in the hub's frame;
    accurate to about 1e-4.
    """
    corner = vertices[triangles]
    area = doubled_areas(corner) / 2.0
    longest = float(np.sqrt(np.linalg.norm(area, axis=1).sum() / PLACES))
    volume = 0.0
    while len(corner):  # halve until no side is longer
        side = np.linalg.norm(np.roll(corner, -1, axis=1) - corner, axis=2)
        top = np.argmax(side, axis=1)
        small = side[np.arange(len(top)), top] <= longest
        volume += float(dots(_field(surface, corner[small].mean(axis=1)), area[small]).sum())
        corner, area, top = corner[~small], area[~small], top[~small]
        a, b, c = (corner[np.arange(len(top)), (top + k) % 3] for k in range(3))
        middle = 0.5 * (a + b)
        corner = np.concatenate(
            [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        )
        area = np.concatenate([area, area]) / 2.0
    return max(volume, 0.0)


def solids_beyond(solids: SolidsOnHub) -> float | None:
    """Return the volume, mm3, of all solids outside their hubs; None if they may overlap."""
    volume = 0.0
    for group in solids.groups:
        surface = group.base.surface
        if isinstance(surface, Developable):  # overlapping solids are rejected earlier
            volume += sum(
                volume_beyond(surface, group.base.inside(body.vertices), body.triangles)
                for body in group.bodies
            )
        elif any(_may_meet(*pair) for pair in combinations(group.bodies, 2)):
            return None
        else:
            volume += sum(
                abs(SolidMesh(body.vertices, body.triangles).volume) for body in group.bodies
            )
    return volume


def _may_meet(body_a: Body, body_b: Body) -> bool:
    return bool(
        (
            (body_a.vertices.min(axis=0) < body_b.vertices.max(axis=0))
            & (body_b.vertices.min(axis=0) < body_a.vertices.max(axis=0))
        ).all()
    )


def _field(surface: Developable, points: Array) -> Array:
    """Return the field (n, 3) at points (n, 3)."""
    cos = np.cos(surface.taper)
    height = np.maximum(surface.distance(points), 0.0)
    rho = np.maximum(np.hypot(points[:, 0], points[:, 1]), 1e-300)
    foot = rho - height * cos
    field: Array = ((rho * rho - foot * foot) / (2.0 * rho * cos))[:, None] * surface.normals(
        points
    )
    return field
