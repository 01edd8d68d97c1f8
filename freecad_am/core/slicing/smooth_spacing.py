# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers whose local distance may vary within a band, so that they stay free of corners.

Fronts at an exactly constant distance gather into corners (errata of Chalvin 2019), at which a robot has to stop. The
deposit tolerates some variation of the layer's height (Chalvin 2020): here each layer lies between the fronts at the least
and the greatest distance allowed, and is as smooth as asked, or as the band allows. At the tip of a corner the front
runs ahead and on its flanks it holds back, so that a corner of up to 2 acos((1 - band) / (1 + band)) stays round.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.sparse import csc_matrix, diags, identity
from scipy.sparse.linalg import splu

from ..geometry.surface import Surface, dot, normals
from ..issues import InputError
from .offset import Offset
from .wall_layer import WallLayer, local_distances

Array = NDArray[np.float64]

MARGIN = 0.02  # of the band, kept free for what the curve does between its points
WEIGHTS = 10.0 ** np.arange(-2, 10)  # of smoothness against the exact distance
HEAVY = 7  # from this weight on the turn is much less, or the band stops it: GAIN by IDLE more is what a search goes on for
GAIN, IDLE = 0.02, 2
AIM = 0.8  # of the limit; layers above sharpen what is round, so some of it is kept for them
ROUNDS, LOOK, RELAXED, CLOSE = 2000, 5, 1.6, 1e-3  # of the alternation; how near its two halves come, of the band
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
    """Turn of the bead within the wall per length, (m - 1,) rad/mm, on each arc together with the corner it starts from.

    The wall's own curvature is left out: the nozzle is normal to the bead in the wall and follows it anyway.
    """
    curve = layer.curve
    normal = normals(surface, layer.u, layer.v)
    # both tangents of a turn brought into one plane, that of the normal between them
    middle = normal[:-1] + normal[1:]
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    turn = _angles(curve.out[:-1], curve.into[1:], middle) + _angles(curve.into[:-1], curve.out[:-1], normal[:-1])
    rate: Array = np.abs(turn) / np.linalg.norm(np.diff(curve.points, axis=0), axis=1)
    return rate


def next_layer(
    surface: Surface, below: WallLayer, height: float, grid: Array, band: float, limit: float, label: str = "wall",
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
                "LAYER_HEIGHT", label, f"the wall has no point at {share * height:g} mm from the layer below: use a smaller "
                "layer height or a narrower band",
            )
        fronts.append(places.u)
    wanted, low, high = fronts

    def trial(index: int) -> Smoothed | None:
        found = _measured(surface, below, grid, _between(wanted, low, high, float(WEIGHTS[index])), index)
        inside = found.least >= (1.0 - band) * height and found.most <= (1.0 + band) * height
        return found if inside else None

    best = _lightest(trial, weight, AIM * limit)
    if best is None:  # a front that can only follow the one below, corners and all
        raise InputError(
            "BAND", label, f"a band of {100.0 * band:g} % is too narrow for {len(grid) - 1} points around: use more of them",
        )
    return best


def _lightest(trial: Callable[[int], Smoothed | None], start: int, limit: float) -> Smoothed | None:
    """The layer of the lightest weight that keeps the limit, searched from `start`, or the one that turns least.

    A heavier weight turns less until the band stops it; too heavy a one leaves the band (`trial` gives None).
    """
    best = trial(start)
    for index in range(start - 1, -1, -1):
        if best is not None and best.turn > limit:
            break
        lighter = trial(index)
        if best is not None and (lighter is None or lighter.turn > limit):
            return best
        best = lighter
    if best is None or best.turn <= limit or best.weight < start:
        return best
    idle = 0
    for index in range(start + 1, len(WEIGHTS)):
        heavier = trial(index)
        if heavier is None:
            break
        idle = 0 if index <= HEAVY or heavier.turn < (1.0 - GAIN) * best.turn else idle + 1
        best = min(best, heavier, key=lambda layer: layer.turn)
        if best.turn <= limit or idle == IDLE:
            break
    return best


def layers(
    surface: Surface, first: WallLayer, height: float, u_end: float, band: float = 0.2, limit: float = 0.1,
    points: int = 360, label: str = "wall",
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


def _between(wanted: Array, low: Array, high: Array, weight: float) -> Array:
    """x (n,), periodic, that minimises |x - wanted|^2 + weight |second differences|^2 with low <= x <= high.

    By alternating directions: a smooth x and one within the bounds approach each other. The smooth one is returned.
    """
    n = len(wanted)
    second = diags([1.0, 1.0, -2.0, 1.0, 1.0], [-(n - 1), -1, 0, 1, n - 1], shape=(n, n))
    matrix = csc_matrix(identity(n) + weight * (second.T @ second))
    pull = 1.0 + np.sqrt(weight)
    solve = splu(csc_matrix(matrix + pull * identity(n))).solve
    bounded, debt = wanted, np.zeros(n)
    x = wanted
    for count in range(ROUNDS):
        x = solve(wanted + pull * (bounded - debt))
        leaning = RELAXED * x + (1.0 - RELAXED) * bounded
        bounded = np.minimum(np.maximum(leaning + debt, low), high)
        debt = debt + leaning - bounded
        if count % LOOK == 0 and np.abs(x - bounded).max() < CLOSE * (high - low).max():
            break
    return x


def _measured(surface: Surface, below: WallLayer, grid: Array, u: Array, weight: int) -> Smoothed:
    closed = np.r_[u, u[0]]
    slope = CubicSpline(grid, closed, bc_type="periodic")(grid, 1)
    layer = WallLayer.of(surface, grid, closed, slope, slope)
    distance = local_distances(layer, below, FINER)[1]
    turn = float(turns_in_wall(surface, layer).max())
    return Smoothed(layer, float(distance.min()), float(distance.max()), turn, weight)


def _angles(one: Array, other: Array, normal: Array) -> Array:
    """Angles (n,) rad about the normals from one vector to the other, both brought into the normal's plane."""
    one, other = (side - dot(side, normal)[:, None] * normal for side in (one, other))
    angle: Array = np.arctan2(dot(np.cross(one, other), normal), dot(one, other))
    return angle
