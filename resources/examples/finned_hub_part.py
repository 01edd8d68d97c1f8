# SPDX-License-Identifier: LGPL-2.1-or-later
"""A hub with two fins and a branch: a tube of revolution, two solids that stand on it, and a thin wall that leaves it."""

from __future__ import annotations

from typing import Any

import step_files  # noqa: F401  (finds FreeCAD)
from FreeCAD import Vector

import Part  # isort: skip  (after FreeCAD, it crashes before)

RADIUS, THICK, HEIGHT = (
    36.0,
    6.0,
    80.0,
)  # mm, of the hub: outside, its wall, which is one bead, and along Z
FIN = Vector(18.0, 14.0, 36.0)  # mm, from the hub outwards, around it and along it
BRANCH, BRANCH_LENGTH = 14.0, 24.0  # mm, radius and how far it stands out
MIDDLE = 0.5 * HEIGHT


def finned_hub() -> Any:
    """Hub and fins as solids, the branch as a face, in one shape."""
    whole = Part.makeCylinder(RADIUS, HEIGHT)
    hub = whole.cut(Part.makeCylinder(RADIUS - THICK, HEIGHT))
    fins = []
    for side in (1.0, -1.0):
        box = Part.makeBox(
            RADIUS + FIN.x, FIN.y, FIN.z, Vector(0, -0.5 * FIN.y, MIDDLE - 0.5 * FIN.z)
        )
        if side < 0.0:
            box.rotate(Vector(), Vector(0, 0, 1), 180.0)
        fins.append(box.cut(whole).Solids[0])
    start = RADIUS - THICK
    branch = Part.makeCylinder(
        BRANCH, THICK + BRANCH_LENGTH, Vector(0, start, MIDDLE), Vector(0, 1, 0)
    ).Faces[0]
    return Part.makeCompound([hub.Solids[0], *fins, branch])
