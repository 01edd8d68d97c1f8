# SPDX-License-Identifier: LGPL-2.1-or-later
"""The section of a part that a plane layer fills, and how well its beads do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..types import Array


@dataclass(frozen=True, eq=False)
class Section:
    """The section of a part that a plane layer fills.

    frame: (4, 4) pose of its plane in part coordinates. loops: closed curves (n, 2) mm on it, first points not repeated,
    material to the left. spacing: mm between neighbouring beads. is_sparse: beads leave it open on purpose. narrowest: share of
    the nominal bead width that the narrowest bead has; nothing is missing where the section is narrower still.
    """

    frame: Array
    loops: tuple[Array, ...]
    spacing: float
    is_sparse: bool = False
    narrowest: float = 1.0

    @property
    def edges(self) -> Array:
        """The edges of all loops.

        Returns
        -------
        Array
            (k, 2, 2) mm on the plane: start and end of each edge. The last edge of a loop ends at its first point.
        """
        return np.concatenate(
            [np.zeros((0, 2, 2))]
            + [np.stack([loop, np.roll(loop, -1, axis=0)], axis=1) for loop in self.loops]
        )

    def flat(self, points: Array) -> Array:
        """Points (n, 3) of the part on its plane, (n, 2) mm."""
        return np.asarray((points - self.frame[:3, 3]) @ self.frame[:3, :2])

    def to_part(self, points: Array) -> Array:
        """Points (n, 2) of its plane in part coordinates, (n, 3)."""
        return np.asarray(points @ self.frame[:3, :2].T + self.frame[:3, 3])


@dataclass(frozen=True, eq=False)
class Coverage:
    """How well the beads of a layer fill its section.

    Shares of the part of the section that the narrowest bead can reach, all with effective widths: void: without a
    bead, NaN where beads leave the section open on purpose; over: deposited more than once; outside: beads beyond the border.
    void_place, over_place: middle (3,) mm of the largest circle in void or double deposit, and void_size, over_size: its
    diameter, mm; None where it was not searched for or there is none.
    """

    void: float
    over: float
    outside: float
    void_place: Array | None = None
    void_size: float = 0.0
    over_place: Array | None = None
    over_size: float = 0.0
