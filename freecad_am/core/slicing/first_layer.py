# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compute the first layer of a wall: the curve in which the wall leaves the substrate."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from ..geometry.columns import Implicit
from ..geometry.curves.space_curve import SpaceCurve
from ..geometry.walls.surface import Surface, dot
from ..issues import InputError
from ..types import Array
from .tubes.smooth_spacing import WallLayer

TOLERANCE_MM = 1e-5  # mm; limit of interpolation_error, a tenth of the tolerance of bead points
MIN_ARC_SHARE = 1e-5  # fraction of the period; minimum arc length that is still halved
ROUNDS = 14


def finer_grid(curve: SpaceCurve, within: float = TOLERANCE_MM) -> Array:
    """Return the midpoints of arcs whose interpolation error is too large.

    Parameters
    ----------
    curve : SpaceCurve
        The curve.
    within : float, optional
        Maximum error, mm.

    Returns
    -------
    (k,) array
        Curve parameters of the midpoints.
    """
    coarse = (curve.interpolation_error() > within) & (curve.span > MIN_ARC_SHARE * curve.period)
    middle: Array = curve.w[:-1][coarse] + 0.5 * curve.span[coarse]
    return middle


SCAN = 200  # samples along each line v = const, tested for inside or outside the substrate
HALVINGS = 60  # maximum number of Newton or bisection steps
SAME_POINT = 1e-6  # mm; maximum distance of coincident points


def intersect_implicit(
    surface: Surface,
    substrate: Implicit,
    u_range: tuple[float, float],
    v: Array,
    label: str = "wall",
) -> WallLayer:
    """Compute the curve in which the wall leaves the substrate for the last time.

    Parameters
    ----------
    surface : Surface
        The wall.
    substrate : Implicit
        The substrate as an implicit surface.
    u_range : tuple[float, float]
        Range of u; the wall leaves the substrate in the direction of ascending u.
    v : (m,) array
        Parameters from one seam to the next. Nodes are added where cubic arcs deviate from the
        curve.
    label : str, optional
        Name of the wall, for messages.

    Returns
    -------
    WallLayer
        The first layer; nodes are exact to rounding errors.

    Raises
    ------
    InputError
        NO_INTERSECTION if the wall does not leave the substrate at every v.
    """
    for _ in range(ROUNDS):
        u, slope = _find_exit(surface, substrate, u_range, v, label)
        layer = WallLayer.of(surface, v, u, slope, slope)
        added = finer_grid(layer.curve)
        if not len(added):
            break
        v = np.sort(np.r_[v, added])
    return layer


def _find_exit(
    surface: Surface, substrate: Implicit, u_range: tuple[float, float], v: Array, label: str
) -> tuple[Array, Array]:
    u = np.linspace(*u_range, SCAN)
    outside = substrate.value(surface.point(*np.meshgrid(u, v, indexing="ij")))[0] > 0.0
    leaves = outside[1:] & ~outside[:-1]
    if not leaves.any(axis=0).all() or not outside[-1].all():
        missing = v[np.flatnonzero(~(leaves.any(axis=0) & outside[-1]))[0]]
        raise InputError(
            "NO_INTERSECTION",
            label,
            "the wall does not rise out of the substrate everywhere (at v = {:.4g}, for "
            "instance); extend the wall into the substrate all around, or choose start edges",
            missing,
        )
    last_exit = len(u) - 2 - np.argmax(leaves[::-1], axis=0)
    low, high = u[last_exit], u[last_exit + 1]
    u_exit = 0.5 * (low + high)
    for _ in range(HALVINGS):  # Newton's method, bracketed by the last samples inside and outside
        points, along, _ = surface.derivatives(u_exit, v)
        value, gradient = substrate.value(points)
        low, high = np.where(value > 0.0, low, u_exit), np.where(value > 0.0, u_exit, high)
        rate = dot(gradient, along)
        new = u_exit - value / np.where(np.abs(rate) > 1e-12, rate, np.inf)
        new = np.where((new < low) | (new > high), 0.5 * (low + high), new)
        still = np.abs(new - u_exit).max() < 1e-15 * max(1.0, np.abs(new).max())
        u_exit = new
        if still:
            break
    points, along, around = surface.derivatives(u_exit, v)
    gradient = substrate.value(points)[1]
    return u_exit, -dot(gradient, around) / dot(gradient, along)


def interpolate_polyline(
    surface: Surface, points: Array, corner: float = np.radians(20.0), label: str = "wall"
) -> WallLayer:
    """Interpolate a layer through a closed chain of points on the wall.

    The layer is smooth between corners.

    Parameters
    ----------
    surface : Surface
        The wall.
    points : (m, 3) array
        The chain in either direction, without repeated first point, mm.
    corner : float, optional
        Minimum direction change at a corner, rad.
    label : str, optional
        Name of the wall, for messages.

    Returns
    -------
    WallLayer
        The layer.

    Raises
    ------
    InputError
        NOT_AROUND if the chain does not run once around the wall without reversing in v.
    ValueError
        If the wall is open in v.
    """
    if surface.period is None:
        raise ValueError("a wall that is open in v has no closed layers")
    points = points[np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1) > SAME_POINT]
    u, v = surface.inverse(points)
    steps = np.diff(np.r_[v, v[0]])
    steps = np.mod(steps + 0.5 * surface.period, surface.period) - 0.5 * surface.period
    if steps.sum() < 0.0:
        points, u, v = points[::-1], u[::-1], v[::-1]
        steps = -np.roll(steps[::-1], -1)
    if (
        len(points) < 4
        or steps.min() <= 0.0
        or abs(steps.sum() - surface.period) > 1e-6 * surface.period
    ):
        raise InputError(
            "NOT_AROUND",
            label,
            "the first layer does not run once around the wall; choose a closed loop of edges "
            "that crosses each line up the wall once",
        )
    chord_before = points - np.roll(points, 1, axis=0)
    chord_after = np.roll(chord_before, -1, axis=0)
    turn = np.arctan2(
        np.linalg.norm(np.cross(chord_before, chord_after), axis=1), dot(chord_before, chord_after)
    )
    breaks = np.flatnonzero(turn > corner)
    start = int(breaks[0]) if len(breaks) else 0
    v = v[start] + np.r_[0.0, np.cumsum(np.roll(steps, -start))]
    v[-1] = v[0] + surface.period
    u = np.r_[np.roll(u, -start), u[start]]
    if not len(breaks):
        slope = CubicSpline(v, u, bc_type="periodic")(v, 1)
        return WallLayer.of(surface, v, u, slope, slope)
    into, out = np.empty(len(v)), np.empty(len(v))
    ends = np.r_[breaks - start, len(v) - 1]
    for low, high in zip(ends[:-1], ends[1:]):
        rows = slice(low, high + 1)
        slope = CubicSpline(v[rows], u[rows])(v[rows], 1)
        into[low + 1 : high + 1], out[low:high] = slope[1:], slope[:-1]
    into[0], out[-1] = into[-1], out[0]
    return WallLayer.of(surface, v, u, into, out)
