# SPDX-License-Identifier: LGPL-2.1-or-later
"""A layer on a wall with a closed parameter: one value of u for each v, with its corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry.space_curve import SpaceCurve
from ..geometry.surface import Surface

Array = NDArray[np.float64]


@dataclass(frozen=True)
class WallLayer:
    """u (m,) at the nodes of the curve; the curve's parameter is v, and its last node repeats the first."""

    u: Array
    curve: SpaceCurve

    @classmethod
    def of(cls, surface: Surface, v: Array, u: Array, into: Array, out: Array) -> WallLayer:
        """The layer through (u, v), (m,), with the slopes du/dv (m,) on either side of each node."""
        points, along, around = surface.derivatives(u, v)
        return cls(u, SpaceCurve(v, points, around + into[:, None] * along, around + out[:, None] * along, True))

    @property
    def v(self) -> Array:
        """v (m,) at the nodes, rising through one period."""
        return self.curve.w


def even_grid(surface: Surface, count: int, start: float = 0.0) -> Array:
    """`count` + 1 equally spread values of v through one period."""
    if surface.period is None:
        raise ValueError("a wall that is open in v has no closed layers")
    return start + surface.period * np.linspace(0.0, 1.0, count + 1)


def local_distances(layer: WallLayer, below: WallLayer, finer: int = 1) -> tuple[Array, Array]:
    """v (n,) and distance (n,) mm from the layer to the nearest point of the one below.

    finer: places per arc of the layer; 1 is its nodes alone. d_ij of Chalvin 2019, equation 6 and figures 6 and 8.
    """
    v = layer.curve.refined(finer)
    return v, below.curve.nearest(layer.curve.at(v)[0])[0]
