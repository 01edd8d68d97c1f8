# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves to deposit as beads without slicing, with the tool direction of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...issues import Issue
from ...types import Array
from ..obstacles import Body

# endings of files whose curves become beads, and their descriptions
POINT_FILES = {
    ".csv": "csv",
    ".gcode": "gcode",
    ".gco": "gcode",
    ".g": "gcode",
    ".ada3dp": "ada3dp",
}
MEETING = 1e-6  # mm between the ends of a closed curve


@dataclass(frozen=True, eq=False)
class BeadCurve:
    """A curve deposited as one bead.

    points: (n, 3) mm; a closed curve repeats its first point as the last. directions: (n, 3)
    unit vectors from the deposit towards the tool; None if the source has no directions.
    layer: number of its layer, from 0.
    """

    points: Array
    directions: Array | None = None
    layer: int = 0

    @property
    def closed(self) -> bool:
        """Whether it ends where it begins."""
        return (
            len(self.points) > 3
            and float(np.linalg.norm(self.points[-1] - self.points[0])) < MEETING
        )


@dataclass(frozen=True, eq=False)
class Curves:
    """Curves to deposit, in this order.

    surroundings: substrate and fixtures, as bodies. depths: None, a part of curves has no
    volume. edges: names of the chosen edges of a shape, empty if all are used; None for
    curves that do not come from a shape.
    """

    label: str
    curves: tuple[BeadCurve, ...]
    surroundings: tuple[Body, ...] = ()
    issues: tuple[Issue, ...] = ()
    depths: None = None
    edges: tuple[str, ...] | None = None


class ReadCurves(NamedTuple):
    """Beads of a file, and issues about its content that does not become beads."""

    curves: tuple[BeadCurve, ...]
    issues: tuple[Issue, ...] = ()
