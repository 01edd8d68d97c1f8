# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wall of revolution in the 3D view: its meridian at the start of the turn, its axis, and layers."""

from __future__ import annotations

import numpy as np
from pivy import coin

from ...core.geometry.curves.profile import RevolvedWall
from ...core.strategies.revolution.plan import Slices
from .lines import DASHED, Lines

COLOUR = (0.96, 0.47, 0.0)
MOST_LAYERS = 150  # that are drawn, evenly chosen
SIDES = 72  # of a whole turn
_NOTHING = np.zeros((0, 3))


class MeridianNodes:
    """Draws a wall, nothing at first."""

    def __init__(self) -> None:
        self.meridian, self.axis, self.layers = (
            Lines(3.0, COLOUR),
            Lines(2.0, COLOUR, DASHED),
            Lines(1.0, COLOUR),
        )
        self.switch = coin.SoSwitch()
        for lines in (self.meridian, self.axis, self.layers):
            self.switch.addChild(lines.node)
        self.show(True)

    def show(self, visible: bool) -> None:
        """Show or hide all of it."""
        self.switch.whichChild = coin.SO_SWITCH_ALL if visible else coin.SO_SWITCH_NONE

    def clear(self) -> None:
        """Draw nothing."""
        for lines in (self.meridian, self.axis, self.layers):
            lines.set(_NOTHING, [])

    def set_wall(self, wall: RevolvedWall) -> None:
        """Meridian and axis, which stands out at both ends."""
        radius, height = wall.meridian.points.T
        points = wall.points(radius, height, np.full(len(radius), wall.start))
        low, high = float(height.min()), float(height.max())
        over = 0.1 * max(high - low, float(radius.max()))
        ends = np.array([low - over, high + over])
        self.meridian.set(points, [len(points)])
        self.axis.set(wall.points(np.zeros(2), ends, np.zeros(2)), [2])

    def set_layers(self, wall: RevolvedWall, slices: Slices) -> None:
        """The beads of layers, or of some of many."""
        count = len(slices.layer)
        shown = np.unique(np.linspace(0, count - 1, min(count, MOST_LAYERS)).round().astype(int))
        angles = np.linspace(
            wall.start, wall.end, max(2, round(SIDES * (wall.end - wall.start) / (2.0 * np.pi)) + 1)
        )
        radius, height = (
            np.repeat(column[shown], len(angles)) for column in (slices.radius, slices.height)
        )
        self.layers.set(
            wall.points(radius, height, np.tile(angles, len(shown))), [len(angles)] * len(shown)
        )
