# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fill strips around a hub with lines that run around the hub or along it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.curves.plane_curve import dense
from ..geometry.regions.region import Region, regions
from ..geometry.regions.several import grow_regions
from ..geometry.regions.strip import Strip
from ..geometry.step_count import round_down, round_up, step_count
from ..types import Array, Mask
from .centre import Beads, PlaneCurve, contours_of, long_enough, strip_closing
from .sparse import levels_between

# in spacings, distance between samples along a line; bisection steps to locate the end of a line
PROBE, HALVES = 0.1, 10


class _Frame(NamedTuple):
    """Space for lines.

    curves: contours around the lines. ends: regions that the lines cross. inset: distance of the
    outermost lines from the borders, mm.
    """

    curves: list[PlaneCurve]
    ends: tuple[Strip | Region, ...]
    inset: float


def _frame(inner: tuple[Strip | Region, ...], beads: Beads, walls: int) -> _Frame:
    """Return the space for lines inside the walls, as `sparse.frame`."""
    half, error = 0.5 * beads.spacing, beads.chord_error
    if not walls:
        return _Frame([], inner, beads.inset)
    curves, wall = contours_of(inner, beads, 0), 1
    while wall < walls and (further := grow_regions(inner, -2.0 * half, error)):
        curves, inner, wall = curves + contours_of(further, beads, wall), further, wall + 1
    ends = grow_regions(inner, -beads.end_inset, error)
    return _Frame(curves, ends, beads.inset + 2.0 * half * wall)


def lines_round(
    strip: Strip, inner: tuple[Strip | Region, ...], beads: Beads, walls: int, density: float
) -> list[PlaneCurve]:
    """Fill a strip with lines around the hub, spaced as in `sparse.lines`.

    The outermost lines are half a bead inside the extreme heights of the borders. A line is closed
    unless it leaves the strip.

    Parameters
    ----------
    strip : Strip
        The region around the hub.
    inner : tuple of Strip or Region
        The strip shrunk by `beads.inset`, mm; bead centrelines stay inside.
    beads : Beads
        Spacing, width, gap and chord error, mm.
    walls : int
        Number of contours around the lines.
    density : float
        Fraction of the area to fill; below 1 the distance between lines is spacing / density.

    Returns
    -------
    list of PlaneCurve
        Contours, lines and, at density 1, beads that close gaps, on the unrolled plane.
    """
    framed = _frame(inner, beads, walls)
    low, high = strip.levels
    turn, within = strip.period.u_period, _Inside(strip, framed.ends)
    curves = list(framed.curves)
    for row, level in enumerate(_levels(low + framed.inset, high - framed.inset, beads, density)):
        count = strip.period.points_round(level, beads.chord_error, beads.spacing)
        u = -0.5 * turn + turn / count * np.arange(count + 1)
        inside = within.contains(np.stack([u, np.full(len(u), level)], axis=1))
        for a, b in _runs(inside[:-1]):
            uv = np.stack([u[0] + turn / count * np.arange(a, b), np.full(b - a, level)], axis=1)
            points, is_closed = strip.period.from_uv(uv), b - a == count
            back = (row % 2 == 1) if not is_closed else beads.clockwise
            sense = 0 if not is_closed else (-1 if back else 1)
            sheet = float(uv[:, 0].mean())
            curves.append(
                PlaneCurve(points[::-1] if back else points, is_closed, "line", walls, sense, sheet)
            )
    curves = long_enough(curves, beads.shortest)
    return curves + (
        strip_closing(strip, curves, beads, walls, "closing") if density == 1.0 else []
    )


