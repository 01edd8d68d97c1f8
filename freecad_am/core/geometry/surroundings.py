# SPDX-License-Identifier: LGPL-2.1-or-later
"""What stands around a wall while it is deposited: the part it grows on, fixtures, as triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Body:
    """A solid or mesh that the nozzle must not touch, in part coordinates.

    name: what messages call it. vertices: (n, 3) mm. triangles: (m, 3) whole numbers, the vertices of each.
    """

    name: str
    vertices: Array
    triangles: NDArray[np.int64]

    def corners(self) -> Array:
        """(m, 3, 3) the three corners of each triangle."""
        corners: Array = self.vertices[self.triangles]
        return corners
