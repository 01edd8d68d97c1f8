# SPDX-License-Identifier: LGPL-2.1-or-later
"""Other retracts, tried in turn if the requested one meets an obstacle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.obstacles import Body
from ...kinematics.cell import Cell
from ...toolpath import Bead
from .retract_ways import DIRECTIONS
from .retracts import STRAY_MM

# how many times the retract distance is tried where the nozzle would meet something, and further, beyond everything there is
RETRACT_FACTORS = (1.5, 2.0, 3.0, 4.0, 6.0, 8.0)
EXTENSION_FACTOR = 1.5
# of a retract distance of nothing, mm
FIRST_RETRACT = 2.0
# how near to the straight line a retract is held that meets something on its way, mm
FINE_MM = 0.02
# retract distances in directions other than the tool axis, as shares of the one asked for
SIDE_SHARES = (1.0, 4.0)


@dataclass(frozen=True)
class Attempt:
    """Height (mm) and direction of a retract, and how near (mm) it is held to the line."""

    height: float
    direction: int = 0
    tolerance: float = STRAY_MM


def attempts(
    cell: Cell, retract: float, beads: Sequence[Bead], bodies: Sequence[Body]
) -> list[Attempt]:
    """Return the retracts to try after the requested one, up to where the nozzle is beyond the sphere
    about all obstacles.
    """
    radius = 0.5 * cell.platform_diameter
    x, y, origin = cell.mount[:3, 0], cell.mount[:3, 1], cell.mount[:3, 3]
    platform = [origin + radius * (a * x + b * y) for a in (-1.0, 1.0) for b in (-1.0, 1.0)]
    all_ = (*bodies, *cell.in_part())
    points = np.vstack(
        [*(bead.points for bead in beads), platform, *(body.vertices for body in all_)]
    )
    # from anywhere inside, a way of the diameter along any direction leads out of it
    furthest = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
    base = retract or FIRST_RETRACT
    heights = [*([] if retract else [base]), *(factor * base for factor in RETRACT_FACTORS)]
    while heights[-1] < furthest:
        heights.append(min(EXTENSION_FACTOR * heights[-1], furthest))
    return [
        *([Attempt(retract, 0, FINE_MM)] if retract else []),
        *(Attempt(height) for height in heights),
        *(Attempt(share * base, direction) for direction in DIRECTIONS for share in SIDE_SHARES),
    ]
