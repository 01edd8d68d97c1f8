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
MIN_STRETCH_MM = 0.05  # mm between points added


class Line(NamedTuple):
    """Values (k, c) linear between positions (k,) mm, rising; constant beyond the ends."""

    positions: Array
    values: Array

    def __call__(self, s: Array) -> Array:
        """The values (n, c) at places (n,)."""
        values_: Array = np.stack(
            [np.interp(s, self.positions, column) for column in self.values.T], axis=-1
        )
        return values_

    def mirrored(self, length: float) -> Line:
        """The values of an open bead, mirrored at both ends: bends next to an end then count for little."""
        positions_ = np.concatenate(
            [-self.positions[::-1], self.positions, 2.0 * length - self.positions[::-1]]
        )
        values = np.vstack([self.values[::-1], self.values, self.values[::-1]])
        is_separate = np.r_[True, np.diff(positions_) > 1e-9]
        return Line(positions_[is_separate], values[is_separate])


def means(line: Line, s: Array, half: Array) -> Array:
    """Means (n, c) of the values over s - half .. s + half (n,), the values themselves where half is 0."""
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
    """Stretches where values change too fast, low .. high (z,) mm, and half the length (z,) mm over which each is spread."""

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
        start, end = (
            np.searchsorted(s, low - 2.0 * self.half),
            np.searchsorted(s, high + 2.0 * self.half),
        )
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
        """Positions to add to the positions (n,) of a bead, so that the ramps are followed."""
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
        """With longer stretches at the zones next to places (n,); a place that none reaches becomes one."""
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
        """The zone (n,) next to each of the places (n,), and how far (n,) mm off it is."""
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
    """Where the values, weighted (c,), change by more than `max_rate` per mm from 0 to `end` mm; their stretches begin short."""
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
