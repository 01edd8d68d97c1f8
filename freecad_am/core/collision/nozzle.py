# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nozzle shape to check against bodies and deposit: while it deposits, and on rapids."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..types import Array, Index
from .frustum import Frustum, side_height
from .tolerances import ABOVE_FACES, CHORD, FACES, HALFWAY

LEAST_UPRIGHT = 0.25  # mm that the lower side of a nozzle at least rises with a mm along its axis, where it leans


@dataclass(frozen=True)
class Nozzle:
    """The same nozzle less what touches where it deposits, and less what bodies and beads are off their true places."""

    bodies: Frustum
    deposit: Frustum

    @property
    def reach(self) -> float:
        """Largest distance of a point of the nozzle from the tip, mm."""
        return max(self.bodies.reach, self.deposit.reach)

    @property
    def foot(self) -> float:
        """Diameter of the lower end to check against deposit, mm: around it is the current bead."""
        return float(np.max(2.0 * (self.deposit.radius + self.deposit.slope * self.deposit.low)))

    def rows(self, index: Index) -> Nozzle:
        """The nozzles of some of the rows, where they differ."""
        return Nozzle(self.bodies.rows(index), self.deposit.rows(index))

    def halfway(self) -> Nozzle:
        """The nozzle to check halfway between points where it is clear."""
        return self.larger(-HALFWAY)

    def larger(self, by: float) -> Nozzle:
        """The nozzle with its side and its upper end `by` mm farther out."""
        return Nozzle(
            *(
                replace(
                    solid,
                    radius=solid.radius + by * np.hypot(1.0, solid.slope),
                    high=solid.high + by,
                )
                for solid in (self.bodies, self.deposit)
            )
        )


def exempt_height(radius: float, slope: float, bead_height: float, lean: float = 0.0) -> float:
    """Height (mm) over the tip plane below which contact with deposit is exempt. lean: rad between tool
    axis and build direction.

    The tip is in the bead that it prints, and adjacent beads overlap that bead by intention: up to
    the bead's height they may be around the nozzle, also below the lower side of a leaning one. The
    minimum is the height at which the nozzle's side is one tip diameter from the tip.
    """
    upright = max(float(np.cos(lean) - slope * np.sin(lean)), LEAST_UPRIGHT)
    return max(side_height(radius, slope), (bead_height + radius * float(np.sin(lean))) / upright)


def depositing(
    radius: float, slope: float, length: float, bead_height: float, lean: float = 0.0
) -> Nozzle:
    """The nozzle while it deposits: radius of its tip and length mm, slope: tangent of its half angle,
    the height mm of the highest bead, and its intended lean, rad. Bodies are exempt only as far as
    the nozzle touches its support.
    """
    return Nozzle(
        Frustum(radius, slope, side_height(radius, slope) + ABOVE_FACES, length),
        Frustum(radius, slope, exempt_height(radius, slope, bead_height, lean), length),
    )


def travelling(radius: float, slope: float, length: float, exempt: float | Array = 0.0) -> Nozzle:
    """The nozzle on a rapid. exempt: mm over the tip that are exempt, one value or (k,), one for each
    position: on retract and approach `exempt_height` at the deposit point less the distance of the
    tip from it, at least 0.
    """
    return Nozzle(
        Frustum(max(radius - FACES, 0.0), slope, np.maximum(exempt, FACES), length),
        Frustum(max(radius - CHORD, 0.0), slope, np.maximum(exempt, CHORD), length),
    )
