# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lower bound of the remaining cost from every rotation at a point.

Bellman's recursion runs from the last point of a bead to the first. A step may end between two
rotations of the lattice. There, quartic polynomials through five neighbouring rotations
interpolate the joints and the remaining cost. The interpolation error is taken as twice the error
that the fourth differences predict, so that the cost of a step is bounded from below.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.frames import TURN
from ...types import Array, Index, Mask
from .lattice import COARSE, NO_FIVE, Lattice

# interpolation error as a share of the fourth difference: 1/96 within a step of the middle of the
# five rotations, 1/24 further out; twice that is allowed
INNER_ERROR, OUTER_ERROR = 2.0 / 96.0, 2.0 / 24.0
MOST_STEPS = 9.0  # larger than any offset within the five rotations
NEWTON = 3  # Newton steps to a minimum, repeated around the rotation nearest to it
MIN_SEPARATION = 3  # rotations between two minima that are both refined
FAR_ABOVE = 2.0  # multiple of the best known sum
# coefficients of 1, x, .. x^4 (rows) of the polynomial that is 1 at one of -2 .. 2 (columns) and 0
# at the others
POWERS = np.linalg.inv(np.vander(np.arange(-2.0, 3.0), 5, increasing=True))
FOURTH = np.array([1.0, -4.0, 6.0, -4.0, 1.0])
TORN = 1e-4  # share of a sum; if the remaining cost is less certain, it is bounded by lines too


def ahead(lattice: Lattice, end_values: Array, counts: Array, max_cost: float) -> Array:
    """Return a lower bound of the cost from every rotation at the first point to the end of a bead.

    Parameters
    ----------
    lattice : Lattice
        Lattice of m points with N rotations.
    end_values : (N,) array
        Costs that are added after the last point.
    counts : (m - 1,) array
        Number of original steps in each lattice step.
    max_cost : float
        Steps that cost more are not checked individually.

    Returns
    -------
    (N,) array
        The least costs; infinite where no rotation is possible.
    """
    value = np.where(lattice.passable[-1], end_values, np.inf)
    for j in range(len(lattice.joints) - 2, -1, -1):
        value = before(lattice, j, lattice, j + 1, value, float(counts[j]), max_cost)
    return value


def before(
    lattice: Lattice,
    i: int,
    next_lattice: Lattice,
    j: int,
    value: Array,
    count: float,
    max_cost: float,
) -> Array:
    """Return the least costs from every rotation at one point, through the next point.

    Parameters
    ----------
    lattice : Lattice
        The lattice with the first point.
    i : int
        Index of the first point.
    next_lattice : Lattice
        The lattice with the second point; it may be the same.
    j : int
        Index of the second point.
    value : (N,) array
        Least costs from the second point on.
    count : float
        Number of original steps that this step stands for.
    max_cost : float
        Steps that cost more than `count` times this are not checked individually.

    Returns
    -------
    (N,) array
        The least costs; infinite where no rotation is possible.
    """
    offsets = _neighbours(lattice, i, next_lattice, j, count * max_cost)
    columns: Index = (np.arange(lattice.count)[:, None] + offsets) % lattice.count
    total, weights = value[columns], lattice.weights / count
    for axis, weight in enumerate(weights):
        difference = next_lattice.joints[j, :, axis][columns] - lattice.joints[i, :, axis][:, None]
        if lattice.turning[axis] and np.nanmax(np.abs(difference), initial=0.0) > 0.5 * TURN:
            difference -= TURN * np.round(difference / TURN)
        total += weight * difference * difference
    total[np.isnan(total)] = np.inf
    minimum = _least(total, columns, lattice.joints[i], next_lattice, j, value, weights)
    if len(offsets) < lattice.count:  # every step that is not checked costs at least max_cost
        minimum = np.minimum(
            minimum, max_cost + value[next_lattice.passable[j]].min(initial=np.inf)
        )
    return np.where(lattice.passable[i], np.maximum(minimum, 0.0), np.inf)


def least_of(value: Array, lattice: Lattice) -> float:
    """Return the minimum of sums over the first point of a lattice, including between rotations.

    Parameters
    ----------
    value : (N,) array
        Sums at the rotations of the lattice.
    lattice : Lattice
        The lattice, N rotations.

    Returns
    -------
    float
        The minimum.
    """
    columns = np.arange(-1, lattice.count + 1)[None] % lattice.count
    return float(
        _least(
            value[columns],
            columns,
            lattice.joints[0, :1],
            lattice,
            0,
            value,
            np.zeros_like(lattice.weights),
        )[0]
    )


