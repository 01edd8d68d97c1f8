# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the torch is held along a bead on a hub: lead, tilt and the deflection of outer contours (Dai 2020, section 3), turned
no faster than `build_direction.max_turn`.

The torch leans from the surface's normal by angles forward and to the right of the way the bead runs. Where that way turns
at a corner the torch leans by as much, and goes round the normal from the one side to the other over a stretch of the bead
about the corner. Laid flat this is a heading, a number that runs on along the bead, and its means over stretches.
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
from .course import LEAST_DEPARTURE, OF_NORMAL, WITHIN, Course, evened, limit
from .spread import Line, Zones, means, too_fast

GROWTH, SHRINK = 1.1, 0.9
ROUNDS = 100
ASTRAY = math.radians(
    40.0
)  # largest mean of how far the heading of the lean may be from the bead's
LONGEST = 0.7  # of a bead; no stretch reaches farther
FEWEST = 0.02  # share of the lean asked for below which it is none
STEEPEST = math.radians(
    300.0
)  # rad/mm; without a limit, so that lean and bead agree next to corners
FINE, FLAT = (
    math.radians(0.02),
    1e4,
)  # what of a direction may be lost between points; mm stretched so that only that counts
LEAST_MM = (
    4e-3  # mm; no shorter are the pieces of a segment on which the torch goes round the normal
)
EDGE = 1e-3  # mm over which a deflection ends before it is spread
ROUGH = 0.05  # share of the chord error that the heading's course need not follow
CORNER = 0.5  # points so much farther apart than those of a curve make a corner


@dataclass(frozen=True)
class Lean:
    """What is asked of a bead: leaning forward and to its right by `lead` and `side`, rad; beyond `until` mm
    by `rest` to the right."""

    lead: float
    side: float
    rest: float = 0.0
    until: float = math.inf

    @property
    def most(self) -> float:
        """The largest angle (rad) between the torch and the normal."""
        return math.acos(
            math.cos(self.lead) * math.cos(max(abs(self.side), abs(self.rest), key=abs))
        )

    def less(self, share: float) -> Lean:
        """The same to a share of it."""
        return Lean(share * self.lead, share * self.side, share * self.rest, self.until)


class Turned(NamedTuple):
    """Besides the bead: share of the lean asked for that it has, by how much (rad) the torch departs from what that asks for
    at corners at most, over how much of the length (mm), and the turn of the normals (rad/mm) where they alone turn faster
    than asked for, else 0."""

    share: float
    asked: float
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


def held(course: Course, lean: Lean, build: BuildDirectionParameters, chord_error: float) -> Held:
    """The bead with its tool axes, and points added where they turn."""
    step = np.linalg.norm(np.diff(course.flat, axis=0), axis=1)
    way = np.r_[0.0, np.cumsum(step)]
    asked = lean.most
    course, off, over = evened(course, way, build, asked > 0.0)
    flat, points, normal, phi = course.at(way, way)
    own = float(turn_rates(points, normal).max())
    most = limit(course.surface, build, own)
    lacking = own if own > (WITHIN if asked else 1.0) * most else 0.0
    most = OF_NORMAL * own if lacking else most
    if asked == 0.0:
        return Held(flat, points, normal, normal, Turned(1.0, 0.0, off, over, lacking))
    limited, most = most < math.inf, min(most, STEEPEST)
    line, period = _line(course, way, float(phi[-1] - phi[0]), chord_error)
    share = 1.0
    if course.closed:  # it cannot go round the normal faster than that
        share = min(
            1.0,
            WITHIN * most * way[-1] / max(math.sin(min(asked, 0.5 * math.pi)) * abs(period), 1e-12),
        )
    while share > FEWEST:
        found = _spread(course, way, line, lean.less(share), most, max(most - own, 0.1 * most))
        if found is not None:
            departure = max(found.turned.departure, off) if limited else off
            return found._replace(
                turned=Turned(share, asked, departure, max(found.turned.length, over), lacking)
            )
        share *= SHRINK
    return Held(flat, points, normal, normal, Turned(0.0, asked, off, over, lacking))


