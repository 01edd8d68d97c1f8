# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves that are to be beads as they are, with the direction in which each is laid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...issues import Issue
from ...types import Array
from ..obstacles import Body

# endings of files that are laid as beads, and what they are
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
    """points: (n, 3) mm, of a closed one the first again as the last. directions: (n, 3) unit vectors from the deposit
    towards the tool; None where nothing of the curve says so. layer: in which it is laid, counted from 0."""

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
    """What is laid, in this order. surroundings: substrate and fixtures, as bodies. depths: None, a part has no volume.
    edges: names of those of a shape that were chosen, none where all of them are; None of what is not a shape's."""

    label: str
    curves: tuple[BeadCurve, ...]
    surroundings: tuple[Body, ...] = ()
    issues: tuple[Issue, ...] = ()
    depths: None = None
    edges: tuple[str, ...] | None = None


class ReadCurves(NamedTuple):
    """Beads of a file, and findings about what of it is no bead."""

    curves: tuple[BeadCurve, ...]
    issues: tuple[Issue, ...] = ()
