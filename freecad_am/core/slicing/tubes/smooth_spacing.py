# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers whose local distance may vary within a band, so that they have no corners.

Fronts at an exactly constant distance develop corners (errata of Chalvin 2019), at which a robot
has to stop. The deposit tolerates some variation of the layer height (Chalvin 2020). Each layer
therefore stays between the fronts at the minimum and maximum distance and is smoothed until it
meets the limit of the turn rate, or as far as the band allows. The front runs ahead at the tip of a
corner and lags behind on the flanks. Thus corners of up to 2 acos((1 - band) / (1 + band)) stay
round.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.walls.surface import Surface, dot, normals
from ...issues import InputError
from ...types import Array
from .. import wall_directions
from ..smoothest_heights import AIM, HEAVY, MARGIN, WEIGHTS, lightest, smooth_between
from .offset import Offset


@dataclass(frozen=True, eq=False)
class WallLayer:
    """Closed layer on a wall.

    u: (m,) at the nodes of the curve. curve: curve with parameter v; the last node repeats the
    first.
    """

    u: Array
    curve: SpaceCurve

    @classmethod
    def of(cls, surface: Surface, v: Array, u: Array, into: Array, out: Array) -> WallLayer:
        """Build the layer through points of the wall.

        Parameters
        ----------
        surface : Surface
            The wall.
        v, u : (m,) array
            Parameters of the nodes; v rises through one period.
        into, out : (m,) array
            Slopes du/dv before and after each node.

        Returns
        -------
        WallLayer
            The layer.
        """
        points, along, around = surface.derivatives(u, v)
        return cls(
            u,
            SpaceCurve(
                v, points, around + into[:, None] * along, around + out[:, None] * along, True
            ),
        )

    @property
    def v(self) -> Array:
        """Return v at the nodes.

        Returns
        -------
        (m,) array
            Ascending values over one period.
        """
        return self.curve.w

    def slopes(self, surface: Surface) -> tuple[Array, Array]:
        """Return the slopes before and after each node.

        Parameters
        ----------
        surface : Surface
            The wall.

        Returns
        -------
        into, out : (m,) array
            du/dv before and after each node.
        """
        _, along, around = surface.derivatives(self.u, self.v)
        rate = dot(along, along)
        return dot(self.curve.into - around, along) / rate, dot(
            self.curve.out - around, along
        ) / rate

    def heights(self, surface: Surface, v: Array) -> tuple[Array, Array, Array]:
        """Evaluate the layer between its nodes.

        Parameters
        ----------
        surface : Surface
            The wall.
        v : (n,) array
            Parameters from the first node to the last.

        Returns
        -------
        u : (n,) array
            Heights.
        into, out : (n,) array
            Slopes du/dv before and after each point.
        """
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
    """Return equally spaced values of v over one period.

    Parameters
    ----------
    surface : Surface
        The wall.
    count : int
        Number of intervals.
    start : float, optional
        First value.

    Returns
    -------
    (count + 1,) array
        Ascending values.

    Raises
    ------
    ValueError
        If the wall is open in v.
    """
    if surface.period is None:
        raise ValueError("a wall that is open in v has no closed layers")
    return start + surface.period * np.linspace(0.0, 1.0, count + 1)


def local_distances(layer: WallLayer, below: WallLayer, finer: int = 1) -> tuple[Array, Array]:
    """Return the distances of a layer from the nearest points of the layer below.

    Parameters
    ----------
    layer : WallLayer
        The layer.
    below : WallLayer
        The layer below.
    finer : int, optional
        Points per arc of the layer; 1: nodes only.

    Returns
    -------
    v : (n,) array
        Parameters of the points.
    distance : (n,) array
        Distances, mm.

    References
    ----------
    Chalvin 2019, equation 6 and figures 6 and 8 (d_ij).
    """
    v = layer.curve.refined(finer)
    return v, below.curve.nearest(layer.curve.at(v)[0])[0]


FINER = 4  # points per arc at which the result is measured


class Smoothed(NamedTuple):
    """Smoothed layer.

    min_distance, max_distance: local distance from the layer below, mm. turn: maximum turn rate
    within the wall, rad/mm. weight: index of WEIGHTS.
    """

    layer: WallLayer
    min_distance: float
    max_distance: float
    turn: float
    weight: int


