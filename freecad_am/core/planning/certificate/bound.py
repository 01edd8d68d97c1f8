# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far a joint path is from the best there could be: its objective beside a lower bound over all rotations.

The rotation about the tool axis is free at every point, not only along a polynomial. Eq. 17 of Chalvin 2020 is a chain: each
step depends on the rotations at two points. So the least objective is a shortest path, and a bound from below is the
shortest path over cells of rotations whose steps are bounded from below (step_bounds.py). Cells through which no path comes
below the target are dropped, the others divided.

Two things keep it quick. Of m steps in a row only the first and the last joints are looked at: a sum of m squares is at
least the square of the sum over m (Cauchy and Schwarz). And a multiple of the rotation is taken from what comes into a
point and added to what leaves it, which changes no path's sum: near the best path a step then hardly depends on where in
its cells it runs (Lagrange's multipliers of the chain).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.angles import TURN, shortest
from ...issues import NOTE, Issue
from ...types import Array, Index
from ..joint_path import BeadPath
from ..points import Points, gather, steps
from ..task import Task
from . import chain_optimum
from .cells import CELLS, PARTS, Cells, cells_of, divided, whole_turn
from .point_bounds import point_bound
from .step_bounds import least_steps

CLOSE = 0.005  # share of the objective at which a bound is near enough
LEVELS = 7  # times that cells are divided
MOST_STEPS = 2_000_000  # between cells of one bead that are looked at together: what would take more is left as it is
LESS = (0.0, 0.01, 0.02, 0.03, 0.05, 0.08, 0.12)  # shares that a bound may be less than is enough: fewer cells stay open
FEWEST = 4  # groups of steps of a bead
GROUPED = 0.002  # of the objective, what may be lost by looking at groups of steps


@dataclass(frozen=True)
class Optimality:
    """What a joint path costs and what no rotation can go below: objective and bound (B,) of each bead."""

    objective: Array
    bound: Array

    @property
    def gaps(self) -> Array:
        """(B,) share of each bead's objective that is not proved to be needed; 0 of what costs nothing."""
        costs = np.where(self.objective > 0.0, self.objective, 1.0)
        return np.where(self.objective > 0.0, 1.0 - self.bound / costs, 0.0)


def summed(
    task: Task, paths: Sequence[BeadPath], report: Callable[[float], None] = lambda share: None
) -> tuple[dict[str, object] | None, list[Issue]]:
    """Objective, bound and gap of a joint path as its report has them, with the bead whose own gap is the largest; none of
    arms that cannot be bounded, and a note that says so."""
    if task.arm.followed:
        return None, [Issue(
            NOTE, "NO_BOUND", "joints.certificate: several solutions of this arm bear the same configuration, so no lower "
            "bound is known; leave it out",
        )]
    found = certified(task, paths, report)
    worst = paths[int(found.gaps.argmax())]
    total, bound = float(found.objective.sum()), float(found.bound.sum())
    return {
        "objective": total, "bound": bound, "gap": 1.0 - bound / total if total > 0.0 else 0.0,
        "worst": {"layer": worst.layer, "bead": worst.index, "gap": float(found.gaps.max())},
    }, []


def certified(
    task: Task, paths: Sequence[BeadPath], report: Callable[[float], None] = lambda share: None
) -> Optimality:
    """The optimality of feasible paths, bead by bead, for the objective of the task; told(share) may raise to cancel.

    The bound holds for every course of the rotation along the beads as they are run, in the branch of the task, that keeps
    limits and condition at the points. Between the samples of a cell joints are taken to bend at most twice as much as
    their second differences say.
    """
    objective, bound = np.zeros(len(paths)), np.zeros(len(paths))
    for number, path in enumerate(paths):
        report(number / len(paths))
        points = gather([path.bead], task.cell)
        if task.parameters.objective != "displacement":
            objective[number] = path.objective
            bound[number] = min(path.objective, point_bound(task, points, path.threshold))
            continue
        step = steps(path.joints, points)
        objective[number] = float(((step * step) @ task.weights).sum())
        bound[number] = _displacement_bound(task, points, path, objective[number])
    return Optimality(objective, bound)


def _displacement_bound(task: Task, points: Points, path: BeadPath, objective: float) -> float:
    """What eq. 17 of one bead cannot go below; `objective` is what its path takes."""
    at = _grouped(steps(path.joints, points), task.weights)
    chain = _Chain(task, points, at, path.threshold, objective * (1.0 - CLOSE))
    return min(objective, chain.bound(path.phi[at]))


def _grouped(step: Array, weights: Array) -> Index:
    """The points between which steps are looked at together, so that little of the objective is lost by it."""
    count = len(step) - 1
    whole, way = float(((step * step) @ weights).sum()), np.cumsum(step, axis=0)
    groups = FEWEST
    while groups < count:
        at: Index = np.unique(np.round(np.linspace(0, count, groups + 1)).astype(np.int64))
        moved = np.diff(way[at], axis=0)
        kept = float(((moved * moved) @ weights / np.diff(at)).sum())
        if kept >= whole * (1.0 - GROUPED) and np.abs(moved).max() < 0.4 * TURN:
            return at
        groups *= 2
    return np.arange(count + 1, dtype=np.int64)


@dataclass(frozen=True)
class _Chain:
    """One bead of which the points `at` (M + 1,) are looked at; threshold (n,) of the condition at all points, target: the
    bound that is enough."""

    task: Task
    points: Points
    at: Index
    threshold: Array
    target: float

    def bound(self, phi: Array) -> float:
        """The least sum over all paths through cells, the target at most; phi (M + 1,) is a path that is known."""
        known, multiplier = chain_optimum.found(self.task, self.points, self.at, phi)
        target = self._target(known)
        centre, half = whole_turn()
        centres = [centre] * len(self.at)
        first, second = (grid.ravel() for grid in np.meshgrid(np.arange(CELLS), np.arange(CELLS), indexing="ij"))
        pairs = [(first, second)] * (len(self.at) - 1)
        best = 0.0
        for _ in range(LEVELS):
            cells = self._cells(centres, half)
            pairs = [_possible(pair, *cells[j : j + 2]) for j, pair in enumerate(pairs)]
            height = [multiplier[j] * _short(centre - known[j]) for j, centre in enumerate(centres)]
            cost = [
                least_steps(
                    self.task.weights / (self.at[j + 1] - self.at[j]), cells[j].of(pair[0]), cells[j + 1].of(pair[1]),
                    (float(multiplier[j]), float(multiplier[j + 1])),
                ) + height[j][pair[0]] - height[j + 1][pair[1]]
                for j, pair in enumerate(pairs)
            ]
            ahead = _shortest(pairs, cost, [len(centre) for centre in centres])
            best = max(best, min(float(ahead[-1].min()), target))
            if best >= target:
                break
            behind = _shortest(
                [pair[::-1] for pair in pairs[::-1]], cost[::-1], [len(centre) for centre in centres[::-1]]
            )[::-1]
            through = [ahead[j][pair[0]] + cost[j] + behind[j + 1][pair[1]] for j, pair in enumerate(pairs)]
            lower = next((less for less in LESS if PARTS**2 * sum(
                int((one < (1.0 - less) * target).sum()) for one in through) <= MOST_STEPS), None)
            if lower is None or best >= (1.0 - lower) * target:
                break
            target *= 1.0 - lower
            pairs = [(pair[0][one < target], pair[1][one < target]) for pair, one in zip(pairs, through)]
            centres, pairs = _divided(centres, pairs, half)
            half /= PARTS
        return best

    def _target(self, phi: Array) -> float:
        """The bound that is enough beside a course phi (M + 1,) that is known. Where it keeps limits and condition no bound
        is above what it takes, and to look for one would leave all cells about it open."""
        chosen, task = self.points.each(self.at), self.task
        joints = task.raw_joints(chosen, phi)
        if not np.isfinite(joints).all():
            return self.target
        moved = _short(np.diff(joints, axis=0))
        run = joints[0] + np.concatenate([np.zeros((1, joints.shape[1])), np.cumsum(moved, axis=0)])
        turns = np.round((task.middle - 0.5 * (run.min(axis=0) + run.max(axis=0))) / TURN)
        run += np.where(task.unturned, 0.0, TURN * turns)
        kept = task.rows.margin(run).min() >= 0.0 and (task.condition(chosen, phi, run) >= self.threshold[self.at]).all()
        value = float(((moved * moved) @ task.weights / np.diff(self.at)).sum())
        return min(self.target, (1.0 - CLOSE) * value) if kept else self.target

    def _cells(self, centres: Sequence[Array], half: float) -> list[Cells]:
        """The cells of every point."""
        index = np.repeat(self.at, [len(centre) for centre in centres])
        every = cells_of(self.task, self.points, index, np.concatenate(centres), half, self.threshold[index])
        ends = np.cumsum([0, *(len(centre) for centre in centres)])
        return [every.of(np.arange(start, end)) for start, end in zip(ends, ends[1:])]


def _possible(pair: tuple[Index, Index], one: Cells, other: Cells) -> tuple[Index, Index]:
    kept = one.feasible[pair[0]] & other.feasible[pair[1]]
    return pair[0][kept], pair[1][kept]


def _shortest(pairs: Sequence[tuple[Index, Index]], cost: Sequence[Array], counts: Sequence[int]) -> list[Array]:
    """The least sum up to every cell of every point, infinite where none leads."""
    found = [np.zeros(counts[0])]
    for (start, end), one, count in zip(pairs, cost, counts[1:]):
        least = np.full(count, np.inf)
        np.minimum.at(least, end, found[-1][start] + one)
        found.append(least)
    return found


def _divided(
    centres: Sequence[Array], pairs: Sequence[tuple[Index, Index]], half: float
) -> tuple[list[Array], list[tuple[Index, Index]]]:
    """The cells that pairs still use in PARTS each, and all pairs of theirs."""
    used = [np.zeros(len(centre), dtype=bool) for centre in centres]
    for j, (start, end) in enumerate(pairs):
        used[j][start] = used[j + 1][end] = True
    number = [PARTS * (np.cumsum(one) - 1) for one in used]
    finer = [divided(centre[one], half) for centre, one in zip(centres, used)]
    first, second = (grid.ravel() for grid in np.meshgrid(np.arange(PARTS), np.arange(PARTS), indexing="ij"))
    spread = [
        ((number[j][start][:, None] + first).ravel(), (number[j + 1][end][:, None] + second).ravel())
        for j, (start, end) in enumerate(pairs)
    ]
    return finer, spread


def _short(angle: Array) -> Array:
    short: Array = shortest(angle)
    return short
