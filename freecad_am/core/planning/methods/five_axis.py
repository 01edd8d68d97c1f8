# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axis paths of five-axis machines: branch, poles, turns, and the four-axis mode (Dai 2020, sections 3 and 5).

There is no freedom left to use but the choice between two branches and whole turns. Within a bead the branch changes only
where a direction lies along an axis and the way straight on leads there; elsewhere a change would be a jump.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...geometry.angles import TURN
from ...issues import ERROR, NOTE, Issue, has_errors
from ...kinematics.cell import Cell
from ...kinematics.inverse.five_axis import FiveAxis
from ...parameters.joints import JointParameters
from ...toolpath import Bead, Toolpath
from ...types import Array
from ..beads.retreat import gone_back
from ..joint_path import BeadPath
from ..reserve import RESERVE
from ..turns import fit_five_axis
from ..turns.rotary_courses import continuous, kept
from ..turns.unwrap import seam_note, split_note

Progress = Callable[[float, str], None]

METHOD = "five-axis"
BETWEEN = np.array([0.25, 0.5, 0.75])
MORE = np.array([1.0, 2.0, 4.0, 5.0]) / 6.0  # of segments that use up more than half of the chord error
ROUNDS = 10
ROUNDING = 1e-6  # mm, and of directions: what rounding may leave between points
AT_POLE = math.radians(0.1)  # a direction this near to the pole counts as on it, or the axis would race round to meet it
STRAY = math.radians(0.5)  # between two points the tool may lean this far from the direction asked for


