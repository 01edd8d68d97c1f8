# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool axes along a bead on a hub: lead, tilt and the deflection of outer contours (Dai 2020, section 3).

`build_direction.max_turn` limits the turn rate. The torch leans from the surface normal by angles forward and to the
right of the travel direction. At a corner it keeps the lean angle and rotates about the normal from one side to the other
over a stretch of the bead. On the flattened bead this rotation is the moving average of the unwrapped heading.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...geometry.columns import columns
from ...geometry.frames import TURN
from ...geometry.regions.region import simplified
from ...geometry.step_count import round_down
from ...layers.surface import LayerSurface
from ...parameters.build_direction import BuildDirectionParameters
from ...slicing.wall_directions import turn_rates
from ...types import Array, Index, Mask
from .flattened_bead import LEAST_DEPARTURE, OF_NORMAL, RATE_MARGIN, Course, evened, limit

SLOPE = 0.75  # half stretches; width of the wider box of the trapezoidal window, which limits the slope of a jump
BLOCK = 128  # positions processed at once; their integrals start nearby, which keeps precision
PARTS = 6  # number of points on half a stretch
MIN_STRETCH_MM = 0.05  # mm; minimum distance between added points


class Line(NamedTuple):
    """Values (k, c), piecewise linear between ascending positions (k,), mm, and constant beyond the ends."""

    positions: Array
    values: Array

    def __call__(self, s: Array) -> Array:
        """Return the values (n, c) at positions (n,)."""
        values_: Array = np.stack(
            [np.interp(s, self.positions, column) for column in self.values.T], axis=-1
        )
        return values_

    def mirrored(self, length: float) -> Line:
        """Mirror the values of an open bead at both ends, so that bends near an end have little effect."""
        positions_ = np.concatenate(
            [-self.positions[::-1], self.positions, 2.0 * length - self.positions[::-1]]
        )
        values = np.vstack([self.values[::-1], self.values, self.values[::-1]])
        is_separate = np.r_[True, np.diff(positions_) > 1e-9]
        return Line(positions_[is_separate], values[is_separate])


def means(line: Line, s: Array, half: Array) -> Array:
    """Return the means of a line over stretches.

    Parameters
    ----------
    line : Line
        The line.
    s : (n,) array
        Midpoints of the stretches, mm.
    half : (n,) array
        Half lengths of the stretches, mm.

    Returns
    -------
    (n, c) array
        Means; the line's values where `half` is 0.
    """
    means_ = line(s)
    wide = np.flatnonzero(half > 1e-6)
    for rows in np.split(wide, np.arange(BLOCK, len(wide), BLOCK)) if len(wide) else ():
        means_[rows] = _means(line, s[rows], half[rows])
    return means_


def _means(line: Line, s: Array, half: Array) -> Array:
    low, high = float((s - half).min()), float((s + half).max())
    inner = line.positions[
        np.searchsorted(line.positions, low, side="right") : np.searchsorted(
            line.positions, high, side="left"
        )
    ]
    x = np.r_[low, inner, high]
    y = line(x)
    offset = y[0].copy()
    y = y - offset
    dx = np.diff(x)[:, None]
    slope = np.where(dx > 1e-12, np.diff(y, axis=0) / np.maximum(dx, 1e-12), 0.0)
    once = np.vstack([np.zeros(y.shape[1]), np.cumsum(0.5 * (y[1:] + y[:-1]) * dx, axis=0)])
    step = once[:-1] * dx + y[:-1] * dx**2 / 2.0 + slope * dx**3 / 6.0
    twice = np.vstack([np.zeros(y.shape[1]), np.cumsum(step, axis=0)])

    def integral(upper: Array) -> Array:
        i = np.clip(np.searchsorted(x, upper, side="right") - 1, 0, len(x) - 2)
        t = (upper - x[i])[:, None]
        value: Array = twice[i] + t * (once[i] + t * (y[i] / 2.0 + t * slope[i] / 6.0))
        return value

    a, b = SLOPE * half, (1.0 - SLOPE) * half
    total = integral(s + a + b) - integral(s + a - b) - integral(s - a + b) + integral(s - a - b)
    mean: Array = offset + total / (4.0 * a * b)[:, None]
    return mean


