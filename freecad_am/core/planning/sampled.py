# SPDX-License-Identifier: LGPL-2.1-or-later
"""A toolpath that is planned at once: of many beads some, and of these some points."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..toolpath import Bead, Layer, Toolpath

PER_TURN = 16  # points of a turn that are kept, about
LEAST = 8  # segments of a bead that are kept where it has so many
TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Sampled:
    """Some beads and points of a toolpath. beads, points: of how many one is among them, 1 where all are."""

    toolpath: Toolpath
    beads: int
    points: int

    @property
    def whole(self) -> bool:
        """Whether it is all of the toolpath."""
        return self.beads == self.points == 1


def sampled(toolpath: Toolpath, most: int) -> Sampled:
    """About `most` points of a toolpath, all of it where it has no more. The first and last bead are among those that are
    kept, and the ends of each; layers keep their numbers, beads not. The chord error grows as that of the points does."""
    total = toolpath.point_count
    if total <= most:
        return Sampled(toolpath, 1, 1)
    turns = sum(abs(float(bead.parameter[-1] - bead.parameter[0])) for _, _, bead in toolpath) / TURN
    points = max(1, min(math.ceil(total / most), int(total / (PER_TURN * max(turns, 1.0)))))
    thin = [(layer, bead.thinned(_kept(bead, points))) for layer, _, bead in toolpath]
    beads = math.ceil(sum(len(bead) for _, bead in thin) / most)
    chosen = [*thin[:-1:beads], thin[-1]]
    layers = tuple(
        Layer(tuple(bead for place, bead in chosen if place == number), layer.wait, layer.first)
        for number, layer in enumerate(toolpath.layers)
    )
    return Sampled(replace(toolpath, layers=layers, chord_error=toolpath.chord_error * points**2), beads, points)


def _kept(bead: Bead, points: int) -> NDArray[np.intp]:
    """The numbers of the points of a bead that are kept: one of so many, more of a short one."""
    last = len(bead) - 1
    return np.unique(np.append(np.arange(0, last, max(1, min(points, last // LEAST))), last))
