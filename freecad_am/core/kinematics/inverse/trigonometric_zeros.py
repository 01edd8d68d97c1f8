# SPDX-License-Identifier: LGPL-2.1-or-later
"""Zeros of many trigonometric polynomials of the same degree at once, each isolated from all
others.

The polynomial is approximated in a step of h by the cubic with the same values and slopes at both
ends. The error of the cubic is at most h^4 / 384 of the maximum of the fourth derivative, that of
its slope sqrt(3) h^3 / 216 of the same. The cubic and its slope lie between the smallest and the
largest of their Bernstein coefficients. So a step has no zero if all coefficients have the same
sign and are larger than the error, and at most one if the same is true of the slope. Undecided
steps are cut into pieces.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from ...geometry.frames import TURN
from ...types import Array, Index, Mask

STEPS = {4: 32, 8: 48}  # per turn, by degree
PIECES, LEVELS = (
    4,
    {4: 10, 8: 7},
)  # pieces of an undecided step, and how often it is cut; for degree 8 as long as that decides
SURE_LEVELS = (
    7  # levels: zeros that only later levels separate are so close that they have few digits
)
VALUE_SHARE, SLOPE_SHARE = 1.0 / 384.0, math.sqrt(3.0) / 216.0
# shares of the sum of all coefficients, by degree: error of a value due to rounding of the pose,
# and largest extreme that counts as a double zero; the higher degree is a difference of products
ROUNDING, TOUCHING = {4: 5e-17, 8: 4e-15}, {4: 1e-13, 8: 1e-13}
EXTREME_STEPS, MAX_STEP_RAD = (
    8,
    1e-4,
)  # steps to an extreme that is next to zero, and rad of one at most
UNTOLD = 2.0  # multiple of the rounding error within which an extreme may be zero
DROWNED = 8.0  # multiple of the rounding error below which it hides the values and slopes of a step


class Parted(NamedTuple):
    """Steps (k,) with one zero: number of the polynomial, both ends, and an estimate of the zero.

    close: polynomials (n,) with zeros too close to each other to separate. touching: number and
    angle (m,) of such zeros, located by the bend of the polynomial where it touches zero, to the
    last digits. drowned: number and ends (s,) of steps throughout which the polynomial is as small
    as the rounding error.
    """

    number: Index
    low: Array
    high: Array
    guess: Array
    close: Mask
    touching: tuple[Index, Array]
    drowned: tuple[Index, Array, Array]


class _Steps(NamedTuple):
    """Steps (k,): number of the polynomial and begin; values and slopes (2, k) at both ends.

    The slopes are multiplied by a third of the step.
    """

    number: Index
    begin: Array
    value: Array
    slope: Array


def angles(count: int) -> Array:
    """Return angles spread evenly over a turn.

    Parameters
    ----------
    count : int
        Number of angles.

    Returns
    -------
    (count,) array
        From 0 on, rad.
    """
    return np.arange(count) * (TURN / count)


def harmonics(degree: int, angle: Array, derivative: int = 0) -> Array:
    """Return 1, cosines and sines of multiples of angles, or their derivative.

    Parameters
    ----------
    degree : int
        Largest multiple.
    angle : (m,) array
        Angles, rad.
    derivative : int, optional
        Order of the derivative.

    Returns
    -------
    (2 degree + 1, m) array
        The constant, the cosines, the sines.
    """
    order = np.arange(degree + 1)[:, None]
    # a derivative shifts the phase by a quarter turn and multiplies by the order
    turned = order * angle + 0.5 * math.pi * derivative
    rows: Array = (
        np.concatenate([np.cos(turned), np.sin(turned)[1:]])
        * np.concatenate([order, order[1:]]) ** derivative
    )
    return rows


@cache
def _grid(degree: int) -> Array:
    """Return the matrix for the values, followed by the slopes times a third of a step, at the ends
    of all steps of a turn.
    """
    step_ends = np.append(angles(STEPS[degree]), 0.0)
    slopes = harmonics(degree, step_ends, 1) * (TURN / STEPS[degree] / 3.0)
    result: Array = np.concatenate([harmonics(degree, step_ends), slopes], axis=1).T.copy()
    return result


def isolate_zeros(coefficients: Array) -> Parted:
    """Isolate the zeros of trigonometric polynomials.

    Parameters
    ----------
    coefficients : (2 degree + 1, n) array
        Coefficients of n polynomials in the order of `harmonics`.

    Returns
    -------
    Parted
        Steps with one zero each, rad, and polynomials with zeros too close to separate.
    """
    degree = len(coefficients) // 2
    amplitudes = np.hypot(coefficients[1 : degree + 1], coefficients[degree + 1 :])
    size = np.abs(coefficients[0]) + amplitudes.sum(axis=0)
    rounding, touching = ROUNDING[degree] * size, TOUCHING[degree] * size
    fourth = np.arange(1.0, degree + 1.0) ** 4 @ amplitudes
    waves: Array | None = None
    width, singles, close = TURN / STEPS[degree], [], np.zeros(coefficients.shape[1], dtype=bool)
    touches: list[tuple[Index, Array]] = []
    drowned: list[tuple[Index, Array, Array]] = []
    steps = _first(coefficients, width, fourth, touching)
    for level in range(LEVELS[degree]):
        single, open_ = _single_or_open(steps, fourth, rounding, width)
        singles.append((single, width))
        drowned_now = _is_drowned(open_, rounding)
        close[open_.number if level >= SURE_LEVELS - 1 else open_.number[drowned_now]] = True
        is_last = level == LEVELS[degree] - 1
        under = np.flatnonzero(drowned_now)
        drowned.append((open_.number[under], open_.begin[under], open_.begin[under] + width))
        finished = np.flatnonzero(drowned_now | is_last)
        touches.append((open_.number[finished], open_.begin[finished] + 0.5 * width))
        open_ = _some(open_, np.flatnonzero(~drowned_now))
        if is_last or not len(open_.number):
            break
        if waves is None:
            waves = np.concatenate(
                [coefficients[:1], coefficients[1 : degree + 1] - 1j * coefficients[degree + 1 :]]
            )
        width /= PIECES
        steps = _drop_empty(_cut(waves, open_, width), fourth, touching, width)
    number, low, high, guesses = (
        np.concatenate(columns) for columns in zip(*(_places(*single) for single in singles))
    )
    numbers, middles = (np.concatenate(columns) for columns in zip(*touches))
    flat, begin, end = (np.concatenate(columns) for columns in zip(*drowned))
    found_at = _touching(coefficients, numbers, middles, touching, rounding)
    return Parted(number, low, high, guesses, close, found_at, (flat, begin, end))


def _touching(
    coefficients: Array, number: Index, angle: Array, max_value: Array, rounding: Array
) -> tuple[Index, Array]:
    """Return number and angle (m,) of the zeros next to angles (k,) with an extreme of at most
    `max_value`.

    The zeros are those of the parabola through the extreme, or the extreme itself if it is zero
    within rounding or does not reach zero.
    """
    own_coefficients, degree = coefficients[:, number], len(coefficients) // 2

    def derivative(order: int) -> Array:
        result: Array = (harmonics(degree, angle, order) * own_coefficients).sum(axis=0)
        return result

    for _ in range(EXTREME_STEPS):
        bend = derivative(2)
        angle = angle - np.clip(
            derivative(1) / np.where(bend == 0.0, 1.0, bend), -MAX_STEP_RAD, MAX_STEP_RAD
        )
    value, bend, noise = derivative(0), derivative(2), UNTOLD * rounding[number]
    # up to the distance at which the steps separate two zeros
    through = (value * bend < 0.0) & (np.abs(value) < 0.5 * MAX_STEP_RAD**2 * np.abs(bend))
    valid = np.flatnonzero(((np.abs(value) <= max_value[number]) | through) & (bend != 0.0))
    number, angle, value, bend, noise = (
        number[valid],
        angle[valid],
        value[valid],
        bend[valid],
        noise[valid],
    )
    unsure = np.sqrt(2.0 * noise / np.abs(bend))
    # the same zero may be found from several steps
    order = np.lexsort((angle, number))
    number, angle, value, bend, noise, unsure = (
        column[order] for column in (number, angle, value, bend, noise, unsure)
    )
    once = np.ones(len(number), dtype=bool)
    once[1:] = (number[1:] != number[:-1]) | (np.diff(angle) > unsure[1:])
    offset = np.sqrt(np.maximum(-2.0 * value / bend, 0.0))
    offset[np.abs(value) <= noise] = 0.0
    two = once & (offset > 0.0)
    return np.concatenate([number[once], number[two]]), np.concatenate(
        [(angle - offset)[once], (angle + offset)[two]]
    )


def _first(coefficients: Array, width: float, fourth: Array, touching: Array) -> _Steps:
    """Return the steps of a whole turn that may have a zero."""
    degree = len(coefficients) // 2
    values, slopes = (_grid(degree) @ coefficients).reshape(2, STEPS[degree] + 1, -1)
    possible = np.flatnonzero(
        _may_be_zero(
            values[:-1], values[1:], slopes[:-1], slopes[1:], _value_bound(fourth, touching, width)
        )
    )
    row, number = np.divmod(possible, coefficients.shape[1])
    values, slopes, next_ends = values.ravel(), slopes.ravel(), possible + coefficients.shape[1]
    return _Steps(
        number,
        row * width,
        np.stack([values[possible], values[next_ends]]),
        np.stack([slopes[possible], slopes[next_ends]]),
    )


def _value_bound(fourth: Array, touching: Array, width: float) -> Array:
    result: Array = VALUE_SHARE * width**4 * fourth + touching
    return result


def _may_be_zero(
    begin_value: Array, end_value: Array, rise: Array, end_slope: Array, off: Array
) -> Mask:
    """Return whether a cubic may come within `off` of zero: its Bernstein coefficients are not all
    beyond `off` on the same side.

    It is given by its values and slopes at both ends.
    """
    second, third = begin_value + rise, end_value - end_slope
    lowest = np.minimum(np.minimum(begin_value, end_value), np.minimum(second, third))
    highest = np.maximum(np.maximum(begin_value, end_value), np.maximum(second, third))
    return np.asarray((lowest <= off) & (highest >= -off))


def _drop_empty(steps: _Steps, fourth: Array, touching: Array, width: float) -> _Steps:
    off = _value_bound(fourth[steps.number], touching[steps.number], width)
    (begin_value, end_value), (rise, end_slope) = steps.value, steps.slope
    return _some(steps, np.flatnonzero(_may_be_zero(begin_value, end_value, rise, end_slope, off)))


def _some(steps: _Steps, rows: Index | Mask) -> _Steps:
    return _Steps(steps.number[rows], steps.begin[rows], steps.value[:, rows], steps.slope[:, rows])


def _single_or_open(
    steps: _Steps, fourth: Array, rounding: Array, width: float
) -> tuple[_Steps, _Steps]:
    """Return the steps with exactly one zero, and the undecided steps, of steps that may have a
    zero.
    """
    number, _, (begin_value, end_value), (rise, end_slope) = steps
    off = SLOPE_SHARE / 3.0 * width**4 * fourth[number] + 3.0 * rounding[number]
    middle = end_value - begin_value - rise - end_slope
    single = np.minimum(np.minimum(rise, end_slope), middle) > off
    single |= np.maximum(np.maximum(rise, end_slope), middle) < -off
    return _some(steps, single & ((begin_value >= 0.0) != (end_value >= 0.0))), _some(
        steps, ~single
    )


def _is_drowned(steps: _Steps, rounding: Array) -> Mask:
    """Return whether the cubic is as small as rounding throughout a step, so that cutting it
    would not help.
    """
    begin_value, end_value = np.abs(steps.value)
    rise, end_slope = np.abs(steps.slope)
    return np.asarray(
        np.maximum(begin_value, end_value) + np.maximum(rise, end_slope)
        < DROWNED * rounding[steps.number]
    )


def _cut(waves: Array, steps: _Steps, width: float) -> _Steps:
    """Return the pieces, `width` long, of steps.

    The polynomials are the real parts of sums of powers of e^(i angle), with coefficients waves
    (degree + 1, n).
    """
    inner = np.arange(1, PIECES) * width
    turn = np.exp(1j * (steps.begin + inner[:, None]))
    of_step = waves[:, steps.number]
    value = np.broadcast_to(of_step[-1], turn.shape).copy()
    slope = np.zeros_like(value)
    for wave in of_step[-2::-1]:
        slope *= turn
        slope += value
        value *= turn
        value += wave
    slope *= turn
    values, slopes = np.empty((2, PIECES + 1, len(steps.number)))
    # identical at the ends of adjacent steps
    values[0], values[-1] = steps.value
    slopes[0], slopes[-1] = steps.slope / PIECES
    values[1:-1], slopes[1:-1] = value.real, slope.imag * (-width / 3.0)
    begin = steps.begin + np.arange(PIECES)[:, None] * width
    return _Steps(
        np.tile(steps.number, PIECES),
        begin.ravel(),
        np.stack([values[:-1].ravel(), values[1:].ravel()]),
        np.stack([slopes[:-1].ravel(), slopes[1:].ravel()]),
    )


def _places(steps: _Steps, width: float) -> tuple[Index, Array, Array, Array]:
    """Return number, both ends and approximate zero (k,) of steps with one zero.

    The zero is that of the cubic that gives the angle as a function of the value, kept in the step.
    """
    begin_value, end_value = steps.value
    change = end_value - begin_value
    share = -begin_value / change
    remainder = 1.0 - share
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        begin_share, end_share = change / (3.0 * steps.slope)
        along = share * (
            share * (3.0 - 2.0 * share) + remainder * (remainder * begin_share - share * end_share)
        )
    # a slope near zero at an end is useless here; use a straight line instead
    along = np.where((begin_share < 4.0) & (end_share < 4.0), np.clip(along, 0.0, 1.0), share)
    return steps.number, steps.begin, steps.begin + width, steps.begin + along * width
