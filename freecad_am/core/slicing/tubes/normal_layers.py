# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers in planes normal to the centreline of a tube (Chalvin 2018), for comparison.

The planes are one layer height apart along the centreline. In a bend they fan out on the outside
and converge on the inside. On a torus their local distance is 2 rho sin(h / 2R), with rho = R + r
at the outside and rho = R - r at the inside of the bend.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from ...geometry.walls.surface import Surface, dot
from ...issues import InputError
from ...types import Array
from ..smoothest_heights import refuse_too_many
from .smooth_spacing import WallLayer

# number of wall sections whose centroids define the centreline, and points per section
SECTIONS, SAMPLES_AROUND = 401, 256
EXTENSION_SHARE = 0.5  # fraction of the wall length; extension of the centreline beyond the wall
STEPS = 50  # maximum number of Newton steps


class Centreline(NamedTuple):
    """Line through the centroids of the sections u = const.

    middle: spline of the centroids (3,), mm, over u. u_at_length: u as a function of the length
    along the centreline, mm.
    """

    middle: CubicSpline
    u_at_length: CubicSpline


def centreline(surface: Surface, low: float, high: float) -> Centreline:
    """Compute the centreline of a wall that is closed in v.

    Parameters
    ----------
    surface : Surface
        The wall.
    low, high : float
        Range of u.

    Returns
    -------
    Centreline
        The centreline.

    Raises
    ------
    ValueError
        If the wall is open in v.
    """
    if surface.period is None:
        raise ValueError("a wall that is open in v has no centreline")
    u = np.linspace(low, high, SECTIONS)
    v = surface.period * np.arange(SAMPLES_AROUND) / SAMPLES_AROUND
    points, _, around = surface.derivatives(*np.meshgrid(u, v, indexing="ij"))
    # weight each point by the curve length that it represents
    share = np.linalg.norm(around, axis=-1, keepdims=True)
    middle = CubicSpline(u, (points * share).sum(axis=1) / share.sum(axis=1))
    x, weight = np.polynomial.legendre.leggauss(5)
    step = np.diff(u)[:, None]
    rate = np.linalg.norm(middle(u[:-1, None] + 0.5 * step * (x + 1.0), 1), axis=-1)
    length = np.r_[0.0, np.cumsum((rate * 0.5 * weight * step).sum(axis=1))]
    return Centreline(middle, CubicSpline(length, u))


def layers(
    surface: Surface,
    first_layer: WallLayer,
    height: float,
    u_end: float,
    points: int = 360,
    label: str = "wall",
) -> list[WallLayer]:
    """Compute the layers in planes at equal distances along the centreline.

    The first plane is at the lowest point of `first_layer`. Parts of a layer below `first_layer`
    need no deposit.

    Parameters
    ----------
    surface : Surface
        The wall.
    first_layer : WallLayer
        The first layer.
    height : float
        Distance along the centreline, mm.
    u_end : float
        End of the wall in u.
    points : int, optional
        Number of points per layer.
    label : str, optional
        Name of the wall, for messages.

    Returns
    -------
    list of WallLayer
        The layers, up to the first layer completely beyond `u_end`.

    Raises
    ------
    InputError
        NOT_NORMAL if the search finds no intersection of a plane with a line v = const of the wall.

    References
    ----------
    Chalvin 2018.
    """
    low = float(first_layer.u.min())
    # the wall is extrapolated beyond its end, so that the last planes cut it all around
    middle, u_at_length = centreline(surface, low, u_end + EXTENSION_SHARE * (u_end - low))
    v = first_layer.v[0] + (first_layer.v[-1] - first_layer.v[0]) * np.linspace(
        0.0, 1.0, points + 1
    )
    wall_layers: list[WallLayer] = []
    while not wall_layers or wall_layers[-1].u.min() < u_end:
        refuse_too_many(len(wall_layers), height, label)
        along = len(wall_layers) * height
        if along > u_at_length.x[-1]:
            break
        u = float(u_at_length(along))
        tangent = middle(u, 1)
        wall_layers.append(
            _in_plane(surface, v, u, middle(u), tangent / np.linalg.norm(tangent), label)
        )
    return wall_layers


def _in_plane(
    surface: Surface, v: Array, start: float, origin: Array, normal: Array, label: str
) -> WallLayer:
    """Intersect a plane with the wall, by Newton's method along each line v = const."""
    u = np.full(len(v), start)
    for _ in range(STEPS):
        point, along, around = surface.derivatives(u, v)
        rise = along @ normal
        step = (point - origin) @ normal / np.where(rise > 0.0, rise, np.nan)
        u = u - step
        if not np.isfinite(u).all() or np.abs(step * np.sqrt(dot(along, along))).max() < 1e-11:
            break
    if not np.isfinite(u).all() or np.abs((surface.point(u, v) - origin) @ normal).max() > 1e-6:
        raise InputError(
            "NOT_NORMAL",
            label,
            "each plane normal to the centre line must cut the wall in one curve; choose other "
            "layers for the wall",
        )
    u[-1] = u[0]
    _, along, around = surface.derivatives(u, v)
    slope = -(around @ normal) / (along @ normal)
    return WallLayer.of(surface, v, u, slope, slope)
