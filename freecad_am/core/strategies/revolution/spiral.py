# SPDX-License-Identifier: LGPL-2.1-or-later
"""The wall as one continuous open bead that rises along the wall by a layer height per turn."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from ...geometry.curves.profile import Meridian, RevolvedWall
from ...geometry.step_count import largest_step, step_count
from ...issues import NOTE, InputError, Issue, Text
from ...parameters.bead_classes import WALL
from ...parameters.process import ProcessParameters
from ...parameters.strategy import RevolutionParameters
from ...process import order
from ...slicing import arc_length
from ...toolpath import Bead, BeadRole, Layer
from ...types import Array, Index
from ..clearance.look import SEAM
from .clearance import Deposit, Tips
from .tilt import Tilting

PER_TURN = 8  # places to a turn at which the tilt-back is settled


def layers(
    wall: RevolvedWall, strategy: RevolutionParameters, process: ProcessParameters, tilting: Tilting
) -> tuple[tuple[Layer, ...], list[Issue]]:
    """The whole spiral as one layer with one open bead; its parameter is the angle unwrapped over all turns.

    It starts with the full turn of the base circle, rises by a layer height per turn along the wall, and ends with
    a full turn at an open top. On a top closed on the axis it ends where the radius is half a layer height.
    Raises InputError 'PARTIAL_TURN', and 'LAYER_HEIGHT' as layers do.
    """
    if not wall.full:
        raise InputError(
            "PARTIAL_TURN", "strategy.path", "{} is not a full turn; use path: layers", wall.label
        )
    pitch = strategy.layer_height
    arc_length.layers(wall.meridian, pitch)
    end = _end(wall.meridian, pitch)
    turns = _turn_angles(wall.meridian, end, pitch, strategy)
    s = np.clip(pitch * (turns / (2.0 * math.pi) - 1.0), 0.0, end)
    radius, height, _ = wall.meridian.at(s)
    rising = order.rising(process, 0, True)
    parameter = process.seam.angle + (turns if rising else -turns)
    build, tool, issues = _directions(wall.meridian, turns, s, rising, tilting)
    bead = Bead(
        wall.points(radius, height, parameter),
        wall.directions(build, parameter),
        wall.directions(tool, parameter),
        parameter,
        np.full(len(s), process.for_class(WALL).travel_speed),
        False,
        role=BeadRole(bead_class=WALL),
    )
    ends = _over_itself(turns, end, pitch, wall.meridian.closed_top)
    return (Layer((bead,)),), [*issues, *ends]


def _over_itself(turns: Array, end: float, pitch: float, closed_top: bool) -> list[Issue]:
    """Notes with the places where the spiral has less than a layer height of room above its turn before: in the turn that
    rises from the flat first one, and in the flat last one of an open top."""
    issues = []
    start = int(np.searchsorted(turns, 2.0 * math.pi - 1e-9))
    if end > 0.0 and start < len(turns) - 1:
        text = Text(
            "from here the second turn rises from 0 to {:g} mm above the flat first turn, so the "
            "first half of it is over-deposited; the end of the turn is correct. Machine the "
            "foot, or use path: layers",
            pitch,
        )
        issues.append(Issue(NOTE, "DEPOSITED_TWICE", text, 0, 0, start))
    last_start = int(np.searchsorted(turns, turns[-1] - 2.0 * math.pi - 1e-9))
    if not closed_top and start < last_start < len(turns) - 1:
        text = Text(
            "from here the flat last turn descends from {:g} to 0 mm above the previous turn, so "
            "the second half of it is over-deposited. Machine the top, or use path: layers",
            pitch,
        )
        issues.append(Issue(NOTE, "DEPOSITED_TWICE", text, 0, 0, last_start))
    return issues


def _end(meridian: Meridian, pitch: float) -> float:
    """Arc length at which the spiral ends."""
    if not meridian.closed_top:
        return meridian.length
    low, high = 0.0, meridian.length
    inside = meridian.points[:, 0] > 0.5 * pitch
    if inside.any():
        last_inside = int(np.flatnonzero(inside)[-1])
        low, high = float(meridian.s[last_inside]), float(meridian.s[last_inside + 1])
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if meridian.at([middle])[0][0] > 0.5 * pitch else (low, middle)
    return low


def _turn_angles(
    meridian: Meridian, end: float, pitch: float, strategy: RevolutionParameters
) -> Array:
    """Angles turned (n,) rad, from 0; each turn evenly divided within the chord error, with a point on each kink."""
    flat_from = 2.0 * math.pi * (1.0 + end / pitch)
    total = flat_from + (0.0 if meridian.closed_top else 2.0 * math.pi)
    kinks = 2.0 * math.pi * (1.0 + meridian.kinks / pitch)
    stops = np.unique(
        np.r_[np.arange(0.0, total, 2.0 * math.pi), total, flat_from, kinks[kinks < flat_from]]
    )
    stops = stops[np.r_[True, np.diff(stops) > 1e-6]]
    stops[-1] = total
    sections = [
        np.linspace(a, b, _segments(meridian, a, b, pitch, end, strategy) + 1)[:-1]
        for a, b in pairwise(stops)
    ]
    turns: Array = np.concatenate([*sections, [total]])
    return turns


def _segments(
    meridian: Meridian, a: float, b: float, pitch: float, end: float, strategy: RevolutionParameters
) -> int:
    """Segments between two angles turned: the second derivative of the curve in the angle bounds the chord error."""
    rate = pitch / (2.0 * math.pi)
    s = np.clip(rate * (np.linspace(a, b, 17) - 2.0 * math.pi), 0.0, end)
    radius, _, tangent = meridian.at(s)
    bend = np.linalg.norm(np.diff(tangent, axis=0), axis=1)[1:-1] / np.maximum(
        np.diff(s)[1:-1], 1e-12
    )
    # 1.05: the meridian's bend is sampled, not bounded
    acceleration = math.hypot(radius.max() + 1.05 * bend.max() * rate**2, 2.0 * rate)
    step = min(
        largest_step(acceleration, strategy.chord_error), 2.0 * math.pi / strategy.min_points
    )
    return math.ceil((b - a) / step - 1e-9)


def _directions(
    meridian: Meridian, turns: Array, s: Array, rising: bool, tilting: Tilting
) -> tuple[Array, Array, list[Issue]]:
    """Build directions and tool axes (n, 3) at angles turned and arc lengths (n,). The tilt-back is settled at PER_TURN
    places to a turn; between them it is interpolated from the larger of neighbours, so that it is never too small."""
    knots = np.linspace(0.0, turns[-1], step_count(turns[-1] * PER_TURN, 2.0 * math.pi) + 1)
    knot_s = np.interp(knots, turns, s)
    radius, height, tangent = meridian.at(knot_s)
    sense = 1.0 if rising else -1.0
    points = meridian.at(s)
    number = np.arange(len(s))

    def tips(where: tuple[Array, Array, Array], turned: Array, moment: Index) -> Tips:
        # deposit of the last turn belongs to the current layer
        own_moment = np.searchsorted(turns, turned - 2.0 * math.pi - SEAM)
        return Tips(where[0], where[1], sense * turned, moment, own_moment)

    deposit = Deposit(
        points[0],
        points[1],
        sense * turns,
        tilting.build(points[2]),
        number,
        number == 0,
        np.interp(turns, knots, np.arange(len(knots))),
        tilting.size,
    )
    knot_tips = tips((radius, height, tangent), knots, np.searchsorted(turns, knots, side="right"))
    back, issues = tilting.tilt_back(
        tangent, rising, knot_tips, deposit, tips(points, turns, number + 1)
    )
    build, tool = tilting.axes(points[2], np.interp(turns, knots, back), rising)
    return build, tool, issues
