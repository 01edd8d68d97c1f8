# SPDX-License-Identifier: LGPL-2.1-or-later
"""The section of a part that a plane layer fills, and its coverage by beads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..types import Array


@dataclass(frozen=True, eq=False)
class Section:
    """The section of a part that a plane layer fills.

    frame: (4, 4) pose of the plane in part coordinates. loops: closed curves (n, 2) mm on the
    plane, first points not repeated, material to the left. spacing: mm between adjacent beads.
    is_sparse: beads leave the section open by design. narrowest: minimum bead width as a fraction
    of the nominal width; parts of the section narrower than this do not count as missing.
    """

    frame: Array
    loops: tuple[Array, ...]
    spacing: float
    is_sparse: bool = False
    narrowest: float = 1.0

    @property
    def edges(self) -> Array:
        """Return the edges of all loops.

        Returns
        -------
        Array
            (k, 2, 2) start and end of each edge on the plane, mm. The last edge of a loop ends at
            the first point.
        """
        return np.concatenate(
            [np.zeros((0, 2, 2))]
            + [np.stack([loop, np.roll(loop, -1, axis=0)], axis=1) for loop in self.loops]
        )

    def flat(self, points: Array) -> Array:
        """Project points (n, 3) of the part onto the section plane, (n, 2) mm."""
        return np.asarray((points - self.frame[:3, 3]) @ self.frame[:3, :2])

    def to_part(self, points: Array) -> Array:
        """Return points (n, 2) of the section plane in part coordinates, (n, 3) mm."""
        return np.asarray(points @ self.frame[:3, :2].T + self.frame[:3, 3])


@dataclass(frozen=True, eq=False)
class Coverage:
    """Coverage of a layer's section by beads of effective width.

    void, over, outside: area fractions of the section that the narrowest bead can reach. void: area
    without a bead, NaN if beads leave the section open by design. over: area deposited more than
    once. outside: bead area beyond the border. void_place, over_place: centre (3,) mm of the
    largest circle in a void or in double deposit; None without a search or a circle. void_size,
    over_size: diameter of this circle, mm.
    """

    void: float
    over: float
    outside: float
    void_place: Array | None = None
    void_size: float = 0.0
    over_place: Array | None = None
    over_size: float = 0.0