def _least(
    total: Array,
    columns: Index,
    start: Array,
    next_lattice: Lattice,
    j: int,
    value: Array,
    weights: Array,
) -> Array:
    """Return a lower bound (n,) of sums (n, k) at the rotations `columns` (n, k) and between them.

    The sums belong to steps from joints start (n, axes) to point j of a lattice. The first and the
    last column serve only as neighbours of the others.
    """
    inner = columns[:, 1:-1]
    low, high = (side[j][inner] for side in next_lattice.about)
    guess, to = _parabolas(total, low, high, next_lattice.passable[j][inner])
    sampled_min = np.where(next_lattice.passable[j][inner], total[:, 1:-1], np.inf).min(
        axis=1, initial=np.inf
    )
    minimum = _at_best(guess, to, sampled_min, inner, start, next_lattice, j, value, weights)
    ragged = next_lattice.ragged[j]
    if ragged.any():  # extrapolate the sums beyond the edge of reach
        inner_total = total[:, 1:-1]
        jumps = [
            np.where(np.isfinite(outer_total), np.abs(inner_total - outer_total), 0.0)
            for outer_total in (total[:, 2:], total[:, :-2])
        ]
        with np.errstate(invalid="ignore"):
            beyond = np.where(
                ragged[inner] & np.isfinite(inner_total), inner_total - np.maximum(*jumps), np.inf
            )
        minimum = np.minimum(minimum, beyond.min(axis=1))
    return minimum


def _neighbours(lattice: Lattice, i: int, next_lattice: Lattice, j: int, max_cost: float) -> Index:
    """Return the rotation offsets of the steps that cost less than `max_cost`, and one more at
    either end.
    """
    cell = lattice.count // COARSE
    radius = np.sqrt(max_cost) + 0.5 * cell * (lattice.rate[i] + next_lattice.rate[j])
    from_, to = lattice.flat[i], next_lattice.flat[j]
    squared_distance = np.nan_to_num(
        (from_ * from_).sum(axis=1)[:, None] + (to * to).sum(axis=1) - 2.0 * from_ @ to.T
    )
    close = (
        (squared_distance < radius * radius)
        & _any(lattice.possible[i], cell)[:, None]
        & _any(next_lattice.possible[j], cell)
    )
    start, end = np.nonzero(close)
    met = np.unique((end - start) % COARSE) if len(start) else np.zeros(1, dtype=np.int64)
    # omit the widest part of the turn where no step ends
    gaps = np.diff(np.append(met, met[0] + COARSE))
    widest = int(gaps.argmax())
    first_cell, last_cell = met[(widest + 1) % len(met)] - 1, met[widest] + 1
    last_cell += COARSE if last_cell < first_cell else 0
    if gaps[widest] <= 3:  # the additional one at either end leaves nothing to omit
        return np.arange(-1, lattice.count + 1)
    return np.arange(first_cell * cell - 1, last_cell * cell + 2)


def _any(possible: Mask, cell: int) -> Mask:
    """Return whether a cell on either side of each coarse rotation is possible: (COARSE,)."""
    cells = possible.reshape(COARSE, cell).any(axis=1)
    return np.asarray(cells | np.roll(cells, 1))


def _parabolas(total: Array, low: Array, high: Array, available: Mask) -> tuple[Array, Array]:
    """Estimate the least sum near each rotation except the outer two, and its offset: (n, k) each.

    total: (n, k + 2) sums at the rotations. low, high: (n, k) range of the offsets, in lattice
    steps. The sum is infinite where not `available` (n, k).
    """
    centre, next_total, previous_total = total[:, 1:-1], total[:, 2:], total[:, :-2]
    with np.errstate(invalid="ignore", over="ignore"):
        slope = 0.5 * (next_total - previous_total)
        bend = next_total - 2.0 * centre + previous_total
        to = np.where(
            bend > 0.0, -slope / np.where(bend > 0.0, bend, 1.0), np.where(slope > 0.0, -1.0, 1.0)
        )
        to = np.clip(to, low, high)
        guess = centre + to * (slope + 0.5 * to * bend)
    finite = np.isfinite(guess)
    return np.where(available, np.where(finite, guess, centre), np.inf), np.where(finite, to, 0.0)


