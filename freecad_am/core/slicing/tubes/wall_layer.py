# SPDX-License-Identifier: LGPL-2.1-or-later
"""A layer on a wall with a closed parameter: one value of u for each v, with its corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.walls.surface import Surface, dot
from ...types import Array


@dataclass(frozen=True, eq=False)
class WallLayer:
    """u (m,) at the nodes of the curve; the curve's parameter is v, and its last node repeats the first."""

    u: Array
    curve: SpaceCurve

    @classmethod
    def of(cls, surface: Surface, v: Array, u: Array, into: Array, out: Array) -> WallLayer:
        """The layer through (u, v), (m,), with the slopes du/dv (m,) on either side of each node."""
        points, along, around = surface.derivatives(u, v)
        return cls(
            u,
            SpaceCurve(
                v, points, around + into[:, None] * along, around + out[:, None] * along, True
            ),
        )

    @property
    def v(self) -> Array:
        """v (m,) at the nodes, rising through one period."""
        return self.curve.w

    def slopes(self, surface: Surface) -> tuple[Array, Array]:
        """du/dv (m,) on either side of each node."""
        _, along, around = surface.derivatives(self.u, self.v)
        rate = dot(along, along)
        return dot(self.curve.into - around, along) / rate, dot(
            self.curve.out - around, along
        ) / rate

    def heights(self, surface: Surface, v: Array) -> tuple[Array, Array, Array]:
        """u (n,) and its slopes du/dv on either side at v (n,) from the first node to the last."""
        into, out = self.slopes(surface)
        arc = np.clip(np.searchsorted(self.v, v, side="right") - 1, 0, len(self.v) - 2)
        span = np.diff(self.v)[arc]
        t = (v - self.v[arc]) / span
        rise = self.u[arc + 1] - self.u[arc]
        a, b = out[arc] * span, into[arc + 1] * span
        u = self.u[arc] + t * (a + t * (3.0 * rise - 2.0 * a - b + t * (a + b - 2.0 * rise)))
        slope = (a + t * (2.0 * (3.0 * rise - 2.0 * a - b) + 3.0 * t * (a + b - 2.0 * rise))) / span
        node = np.clip(np.searchsorted(self.v, v), 0, len(self.v) - 1)
        same = self.v[node] == v
        return u, np.where(same, into[node], slope), np.where(same, out[node], slope)


def even_grid(surface: Surface, count: int, start: float = 0.0) -> Array:
    """`count` + 1 equally spread values of v through one period."""
    if surface.period is None:
        raise ValueError("a wall that is open in v has no closed layers")
    return start + surface.period * np.linspace(0.0, 1.0, count + 1)


def local_distances(layer: WallLayer, below: WallLayer, finer: int = 1) -> tuple[Array, Array]:
    """Return v (n,) and the distance (n,) mm of the layer from the nearest point of the one
    below.

    finer: points per arc of the layer; 1 uses only its nodes. d_ij of Chalvin 2019, equation
    6 and figures 6 and 8.
    """
    v = layer.curve.refined(finer)
    return v, below.curve.nearest(layer.curve.at(v)[0])[0]
