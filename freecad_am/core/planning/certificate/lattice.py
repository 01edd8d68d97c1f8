# SPDX-License-Identifier: LGPL-2.1-or-later
"""The joints at points of a bead, for N rotations of a turn about the tool axis at each point."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...geometry.frames import TURN, shortest
from ...kinematics import jacobian as jac
from ...types import Array, Index, Mask
from ..points import Points
from ..task import Task

CELLS, PARTS = 36, 3  # initial cells per turn, and parts into which a cell is divided


def whole_turn() -> tuple[Array, float]:
    """Divide a whole turn into CELLS equal cells.

    Returns
    -------
    middles : (CELLS,) array
        Middle of each cell, -pi to pi, rad.
    half : float
        Half the width of a cell, rad.
    """
    half = np.pi / CELLS
    return -np.pi + half * (2.0 * np.arange(CELLS) + 1.0), half


def divided(phi: Array, half: float) -> Array:
    """Divide each cell into PARTS equal parts.

    Parameters
    ----------
    phi : (n,) array
        Middles of the cells, rad.
    half : float
        Half the width of a cell, rad.

    Returns
    -------
    (PARTS n,) array
        Middles of the parts, in sequence for each cell, rad.
    """
    offsets = (2.0 * np.arange(PARTS) - (PARTS - 1)) * half / PARTS
    return np.asarray((phi[:, None] + offsets).ravel())


def possible(
    task: Task, points: Points, index: Index, phi: Array, half: Array, threshold: Array
) -> Mask:
    """Return whether a rotation in each cell may keep limits and condition.

    This follows from the middle and the ends of the cell. Joints are assumed to bend at most
    twice as much in between as their second differences show.

    Parameters
    ----------
    task : Task
        The plan, with limits.
    points : Points
        The points.
    index : (n,) int array
        Point of each cell.
    phi, half : (n,) array
        Middle and half width of each cell, rad.
    threshold : (n,) array
        Smallest condition allowed.

    Returns
    -------
    (n,) bool array
        False where no rotation of the cell can serve.
    """
    count = len(phi)
    begins = ~_goes_on(index, phi, half)  # the previous cell does not end where this one begins
    sampled = np.concatenate([phi[begins] - half[begins], phi, phi + half])
    sampled_points = points.select_points(np.concatenate([index[begins], index, index]))
    joints, begin_count = task.raw_joints(sampled_points, sampled), int(begins.sum())
    rows = begin_count + np.arange(2 * count).reshape(2, count)
    rows = np.stack([np.where(begins, np.cumsum(begins) - 1, rows[1] - 1), *rows])
    previous, middle, following = joints[rows]
    ahead, behind = _short(following - middle), _short(middle - previous)
    # a cell at the edge of reach is extrapolated beyond the edge
    lost_ahead, lost_behind = (np.isnan(difference).any(axis=1) for difference in (ahead, behind))
    feasible = np.isfinite(middle).all(axis=1) & ~(lost_ahead & lost_behind)
    ahead, behind = (
        np.where(lost_ahead[:, None], behind, ahead),
        np.where(lost_behind[:, None], ahead, behind),
    )
    turned, bend = 0.5 * np.abs(ahead + behind), np.abs(ahead - behind)
    # a line through the ends of a parabola is off by up to a quarter of its second
    # difference: allow twice that
    off = 0.5 * bend + (half**2)[:, None] * turned.max(axis=1, keepdims=True)
    off = np.where((lost_ahead ^ lost_behind)[:, None], 0.5 * np.abs(ahead), off)
    feasible &= _within_limits(task, middle, turned + off + bend)
    open_ = np.flatnonzero(feasible)
    once, inverse_rows = np.unique(rows[:, open_], return_inverse=True)
    thresholds = np.empty(len(once))
    thresholds[inverse_rows.ravel()] = np.tile(threshold[open_], 3)
    ratio = _condition(task, sampled_points, sampled, joints, once, thresholds)[
        inverse_rows
    ].reshape(3, -1)
    feasible[open_] = 2.0 * ratio.max(axis=0) - ratio.min(axis=0) >= threshold[open_]
    return np.asarray(feasible)


def _goes_on(index: Index, phi: Array, half: Array) -> Mask:
    """Return whether each cell (n,) phi +- half begins where the previous cell ends, at the same
    point.
    """
    continues = np.zeros(len(phi), dtype=bool)
    gap = np.abs(phi[1:] - phi[:-1] - half[1:] - half[:-1])
    continues[1:] = (index[1:] == index[:-1]) & (gap < 1e-6 * half[1:])
    return continues


def _within_limits(task: Task, joints: Array, reach: Array) -> Mask:
    """Return whether joints (n, axes) can be within the limits of each axis when moved by up to
    `reach` and by whole turns.
    """
    limits = task.cell.limits
    beyond = np.abs(_short(joints - task.middle)) - np.where(
        task.continuous, np.inf, 0.5 * (limits.upper - limits.lower)
    )
    return np.asarray((beyond <= reach).all(axis=1))


def _condition(
    task: Task, points: Points, phi: Array, joints: Array, rows: Index, threshold: Array
) -> Array:
    """Return the condition at the chosen rows, 0 out of reach.

    A lower bound replaces it where this bound is far above the threshold.
    """
    ratio = np.zeros(len(rows))
    good = np.flatnonzero(np.isfinite(joints[rows]).all(axis=1))
    matrix = task.jacobian_at(points.frames.of(rows[good]), phi[rows[good]], joints[rows[good]])
    length = task.parameters.characteristic_length
    bound = jac.condition_bound(matrix, length)
    uncertain = bound < 2.0 * threshold[good]
    bound[uncertain] = jac.condition(matrix[uncertain], length)
    ratio[good] = bound
    return ratio


def _short(angle: Array) -> Array:
    short: Array = shortest(angle)
    return short


NO_FIVE = 9
RATE_SAMPLES, HARMONICS = (
    180,
    36,
)  # number of rotations at which joint rates are sampled, and the subdivisions of each
SMOOTH = 0.06  # rad
KNOWN = 1000  # samples at which the rotations of the lattice are interpolated
EVENLY = 0.25  # share of rotations spread evenly, not by joint motion
LARGEST_SHARE = 12.0  # times the mean
COARSE = 60  # cells of a turn in the first pass; cells next to an impossible one are divided


@dataclass(frozen=True, eq=False)
class Lattice:
    """A lattice of m points with N rotations from -pi on, N a multiple of COARSE.

    joints: (m, N, axes) rad or mm, NaN out of reach. possible: (m, N) whether a rotation between
    this one and the next may keep limits and condition. weights: (axes,) of eq. 17. turning:
    (axes,) axes for which whole turns cost nothing.
    """

    joints: Array
    possible: Mask
    weights: Array
    turning: Mask

    @cached_property
    def passable(self) -> Mask:
        """(m, N) rotations at the ends of possible cells."""
        ends: Mask = (self.possible | np.roll(self.possible, 1, axis=1)) & np.isfinite(
            self.joints
        ).all(axis=2)
        return ends

    @cached_property
    def closed_cells(self) -> Mask:
        """Possible cells (m, N) with both ends within reach."""
        return np.asarray(self.possible & self.passable & np.roll(self.passable, -1, axis=1))

    @cached_property
    def ragged(self) -> Mask:
        """(m, N) rotations at a possible cell whose other end is out of reach."""
        torn = self.possible & ~self.closed_cells
        return np.asarray(self.passable & (torn | np.roll(torn, 1, axis=1)))

    @cached_property
    def about(self) -> tuple[Array, Array]:
        """Return the range about each rotation in which cells are whole.

        Returns
        -------
        low, high : (m, N) array
            In steps, from -0.5 to 0.5; up to 1 where the next rotation has no whole
            cell beyond.
        """
        right_closed, left_closed = self.closed_cells, np.roll(self.closed_cells, 1, axis=1)
        low = np.where(left_closed, np.where(np.roll(left_closed, 1, axis=1), -0.5, -1.0), 0.0)
        return low, np.where(
            right_closed, np.where(np.roll(right_closed, -1, axis=1), 0.5, 1.0), 0.0
        )

    @cached_property
    def shift(self) -> Index:
        """Offset (m, N), in rotations, of the middle of five consecutive rotations with whole
        cells; NO_FIVE if there are no five.
        """
        right_count, left_count = (np.zeros(self.possible.shape, dtype=np.int64) for _ in range(2))
        to_right, to_left = np.ones_like(self.possible), np.ones_like(self.possible)
        for by in range(4):
            to_right = to_right & np.roll(self.closed_cells, -by, axis=1)
            to_left = to_left & np.roll(self.closed_cells, by + 1, axis=1)
            right_count += to_right
            left_count += to_left
        lowest, highest = 2 - left_count, right_count - 2
        return np.where(lowest <= highest, np.clip(0, lowest, np.maximum(lowest, highest)), NO_FIVE)

    @cached_property
    def rate(self) -> Array:
        """Return the largest root of the cost from a rotation to the next one.

        Returns
        -------
        (m,) array
            Root of eq. 17 for one lattice step, the largest at each point.
        """
        moved = self.joint_steps(self.joints, np.roll(self.joints, -1, axis=1))
        return np.asarray(np.nan_to_num(np.sqrt((moved * moved) @ self.weights)).max(axis=1))

    def joint_steps(self, start: Array, end: Array) -> Array:
        """Return the steps between joints, the short way round for turning axes.

        Parameters
        ----------
        start, end : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (..., axes) array
            The steps, rad or mm.
        """
        difference = end - start
        return np.where(self.turning, shortest(difference), difference)

    @property
    def first(self) -> Lattice:
        """The lattice of only the first point."""
        return Lattice(self.joints[:1], self.possible[:1], self.weights, self.turning)

    @property
    def count(self) -> int:
        """Rotations of a turn N."""
        return self.joints.shape[1]

    @cached_property
    def flat(self) -> Array:
        """Return coordinates of the joints whose distances bound the cost from below.

        Returns
        -------
        (m, COARSE, 2 axes) array
            At each of COARSE rotations. Distances of rows are at most the distances of
            the joints, so eq. 17 of a step is at least their square.
        """
        samples, scale = self.joints[:, :: self.count // COARSE], np.sqrt(self.weights)
        return np.concatenate(
            [
                np.where(self.turning, np.cos(samples), samples) * scale,
                np.where(self.turning, np.sin(samples), 0.0) * scale,
            ],
            axis=2,
        )


def lattice(task: Task, points: Points, rows: Index, threshold: Array, count: int) -> Lattice:
    """Build the lattice of selected points.

    Parameters
    ----------
    task : Task
        The plan, with limits.
    points : Points
        The points.
    rows : (m,) int array
        The selected points.
    threshold : (m,) array
        Smallest condition allowed there.
    count : int
        Number N of rotations, a multiple of COARSE.

    Returns
    -------
    Lattice
        The joints and the possible cells at these points.
    """
    ends = _rotations(task, points, rows, count)
    joints = task.raw_joints(
        points.select_points(np.repeat(rows, count)), np.tile(ends[:-1], len(rows))
    ).reshape(len(rows), count, -1)
    return Lattice(
        joints,
        _possible(task, points, rows, threshold, ends),
        task.weights,
        ~task.cell.machine.chain.sliding,
    )


def _rotations(task: Task, points: Points, rows: Index, count: int) -> Array:
    """Return rotations (count + 1,) over a turn, closer together where joints move more at one of
    the points; the last is a turn after the first.
    """
    phi = -np.pi + TURN / RATE_SAMPLES * np.arange(RATE_SAMPLES)
    joints = task.raw_joints(
        points.select_points(np.repeat(rows, len(phi))), np.tile(phi, len(rows))
    ).reshape(len(rows), len(phi), -1)
    moved = np.nan_to_num(shortest(np.roll(joints, -1, axis=1) - joints))
    rate = np.sqrt(((moved * moved) @ task.weights).max(axis=0))
    if not rate.any():
        return np.linspace(-np.pi, np.pi, count + 1)
    rate = np.minimum(rate / rate.mean(), LARGEST_SHARE)
    order = np.arange(1, HARMONICS + 1)
    # use the harmonics of a smooth density: its integral is exact, and joint paths do not get
    # sharper bends
    smooth = np.exp(-0.5 * (np.arange(HARMONICS + 1) * SMOOTH) ** 2)
    waves = np.fft.rfft(EVENLY + (1.0 - EVENLY) * rate)[: HARMONICS + 1] * smooth
    factor = (
        2.0
        * waves[1:]
        / waves[0].real
        * np.exp(1j * order * np.pi - 0.5j * order * TURN / RATE_SAMPLES)
    )

    def cumulative(phi: Array) -> tuple[Array, Array]:
        wave = np.exp(1j * phi[:, None] * order) * factor
        return phi + (wave / (1j * order)).real.sum(axis=1), 1.0 + wave.real.sum(axis=1)

    samples = np.linspace(-np.pi, np.pi, KNOWN + 1)
    up_to = cumulative(samples)[0]
    targets = up_to[0] + TURN * np.arange(count + 1) / count
    rotations = np.interp(targets, up_to, samples)
    for _ in range(3):
        value, slope = cumulative(rotations)
        rotations -= (value - targets) / slope
    return rotations


def _possible(task: Task, points: Points, rows: Index, threshold: Array, ends: Array) -> Mask:
    def looked(point: Index, cell: Index, ends: Array) -> Mask:
        middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
        return possible(task, points, rows[point], middle[cell], half[cell], threshold[point])

    stride = (len(ends) - 1) // COARSE
    point, cell = np.divmod(np.arange(len(rows) * COARSE), COARSE)
    coarse = looked(point, cell, ends[::stride]).reshape(len(rows), COARSE)
    fine = np.repeat(coarse, stride, axis=1)
    inside = coarse & np.roll(coarse, 1, axis=1) & np.roll(coarse, -1, axis=1)
    edge = np.nonzero(np.repeat(coarse & ~inside, stride, axis=1))
    if len(edge[0]):
        fine[edge] = looked(edge[0], edge[1], ends)
    return fine