def lines_along(
    strip: Strip, inner: tuple[Strip | Region, ...], beads: Beads, walls: int, density: float
) -> list[PlaneCurve]:
    """Fill a strip with lines along generatrices, evenly distributed around the hub.

    The distance between lines is at most the spacing. On a cone the lines converge towards the
    apex, so this limit applies to the end farthest from the apex. Every second line is reversed.

    Parameters
    ----------
    strip : Strip
        The region around the hub.
    inner : tuple of Strip or Region
        The strip shrunk by `beads.inset`, mm; bead centrelines stay inside.
    beads : Beads
        Spacing, width, gap and chord error, mm.
    walls : int
        Number of contours around the lines.
    density : float
        Fraction of the area to fill; below 1 the distance between lines is spacing / density.

    Returns
    -------
    list of PlaneCurve
        Contours, lines and, at density 1, beads that close gaps, on the unrolled plane.
    """
    framed = _frame(inner, beads, walls)
    turn, interior = strip.period.u_period, _Inside(strip, framed.ends)
    pitch = beads.spacing / density
    count = step_count(turn * _stretch(strip) - 0.01 * turn, pitch)
    low, high = strip.levels
    v: Array = np.linspace(low, high, step_count(high - low, PROBE * beads.spacing, 2))
    u: Array = np.asarray(-0.5 * turn + turn / count * (np.arange(count) + 0.5), dtype=np.float64)
    inside = interior.contains(
        np.stack(np.broadcast_arrays(u[:, None], v), axis=-1).reshape(-1, 2)
    ).reshape(count, -1)
    runs = [
        (number, a, b) for number in range(count) for a, b in _runs(inside[number], closed=False)
    ]
    line, start, past = np.array(runs, dtype=np.intp).reshape(-1, 3).T
    bottom, top = (
        interior.border(u[line], v[within], v[np.clip(beyond, 0, len(v) - 1)])
        for within, beyond in ((start, start - 1), (past - 1, past))
    )
    curves = list(framed.curves)
    for number, *levels in zip(line.tolist(), bottom, top):
        ends = strip.period.from_uv(np.stack([np.full(2, u[number]), levels], axis=1))
        curves.append(PlaneCurve(ends[::-1] if number % 2 else ends, False, "line", walls))
    curves = long_enough(curves, beads.shortest)
    return curves + (
        strip_closing(strip, curves, beads, walls, "closing") if density == 1.0 else []
    )


def _levels(low: float, high: float, beads: Beads, density: float) -> Array:
    """Return the heights of lines.

    At density 1 the lines are evenly spaced between the borders. Below 1 the density sets the
    pitch, and all layers have lines at the same heights.
    """
    if density == 1.0:
        return levels_between(low, high, beads)
    pitch = beads.spacing / density
    return np.asarray(pitch * np.arange(round_up(low / pitch), round_down(high / pitch) + 1))


class _Inside:
    """Regions of a strip with a fast test for points inside."""

    def __init__(self, strip: Strip, regions_: Sequence[Strip | Region]) -> None:
        turn = strip.period.u_period
        reach = 0.75 * turn
        self.unrolled = [
            section
            for region in regions_
            if isinstance(region, Strip)
            for section in region.between(-reach, reach)
        ]
        for region in (region for region in regions_ if isinstance(region, Region)):
            borders = [
                strip.period.unwrap_curve(dense(border, 0.001 * turn), region.sheet)
                for border in region.borders()
            ]
            for hole in borders[1:] if math.isfinite(strip.period.full_turn) else ():
                offset = 0.5 * (borders[0][:, 0].min() + borders[0][:, 0].max()) - hole[0, 0]
                hole[:, 0] += strip.period.full_turn * np.round(offset / strip.period.full_turn)
            for k in (-1, 0, 1):
                self.unrolled += regions([uv + np.array([k * turn, 0.0]) for uv in borders])

    def contains(self, uv: Array) -> Mask:
        """Return a mask of the points (u, v) (n, 2) inside any region; u is within one turn."""
        inside = np.zeros(len(uv), dtype=bool)
        for region in self.unrolled:
            inside |= region.contains(uv)
        return inside

    def border(self, u: Array, within: Array, beyond: Array) -> Array:
        """Bisect the heights (n,) at which generatrices leave the regions; return the inner bounds.

        within, beyond: heights (n,) inside and outside.
        """
        for _ in range(HALVES):
            middle = 0.5 * (within + beyond)
            inside = self.contains(np.stack([u, middle], axis=1))
            within, beyond = np.where(inside, middle, within), np.where(inside, beyond, middle)
        return within


def _runs(inside: Mask, closed: bool = True) -> list[tuple[int, int]]:
    """Return start and stop of each run of at least two members.

    In a closed list, a run across the end stops beyond the length of the list.
    """
    count = len(inside)
    if inside.all():
        return [(0, count)]
    change = np.diff(np.r_[False, inside, False].astype(int))
    runs = [
        (int(a), int(b)) for a, b in zip(np.flatnonzero(change > 0), np.flatnonzero(change < 0))
    ]
    if closed and len(runs) > 1 and runs[0][0] == 0 and runs[-1][1] == count:
        runs = [*runs[1:-1], (runs[-1][0], count + runs[0][1])]
    return [run for run in runs if run[1] - run[0] > 1]


def _stretch(strip: Strip) -> float:
    """Return the ratio of the longest turn around the hub to the turn at the reference height."""
    return (
        1.0
        if math.isinf(strip.period.apex)
        else (strip.period.apex - strip.levels[0]) / abs(strip.period.apex)
    )
