# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers whose local distance may vary within a band, so that they stay free of corners.

Fronts at an exactly constant distance gather into corners (errata of Chalvin 2019), at
which a robot has to stop. The deposit tolerates some variation of the layer height
(Chalvin 2020): here each layer is between the fronts at the minimum and maximum distance
allowed, and is as smooth as requested, or as the band allows. At the tip of a corner the
front runs ahead and on its flanks it holds back, so a corner of up to 2 acos((1 - band) /
(1 + band)) stays round.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from ...geometry.walls.surface import Surface, normals
from ...issues import InputError
from ...types import Array
from ..banded import AIM, HEAVY, MARGIN, WEIGHTS, lightest, smooth_between
from ..directions import wall_turn
from .offset import Offset
from .wall_layer import WallLayer, local_distances

FINER = 4  # places per arc at which the result is measured


class Smoothed(NamedTuple):
    """A layer, its minimum and maximum local distance (mm), its sharpest turn within the wall
    (rad/mm), and its weight number.
    """

    layer: WallLayer
    min_distance: float
    max_distance: float
    turn: float
    weight: int


def turns_in_wall(surface: Surface, layer: WallLayer) -> Array:
    """Turn of the bead within the wall per length, (m - 1,) rad/mm, see `wall_turn`."""
    return wall_turn.turns_in_wall(layer.curve, normals(surface, layer.u, layer.v))


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
    """Return the layer above `below`, as near to `height` mm as a turn within the wall of
    `limit` rad/mm allows.

    grid: (n,) evenly spaced values of v from seam to seam. band: largest departure of the
    local distance, as a share of the height. weight: start of the search, best the weight of
    the layer below. If the band is too narrow for the limit, the band holds: see
    Smoothed.turn. Raises InputError LAYER_HEIGHT if the wall has no point at such a distance.
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
    if best is None:  # a front that can only follow the one below, including its corners
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
    """Return all layers above the first up to the first one wholly past u_end."""
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
