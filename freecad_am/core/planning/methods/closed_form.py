# SPDX-License-Identifier: LGPL-2.1-or-later
"""No free coordinate, k = 0: point and tool axis allow two branches and whole turns (Dai 2020,
section 3).

They are chosen bead by bead. Within a bead the branch changes only if a direction coincides with an
axis and the straight continuation leads to the other branch; elsewhere a change would be a jump. If
a rotary axis lacks the stroke for a bead, the seam of the bead moves; as the last resort it is
split.

The rule for this differs from that of robots (`turns.fit`). The robot's rule searches the tool
rotation as if the last axis were continuous, and moves or cuts the resulting path without other
changes. Here no such rotation exists, either of two axes may lack stroke, and a bead with another
start may cross a pole in the other branch. So each variant of a bead is computed again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ...geometry.frames import TURN, shortest
from ...issues import ERROR, Issue, Text
from ...kinematics.limits import RESERVE
from ...toolpath import Bead
from ...types import Array
from ..beads.chord_error import ROUNDING, deviation, leaning
from ..beads.retreat import gone_back
from ..joint_path import BeadPath
from ..task import Task
from ..turns import directed
from ..turns.directed import AT_POLE
from ..turns.unwrap import is_otherwise, seam_notes

Progress = Callable[[float, str], None]
Place = tuple[int, int]

METHOD = "five-axis"
MOST_PIECES = 4
FEWEST_POINTS = 3  # of a piece
ROUNDS = 10
STRAY = math.radians(
    0.5
)  # allowed deviation of the tool from the requested direction between two points
LIMIT_TOLERANCE = 1e-9  # tolerance at limits, rad and mm: a limit that is met exactly is kept
# rad; within this angle a direction counts as on the pole; larger values, below STRAY, are tried
# if an axis would race near the pole
POLES = (AT_POLE, math.radians(0.2), math.radians(0.4))
RACES = 2.0  # ratio to its maximum speed above which an axis races; below that the bead is slowed


class _Run(NamedTuple):
    """A bead or a piece of one in final form, with its axis values (n, 5); fits: whether it keeps
    the limits.

    bent: a segment that is not straight: number of its end point, deviation from the bead, mm, and
    from the direction, rad.
    """

    bead: Bead
    axes: Array
    fits: bool
    bent: tuple[int, float, float] | None = None


def plan(
    task: Task, beads: Sequence[Bead], bead_ids: Sequence[Place], progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    """Plan the paths of a machine without a free coordinate.

    Points are added where straight motion of the axes would leave the bead. If a limited rotary
    axis lacks the stroke for a bead, its seam is moved or it is split; then the beads are
    renumbered.

    Parameters
    ----------
    task : Task
        The plan, with a five-axis machine.
    beads : sequence of Bead
        The beads in print order.
    bead_ids : sequence of Place
        Layer and index of each bead.
    progress : callable
        Called with the completed share and a text; may raise to cancel.

    Returns
    -------
    paths : list of BeadPath
        The paths; NaN joints where unreachable.
    issues : list of Issue
        Segments that are not straight, moved seams and split beads.

    References
    ----------
    Dai 2020, section 3.
    """
    paths: list[BeadPath] = []
    issues: list[Issue] = []
    helped: tuple[list[int], list[int]] = [], []
    previous, index = np.zeros(task.cell.machine.chain.axes), 0
    for number, (bead, (layer, _)) in enumerate(zip(beads, bead_ids, strict=True)):
        progress(number / len(beads), Text("bead {} of {}", number + 1, len(beads)))
        index = index if paths and paths[-1].layer == layer else 0
        runs = _within_stroke(task, bead, previous)
        if is_otherwise(bead, [run.bead for run in runs]):
            helped[len(runs) > 1].append(layer)
        for run in runs:
            paths.append(_path(task, run, (layer, index)))
            if run.bent is not None:
                issues.append(_not_straight(*run.bent, layer, index))
            previous, index = run.axes[-1] if paths[-1].reachable else previous, index + 1
    return paths, [*issues, *seam_notes(*helped)]


def _within_stroke(task: Task, bead: Bead, previous: Array) -> list[_Run]:
    """The bead unchanged, or from another seam or in pieces if a rotary axis lacks the stroke for
    it.
    """
    unsplit = _run(task, bead, previous)
    if unsplit.fits or not _short_of_turns(task, unsplit.axes):
        return [unsplit]
    for sections in _ways(task, bead):
        runs, current = list[_Run](), previous
        for section in sections:
            runs.append(_run(task, section, current))
            current = runs[-1].axes[-1]
            if not runs[-1].fits:
                break
        else:
            return runs
    return [unsplit]


def _run(task: Task, bead: Bead, previous: Array) -> _Run:
    """Return the bead in the turns and the branch that suit best after axes (5,).

    It passes poles with the requested directions if possible.
    """
    runs: list[tuple[bool, bool, float, _Run]] = []
    for pole in POLES[:1] if task.lock is not None else POLES:
        run = _finer(task, bead, previous, pole)
        race = _race(task, run)
        # straight through a pole a tilting axis changes sides, for which it may lack the stroke
        if run.bent is None and race <= RACES and (run.fits or not runs):
            return run
        runs.append((run.bent is not None, not run.fits, race, run))
    return min(runs, key=lambda candidate: candidate[:3])[3]


def _race(task: Task, run: _Run) -> float:
    """Return the largest ratio of required axis speed to maximum speed along a run; 0 if it is
    infeasible.
    """
    if not np.isfinite(run.axes).all():
        return 0.0
    time = np.linalg.norm(np.diff(run.bead.points, axis=0), axis=1) / run.bead.speed[1:]
    fastest = (np.abs(np.diff(run.axes, axis=0)) / task.cell.machine.max_speed).max(axis=1)
    return float((fastest / np.maximum(time, 1e-300)).max(initial=0.0, where=time > 0.0))


def _finer(task: Task, bead: Bead, previous: Array, pole: float) -> _Run:
    """The bead with directions within `pole` rad of a pole moved onto it, refined where needed."""
    cell, checked, axes = task.cell, bead, previous
    bead = gone_back(bead, task.rules.retreat).run_on(task.rules.overlap)
    for _ in range(ROUNDS):
        # compute the whole bead again: near a pole the shorter continuation only shows with more
        # points
        axes = directed.chosen(cell, directed.courses(cell, task.lock, bead, pole), previous)
        if not np.isfinite(axes).all():
            return _Run(bead, axes, False)
        deviations, leans = deviation(task, bead, axes, task.chord_error), leaning(cell, bead, axes)
        # with an axis locked the tool leans anyway; one message reports that for the whole job
        off = (deviations > task.chord_error + ROUNDING) | ((leans > STRAY) & (task.lock is None))
        if not off.any():
            return _Run(bead, axes, not cell.limits.exceeded(axes, LIMIT_TOLERANCE).any())
        checked, bead = bead, bead.halved(np.flatnonzero(off))
    return _Run(
        checked, axes, False, (int(np.argmax(off)) + 1, float(deviations.max()), float(leans.max()))
    )


def _not_straight(point: int, distance: float, leans: float, layer: int, bead: int) -> Issue:
    return Issue(
        ERROR,
        "NOT_STRAIGHT",
        Text(
            "the axes deviate from the bead by {:.3g} mm and {:.3g} deg between two points, no "
            "matter how many are added: it is near a pole; tilt away from it",
            distance,
            math.degrees(leans),
        ),
        layer,
        bead,
        point,
    )


def _path(task: Task, run: _Run, bead_id: Place) -> BeadPath:
    """Convert the run to a path.

    There is no condition to check, because the courses avoid poles.
    """
    none, limits = np.full(len(run.bead), np.nan), task.cell.limits
    half = 0.5 * (limits.upper - limits.lower)
    moved = np.abs(np.diff(run.axes, axis=0)).sum(axis=0) / np.where(np.isfinite(half), half, TURN)
    margin = (
        float(limits.smallest_share(run.axes).min()) if np.isfinite(run.axes).all() else -math.inf
    )
    return BeadPath(
        *bead_id,
        run.bead,
        np.zeros(len(run.bead)),
        run.axes,
        none,
        none,
        float(np.linalg.norm(moved)),
        margin,
        reason="closed form",
    )


def _short_of_turns(task: Task, joints: Array) -> bool:
    """Whether a rotary axis exceeds its stroke on axis values (n, 5)."""
    limits, turning = task.cell.limits, ~task.cell.machine.chain.sliding
    over = (
        np.maximum(limits.lower + RESERVE - joints, joints - limits.upper + RESERVE)
        > LIMIT_TOLERANCE
    )
    return bool(over[:, turning].any())


def _ways(task: Task, bead: Bead) -> Iterator[list[Bead]]:
    """Yield other variants of a bead, the best first.

    These are a closed bead with a seam at which a rotary axis has enough stroke, then any bead in
    two or more pieces.
    """
    limits = task.cell.limits
    if bead.closed:
        for course in directed.courses(task.cell, task.lock, bead):
            for axis in np.flatnonzero(~task.unturned):
                start = _start(
                    course[:, axis], float(limits.lower[axis]), float(limits.upper[axis])
                )
                if start:
                    yield [bead.started_at(start)]
    extended = bead.run_on(task.rules.overlap)
    for count in range(2, min(MOST_PIECES, (len(extended) - 1) // (FEWEST_POINTS - 1)) + 1):
        cuts = np.round(np.linspace(0, len(extended) - 1, count + 1)).astype(int).tolist()
        yield [
            extended.part(slice(low, high + 1))
            for low, high in zip(cuts[:-1], cuts[1:], strict=True)
        ]


def _start(angles: Array, low: float, high: float) -> int:
    """Return the start point that best centres the course (n,) of a closed bead between two limits.

    Whole turns do not matter.
    """
    n = len(angles) - 1
    turn = angles[-1] - angles[0]
    twice = np.concatenate([angles[:-1], angles + turn])
    windows = np.lib.stride_tricks.sliding_window_view(twice, n + 1)[:n]
    lowest, highest = windows.min(axis=1), windows.max(axis=1)
    off = shortest(0.5 * (lowest + highest) - 0.5 * (low + high))
    over = np.maximum(np.abs(off) + 0.5 * (highest - lowest) - 0.5 * (high - low), 0.0)
    # rounded, so that every computer gets the same point: among fitting points the nearest to
    # the seam
    fits = np.flatnonzero(over <= 0.0)
    if len(fits):
        return int(fits[np.argmin(np.minimum(fits, n - fits))])
    return int(np.argmin(np.round(over, 9)))
