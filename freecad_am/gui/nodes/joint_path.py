# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planned beads in the 3D view, coloured by the distance to the machine's limits, with a legend."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pivy import coin

from ...core.planning.joint_path import BeadPath
from ...core.types import Array
from ..path.colouring import UNREACHABLE, by_machine
from ..path.legend import Legend
from .lines import Lines, Points
from .wall import unpickable

_NOTHING = np.zeros((0, 3))


class JointPathNodes:
    """Draws beads as lines, initially nothing. Clicks pass through."""

    def __init__(self) -> None:
        self.lines, self.lost, self.legend = Lines(3.0), Points(7.0, UNREACHABLE), Legend()
        self.switch = coin.SoSwitch()
        for node in (unpickable(), self.lines.node, self.lost.node, self.legend.node):
            self.switch.addChild(node)
        self.switch.whichChild = coin.SO_SWITCH_ALL

    def clear(self) -> None:
        """Draw nothing."""
        self.lines.set(_NOTHING, [])
        self.lines.paint(_NOTHING)
        self.lost.set(_NOTHING)
        self.legend.hide()

    def set(self, paths: Sequence[BeadPath], values: Array, kind: str, unreachable: Array) -> None:
        """The beads of paths in colours of the values (n,) of their points, of one of the kinds that `by_machine` knows;
        dots where they are lost (n,)."""
        points = np.concatenate([path.bead.points for path in paths])
        colours, scale = by_machine(values, kind)
        self.lines.set(points, [len(path.bead) for path in paths])
        self.lines.paint(colours)
        self.lost.set(points[unreachable])
        self.legend.show(((), scale), 0)
