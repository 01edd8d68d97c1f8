# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers equally spaced along the wall (Chalvin 2020, section 2.1, variable height)."""

from __future__ import annotations

import numpy as np

from ..geometry.curves.profile import Meridian
from ..issues import InputError
from ..types import Array


def layers(meridian: Meridian, layer_height: float) -> tuple[list[Array], float]:
    """Return the arc lengths of the beads of each layer, the first at the base, and the length
    left over at the top, mm.

    A wall that is a whole number of layer heights long has its last layer on its end. The
    closing of a top on the axis adds none. Raises InputError 'LAYER_HEIGHT' if the layer
    height is larger than the wall is long.
    """
    if layer_height > meridian.length:
        raise InputError(
            "LAYER_HEIGHT",
            "strategy.layer_height",
            "{:g} mm exceeds the length of the wall ({:.4g} mm); use a smaller layer height",
            layer_height,
            meridian.length,
        )
    steps = int(np.floor(meridian.length / layer_height + 1e-6))
    s = np.minimum(np.arange(steps + 1) * layer_height, meridian.length)
    return [s[i : i + 1] for i in range(steps + 1)], max(
        0.0, meridian.length - steps * layer_height
    )
