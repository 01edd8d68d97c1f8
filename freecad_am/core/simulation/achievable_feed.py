# SPDX-License-Identifier: LGPL-2.1-or-later
"""Achievable feed of a machine along a motion.

A motion requests a speed at the deposition point on every segment. Each axis has a maximum speed
and, if the machine file states it, a maximum acceleration. The result is the fastest motion along
the same joint path within these limits that never exceeds the requested speed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.ramps import limit_growth
from ..motion import Motion
from ..types import Array, ArrayLike, Index, Integers, Mask


def speed_ratios(joints: Array, duration: Array, speed_limits: Array) -> Array:
    """Return the mean joint speeds on segments as fractions of the axis maxima.

    Parameters
    ----------
    joints : (n, a) array
        Joint values of the rows, rad or mm.
    duration : (n,) array
        Time of the segment that ends at each row, s.
    speed_limits : (a,) array
        Maximum speeds, rad/s or mm/s; infinite if unknown.

    Returns
    -------
    (n, a) array
        Fractions for the segment that ends at each row. For segments of zero duration, 0, or
        infinite if an axis moves.
    """
    moved = np.abs(np.diff(joints, axis=0, prepend=joints[:1]))
    lasts = duration[:, None] > 0.0
    speed = np.where(
        lasts, moved / np.where(lasts, duration[:, None], 1.0), np.where(moved > 0.0, np.inf, moved)
    )
    return np.divide(
        speed,
        speed_limits,
        out=np.zeros_like(speed),
        where=np.isfinite(speed_limits) | np.isnan(speed),
    )


def spread_to_deposit_rows(deposit: Mask, values: Array) -> Array:
    """Spread values of the deposit rows over all rows.

    Parameters
    ----------
    deposit : (n,) array of bool
        Whether a row deposits.
    values : (k,) array
        Values of the k deposit rows, such as the condition of a joint path's beads.

    Returns
    -------
    (n,) array
        The values; NaN on rapid rows.
    """
    all_rows = np.full(len(deposit), np.nan)
    all_rows[deposit] = values
    return all_rows


def from_next(deposit: Mask, point: Integers, values: Array) -> Array:
    """Copy the value of the second row of each bead to its first row, where no segment ends.

    Parameters
    ----------
    deposit : (n,) array of bool
        Whether a row deposits.
    point : (n,) array of int
        Index of the point in its bead.
    values : (n,) array
        Values of the segments that end at the rows.

    Returns
    -------
    (n,) array
        The values, a copy.
    """
    first_rows = np.flatnonzero(deposit & (point == 0))
    shifted = values.copy()
    shifted[first_rows] = values[np.minimum(first_rows + 1, len(values) - 1)]
    return shifted


# relative excess of an axis speed that is still rounding error
OVER = 1e-9
# fractions of the curvature limit tried as ceilings; factor and number of times by which the best
# ceiling is then raised
CEILINGS = (0.5, 0.8, 0.95, 0.99)
GROWTH, ROUNDS = 1.3, 6
# minimum fraction of a bend's bound at which the bend is reported as the cause of a lower speed
BENT = 0.9
_ANY = 1e9  # unlimited change of p^2
# s; rows with a shorter segment repeat a position and are not moves
_NO_TIME = 1e-12


@dataclass(frozen=True, eq=False)
class AchievableFeed:
    """Columns (n,) for the segments that end at the n rows of a motion.

    ratio: speed of the fastest axis as a fraction of its maximum, 0 at standstill. axis: int, the
    axis that limits the speed, -1 if none does. asked, achieved: requested and mean achieved speed,
    mm/s at the deposition point. duration: achieved duration, s. slowed: bool, whether the achieved
    speed is below the requested speed. lost: additional time of the whole job, s.
    """

    ratio: Array
    axis: Integers
    asked: Array
    achieved: Array
    duration: Array
    slowed: Mask
    lost: float


def achievable_feed(
    motion: Motion, max_speed: ArrayLike, max_acceleration: ArrayLike = np.inf
) -> AchievableFeed:
    """Return the achievable feed of a machine along a motion.

    If accelerations are known, the machine stops at both ends of every bead and of every rapid,
    like the program. Rows without joint values keep the requested speed.

    Parameters
    ----------
    motion : Motion
        The motion, n rows.
    max_speed : (axes,) array_like
        Maximum speeds, rad/s, or mm/s of prismatic axes; infinite if unknown.
    max_acceleration : (axes,) array_like or float, optional
        Maximum accelerations, rad/s^2 or mm/s^2; infinite if unknown.

    Returns
    -------
    AchievableFeed
        Speeds, durations and limiting axes of the segments that end at the rows.
    """
    speed_limits = np.asarray(max_speed, float)
    shares = np.nan_to_num(
        speed_ratios(motion.joints, np.nan_to_num(motion.duration), speed_limits), posinf=0.0
    )
    ratio = shares.max(axis=1, initial=0.0)
    factor = np.ones(len(motion))
    over = ratio > 1.0 + OVER
    factor[over] = 1.0 / ratio[over]
    axis = np.where(over, shares.argmax(axis=1), -1)
    largest = np.broadcast_to(np.asarray(max_acceleration, float), speed_limits.shape)
    if np.isfinite(largest).any() and len(motion) > 1:
        factor, axis = _accelerated(motion, factor, axis, largest)
    slowed = factor < 1.0 - OVER
    planned_duration = np.nan_to_num(motion.duration)
    duration = planned_duration / factor
    return AchievableFeed(
        ratio=ratio,
        axis=np.where(slowed, axis, -1),
        asked=motion.speed,
        achieved=motion.speed * factor,
        duration=duration,
        slowed=slowed,
        lost=float((duration - planned_duration).sum()),
    )


def _rates(motion: Motion) -> Array:
    """Return the axis speeds on the segment that ends at each row, (n, axes) rad/s or mm/s.

    They are 0 at standstill or where joints are unknown.
    """
    turned = np.nan_to_num(np.diff(motion.joints, axis=0, prepend=motion.joints[:1]))
    moving = np.nan_to_num(motion.duration) > _NO_TIME
    rates: Array = turned / np.where(moving, motion.duration, np.inf)[:, None]
    return rates


def _accelerated(
    motion: Motion, factor: Array, axis: Integers, largest: Array
) -> tuple[Array, Integers]:
    """Return the speed factors (n,) within speed and acceleration limits, and the limiting axes.

    Let u be the time at the requested speed and p = du/dt the rate. An axis then has the speed q' p
    and the acceleration q'' p^2 + q' (p^2)'/2. q' is constant in a segment. At a row between two
    segments, q'' is the change of q' divided by the mean of the two durations.
    """
    rates = _rates(motion)
    moving = np.flatnonzero(np.abs(rates).max(axis=1) > 0.0)
    if not len(moving):
        return factor, axis
    time, square = np.nan_to_num(motion.duration)[moving], factor[moving] ** 2
    profile = _Way.of(rates[moving], time, square, largest, _blocks(motion)[moving])
    node = profile.fastest()
    gain, by_speed = profile.gain(node)
    # the bound by bends is known at nodes; a segment takes the higher bound of its two nodes
    mean = _mean_rate(
        node[:-1],
        node[1:],
        np.minimum(square, np.maximum(profile.bound[:-1], profile.bound[1:])),
        gain,
    )
    result, limiting = factor.copy(), axis.copy()
    slower = mean < factor[moving] - OVER
    result[moving[slower]] = mean[slower]
    # the limiting axis is that of the bend if the bend is near its bound, else that of the ramp
    worst = np.where(node[1:] < node[:-1], profile.bound[1:], profile.bound[:-1])
    bent = np.minimum(node[:-1], node[1:]) > BENT * worst
    by_bend = np.where(node[1:] < node[:-1], profile.by_bend[1:], profile.by_bend[:-1])
    limiting[moving[slower]] = np.where(bent, by_bend, by_speed)[slower]
    return result, limiting


@dataclass(frozen=True, eq=False)
class _Way:
    """Segments (m,) and the m + 1 nodes at their ends.

    speed: (m, axes) |q'|. bend: (m + 1, axes) |q''|. largest: (axes,) maximum accelerations. most: (m + 1,) maximum p^2
    by speeds, 0 at stops. bound: (m + 1,) maximum p^2 by bends. by_bend: (m + 1,) axis of that bound.
    """

    speed: Array
    time: Array
    bend: Array
    largest: Array
    most: Array
    bound: Array
    by_bend: Index

    @staticmethod
    def of(speed: Array, time: Array, square: Array, largest: Array, block: Integers) -> _Way:
        """Compute the bounds of p^2 for segments; the motion stops at both ends and between blocks."""
        bend = np.zeros((len(speed) + 1, speed.shape[1]))
        bend[1:-1] = np.abs(np.diff(speed, axis=0)) / (0.5 * (time[:-1] + time[1:]))[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            bounds = np.where(bend > 0.0, largest / bend, np.inf)
        highest = np.zeros(len(bend))
        highest[1:-1] = np.where(block[1:] == block[:-1], np.minimum(square[:-1], square[1:]), 0.0)
        return _Way(
            np.abs(speed), time, bend, largest, highest, bounds.min(axis=1), bounds.argmin(axis=1)
        )

    def fastest(self) -> Array:
        """Return the maximum p^2 (m + 1,) at the nodes, approximated from below to about a percent.

        A ceiling of p^2 bounds the acceleration in bends. The remaining acceleration limits the slope of p^2 below the
        ceiling. Low ceilings leave more acceleration; high ceilings are faster once reached. The pointwise maximum of
        feasible motions is feasible too.
        """
        best = np.zeros(len(self.most))
        for share in CEILINGS:
            best = np.maximum(best, self._below(np.minimum(self.most, share * self.bound)))
        for _ in range(ROUNDS):
            best = np.maximum(
                best, self._below(np.minimum(np.minimum(self.most, self.bound), GROWTH * best))
            )
        return best

    def _below(self, ceiling: Array) -> Array:
        """Return the maximum p^2 (m + 1,) below a ceiling whose slopes need no more than the remaining acceleration."""
        # p^2 never exceeds 1
        total = np.concatenate([[0.0], np.cumsum(np.minimum(self.gain(ceiling)[0], 1.0))])
        lower: Array = np.maximum(np.minimum(limit_growth(ceiling, total), ceiling), 0.0)
        return lower

    def gain(self, ceiling: Array) -> tuple[Array, Index]:
        """Return the maximum change of p^2 over each segment below the ceiling, (m,), and the limiting axes."""
        with np.errstate(divide="ignore", invalid="ignore"):
            remaining = self.largest - np.where(self.bend > 0.0, self.bend * ceiling[:, None], 0.0)
            margin = np.maximum(np.minimum(remaining[:-1], remaining[1:]), 0.0)
            slopes = np.where(self.speed > 0.0, 2.0 * margin / self.speed, np.inf)
        return np.minimum(slopes.min(axis=1) * self.time, _ANY), slopes.argmin(axis=1)


def _blocks(motion: Motion) -> Integers:
    """Return the block of each row, (n,) int; the program runs through a block without a stop."""
    columns = (motion.deposit.astype(np.int64), motion.layer, motion.bead)
    new = np.any([np.diff(column, prepend=column[:1]) != 0 for column in columns], axis=0)
    blocks: Integers = np.cumsum(new)
    return blocks


def _mean_rate(start: Array, end: Array, highest: Array, gain: Array) -> Array:
    """Return the mean rate p (m,) on segments where p^2 goes from `start` to `end`.

    p^2 rises up to `highest` in between, as far as `gain`, the maximum change of p^2, allows.
    """
    top = np.minimum(highest, 0.5 * (start + end + gain))
    up, down = np.maximum(top - start, 0.0), np.maximum(top - end, 0.0)
    safe = np.where(gain > 0.0, gain, 1.0)
    even = np.maximum(1.0 - (up + down) / safe, 0.0)
    low, high, peak = np.sqrt(start), np.sqrt(end), np.sqrt(np.maximum(top, 1e-300))
    # integral of du / p with p^2 linear in u: duration of a ramp = length / mean of p at its ends
    with np.errstate(divide="ignore", invalid="ignore"):
        time = up / safe * 2.0 / (low + peak) + down / safe * 2.0 / (high + peak) + even / peak
    mean: Array = np.where(time > 0.0, 1.0 / time, peak)
    return mean
