# SPDX-License-Identifier: LGPL-2.1-or-later
"""Regions that run all the way round a hub: laid flat they have no ends, they repeat under an isometry of the plane.

For a cylinder that is a way along x, for a cone a turn about its apex. A strip is kept unrolled: u runs round the hub (mm at
a reference distance from the apex), v up along it, both of any turn. Parallel curves are made on the plane, window by window
narrower than half a turn, with so much room beside each window that its ends do not matter; the results are cut at the
windows' ends, where neighbours agree, and chained again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...types import Array
from ..columns import columns
from ..curves.plane_curve import doubled_area, winding
from ..step_count import step_count
from .chained import MEETING, chained
from .region import Region, regions

HALF_TURN = 2.6  # rad; a window is no wider, room included


@dataclass(frozen=True)
class Period:
    """turn: what a turn round the hub is when laid flat, mm along x or, with an apex, rad about the point (0, apex)."""

    turn: float
    apex: float = math.inf

    @property
    def around(self) -> float:
        """The period of u, mm."""
        return self.turn if math.isinf(self.apex) else self.turn * abs(self.apex)

    def unrolled(self, flat: Array) -> Array:
        """(u, v) (n, 2) of points (n, 2) of the plane, u within half a turn of the plane about 0."""
        if math.isinf(self.apex):
            return flat.copy()
        x, y = columns(flat)
        rest = self.apex - y
        return np.stack(
            [np.arctan2(x, rest) * abs(self.apex), self.apex - np.hypot(x, rest)], axis=1
        )

    @property
    def whole(self) -> float:
        """What u takes to come round to the same place of the plane, mm; more than a turn round the hub."""
        return math.inf if math.isinf(self.apex) else 2.0 * math.pi * abs(self.apex)

    def followed(self, flat: Array, sheet: float = 0.0, turns: int = 0) -> Array:
        """(u, v) (n, 2) along a curve (n, 2) on the plane, u counted on where it comes round behind the apex, in the mean
        within half a turn of the plane about `sheet`, mm; one that goes round the hub to where it begins again."""
        uv = self.unrolled(flat)
        if not math.isinf(self.apex):
            uv[:, 0] = np.unwrap(uv[:, 0], period=self.whole)
            uv[:, 0] -= self.whole * np.round((uv[:, 0].mean() - sheet) / self.whole)
        return np.vstack([uv, uv[:1] + np.array([turns * self.around, 0.0])]) if turns else uv

    def unroll(self, uv: Array, about: float = 0.0) -> Array:
        """Points (n, 2) of the plane of (u, v), turned back by `about` mm of u."""
        if math.isinf(self.apex):
            return np.asarray(uv - np.array([about, 0.0]))
        phi, way = (uv[:, 0] - about) / abs(self.apex), self.apex - uv[:, 1]
        return np.stack([way * np.sin(phi), self.apex - way * np.cos(phi)], axis=1)

    def moved(self, flat: Array, turns: int) -> Array:
        """Points (n, 2) of the plane moved on by whole turns round the hub."""
        if math.isinf(self.apex):
            return np.asarray(flat + np.array([turns * self.turn, 0.0]))
        angle, apex = turns * self.turn, np.array([0.0, self.apex])
        cos, sin = math.cos(angle), math.sin(angle)
        away = flat - apex
        turned = np.stack(
            [away[:, 0] * cos - away[:, 1] * sin, away[:, 0] * sin + away[:, 1] * cos], axis=1
        )
        return np.asarray(turned + apex)

    def points_round(self, v: float, chord_error: float, least_radius: float) -> int:
        """So many points of a line once round the hub at a v keep within the chord error (mm) on the plane."""
        radius = 1e6 if math.isinf(self.apex) else max(abs(self.apex - v), least_radius)
        return step_count(self.around, math.sqrt(8.0 * chord_error * radius), 24)

    def distance_past(self, flat: Array, u: float) -> Array:
        """How far (n,) mm points of the plane lie past the generatrix at u, |u| below a quarter turn."""
        if math.isinf(self.apex):
            return np.asarray(flat[:, 0] - u)
        phi = u / abs(self.apex)
        return np.asarray(flat[:, 0] * math.cos(phi) - (self.apex - flat[:, 1]) * math.sin(phi))


class Window(NamedTuple):
    """Part of a turn: u from low to high and what else is looked at on both sides, mm. about: its middle."""

    about: float
    low: float
    high: float
    margin: float


@dataclass(frozen=True, eq=False)
class Strip:
    """A region round the hub between two borders, with holes; all in (u, v).

    lower (n, 2): runs on by one period, `upper` (m, 2) back by one, so that the material is to the left; neither repeats its
    first point a period on. holes: closed, clockwise, in any turn.
    """

    period: Period
    lower: Array
    upper: Array
    holes: tuple[Array, ...] = ()

    def borders(self) -> tuple[tuple[Array, int], ...]:
        """The borders (n, 2) laid flat and how often each goes round: 1, -1 and 0 for holes."""
        found = [(self.lower, 1), (self.upper, -1), *((hole, 0) for hole in self.holes)]
        return tuple((self.period.unroll(points), turns) for points, turns in found)

    @cached_property
    def levels(self) -> tuple[float, float]:
        """Lowest and highest v, mm."""
        return float(self.lower[:, 1].min()), float(self.upper[:, 1].max())

    def grown(self, distance: float, chord_error: float) -> tuple[Strip | Region, ...]:
        """As `Region.grown`, on the plane without ends; what does not go round any more is a region."""
        return self.made(lambda part: part.grown(distance, chord_error), abs(distance))

    def made(
        self, operation: Callable[[Region], Sequence[Region]], reach: float
    ) -> tuple[Strip | Region, ...]:
        """What an operation makes of the strip that looks no farther than `reach` mm around."""
        windows = self.windows(reach)
        pieces: list[list[Array]] = []
        for window in windows:
            found: list[Array] = []
            for part in (
                part for region in self.flat(window, with_margin=True) for part in operation(region)
            ):
                uv = [self._cut(ring, window) for ring in part.borders()]
                found += [
                    ring
                    for inner in regions(uv, every_point=True)
                    for ring in _boxed(inner, window.low, window.high)
                ]
            pieces.append(found)
        return parts(
            *chained(pieces, np.array([windows[0].low, *(window.high for window in windows)])),
            self.period,
        )

    def between(self, low: float, high: float) -> tuple[Region, ...]:
        """The strip from u = low to u = high as regions in (u, v)."""
        turn = self.period.around
        lower, upper = self._repeated(self.lower, low, high), self._repeated(self.upper, low, high)
        loops = [np.vstack([lower, upper])]
        for hole in self.holes:
            first = math.floor((low - hole[:, 0].max()) / turn)
            last = math.ceil((high - hole[:, 0].min()) / turn)
            loops += [hole + np.array([k * turn, 0.0]) for k in range(first, last + 1)]
        box = _box(low, high, *self.levels)
        return tuple(
            part
            for region in regions(loops, every_point=True)
            for part in region.common(regions([box]), every_point=True)
        )

    def flat(self, window: Window, with_margin: bool = False) -> list[Region]:
        """The strip in a window, with its margin or without, as regions laid flat about its middle."""
        margin = window.margin if with_margin else 0.0
        return [
            part
            for region in self.between(window.low - margin, window.high + margin)
            for part in regions(
                [self.period.unroll(ring, window.about) for ring in region.borders()]
            )
        ]

    def moved_back(self, window: Window, flat: Array) -> tuple[Array, float]:
        """Points (n, 2) laid flat about the middle of a window laid flat about 0, and the u about which they lie, mm."""
        uv = self.period.unrolled(flat) + np.array([window.about, 0.0])
        return self.period.unroll(uv), float(uv[:, 0].mean())

    def _repeated(self, border: Array, low: float, high: float) -> Array:
        turn = self.period.around
        sense = 1 if border is self.lower else -1
        first = math.floor((low - border[:, 0].max()) / turn) - 2
        last = math.ceil((high - border[:, 0].min()) / turn) + 2
        copies = [border + np.array([k * turn, 0.0]) for k in range(first, last + 1)][::sense]
        exact = np.vstack(copies)
        return self._with_cuts(exact, (low, high), closed=False)

    def _with_cuts(self, uv: Array, at: Sequence[float], closed: bool) -> Array:
        """A line in (u, v) with points where the edges, straight when laid flat, cross generatrices."""
        for u in at:
            following = np.roll(uv, -1, axis=0)
            k = np.flatnonzero((uv[:, 0] < u) != (following[:, 0] < u))
            k = k if closed else k[k < len(uv) - 1]
            a, b = self.period.unroll(uv[k], u), self.period.unroll(following[k], u)
            fa, fb = self.period.distance_past(a, 0.0), self.period.distance_past(b, 0.0)
            place = self.period.unrolled(a + (fa / (fa - fb))[:, None] * (b - a))
            place[:, 0] = u
            uv = np.insert(uv, k + 1, place, axis=0)
        return uv

    def _cut(self, flat: Array, window: Window) -> Array:
        """A ring laid flat about the middle of a window in (u, v), with points where the ends of the window cross it."""
        ends = window.low - window.about, window.high - window.about
        return np.asarray(
            self._with_cuts(self.period.unrolled(flat), ends, closed=True)
            + np.array([window.about, 0.0])
        )

    def windows(self, reach: float) -> tuple[Window, ...]:
        """The strip once round, for what looks `reach` mm around."""
        margin, count = self._windows(reach)
        cuts = np.linspace(-0.5 * self.period.around, 0.5 * self.period.around, count + 1).tolist()
        return tuple(
            Window(0.5 * (low + high), low, high, margin) for low, high in zip(cuts, cuts[1:])
        )

    def pane(self, window: Window) -> tuple[Region, ...]:
        """What is about all of the strip in a window, without the room beside it, laid flat about its middle."""
        u = np.linspace(window.low, window.high, 17)
        bottom, top = self.levels
        margin = 0.05 * (window.high - window.low) + 1.0
        below, above = (
            np.stack([u, np.full(17, bottom - margin)], axis=1),
            np.stack([u, np.full(17, top + margin)], axis=1),
        )
        return regions([self.period.unroll(np.vstack([below, above[::-1]]), window.about)])

    def near(self, window: Window, uv: Array, closed: bool) -> list[tuple[Array, bool]]:
        """What of a curve in (u, v), in all turns, lies in a window or beside it, laid flat about its middle: points (n, 2)
        and whether they close. closed: the curve is, on the plane."""
        turn = self.period.around
        low, high = window.low - window.margin, window.high + window.margin
        found: list[tuple[Array, bool]] = []
        first, last = (
            np.ceil((low - uv[:, 0].max()) / turn),
            np.floor((high - uv[:, 0].min()) / turn),
        )
        for k in range(int(first), int(last) + 1):
            line = uv + np.array([k * turn, 0.0])
            if closed:
                found.append((line, True))
                continue
            within = (line[:, 0] >= low) & (line[:, 0] <= high)
            edge = (
                within[1:]
                | within[:-1]
                | ((line[1:, 0] < low) & (line[:-1, 0] > high))
                | ((line[1:, 0] > high) & (line[:-1, 0] < low))
            )
            change = np.diff(np.r_[False, edge, False].astype(int))
            runs = zip(np.flatnonzero(change > 0), np.flatnonzero(change < 0))
            found += [(line[a : b + 1], False) for a, b in runs]
        return [(self.period.unroll(line, window.about), whole) for line, whole in found]

    def _windows(self, reach: float) -> tuple[float, int]:
        """Room (mm of u) beside a window, and the number of windows."""
        if math.isinf(self.period.apex):
            return 1.1 * reach, 1
        way = abs(self.period.apex - self.levels[1])
        # a place that is `reach` inside is as far above the border next to the apex, and that border hides what is beyond
        margin = 1.1 * math.asin(reach / (way + reach))
        count = max(1, math.ceil(self.period.turn / max(HALF_TURN - 2.0 * margin, 0.2)))
        return margin * abs(self.period.apex), count


def parts(
    rounds: Sequence[tuple[Array, int]], closed: Sequence[Array], period: Period
) -> tuple[Strip | Region, ...]:
    """Strips and plane regions that borders bound: (u, v) of those that go round with their sense, and of closed ones."""
    begun = [_begun(ring, sense, period.around) for ring, sense in rounds]
    order = sorted(begun, key=lambda item: float(item[0][:, 1].mean()))
    holes = [ring for ring in closed if doubled_area(ring) < 0.0]
    outers = [ring for ring in closed if doubled_area(ring) > 0.0]
    found: list[Strip | Region] = []
    free = list(holes)
    for (lower, sense), (upper, other) in zip(order, order[1:]):
        if sense != 1 or other != -1:
            continue
        strip = Strip(period, lower, upper)
        middle = [hole for hole in free if _within(strip, hole)]
        free = [hole for hole in free if not any(hole is one for one in middle)]
        found.append(Strip(period, lower, upper, tuple(middle)))
    for outer in outers:
        shifted = [hole + np.array([k * period.around, 0.0]) for hole in free for k in (-1, 0, 1)]
        inside = [hole for hole in shifted if winding((outer,), hole[:1])[0] > 0]
        about = np.array([np.round(outer[:, 0].mean() / period.around) * period.around, 0.0])
        sheet = 0.5 * float(outer[:, 0].min() + outer[:, 0].max()) - float(about[0])
        unrolled = regions([period.unroll(ring - about) for ring in (outer, *inside)])
        found += [replace(region, sheet=sheet) for region in unrolled]
    return tuple(found)


def strips(loops: Sequence[tuple[Array, int]], period: Period) -> tuple[Strip | Region, ...]:
    """Strips and regions of the loops of a layer: points (n, 2) laid flat within one turn, and how often each goes round."""
    rounds, closed, turn = [], [], period.around
    for flat, turns in loops:
        uv = period.unrolled(flat)
        step = np.diff(uv[:, 0], prepend=uv[:1, 0])
        uv[:, 0] -= turn * np.cumsum(np.round(step / turn))
        if turns:
            rounds.append((uv, turns))
        else:
            closed.append(uv)
    return parts(rounds, closed, period)


def _begun(ring: Array, sense: int, turn: float) -> tuple[Array, int]:
    """A border that goes round, begun where it leaves the generatrix half a turn from 0."""
    past = np.remainder(sense * ring[:, 0] + 0.5 * turn + MEETING * turn, turn)
    first = int(np.argmin(past))
    ring = np.vstack([ring[first:], ring[:first] + np.array([sense * turn, 0.0])])
    ring[:, 0] -= turn * np.round((ring[0, 0] + sense * 0.5 * turn) / turn)
    return ring, sense


def _within(strip: Strip, hole: Array) -> bool:
    u, near = float(hole[0, 0]), 0.25 * strip.period.around
    return any(part.contains(hole[:1])[0] for part in strip.between(u - near, u + near))


def _box(low: float, high: float, bottom: float, top: float) -> Array:
    margin = 1.0 + top - bottom
    return np.array(
        [[low, bottom - margin], [high, bottom - margin], [high, top + margin], [low, top + margin]]
    )


def _boxed(region: Region, low: float, high: float) -> list[Array]:
    """The rings of what of a region lies between two generatrices."""
    v = region.borders()[0][:, 1]
    box = regions([_box(low, high, float(v.min()), float(v.max()))])
    return [ring for part in region.common(box, every_point=True) for ring in part.borders()]
