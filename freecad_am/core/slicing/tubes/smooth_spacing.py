# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers whose local distance may vary within a band, so that they stay free of corners.

Fronts at an exactly constant distance gather into corners (errata of Chalvin 2019), at which a robot has to stop. The
deposit tolerates some variation of the layer's height (Chalvin 2020): here each layer lies between the fronts at the least
and the greatest distance allowed, and is as smooth as asked, or as the band allows. At the tip of a corner the front
runs ahead and on its flanks it holds back, so that a corner of up to 2 acos((1 - band) / (1 + band)) stays round.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from ...geometry.walls.surface import Surface, normals
from ...issues import InputError
from ...types import Array
from ..banded import AIM, HEAVY, MARGIN, WEIGHTS, between, lightest
from ..directions import wall_turn
from .offset import Offset
from .wall_layer import WallLayer, local_distances

FINER = 4  # places per arc at which the result is measured


class Smoothed(NamedTuple):
    """A layer, the least and greatest local distance (mm), its sharpest turn within the wall (rad/mm), and which of the
    weights it was made with."""

    layer: WallLayer
    least: float
    most: float
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
    """The layer above `below`, as near to `height` mm as a turn within the wall of `limit` rad/mm allows.

    grid: (n,) equally spread values of v from seam to seam. band: largest departure of the local distance, as a share of
    the height. weight: where the search begins, best that of the layer below. Where the band is too narrow for the
    limit, the band holds: see Smoothed.turn. InputError LAYER_HEIGHT where the wall has no point at such a distance.
    """
    fronts = []
    for share in (1.0, 1.0 - band * (1.0 - MARGIN), 1.0 + band * (1.0 - MARGIN)):
        places = Offset(surface, below.curve, below.u, share * height).at(grid[:-1])
        if (places.run < 0).any():
            raise InputError(
                "LAYER_HEIGHT",
                label,
                "the wall has no point at {:g} mm from the layer below: use a smaller layer height "
                "or a narrower band",
                share * height,
            )
        fronts.append(places.u)
    wanted, low, high = fronts

    def trial(index: int) -> Smoothed | None:
        found = _measured(
            surface, below, grid, between(wanted, low, high, float(WEIGHTS[index])), index
        )
        inside = found.least >= (1.0 - band) * height and found.most <= (1.0 + band) * height
        return found if inside else None

    best = lightest(trial, weight, AIM * limit)
    if best is None:  # a front that can only follow the one below, corners and all
        raise InputError(
            "BAND",
            label,
            "a band of {:g} % is too narrow for {} points around: use more of them",
            100.0 * band,
            len(grid) - 1,
        )
    return best


def layers(
    surface: Surface,
    first: WallLayer,
    height: float,
    u_end: float,
    band: float = 0.2,
    limit: float = 0.1,
    points: int = 360,
    label: str = "wall",
) -> list[Smoothed]:
    """All layers above the first up to the first one wholly past u_end."""
    grid = first.v[0] + (first.v[-1] - first.v[0]) * np.linspace(0.0, 1.0, points + 1)
    done: list[Smoothed] = []
    below = first
    while below.u.min() < u_end:
        weight = done[-1].weight if done else HEAVY
        done.append(next_layer(surface, below, height, grid, band, limit, label, weight))
        below = done[-1].layer
    return done


def _measured(surface: Surface, below: WallLayer, grid: Array, u: Array, weight: int) -> Smoothed:
    closed = np.r_[u, u[0]]
    slope = CubicSpline(grid, closed, bc_type="periodic")(grid, 1)
    layer = WallLayer.of(surface, grid, closed, slope, slope)
    distance = local_distances(layer, below, FINER)[1]
    turn = float(turns_in_wall(surface, layer).max())
    return Smoothed(layer, float(distance.min()), float(distance.max()), turn, weight)