def turns_in_wall(surface: Surface, layer: WallLayer) -> Array:
    """Return the turn rate of a bead within the wall.

    Parameters
    ----------
    surface : Surface
        The wall.
    layer : WallLayer
        The bead, m nodes.

    Returns
    -------
    (m - 1,) array
        Turn rate of each arc, rad/mm.
    """
    return wall_directions.turns_in_wall(layer.curve, normals(surface, layer.u, layer.v))


def next_layer(
    surface: Surface,
    below: WallLayer,
    height: float,
    grid: Array,
    band: float,
    limit: float,
    label: str = "wall",
    weight: int = HEAVY,
) -> Smoothed:
    """Compute the next smooth layer, as close to the layer height as the turn rate limit allows.

    If the band is too narrow for the limit, the layer keeps the band and exceeds the limit, see
    `Smoothed.turn`.

    Parameters
    ----------
    surface : Surface
        The wall.
    below : WallLayer
        The layer below.
    height : float
        Layer height, mm.
    grid : (n,) array
        Evenly spaced values of v from seam to seam.
    band : float
        Maximum deviation of the local distance, as a fraction of the layer height.
    limit : float
        Maximum turn rate within the wall, rad/mm.
    label : str, optional
        Name of the wall, for messages.
    weight : int, optional
        Index of WEIGHTS at which the search starts, preferably that of the layer below.

    Returns
    -------
    Smoothed
        The layer with its local distances and turn rate.

    Raises
    ------
    InputError
        LAYER_HEIGHT if the wall has no point at the layer height or a limit of the band. BAND if no
        layer fits the band.
    """
    fronts = []
    for share in (1.0, 1.0 - band * (1.0 - MARGIN), 1.0 + band * (1.0 - MARGIN)):
        positions = Offset(surface, below.curve, below.u, share * height).evaluate(grid[:-1])
        if (positions.run < 0).any():
            raise InputError(
                "LAYER_HEIGHT",
                label,
                "the wall has no point at {:g} mm from the layer below: use a smaller layer "
                "height or a narrower band",
                share * height,
            )
        fronts.append(positions.u)
    target, low, high = fronts

    def trial(index: int) -> Smoothed | None:
        candidate = _measured(
            surface, below, grid, smooth_between(target, low, high, float(WEIGHTS[index])), index
        )
        inside = (
            candidate.min_distance >= (1.0 - band) * height
            and candidate.max_distance <= (1.0 + band) * height
        )
        return candidate if inside else None

    best = lightest(trial, weight, AIM * limit)
    if best is None:  # the band only admits fronts that repeat the corners of the layer below
        raise InputError(
            "BAND",
            label,
            "a band of {:g} % is too narrow for {} points around: use more points",
            100.0 * band,
            len(grid) - 1,
        )
    return best


def layers(
    surface: Surface,
    first_layer: WallLayer,
    height: float,
    u_end: float,
    band: float = 0.2,
    limit: float = 0.1,
    points: int = 360,
    label: str = "wall",
) -> list[Smoothed]:
    """Compute all smooth layers above the first layer, up to the first completely beyond the end.

    Parameters
    ----------
    surface : Surface
        The wall.
    first_layer : WallLayer
        The first layer.
    height : float
        Layer height, mm.
    u_end : float
        End of the wall in u.
    band : float, optional
        Maximum deviation of the local distance, as a fraction of the layer height.
    limit : float, optional
        Maximum turn rate within the wall, rad/mm.
    points : int, optional
        Number of points of a layer.
    label : str, optional
        Name of the wall, for messages.

    Returns
    -------
    list of Smoothed
        The layers, without `first_layer`.
    """
    grid = first_layer.v[0] + (first_layer.v[-1] - first_layer.v[0]) * np.linspace(
        0.0, 1.0, points + 1
    )
    smoothed_layers: list[Smoothed] = []
    below = first_layer
    while below.u.min() < u_end:
        weight = smoothed_layers[-1].weight if smoothed_layers else HEAVY
        smoothed_layers.append(next_layer(surface, below, height, grid, band, limit, label, weight))
        below = smoothed_layers[-1].layer
    return smoothed_layers


def _measured(surface: Surface, below: WallLayer, grid: Array, u: Array, weight: int) -> Smoothed:
    closed = np.r_[u, u[0]]
    slope = CubicSpline(grid, closed, bc_type="periodic")(grid, 1)
    layer = WallLayer.of(surface, grid, closed, slope, slope)
    distance = local_distances(layer, below, FINER)[1]
    turn = float(turns_in_wall(surface, layer).max())
    return Smoothed(layer, float(distance.min()), float(distance.max()), turn, weight)
