# SPDX-License-Identifier: LGPL-2.1-or-later
"""Looks whether the nozzle stays clear of deposit, platform and bodies on the rapid moves between beads.

While depositing, clearance is settled before the joints are planned. A rapid runs straight in the joints, so where the
nozzle goes is known only now: retract, travel and approach alike are driven through in small steps, against everything
deposited by then, and against the triangles of the bodies around the part.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..collision.bodies import Bodies
from ..collision.deposit import of_beads
from ..collision.frustum import beside_tip
from ..collision.nozzle import Nozzle, travelling
from ..collision.scene import scene
from ..collision.standing import standing_heights
from ..collision.tolerances import ABOVE_FACES
from ..geometry.surroundings import Body, disc
from ..issues import ERROR, Issue
from ..kinematics.cell import Cell
from ..motion import Motion

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

# largest turn of an axis between two looks, rad, and way of one that slides, mm
STEP = np.radians(5.0)
SLIDE = 5.0
# largest way of a point of the nozzle between two looks, mm: first with a nozzle as much thicker, then, where that meets
# anything, with the nozzle itself
COARSE = 5.0
FINE = 0.5
# length of the pieces the deposit is looked at as, mm
GRAIN = 1.5
# moves driven at once, so that large jobs need no more memory than small ones
MOVES = 4096


class Moves(NamedTuple):
    """Rapid moves: joints (k, axes) they start and end at, and how many deposit rows (k,) are there by then: the last of
    these is where the bead before ends, the one after it where the next starts."""

    start: Array
    end: Array
    laid: Index

    def of(self, rows: Index) -> Moves:
        """Those of the rows."""
        return Moves(self.start[rows], self.end[rows], self.laid[rows])


class Looks(NamedTuple):
    """Where the nozzle is looked at: tip and tool axis (l, 3) in part coordinates, the move (l,) and the share of it."""

    tip: Array
    axis: Array
    move: Index
    share: Array


class Deposit(NamedTuple):
    """Deposit rows in order: points, build directions and tool axes (m, 3), width and height (m,) mm of the beads, and
    whether each is the first of one (m,)."""

    points: Array
    build: Array
    tool: Array
    width: Array
    height: Array
    first: Mask


class _Ends(NamedTuple):
    """Ends of beads by a number: points (m, 3), NaN where there is none, and the heights (m,) mm that are left out there."""

    point: Array
    height: Array


class Surroundings:
    """What is in the way of rapids: beads of their width and height, with the row from which they are there, platform and
    bodies.

    Where the nozzle retracts from the end of a bead or comes to the start of one, it touches what it has laid and what that
    stands on, as while depositing: there its part below a height is left out, less the distance of the tip from that
    point. Against deposit it is the height to which the nozzle stands in it at the point (`standing_heights`), against
    bodies that at which its side is one diameter of the tip from the point. Withdrawn along its axis, a cone stays within
    the room that it had above that height: so nothing more need be left out, wherever the move leads.
    """

    def __init__(self, cell: Cell, deposit: Deposit, bodies: Sequence[Body]) -> None:
        self.cell = cell
        platform = [disc(cell.platform_diameter, cell.mount, "the platform")] if cell.platform_diameter > 0.0 else []
        self.bodies = (*bodies, *platform)
        self.laid = of_beads(deposit.points, deposit.build, deposit.width, deposit.height, deposit.first, grain=GRAIN)
        self._left, self._entered = self._ends(deposit)
        self._box = np.array([[np.inf] * 3, [-np.inf] * 3])
        self._bodies = scene((), deposit.points, 0.0).bodies

    def _ends(self, deposit: Deposit) -> tuple[_Ends, _Ends]:
        """Where beads are left and come to, by the number of rows (m + 1) that are there by then."""
        starts = np.flatnonzero(deposit.first)
        ends = np.append(starts[1:], len(deposit.points)) - 1
        rows, when = np.concatenate([ends, starts]), np.concatenate([ends + 1, starts])
        heights = standing_heights(
            self.laid, *_sizes(self.cell), deposit.points[rows], deposit.tool[rows], deposit.height[rows], when)
        found = []
        for some in np.split(np.arange(len(rows)), 2):
            point, height = np.full((len(deposit.points) + 1, 3), np.nan), np.zeros(len(deposit.points) + 1)
            point[when[some]], height[when[some]] = deposit.points[rows[some]], heights[some]
            found.append(_Ends(point, height))
        return found[0], found[1]

    def met(self, moves: Moves) -> Mask:
        """(k,) whether the nozzle meets anything on each of the moves; not on those whose joints are NaN."""
        met = np.zeros(len(moves.start), dtype=bool)
        known = np.flatnonzero(np.isfinite(moves.start + moves.end).all(axis=1))
        for first in range(0, len(known), MOVES):
            rows = known[first : first + MOVES]
            met[rows] = self._met(moves.of(rows))
        return met

    def names(self, moves: Moves) -> list[str]:
        """What is met on any of the moves: deposit, bodies by their names and the platform."""
        looks = _driven(self.cell, moves, FINE)
        nozzle = self._nozzle(moves, looks)
        found = ["the deposit"] if self._deposit_touched(nozzle, looks, moves).any() else []
        near = [(body.name, scene((body,), looks.tip, nozzle.reach).bodies) for body in self.bodies]
        return found + [name for name, one in near if one.touched(nozzle.bodies, looks.tip, looks.axis).any()]

    def _met(self, moves: Moves) -> Mask:
        looks = _driven(self.cell, moves, COARSE)
        near = self._touched(_thicker(self._nozzle(moves, looks), 0.5 * COARSE), looks, moves)
        before = np.flatnonzero((looks.move[1:] == looks.move[:-1]) & (near[1:] | near[:-1]))
        parts = int(np.ceil(COARSE / FINE))
        step = np.linspace(0.0, 1.0, parts + 1)
        share = looks.share[before, None] + step * (looks.share[before + 1] - looks.share[before])[:, None]
        close = _looks(self.cell, moves, np.repeat(looks.move[before], parts + 1), share.ravel())
        touched = self._touched(self._nozzle(moves, close), close, moves)
        return np.bincount(close.move, touched, minlength=len(moves.start)) > 0

    def _touched(self, nozzle: Nozzle, looks: Looks, moves: Moves) -> Mask:
        found = self._deposit_touched(nozzle, looks, moves)
        rows = np.flatnonzero(~found)
        if len(rows):
            tip = looks.tip[rows]
            found[rows] = self._around(tip).touched(nozzle.bodies.rows(rows), tip, looks.axis[rows])
        return found

    def _deposit_touched(self, nozzle: Nozzle, looks: Looks, moves: Moves) -> Mask:
        found: Mask = self.laid.touched(nozzle.deposit, looks.tip, looks.axis, moves.laid[looks.move])
        return found

    def _around(self, tip: Array) -> Bodies:
        """The bodies that nozzles at the tips (k, 3) may meet. Trees of bodies take long and are kept for the next moves."""
        low, high = tip.min(axis=0), tip.max(axis=0)
        if (low < self._box[0]).any() or (high > self._box[1]).any():
            # larger at once by half where it is too small, so that it seldom is again
            known = np.isfinite(self._box).all()
            more = 0.5 * (high - low) if known else np.zeros(3)
            least, most = self._box
            self._box = np.array([np.where(low < least, low - more, least), np.where(high > most, high + more, most)])
            radius, slope, length = _sizes(self.cell)
            reach = float(np.hypot(length, radius + slope * length))
            self._bodies = scene(self.bodies, self._box, reach).bodies
        return self._bodies

    def _nozzle(self, moves: Moves, looks: Looks) -> Nozzle:
        """The nozzle at each look, less what touches rightly near the ends of beads."""
        radius, slope, length = _sizes(self.cell)
        laid = moves.laid[looks.move]
        about = beside_tip(radius, slope) + ABOVE_FACES
        bodies, deposit = np.zeros(len(laid)), np.zeros(len(laid))
        for end in (self._left, self._entered):
            away = np.linalg.norm(looks.tip - end.point[laid], axis=1)
            bodies, deposit = np.fmax(bodies, about - away), np.fmax(deposit, end.height[laid] - away)
        return Nozzle(
            travelling(radius, slope, length, bodies).bodies, travelling(radius, slope, length, deposit).deposit)


def collisions(
    motion: Motion, cell: Cell, among: Collection[tuple[int, int]] | None = None, bodies: Sequence[Body] = ()
) -> list[Issue]:
    """An issue for every bead on the rapid way to which, or after the last one, the nozzle would meet deposit, platform or
    bodies; beads are lines here.

    Only the ways to the beads `among` (layer, bead) are looked at, where they are given.
    """
    rows, moves = moves_of(motion)
    if among is not None:
        chosen = np.array([(int(motion.layer[row]), int(motion.bead[row])) in among for row in rows], dtype=bool)
        rows, moves = rows[chosen], moves.of(np.flatnonzero(chosen))
    laid = motion.deposit
    none = np.zeros(int(laid.sum()))  # a motion does not tell how high its beads are
    deposit = Deposit(motion.position[laid], motion.build[laid], motion.tool[laid], none, none, motion.point[laid] == 0)
    surroundings = Surroundings(cell, deposit, bodies)
    met = surroundings.met(moves)
    places: dict[tuple[int, int], list[int]] = {}
    for k in np.flatnonzero(met).tolist():
        places.setdefault((int(motion.layer[rows[k]]), int(motion.bead[rows[k]])), []).append(k)
    return [
        collision(surroundings.names(moves.of(np.array(some))), layer, bead)
        for (layer, bead), some in places.items()
    ]


def collision(names: Sequence[str], layer: int, bead: int) -> Issue:
    """The issue about a bead on the rapid way to which the nozzle would meet what the names tell."""
    return Issue(
        ERROR, "RAPID_COLLISION",
        f"on its way from the bead before the nozzle would meet {', '.join(names)} at every retract distance and direction "
        "tried; move the seam or the part, or take a more slender nozzle", layer, bead,
    )


def moves_of(motion: Motion) -> tuple[Index, Moves]:
    """The rows (k,) of a motion that a rapid move leads to, and the moves. The way to its first row is not known."""
    rows = np.flatnonzero(~motion.deposit[1:]) + 1
    return rows, Moves(motion.joints[rows - 1], motion.joints[rows], np.searchsorted(np.flatnonzero(motion.deposit), rows))


def _driven(cell: Cell, moves: Moves, largest: float) -> Looks:
    """Looks along all moves, between which no point of the nozzle goes farther than the largest way, mm."""
    chain = cell.machine.chain
    steps = np.where(chain.sliding, SLIDE, STEP)
    count = 1 + np.ceil((np.abs(moves.end - moves.start) / steps).max(axis=1)).astype(np.intp)
    looks = _evenly(cell, moves, count)
    # an arm's tip goes far while its axes hardly turn
    same = looks.move[1:] == looks.move[:-1]
    way = np.linalg.norm(np.diff(looks.tip, axis=0), axis=1) + cell.nozzle.length * np.linalg.norm(
        np.diff(looks.axis, axis=0), axis=1)
    longest = np.zeros(len(count))
    np.maximum.at(longest, looks.move[1:][same], way[same])
    more = count * np.maximum(np.ceil(longest / largest).astype(np.intp), 1)
    return looks if (more == count).all() else _evenly(cell, moves, more)


def _evenly(cell: Cell, moves: Moves, count: Index) -> Looks:
    """One look more along each move than the count (k,)."""
    move = np.repeat(np.arange(len(count)), count + 1)
    step = np.arange(len(move)) - np.repeat(np.cumsum(count + 1) - count - 1, count + 1)
    return _looks(cell, moves, move, step / count[move])


def _looks(cell: Cell, moves: Moves, move: Index, share: Array) -> Looks:
    joints = moves.start[move] + share[:, None] * (moves.end - moves.start)[move]
    tip, axis = cell.tip_in_part(cell.machine.chain.forward(joints))
    return Looks(tip, axis, move, share)


def _thicker(nozzle: Nozzle, more: float) -> Nozzle:
    """A nozzle that holds all that is no farther than so many mm from the nozzle."""
    return Nozzle(*(
        replace(solid, radius=solid.radius + more * np.hypot(1.0, solid.slope), low=solid.low - more, high=solid.high + more)
        for solid in (nozzle.bodies, nozzle.deposit)
    ))


def _sizes(cell: Cell) -> tuple[float, float, float]:
    """Radius of the nozzle's tip, tangent of its half angle, and its length, mm."""
    nozzle = cell.nozzle
    return 0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)), nozzle.length