@dataclass
class Zones:
    """Zones where values change too fast.

    low, high: (z,) limits, mm. half: (z,) half length over which the values are spread, mm. length: length of a closed
    bead, mm, None for an open bead.
    """

    low: Array
    high: Array
    half: Array
    length: float | None

    def _copies(self) -> tuple[float, ...]:
        return (0.0,) if self.length is None else (-self.length, 0.0, self.length)

    def stretches(self, s: Array) -> Array:
        """Return the half stretch over which values are spread.

        Parameters
        ----------
        s : (n,) array
            Ascending positions, mm.

        Returns
        -------
        (n,) array
            Half lengths, mm; constant near a zone, then decreasing along a ramp.
        """
        half = np.zeros(len(s))
        moved = np.array(self._copies())[:, None]
        low, high = self.low + moved, self.high + moved
        start = np.searchsorted(s, low - 2.0 * self.half)
        end = np.searchsorted(s, high + 2.0 * self.half)
        for copy, zone in np.argwhere(start < end).tolist():
            rows, zone_half = slice(start[copy, zone], end[copy, zone]), self.half[zone]
            local = s[rows]
            distance = (
                np.maximum(
                    np.maximum(low[copy, zone] - local, local - self.high[zone] - moved[copy, 0]),
                    0.0,
                )
                / zone_half
            )
            share = 0.5 + 0.5 * np.cos(np.pi * np.minimum(np.maximum(distance - 1.0, 0.0), 1.0))
            half[rows] = np.maximum(half[rows], zone_half * share)
        return half

    def places(self, s: Array) -> Array:
        """Return positions to add to a bead so that it follows the ramps.

        Parameters
        ----------
        s : (n,) array
            Positions of the bead's points, mm.

        Returns
        -------
        (k,) array
            New positions, mm.
        """
        shares = np.arange(-PARTS, PARTS + 1) / PARTS
        ramps = []
        for low, high, half in zip(self.low.tolist(), self.high.tolist(), self.half.tolist()):
            ends = (0.5 * (low + high),) if high - low < 0.5 * half else (low, high)
            count = max(1, min(PARTS, round_down(half / MIN_STRETCH_MM)))
            ramp = shares if count == PARTS else np.arange(-count, count + 1) / count
            reach = half + 0.5 * (high - low) if len(ends) == 1 else half
            ramps += [end + reach * ramp for end in ends]
        if not ramps:
            return np.zeros(0)
        candidates = np.concatenate([np.concatenate(ramps) + moved for moved in self._copies()])
        candidates = np.unique(candidates[(candidates > s[0]) & (candidates < s[-1])])
        spaced: list[float] = []
        for position in candidates.tolist():
            if not spaced or position - spaced[-1] >= MIN_STRETCH_MM:
                spaced.append(position)
        kept_positions: Array = np.array(spaced)
        right = np.clip(np.searchsorted(s, kept_positions), 1, len(s) - 1)
        free: Array = kept_positions[
            np.minimum(kept_positions - s[right - 1], s[right] - kept_positions)
            >= 0.5 * MIN_STRETCH_MM
        ]
        return free

    def widened(self, positions: Array, factor: float) -> Zones:
        """Return zones with longer stretches near positions.

        Parameters
        ----------
        positions : (n,) array
            Positions, mm.
        factor : float
            Factor for the half length of a zone near a position.

        Returns
        -------
        Zones
            The zones. The first position out of reach of all zones becomes a new zone.
        """
        low, high, half, unreached = self.low, self.high, self.half.copy(), positions
        if len(low):
            best, distance = self._nearest(positions)
            reached = distance < 3.0 * half[best] + MIN_STRETCH_MM
            half[np.unique(best[reached])] *= factor
            unreached = positions[~reached]
        if len(unreached):
            low, high = np.r_[low, unreached[:1]], np.r_[high, unreached[:1]]
            half = np.r_[half, 2.0 * MIN_STRETCH_MM]
        return Zones(low, high, half, self.length)

    def _nearest(self, positions: Array) -> tuple[Index, Array]:
        """Return the nearest zone (n,) of each position (n,), and its distance (n,), mm."""
        best, distance = np.zeros(len(positions), dtype=np.intp), np.zeros(len(positions))
        for start in range(0, len(positions), BLOCK):
            block = positions[start : start + BLOCK, None]
            off = [
                np.maximum(np.maximum(self.low + m - block, block - self.high - m), 0.0)
                for m in self._copies()
            ]
            nearest = np.min(off, axis=0)
            best[start : start + BLOCK], distance[start : start + BLOCK] = (
                np.argmin(nearest, axis=1),
                nearest.min(axis=1),
            )
        return best, distance