def _line(course: Course, way: Array, round_: float, chord_error: float) -> tuple[Line, float]:
    """The heading (rad) of the bead along it, in the plane, and by how much it is more after a round of a closed one.

    At each point it turns over as much of the way as a curve that stays within the chord error would, half of the shorter
    edge at most; next to at once at a corner. round_: how far phi goes on in a round.
    """
    x, y = columns(course.flat)
    kept = np.isin(x + 1j * y, simplified(course.flat, ROUGH * chord_error) @ np.array([1.0, 1j]))
    x, y = columns(np.diff(course.flat[kept], axis=0))
    heading = np.unwrap(np.arctan2(y, x))
    edge, at = np.diff(way[kept]), way[kept][1:-1]
    turn = np.diff(heading)
    margin = 0.5 * np.minimum(edge[:-1], edge[1:])
    before, after = heading[:-1], heading[1:]
    period = 0.0
    if course.closed:
        seam = float(np.remainder(heading[0] + round_ - heading[-1] + math.pi, TURN) - math.pi)
        period = heading[-1] + seam - heading[0]
        at, turn = np.r_[0.0, at], np.r_[seam, turn]
        margin = np.r_[0.5 * min(edge[-1], edge[0]), margin]
        before, after = np.r_[heading[-1] - period, before], np.r_[heading[0], after]
    curve = 2.0 * chord_error / np.maximum(np.abs(turn), 1e-12)
    margin = np.where(curve < CORNER * margin, 0.1 * EDGE, np.minimum(margin, curve))
    places = np.stack([at - margin, at + margin], axis=1).ravel()
    values = np.stack([before, after], axis=1).ravel()
    if course.closed:
        turns = np.array([-1.0, 0.0, 1.0])[:, None]
        places, values = (places + turns * way[-1]).ravel(), (values + turns * period).ravel()
    if not len(places):
        places, values = np.zeros(1), heading[:1]
    apart = np.r_[True, np.diff(places) > 1e-9]
    return Line(places[apart], values[apart, None]), period


def _with_sides(line: Line, lean: Lean) -> Line:
    """Heading and angle to the right along the bead."""
    if math.isinf(lean.until):
        return Line(line.at, np.column_stack([line.values, np.full(len(line.at), lean.side)]))
    ends = lean.until + np.array([-0.5, 0.5]) * EDGE
    at = np.union1d(line.at, ends)
    side = np.interp(at, ends, [lean.side, lean.rest])
    return Line(at, np.column_stack([line(at)[:, 0], side]))


def _spread(
    course: Course, way: Array, heading: Line, lean: Lean, most: float, budget: float
) -> Held | None:
    """The bead with its lean spread so that the torch turns no faster than `most`; None where that takes it too far astray.

    budget: what the lean may turn by for sure."""
    length = float(way[-1])
    line = _with_sides(heading, lean)
    line = line if course.closed else line.mirrored(length)
    weights = np.array([math.sin(lean.most), 1.0])
    leaning = length if lean.lead or lean.rest else min(length, lean.until + EDGE)
    zones = too_fast(line, weights, budget, length if course.closed else None, leaning)
    for _ in range(ROUNDS):
        s = np.union1d(way, zones.places(way))
        values = means(line, s, zones.stretches(s))
        more = _within_bends(line, s, zones, values, lean.most)
        if len(more):
            s = np.union1d(s, more)
            values = means(line, s, zones.stretches(s))
        more = _about_normal(s, values, lean.most)
        if len(more):
            s = np.union1d(s, more)
            values = means(line, s, zones.stretches(s))
        flat, points, normal, tool, phi, rates = _sampled(course, way, s, values, lean)
        fast = rates > WITHIN * most
        if not fast.any():
            break
        zones = zones.widened(0.5 * (s[1:] + s[:-1])[fast], GROWTH)
        if zones.half.max() > LONGEST * length:
            return None
    else:
        return None
    fewer = np.isin(s, way) | _needed(s, values, lean.lead)
    if not fewer.all():
        thin = _sampled(course, way, s[fewer], values[fewer], lean)
        if not (thin.rates > 0.5 * (1.0 + WITHIN) * most).any():
            s, values = s[fewer], values[fewer]
            flat, points, normal, tool, phi, _ = thin
    asked = line(s)
    share = np.diff(s) / length
    leans = np.hypot(
        math.sin(lean.lead), np.sin(asked[:, 1])
    )  # where the torch stands straight its heading says nothing
    off, weight = (
        0.5 * (row[1:] + row[:-1]) @ share
        for row in (np.abs(values[:, 0] - asked[:, 0]) * leans, leans)
    )
    if off > ASTRAY * weight:
        return None
    wanted = directed(course.surface, normal, asked[:, 0] - phi, lean.lead, asked[:, 1])
    apart = np.arctan2(np.linalg.norm(np.cross(wanted, tool), axis=1), (wanted * tool).sum(axis=1))
    touched = float((share * length)[np.maximum(apart[1:], apart[:-1]) > LEAST_DEPARTURE].sum())
    return Held(
        flat,
        points,
        normal,
        tool,
        Turned(1.0, 0.0, float(apart.max()) if touched else 0.0, touched),
    )


