# SPDX-License-Identifier: LGPL-2.1-or-later
"""How high beads of a motion end where their deposit has been predicted."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..types import Array, Index

LEAST = 1e-3  # mm; what ends below its path is drawn as lying on it


def heights(deposited: Array, position: Array, layer: Index) -> Array:
    """(n,) mm above points (n, 3) of layers (n,) at which the surface of a deposit is: that of the nearest piece of the same
    layer. laid: (m, 5) places of pieces, their layers, and mm of the surface above them. NaN in layers without pieces."""
    found = np.full(len(position), np.nan)
    of = deposited[:, 3].astype(np.intp)
    for number in np.unique(layer).tolist():
        some, mine = np.flatnonzero(of == number), np.flatnonzero(layer == number)
        if len(some):
            near = np.asarray(cKDTree(deposited[some, :3]).query(position[mine])[1])
            found[mine] = np.maximum(deposited[some[near], 4], LEAST)
    return found
