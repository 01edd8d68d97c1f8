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
from .tilt_search import SPREAD, Change, TiltSearch, Touching, what_helps

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
    for turn in range(HALVINGS + 1):
        sub_watch = (watch or Watch()).section(turn / (HALVINGS + 1), (turn + 1) / (HALVINGS + 1))
        tilted, between, solutions = _tilted(
            toolpath, bodies, nozzle, build, plane, feature, turn == HALVINGS, sub_watch, earlier
        )
        if not between.any():
            break
        marks = np.split(between, np.cumsum([len(bead) for _, _, bead in toolpath])[:-1])
        earlier = [
            None if mark.any() else solution
            for solution, mark in zip(solutions, marks, strict=True)
        ]
        toolpath = halved(toolpath, between)
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
) -> tuple[Toolpath, Mask, list[_Way | None]]:
    """Tilt the toolpath clear at its points.

    Returns the toolpath, the points (n,) with a contact halfway to the next point, and the tilts of
    each bead. The last attempt returns no such points but reports them in an issue. If there are
    such contacts with the original axes, nothing is tilted yet. earlier: tilts of an earlier
    attempt, for beads with the same points.
    """
    beads = [bead for _, _, bead in toolpath]
    begin = np.r_[0, np.cumsum([len(bead) for bead in beads])]
    tool_before = np.concatenate([bead.tool for bead in beads])
    space = space_of(toolpath, bodies, nozzle, build.max_tilt, feature=feature or 0)
    in_feature = np.repeat(beads_of(toolpath, feature), np.diff(begin))
    free = ~in_feature
    free[in_feature] = space.clear(np.flatnonzero(in_feature), tool_before[in_feature])
    between = touched_between(space, beads, tool_before, free & in_feature)
    if between.any() and not is_last:
        return toolpath, between, earlier
    blocked = [k for k in range(len(beads)) if not (free & ~between)[begin[k] : begin[k + 1]].all()]
    if not blocked:
        return toolpath, between, earlier
    (tool, tilt, stuck), turned = _ways(
        space, beads, begin, blocked, tool_before, plane, free, build.turn(), watch, earlier
    )
    solutions: list[_Way | None] = [None for _ in beads]
    for k in blocked:
        row = slice(begin[k], begin[k + 1])
        solutions[k] = _Way(tool[row], tilt[row], stuck[row].copy())
    # stuck beads get no more points; their current points are reported
    sound = in_feature & ~np.repeat(np.logical_or.reduceat(stuck, begin[:-1]), np.diff(begin))
    between = touched_between(space, beads, tool, sound)
    if between.any() and not is_last:
        return toolpath, between, solutions
    stuck |= between
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
) -> tuple[_Way, float]:
    """Return axes, tilts and stuck points, and the maximum turn rate, rad/mm, of beads above `max_rate`.

    Only beads whose original axes were within `max_rate` count. Earlier tilts of a bead are kept while clear.
    """
    tool = tool_before.copy()
    tilt = np.zeros(len(tool_before))
    lost = np.zeros(len(tool_before), dtype=bool)
    kept_rows, new_rows = [], []
    for k in blocked:
        row, solution = np.arange(begin[k], begin[k + 1]), earlier[k]
        if solution is None or not (space.clear(row, solution.tool) | solution.stuck).all():
            new_rows.append((row, beads[k].closed))
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
        space, rows, loops, tool_before, plane, free, watch.section(0.0, SEARCHED)
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
    watch: Watch,
    spread: float = SPREAD,
) -> tuple[Array, Array, Index]:
    """Tilt the beads of `rows` clear; return axes (n, 3) of all points, tilts (n,), rad, and the stuck points."""
    knots = [knots_along(row) for row in rows]
    for row, bead_knots in zip(rows, knots, strict=True):
        if len(bead_knots) < len(row):
            free = free.copy()
            free[bead_knots] = free_about(row, bead_knots, free)
    tool, tilt = tool_before.copy(), np.zeros(len(tool_before))
    touching = []
    blocks = _blocks(np.array([len(bead_knots) for bead_knots in knots]))
    for number, block in enumerate(blocks):
        some_knots = [knots[k] for k in block]
        search = TiltSearch(space, some_knots, closed[block], tool_before, plane, free, spread)
        offset, stuck = search.search(
            watch.section(number / len(blocks), (number + 1) / len(blocks))
        )
        flat = search.flat
        tool[flat], tilt[flat] = search.axes(flat, offset), np.linalg.norm(offset, axis=1)
        touching.append(flat[stuck])
    for row, bead_knots in zip(rows, knots, strict=True):
        if len(bead_knots) < len(row):
            tool[row], touching_rows = spread_out(
                space, row, bead_knots, tool_before, tool[bead_knots]
            )
            tilt[row] = np.arctan2(
                np.linalg.norm(np.cross(tool_before[row], tool[row]), axis=1),
                dot(tool_before[row], tool[row]),
            )
            touching.append(touching_rows)
    return tool, tilt, np.concatenate(touching)


