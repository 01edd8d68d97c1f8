# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lattice of joints at bead points, for N rotations about the tool axis at each point."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...geometry.frames import TURN, shortest
from ...kinematics import jacobian as jac
from ...types import Array, Index, Mask
from ..points import Points
from ..task import Task

CELLS, PARTS = 36, 3  # initial number of cells per turn, and parts of a subdivided cell


def whole_turn() -> tuple[Array, float]:
    """Divide a full turn into CELLS equal cells.

    Returns
    -------
    middles : (CELLS,) array
        Midpoint of each cell, -pi to pi, rad.
    half : float
        Half the cell width, rad.
    """
    half = np.pi / CELLS
    return -np.pi + half * (2.0 * np.arange(CELLS) + 1.0), half


def divided(phi: Array, half: float) -> Array:
    """Divide each cell into PARTS equal parts.

    Parameters
    ----------
    phi : (n,) array
        Midpoints of the cells, rad.
    half : float
        Half the cell width, rad.

    Returns
    -------
    (PARTS n,) array
        Midpoints of the parts, cell by cell, rad.
    """
    offsets = (2.0 * np.arange(PARTS) - (PARTS - 1)) * half / PARTS
    return np.asarray((phi[:, None] + offsets).ravel())


def possible(
    task: Task, points: Points, index: Index, phi: Array, half: Array, threshold: Array
) -> Mask:
    """Return in which cells a rotation may keep limits and condition.

    The result follows from the midpoint and ends of each cell. The curvature of the joints in
    between is assumed to be at most twice their second differences.

    Parameters
    ----------
    task : Task
        The plan, including limits.
    points : Points
        The points.
    index : (n,) int array
        Point index of each cell.
    phi, half : (n,) array
        Midpoint and half width of each cell, rad.
    threshold : (n,) array
        Required minimum condition.

    Returns
    -------
    (n,) bool array
        False for a cell without a feasible rotation.
    """
    count = len(phi)
    begins = ~_goes_on(index, phi, half)  # the previous cell does not end where this cell begins
    sampled = np.concatenate([phi[begins] - half[begins], phi, phi + half])
    sampled_points = points.select_points(np.concatenate([index[begins], index, index]))
    joints, begin_count = task.raw_joints(sampled_points, sampled), int(begins.sum())
    rows = begin_count + np.arange(2 * count).reshape(2, count)
    rows = np.stack([np.where(begins, np.cumsum(begins) - 1, rows[1] - 1), *rows])
    previous, middle, following = joints[rows]
    ahead, behind = _short(following - middle), _short(middle - previous)
    # extrapolate a cell at the edge of reach beyond this edge
    lost_ahead, lost_behind = (np.isnan(difference).any(axis=1) for difference in (ahead, behind))
    feasible = np.isfinite(middle).all(axis=1) & ~(lost_ahead & lost_behind)
    ahead, behind = (
        np.where(lost_ahead[:, None], behind, ahead),
        np.where(lost_behind[:, None], ahead, behind),
    )
    turned, bend = 0.5 * np.abs(ahead + behind), np.abs(ahead - behind)
    # a line through the ends of a parabola deviates by up to a quarter of its second difference:
    # allow twice this deviation
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
    """Whether each cell (n,) phi +- half begins where the previous cell of its point ends."""
    continues = np.zeros(len(phi), dtype=bool)
    gap = np.abs(phi[1:] - phi[:-1] - half[1:] - half[:-1])
    continues[1:] = (index[1:] == index[:-1]) & (gap < 1e-6 * half[1:])
    return continues


def _within_limits(task: Task, joints: Array, reach: Array) -> Mask:
    """Whether joints (n, axes) may be within limits if moved by `reach` and by whole turns."""
    limits = task.cell.limits
    beyond = np.abs(_short(joints - task.middle)) - np.where(
        task.continuous, np.inf, 0.5 * (limits.upper - limits.lower)
    )
    return np.asarray((beyond <= reach).all(axis=1))


