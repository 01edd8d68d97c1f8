# SPDX-License-Identifier: LGPL-2.1-or-later
"""A layer that is a plane normal to a guide curve: nothing to unroll, and higher on one side than on the other where the
guide bends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.curves.guide import Guide
from ...types import Array
from ..planes.flat import Flat
from ..surface import Wrapped


@dataclass(frozen=True, eq=False)
class AlongLayer(Flat):
    """pose: (4, 4) of the plane in the frame of the field, Z along the guide. As `LayerSurface`; its height (mm) at a place
    (x, y) of the plane is height + slope . (x, y)."""

    pose: Array
    height: float
    slope: Array

    def unroll(self, points: Array) -> Array:
        """Return points on the plane, (n, 2) mm."""
        unrolled: Array = (points - self.pose[:3, 3]) @ self.pose[:3, :2]
        return unrolled

    def wrap(self, flat: Array) -> Wrapped:
        """Return every point at its position on the plane."""
        points = flat @ self.pose[:3, :2].T + self.pose[:3, 3]
        return Wrapped(points, np.tile(self.pose[:3, 2], (len(flat), 1)), np.zeros(len(flat)))

    def heights(self, flat: Array) -> Array:
        """Return the distance (n,) mm from this plane to the next at points (n, 2)."""
        heights: Array = self.height + flat @ self.slope
        return heights

    def for_sheet(self, flat: Array, sheet: float) -> AlongLayer:
        """Return the same plane."""
        return self

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """The x and y of the plane."""
        count = len(normals)
        return np.tile(self.pose[:3, 0], (count, 1)), np.tile(self.pose[:3, 1], (count, 1))


def between(guide: Guide, low: float, high: float, share: float = 0.5) -> AlongLayer:
    """Return the layer on the plane at `low` mm along a guide, up to the plane at `high`.

    Its height is measured where it is cut, a share of the distance up, along the normal
    there.
    """
    start, middle, top = (guide.frame(s) for s in (low, low + share * (high - low), high))
    height, slope = 0.0, np.zeros(2)
    for pose, sense in ((top, 1.0), (start, -1.0)):
        normal = pose[:3, 2]
        height += (
            sense * float((pose[:3, 3] - middle[:3, 3]) @ normal) / float(middle[:3, 2] @ normal)
        )
        slope -= sense * (normal @ middle[:3, :2]) / float(middle[:3, 2] @ normal)
    return AlongLayer(start, height, slope)
