# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotations at which the links of the robot stay clear.

Those at which a link comes too near are not candidates of the search. What the local search makes of one that is clear may
come too near again: then it is made once more with how far links are off, and how that changes, among its constraints, from
the polynomial that goes furthest towards the first and stays clear. Where that finds nothing clear, this one is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...geometry.angles import TURN
from ...issues import Issue
from ...kinematics.links.rounds import NONE
from ...toolpath import Bead
from ...types import Array, Mask
from ..joint_path import BeadPath
from ..limit_rows import UNREACHABLE
from ..points import Points, gather
from ..rotation.refine import Refined
from ..rotation.search import Found
from ..task import FITS, Task, condition_margin
from .kept import ArmKept, Place, clearance_issue
from .refined import refined_clear

FIRST_LOOK, TURNS = (
    4,
    72,
)  # candidates of a bead looked at before there is a map, and rotations of that
ENDS = 3  # points of a bead looked at before all of them: where no rotation serves one of these, none serves the bead
POINTS_PER_BEAD = 24  # and turn, at which the links are looked at
SHARES = (0.75, 0.5, 0.25, 0.0)  # of the way from where the local search began to what it found
TOUCHING = -1e-3  # margin of the candidate that is planned where none is clear, so that what is in its way can be named


def without_touching(
    task: Task, kept: ArmKept, points: Points, places: Sequence[Place], found: Found
) -> Found:
    """The candidates, without a margin where a link comes too near: of each bead the best ones are looked at themselves,
    until one is clear; where the first few are not, all by a map of the rotations at which links come too near. Where none
    is clear the one that was best has next to none."""
    margin, each = found.margin.copy(), np.arange(points.beads)
    left = np.ones(points.beads, dtype=bool)
    for attempt in range(3 * FIRST_LOOK):
        if attempt == FIRST_LOOK:
            margin[_mapped(task, kept, points, places, found.coefficients, left)] = UNREACHABLE
        best = Found(found.coefficients, found.objective, margin).best()
        left &= margin[best, each] >= 0.0
        if not left.any():
            break
        left &= _touched(task, kept, points, places, found.coefficients[best, each], left)
        margin[best[left], each[left]] = UNREACHABLE
    first = found.best()
    lost = np.flatnonzero((margin < 0.0).all(axis=0) & (found.margin[first, each] >= 0.0))
    margin[first[lost], lost] = TOUCHING
    return Found(found.coefficients, found.objective, margin)


def _mapped(
    task: Task,
    kept: ArmKept,
    points: Points,
    places: Sequence[Place],
    coefficients: Array,
    asked: Mask,
) -> Mask:
    """(C, B) for which of the candidates (C, B, degree + 1) of beads asked about a link comes too near at a rotation next to
    one of theirs."""
    joints = task.raw_joints(
        points, np.broadcast_to(np.arange(TURNS)[:, None] * (TURN / TURNS), (TURNS, len(points)))
    )
    near, hopeless = _map(kept, points, places, joints, asked)
    every, found = np.arange(len(points)), np.zeros(coefficients.shape[:2], dtype=bool)
    for row, candidate in zip(found, coefficients):
        phi = task.rotation(points, points.polynomial(candidate))[0]
        at = np.mod(phi / (TURN / TURNS), TURNS).astype(np.intp) % TURNS
        row[:] = asked & np.logical_or.reduceat(
            near[at, every] | near[(at + 1) % TURNS, every], points.first
        )
    found[:, hopeless] = True
    return found


def _map(
    kept: ArmKept, points: Points, places: Sequence[Place], joints: Array, asked: Mask
) -> tuple[Mask, Mask]:
    """(TURNS, T) at which rotations, whose joints are (TURNS, T, axes), a link comes too near at points of the beads asked
    about; and which beads (B,) have a point that no rotation serves. Of these no more than ENDS points are known."""
    near, hopeless = np.zeros(joints.shape[:2], dtype=bool), np.zeros(points.beads, dtype=bool)
    last = np.append(points.first[1:], len(points)) - 1
    share = np.linspace(0.0, 1.0, ENDS)[:, None]
    ends = np.zeros(len(points), dtype=bool)
    ends[np.round(points.first + share * (last - points.first)).astype(np.intp)] = True
    reached = np.isfinite(joints).all(axis=2)
    for some in (ends, ~ends):
        columns = np.flatnonzero(some & (asked & ~hopeless)[points.bead])
        near[:, columns] = kept.rotations_near(joints[:, columns], points.bead[columns], places)
        closed = (near | ~reached).all(axis=0) & near.any(axis=0)
        hopeless |= np.logical_or.reduceat(closed, points.first)
    return near, hopeless


