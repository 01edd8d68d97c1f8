# SPDX-License-Identifier: LGPL-2.1-or-later
"""Keep the nozzle clear of bodies and deposit along any beads by tilting the tool axis as little as needed.

The nozzle is a frustum without its lowest section (`collision.scene`), which touches the current bead and adjacent beads
intentionally. Only deposit that exists at that time counts. Anything at or behind the tip plane is ignored.

A bead with contacts gets tilts that are clear at every point, small, and even along the bead (`tilt_search`). The nozzle
is also checked halfway between clear points. On contact there, the bead gets another point and is tilted again.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...geometry.obstacles import Body
from ...geometry.step_count import step_count
from ...geometry.walls.surface import dot
from ...issues import InputError, Issue, Text
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.cell import NozzleParameters
from ...slicing.wall_directions import limit_turns, turn_rates
from ...toolpath import Bead, Toolpath
from ...types import Array, Index, Mask
from ..progress import Watch
from .nozzle_check import (
    CLEARANCE,
    Space,
    beads_of,
    halved,
    space_of,
    tilt_issues,
    touched_between,
    turn_issues,
)
from .tilt_search import (
    SPREAD,
    Change,
    TiltSearch,
    Touching,
    near_marks,
    what_helps,
)

SLOWER = 6  # maximum number of new tilt searches for a bead that turns too fast
SEARCHED = 0.7  # fraction of the progress at which these searches begin
POINTS_AT_ONCE = 10_000  # bead points searched together
ROUNDING = 1e-9
HALVINGS = 3  # maximum number of halvings of a segment with contact between its ends


def keep_clear(
    toolpath: Toolpath,
    bodies: Sequence[Body],
    nozzle: NozzleParameters,
    build: BuildDirectionParameters,
    plane: Array | None = None,
    feature: int | None = None,
    watch: Watch | None = None,
    remedy: bool = True,
) -> Toolpath:
    """Tilt the tool axes where the nozzle would touch bodies or deposit.

    If no tilt of up to 90 deg helps, the axes stay, with an issue CLEARANCE. Beads get midpoints
    between clear points if the nozzle would touch there.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    bodies : sequence of Body
        All obstacles, with the platform.
    nozzle : NozzleParameters
        The nozzle.
    build : BuildDirectionParameters
        Build direction with the maximum tilt and turn rate.
    plane : (3,) array or None, optional
        Unit normal of the plane that must contain the tool axes; None for any direction.
    feature : int or None, optional
        Index of the feature whose beads are kept clear, also of other features' earlier
        deposit; None for all features.
    watch : Watch or None, optional
        Receives the progress of the search for tilts.
    remedy : bool, optional
        Whether to add a remedy to the issue CLEARANCE.

    Returns
    -------
    Toolpath
        The toolpath with issues about tilts and contacts.
    """
    earlier: list[_Way | None] = [None for _ in toolpath]
    examined = beads_of(toolpath, feature)
    for turn in range(HALVINGS + 1):
        sub_watch = (watch or Watch()).section(turn / (HALVINGS + 1), (turn + 1) / (HALVINGS + 1))
        tilted, between, solutions = _tilted(
            toolpath,
            bodies,
            nozzle,
            build,
            plane,
            feature,
            turn == HALVINGS,
            sub_watch,
            earlier,
            examined,
        )
        if not between.any():
            break
        marks = np.split(between, np.cumsum([len(bead) for _, _, bead in toolpath])[:-1])
        earlier = [
            None if solution is None else solution.halved(np.flatnonzero(mark))
            for solution, mark in zip(solutions, marks, strict=True)
        ]
        toolpath = halved(toolpath, between)
        examined = np.array([bool(mark.any()) for mark in marks])
    if not remedy or not _touches(tilted, toolpath):
        return tilted
    stuck = [
        np.zeros(len(bead), dtype=bool) if solution is None else solution.stuck
        for (_, _, bead), solution in zip(toolpath, solutions)
    ]
    end = (watch or Watch()).at_end()

    def clears(change: Change) -> bool:
        trial = keep_clear(
            toolpath, change.bodies, change.nozzle, change.build, plane, feature, end, remedy=False
        )
        return not _touches(trial, toolpath)

    touching = Touching(toolpath, np.flatnonzero(np.concatenate(stuck)), plane, feature)
    words = what_helps(touching, Change(bodies, nozzle, build, Text("")), clears)
    return dataclasses.replace(
        tilted,
        issues=tuple(
            dataclasses.replace(issue, message=Text("{}; {}", issue.message, words))
            if issue.code == CLEARANCE and issue not in toolpath.issues
            else issue
            for issue in tilted.issues
        ),
    )


def _touches(tilted: Toolpath, original: Toolpath) -> bool:
    """Whether tilting the original toolpath added an issue CLEARANCE."""
    return any(issue.code == CLEARANCE for issue in tilted.issues[len(original.issues) :])


class _Way(NamedTuple):
    """Tilts of a bead: axes (n, 3), tilts (n,) rad, and points (n,) where no tilt is clear."""

    tool: Array
    tilt: Array
    stuck: Mask

    def halved(self, rows: Index) -> _Way:
        """Return the tilts with the means of points and their next points inserted."""
        tool = 0.5 * (self.tool[rows] + self.tool[rows + 1])
        tool /= np.linalg.norm(tool, axis=1, keepdims=True)
        return _Way(
            np.insert(self.tool, rows + 1, tool, axis=0),
            np.insert(self.tilt, rows + 1, 0.5 * (self.tilt[rows] + self.tilt[rows + 1])),
            np.insert(self.stuck, rows + 1, False),
        )


def _tilted(
    toolpath: Toolpath,
    bodies: Sequence[Body],
    nozzle: NozzleParameters,
    build: BuildDirectionParameters,
    plane: Array | None,
    feature: int | None,
    is_last: bool,
    watch: Watch,
    earlier: list[_Way | None],
    examined: Mask,
) -> tuple[Toolpath, Mask, list[_Way | None]]:
    """Tilt the toolpath clear at its points.

    Returns the toolpath, the points (n,) with a contact halfway to the next point, and the tilts of
    each bead. The last attempt returns no such points but reports them in an issue. earlier: tilts
    of an earlier attempt. examined: beads (b,) to tilt; others have the points of an earlier
    attempt, keep its tilts, and are checked at the end.
    """
    beads = [bead for _, _, bead in toolpath]
    begin = np.r_[0, np.cumsum([len(bead) for bead in beads])]
    counts = np.diff(begin)
    tool_before = np.concatenate([bead.tool for bead in beads])
    space = space_of(toolpath, bodies, nozzle, build.max_tilt, feature=feature or 0)
    rows = np.flatnonzero(np.repeat(examined, counts))
    free = np.ones(len(tool_before), dtype=bool)
    free[rows] = space.clear(rows, tool_before[rows])
    touched = ~np.logical_and.reduceat(free, begin[:-1])
    kept = np.array([solution is not None for solution in earlier]) & ~examined
    blocked = np.flatnonzero(touched | kept).tolist()
    (tool, tilt, stuck), turned = _ways(
        space, beads, begin, blocked, tool_before, plane, free, build.turn(), watch, earlier, kept
    )
    solutions: list[_Way | None] = [None for _ in beads]
    for k in blocked:
        row = slice(begin[k], begin[k + 1])
        solutions[k] = _Way(tool[row], tilt[row], stuck[row].copy())
    # stuck beads get no more points; their current points are reported
    sound = ~np.repeat(np.logical_or.reduceat(stuck, begin[:-1]), counts)
    between = touched_between(space, beads, tool, sound & np.repeat(examined, counts))
    if between.any() and not is_last:
        return toolpath, between, solutions
    in_feature = beads_of(toolpath, feature)
    if (in_feature & ~examined).any():
        # new points of the examined beads change the deposit a little
        rows = np.flatnonzero(np.repeat(in_feature & ~examined, counts) & sound)
        clear = space.clear(rows, tool[rows]).all()
        others = touched_between(space, beads, tool, sound & np.repeat(in_feature, counts))
        if not clear or (others & ~between).any():
            return _tilted(
                toolpath,
                bodies,
                nozzle,
                build,
                plane,
                feature,
                is_last,
                watch,
                solutions,
                in_feature,
            )
    stuck |= between
    if not (blocked or between.any()):
        return toolpath, between, solutions
    issues = (
        *tilt_issues([(i, j) for i, j, _ in toolpath], begin, tilt, stuck),
        *turn_issues(turned, build.turn()),
    )
    return (
        _set_tools(toolpath, np.split(tool, begin[1:-1]), issues),
        np.zeros(len(tool_before), dtype=bool),
        solutions,
    )


def _set_tools(toolpath: Toolpath, tools: Sequence[Array], issues: tuple[Issue, ...]) -> Toolpath:
    """Return the toolpath with new tool axes, bead by bead, and additional issues."""
    axes = iter(tools)
    layers = []
    for layer in toolpath.layers:
        beads = [dataclasses.replace(bead, tool=next(axes)) for bead in layer.beads]
        layers.append(dataclasses.replace(layer, beads=tuple(beads)))
    return dataclasses.replace(toolpath, layers=tuple(layers), issues=(*toolpath.issues, *issues))


def _ways(
    space: Space,
    beads: Sequence[Bead],
    begin: Index,
    blocked: list[int],
    tool_before: Array,
    plane: Array | None,
    free: Mask,
    max_rate: float,
    watch: Watch,
    earlier: list[_Way | None],
    kept: Mask,
) -> tuple[_Way, float]:
    """Return axes, tilts and stuck points, and the maximum turn rate, rad/mm, of beads above `max_rate`.

    Only beads whose original axes were within `max_rate` count. Earlier tilts of a bead are kept while clear, and those
    of beads `kept` (b,) without a check.
    """
    tool = tool_before.copy()
    tilt = np.zeros(len(tool_before))
    lost = np.zeros(len(tool_before), dtype=bool)
    kept_rows, new_rows = [], []
    start: list[Array | None] = []
    for k in blocked:
        row, solution = np.arange(begin[k], begin[k + 1]), earlier[k]
        if solution is None or not (
            kept[k] or (space.clear(row, solution.tool) | solution.stuck).all()
        ):
            new_rows.append((row, beads[k].closed))
            start.append(None if solution is None or solution.stuck.any() else solution.tool)
            continue
        tool[row], tilt[row], lost[row] = solution
        kept_rows.append(row)
    turned = max(
        (
            _fastest(space, kept_rows[k], tool)
            for k in _too_fast(space, kept_rows, tool_before, max_rate, tool, lost)
        ),
        default=0.0,
    )
    if not new_rows:
        return _Way(tool, tilt, lost), turned
    rows = [row for row, _ in new_rows]
    flat = np.concatenate(rows)
    watch.points(len(flat), 1)
    loops = np.array([loop for _, loop in new_rows])
    tilted, leant, stuck = _cleared(
        space, rows, loops, tool_before, plane, free, start, watch.section(0.0, SEARCHED)
    )
    tool[flat], tilt[flat] = tilted[flat], leant[flat]
    lost[stuck] = True
    fast = _too_fast(space, rows, tool_before, max_rate, tool, lost)
    if fast:
        watch.points(sum(len(rows[k]) for k in fast), SLOWER)
    remaining = _slowed(
        space,
        [new_rows[k] for k in fast],
        tool_before,
        plane,
        max_rate,
        tool,
        tilt,
        watch.section(SEARCHED, 1.0),
    )
    return _Way(tool, tilt, lost), max(turned, remaining)


def _cleared(
    space: Space,
    rows: list[Index],
    closed: Mask,
    tool_before: Array,
    plane: Array | None,
    free: Mask,
    start: list[Array | None],
    watch: Watch,
    spread: float = SPREAD,
) -> tuple[Array, Array, Index]:
    """Tilt the beads of `rows` clear; return axes (n, 3) of all points, tilts (n,), rad, and the stuck points.

    Beads are searched at their knots. The nozzle is then checked at every point. Points at which it touches become knots
    too, and are searched near the present tilts. Beads that still touch are searched at every point.

    start: tilted axes (k, 3) from an earlier attempt, near which a bead is searched first; None for none.
    """
    beads = _Knotted(
        space, rows, list(rows), closed, tool_before, plane, free.copy(), spread, tool_before.copy()
    )
    started = np.array([axes is not None for axes in start])
    for row, axes in zip(rows, start, strict=True):
        if axes is not None:
            beads.tool[row] = axes
    unknown = ~started | _any(beads.search(started, True, watch.section(0.0, 0.1)))
    for k in np.flatnonzero(unknown):
        beads.knots[k] = knots_along(
            space.points[rows[k]], tool_before[rows[k]], rows[k], free[rows[k]]
        )
    stuck = beads.search(unknown, False, watch.section(0.1, 0.6))
    lost = _any(stuck)
    again, pending = np.zeros(len(rows), dtype=bool), ~lost
    for number in range(REPAIRS):
        pending &= beads.touching_become_knots(pending)
        if not pending.any():
            break
        section = watch.section(0.6 + 0.1 * number / REPAIRS, 0.6 + 0.1 * (number + 1) / REPAIRS)
        again |= _any(beads.search(pending, True, section))
        pending &= ~again
    again |= _any(beads.touching(pending))
    for k in np.flatnonzero(again):
        beads.knots[k] = every_point(rows[k])
    stuck += beads.search(again, False, watch.section(0.7, 1.0))
    stuck += beads.touching(lost | again)
    flat = np.concatenate(rows)
    tilt = np.zeros(len(tool_before))
    tilt[flat] = _angles(tool_before[flat], beads.tool[flat])
    return beads.tool, tilt, np.concatenate(stuck)


def _any(points: list[Index]) -> Mask:
    """Return which beads have points in a list by bead."""
    return np.array([len(of_bead) > 0 for of_bead in points], dtype=bool)


class _Knotted(NamedTuple):
    """Beads that are tilted at knots.

    rows, knots: points of each bead, and the knots among them. tool: (n, 3) present axes of all points. Other fields: as
    for `TiltSearch`.
    """

    space: Space
    rows: list[Index]
    knots: list[Index]
    closed: Mask
    tool_before: Array
    plane: Array | None
    free: Mask
    spread: float
    tool: Array

    def search(self, searched: Mask, near: bool, watch: Watch) -> list[Index]:
        """Tilt some beads at their knots, in place, and between them; return the points of each bead without clear tilt.

        near: search only near the present axes, and leave a bead without clear tilts unchanged.
        """
        stuck = [row[:0] for row in self.rows]
        numbers = np.flatnonzero(searched)
        free, reach = self.free, RELEASED * self.spread
        if near and len(numbers):
            points = np.concatenate([self.knots[k] for k in numbers])
            free, reach = np.ones(len(self.free), dtype=bool), REPAIR_REACH * self.spread
            free[points] = self.space.clear(points, self.tool[points])
        knots = {k: self._adjustable(k, free, reach) for k in numbers}
        blocks = _blocks(numbers, np.array([len(knots[k]) for k in numbers], dtype=np.intp))
        for number, block in enumerate(blocks if len(numbers) else ()):
            share = watch.section(number / len(blocks), (number + 1) / len(blocks))
            tilts = TiltSearch(
                self.space,
                [self.rows[k] for k in block],
                [knots[k] for k in block],
                self.closed[block],
                self.tool_before,
                self.plane,
                free,
                self.spread,
                reach,
            )
            offset, touching = (
                tilts.repair(self.tool[tilts.flat], share) if near else tilts.search(share)
            )
            axes = tilts.axes(tilts.flat, offset)
            for k, begin, count in zip(block, tilts.begin, tilts.counts, strict=True):
                at = slice(begin, begin + count)
                stuck[k] = knots[k][touching[at]]
                if not (near and len(stuck[k])):
                    self.tool[knots[k]] = axes[at]
                    self.tool[self.rows[k]] = spread_out(
                        self.space.points, self.rows[k], self.knots[k], self.tool_before, self.tool
                    )
        return stuck

    def _adjustable(self, number: int, free: Mask, reach: float) -> Index:
        """Return the knots of a bead within `reach` mm of points that are not free (n,), their neighbours, and both ends."""
        row, knots = self.rows[number], self.knots[number]
        points = self.space.points[row]
        near = near_marks(points, ~free[row], bool(self.closed[number]), reach)
        near = near[np.searchsorted(row, knots)]
        kept = near.copy()
        kept[1:] |= near[:-1]
        kept[:-1] |= near[1:]
        kept[[0, -1]] = True
        return knots[kept]

    def touching(self, checked: Mask) -> list[Index]:
        """Return the points of each checked bead between its knots at which the nozzle touches."""
        between = [
            np.setdiff1d(row, knots if is_checked else row, assume_unique=True)
            for row, knots, is_checked in zip(self.rows, self.knots, checked, strict=True)
        ]
        points = np.concatenate(between)
        touching = ~self.space.clear(points, self.tool[points])
        ends = np.cumsum([len(of_bead) for of_bead in between])
        return [
            of_bead[mask]
            for of_bead, mask in zip(between, np.split(touching, ends[:-1]), strict=True)
        ]

    def touching_become_knots(self, checked: Mask) -> Mask:
        """Add the touching points of checked beads to their knots; return which beads have such points."""
        touching = self.touching(checked)
        for k, points in enumerate(touching):
            self.knots[k] = np.union1d(self.knots[k], points)
            self.free[points] = False
        return _any(touching)


def _angles(before: Array, after: Array) -> Array:
    """Return the angles (n,), rad, between unit vectors (n, 3)."""
    angles: Array = np.arctan2(np.linalg.norm(np.cross(before, after), axis=1), dot(before, after))
    return angles


def _blocks(beads: Index, counts: Index) -> list[Index]:
    """Return blocks of beads, of `counts` points, that are searched together; this bounds the memory."""
    number = (np.cumsum(counts) - counts) // POINTS_AT_ONCE
    return np.split(beads, np.flatnonzero(np.diff(number)) + 1)


def _fastest(space: Space, row: Index, axes: Array) -> float:
    """Return the maximum turn rate along the bead with the points `row`, rad/mm."""
    return float(turn_rates(space.points[row], axes[row]).max(initial=0.0))


def _too_fast(
    space: Space, rows: list[Index], tool_before: Array, max_rate: float, tool: Array, stuck: Mask
) -> list[int]:
    """Return the beads whose tilts raise the turn rate above `max_rate`, rad/mm."""
    if max_rate == np.inf:
        return []
    return [
        k
        for k, row in enumerate(rows)
        if _fastest(space, row, tool) > max_rate
        and not stuck[row].any()
        and _fastest(space, row, tool_before) <= max_rate * (1.0 + ROUNDING)
    ]


def _slowed(
    space: Space,
    fast: list[tuple[Index, bool]],
    tool_before: Array,
    plane: Array | None,
    max_rate: float,
    tool: Array,
    tilt: Array,
    watch: Watch,
) -> float:
    """Tilt beads that turn faster than `max_rate`, rad/mm, again, in place.

    fast: points of each bead, and whether it is closed. Returns the maximum remaining turn rate, 0 if none exceeds the
    limit. Each trial reduces the turn rate of the original axes by the excess and spreads tilts over a longer distance.
    """
    worst = 0.0
    for number, (row, loop) in enumerate(fast):
        rate, spread, now = max_rate, SPREAD, _fastest(space, row, tool)
        for turn in range(SLOWER):
            start = (number * SLOWER + turn) / (len(fast) * SLOWER)
            sub_watch = watch.section(start, start + 1.0 / (len(fast) * SLOWER))
            rate, spread = 0.98 * rate * max_rate / now, 1.5 * spread
            slower = tool_before.copy()
            try:
                slower[row] = limit_turns(
                    space.points[row], tool_before[row], loop, rate, max_lean=space.max_tilt
                ).directions
            except InputError:
                break
            free = np.ones(len(tool_before), dtype=bool)
            free[row] = space.clear(row, slower[row])
            trial, stuck = slower, row[:0]
            if not free[row].all():
                trial, _, stuck = _cleared(
                    space, [row], np.array([loop]), slower, plane, free, [None], sub_watch, spread
                )
            now = _fastest(space, row, trial)
            if not len(stuck) and now < _fastest(space, row, tool):
                tool[row], tilt[row] = trial[row], _angles(tool_before[row], trial[row])
            if now <= max_rate:
                break
        remaining = _fastest(space, row, tool)
        worst = max(worst, remaining if remaining > max_rate else 0.0)
    return worst


# ---- Beads are tilted at some points, the knots; between knots, tilts are interpolated and checked
#
# Tilts change over millimetres, but points may be only hundredths of a millimetre apart. A search at
# every point would take long, and candidates several degrees apart would turn the tool too fast
# between adjacent points.

KNOT_MM = 2.0  # mm; distance of knots along a bead, less than half of SPREAD
KNOT_TURN = np.radians(10.0)  # turn of the requested axis between knots
MAX_POINTS = 2500  # maximum number of points of a bead at which tilts are searched
RELEASED = 4.0  # times SPREAD; distance at which a tilt has decayed
REPAIR_REACH = (
    2.0  # times SPREAD; distance from touching points within which a repair changes tilts
)
REPAIRS = 4  # maximum number of searches near tilts that touch between knots


def knots_along(points: Array, tool: Array, row: Index, free: Mask) -> Index:
    """Return the points of a bead at which tilts are searched first.

    Parameters
    ----------
    points : (n, 3) array
        Points of the bead, mm.
    tool : (n, 3) array
        Requested axes, unit vectors.
    row : (n,) array of int
        Indices of the points, in order.
    free : (n,) bool array
        Points at which the requested axes are clear.

    Returns
    -------
    (k,) array of int
        Points about KNOT_MM or KNOT_TURN apart, both ends of the bead, and both ends of each
        blocked stretch; but at most MAX_POINTS, evenly distributed.
    """
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1) / KNOT_MM
    steps += _angles(tool[:-1], tool[1:]) / KNOT_TURN
    along = np.r_[0.0, np.cumsum(steps)]
    places = np.linspace(0.0, along[-1], step_count(along[-1], 1.0, 2) + 1)
    changes = np.flatnonzero(np.diff(free))
    blocked_ends = np.where(free[changes], changes + 1, changes)
    knots = np.union1d(along.searchsorted(places - ROUNDING), blocked_ends)
    knots = np.union1d(knots, [0, len(row) - 1]).astype(np.intp)
    return np.asarray(row[knots]) if len(knots) <= MAX_POINTS else every_point(row)


def every_point(row: Index) -> Index:
    """Return the points of a bead, but at most MAX_POINTS, evenly distributed, with both ends."""
    if len(row) <= MAX_POINTS:
        return row
    places = np.linspace(0, len(row) - 1, MAX_POINTS)
    knots: Index = row[np.unique(np.round(places).astype(np.intp))]
    return knots


def spread_out(points: Array, row: Index, knots: Index, tool: Array, tilted: Array) -> Array:
    """Interpolate tool axes between the knots of a bead.

    Parameters
    ----------
    points : (n, 3) array
        Points of the toolpath, mm.
    row : (m,) int array
        Points of the bead.
    knots : (k,) int array
        Knots among them.
    tool : (n, 3) array
        Requested axes of all points of the toolpath.
    tilted : (n, 3) array
        Axes of all points; only the axes at the knots count.

    Returns
    -------
    (m, 3) array
        Axes at all points of the bead, unit vectors.
    """
    along = np.cumsum(np.linalg.norm(np.diff(points[row], axis=0, prepend=points[row[:1]]), axis=1))
    at = np.searchsorted(row, knots)
    lean = tilted[knots] - tool[knots]
    axes: Array = tool[row] + np.stack(
        [np.interp(along, along[at], column) for column in lean.T], axis=1
    )
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    # where nothing is tilted, the axes stay to the last bit
    still = np.interp(along, along[at], lean.any(axis=1)) == 0.0
    axes[still] = tool[row[still]]
    axes[at] = tilted[knots]
    return axes
