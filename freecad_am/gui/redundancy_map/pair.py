# SPDX-License-Identifier: LGPL-2.1-or-later
"""Two external axes against each other at a point of a path, the rotation about the tool and other axes as planned there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from freecad_am.core.geometry.angles import TURN
from freecad_am.core.types import Array, Mask

from ...core.planning.redundancy import across as rotation_across
from ...core.planning.redundancy import map as redundancy_map
from ...core.planning.redundancy.map import Columns, Picture, RedundancyMap
from .source import Source

ROWS = 61  # values of the axis that goes upwards
LABELS = 6


@dataclass(frozen=True, eq=False)
class Pair:
    """cells: all pairs, row after row. values: (R,) rad or mm of the axis `up`, which is planned `here`. phi: the rotation
    that is planned, rad. count: of columns."""

    source: Source
    up: int
    cells: Columns
    values: Array
    here: float
    phi: float
    count: int

    def compute(self, branch: int, known: RedundancyMap | None) -> tuple[RedundancyMap, Picture]:
        """All branches, cells in one row, where they are not known yet, and the picture (R, C) of one."""
        task = self.source.task(branch)
        found = known or redundancy_map.redundancy_map(
            task,
            self.cells,
            redundancy_map.ROTATION,
            self.source.toolpath.surroundings,
            np.array([self.phi]),
        )
        return found, rotation_across.in_rows(
            redundancy_map.picture(task, found, branch), len(self.values)
        )

    def arm(self, branch: int, known: RedundancyMap) -> Mask:
        """(R, C) where links of the robot touch something."""
        source = self.source
        moment = source.starts[self.cells.bead] + self.cells.point
        found = redundancy_map.arm_touched(source.task(branch), known, branch, source.arm, moment)
        return found.reshape(len(self.values), self.count)

    def number(self, column: int, value: float) -> int:
        """Which of `cells` is at a column and a height of the map, which goes from -pi to pi."""
        row = round((value + np.pi) / TURN * (len(self.values) - 1))
        return int(np.clip(row, 0, len(self.values) - 1)) * self.count + column

    @property
    def name(self) -> str:
        """Of the axis that goes upwards."""
        return self.source.cell.machine.axes[self.source.cell.robot.chain.axes + self.up]

    @property
    def labels(self) -> list[tuple[float, str]]:
        """Heights and the values written beside them, deg or mm."""
        machine = self.source.cell.machine
        unit = float(machine.unit_values[self.source.cell.robot.chain.axes + self.up])
        sign = " mm" if machine.chain.sliding[self.source.cell.robot.chain.axes + self.up] else "°"
        shown = np.unique(np.round(np.linspace(0, len(self.values) - 1, LABELS)).astype(int))
        return [
            (float(TURN * k / (len(self.values) - 1) - np.pi), f"{self.values[k] / unit:.0f}{sign}")
            for k in shown
        ]

    @property
    def planned(self) -> float:
        """The height at which the axis is planned."""
        return float(
            np.interp(self.here, self.values, np.linspace(-np.pi, np.pi, len(self.values)))
        )


def pair_of(source: Source, at: tuple[int, int], axes: tuple[int, int], offsets: Array) -> Pair:
    """At a point (bead, point): values (C,) of the first of two external axes against those of the second over its range."""
    bead, point = at
    values = rotation_across.span(
        source.task(source.branch), source.beads[bead], point, axes[1], ROWS
    )
    cells = rotation_across.across_two_axes(source.beads, source.cell, at, axes, (offsets, values))
    here = float(redundancy_map.planned_external(source.beads[bead])[point, axes[1]])
    return Pair(
        source,
        axes[1],
        cells,
        values,
        here,
        float(source.planned.beads[bead].phi[point]),
        len(offsets),
    )
