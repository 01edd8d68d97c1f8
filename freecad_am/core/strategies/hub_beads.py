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
from ..geometry.region import simplified
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.process import ProcessParameters
from ..parameters.strategy import DevelopableParameters
from ..process.bead_model import BeadModel
from ..process.bead_speed import followed, radii
from ..process.wire import with_model
from ..toolpath import Bead
from .hub_layers import period
from .hub_lean import Course, Lean, Turned, held, unrolled

Mask = NDArray[np.bool_]

ROLLED = 0.5  # share of the chord error between a bead's chords and the surface
GRID = 6  # decimals of mm that decide between points
NEEDLESS = 0.02  # share of the chord error that a point has to matter by: offsets leave pairs of points at each node
CLOSE = 2e-3  # mm; points nearer together are one: no controller tells the time of such a move


class Rolled(NamedTuple):
    """A bead, where (n,) the speed is not what the width asks for, and where it bends more than the table's beads; None
    without a bead model."""

    bead: Bead
    clamped: Mask | None = None
    tight: Mask | None = None
    turned: Turned | None = None


def rolled(
    curve: PlaneCurve, surface: Developable, middle: float, base: Base, strategy: DevelopableParameters,
    build: BuildDirectionParameters, process: ProcessParameters, model: BeadModel | None, lean: Lean | None = None,
) -> Rolled:
    """The bead of a curve on the plane, in part coordinates; its polynomial's variable is the arc length, 2 pi in all.

    lean: of the torch, by default that of the build direction.
    """
    start = period(surface).moved(curve.points[:1], curve.turns) if curve.turns else curve.points[:1]
    ended = np.vstack([curve.points, start]) if curve.closed else curve.points
    flat = dense(ended, surface, ROLLED * strategy.chord_error)
    course = Course(flat, curve.closed, surface, middle + _behind(flat, surface, curve.sheet))
    lean = Lean(build.lead, build.tilt) if lean is None else lean
    flat, local, normal, tool, turned = held(course, lean, build, strategy.chord_error)
    points = base.placed(local)
    if curve.closed:
        points[-1] = points[0]
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    bead = Bead(
        points, base.turned(normal), base.turned(tool), TURN * way / way[-1], np.full(len(way), process.travel_speed),
        curve.closed, kind=curve.kind, ring=curve.ring,
    )
    if model is None:
        return Rolled(bead, turned=turned)
    return _at_speed(bead, flat, curve.closed and not curve.turns, process, model)._replace(turned=turned)


def _behind(flat: Array, surface: Developable, sheet: float) -> float:
    """By what azimuth, rad, a curve (n, 2) that lies about u = `sheet` mm is farther round than the plane alone tells: on a
    wide cone it may have come round behind the apex."""
    if surface.is_cylinder:
        return 0.0
    sine = math.sin(surface.taper)
    away = sheet / surface.slant - float(unrolled(flat, surface)[0].mean()) * sine
    return TURN * round(away / TURN) / sine


def _needed(flat: Array, tolerance: float) -> Array:
    """A polyline (n, 2) without the points that it does without within `tolerance` mm."""
    grid = np.ascontiguousarray(np.round(flat, GRID) + 0.0)  # of points alike the same wherever the hub stands
    chosen = np.ascontiguousarray(simplified(grid, tolerance))
    kept = np.isin(grid.view(np.complex128).ravel(), chosen.view(np.complex128).ravel())
    kept[[0, -1]] = True
    return flat[kept]


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
    flat = _apart(_needed(flat, NEEDLESS * chord_error))
    edge = np.diff(flat, axis=0)
    length = np.linalg.norm(edge, axis=1)
    theta, z = unrolled(flat, surface)
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


def _at_speed(bead: Bead, flat: Array, closed: bool, process: ProcessParameters, model: BeadModel) -> Rolled:
    """The bead, laid flat (n, 2) where it may be closed or not, at the speeds that keep its width."""
    radius = radii(flat, closed, process.bead_width)
    asked = model.speed_for(process.bead_width, radius)
    speed = followed(flat, asked.speed, closed, process.acceleration)
    segment = np.r_[speed[0], 0.5 * (speed[:-1] + speed[1:])]
    widths, heights, share = model.widths(speed, radius), model.heights(speed, radius), None
    if process.wire.feed_mode == "proportional":
        heights = model.heights_of_section(widths, process.bead_width)
        share = with_model(process, model) / model.straight_speed(process.bead_width)
    at_speed = replace(bead, speed=segment, width=widths, height=heights, wire_share=share)
    return Rolled(at_speed, asked.too_slow | asked.too_fast, asked.too_tight)


def reversed_curve(curve: PlaneCurve) -> PlaneCurve:
    """The curve run the other way, a closed one from the same start."""
    points = curve.points[::-1]
    return replace(curve, points=np.roll(points, 1, axis=0) if curve.closed else points)
