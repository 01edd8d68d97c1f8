# SPDX-License-Identifier: LGPL-2.1-or-later
"""Values along a bead that jump at corners, spread over stretches about them: means under a trapezoid, exact.

A jump becomes a ramp with rounded ends, symmetric about its place, as long as the stretch given; elsewhere nothing changes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...geometry.step_count import round_down
from ...types import Array, Index

SLOPE = 0.75  # of half a stretch: the wider of the two boxes that make the trapezoid; a jump's ramp is steepest over it
BLOCK = 128  # places worked on at once: their integrals begin nearby and keep their digits
PARTS = 6  # points on half a stretch
LEAST = 0.05  # mm between points added


class Line(NamedTuple):
    """Values (k, c) that run straight between places (k,) mm, rising; beyond the ends they stay as they are there."""

    at: Array
    values: Array

    def __call__(self, s: Array) -> Array:
        """The values (n, c) at places (n,)."""
        found: Array = np.stack(
            [np.interp(s, self.at, column) for column in self.values.T], axis=-1
        )
        return found

    def mirrored(self, length: float) -> Line:
        """Of an open bead gone on at either end as if it came back: then what bends next to an end counts for little."""
        at = np.concatenate([-self.at[::-1], self.at, 2.0 * length - self.at[::-1]])
        values = np.vstack([self.values[::-1], self.values, self.values[::-1]])
        apart = np.r_[True, np.diff(at) > 1e-9]
        return Line(at[apart], values[apart])


def means(line: Line, s: Array, half: Array) -> Array:
    """Means (n, c) of the values over s - half .. s + half (n,), the values themselves where half is 0."""
    found = line(s)
    wide = np.flatnonzero(half > 1e-6)
    for some in np.split(wide, np.arange(BLOCK, len(wide), BLOCK)) if len(wide) else ():
        found[some] = _means(line, s[some], half[some])
    return found


def _means(line: Line, s: Array, half: Array) -> Array:
    low, high = float((s - half).min()), float((s + half).max())
    inner = line.at[
        np.searchsorted(line.at, low, side="right") : np.searchsorted(line.at, high, side="left")
    ]
    x = np.r_[low, inner, high]
    y = line(x)
    first = y[0].copy()
    y = y - first
    dx = np.diff(x)[:, None]
    slope = np.where(dx > 1e-12, np.diff(y, axis=0) / np.maximum(dx, 1e-12), 0.0)
    once = np.vstack([np.zeros(y.shape[1]), np.cumsum(0.5 * (y[1:] + y[:-1]) * dx, axis=0)])
    step = once[:-1] * dx + y[:-1] * dx**2 / 2.0 + slope * dx**3 / 6.0
    twice = np.vstack([np.zeros(y.shape[1]), np.cumsum(step, axis=0)])

    def integral(at: Array) -> Array:
        i = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(x) - 2)
        t = (at - x[i])[:, None]
        value: Array = twice[i] + t * (once[i] + t * (y[i] / 2.0 + t * slope[i] / 6.0))
        return value

    a, b = SLOPE * half, (1.0 - SLOPE) * half
    total = integral(s + a + b) - integral(s + a - b) - integral(s - a + b) + integral(s - a - b)
    mean: Array = first + total / (4.0 * a * b)[:, None]
    return mean


@dataclass
class Zones:
    """Where values change too fast, low .. high (z,) mm, and half the stretch (z,) mm that each is spread over.

    length: of a closed bead, on which zones repeat; None for an open one.
    """

    low: Array
    high: Array
    half: Array
    length: float | None

    def _copies(self) -> tuple[float, ...]:
        return (0.0,) if self.length is None else (-self.length, 0.0, self.length)

    def stretches(self, s: Array) -> Array:
        """Half the stretch (n,) at places (n,), rising: the same as far as its ramp goes, then less."""
        half = np.zeros(len(s))
        moved = np.array(self._copies())[:, None]
        low, high = self.low + moved, self.high + moved
        first, last = (
            np.searchsorted(s, low - 2.0 * self.half),
            np.searchsorted(s, high + 2.0 * self.half),
        )
        for copy, zone in np.argwhere(first < last).tolist():
            some, most = slice(first[copy, zone], last[copy, zone]), self.half[zone]
            here = s[some]
            away = (
                np.maximum(
                    np.maximum(low[copy, zone] - here, here - self.high[zone] - moved[copy, 0]), 0.0
                )
                / most
            )
            share = 0.5 + 0.5 * np.cos(np.pi * np.minimum(np.maximum(away - 1.0, 0.0), 1.0))
            half[some] = np.maximum(half[some], most * share)
        return half

    def places(self, s: Array) -> Array:
        """Places to add to those of a bead (n,), so that the ramps are followed."""
        parts = np.arange(-PARTS, PARTS + 1) / PARTS
        wanted = []
        for low, high, half in zip(self.low.tolist(), self.high.tolist(), self.half.tolist()):
            ends = (0.5 * (low + high),) if high - low < 0.5 * half else (low, high)
            count = max(1, min(PARTS, round_down(half / LEAST)))
            ramp = parts if count == PARTS else np.arange(-count, count + 1) / count
            reach = half + 0.5 * (high - low) if len(ends) == 1 else half
            wanted += [end + reach * ramp for end in ends]
        if not wanted:
            return np.zeros(0)
        found = np.concatenate([np.concatenate(wanted) + moved for moved in self._copies()])
        found = np.unique(found[(found > s[0]) & (found < s[-1])])
        kept: list[float] = []
        for place in found.tolist():
            if not kept or place - kept[-1] >= LEAST:
                kept.append(place)
        chosen: Array = np.array(kept)
        after = np.clip(np.searchsorted(s, chosen), 1, len(s) - 1)
        free: Array = chosen[np.minimum(chosen - s[after - 1], s[after] - chosen) >= 0.5 * LEAST]
        return free

    def widened(self, places: Array, factor: float) -> Zones:
        """With longer stretches at the zones next to places (n,); a place that none reaches becomes one."""
        low, high, half, lost = self.low, self.high, self.half.copy(), places
        if len(low):
            best, away = self._nearest(places)
            reached = away < 3.0 * half[best] + LEAST
            half[np.unique(best[reached])] *= factor
            lost = places[~reached]
        if len(lost):
            low, high = np.r_[low, lost[:1]], np.r_[high, lost[:1]]
            half = np.r_[half, 2.0 * LEAST]
        return Zones(low, high, half, self.length)

    def _nearest(self, places: Array) -> tuple[Index, Array]:
        """The zone (n,) next to each of the places (n,), and how far (n,) mm off it is."""
        best, away = np.zeros(len(places), dtype=np.intp), np.zeros(len(places))
        for at in range(0, len(places), BLOCK):
            here = places[at : at + BLOCK, None]
            off = [
                np.maximum(np.maximum(self.low + m - here, here - self.high - m), 0.0)
                for m in self._copies()
            ]
            nearest = np.min(off, axis=0)
            best[at : at + BLOCK], away[at : at + BLOCK] = (
                np.argmin(nearest, axis=1),
                nearest.min(axis=1),
            )
        return best, away


def too_fast(line: Line, weights: Array, most: float, length: float | None, end: float) -> Zones:
    """Where the values, weighted (c,), change by more than `most` per mm from 0 to `end` mm; their stretches begin short."""
    step = np.diff(line.at)
    change = np.linalg.norm(np.diff(line.values, axis=0) * weights, axis=1)
    middle = 0.5 * (line.at[1:] + line.at[:-1])
    fast = (
        (change > most * step + 1e-9)
        & (middle > -1e-9)
        & (middle < end - (1e-9 if length is not None else -1e-9))
    )
    edge = np.diff(np.r_[False, fast, False].astype(int))
    first, last = np.flatnonzero(edge > 0), np.flatnonzero(edge < 0)
    total = np.r_[0.0, np.cumsum(change)]
    need = (total[last] - total[first]) / most / (2.0 * SLOPE)
    return Zones(line.at[first], line.at[last], np.maximum(0.5 * need, LEAST), length)
