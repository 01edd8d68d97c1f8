# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clearance of the nozzle from deposit, platform and bodies on rapids.

Clearance while depositing is settled before the joints are planned. Rapids are joint moves, so the
nozzle path is known only after joint planning. Retracts, travels and approaches are simulated in
small steps against the deposit at that time and the triangles of the surrounding bodies.
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

# maximum step between two checks: rad for revolute axes, mm for prismatic axes
STEP = np.radians(5.0)
SLIDE = 5.0
# maximum displacement of a nozzle point between two checks, mm: first with a nozzle thickened by as
# much, then with the actual nozzle where the thickened nozzle makes contact
COARSE = 5.0
FINE = 0.5
STRIDE = 8  # stride of the first check, which finds most collisions
# moves per batch, to limit memory
MOVES = 4096


class Moves(NamedTuple):
    """Rapid moves.

    start, end: (k, axes) joints. deposited: (k,) number of deposit rows printed before the move.
    The last of these rows ends the previous bead; the row after it starts the next bead.
    """

    start: Array
    end: Array
    deposited: Index

    def of(self, rows: Index) -> Moves:
        """Return selected moves."""
        return Moves(self.start[rows], self.end[rows], self.deposited[rows])


class Looks(NamedTuple):
    """Checked nozzle positions.

    tip, axis: (l, 3) in part coordinates. move: (l,) move index. share: (l,) fraction of the move.
    """

    tip: Array
    axis: Array
    move: Index
    share: Array

    def of(self, rows: Index) -> Looks:
        """Return selected nozzle positions."""
        return Looks(self.tip[rows], self.axis[rows], self.move[rows], self.share[rows])


Touching = Callable[[Nozzle, Looks], Mask]


class RapidObstacles:
    """The obstacles of rapids: beads with their width and height, platform and bodies.

    A bead is an obstacle only after it is printed.
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
        """Return the moves on which the nozzle hits an obstacle.

        Parameters
        ----------
        moves : Moves
            k moves.

        Returns
        -------
        (k,) array of bool
            True for collisions; False for moves with NaN joints.
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
        """Return the names of the obstacles that the nozzle hits: deposit, bodies and platform.

        Moves with NaN joints are ignored.
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
        """Return which moves (k,) hit an obstacle, by the contact test `touching`."""
        collides = np.zeros(len(moves.start), dtype=bool)
        looks = _evaluate_looks(self.cell, moves, COARSE)
        nozzle = self._nozzle(moves, looks)

        def mark(rows: Index) -> None:
            collides[looks.move[rows[touching(nozzle.rows(rows), looks.of(rows))]]] = True

        # most colliding moves run deep into the obstacle, so a few positions find them
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
        """Maximum distance of a nozzle point from the tip, mm."""
        radius, slope, length = self._size
        return float(np.hypot(length, radius + slope * length))

    def _nearby_bodies(self, tip: Array) -> Bodies:
        """Return the bodies near nozzles at tips (k, 3).

        Search trees of bodies are slow to build, so they are kept for later moves.
        """
        low, high = tip.min(axis=0), tip.max(axis=0)
        if (low < self._box[0]).any() or (high > self._box[1]).any():
            # enlarge a box that is too small by half, so that it seldom needs to grow again
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
        """Return the nozzle at each position, without the part in intended contact at bead ends."""
        return self._ends.nozzle(looks.tip, moves.deposited[looks.move])


def _evaluate_looks(cell: Cell, moves: Moves, largest: float) -> Looks:
    """Return nozzle positions along all moves.

    Between two positions, no nozzle point moves further than `largest` (mm).
    """
    chain = cell.machine.chain
    steps = np.where(chain.sliding, SLIDE, STEP)
    count = 1 + step_counts((np.abs(moves.end - moves.start) / steps).max(axis=1), 1.0, 0)
    looks = _evenly(cell, moves, count)
    # the tip may travel far while the axes hardly rotate
    same = looks.move[1:] == looks.move[:-1]
    travel = np.linalg.norm(
        np.diff(looks.tip, axis=0), axis=1
    ) + cell.nozzle.length * np.linalg.norm(np.diff(looks.axis, axis=0), axis=1)
    longest = np.zeros(len(count))
    np.maximum.at(longest, looks.move[1:][same], travel[same])
    finer_count = count * step_counts(longest, largest)
    return looks if (finer_count == count).all() else _evenly(cell, moves, finer_count)


def _evenly(cell: Cell, moves: Moves, count: Index) -> Looks:
    """Return `count` + 1 (k,) evenly spaced nozzle positions along each move."""
    return _looks(cell, moves, *evenly(count))


def evenly(count: Index) -> tuple[Index, Array]:
    """Return evenly spaced positions along moves.

    Parameters
    ----------
    count : (k,) int array
        Number of intervals per move.

    Returns
    -------
    move : (n,) int array
        Move index of each position.
    share : (n,) array
        Fraction of the move, including both ends.
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
    """Return a nozzle that contains all points within `thickness` mm of the given nozzle."""
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
