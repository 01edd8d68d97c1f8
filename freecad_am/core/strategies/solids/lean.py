# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the torch is held along a bead on a hub: lead, tilt and the deflection of outer contours (Dai 2020, section 3), turned
no faster than `build_direction.max_turn`.

The torch leans from the surface's normal by angles forward and to the right of the direction of travel. At a corner the torch
leans by the same angle, and goes round the normal from one side to the other over a stretch of the bead about the corner. On
the flattened bead this is a heading, a number that continues along the bead, and its means over stretches.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...geometry.angles import TURN
from ...geometry.columns import columns
from ...geometry.regions.region import simplified
from ...layers.surface import LayerSurface
from ...parameters.build_direction import BuildDirectionParameters
from ...slicing.directions.wall import turn_rates
from ...types import Array, Mask
from .course import LEAST_DEPARTURE, OF_NORMAL, RATE_MARGIN, Course, evened, limit
from .spread import Line, Zones, means, too_fast

GROWTH, SHRINK = 1.1, 0.9
ROUNDS = 100
MAX_DEPARTURE_SHARE = math.radians(
    40.0
)  # largest mean of how far the heading of the lean may be from the bead's
MAX_STRETCH_SHARE = 0.7  # of a bead; no stretch reaches farther
MIN_LEAN_SHARE = 0.02  # share of the lean asked for below which it is none
STEEPEST = math.radians(
    300.0
)  # rad/mm; without a limit, so that lean and bead agree next to corners
FINE, STRETCH = (
    math.radians(0.02),
    1e4,
)  # largest loss of a direction between points; mm stretched so that only this counts
LEAST_MM = (
    4e-3  # mm; no shorter are the pieces of a segment on which the torch goes round the normal
)
EDGE = 1e-3  # mm over which a deflection ends before it is spread
SIMPLIFY_SHARE = 0.05  # share of the chord error that the heading's course need not follow
CORNER = 0.5  # ratio of point distance to that of a curve from which points make a corner


@dataclass(frozen=True)
class Lean:
    """The requested lean of a bead: forward and to its right by `lead` and `side`, rad; beyond `until` mm by `side_beyond` to the
    right.
    """

    lead: float
    side: float
    side_beyond: float = 0.0
    until: float = math.inf

    @property
    def most(self) -> float:
        """The largest angle (rad) between the torch and the normal."""
        return math.acos(
            math.cos(self.lead) * math.cos(max(abs(self.side), abs(self.side_beyond), key=abs))
        )

    def less(self, share: float) -> Lean:
        """The lean scaled by a share."""
        return Lean(share * self.lead, share * self.side, share * self.side_beyond, self.until)


class Turned(NamedTuple):
    """Torch turning of a bead: its share of the requested lean, the largest departure (rad) from the requested axis at corners, the
    length affected (mm), and the turn of the normals (rad/mm) if the normals turn faster than the limit, else 0.
    """

    share: float
    requested: float
    departure: float
    length: float
    normals: float = 0.0


class Held(NamedTuple):
    """A bead in the hub's frame with the points it needs: flat (n, 2), points, normals and tool axes (n, 3)."""

    flat: Array
    points: Array
    normal: Array
    tool: Array
    turned: Turned


def hold_torch(
    course: Course, lean: Lean, build: BuildDirectionParameters, chord_error: float
) -> Held:
    """The bead with its tool axes, and points added where they turn."""
    step = np.linalg.norm(np.diff(course.flat, axis=0), axis=1)
    arc = np.r_[0.0, np.cumsum(step)]
    requested = lean.most
    course, off, over = evened(course, arc, build, requested > 0.0)
    flat, points, normal, phi = course.wrap_at(arc, arc)
    normal_rate = float(turn_rates(points, normal).max())
    max_rate = limit(course.surface, build, normal_rate)
    lacking = normal_rate if normal_rate > (RATE_MARGIN if requested else 1.0) * max_rate else 0.0
    max_rate = OF_NORMAL * normal_rate if lacking else max_rate
    if requested == 0.0:
        return Held(flat, points, normal, normal, Turned(1.0, 0.0, off, over, lacking))
    limited, max_rate = max_rate < math.inf, min(max_rate, STEEPEST)
    line, period = _line(course, arc, float(phi[-1] - phi[0]), chord_error)
    share = 1.0
    if course.closed:  # it cannot go round the normal faster than that
        share = min(
            1.0,
            RATE_MARGIN
            * max_rate
            * arc[-1]
            / max(math.sin(min(requested, 0.5 * math.pi)) * abs(period), 1e-12),
        )
    while share > MIN_LEAN_SHARE:
        spread_bead = _spread_lean(
            course,
            arc,
            line,
            lean.less(share),
            max_rate,
            max(max_rate - normal_rate, 0.1 * max_rate),
        )
        if spread_bead is not None:
            departure = max(spread_bead.turned.departure, off) if limited else off
            return spread_bead._replace(
                turned=Turned(
                    share, requested, departure, max(spread_bead.turned.length, over), lacking
                )
            )
        share *= SHRINK
    return Held(flat, points, normal, normal, Turned(0.0, requested, off, over, lacking))