def _at_best(
    guess: Array,
    to: Array,
    sampled_min: Array,
    columns: Index,
    start: Array,
    next_lattice: Lattice,
    j: int,
    value: Array,
    weights: Array,
) -> Array:
    """Return the least sums (n,) near the best guess of each row and near its other local
    minima.

    The guesses (n, k) are at the offsets `to` from the rotations `columns` (n, k). The result is
    at most `sampled_min` (n,), the least sum at a rotation of the lattice.
    """
    rows, number = np.arange(len(guess)), np.arange(guess.shape[1])
    best_column = guess.argmin(axis=1)
    edge = np.full((len(guess), 1), np.inf)
    neighbours = np.minimum(np.c_[edge, guess[:, :-1]], np.c_[guess[:, 1:], edge])
    # a guess above the best known sum by much more than its error cannot be the minimum
    worth, minima = np.nonzero(
        (guess <= neighbours)
        & (guess < FAR_ABOVE * sampled_min[:, None])
        & (np.abs(number - best_column[:, None]) >= MIN_SEPARATION)
    )
    row, best = np.concatenate([rows, worth]), np.concatenate([best_column, minima])
    column, step = columns[row, best], to[row, best]
    model = _near(column, start[row], next_lattice, j, value)
    finer, step, doubt = model.least(step, weights)
    nearest = np.nan_to_num(np.round(step)).astype(np.int64)
    model = _near((column + nearest) % len(value), start[row], next_lattice, j, value)
    finer, step, doubt = model.least(
        step - nearest, weights
    )  # around the rotation nearest to the minimum
    torn = np.flatnonzero(doubt > TORN * np.abs(finer))
    if len(torn):
        finer[torn] = np.maximum(finer[torn], model.of(torn).least_by_lines(weights))
    sure = np.where(np.isfinite(finer), finer, guess[row, best])
    minimum = np.minimum(sure[: len(rows)], sampled_min)
    np.minimum.at(minimum, worth, sure[len(rows) :])
    return np.where(np.isfinite(guess[rows, best_column]), minimum, np.inf)


