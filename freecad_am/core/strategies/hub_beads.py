# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads on a cylinder or cone from curves on the plane: rolled up, with directions and speeds."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..filling.curve import PlaneCurve
from ..geometry.columns import columns
from ..geometry.developable import TURN, Array, Developable
from ..geometry.on_hub import Base
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.process import ProcessParameters
from ..parameters.strategy import DevelopableParameters
from ..process.bead_model import BeadModel
from ..process.bead_speed import followed, radii
from ..toolpath import Bead
from .hub_layers import period

Mask = NDArray[np.bool_]

ROLLED = 0.5  # share of the chord error between a bead's chords and the surface
CLOSE = 2e-3  # mm; points nearer together are one: no controller tells the time of such a move


class Rolled(NamedTuple):
    """A bead, its predicted heights (n,) mm, where (n,) the speed is not what the width asks for, and where it bends more
    than the table's beads; None without a bead model."""

    bead: Bead
    height: Array | None = None
    clamped: Mask | None = None
    tight: Mask | None = None


def rolled(
    curve: PlaneCurve, surface: Developable, middle: float, base: Base, strategy: DevelopableParameters,
    build: BuildDirectionParameters, process: ProcessParameters, model: BeadModel | None, deflection: float = 0.0,
) -> Rolled:
    """The bead of a curve on the plane, in part coordinates; its polynomial's variable is the arc length, 2 pi in all.

    deflection: rad, of the torch to the right of the bead, besides the tilt.
    """
    start = period(surface).moved(curve.points[:1], curve.turns) if curve.turns else curve.points[:1]
    ended = np.vstack([curve.points, start]) if curve.closed else curve.points
    flat = dense(ended, surface, ROLLED * strategy.chord_error)
    local = _rolled(flat, surface, middle)
    if curve.closed:
        local[-1] = local[0]
    normal = _unit(surface.normals(local))
    along = _along(local, normal, curve.closed)
    tool = directed(normal, along, build, deflection)
    points = base.placed(local)
    if curve.closed:
        points[-1] = points[0]
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    bead = Bead(
        points, base.turned(normal), base.turned(tool), TURN * way / way[-1], np.full(len(way), process.travel_speed),
        curve.closed,
    )
    return Rolled(bead) if model is None else _at_speed(bead, flat, curve.closed and not curve.turns, process, model)


def _apart(flat: Array) -> Array:
    """A polyline (n, 2) without points nearer than CLOSE, along it, to the one kept before; both ends stay."""
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(flat, axis=0), axis=1))]
    kept = np.r_[True, np.diff(np.floor(way / CLOSE)) > 0.0]
    kept &= (way < way[-1] - CLOSE) | (way == 0.0)
    kept[0] = kept[-1] = True
    chosen = flat[kept]
    near = np.r_[False, np.linalg.norm(np.diff(chosen, axis=0), axis=1) < CLOSE]
    near[-1] = False  # neighbours across a step of the count: the first of the two is enough
    return chosen[~near] if len(chosen) - int(near.sum()) >= 2 else chosen[[0, -1]]


def dense(flat: Array, surface: Developable, chord_error: float) -> Array:
    """A polyline (n, 2) on the plane with so many points that its chords, rolled up, keep within the chord error.

    An edge is a geodesic: its curvature is that of the surface around the axis, by the square of its share of that way.
    """
    flat = _apart(flat)
    edge = np.diff(flat, axis=0)
    length = np.linalg.norm(edge, axis=1)
    theta, z = _unrolled(flat, surface)
    phi = theta * math.sin(surface.taper)
    along, across = columns(edge)
    heading = np.arctan2(across, along)
    share = np.maximum(np.abs(np.cos(heading - phi[:-1])), np.abs(np.cos(heading - phi[1:])))
    share = np.minimum(share + np.abs(np.diff(phi)), 1.0)
    rho = np.full(len(z), surface.radius) if surface.is_cylinder else (surface.height - z) * math.tan(surface.taper)
    # an edge comes nearer to the apex than its ends by no more than its sagitta seen from there
    least = np.minimum(rho[:-1], rho[1:]) * np.cos(0.5 * np.abs(np.diff(phi)))
    curvature = math.cos(surface.taper) * share**2 / least
    count = np.maximum(np.ceil(length * np.sqrt(curvature / (8.0 * chord_error)) - 1e-9), 1.0).astype(np.intp)
    start = np.repeat(np.arange(len(edge)), count)
    number = np.arange(len(start)) - np.repeat(np.cumsum(count) - count, count)
    points: Array = flat[start] + (number / count[start])[:, None] * edge[start]
    return np.vstack([points, flat[-1:]])


def _unrolled(flat: Array, surface: Developable) -> tuple[Array, Array]:
    """Azimuth and height (n,) along a curve (n, 2) on the plane, the azimuth counted on where the curve goes far round."""
    theta, z = surface.unrolled(flat)
    if surface.is_cylinder:
        return theta, z
    sine = math.sin(surface.taper)
    return np.unwrap(theta * sine) / sine, z


def _rolled(flat: Array, surface: Developable, middle: float) -> Array:
    theta, z = _unrolled(flat, surface)
    rho = np.full(len(z), surface.radius) if surface.is_cylinder else (surface.height - z) * math.tan(surface.taper)
    angle = theta + middle
    return np.stack([rho * np.cos(angle), rho * np.sin(angle), z], axis=1)


def directed(normal: Array, along: Array, build: BuildDirectionParameters, deflection: float) -> Array:
    """Tool axes (n, 3): the normals turned forward by the lead, then about the bead by tilt and deflection (rad), towards
    its right where positive."""
    right = np.cross(along, normal)
    side = build.tilt + deflection
    ahead = math.cos(build.lead) * normal + math.sin(build.lead) * along
    return _unit(math.cos(side) * ahead + math.sin(side) * right)


def _along(points: Array, normal: Array, closed: bool) -> Array:
    """Unit tangents (n, 3) within the surface, at corners halfway."""
    step = np.diff(points, axis=0)
    step /= np.linalg.norm(step, axis=1)[:, None]
    before = np.vstack([step[-1:] if closed else step[:1], step])
    after = np.vstack([step, step[:1] if closed else step[-1:]])
    mean = before + after
    mean = np.where(np.linalg.norm(mean, axis=1)[:, None] > 1e-6, mean, after)
    return _unit(mean - (mean * normal).sum(axis=1)[:, None] * normal)


def _at_speed(bead: Bead, flat: Array, closed: bool, process: ProcessParameters, model: BeadModel) -> Rolled:
    """The bead, laid flat (n, 2) where it may be closed or not, at the speeds that keep its width."""
    radius = radii(flat, closed, process.bead_width)
    asked = model.speed_for(process.bead_width, radius)
    speed = followed(flat, asked.speed, closed, process.acceleration)
    segment = np.r_[speed[0], 0.5 * (speed[:-1] + speed[1:])]
    return Rolled(
        replace(bead, speed=segment, width=model.widths(speed, radius)), model.heights(speed, radius),
        asked.too_slow | asked.too_fast, asked.too_tight,
    )


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit


def reversed_curve(curve: PlaneCurve) -> PlaneCurve:
    """The curve run the other way, a closed one from the same start."""
    points = curve.points[::-1]
    return replace(curve, points=np.roll(points, 1, axis=0) if curve.closed else points)
