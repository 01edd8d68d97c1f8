# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planning for machines without a free coordinate (Dai 2020, section 3).

Point and tool axis leave two branches and whole turns, chosen bead by bead. Within a bead the
branch changes only where a direction coincides with an axis and continuing without reversal leads
to the other branch; elsewhere a change would be a jump. If a rotary axis lacks the stroke for a
bead, its seam is moved, and as a last resort the bead is split.

Robots use a different rule (`turns.unwrap`): it searches the tool rotation as if the last axis were
continuous, and moves or cuts the resulting path. Here there is no such rotation, either of two axes
may lack stroke, and a bead with a moved seam may cross a pole in the other branch. Each variant of
a bead is therefore computed again.
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
FEWEST_POINTS = 3  # minimum number of points of a piece
ROUNDS = 10
STRAY = math.radians(
    0.5
)  # maximum deviation of the tool from the requested direction between two points
LIMIT_TOLERANCE = 1e-9  # rad or mm; tolerance for values exactly at a limit
# rad; angles within which a direction counts as on the pole; those above AT_POLE, below STRAY, are
# tried if an axis would race near the pole
POLES = (AT_POLE, math.radians(0.2), math.radians(0.4))
RACES = 2.0  # speed ratio above which an axis races; for smaller ratios the bead is slowed


class _Run(NamedTuple):
    """A bead, or a piece of it, with its axis values.

    axes: (n, 5). fits: whether the limits are kept. bent: a segment that deviates: index of its end
    point, deviation from the bead, mm, and from the direction, rad; None if there is none.
    """

    bead: Bead
    axes: Array
    fits: bool
    bent: tuple[int, float, float] | None = None


def plan(
    task: Task, beads: Sequence[Bead], bead_ids: Sequence[Place], progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    """Plan the paths of a machine without a free coordinate.

    Points are added where joint motion would deviate from the bead. If a rotary axis lacks the
    stroke for a bead, its seam is moved, or the bead is split and the beads are renumbered.

    Parameters
    ----------
    task : Task
        The plan, with a five-axis machine.
    beads : sequence of Bead
        The beads in print order.
    bead_ids : sequence of Place
        Layer and index of each bead.
    progress : callable
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    paths : list of BeadPath
        The paths; NaN joints where unreachable.
    issues : list of Issue
        Segments that deviate, moved seams and split beads.

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
    """Return the bead as is, or with a moved seam or in pieces if a rotary axis lacks stroke."""
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
    """Return the bead in the branch and turns that suit best after `previous` (5,).

    It passes poles with the requested directions if possible.
    """
    runs: list[tuple[bool, bool, float, _Run]] = []
    for pole in POLES[:1] if task.lock is not None else POLES:
        run = _finer(task, bead, previous, pole)
        race = _race(task, run)
        # passing a pole without reversing, the tilt axis changes sides and may lack stroke for that
        if run.bent is None and race <= RACES and (run.fits or not runs):
            return run
        runs.append((run.bent is not None, not run.fits, race, run))
    return min(runs, key=lambda candidate: candidate[:3])[3]


def _race(task: Task, run: _Run) -> float:
    """Return the maximum ratio of required to maximum axis speed along a run; 0 if infeasible."""
    if not np.isfinite(run.axes).all():
        return 0.0
    time = np.linalg.norm(np.diff(run.bead.points, axis=0), axis=1) / run.bead.speed[1:]
    fastest = (np.abs(np.diff(run.axes, axis=0)) / task.cell.machine.max_speed).max(axis=1)
    return float((fastest / np.maximum(time, 1e-300)).max(initial=0.0, where=time > 0.0))


def _finer(task: Task, bead: Bead, previous: Array, pole: float) -> _Run:
    """Return the refined bead, with directions within `pole` (rad) of a pole moved onto it."""
    cell, checked, axes = task.cell, bead, previous
    bead = gone_back(bead, task.rules.retreat).run_on(task.rules.overlap)
    for _ in range(ROUNDS):
        # recompute the whole bead: near a pole, only a finer path shows the shorter continuation
        axes = directed.chosen(cell, directed.courses(cell, task.lock, bead, pole), previous)
        if not np.isfinite(axes).all():
            return _Run(bead, axes, False)
        deviations, leans = deviation(task, bead, axes, task.chord_error), leaning(cell, bead, axes)
        # a locked axis tilts the tool anyway; one message reports this for the whole job
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
            "the axes deviate from the bead by {:.3g} mm and {:.3g} deg between two points near "
            "a pole, no matter how many points are added; tilt the tool away from the pole",
            distance,
            math.degrees(leans),
        ),
        layer,
        bead,
        point,
    )


def _path(task: Task, run: _Run, bead_id: Place) -> BeadPath:
    """Convert a run to a path.

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
    """Whether a rotary axis exceeds its stroke for axis values (n, 5)."""
    limits, turning = task.cell.limits, ~task.cell.machine.chain.sliding
    over = (
        np.maximum(limits.lower + RESERVE - joints, joints - limits.upper + RESERVE)
        > LIMIT_TOLERANCE
    )
    return bool(over[:, turning].any())


def _ways(task: Task, bead: Bead) -> Iterator[list[Bead]]:
    """Yield other variants of a bead, the best first.

    First come seams of a closed bead at which a rotary axis has enough stroke, then divisions into
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
    """Return the start that best centres the course (n,) of a closed bead between two limits.

    Whole turns are ignored.
    """
    n = len(angles) - 1
    turn = angles[-1] - angles[0]
    twice = np.concatenate([angles[:-1], angles + turn])
    windows = np.lib.stride_tricks.sliding_window_view(twice, n + 1)[:n]
    lowest, highest = windows.min(axis=1), windows.max(axis=1)
    off = shortest(0.5 * (lowest + highest) - 0.5 * (low + high))
    over = np.maximum(np.abs(off) + 0.5 * (highest - lowest) - 0.5 * (high - low), 0.0)
    # round, so that the result is the same on every computer; among starts that fit, take the one
    # nearest to the seam
    fits = np.flatnonzero(over <= 0.0)
    if len(fits):
        return int(fits[np.argmin(np.minimum(fits, n - fits))])
    return int(np.argmin(np.round(over, 9)))