@dataclass(frozen=True, eq=False)
class _Near:
    """Polynomial models of the steps to rotations near n columns of a lattice.

    The variable x counts lattice steps from the middle of the five rotations, which is `shift` (n,)
    steps from the column. moved: (5, n, axes) coefficients of the joint motion. later: (5, n)
    coefficients of the remaining cost. off: (n, axes) and doubt: (n,) fourth differences of the
    two. low, high: (n,) range of x that covers whole cells. around: (n, 5) remaining costs at the
    rotations around the column.
    """

    moved: Array
    later: Array
    off: Array
    doubt: Array
    shift: Index
    low: Array
    high: Array
    around: Array

    def of(self, rows: Index) -> _Near:
        """Return the models of the given rows."""
        return _Near(
            self.moved[:, rows],
            self.later[:, rows],
            self.off[rows],
            self.doubt[rows],
            self.shift[rows],
            self.low[rows],
            self.high[rows],
            self.around[rows],
        )

    def least(self, to: Array, weights: Array) -> tuple[Array, Array, Array]:
        """Return the least sum near offset `to`, its offset, and the error of the remaining cost.

        All are (n,). The sum is NaN if unknown.
        """
        x = self._minimised(to - self.shift, self.later, self.low, self.high, weights)
        doubt = np.where(np.abs(x) <= 1.0, INNER_ERROR, OUTER_ERROR) * self.doubt
        with np.errstate(invalid="ignore", over="ignore"):
            return (
                self._step(x, weights) + _polynomial(self.later, x, 0) - doubt,
                x + self.shift,
                doubt,
            )

    def least_by_lines(self, weights: Array) -> Array:
        """Return the least sum (n,) where polynomials are a poor model of the remaining cost.

        This is the case near rotations from which the bead cannot be continued. Within a cell the
        remaining cost is at least that at the ends, except in a dip, which is bounded by the lines
        that descend into it.
        """
        minimum = np.full(len(self.low), np.inf)
        for offset, (before_, centre, next_value, far_value) in (
            (-1.0, self.around.T[:4]),
            (0.0, self.around.T[1:]),
        ):
            begin = offset - self.shift
            low, high = np.maximum(self.low, begin), np.minimum(self.high, begin + 1.0)
            with np.errstate(invalid="ignore"):
                down = [
                    np.nan_to_num(inner - outer, posinf=0.0, neginf=0.0)
                    for inner, outer in ((centre, before_), (far_value, next_value))
                ]
            dip = (down[0] < 0.0) & ((down[1] > 0.0) | ~np.isfinite(far_value)) | (
                down[1] > 0.0
            ) & ~np.isfinite(before_)
            bound = np.full(len(minimum), -np.inf)
            for value, slope, position in (
                (centre, down[0], begin),
                (next_value, down[1], begin + 1.0),
            ):
                slope = np.where(dip, slope, 0.0)
                line = np.zeros_like(self.later)
                line[1], line[0] = (
                    slope,
                    np.where(dip, value, np.minimum(centre, next_value)) - slope * position,
                )
                sums = self._step(
                    x := self._minimised(0.5 * (low + high), line, low, high, weights), weights
                )
                bound = np.fmax(
                    bound, np.where(dip & (slope == 0.0), -np.inf, sums + line[0] + line[1] * x)
                )
            minimum = np.minimum(minimum, np.where(low < high, bound, np.inf))
        return np.where(np.isfinite(minimum), minimum, -np.inf)

    def _step(self, x: Array, weights: Array) -> Array:
        off = np.where(np.abs(x) <= 1.0, INNER_ERROR, OUTER_ERROR)[:, None] * self.off
        distance = np.maximum(np.abs(_polynomial(self.moved, x[:, None], 0)) - off, 0.0)
        return np.asarray((distance * distance) @ weights)

    def _minimised(self, x: Array, later: Array, low: Array, high: Array, weights: Array) -> Array:
        with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
            for _ in range(NEWTON):
                displacement, slope, bend = (
                    _polynomial(self.moved, x[:, None], order) for order in range(3)
                )
                rate = 2.0 * (displacement * slope) @ weights + _polynomial(later, x, 1)
                curve = 2.0 * (slope * slope + displacement * bend) @ weights + _polynomial(
                    later, x, 2
                )
                down = np.where(
                    curve > 0.0,
                    rate / np.where(curve > 0.0, curve, 1.0),
                    MOST_STEPS * np.sign(rate),
                )
                x = np.clip(x - down, low, high)
        return x


def _near(column: Index, start: Array, next_lattice: Lattice, j: int, value: Array) -> _Near:
    """Return the models of steps from joints start (n, axes) to rotations near `column` (n,).

    The rotations belong to point j of a lattice, whose remaining costs are value (N,).
    """
    joints, shift, count = next_lattice.joints[j], next_lattice.shift[j][column], len(value)
    five = (column + np.where(shift == NO_FIVE, 0, shift))[:, None] + np.arange(-2, 3)
    five %= count
    middle = joints[column]
    to_five = (
        next_lattice.joint_steps(middle[:, None], joints[five])
        + next_lattice.joint_steps(start, middle)[:, None]
    )
    ahead_ = np.where((shift == NO_FIVE)[:, None], np.nan, value[five])
    whole_cells = next_lattice.closed_cells[j]
    with np.errstate(invalid="ignore"):
        return _Near(
            np.einsum("pk,nka->pna", POWERS, to_five),
            POWERS @ ahead_.T,
            np.abs(np.einsum("k,nka->na", FOURTH, to_five)),
            np.abs(ahead_ @ FOURTH),
            shift,
            np.where(whole_cells[column - 1], -1.0, 0.0) - shift,
            np.where(whole_cells[column], 1.0, 0.0) - shift,
            value[(column[:, None] + np.arange(-2, 3)) % count],
        )


def _polynomial(powers: Array, x: Array, order: int) -> Array:
    """Return the polynomial with coefficients (5, ...) at x, or its first or second derivative."""
    a, b, c, d, e = powers
    if order == 0:
        return np.asarray(a + x * (b + x * (c + x * (d + x * e))))
    if order == 1:
        return np.asarray(b + x * (2.0 * c + x * (3.0 * d + 4.0 * x * e)))
    return np.asarray(2.0 * c + x * (6.0 * d + 12.0 * x * e))
