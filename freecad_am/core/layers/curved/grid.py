# SPDX-License-Identifier: LGPL-2.1-or-later
"""How fine the grid is on which curved layers are looked for."""

from __future__ import annotations

import numpy as np

FINE, COARSE = 0.4, 0.8  # layer heights from node to node: as a rule, at most
MAX_NODES = 2_000_000  # nodes, where that keeps below COARSE


def step_of(volume: float, layer_height: float) -> float:
    """Mm from node to node for solids of a volume, mm3."""
    return max(FINE * layer_height, float(np.cbrt(volume / MAX_NODES)))