def brought_clear(
    task: Task,
    kept: ArmKept,
    beads: Sequence[Bead],
    places: Sequence[Place],
    start: Array,
    reached: Refined,
) -> tuple[Refined, Mask]:
    """Polynomials that keep the links clear in place of those `reached` that do not, where there are any, and which (B,)
    these are. start: (B, degree + 1) coefficients with which the local search began."""
    points = gather(beads, task.cell, POINTS_PER_BEAD)
    near = _touched(
        task, kept, points, places, reached.coefficients, np.ones(points.beads, dtype=bool)
    )
    some = np.flatnonzero(near)
    if not len(some):
        return reached, near
    points = gather([beads[k] for k in some], task.cell, POINTS_PER_BEAD)
    serves = _Serving(task, kept, points, [places[k] for k in some])
    back, near[some] = _stepped_back(
        start[some], reached.coefficients[some], task.joined & points.closed, serves
    )
    coefficients, reason, iterations = (
        reached.coefficients.copy(),
        list(reached.reason),
        list(reached.iterations),
    )
    coefficients[some] = back
    some = np.flatnonzero(near)
    if len(some):
        full = gather([beads[k] for k in some], task.cell)
        again = refined_clear(task, kept, full, [places[k] for k in some], coefficients[some])
        points = gather([beads[k] for k in some], task.cell, POINTS_PER_BEAD)
        for k in np.flatnonzero(
            _Serving(task, kept, points, [places[k] for k in some])(again.coefficients)
        ):
            coefficients[some[k]] = again.coefficients[k]
            reason[some[k]], iterations[some[k]] = again.reason[k], again.iterations[k]
    return Refined(coefficients, reached.objective, tuple(reason), tuple(iterations)), near


@dataclass(frozen=True)
class _Serving:
    """Which beads keep limits, condition and links clear with coefficients (B, degree + 1): (B,)."""

    task: Task
    kept: ArmKept
    points: Points
    places: Sequence[Place]

    @cached_property
    def _threshold(self) -> Array:
        return self.task.thresholds(self.points)

    def __call__(self, coefficients: Array) -> Mask:
        every = np.ones(self.points.beads, dtype=bool)
        near = _touched(self.task, self.kept, self.points, self.places, coefficients, every)
        return np.asarray(~near & _fits(self.task, self.points, self._threshold, coefficients))


def _stepped_back(
    start: Array, reached: Array, joined: Mask, serves: Callable[[Array], Mask]
) -> tuple[Array, Mask]:
    """Coefficients (B, degree + 1) that serve, as near as may be to those reached, and which (B,) do; where none does, those
    reached. joined: (B,) which beads have to join up."""
    result, changed = reached.copy(), np.zeros(len(start), dtype=bool)
    for share in SHARES:
        if changed.all():
            break
        mixed = start + share * (reached - start)
        good = ~changed & serves(mixed)
        if share > 0.0:  # between two numbers of whole turns a bead that has to join up does not
            good &= ~joined | (np.abs(reached - start)[:, 1:].max(axis=1, initial=0.0) < 1e-9)
        result[good], changed[good] = mixed[good], True
    return result, changed


def findings(kept: ArmKept, paths: Sequence[BeadPath]) -> list[Issue]:
    """An error for each bead at whose points a link comes too near, with the link and what it comes near to."""
    found = []
    for path in paths:
        some = np.unique(
            np.linspace(0, len(path.bead) - 1, min(len(path.bead), POINTS_PER_BEAD)).astype(np.intp)
        )
        met = kept.contact.touches(
            path.joints[some], np.full(len(some), kept.moment((path.layer, path.index)))
        )
        if met.any.any():
            first = int(np.argmax(met.link != NONE))
            link, what = kept.contact.links[met.link[first]], kept.contact.names[met.what[first]]
            found.append(clearance_issue(kept.contact.cell, link, what, path.layer, path.index))
    return found


def _touched(
    task: Task,
    kept: ArmKept,
    points: Points,
    places: Sequence[Place],
    coefficients: Array,
    asked: Mask,
) -> Mask:
    """(B,) on which of the beads asked about a link comes too near."""
    joints = task.joints(points, task.rotation(points, points.polynomial(coefficients))[0])
    met = kept.touches(np.where(asked[points.bead, None], joints, np.nan), points, places)
    return np.asarray(np.logical_or.reduceat(met.any, points.first))


def _fits(task: Task, points: Points, threshold: Array, coefficients: Array) -> Mask:
    """(B,) whether limits and condition hold."""
    phi = task.rotation(points, points.polynomial(coefficients))[0]
    joints = task.joints(points, phi)
    margin = np.minimum(
        task.rows.margin(joints), condition_margin(task.condition(points, phi, joints), threshold)
    )
    return np.asarray(points.worst(margin) >= FITS)
