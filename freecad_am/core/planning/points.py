# SPDX-License-Identifier: LGPL-2.1-or-later
"""The points of many beads in one set of arrays, so that all layers are computed at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from ..geometry.frames import TURN, shortest
from ..kinematics.cell import Cell
from ..kinematics.limits import PoseFrames
from ..toolpath import Bead
from ..types import Array, Integers, Mask

PIECE = 4096  # points per batch of poses and Jacobians, to limit memory
UNPOSED = PoseFrames(np.zeros((0, 4, 4)), 1.0, np.zeros((0, 4, 4)))


@dataclass(frozen=True, eq=False)
class Points:
    """T points of B beads.

    position, tool: (T, 3) part frame. parameter: (T,) polynomial variable. first: (B,) index of the
    first point of each bead. bead: (T,) bead index of each point. closed: (B,) bool, whether the
    bead ends where it starts. frames: pose frames of the points. external: (T, k) external axis
    values; None without external axes. sliding: (axes,) bool, prismatic axes; None without any.
    """

    position: Array
    tool: Array
    parameter: Array
    first: Integers
    bead: Integers
    closed: Mask
    frames: PoseFrames
    external: Array | None = None
    sliding: Mask | None = None

    def __len__(self) -> int:
        return len(self.position)

    @property
    def beads(self) -> int:
        """Number of beads B."""
        return len(self.first)

    @property
    def ends(self) -> tuple[Array, Array]:
        """Return the parameter at the ends of each bead.

        Returns
        -------
        first, last : (B,) array
            Parameter at the first and last point.
        """
        return self.parameter[self.first], self.parameter[np.append(self.first[1:], len(self)) - 1]

    @cached_property
    def starts(self) -> Mask:
        """(T,) bool, True at the first point of each bead."""
        starts = np.zeros(len(self.position), dtype=bool)
        starts[self.first] = True
        return starts

    def select_points(self, index: Integers) -> Points:
        """Return selected points, each as a separate bead.

        Parameters
        ----------
        index : (n,) array of int
            Point indices.

        Returns
        -------
        Points
            n points of n open beads.
        """
        numbers = np.arange(len(index))
        return Points(
            self.position[index],
            self.tool[index],
            self.parameter[index],
            numbers,
            numbers,
            np.zeros(len(index), dtype=bool),
            self.frames.of(index),
            None if self.external is None else self.external[index],
            self.sliding,
        )

    def only(self, bead: int) -> tuple[Points, slice]:
        """Return the points of one bead.

        Parameters
        ----------
        bead : int
            Bead index.

        Returns
        -------
        points : Points
            Points of this bead.
        rows : slice
            Rows of the bead among all points.
        """
        ends = np.append(self.first, len(self))
        rows = slice(int(ends[bead]), int(ends[bead + 1]))
        none = np.zeros(rows.stop - rows.start, dtype=np.int64)
        points = Points(
            self.position[rows],
            self.tool[rows],
            self.parameter[rows],
            none[:1],
            none,
            self.closed[bead : bead + 1],
            self.frames.of(rows),
            None if self.external is None else self.external[rows],
            self.sliding,
        )
        return points, rows

    def powers(self, degree: int) -> Array:
        """Return the powers of the parameter.

        Parameters
        ----------
        degree : int
            Highest power.

        Returns
        -------
        (T, degree + 1) array
            Powers in ascending order.
        """
        return np.vander(self.parameter, degree + 1, increasing=True)

    def polynomial(self, coefficients: Array) -> Array:
        """Evaluate the polynomial of each bead at its points.

        Parameters
        ----------
        coefficients : (B, degree + 1) array
            Coefficients in ascending order.

        Returns
        -------
        (T,) array
            The values.
        """
        value = np.zeros(len(self.position))
        for column in coefficients.T[::-1]:
            value = value * self.parameter + column[self.bead]
        return value

    def worst(self, values: Array) -> Array:
        """Return the minimum value of each bead.

        Parameters
        ----------
        values : (..., T) array
            Values at the points.

        Returns
        -------
        (..., B) array
            Minima.
        """
        smallest: Array = np.minimum.reduceat(values, self.first, axis=-1)
        return smallest

    def spread_to_points(self, values: Array) -> Array:
        """Repeat the values of each bead at its points.

        Parameters
        ----------
        values : (..., B, axes) array
            One value per bead and axis.

        Returns
        -------
        (..., T, axes) array
            Values at the points, contiguous per axis.
        """
        return np.swapaxes(np.swapaxes(values, -1, -2)[..., self.bead], -1, -2)

    def total(self, values: Array) -> Array:
        """Return the sum of the values of each bead.

        Parameters
        ----------
        values : (..., T) array
            Values at the points.

        Returns
        -------
        (..., B) array
            Sums.
        """
        total: Array = np.add.reduceat(values, self.first, axis=-1)
        return total


def gather(
    beads: Sequence[Bead], cell: Cell, max_points: int | None = None, posed: bool = True
) -> Points:
    """Return the points of beads in one set of arrays.

    Parameters
    ----------
    beads : sequence of Bead
        The B beads.
    cell : Cell
        The cell, for pose frames and external axes.
    max_points : int or None, optional
        Maximum number of points per bead and per turn about the axis, including both ends. None
        for all points.
    posed : bool, optional
        Whether to compute the pose frames; otherwise they are empty.

    Returns
    -------
    Points
        T points in the part frame.
    """
    rows = [thinned(bead, max_points) for bead in beads]
    counts = np.array([len(index) for index in rows])
    position = np.concatenate([bead.points[index] for bead, index in zip(beads, rows)])
    tool = np.concatenate([bead.tool[index] for bead, index in zip(beads, rows)])
    external = None
    if cell.external is not None:
        external = np.concatenate(
            [bead.external[index] for bead, index in zip(beads, rows) if bead.external is not None]
        )
    return Points(
        position=position,
        tool=tool,
        parameter=np.concatenate([bead.parameter[index] for bead, index in zip(beads, rows)]),
        first=np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(np.int64),
        bead=np.repeat(np.arange(len(beads)), counts),
        closed=np.array([bead.closed for bead in beads], dtype=bool),
        frames=_frames_of(cell, position, tool, external) if posed else UNPOSED,
        external=external,
        sliding=cell.machine.chain.sliding if cell.machine.chain.sliding.any() else None,
    )


def in_pieces(count: int) -> list[slice]:
    """Return slices that divide `count` points into batches."""
    return [slice(start, start + PIECE) for start in range(0, count, PIECE)]


def _frames_of(cell: Cell, position: Array, tool: Array, external: Array | None) -> PoseFrames:
    """Return `cell.pose_frames`, computed in batches to limit the memory of intermediate arrays."""
    frame_groups = [
        cell.pose_frames(position[rows], tool[rows], None if external is None else external[rows])
        for rows in in_pieces(len(position))
    ]
    if cell.arrangement.carries_part:
        return PoseFrames(
            frame_groups[0].left,
            frame_groups[0].sign,
            np.concatenate([group.right for group in frame_groups]),
        )
    return PoseFrames(
        np.concatenate([group.left for group in frame_groups]),
        frame_groups[0].sign,
        frame_groups[0].right,
    )


def thinned(bead: Bead, max_points: int | None) -> Integers:
    """Return evenly spaced points of a bead.

    Parameters
    ----------
    bead : Bead
        The bead.
    max_points : int or None
        Maximum number of points per turn about the axis; None for all points.

    Returns
    -------
    (k,) array of int
        Point indices.
    """
    if max_points is None:
        return np.arange(len(bead))
    turns = abs(bead.parameter[-1] - bead.parameter[0]) / TURN
    max_points = max(max_points, int(np.ceil((max_points - 1) * turns)) + 1)
    if len(bead) <= max_points:
        return np.arange(len(bead))
    return _evenly(len(bead), max_points)


@lru_cache(maxsize=64)
def _evenly(count: int, max_points: int) -> Integers:
    """Return evenly spaced indices, including both ends.

    Cached, because many beads have the same number of points.
    """
    rows: Integers = np.unique(np.round(np.linspace(0, count - 1, max_points)).astype(np.int64))
    rows.flags.writeable = False
    return rows


def steps(joints: Array, points: Points) -> Array:
    """Return the joint steps between consecutive points.

    Parameters
    ----------
    joints : (..., T, axes) array
        Joints, rad or mm.
    points : Points
        The T points.

    Returns
    -------
    (..., T, axes) array
        Step from the previous point, the short way for revolute axes; 0 at the first point of a
        bead.
    """
    step = np.zeros_like(joints)
    np.subtract(joints[..., 1:, :], joints[..., :-1, :], out=step[..., 1:, :])
    step[..., points.first, :] = 0.0
    if (
        not max(step.max(initial=0.0), -step.min(initial=0.0)) <= 0.5 * TURN
    ):  # otherwise every step already is the short way
        long = np.abs(step) > 0.5 * TURN
        if points.sliding is not None:
            long &= ~points.sliding
        step[long] = shortest(step[long])
    return step


def unwrapped(joints: Array, points: Points) -> Array:
    """Unwrap joints along each bead, starting at its first point.

    Parameters
    ----------
    joints : (..., T, axes) array
        Joints, rad or mm.
    points : Points
        The T points.

    Returns
    -------
    (..., T, axes) array
        Unwrapped joints; NaN from the first NaN point of a bead on.
    """
    rising = steps(joints, points)
    unreachable = np.isnan(rising)
    any_lost = bool(unreachable.any())
    if any_lost:
        rising[unreachable] = 0.0
        unreachable = np.cumsum(unreachable, axis=-2)
        unreachable = unreachable > points.spread_to_points(unreachable[..., points.first, :])
    np.cumsum(rising, axis=-2, out=rising)
    rising += points.spread_to_points(joints[..., points.first, :] - rising[..., points.first, :])
    if any_lost:
        rising[unreachable] = np.nan
    return rising


def unwrapped_by_turns(joints: Array, points: Points) -> Array:
    """Unwrap reachable joints in a third of the time of `unwrapped`.

    The result equals `unwrapped` up to rounding. Only axes with steps over half a turn change.

    Parameters
    ----------
    joints : (..., T, axes) array
        Joints without NaN, rad or mm.
    points : Points
        The T points.

    Returns
    -------
    (..., T, axes) array
        Unwrapped joints.
    """
    step = np.diff(joints, axis=-2)
    leading_axes = tuple(range(step.ndim - 1))
    takes_turns = (
        np.maximum(
            step.max(axis=leading_axes, initial=0.0), -step.min(axis=leading_axes, initial=0.0)
        )
        > 0.5 * TURN
    )
    if points.sliding is not None:
        takes_turns &= ~points.sliding
    result = joints.copy(order="K")
    for axis in np.flatnonzero(takes_turns).tolist():
        result[..., axis] -= whole_turns(step[..., axis], points)
    return result


def whole_turns(step: Array, points: Points) -> Array:
    """Return the accumulated whole turns of an angle along each bead.

    Parameters
    ----------
    step : (..., T - 1) array
        Step of the angle between consecutive points, rad.
    points : Points
        The T points.

    Returns
    -------
    (..., T) array
        Angle to subtract so that each step is the short way, rad; 0 at the first point of a
        bead.
    """
    turns = np.zeros((*step.shape[:-1], len(points)), dtype=np.int32)
    turns[..., 1:] = np.rint(step / TURN)
    turns[..., points.first] = 0
    np.cumsum(turns, axis=-1, out=turns)
    turns -= turns[..., points.first][..., points.bead]
    angles: Array = TURN * turns
    return angles
