# SPDX-License-Identifier: LGPL-2.1-or-later
"""Keeps the nozzle clear of bodies and deposit along any beads, by tilting the tool axis no more than needed.

The nozzle is a frustum. Its lowest part is left out (`collision.nozzle`): there it touches what it stands on, the bead
being laid and those beside it. The deposit has its width and height at that moment; what is not deposited yet is free, and
so is what is at or behind the tip plane.

A bead on which the nozzle would touch gets tilts that are clear at every point and small and even along it (`tilt_search`).

Halfway between points that are clear the nozzle is looked at too; where it touches there, the bead gets a point, and is
tilted anew, it alone.
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
from ...slicing.directions.wall import limit_turns, turn_rates
from ...toolpath import Bead, Toolpath
from ...types import Array, Index, Mask
from ..progress import Watch
from . import knots as clearance_knots
from .helpful import Change, Touching, what_helps
from .notes import CLEARANCE, tilt_issues, turn_issues
from .places import Space, beads_of, halved, space_of, touched_between
from .tilt_search import SPREAD, TiltSearch

SLOWER = 6  # times that a bead is tilted anew where it turns too fast
SEARCHED = 0.7  # of the search when that begins
ROUNDING = 1e-9
HALVINGS = 3  # of a segment halfway on which the nozzle touches


def kept_clear(
    toolpath: Toolpath,
    bodies: Sequence[Body],
    nozzle: NozzleParameters,
    build: BuildDirectionParameters,
    plane: Array | None = None,
    feature: int | None = None,
    watch: Watch | None = None,
    remedy: bool = True,
) -> Toolpath:
    """The toolpath with tool axes tilted where the nozzle would touch bodies or deposit, and issues that say so.

    bodies: all that counts, the platform too. plane: unit normal (3,) of the plane that the tool must stay in. Where no
    tilt of up to 90 deg helps, the axes stay as they come, with an issue CLEARANCE, which with `remedy` says what would.
    Beads get points halfway between those that are clear where the nozzle would touch there. feature: of several features,
    the one whose beads are kept clear, of what is deposited of the others by then too. watch: is told where tilts are
    searched for.
    """
    known: list[_Way | None] = [None for _ in toolpath]
    for turn in range(HALVINGS + 1):
        part = (watch or Watch()).within(turn / (HALVINGS + 1), (turn + 1) / (HALVINGS + 1))
        found, between, ways = _tilted(
            toolpath, bodies, nozzle, build, plane, feature, turn == HALVINGS, part, known
        )
        if not between.any():
            break
        marks = np.split(between, np.cumsum([len(bead) for _, _, bead in toolpath])[:-1])
        known = [None if mark.any() else way for way, mark in zip(ways, marks, strict=True)]
        toolpath = halved(toolpath, between)
    if not remedy or not _touches(found, toolpath):
        return found
    lost = [
        np.zeros(len(bead), dtype=bool) if way is None else way.lost
        for (_, _, bead), way in zip(toolpath, ways)
    ]
    end = (watch or Watch()).at_end()

    def clears(change: Change) -> bool:
        made = kept_clear(
            toolpath, change.bodies, change.nozzle, change.build, plane, feature, end, remedy=False
        )
        return not _touches(made, toolpath)

    touching = Touching(toolpath, np.flatnonzero(np.concatenate(lost)), plane, feature)
    words = what_helps(touching, Change(bodies, nozzle, build, Text("")), clears)
    return dataclasses.replace(
        found,
        issues=tuple(
            dataclasses.replace(issue, message=Text("{}; {}", issue.message, words))
            if issue.code == CLEARANCE and issue not in toolpath.issues
            else issue
            for issue in found.issues
        ),
    )


def _touches(made: Toolpath, before: Toolpath) -> bool:
    """Whether a toolpath made of another is told to touch."""
    return any(issue.code == CLEARANCE for issue in made.issues[len(before.issues) :])


class _Way(NamedTuple):
    """What was found for a bead that is tilted: axes (n, 3), tilts (n,) rad, and which points (n,) touch even so."""

    tool: Array
    tilt: Array
    lost: Mask


def _tilted(
    toolpath: Toolpath,
    bodies: Sequence[Body],
    nozzle: NozzleParameters,
    build: BuildDirectionParameters,
    plane: Array | None,
    feature: int | None,
    last: bool,
    watch: Watch,
    known: list[_Way | None],
) -> tuple[Toolpath, Mask, list[_Way | None]]:
    """The toolpath tilted clear at its points, the points (n,) after which the nozzle touches halfway to the next, none at
    the `last` try, where an issue says so, and what was found bead by bead. Where it touches with the axes asked for,
    nothing is tilted yet. known: what was found before, of beads that have the same points since."""
    beads = [bead for _, _, bead in toolpath]
    begin = np.r_[0, np.cumsum([len(bead) for bead in beads])]
    asked = np.concatenate([bead.tool for bead in beads])
    space = space_of(toolpath, bodies, nozzle, build.max_tilt, feature=feature or 0)
    mine = np.repeat(beads_of(toolpath, feature), np.diff(begin))
    free = ~mine
    free[mine] = space.clear(np.flatnonzero(mine), asked[mine])
    between = touched_between(space, beads, asked, free & mine)
    if between.any() and not last:
        return toolpath, between, known
    blocked = [k for k in range(len(beads)) if not (free & ~between)[begin[k] : begin[k + 1]].all()]
    if not blocked:
        return toolpath, between, known
    (tool, tilt, lost), turned = _ways(
        space, beads, begin, blocked, asked, plane, free, build.turn(), watch, known
    )
    ways: list[_Way | None] = [None for _ in beads]
    for k in blocked:
        row = slice(begin[k], begin[k + 1])
        ways[k] = _Way(tool[row], tilt[row], lost[row].copy())
    # no more points for beads that are lost: they are told of at those they have
    sound = mine & ~np.repeat(np.logical_or.reduceat(lost, begin[:-1]), np.diff(begin))
    between = touched_between(space, beads, tool, sound)
    if between.any() and not last:
        return toolpath, between, ways
    lost |= between
    issues = (
        *tilt_issues([(i, j) for i, j, _ in toolpath], begin, tilt, lost),
        *turn_issues(turned, build.turn()),
    )
    return (
        _with_tools(toolpath, np.split(tool, begin[1:-1]), issues),
        np.zeros(len(asked), dtype=bool),
        ways,
    )


def _with_tools(toolpath: Toolpath, tools: Sequence[Array], issues: tuple[Issue, ...]) -> Toolpath:
    """The toolpath with tool axes, bead by bead, and further issues."""
    each = iter(tools)
    return dataclasses.replace(
        toolpath,
        layers=tuple(
            dataclasses.replace(
                layer,
                beads=tuple(dataclasses.replace(bead, tool=next(each)) for bead in layer.beads),
            )
            for layer in toolpath.layers
        ),
        issues=(*toolpath.issues, *issues),
    )


def _ways(
    space: Space,
    beads: Sequence[Bead],
    begin: Index,
    blocked: list[int],
    asked: Array,
    plane: Array | None,
    free: Mask,
    most: float,
    watch: Watch,
    known: list[_Way | None],
) -> tuple[_Way, float]:
    """Axes, tilts and points that touch even so, of all points, and the fastest turn (rad/mm) that is left of beads that
    turn faster than `most` with their tilts though what was asked does not. What is known of a bead stays while clear."""
    tool, tilt, lost = asked.copy(), np.zeros(len(asked)), np.zeros(len(asked), dtype=bool)
    kept, anew = [], []
    for k in blocked:
        row, way = np.arange(begin[k], begin[k + 1]), known[k]
        if way is None or not (space.clear(row, way.tool) | way.lost).all():
            anew.append((row, beads[k].closed))
            continue
        tool[row], tilt[row], lost[row] = way
        kept.append(row)
    turned = max(
        (_fastest(space, kept[k], tool) for k in _too_fast(space, kept, asked, most, tool, lost)),
        default=0.0,
    )
    if not anew:
        return _Way(tool, tilt, lost), turned
    rows = [row for row, _ in anew]
    flat = np.concatenate(rows)
    watch.points(len(flat), 1)
    loops = np.array([loop for _, loop in anew])
    found, leant, stuck = _cleared(
        space, rows, loops, asked, plane, free, watch.within(0.0, SEARCHED)
    )
    tool[flat], tilt[flat] = found[flat], leant[flat]
    lost[stuck] = True
    fast = _too_fast(space, rows, asked, most, tool, lost)
    if fast:
        watch.points(sum(len(rows[k]) for k in fast), SLOWER)
    left = _slowed(
        space, [anew[k] for k in fast], asked, plane, most, tool, tilt, watch.within(SEARCHED, 1.0)
    )
    return _Way(tool, tilt, lost), max(turned, left)


def _cleared(
    space: Space,
    rows: list[Index],
    closed: Mask,
    asked: Array,
    plane: Array | None,
    free: Mask,
    watch: Watch,
    spread: float = SPREAD,
) -> tuple[Array, Array, Index]:
    """Axes (n, 3) of all points, those of the beads with the rows tilted clear; tilts (n,) rad; the points that touch even
    so."""
    knots = [clearance_knots.of_bead(row) for row in rows]
    for row, some in zip(rows, knots, strict=True):
        if len(some) < len(row):
            free = free.copy()
            free[some] = clearance_knots.free_about(row, some, free)
    search = TiltSearch(space, knots, closed, asked, plane, free, spread)
    offset, stuck = search.found(watch)
    tool, tilt = asked.copy(), np.zeros(len(asked))
    flat = np.concatenate(knots)
    tool[flat], tilt[flat] = search.axes(flat, offset), np.linalg.norm(offset, axis=1)
    touching = [flat[stuck]]
    for row, some in zip(rows, knots, strict=True):
        if len(some) < len(row):
            tool[row], more = clearance_knots.spread_out(space, row, some, asked, tool[some])
            tilt[row] = np.arctan2(
                np.linalg.norm(np.cross(asked[row], tool[row]), axis=1), dot(asked[row], tool[row])
            )
            touching.append(more)
    return tool, tilt, np.concatenate(touching)


def _fastest(space: Space, row: Index, axes: Array) -> float:
    """The fastest turn (rad/mm) along the bead with the points `row`."""
    return float(turn_rates(space.points[row], axes[row]).max(initial=0.0))


def _too_fast(
    space: Space, rows: list[Index], asked: Array, most: float, tool: Array, lost: Mask
) -> list[int]:
    """The beads that turn faster than `most` rad/mm with their tilts though what was asked does not."""
    if most == np.inf:
        return []
    return [
        k
        for k, row in enumerate(rows)
        if _fastest(space, row, tool) > most
        and not lost[row].any()
        and _fastest(space, row, asked) <= most * (1.0 + ROUNDING)
    ]


def _slowed(
    space: Space,
    fast: list[tuple[Index, bool]],
    asked: Array,
    plane: Array | None,
    most: float,
    tool: Array,
    tilt: Array,
    watch: Watch,
) -> float:
    """Find axes anew, in place, for beads that turn faster than `most` rad/mm, given by their points and whether they are
    closed; comes back with the fastest turn that is left of them, 0 where none is.

    Each time what is asked turns slower, by as much as is too much, and tilts come and go over a longer way.
    """
    worst = 0.0
    for number, (row, loop) in enumerate(fast):
        rate, spread, now = most, SPREAD, _fastest(space, row, tool)
        for turn in range(SLOWER):
            done = (number * SLOWER + turn) / (len(fast) * SLOWER)
            part = watch.within(done, done + 1.0 / (len(fast) * SLOWER))
            rate, spread = 0.98 * rate * most / now, 1.5 * spread
            slower = asked.copy()
            try:
                slower[row] = limit_turns(
                    space.points[row], asked[row], loop, rate, max_lean=space.max_tilt
                ).directions
            except InputError:
                break
            free = np.ones(len(asked), dtype=bool)
            free[row] = space.clear(row, slower[row])
            found, stuck = slower, row[:0]
            if not free[row].all():
                found, _, stuck = _cleared(
                    space, [row], np.array([loop]), slower, plane, free, part, spread
                )
            now = _fastest(space, row, found)
            if not len(stuck) and now < _fastest(space, row, tool):
                cross = np.linalg.norm(np.cross(asked[row], found[row]), axis=1)
                tool[row], tilt[row] = found[row], np.arctan2(cross, dot(asked[row], found[row]))
            if now <= most:
                break
        left = _fastest(space, row, tool)
        worst = max(worst, left if left > most else 0.0)
    return worst
