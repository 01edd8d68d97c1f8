# SPDX-License-Identifier: LGPL-2.1-or-later
"""A layer that is a plane: nothing to unroll."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...types import Array
from ..surface import Wrapped
from .flat import Flat


@dataclass(frozen=True)
class PlaneLayer(Flat):
    """The plane at a height (mm) along the Z of its frame, with the x and y of the frame. As
    `LayerSurface`.
    """

    height: float

    def unroll(self, points: Array) -> Array:
        """(n, 2) mm."""
        return points[:, :2].copy()

    def wrap(self, flat: Array) -> Wrapped:
        """Every point as it is, at the height."""
        count = len(flat)
        points = np.column_stack([flat, np.full(count, self.height)])
        return Wrapped(points, np.tile([0.0, 0.0, 1.0], (count, 1)), np.zeros(count))

    def heights(self, flat: Array) -> None:
        """The layer height everywhere."""

    def for_sheet(self, flat: Array, sheet: float) -> PlaneLayer:
        """Return the same plane."""
        return self

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """The x and y of the plane."""
        count = len(normals)
        return np.tile([1.0, 0.0, 0.0], (count, 1)), np.tile([0.0, 1.0, 0.0], (count, 1))
