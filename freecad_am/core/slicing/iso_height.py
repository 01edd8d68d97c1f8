# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers equally spaced along the axis (Chalvin 2020, section 2.1, Z-level planes)."""

from __future__ import annotations

import numpy as np

from ..geometry.curves.profile import Meridian
from ..issues import InputError
from ..types import Array


def layers(meridian: Meridian, layer_height: float) -> tuple[list[Array], float]:
    """Arc lengths of the beads of each layer, from the lowest plane up, and the height left at the top. mm.

    A plane that cuts the wall more than once gives as many beads, in the order of the wall from the platform up.
    Raises InputError 'LAYER_HEIGHT' when the layer height is larger than the wall is high.
    """
    low, high = float(meridian.points[:, 1].min()), float(meridian.points[:, 1].max())
    if layer_height > high - low:
        raise InputError(
            "LAYER_HEIGHT",
            "strategy.layer_height",
            "{:g} mm exceeds the height of the wall ({:.4g} mm); use a smaller layer height, or "
            "layers along the wall (spacing: arc-length)",
            layer_height,
            high - low,
        )
    steps = int(np.floor((high - low) / layer_height + 1e-6))
    heights = np.minimum(low + np.arange(steps + 1) * layer_height, high)
    return meridian.s_at_height(heights), max(0.0, high - low - steps * layer_height)


def spacing(meridian: Meridian, below: Array, layer: Array) -> Array:
    """Return the distance (k,) mm in the meridian's plane of each bead of a layer from the
    nearest bead below.
    """
    r, h, _ = meridian.at(np.r_[below, layer])
    n = len(below)
    distances: Array = np.hypot(r[n:, None] - r[None, :n], h[n:, None] - h[None, :n]).min(axis=1)
    return distances
