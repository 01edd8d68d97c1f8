# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a deposit touches its named substrate."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...core.geometry.mesh.solid import SolidMesh
from ...core.geometry.obstacles import Body
from ...core.issues import WARNING, Issue, Text
from ...core.strategies.support import ABOVE_SUBSTRATE
from ...core.types import Array
from ..shapes.bodies import Taken

REACH = (
    1.5  # layer heights; a deposit this near to a body counts as supported by it, as in `support`
)


def gap_issues(
    label: str,
    deposited: Sequence[Body],
    points: Sequence[Array],
    ground: Sequence[Taken],
    layer_height: float,
) -> tuple[Issue, ...]:
    """A warning where nothing of bodies, or of points (n, 3) of curves, is near the substrate that is named, with how far it
    is and where it comes nearest."""
    issues = []
    for substrate in ground:
        under = substrate.body()
        deposit_points = np.vstack([*(body.vertices for body in deposited), *points])
        distance = (
            SolidMesh(under.vertices, under.triangles)
            .searched(layer_height)
            .signed(deposit_points)[0]
        )
        nearest = int(distance.argmin())
        gap, position = float(distance[nearest]), deposit_points[nearest]
        for body in deposited if gap > REACH * layer_height else ():
            search = SolidMesh(body.vertices, body.triangles).searched(layer_height)
            back = search.signed(under.vertices)[0]
            if float(back.min()) < gap:
                gap, position = float(back.min()), under.vertices[int(back.argmin())]
        if gap > REACH * layer_height:
            x, y, z = (float(value) for value in position)
            issues.append(
                Issue(
                    WARNING,
                    ABOVE_SUBSTRATE,
                    Text(
                        "{} does not touch its substrate {}: the smallest gap is {:.4g} mm, at "
                        "({:.4g}, {:.4g}, {:.4g}); move it onto the substrate, or remove the "
                        "substrate",
                        label,
                        substrate.label,
                        gap,
                        x,
                        y,
                        z,
                    ),
                )
            )
    return tuple(issues)
