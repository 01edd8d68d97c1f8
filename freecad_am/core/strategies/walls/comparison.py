# SPDX-License-Identifier: LGPL-2.1-or-later
"""Comparison of slicing methods for a wall by layer spacing, as in figures 6 and 8 to 10 of Chalvin 2019."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.walls.surface_wall import Placed, SurfaceWall
from ...issues import InputError
from ...parameters.strategy import SurfaceParameters
from ...slicing.first_layer import interpolate_polyline
from ...slicing.tubes import normal_layers
from ...slicing.tubes.smooth_spacing import WallLayer, local_distances, turns_in_wall
from ...types import Array
from .plan import sliced

NORMAL = "centreline-normal"
METHODS = ("iso-parameter", NORMAL, "constant-distance", "smooth")
FINER = 4  # samples per arc at which the distance is measured
END_TOLERANCE = 1e-9  # in u; maximum distance past an edge of a point on the edge


@dataclass(frozen=True, eq=False)
class Compared:
    """A wall sliced by one method. Lengths in mm, angles in rad.

    layers: number of layers up to the first layer entirely past the end. smallest, mean, largest:
    distance of points to the nearest point of the layer below. turn: maximum turn rate within the
    wall, per mm, away from corners. corners: number of layers with corners. corner: sharpest corner.
    length: total length of the layers below the end. For each layer after the first: around (n,), v
    as a fraction of its period from -0.5 to 0.5; distance (n,); and step (n,), the height above the
    layer below along the line v = const (Delta_ij). curves: points (n, 3) of the layers. These
    arrays are NaN where there is no deposit.
    """

    method: str
    layers: int
    smallest: float
    mean: float
    largest: float
    turn: float
    corners: int
    corner: float
    length: float
    around: tuple[Array, ...]
    distance: tuple[Array, ...]
    step: tuple[Array, ...]
    curves: tuple[Array, ...]


@dataclass(frozen=True)
class Refused:
    """A method that does not apply to the wall, with the reason."""

    method: str
    reason: str


def compare(wall: SurfaceWall, strategy: SurfaceParameters) -> tuple[Compared | Refused, ...]:
    """Cut a wall by every method of METHODS and compare the layers.

    Parameters
    ----------
    wall : SurfaceWall
        The wall.
    strategy : SurfaceParameters
        Layer height, band and maximum turn rate.

    Returns
    -------
    tuple[Compared or Refused, ...]
        The results of each method, or the reason why the method does not apply.

    References
    ----------
    Chalvin 2019, figures 6 and 8 to 10.
    """
    surface = wall.surface()
    first_layer = interpolate_polyline(surface, wall.first, label=wall.label)
    results: list[Compared | Refused] = []
    for method in METHODS:
        try:
            if method == NORMAL:
                fronts = normal_layers.layers(
                    surface, first_layer, strategy.layer_height, wall.end, label=wall.label
                )
            else:
                fronts = sliced(wall, surface, replace(strategy, spacing=method))
        except InputError as error:
            results.append(Refused(method, error.message))
        else:
            results.append(_measured(method, surface, fronts, first_layer, wall.end))
    return tuple(results)


def _measured(
    method: str, surface: Placed, fronts: Sequence[WallLayer], first_layer: WallLayer, end: float
) -> Compared:
    around, distance, step = [], [], []
    for below, above in zip(fronts, fronts[1:]):
        v, distance_ = local_distances(above, below, FINER)
        u, base = above.heights(surface, v)[0], below.heights(surface, v)[0]
        is_deposited = u > first_layer.heights(surface, v)[0]
        rise = np.linalg.norm(surface.point(u, v) - surface.point(base, v), axis=1)
        share = v[:-1] / above.curve.period
        share -= np.round(share)
        order = np.argsort(share, kind="stable")
        order = np.r_[order, order[0]]
        around.append(np.r_[share[order[:-1]], share[order[0]] + 1.0])
        distance.append(np.where(is_deposited, distance_, np.nan)[order])
        step.append(np.where(is_deposited, rise, np.nan)[order])
    # nodes are denser at corners, so each node is weighted by its stretch
    weight = np.concatenate([np.gradient(shares) for shares in around])
    values = np.concatenate(distance)
    weight, values = weight[np.isfinite(values)], values[np.isfinite(values)]
    turn = corner = 0.0
    cornered = 0
    for front in fronts[1:]:  # the substrate determines the first layer
        inside = (front.u <= end) & (front.u >= first_layer.heights(surface, front.v)[0])
        corners = front.curve.corners
        sharpest = float(front.curve.turns[corners[inside[corners]]].max(initial=0.0))
        smooth = inside[:-1] & inside[1:]
        smooth[corners] = False
        turn = max(turn, float(turns_in_wall(surface, front)[smooth].max(initial=0.0)))
        cornered, corner = cornered + (sharpest > 0.0), max(corner, sharpest)
    curves = tuple(_deposited(surface, front, first_layer, end) for front in fronts)
    length = sum(
        float(np.nansum(np.linalg.norm(np.diff(curve, axis=0), axis=1))) for curve in curves
    )
    return Compared(
        method,
        len(fronts),
        float(values.min()),
        float(np.average(values, weights=weight)),
        float(values.max()),
        turn,
        cornered,
        corner,
        length,
        tuple(around),
        tuple(distance),
        tuple(step),
        curves,
    )


def _deposited(surface: Placed, front: WallLayer, first_layer: WallLayer, end: float) -> Array:
    """Return points (n, 3) along a layer, NaN below the first layer and past the end."""
    v = front.curve.refined(2)
    u = front.heights(surface, v)[0]
    is_deposited = (u <= end + END_TOLERANCE) & (
        u >= first_layer.heights(surface, v)[0] - END_TOLERANCE
    )
    points: Array = np.where(is_deposited[:, None], surface.point(u, v), np.nan)
    return points