def _condition(
    task: Task, points: Points, phi: Array, joints: Array, rows: Index, threshold: Array
) -> Array:
    """Return the condition at selected rows; 0 out of reach.

    A lower bound replaces the condition where it is far above the threshold.
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
)  # number of rotations at which joint rates are sampled, and number of harmonics
SMOOTH = 0.06  # rad; smoothing width of the density
KNOWN = 1000  # number of samples for interpolating the lattice rotations
EVENLY = 0.25  # fraction of the density that is even; the rest follows joint motion
LARGEST_SHARE = 12.0  # maximum joint rate, relative to the mean
COARSE = 60  # cells per turn in the first pass; cells next to an impossible cell are refined


@dataclass(frozen=True, eq=False)
class Lattice:
    """A lattice of m points with N rotations starting at -pi; N is a multiple of COARSE.

    joints: (m, N, axes) rad or mm, NaN out of reach. possible: (m, N) whether a rotation between
    this one and the next may keep limits and condition. weights: (axes,) of eq. 17. turning:
    (axes,) axes for which whole turns have no cost.
    """

    joints: Array
    possible: Mask
    weights: Array
    turning: Mask

    @cached_property
    def passable(self) -> Mask:
        """(m, N) reachable rotations at the ends of possible cells."""
        ends: Mask = (self.possible | np.roll(self.possible, 1, axis=1)) & np.isfinite(
            self.joints
        ).all(axis=2)
        return ends

    @cached_property
    def closed_cells(self) -> Mask:
        """(m, N) possible cells with both ends within reach."""
        return np.asarray(self.possible & self.passable & np.roll(self.passable, -1, axis=1))

    @cached_property
    def ragged(self) -> Mask:
        """(m, N) rotations of a possible cell whose other end is out of reach."""
        torn = self.possible & ~self.closed_cells
        return np.asarray(self.passable & (torn | np.roll(torn, 1, axis=1)))

    @cached_property
    def about(self) -> tuple[Array, Array]:
        """Return the range around each rotation in which cells are closed.

        Returns
        -------
        low, high : (m, N) array
            In lattice steps, from -0.5 to 0.5; up to 1 if the next rotation has no closed cell
            beyond it.
        """
        right_closed, left_closed = self.closed_cells, np.roll(self.closed_cells, 1, axis=1)
        low = np.where(left_closed, np.where(np.roll(left_closed, 1, axis=1), -0.5, -1.0), 0.0)
        return low, np.where(
            right_closed, np.where(np.roll(right_closed, -1, axis=1), 0.5, 1.0), 0.0
        )

    @cached_property
    def shift(self) -> Index:
        """(m, N) offset, in rotations, of the centre of five consecutive rotations.

        All five have closed cells; NO_FIVE if there are none.
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
        """Return the maximum square root of the cost of one lattice step.

        Returns
        -------
        (m,) array
            Square root of eq. 17 for one lattice step, maximum at each point.
        """
        moved = self.joint_steps(self.joints, np.roll(self.joints, -1, axis=1))
        return np.asarray(np.nan_to_num(np.sqrt((moved * moved) @ self.weights)).max(axis=1))

    def joint_steps(self, start: Array, end: Array) -> Array:
        """Return the joint steps, the short way for revolute axes.

        Parameters
        ----------
        start, end : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (..., axes) array
            Steps, rad or mm.
        """
        difference = end - start
        return np.where(self.turning, shortest(difference), difference)

    @property
    def first(self) -> Lattice:
        """The lattice of the first point only."""
        return Lattice(self.joints[:1], self.possible[:1], self.weights, self.turning)

    @property
    def count(self) -> int:
        """Number N of rotations per turn."""
        return self.joints.shape[1]

    @cached_property
    def flat(self) -> Array:
        """Return joint coordinates whose distances bound the cost from below.

        Returns
        -------
        (m, COARSE, 2 axes) array
            Coordinates at COARSE rotations. Their distances are at most the joint distances, so
            eq. 17 of a step is at least the squared distance.
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
        The plan, including limits.
    points : Points
        The points.
    rows : (m,) int array
        The selected points.
    threshold : (m,) array
        Required minimum condition at these points.
    count : int
        Number N of rotations; a multiple of COARSE.

    Returns
    -------
    Lattice
        Joints and possible cells at these points.
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
    """Return rotations (count + 1,) over a turn, denser where joints move more at any point.

    The last rotation is one turn after the first.
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
    # use the harmonics of a smooth density: its integral is exact, and joint paths stay smooth
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