def too_fast(
    line: Line, weights: Array, max_rate: float, length: float | None, end: float
) -> Zones:
    """Return where values change too fast.

    Parameters
    ----------
    line : Line
        The values along a bead.
    weights : (c,) array
        Weights of the values.
    max_rate : float
        Maximum change per mm.
    length : float or None
        Length of a closed bead, mm; None for an open bead.
    end : float
        End of the checked range, from 0, mm.

    Returns
    -------
    Zones
        The zones, initially with short stretches.
    """
    step = np.diff(line.positions)
    change = np.linalg.norm(np.diff(line.values, axis=0) * weights, axis=1)
    middle = 0.5 * (line.positions[1:] + line.positions[:-1])
    fast = (
        (change > max_rate * step + 1e-9)
        & (middle > -1e-9)
        & (middle < end - (1e-9 if length is not None else -1e-9))
    )
    edge = np.diff(np.r_[False, fast, False].astype(int))
    start, last = np.flatnonzero(edge > 0), np.flatnonzero(edge < 0)
    total = np.r_[0.0, np.cumsum(change)]
    need = (total[last] - total[start]) / max_rate / (2.0 * SLOPE)
    return Zones(
        line.positions[start], line.positions[last], np.maximum(0.5 * need, MIN_STRETCH_MM), length
    )


GROWTH, SHRINK = 1.1, 0.9
ROUNDS = 100
MAX_DEPARTURE_SHARE = math.radians(
    40.0
)  # maximum mean deviation between the heading of the lean and the bead
MAX_STRETCH_SHARE = 0.7  # fraction of a bead; maximum reach of a stretch
MIN_LEAN_SHARE = 0.02  # fraction of the requested lean; a smaller lean counts as none
STEEPEST = math.radians(
    300.0
)  # rad/mm; turn rate if there is no limit, so that lean and bead agree next to corners
FINE, STRETCH = (
    math.radians(0.02),
    1e4,
)  # maximum loss of lean between points; scale of positions, so that only this loss counts
LEAST_MM = 4e-3  # mm; minimum length of the pieces of a segment on which the torch rotates about the normal
EDGE = 1e-3  # mm; length over which a deflection ends, before spreading
SIMPLIFY_SHARE = 0.05  # fraction of the chord error; tolerance of the heading's path
CORNER = 0.5  # minimum ratio of point distance to that of a curve at a corner


@dataclass(frozen=True)
class Lean:
    """Requested lean of a bead, rad: `lead` forward and `side` to the right, or `side_beyond` past `until` mm."""

    lead: float
    side: float
    side_beyond: float = 0.0
    until: float = math.inf

    @property
    def most(self) -> float:
        """Maximum angle between torch and normal, rad."""
        return math.acos(
            math.cos(self.lead) * math.cos(max(abs(self.side), abs(self.side_beyond), key=abs))
        )

    def less(self, share: float) -> Lean:
        """Return the lean scaled by a fraction."""
        return Lean(share * self.lead, share * self.side, share * self.side_beyond, self.until)


class Turned(NamedTuple):
    """Torch rotation on a bead.

    share: fraction of the requested lean. requested: requested lean, rad. departure: maximum deviation from the
    requested axis at corners, rad. length: affected length, mm. normals: turn rate of the normals, rad/mm, if above the
    limit, else 0.
    """

    share: float
    requested: float
    departure: float
    length: float
    normals: float = 0.0


class Held(NamedTuple):
    """A bead in the hub frame with all needed points: flat (n, 2), points, normals and tool axes (n, 3)."""

    flat: Array
    points: Array
    normal: Array
    tool: Array
    turned: Turned


