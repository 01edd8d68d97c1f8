# SPDX-License-Identifier: LGPL-2.1-or-later
"""Regions that surround a hub: unrolled, they repeat without end under an isometry of the plane.

The isometry is a translation along x for a cylinder, and a rotation about the apex for a cone. A
strip is stored in (u, v): u runs around the hub (mm at a reference distance from the apex) over any
number of turns, v up along the surface. Parallel curves are computed on the plane, in windows
narrower than half a turn, with enough margin that the window ends have no effect. The results are
cut at the window ends, where adjacent windows agree, and chained again.
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
from .region import Region, regions

TOLERANCE_SHARE = 1e-7  # of the period; tolerance of points on a cut


def chain_windows(
    window_rings: Sequence[Sequence[Array]], cuts: Array
) -> tuple[list[tuple[Array, int]], list[Array]]:
    """Chain the rings of windows across the cuts between them.

    Parameters
    ----------
    window_rings : sequence of sequence of (n, 2) array
        Closed rings in (u, v) of each window, mm, cut at the window ends.
    cuts : (k + 1,) array
        u at the ends of k windows, ascending over one turn, mm.

    Returns
    -------
    rounds : list of tuple of (n, 2) array and int
        Rings around the hub, in (u, v), mm, with their signed number of turns.
    closed : list of (n, 2) array
        Closed rings in (u, v), mm.
    """
    turn = float(cuts[-1] - cuts[0])
    tolerance, count = TOLERANCE_SHARE * turn, len(cuts) - 1
    runs: list[Array] = []
    closed: list[Array] = []
    starts: list[tuple[int, float, int]] = []
    ends: list[tuple[int, float, int]] = []
    for window, rings in enumerate(window_rings):
        for ring in rings:
            side = np.where(np.abs(ring[:, 0] - cuts[window]) < tolerance, 1, 0)
            side = np.where(np.abs(ring[:, 0] - cuts[window + 1]) < tolerance, 2, side)
            on_cut = (side > 0) & (side == np.roll(side, -1))
            if not on_cut.any():
                closed.append(ring)
                continue
            first_cut = int(np.flatnonzero(on_cut)[0]) + 1
            ring, side, on_cut = (
                np.roll(column, -first_cut, axis=0) for column in (ring, side, on_cut)
            )
            borders = np.r_[-1, np.flatnonzero(on_cut)]
            for a, b in zip(borders + 1, borders[1:]):
                if b > a:
                    starts.append(
                        ((window + int(side[a] == 2)) % count, float(ring[a, 1]), len(runs))
                    )
                    ends.append(
                        ((window + int(side[b] == 2)) % count, float(ring[b, 1]), len(runs))
                    )
                    runs.append(ring[a : b + 1])
    successor = {}
    for (_, _, run), (_, _, following) in zip(sorted(ends), sorted(starts)):
        successor[run] = following
    rounds = []
    unused = set(range(len(runs)))
    while unused:
        run = min(unused)
        points: list[Array] = []
        while run in unused:
            unused.remove(run)
            run_points = runs[run]
            if points:
                shift = round((points[-1][-1, 0] - run_points[0, 0]) / turn) * turn
                run_points = run_points + np.array([shift, 0.0])
                points[-1] = points[-1][:-1]
            points.append(run_points)
            run = successor[run]
        loop = np.vstack(points)
        turns = round(float(loop[-1, 0] - loop[0, 0]) / turn)
        loop = loop[:-1]
        if turns:
            rounds.append((loop, turns))
        else:
            closed.append(loop)
    return rounds, closed


HALF_TURN = 2.6  # rad; maximum width of a window with its margins


@dataclass(frozen=True)
class Period:
    """The repetition of an unrolled hub.

    turn: one unrolled turn around the hub, mm along x or, with an apex, rad about the point
    (0, apex).
    """

    turn: float
    apex: float = math.inf

    @property
    def u_period(self) -> float:
        """Period of u, mm."""
        return self.turn if math.isinf(self.apex) else self.turn * abs(self.apex)

    def to_uv(self, flat: Array) -> Array:
        """Return (u, v) of points of the plane.

        Parameters
        ----------
        flat : (n, 2) array
            Points of the unrolled plane, mm.

        Returns
        -------
        (n, 2) array
            (u, v), mm; with an apex, u is within half a turn of the plane about 0.
        """
        if math.isinf(self.apex):
            return flat.copy()
        x, y = columns(flat)
        to_apex = self.apex - y
        return np.stack(
            [np.arctan2(x, to_apex) * abs(self.apex), self.apex - np.hypot(x, to_apex)], axis=1
        )

    @property
    def full_turn(self) -> float:
        """Period of u on the plane, mm; more than a turn around the hub."""
        return math.inf if math.isinf(self.apex) else 2.0 * math.pi * abs(self.apex)

    def unwrap_curve(self, flat: Array, sheet: float = 0.0, turns: int = 0) -> Array:
        """Return (u, v) along a curve, with u unwrapped where the curve passes behind the apex.

        Parameters
        ----------
        flat : (n, 2) array
            The curve on the unrolled plane, mm.
        sheet : float, optional
            Approximate mean of u, within half a turn of the plane, mm.
        turns : int, optional
            Number of turns of the curve around the hub; if not 0, its start is repeated at the
            end, moved by these turns.

        Returns
        -------
        (n, 2) or (n + 1, 2) array
            (u, v), mm; one more point if the curve goes around the hub.
        """
        uv = self.to_uv(flat)
        if not math.isinf(self.apex):
            uv[:, 0] = np.unwrap(uv[:, 0], period=self.full_turn)
            uv[:, 0] -= self.full_turn * np.round((uv[:, 0].mean() - sheet) / self.full_turn)
        return np.vstack([uv, uv[:1] + np.array([turns * self.u_period, 0.0])]) if turns else uv

    def from_uv(self, uv: Array, about: float = 0.0) -> Array:
        """Return points of the plane for (u, v).

        Parameters
        ----------
        uv : (n, 2) array
            (u, v), mm.
        about : float, optional
            u that is unrolled to x = 0, mm.

        Returns
        -------
        (n, 2) array
            Points of the unrolled plane, mm.
        """
        if math.isinf(self.apex):
            return np.asarray(uv - np.array([about, 0.0]))
        phi, apex_distance = (uv[:, 0] - about) / abs(self.apex), self.apex - uv[:, 1]
        return np.stack(
            [apex_distance * np.sin(phi), self.apex - apex_distance * np.cos(phi)], axis=1
        )

    def move_turns(self, flat: Array, turns: int) -> Array:
        """Move points of the plane by whole turns around the hub.

        Parameters
        ----------
        flat : (n, 2) array
            Points of the unrolled plane, mm.
        turns : int
            Turns, in the sense of u.

        Returns
        -------
        (n, 2) array
            Moved points, mm.
        """
        if math.isinf(self.apex):
            return np.asarray(flat + np.array([turns * self.turn, 0.0]))
        angle, apex = turns * self.turn, np.array([0.0, self.apex])
        cos, sin = math.cos(angle), math.sin(angle)
        offset = flat - apex
        turned = np.stack(
            [offset[:, 0] * cos - offset[:, 1] * sin, offset[:, 0] * sin + offset[:, 1] * cos],
            axis=1,
        )
        return np.asarray(turned + apex)

    def points_round(self, v: float, chord_error: float, least_radius: float) -> int:
        """Return the number of points that a line once around the hub needs on the plane.

        Parameters
        ----------
        v : float
            v of the line, mm.
        chord_error : float
            Chord error of the line, mm.
        least_radius : float
            Minimum radius to assume near the apex, mm.

        Returns
        -------
        int
            Number of points, at least 24.
        """
        radius = 1e6 if math.isinf(self.apex) else max(abs(self.apex - v), least_radius)
        return step_count(self.u_period, math.sqrt(8.0 * chord_error * radius), 24)

    def distance_past(self, flat: Array, u: float) -> Array:
        """Return the distances of points past a generatrix.

        Parameters
        ----------
        flat : (n, 2) array
            Points of the unrolled plane, mm.
        u : float
            u of the generatrix, mm; less than a quarter turn from 0.

        Returns
        -------
        (n,) array
            Distances in the sense of u, mm.
        """
        if math.isinf(self.apex):
            return np.asarray(flat[:, 0] - u)
        phi = u / abs(self.apex)
        return np.asarray(flat[:, 0] * math.cos(phi) - (self.apex - flat[:, 1]) * math.sin(phi))


class Window(NamedTuple):
    """Part of a turn, in mm of u.

    about: centre. low, high: range. margin: additional range on both sides.
    """

    about: float
    low: float
    high: float
    margin: float


@dataclass(frozen=True, eq=False)
class Strip:
    """A region around the hub between two borders, with holes; all in (u, v).

    lower: (n, 2) runs forwards by one period. upper: (m, 2) runs backwards by one period, so the
    material is to the left of both. Neither repeats its first point a period later. holes: closed,
    clockwise, in any turn.
    """

    period: Period
    lower: Array
    upper: Array
    holes: tuple[Array, ...] = ()

    def borders(self) -> tuple[tuple[Array, int], ...]:
        """Return the unrolled borders and their numbers of turns.

        Returns
        -------
        tuple of tuple of (n, 2) array and int
            Points of the unrolled plane, mm, and turns: 1, -1, and 0 for holes.
        """
        loops = [(self.lower, 1), (self.upper, -1), *((hole, 0) for hole in self.holes)]
        return tuple((self.period.from_uv(points), turns) for points, turns in loops)

    @cached_property
    def levels(self) -> tuple[float, float]:
        """Lowest and highest v, mm."""
        return float(self.lower[:, 1].min()), float(self.upper[:, 1].max())

    def grown(self, distance: float, chord_error: float) -> tuple[Strip | Region, ...]:
        """Grow the strip, as `Region.grown`; a part that does not surround the hub is a region."""
        return self.apply(lambda region: region.grown(distance, chord_error), abs(distance))

    def apply(
        self, operation: Callable[[Region], Sequence[Region]], reach: float
    ) -> tuple[Strip | Region, ...]:
        """Apply an operation with a range of at most `reach` mm; return strips and regions."""
        windows = self.windows(reach)
        window_rings: list[list[Array]] = []
        for window in windows:
            rings_found: list[Array] = []
            for result in (
                result
                for region in self.flat(window, with_margin=True)
                for result in operation(region)
            ):
                uv = [self._cut(ring, window) for ring in result.borders()]
                rings_found += [
                    ring
                    for inner in regions(uv, every_point=True)
                    for ring in _cut_rings(inner, window.low, window.high)
                ]
            window_rings.append(rings_found)
        return assemble_regions(
            *chain_windows(
                window_rings, np.array([windows[0].low, *(window.high for window in windows)])
            ),
            self.period,
        )

    def between(self, low: float, high: float) -> tuple[Region, ...]:
        """Return the strip from u = low to u = high as regions in (u, v)."""
        turn = self.period.u_period
        lower, upper = self._repeated(self.lower, low, high), self._repeated(self.upper, low, high)
        loops = [np.vstack([lower, upper])]
        for hole in self.holes:
            first_turn = math.floor((low - hole[:, 0].max()) / turn)
            last_turn = math.ceil((high - hole[:, 0].min()) / turn)
            loops += [hole + np.array([k * turn, 0.0]) for k in range(first_turn, last_turn + 1)]
        box = _box(low, high, *self.levels)
        return tuple(
            piece_region
            for region in regions(loops, every_point=True)
            for piece_region in region.common(regions([box]), every_point=True)
        )

    def flat(self, window: Window, with_margin: bool = False) -> list[Region]:
        """Return the strip in a window as regions unrolled about the centre of the window."""
        margin = window.margin if with_margin else 0.0
        return [
            unrolled_region
            for region in self.between(window.low - margin, window.high + margin)
            for unrolled_region in regions(
                [self.period.from_uv(ring, window.about) for ring in region.borders()]
            )
        ]

    def moved_back(self, window: Window, flat: Array) -> tuple[Array, float]:
        """Convert points unrolled about the centre of a window to points unrolled about 0.

        Parameters
        ----------
        window : Window
            The window.
        flat : (n, 2) array
            Points unrolled about the window centre, mm.

        Returns
        -------
        points : (n, 2) array
            Points unrolled about 0, mm.
        sheet : float
            Mean u of the points, mm.
        """
        uv = self.period.to_uv(flat) + np.array([window.about, 0.0])
        return self.period.from_uv(uv), float(uv[:, 0].mean())

    def _repeated(self, border: Array, low: float, high: float) -> Array:
        turn = self.period.u_period
        sense = 1 if border is self.lower else -1
        first_turn = math.floor((low - border[:, 0].max()) / turn) - 2
        last_turn = math.ceil((high - border[:, 0].min()) / turn) + 2
        copies = [border + np.array([k * turn, 0.0]) for k in range(first_turn, last_turn + 1)][
            ::sense
        ]
        exact = np.vstack(copies)
        return self._insert_cuts(exact, (low, high), closed=False)

    def _insert_cuts(self, uv: Array, cuts: Sequence[float], closed: bool) -> Array:
        """Insert the crossings of a line in (u, v) with generatrices.

        Edges of the line are straight when unrolled.
        """
        for u in cuts:
            following = np.roll(uv, -1, axis=0)
            k = np.flatnonzero((uv[:, 0] < u) != (following[:, 0] < u))
            k = k if closed else k[k < len(uv) - 1]
            a, b = self.period.from_uv(uv[k], u), self.period.from_uv(following[k], u)
            fa, fb = self.period.distance_past(a, 0.0), self.period.distance_past(b, 0.0)
            crossing = self.period.to_uv(a + (fa / (fa - fb))[:, None] * (b - a))
            crossing[:, 0] = u
            uv = np.insert(uv, k + 1, crossing, axis=0)
        return uv

    def _cut(self, flat: Array, window: Window) -> Array:
        """Convert a ring unrolled about a window centre to (u, v); add points at window ends."""
        ends = window.low - window.about, window.high - window.about
        return np.asarray(
            self._insert_cuts(self.period.to_uv(flat), ends, closed=True)
            + np.array([window.about, 0.0])
        )

    def windows(self, reach: float) -> tuple[Window, ...]:
        """Return windows over one turn, with margins for operations with a range of `reach` mm."""
        margin, count = self._windows(reach)
        cuts = np.linspace(
            -0.5 * self.period.u_period, 0.5 * self.period.u_period, count + 1
        ).tolist()
        return tuple(
            Window(0.5 * (low + high), low, high, margin) for low, high in zip(cuts, cuts[1:])
        )

    def pane(self, window: Window) -> tuple[Region, ...]:
        """Return a window without its margin as regions unrolled about its centre.

        The regions extend slightly beyond the strip in v.
        """
        u = np.linspace(window.low, window.high, 17)
        bottom, top = self.levels
        margin = 0.05 * (window.high - window.low) + 1.0
        below, above = (
            np.stack([u, np.full(17, bottom - margin)], axis=1),
            np.stack([u, np.full(17, top + margin)], axis=1),
        )
        return regions([self.period.from_uv(np.vstack([below, above[::-1]]), window.about)])

    def near(self, window: Window, uv: Array, closed: bool) -> list[tuple[Array, bool]]:
        """Return the pieces of a curve inside a window and its margin, from all turns.

        Parameters
        ----------
        window : Window
            The window.
        uv : (n, 2) array
            The curve in (u, v), mm.
        closed : bool
            Whether the curve is closed on the plane.

        Returns
        -------
        list of tuple of (m, 2) array and bool
            Points unrolled about the window centre, mm, and whether they are closed.
        """
        turn = self.period.u_period
        low, high = window.low - window.margin, window.high + window.margin
        lines: list[tuple[Array, bool]] = []
        first_turn, last_turn = (
            np.ceil((low - uv[:, 0].max()) / turn),
            np.floor((high - uv[:, 0].min()) / turn),
        )
        for k in range(int(first_turn), int(last_turn) + 1):
            line = uv + np.array([k * turn, 0.0])
            if closed:
                lines.append((line, True))
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
            lines += [(line[a : b + 1], False) for a, b in runs]
        return [(self.period.from_uv(line, window.about), is_closed) for line, is_closed in lines]

    def _windows(self, reach: float) -> tuple[float, int]:
        """Return the margin (mm of u) of a window, and the number of windows."""
        if math.isinf(self.period.apex):
            return 1.1 * reach, 1
        apex_distance = abs(self.period.apex - self.levels[1])
        # widest angle: a circle of radius `reach` that touches the border nearest to the apex
        margin = 1.1 * math.asin(reach / (apex_distance + reach))
        count = max(1, math.ceil(self.period.turn / max(HALF_TURN - 2.0 * margin, 0.2)))
        return margin * abs(self.period.apex), count


def assemble_regions(
    rounds: Sequence[tuple[Array, int]], closed: Sequence[Array], period: Period
) -> tuple[Strip | Region, ...]:
    """Assemble strips and plane regions from borders.

    Parameters
    ----------
    rounds : sequence of tuple of (n, 2) array and int
        Borders around the hub, in (u, v), mm, and their sense: 1 or -1.
    closed : sequence of (n, 2) array
        Closed borders in (u, v), mm; clockwise borders are holes.
    period : Period
        Period of the unrolled hub.

    Returns
    -------
    tuple of Strip or Region
        Strips in (u, v), by rising v, then regions on the unrolled plane.
    """
    borders = [_start_at_cut(ring, sense, period.u_period) for ring, sense in rounds]
    order = sorted(borders, key=lambda item: float(item[0][:, 1].mean()))
    holes = [ring for ring in closed if doubled_area(ring) < 0.0]
    outers = [ring for ring in closed if doubled_area(ring) > 0.0]
    results: list[Strip | Region] = []
    free = list(holes)
    for (lower, sense), (upper, upper_sense) in zip(order, order[1:]):
        if sense != 1 or upper_sense != -1:
            continue
        strip = Strip(period, lower, upper)
        middle = [hole for hole in free if _is_inside(strip, hole)]
        free = [hole for hole in free if not any(hole is hole_inside for hole_inside in middle)]
        results.append(Strip(period, lower, upper, tuple(middle)))
    for outer in outers:
        shifted = [hole + np.array([k * period.u_period, 0.0]) for hole in free for k in (-1, 0, 1)]
        inside = [hole for hole in shifted if winding((outer,), hole[:1])[0] > 0]
        about = np.array([np.round(outer[:, 0].mean() / period.u_period) * period.u_period, 0.0])
        sheet = 0.5 * float(outer[:, 0].min() + outer[:, 0].max()) - float(about[0])
        unrolled = regions([period.from_uv(ring - about) for ring in (outer, *inside)])
        results += [replace(region, sheet=sheet) for region in unrolled]
    return tuple(results)


def strips(loops: Sequence[tuple[Array, int]], period: Period) -> tuple[Strip | Region, ...]:
    """Build strips and regions from the loops of a layer.

    Parameters
    ----------
    loops : sequence of tuple of (n, 2) array and int
        Points unrolled within one turn, mm, and number of turns of each loop.
    period : Period
        Period of the unrolled hub.

    Returns
    -------
    tuple of Strip or Region
        Strips and regions, as from `assemble_regions`.
    """
    rounds, closed, turn = [], [], period.u_period
    for flat, turns in loops:
        uv = period.to_uv(flat)
        step = np.diff(uv[:, 0], prepend=uv[:1, 0])
        uv[:, 0] -= turn * np.cumsum(np.round(step / turn))
        if turns:
            rounds.append((uv, turns))
        else:
            closed.append(uv)
    return assemble_regions(rounds, closed, period)


def _start_at_cut(ring: Array, sense: int, turn: float) -> tuple[Array, int]:
    """Start a border around the hub where it leaves the generatrix half a turn from 0."""
    past = np.remainder(sense * ring[:, 0] + 0.5 * turn + TOLERANCE_SHARE * turn, turn)
    start = int(np.argmin(past))
    ring = np.vstack([ring[start:], ring[:start] + np.array([sense * turn, 0.0])])
    ring[:, 0] -= turn * np.round((ring[0, 0] + sense * 0.5 * turn) / turn)
    return ring, sense


def _is_inside(strip: Strip, hole: Array) -> bool:
    u, half_width = float(hole[0, 0]), 0.25 * strip.period.u_period
    return any(
        region.contains(hole[:1])[0] for region in strip.between(u - half_width, u + half_width)
    )


def _box(low: float, high: float, bottom: float, top: float) -> Array:
    margin = 1.0 + top - bottom
    return np.array(
        [[low, bottom - margin], [high, bottom - margin], [high, top + margin], [low, top + margin]]
    )


def _cut_rings(region: Region, low: float, high: float) -> list[Array]:
    """Cut a region at two generatrices and return the rings between them."""
    v = region.borders()[0][:, 1]
    box = regions([_box(low, high, float(v.min()), float(v.max()))])
    return [
        ring
        for region_between in region.common(box, every_point=True)
        for ring in region_between.borders()
    ]