def _within_bends(line: Line, s: Array, zones: Zones, values: Array, lean: float) -> Array:
    """Places (m,) mm to add between places s (n,) with their values (n, c) where the heading bends on a short part of a long
    segment alone: straight from one to the other it would be so far off that the torch leaned by more than FINE less."""
    at = line.at[(line.at > s[0] + LEAST_MM) & (line.at < s[-1] - LEAST_MM)]
    at = at[np.diff(at, prepend=-math.inf) >= LEAST_MM]
    after = np.searchsorted(s, at)
    at = at[np.minimum(at - s[after - 1], s[after] - at) >= LEAST_MM]
    off = np.abs(means(line, at, zones.stretches(at))[:, 0] - np.interp(at, s, values[:, 0]))
    found: Array = at[off > _straight_turn(lean)]
    return found


def _straight_turn(lean: float) -> float:
    """How far (rad) the torch may go round the normal on a straight way from one side to the other and lean by no more than
    FINE less."""
    return 2.0 * math.acos(max(1.0 - 2.0 * FINE / max(math.sin(2.0 * lean), FINE), 0.0))


def _about_normal(s: Array, values: Array, lean: float) -> Array:
    """Places (m,) mm to add where the torch goes round the normal by so much between two places s (n,) that on the straight
    way from one side to the other it would lean by more than FINE less."""
    most = _straight_turn(lean)
    turn, step = np.abs(np.diff(values[:, 0])), np.diff(s)
    count = np.maximum(np.minimum(np.ceil(turn / most), step / LEAST_MM), 1.0).astype(np.intp)
    start = np.repeat(np.arange(len(step)), count - 1)
    number = np.arange(len(start)) - np.repeat(np.cumsum(count - 1) - (count - 1), count - 1) + 1
    found: Array = s[start] + number / count[start] * step[start]
    return found


class _Sampled(NamedTuple):
    """Places (n, 2) on the plane, points, normals and tools (n, 3), phi (n,) rad, turns (n - 1,) rad/mm."""

    flat: Array
    points: Array
    normal: Array
    tool: Array
    phi: Array
    rates: Array


def _sampled(course: Course, way: Array, s: Array, values: Array, lean: Lean) -> _Sampled:
    """The bead at places s (n,) with its torch by headings and angles to the right, values (n, 2)."""
    flat, points, normal, phi = course.at(s, way)
    tool = directed(course.surface, normal, values[:, 0] - phi, lean.lead, values[:, 1])
    if course.closed:
        tool[-1] = tool[0]
    return _Sampled(flat, points, normal, tool, phi, turn_rates(points, tool))


def _needed(s: Array, values: Array, lead: float) -> Mask:
    """Which places (n,) keep the lean, laid flat, within FINE where it runs straight between them."""
    heading, side = columns(values)
    ahead, right = np.cos(side) * math.sin(lead), np.sin(side)
    cos, sin = np.cos(heading), np.sin(heading)
    found = np.zeros(len(s), dtype=bool)
    for part in (ahead * cos + right * sin, ahead * sin - right * cos):
        kept = simplified(np.stack([FLAT * s, part], axis=-1), FINE)
        found |= np.isin(FLAT * s, kept[:, 0])
    return found


def directed(
    surface: LayerSurface, normal: Array, heading: Array, lead: float, side: Array
) -> Array:
    """Tool axes (n, 3): the normals turned by `lead` towards the heading (n,), counted from the first axis of the surface,
    then by `side` (n,) to the right of it, rad."""
    around, up = surface.axes(normal)
    cos, sin = np.cos(heading)[:, None], np.sin(heading)[:, None]
    along, right = cos * around + sin * up, sin * around - cos * up
    ahead = math.cos(lead) * normal + math.sin(lead) * along
    tool = np.cos(side)[:, None] * ahead + np.sin(side)[:, None] * right
    unit: Array = tool / np.linalg.norm(tool, axis=1, keepdims=True)
    return unit
