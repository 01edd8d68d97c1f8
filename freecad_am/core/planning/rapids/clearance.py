# SPDX-License-Identifier: LGPL-2.1-or-later
"""Looks whether the nozzle stays clear of deposit, platform and bodies on the rapid moves between beads.

While depositing, clearance is settled before the joints are planned. A rapid runs straight in the joints, so where the
nozzle goes is known only now: retract, travel and approach alike are driven through in small steps, against everything
deposited by then, and against the triangles of the bodies around the part.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...collision.bead_ends import BeadEnds, Beads, Size
from ...collision.scene import Bodies, Nozzle, scene
from ...geometry.obstacles import Body, disc
from ...geometry.step_count import step_counts
from ...kinematics.cell import Cell
from ...types import Array, Index, Mask

# largest turn of an axis between two looks, rad, and way of one that slides, mm
STEP = np.radians(5.0)
SLIDE = 5.0
# largest way of a point of the nozzle between two looks, mm: first with a nozzle as much thicker, then, where that meets
# anything, with the nozzle itself
COARSE = 5.0
FINE = 0.5
STRIDE = 8  # one position in STRIDE is enough to find most collisions
# moves driven at once, so that large jobs need no more memory than small ones
MOVES = 4096


class Moves(NamedTuple):
    """Rapid moves: joints (k, axes) they start and end at, and how many deposit rows (k,) are there by then: the last of
    these is where the bead before ends, the one after it where the next starts."""

    start: Array
    end: Array
    deposited: Index

    def of(self, rows: Index) -> Moves:
        """Return the moves of the rows."""
        return Moves(self.start[rows], self.end[rows], self.deposited[rows])


class Looks(NamedTuple):
    """Checked nozzle positions: tip and tool axis (l, 3) in part coordinates, the move (l,) and the
    share of it.
    """

    tip: Array
    axis: Array
    move: Index
    share: Array

    def of(self, rows: Index) -> Looks:
        """Return the nozzle positions of the rows."""
        return Looks(self.tip[rows], self.axis[rows], self.move[rows], self.share[rows])


Touching = Callable[[Nozzle, Looks], Mask]


class RapidObstacles:
    """The obstacles of rapids: beads of their width and height, platform and bodies.

    A bead counts from the row on at which it exists.
    """

    def __init__(self, cell: Cell, deposit: Beads, bodies: Sequence[Body]) -> None:
        self.cell = cell
        platform = (
            [disc(cell.platform_diameter, cell.poses.mount, "the platform")]
            if cell.platform_diameter > 0.0
            else []
        )
        self.bodies = (*bodies, *platform, *cell.in_part())
        nozzle = cell.nozzle
        self._size = Size(0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)), nozzle.length)
        self._ends = BeadEnds.of(deposit, self._size)
        self.deposited = self._ends.deposit
        self._box = np.array([[np.inf] * 3, [-np.inf] * 3])
        self._bodies = scene((), deposit.points, 0.0).bodies

    def find_collisions(self, moves: Moves) -> Mask:
        """Return on which moves the nozzle meets an obstacle.

        Parameters
        ----------
        moves : Moves
            k moves.

        Returns
        -------
        (k,) array of bool
            False for moves whose joints are NaN.
        """
        collides = np.zeros(len(moves.start), dtype=bool)
        reachable = np.flatnonzero(np.isfinite(moves.start + moves.end).all(axis=1))
        for begin in range(0, len(reachable), MOVES):
            rows = reachable[begin : begin + MOVES]
            batch = moves.of(rows)
            collides[rows] = self._find_collisions(
                batch, functools.partial(self._test_contact, moves=batch)
            )
        return collides

    def names(self, moves: Moves) -> list[str]:
        """Return the obstacles met on the moves, except moves whose joints are NaN: deposit, bodies by their
        names, the platform.
        """
        moves = moves.of(np.flatnonzero(np.isfinite(moves.start + moves.end).all(axis=1)))
        if not len(moves.start):
            return []
        tip = _evaluate_looks(self.cell, moves, COARSE).tip
        reach = self._reach + COARSE
        touching: dict[str, Touching] = {
            "the deposit": functools.partial(self._deposit_touched, moves=moves)
        }
        for body in self.bodies:
            touching[body.name] = functools.partial(
                _body_touched, scene((body,), tip, reach).bodies
            )
        return [
            name
            for name, touched in touching.items()
            if self._find_collisions(moves, touched).any()
        ]

    def _find_collisions(self, moves: Moves, touching: Touching) -> Mask:
        """Return whether (k,) each of the moves meets an obstacle, by the test `touching` of nozzle positions."""
        collides = np.zeros(len(moves.start), dtype=bool)
        looks = _evaluate_looks(self.cell, moves, COARSE)
        nozzle = self._nozzle(moves, looks)

        def mark(rows: Index) -> None:
            collides[looks.move[rows[touching(nozzle.rows(rows), looks.of(rows))]]] = True

        # most moves that meet an obstacle run deep into it: few positions suffice to find that
        mark(np.arange(0, len(looks.move), STRIDE))
        pending = np.flatnonzero(~collides[looks.move])
        close_looks = np.zeros(len(looks.move), dtype=bool)
        close_looks[pending] = touching(
            _thicker(nozzle, 0.5 * COARSE).rows(pending), looks.of(pending)
        )
        mark(np.flatnonzero(close_looks))
        segments = np.flatnonzero(
            (looks.move[1:] == looks.move[:-1])
            & (close_looks[1:] | close_looks[:-1])
            & ~collides[looks.move[:-1]]
        )
        pieces_per_step = int(np.ceil(COARSE / FINE))
        step = np.linspace(0.0, 1.0, pieces_per_step + 1)
        share = (
            looks.share[segments, None]
            + step * (looks.share[segments + 1] - looks.share[segments])[:, None]
        )
        close = _looks(
            self.cell, moves, np.repeat(looks.move[segments], pieces_per_step + 1), share.ravel()
        )
        touched = touching(self._nozzle(moves, close), close)
        return collides | (np.bincount(close.move, touched, minlength=len(moves.start)) > 0)

    def _test_contact(self, nozzle: Nozzle, looks: Looks, moves: Moves) -> Mask:
        touched = self._deposit_touched(nozzle, looks, moves)
        rows = np.flatnonzero(~touched)
        if len(rows):
            tip = looks.tip[rows]
            touched[rows] = self._nearby_bodies(tip).find_touching(
                nozzle.bodies.rows(rows), tip, looks.axis[rows]
            )
        return touched

    def _deposit_touched(self, nozzle: Nozzle, looks: Looks, moves: Moves) -> Mask:
        touched: Mask = self.deposited.find_touching(
            nozzle.deposit, looks.tip, looks.axis, moves.deposited[looks.move]
        )
        return touched

    @property
    def _reach(self) -> float:
        """Largest distance of a point of the nozzle from its tip, mm."""
        radius, slope, length = self._size
        return float(np.hypot(length, radius + slope * length))

    def _nearby_bodies(self, tip: Array) -> Bodies:
        """The bodies that nozzles at the tips (k, 3) may meet. Trees of bodies take long and are kept for the next moves."""
        low, high = tip.min(axis=0), tip.max(axis=0)
        if (low < self._box[0]).any() or (high > self._box[1]).any():
            # larger at once by half where it is too small, so that it seldom is again
            is_known = np.isfinite(self._box).all()
            extra = 0.5 * (high - low) if is_known else np.zeros(3)
            lowest, highest = self._box
            self._box = np.array(
                [
                    np.where(low < lowest, low - extra, lowest),
                    np.where(high > highest, high + extra, highest),
                ]
            )
            self._bodies = scene(self.bodies, self._box, self._reach).bodies
        return self._bodies

    def _nozzle(self, moves: Moves, looks: Looks) -> Nozzle:
        """The nozzle at each look, less what touches rightly near the ends of beads."""
        return self._ends.nozzle(looks.tip, moves.deposited[looks.move])


def _evaluate_looks(cell: Cell, moves: Moves, largest: float) -> Looks:
    """Looks along all moves, between which no point of the nozzle goes farther than the largest way, mm."""
    chain = cell.machine.chain
    steps = np.where(chain.sliding, SLIDE, STEP)
    count = 1 + step_counts((np.abs(moves.end - moves.start) / steps).max(axis=1), 1.0, 0)
    looks = _evenly(cell, moves, count)
    # an arm's tip goes far while its axes hardly turn
    same = looks.move[1:] == looks.move[:-1]
    travel = np.linalg.norm(
        np.diff(looks.tip, axis=0), axis=1
    ) + cell.nozzle.length * np.linalg.norm(np.diff(looks.axis, axis=0), axis=1)
    longest = np.zeros(len(count))
    np.maximum.at(longest, looks.move[1:][same], travel[same])
    finer_count = count * step_counts(longest, largest)
    return looks if (finer_count == count).all() else _evenly(cell, moves, finer_count)


def _evenly(cell: Cell, moves: Moves, count: Index) -> Looks:
    """One look more along each move than the count (k,)."""
    return _looks(cell, moves, *evenly(count))


def evenly(count: Index) -> tuple[Index, Array]:
    """Spread positions evenly along moves.

    Parameters
    ----------
    count : (k,) int array
        Number of intervals on each move.

    Returns
    -------
    move : (n,) int array
        Move of each position.
    share : (n,) array
        Share of the move, both ends included.
    """
    move = np.repeat(np.arange(len(count)), count + 1)
    step = np.arange(len(move)) - np.repeat(np.cumsum(count + 1) - count - 1, count + 1)
    return move, step / count[move]


def _looks(cell: Cell, moves: Moves, move: Index, share: Array) -> Looks:
    joints = moves.start[move] + share[:, None] * (moves.end - moves.start)[move]
    tip, axis = cell.tip_in_part(cell.machine.chain.forward(joints))
    return Looks(tip, axis, move, share)


def _body_touched(bodies: Bodies, nozzle: Nozzle, looks: Looks) -> Mask:
    return bodies.find_touching(nozzle.bodies, looks.tip, looks.axis)


def _thicker(nozzle: Nozzle, thickness: float) -> Nozzle:
    """Return a nozzle that contains every point within `thickness` mm of the nozzle."""
    return Nozzle(
        *(
            replace(
                solid,
                radius=solid.radius + thickness * np.hypot(1.0, solid.slope),
                low=solid.low - thickness,
                high=solid.high + thickness,
            )
            for solid in (nozzle.bodies, nozzle.deposit)
        )
    )