def _line(course: Course, arc: Array, round_: float, chord_error: float) -> tuple[Line, float]:
    """The heading (rad) of the bead along it, in the plane, and by how much it is more after a round of a closed one.

    At each point it turns over as much of the way as a curve that stays within the chord error would, half of the shorter
    edge at most; next to at once at a corner. round_: how far phi goes on in a round.
    """
    x, y = columns(course.flat)
    is_kept = np.isin(
        x + 1j * y, simplified(course.flat, SIMPLIFY_SHARE * chord_error) @ np.array([1.0, 1j])
    )
    x, y = columns(np.diff(course.flat[is_kept], axis=0))
    heading = np.unwrap(np.arctan2(y, x))
    edge, position = np.diff(arc[is_kept]), arc[is_kept][1:-1]
    turn = np.diff(heading)
    margin = 0.5 * np.minimum(edge[:-1], edge[1:])
    left, right = heading[:-1], heading[1:]
    period = 0.0
    if course.closed:
        seam = float(np.remainder(heading[0] + round_ - heading[-1] + math.pi, TURN) - math.pi)
        period = heading[-1] + seam - heading[0]
        position, turn = np.r_[0.0, position], np.r_[seam, turn]
        margin = np.r_[0.5 * min(edge[-1], edge[0]), margin]
        left, right = np.r_[heading[-1] - period, left], np.r_[heading[0], right]
    curve = 2.0 * chord_error / np.maximum(np.abs(turn), 1e-12)
    margin = np.where(curve < CORNER * margin, 0.1 * EDGE, np.minimum(margin, curve))
    knots = np.stack([position - margin, position + margin], axis=1).ravel()
    values = np.stack([left, right], axis=1).ravel()
    if course.closed:
        turns = np.array([-1.0, 0.0, 1.0])[:, None]
        knots, values = (knots + turns * arc[-1]).ravel(), (values + turns * period).ravel()
    if not len(knots):
        knots, values = np.zeros(1), heading[:1]
    is_separate = np.r_[True, np.diff(knots) > 1e-9]
    return Line(knots[is_separate], values[is_separate, None]), period


def _add_sides(line: Line, lean: Lean) -> Line:
    """Heading and angle to the right along the bead."""
    if math.isinf(lean.until):
        return Line(
            line.positions, np.column_stack([line.values, np.full(len(line.positions), lean.side)])
        )
    ends = lean.until + np.array([-0.5, 0.5]) * EDGE
    knots = np.union1d(line.positions, ends)
    side = np.interp(knots, ends, [lean.side, lean.side_beyond])
    return Line(knots, np.column_stack([line(knots)[:, 0], side]))


def _spread_lean(
    course: Course, arc: Array, heading: Line, lean: Lean, max_rate: float, budget: float
) -> Held | None:
    """The bead with its lean spread so that the torch turns no faster than `max_rate`; None if that departs too far.

    budget: rate of turn reserved for the lean.
    """
    length = float(arc[-1])
    line = _add_sides(heading, lean)
    line = line if course.closed else line.mirrored(length)
    weights = np.array([math.sin(lean.most), 1.0])
    leaning = length if lean.lead or lean.side_beyond else min(length, lean.until + EDGE)
    zones = too_fast(line, weights, budget, length if course.closed else None, leaning)
    for _ in range(ROUNDS):
        s = np.union1d(arc, zones.places(arc))
        values = means(line, s, zones.stretches(s))
        extra = _within_bends(line, s, zones, values, lean.most)
        if len(extra):
            s = np.union1d(s, extra)
            values = means(line, s, zones.stretches(s))
        extra = _about_normal(s, values, lean.most)
        if len(extra):
            s = np.union1d(s, extra)
            values = means(line, s, zones.stretches(s))
        flat, points, normal, tool, phi, rates = _sampled(course, arc, s, values, lean)
        fast = rates > RATE_MARGIN * max_rate
        if not fast.any():
            break
        zones = zones.widened(0.5 * (s[1:] + s[:-1])[fast], GROWTH)
        if zones.half.max() > MAX_STRETCH_SHARE * length:
            return None
    else:
        return None
    is_kept = np.isin(s, arc) | _needed(s, values, lean.lead)
    if not is_kept.all():
        thin = _sampled(course, arc, s[is_kept], values[is_kept], lean)
        if not (thin.rates > 0.5 * (1.0 + RATE_MARGIN) * max_rate).any():
            s, values = s[is_kept], values[is_kept]
            flat, points, normal, tool, phi, _ = thin
    requested = line(s)
    share = np.diff(s) / length
    leans = np.hypot(
        math.sin(lean.lead), np.sin(requested[:, 1])
    )  # where the torch is upright its heading is undefined
    off, weight = (
        0.5 * (row[1:] + row[:-1]) @ share
        for row in (np.abs(values[:, 0] - requested[:, 0]) * leans, leans)
    )
    if off > MAX_DEPARTURE_SHARE * weight:
        return None
    target = directed(course.surface, normal, requested[:, 0] - phi, lean.lead, requested[:, 1])
    departure = np.arctan2(
        np.linalg.norm(np.cross(target, tool), axis=1), (target * tool).sum(axis=1)
    )
    touched = float(
        (share * length)[np.maximum(departure[1:], departure[:-1]) > LEAST_DEPARTURE].sum()
    )
    return Held(
        flat,
        points,
        normal,
        tool,
        Turned(1.0, 0.0, float(departure.max()) if touched else 0.0, touched),
    )