def plan(
    cell: Cell, toolpath: Toolpath, parameters: JointParameters, progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    """The axis values of all beads, with points added where axes running straight would leave them, and findings.

    Closed beads run on by the toolpath's overlap. Where a limited turning axis has no room for a bead, its seam is moved
    or it is split; beads are then numbered anew.
    """
    arm = FiveAxis(cell.machine.chain)
    beads = [(layer, bead) for layer, _, bead in toolpath]
    lock = _lock(arm, cell, parameters, [cell.on_flange(bead.points, bead.tool)[1] for _, bead in beads])
    paths: list[BeadPath] = []
    strays: list[Stray] = []
    issues: list[Issue] = []
    helped: tuple[list[int], list[int]] = [], []
    before: Array | None = None
    index = 0
    for number, (layer, bead) in enumerate(beads):
        progress(number / len(beads), f"bead {number + 1} of {len(beads)}")
        index = index if paths and paths[-1].layer == layer else 0
        task = _Task(arm, cell, lock, toolpath.chord_error, toolpath.overlap, toolpath.retreat)
        runs = _runs_of(task, bead, before, (layer, index))
        if len(runs) > 1 or runs[0].bead.points[0].tolist() != bead.points[0].tolist():
            helped[len(runs) > 1].append(layer)
        for run in runs:
            place, held = (layer, index), run.bead
            issues += run.issues
            if np.isfinite(run.axes).all():
                before = run.axes[-1]
                held, stray = _as_held(cell, held, run.axes, place)
                strays.append(stray)
            paths.append(_path(cell, held, run.axes, place))
            index += 1
    if lock is not None and strays:
        issues.append(_residual_issue(arm, cell, lock, max(strays), parameters.max_residual))
    for layers, note in zip(helped, (seam_note, split_note)):
        issues += [note(layers)] if layers else []
    return paths, issues


class _Task(NamedTuple):
    arm: FiveAxis
    cell: Cell
    lock: Lock | None
    chord_error: float
    overlap: float
    retreat: float


class _Run(NamedTuple):
    """A bead or a piece of one, with its axis values (n, 5) and what is wrong with it."""

    bead: Bead
    axes: Array
    issues: list[Issue]


def _runs_of(task: _Task, bead: Bead, before: Array | None, place: tuple[int, int]) -> list[_Run]:
    """The bead as it is, or where a turning axis has no room for it, from another seam or in pieces."""
    whole = _bead(task, gone_back(bead, task.retreat).run_on(task.overlap), before, place)
    limits, turning = task.cell.limits, task.arm.turning
    if not has_errors(whole.issues) or not fit_five_axis.short_of(limits, turning, whole.axes, RESERVE):
        return [whole]
    for parts in fit_five_axis.ways(limits, turning, _courses(task, bead), bead, task.overlap):
        runs, last = list[_Run](), before
        for number, part in enumerate(parts):
            # a closed one begun elsewhere is one part, and runs on instead
            held = part if len(parts) == 1 else gone_back(part, task.retreat)
            runs.append(_bead(task, held, last, (place[0], place[1] + number)))
            last = runs[-1].axes[-1]
            if has_errors(runs[-1].issues):
                break
        else:
            return runs
    return [whole]


class Stray(NamedTuple):
    """By what angle, rad, a tool misses the direction asked for, and where: layer, bead, point."""

    angle: float
    layer: int
    bead: int
    point: int


@dataclasses.dataclass(frozen=True)
class Lock:
    """axis: 0 or 1, which of the turning axes stands still. angle: rad, where."""

    axis: int
    angle: float


def _lock(arm: FiveAxis, cell: Cell, parameters: JointParameters, tools: Sequence[Array]) -> Lock | None:
    """The axis that stands still and where: as asked, or where the largest residual is least."""
    if parameters.lock == "none":
        return None
    axis = 0 if parameters.lock == "first" else 1
    if not isinstance(parameters.lock_at, str):
        return Lock(axis, parameters.lock_at)
    directions: Array = np.unique(np.round(np.concatenate(tools), 5), axis=0)
    turning = arm.turning[axis]
    low = max(float(cell.limits.lower[turning]) + RESERVE, -math.pi)
    high = min(float(cell.limits.upper[turning]) - RESERVE, math.pi)
    return Lock(axis, arm.best_lock(axis, directions, cell.station[:3, 2], low, high))


def _bead(task: _Task, bead: Bead, before: Array | None, place: tuple[int, int]) -> _Run:
    """The bead, finer where it must be, its axes (n, 5) in the turns and the branch that suit best, and what is wrong."""
    cell = task.cell
    for _ in range(ROUNDS):
        axes = _chosen(task.arm, cell, _courses(task, bead), before)
        if not np.isfinite(axes).all():
            lost = np.flatnonzero(~np.isfinite(axes).all(axis=1))
            return _Run(bead, axes, [Issue(
                ERROR, "UNREACHABLE", f"{len(lost)} of {len(axes)} directions cannot be turned to the torch by this "
                "machine; tilt less, or mount the part otherwise", *place, int(lost[0]),
            )])
        away, leaning = _between(cell, bead, axes, task.chord_error)
        # with an axis locked the tool leans anyhow; that is told once for all
        off = (away > task.chord_error + ROUNDING) | ((leaning > STRAY) & (task.lock is None))
        if not off.any():
            return _Run(bead, axes, _limit_findings(cell, axes, place))
        looked_at, bead = bead, bead.halved(np.flatnonzero(off))
    return _Run(looked_at, axes, [Issue(
        ERROR, "NOT_STRAIGHT", f"the axes leave the bead by {away.max():.3g} mm, its direction by "
        f"{math.degrees(leaning.max()):.3g} deg between two points however many are added: near a pole; tilt away from it",
        *place, int(np.argmax(off)) + 1,
    )])


def _courses(task: _Task, bead: Bead) -> list[Array]:
    """All ways (n, 5) to run the bead, up to whole turns."""
    arm, cell, lock = task.arm, task.cell, task.lock
    points, tools = cell.on_flange(bead.points, bead.tool)
    if lock is not None:
        turned = np.full((len(points), 2), lock.angle)
        turned[:, 1 - lock.axis] = np.unwrap(arm.locked(lock.axis, lock.angle, tools, cell.station[:3, 2]).angle)
        return [arm.placed(turned, points, cell.station)]
    found = arm.turns(_off_pole(arm.pole, tools), cell.station[:3, 2])
    turned = np.stack([found.first, found.second], axis=-1)
    for axis, free in enumerate((found.first_free, found.second_free)):
        turned[:, :, axis] = kept(turned[:, :, axis], free)
    return [arm.placed(course, points, cell.station) for course in continuous(turned)]


def _off_pole(pole: Array, tools: Array) -> Array:
    """Directions (n, 3), those nearly along the pole or against it brought onto it."""
    near = np.linalg.norm(np.cross(tools, pole), axis=1) < math.sin(AT_POLE)
    return np.where(near[:, None], np.sign(tools @ pole)[:, None] * pole, tools)


def _chosen(arm: FiveAxis, cell: Cell, courses: Sequence[Array], before: Array | None) -> Array:
    """Of all courses and whole turns the one within the limits that starts nearest to where the axes are; without one
    within the limits, the one that leaves them least."""
    limits = cell.limits
    turning = list(arm.turning)
    ranked = []
    for course in courses:
        if not np.isfinite(course).all():
            ranked.append((math.inf, math.inf, course))
            continue
        start = np.zeros(5) if before is None else before
        moved = course.copy()
        for axis in turning:
            moved[:, axis] += TURN * _turns(course[:, axis], start[axis], limits.lower[axis], limits.upper[axis])
        over = np.maximum(limits.lower + RESERVE - moved, moved - limits.upper + RESERVE).max()
        way = float((np.abs(moved[0] - start) / cell.machine.max_speed).max())
        ranked.append((max(float(over), 0.0), way, moved))
    best = min(range(len(ranked)), key=lambda k: ranked[k][:2])
    return ranked[best][2]


def _turns(values: Array, start: float, lower: float, upper: float) -> float:
    """Whole turns that bring an axis near where it is, within its limits where there is room."""
    wanted = np.round((start - values[0]) / TURN)
    lowest = np.ceil((lower + RESERVE - values.min()) / TURN - 1e-12)
    highest = np.floor((upper - RESERVE - values.max()) / TURN + 1e-12)
    return float(np.clip(wanted, lowest, highest)) if lowest <= highest else float(np.round(
        (0.5 * (lower + upper) - 0.5 * (values.min() + values.max())) / TURN))


def _between(cell: Cell, bead: Bead, axes: Array, chord_error: float) -> tuple[Array, Array]:
    """How far (n - 1,) mm the tip leaves each segment and by what angle (n - 1,) rad the tool strays from the directions
    at its ends while the axes run straight."""
    away, leaning = _looked_at(cell, bead, axes, np.arange(len(axes) - 1), BETWEEN)
    near = np.flatnonzero(away > 0.5 * chord_error)
    if len(near):
        more = _looked_at(cell, bead, axes, near, MORE)
        away[near], leaning[near] = np.maximum(away[near], more[0]), np.maximum(leaning[near], more[1])
    return away, leaning


def _looked_at(
    cell: Cell, bead: Bead, axes: Array, segments: NDArray[np.intp], shares: Array
) -> tuple[Array, Array]:
    """The same of the segments (k,), at shares of their length: (k,) mm and (k,) rad."""
    way = (axes[segments + 1] - axes[segments])[:, None]
    flange = cell.machine.chain.forward((axes[segments, None] + shares[:, None] * way).reshape(-1, axes.shape[1]))
    tip, tool = (column.reshape(len(way), len(shares), 3) for column in cell.tip_in_part(flange))
    along = (bead.points[segments + 1] - bead.points[segments])[:, None]
    gap = tip - bead.points[segments, None]
    share = np.clip((gap * along).sum(-1) / np.maximum((along * along).sum(-1), 1e-18), 0.0, 1.0)
    away = np.linalg.norm(gap - share[..., None] * along, axis=-1).max(axis=1)
    asked = bead.tool[segments, None] + shares[:, None] * (bead.tool[segments + 1] - bead.tool[segments])[:, None]
    sine = np.linalg.norm(np.cross(asked, tool), axis=-1)
    return away, np.arctan2(sine, (asked * tool).sum(-1)).max(axis=1)


def _path(cell: Cell, bead: Bead, axes: Array, place: tuple[int, int]) -> BeadPath:
    """The bead with its axes. A machine with five axes has no condition to keep: its poles are told apart above."""
    count, none = len(bead), np.full(len(bead), np.nan)
    limits = cell.limits
    half = 0.5 * (limits.upper - limits.lower)
    shares = np.minimum(axes - limits.lower, limits.upper - axes) / np.where(np.isfinite(half), half, 1.0)
    margin = float(np.where(np.isfinite(half), shares, np.inf).min()) if np.isfinite(axes).all() else -math.inf
    moved = np.abs(np.diff(axes, axis=0)).sum(axis=0) / np.where(np.isfinite(half), half, TURN)
    return BeadPath(
        place[0], place[1], bead, np.zeros(count), axes, none, none, float(np.linalg.norm(moved)),
        margin, reason="closed form",
    )


def _limit_findings(cell: Cell, axes: Array, place: tuple[int, int]) -> list[Issue]:
    limits = cell.limits
    over = np.maximum(limits.lower - axes, axes - limits.upper)
    found = []
    for axis in np.flatnonzero((over > 1e-9).any(axis=0)):
        point = int(over[:, axis].argmax())
        value, unit = axes[point, axis] / cell.machine.unit_values[axis], cell.machine.units[axis]
        bound = limits.lower[axis] if axes[point, axis] < limits.lower[axis] else limits.upper[axis]
        found.append(Issue(
            ERROR, "LIMIT", f"{limits.labels[axis]} would be at {value:.2f} {unit}, its limit is "
            f"{bound / cell.machine.unit_values[axis]:g} {unit}; move the part on the table", *place, point,
        ))
    return found


def _as_held(cell: Cell, bead: Bead, axes: Array, place: tuple[int, int]) -> tuple[Bead, Stray]:
    """The bead with the tool axes that it will really be laid with, and the largest angle to those asked for."""
    tool = cell.tip_in_part(cell.machine.chain.forward(axes))[1]
    missed = np.arctan2(np.linalg.norm(np.cross(tool, bead.tool), axis=1), (tool * bead.tool).sum(axis=1))
    tool = tool / np.linalg.norm(tool, axis=1)[:, None]
    return dataclasses.replace(bead, tool=tool), Stray(float(missed.max()), *place, int(missed.argmax()))


def _residual_issue(arm: FiveAxis, cell: Cell, lock: Lock, worst: Stray, allowed: float) -> Issue:
    name = cell.machine.axes[arm.turning[lock.axis]]
    stands, off, most = (math.degrees(angle) for angle in (lock.angle, worst.angle, allowed))
    place = worst.layer, worst.bead, worst.point
    text = f"axis {name} stands at {stands:.4g} deg; the tool is up to {off:.3g} deg off the direction asked for"
    if worst.angle <= allowed:
        return Issue(NOTE, "FOUR_AXES", text, *place)
    return Issue(
        ERROR, "FOUR_AXES", f"{text}, more than joints.max_residual allows ({most:.3g} deg); lock the other axis, elsewhere "
        "or none", *place,
    )