def hold_torch(
    course: Course, lean: Lean, build: BuildDirectionParameters, chord_error: float
) -> Held:
    """Return a bead with its tool axes, and with points added where the axes turn.

    Parameters
    ----------
    course : Course
        The flattened bead with its surface.
    lean : Lean
        The requested lean.
    build : BuildDirectionParameters
        Build direction with the maximum turn rate.
    chord_error : float
        Chord error, mm.

    Returns
    -------
    Held
        The bead and its torch rotation.

    References
    ----------
    Dai 2020, section 3.
    """
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
    if course.closed:  # limits the lean by the rotation about the normal per loop
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
    """Return the heading along the bead in the plane, rad, and its increase per loop if closed.

    At each point the heading turns over the length of a curve within the chord error, at most half
    of the shorter edge. At corners it turns almost at once. round_: increase of phi per loop.
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
    """Return heading and sideways angle along the bead."""
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
    """Spread the lean of a bead to limit the turn rate to `max_rate`; None if the deviation is too large.

    budget: turn rate reserved for the lean.
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
    )  # an upright torch has no heading
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
    """Return positions (m,), mm, to add where the heading bends on a short section of a long segment.

    Without them, linear interpolation between positions s (n,) with values (n, c) would lose more than FINE of the lean.
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
    """Return the maximum rotation about the normal, rad, that linear interpolation may span with a lean loss of FINE."""
    return 2.0 * math.acos(max(1.0 - 2.0 * FINE / max(math.sin(2.0 * lean), FINE), 0.0))


def _about_normal(s: Array, values: Array, lean: float) -> Array:
    """Return positions (m,), mm, to add where the torch rotates too far about the normal between positions s (n,).

    Without them, the lean in between would be reduced by more than FINE.
    """
    max_turn = _straight_turn(lean)
    turn, step = np.abs(np.diff(values[:, 0])), np.diff(s)
    count = np.maximum(np.minimum(np.ceil(turn / max_turn), step / LEAST_MM), 1.0).astype(np.intp)
    start = np.repeat(np.arange(len(step)), count - 1)
    number = np.arange(len(start)) - np.repeat(np.cumsum(count - 1) - (count - 1), count - 1) + 1
    positions: Array = s[start] + number / count[start] * step[start]
    return positions


class _Sampled(NamedTuple):
    """Positions (n, 2) on the plane, points, normals and tool axes (n, 3), phi (n,) rad, turn rates (n - 1,) rad/mm."""

    flat: Array
    points: Array
    normal: Array
    tool: Array
    phi: Array
    rates: Array


def _sampled(course: Course, arc: Array, s: Array, values: Array, lean: Lean) -> _Sampled:
    """Sample the bead at positions s (n,) with tool axes from headings and sideways angles, values (n, 2)."""
    flat, points, normal, phi = course.wrap_at(s, arc)
    tool = directed(course.surface, normal, values[:, 0] - phi, lean.lead, values[:, 1])
    if course.closed:
        tool[-1] = tool[0]
    return _Sampled(flat, points, normal, tool, phi, turn_rates(points, tool))


def _needed(s: Array, values: Array, lead: float) -> Mask:
    """Return the mask of positions (n,) that keep the flattened lean within FINE under linear interpolation."""
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
    """Return tool axes that lean from the normals.

    The normal is rotated by `lead` towards the heading, then by `side` to the right.

    Parameters
    ----------
    surface : LayerSurface
        The layer surface.
    normal : (n, 3) array
        Unit normals.
    heading : (n,) array
        Heading of the bead from the first axis of the surface, rad.
    lead : float
        Forward angle, rad.
    side : (n,) array
        Sideways angles, rad.

    Returns
    -------
    (n, 3) array
        Unit tool axes.
    """
    around, up = surface.axes(normal)
    cos, sin = np.cos(heading)[:, None], np.sin(heading)[:, None]
    along, right = cos * around + sin * up, sin * around - cos * up
    ahead = math.cos(lead) * normal + math.sin(lead) * along
    tool = np.cos(side)[:, None] * ahead + np.sin(side)[:, None] * right
    unit: Array = tool / np.linalg.norm(tool, axis=1, keepdims=True)
    return unit
