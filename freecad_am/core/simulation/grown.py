# SPDX-License-Identifier: LGPL-2.1-or-later
"""How high beads of a motion end where their deposit has been predicted."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..types import Array, Index

MIN_HEIGHT_MM = 1e-3  # mm; what ends below its path is drawn as lying on it


def heights(deposited: Array, position: Array, layer: Index) -> Array:
    """(n,) mm above points (n, 3) of layers (n,) at which the surface of a deposit is: that of the nearest piece of the same
    layer. laid: (m, 5) places of pieces, their layers, and mm of the surface above them. NaN in layers without pieces."""
    surface_heights = np.full(len(position), np.nan)
    piece_layers = deposited[:, 3].astype(np.intp)
    for number in np.unique(layer).tolist():
        piece_rows, point_rows = (
            np.flatnonzero(piece_layers == number),
            np.flatnonzero(layer == number),
        )
        if len(piece_rows):
            nearest = np.asarray(cKDTree(deposited[piece_rows, :3]).query(position[point_rows])[1])
            surface_heights[point_rows] = np.maximum(
                deposited[piece_rows[nearest], 4], MIN_HEIGHT_MM
            )
    return surface_heights