def _within_bends(line: Line, s: Array, zones: Zones, values: Array, lean: float) -> Array:
    """Positions (m,) mm to add between positions s (n,) with values (n, c) where the heading bends on a short section of a long
    segment: interpolated linearly, the torch would lean by more than FINE less.
    """
    bends = line.positions[(line.positions > s[0] + LEAST_MM) & (line.positions < s[-1] - LEAST_MM)]
    bends = bends[np.diff(bends, prepend=-math.inf) >= LEAST_MM]
    right = np.searchsorted(s, bends)
    bends = bends[np.minimum(bends - s[right - 1], s[right] - bends) >= LEAST_MM]
    off = np.abs(
        means(line, bends, zones.stretches(bends))[:, 0] - np.interp(bends, s, values[:, 0])
    )
    positions: Array = bends[off > _straight_turn(lean)]
    return positions


def _straight_turn(lean: float) -> float:
    """How far (rad) the torch may go round the normal on a straight way from one side to the other and lean by no more than
    FINE less."""
    return 2.0 * math.acos(max(1.0 - 2.0 * FINE / max(math.sin(2.0 * lean), FINE), 0.0))


def _about_normal(s: Array, values: Array, lean: float) -> Array:
    """Positions (m,) mm to add where the torch goes so far round the normal between two positions s (n,) that in between it would
    lean by more than FINE less.
    """
    max_turn = _straight_turn(lean)
    turn, step = np.abs(np.diff(values[:, 0])), np.diff(s)
    count = np.maximum(np.minimum(np.ceil(turn / max_turn), step / LEAST_MM), 1.0).astype(np.intp)
    start = np.repeat(np.arange(len(step)), count - 1)
    number = np.arange(len(start)) - np.repeat(np.cumsum(count - 1) - (count - 1), count - 1) + 1
    positions: Array = s[start] + number / count[start] * step[start]
    return positions


class _Sampled(NamedTuple):
    """Places (n, 2) on the plane, points, normals and tools (n, 3), phi (n,) rad, turns (n - 1,) rad/mm."""

    flat: Array
    points: Array
    normal: Array
    tool: Array
    phi: Array
    rates: Array


def _sampled(course: Course, arc: Array, s: Array, values: Array, lean: Lean) -> _Sampled:
    """The bead at places s (n,) with its torch by headings and angles to the right, values (n, 2)."""
    flat, points, normal, phi = course.wrap_at(s, arc)
    tool = directed(course.surface, normal, values[:, 0] - phi, lean.lead, values[:, 1])
    if course.closed:
        tool[-1] = tool[0]
    return _Sampled(flat, points, normal, tool, phi, turn_rates(points, tool))


def _needed(s: Array, values: Array, lead: float) -> Mask:
    """Mask of the positions (n,) that keep the flattened lean within FINE under linear interpolation."""
    heading, side = columns(values)
    ahead, right = np.cos(side) * math.sin(lead), np.sin(side)
    cos, sin = np.cos(heading), np.sin(heading)
    is_needed = np.zeros(len(s), dtype=bool)
    for component in (ahead * cos + right * sin, ahead * sin - right * cos):
        simple = simplified(np.stack([STRETCH * s, component], axis=-1), FINE)
        is_needed |= np.isin(STRETCH * s, simple[:, 0])
    return is_needed


def directed(
    surface: LayerSurface, normal: Array, heading: Array, lead: float, side: Array
) -> Array:
    """Tool axes (n, 3): the normals turned by `lead` towards the heading (n,), counted from the first axis of the surface, then to
    its right by `side` (n,), rad.
    """
    around, up = surface.axes(normal)
    cos, sin = np.cos(heading)[:, None], np.sin(heading)[:, None]
    along, right = cos * around + sin * up, sin * around - cos * up
    ahead = math.cos(lead) * normal + math.sin(lead) * along
    tool = np.cos(side)[:, None] * ahead + np.sin(side)[:, None] * right
    unit: Array = tool / np.linalg.norm(tool, axis=1, keepdims=True)
    return unit