def _blocks(counts: Index) -> list[Index]:
    """Return blocks of beads, of `counts` points, that are searched together; this bounds the memory."""
    number = (np.cumsum(counts) - counts) // POINTS_AT_ONCE
    return np.split(np.arange(len(counts)), np.flatnonzero(np.diff(number)) + 1)


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
                    space, [row], np.array([loop]), slower, plane, free, sub_watch, spread
                )
            now = _fastest(space, row, trial)
            if not len(stuck) and now < _fastest(space, row, tool):
                cross = np.linalg.norm(np.cross(tool_before[row], trial[row]), axis=1)
                tool[row], tilt[row] = (
                    trial[row],
                    np.arctan2(cross, dot(tool_before[row], trial[row])),
                )
            if now <= max_rate:
                break
        remaining = _fastest(space, row, tool)
        worst = max(worst, remaining if remaining > max_rate else 0.0)
    return worst


# ---- Long beads are tilted at some points, the knots; between knots, tilts are interpolated and
# checked
#
# Tilts change over millimetres, but points may be only hundredths of a millimetre apart. A search at
# every point would take long, and candidates several degrees apart would turn the tool too fast
# between adjacent points.

MAX_POINTS = 2500  # maximum number of points of a bead at which tilts are searched


def knots_along(row: Index) -> Index:
    """Return the points of a bead at which tilts are searched.

    Parameters
    ----------
    row : (n,) array of int
        Indices of the bead's points, in order.

    Returns
    -------
    (k,) array of int
        At most MAX_POINTS evenly distributed points, including both ends.
    """
    if len(row) <= MAX_POINTS:
        return row
    knots: Index = row[
        np.unique(np.round(np.linspace(0, len(row) - 1, MAX_POINTS)).astype(np.intp))
    ]
    return knots


def free_about(row: Index, knots: Index, free: Mask) -> Mask:
    """Return whether all points nearest to each knot are free.

    Parameters
    ----------
    row : (m,) int array
        Points of the bead.
    knots : (k,) int array
        Knots among them.
    free : (n,) bool array
        Free points of the toolpath.

    Returns
    -------
    (k,) bool array
        True where all are free.
    """
    position = np.searchsorted(row, knots)
    middles = np.r_[0, (position[:-1] + position[1:] + 1) // 2]
    about: Mask = np.logical_and.reduceat(free[row], middles)
    return about


def spread_out(
    space: Space, row: Index, knots: Index, tool: Array, axes: Array
) -> tuple[Array, Index]:
    """Interpolate tool axes between the knots of a bead.

    Parameters
    ----------
    space : Space
        The clearance data.
    row : (m,) int array
        Points of the bead.
    knots : (k,) int array
        Knots among them.
    tool : (n, 3) array
        Requested axes of all points of the toolpath.
    axes : (k, 3) array
        Axes at the knots.

    Returns
    -------
    axes : (m, 3) array
        Axes at all points of the bead, unit vectors.
    touching : int array
        Points between the knots at which the nozzle touches.
    """
    points = space.points[row]
    along = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    knot_lengths = along[np.searchsorted(row, knots)]
    lean = axes - tool[knots]
    tilted = tool[row] + np.stack(
        [np.interp(along, knot_lengths, column) for column in lean.T], axis=1
    )
    tilted /= np.linalg.norm(tilted, axis=1, keepdims=True)
    between = dataclasses.replace(space, nozzle=space.nozzle.halfway())
    between_rows = np.setdiff1d(row, knots, assume_unique=True)
    touching: Index = between_rows[
        ~between.clear(between_rows, tilted[np.searchsorted(row, between_rows)])
    ]
    return tilted, touching
