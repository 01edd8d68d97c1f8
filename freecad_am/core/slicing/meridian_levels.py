# SPDX-License-Identifier: LGPL-2.1-or-later
"""Levels of layers along a meridian, equally spaced along the wall or along the axis (Chalvin
2020, section 2.1)."""

from __future__ import annotations

import numpy as np

from ..geometry.curves.profile import Meridian
from ..issues import InputError
from ..types import Array


def arc_length_levels(meridian: Meridian, layer_height: float) -> tuple[list[Array], float]:
    """Return the arc lengths of the beads of each layer, equally spaced along the wall.

    A wall that is a whole number of layer heights long has its last layer on its end. The
    closing of a top on the axis adds none.

    Parameters
    ----------
    meridian : Meridian
        The meridian of the wall.
    layer_height : float
        Layer height along the wall, mm.

    Returns
    -------
    levels : list of (1,) array
        Arc length of the bead of each layer, the first at the base, mm.
    rest : float
        Length left over at the top, mm.

    Raises
    ------
    InputError
        LAYER_HEIGHT if the layer height is larger than the wall is long.

    References
    ----------
    Chalvin 2020, section 2.1.
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


# ---- Layers equally spaced along the axis (Chalvin 2020, section 2.1, Z-level planes)


def iso_height_levels(meridian: Meridian, layer_height: float) -> tuple[list[Array], float]:
    """Return the arc lengths of the beads of each layer, equally spaced along the axis.

    A plane that cuts the wall more than once gives as many beads, in the order of the wall from
    the platform up.

    Parameters
    ----------
    meridian : Meridian
        The meridian of the wall.
    layer_height : float
        Layer height along the axis, mm.

    Returns
    -------
    levels : list of array
        Arc lengths of the beads of each layer, from the lowest plane up, mm.
    rest : float
        Height left over at the top, mm.

    Raises
    ------
    InputError
        LAYER_HEIGHT if the layer height is larger than the wall is high.

    References
    ----------
    Chalvin 2020, section 2.1.
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
    """Return the distances of the beads of a layer from the layer below.

    Parameters
    ----------
    meridian : Meridian
        The meridian of the wall.
    below : (m,) array
        Arc lengths of the beads below, mm.
    layer : (k,) array
        Arc lengths of the beads of the layer, mm.

    Returns
    -------
    (k,) array
        Distance from the nearest bead below in the meridian's plane, mm.
    """
    r, h, _ = meridian.at(np.r_[below, layer])
    n = len(below)
    distances: Array = np.hypot(r[n:, None] - r[None, :n], h[n:, None] - h[None, :n]).min(axis=1)
    return distances
