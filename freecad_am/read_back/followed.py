# SPDX-License-Identifier: LGPL-2.1-or-later
"""The joints by which a machine follows the positions of a text: of all solutions those that the text names, or else those
next to where the machine stands."""

from __future__ import annotations

import numpy as np

from freecad_am.core.geometry.angles import TURN
from freecad_am.core.types import Array, Index, Mask

from ..core.geometry import frames
from ..core.issues import InputError
from ..core.kinematics.cell import Cell
from ..core.kinematics.inverse import opw
from ..core.kinematics.inverse.five_axis import FiveAxis
from ..core.read_moves import ReadMoves
from .planned import pieces
from .text_path import Path


def by_robot(cell: Cell, read: ReadMoves, asked: Array) -> Array:
    """(n, axes) serial joints of a cell with a robot whose flange is at `asked` (n, 4, 4); NaN where it is not reached.

    Rows that the text tells in joints have these. Raises InputError NO_CONFIGURATION where it begins with a position and
    neither names a configuration nor says what it is next to, and the cell leaves it open too.
    """
    machine, own = cell.machine, cell.robot.chain.axes
    shown = (
        np.full((len(asked), machine.chain.axes), np.nan) if read.joints is None else read.joints
    )
    unknown = np.isnan(shown[:, :own]).any(axis=1)
    serial = np.full_like(shown, np.nan)
    serial[~unknown] = machine.from_controller(shown[~unknown])
    if cell.external is not None:  # the external axes are told with every position
        external = machine.from_controller(np.where(np.isnan(shown), 0.0, shown))[:, own:]
        asked, serial[:, own:] = frames.inverse(cell.external.base(external)) @ asked, external
    if read.near is not None:
        known = unknown & np.isfinite(read.near).all(axis=1)
        serial[known, :own] = _nearest_turns(
            cell, asked[known], machine.from_controller(read.near[known])[:, :own]
        )
        unknown &= ~known
    for start, end in _runs(unknown):
        before = serial[start - 1, :own] if start else np.full(own, np.nan)
        serial[start:end, :own] = _arm(cell, read, asked, slice(start, end), before)
    return serial


def by_table(cell: Cell, read: ReadMoves, path: Path) -> Array:
    """(n, 5) serial joints of a machine with rotary axes whose tip takes a path; NaN where a direction is not reached.

    A rotary axis that a direction leaves free stays where it is.
    """
    assert read.joints is not None
    serial = cell.machine.from_controller(read.joints)
    solver, unknown = FiveAxis(cell.machine.chain), np.isnan(read.joints).any(axis=1)
    points, tools = cell.on_flange(path.position, path.tool)
    turning = list(solver.turning)
    for start, end in _runs(unknown):
        rows = slice(start, end)
        before = serial[start - 1, turning] if start else np.zeros(2)
        turned = serial[rows, turning]
        if np.isnan(turned).any():
            found, free = solver.inverse(points[rows], tools[rows], cell.station)
            turned = _nearest(np.moveaxis(found[..., turning], 0, 1), free, before)
        serial[rows] = solver.placed(turned, points[rows], cell.station)
    return serial


def _runs(mask: Mask) -> list[tuple[int, int]]:
    """First and behind the last row of each run of rows in a mask."""
    edges = np.flatnonzero(np.diff(mask, prepend=False, append=False)).tolist()
    return list(zip(edges[::2], edges[1::2], strict=True))


def _arm(cell: Cell, read: ReadMoves, asked: Array, rows: slice, before: Array) -> Array:
    """(k, 6) joints of the arm at some rows of the text that follow each other after joints `before` (6,)."""
    arm = cell.robot.arm
    assert arm is not None
    solutions = [
        arm.solutions(asked[rows][some]) for some in pieces(np.arange(rows.stop - rows.start))
    ]
    found = np.concatenate([np.moveaxis(joints, 0, 1) for joints, _ in solutions])
    if read.configuration is not None:
        return _as_named(
            cell, read, found, np.concatenate([words.T for _, words in solutions]), rows
        )
    if not np.isfinite(before).all():
        if cell.branch is None:
            raise InputError(
                "NO_CONFIGURATION",
                "program",
                "it begins with a position and names no configuration of the arm; say it in "
                "the cell, branch: [front, up, flip]",
            )
        before = found[0, cell.branch]
    return _nearest(found, np.zeros((len(found), found.shape[2]), dtype=bool), before)


def _nearest_turns(cell: Cell, asked: Array, near: Array) -> Array:
    """(k, 6) the joints of flange poses (k, 4, 4) next to joints `near` (k, 6), in their turns."""
    arm = cell.robot.arm
    assert arm is not None
    found = np.moveaxis(arm.inverse(asked), 0, 1)
    chosen = found[np.arange(len(found)), _apart(near[:, None], found).argmin(axis=1)]
    unwrapped: Array = chosen + TURN * np.rint((near - chosen) / TURN)
    return unwrapped


def _as_named(cell: Cell, read: ReadMoves, found: Array, words: Index, rows: slice) -> Array:
    """Of solutions (k, configurations, 6) that bear `words` (k, configurations) those the text names, with its turns."""
    configuration = read.configuration
    assert configuration is not None
    names = np.array([opw.branch_name(index) for index in range(8)])[words]
    # what controllers call flip is which way axis 5 is bent as they count it
    shown = cell.robot.to_controller(found)
    named = (names[..., 0] == "front") == configuration.front[rows, None]
    named &= (names[..., 1] == "up") == configuration.up[rows, None]
    named &= (
        ((shown[..., 4] > 0.0) == configuration.flip[rows, None])
        & np.isfinite(found).all(axis=2)
        & (words >= 0)
    )
    if configuration.turns[rows, :-1].any():
        raise InputError(
            "NOT_YET",
            "program",
            "it names turns of other axes than the last one, which cannot be followed; "
            "give these positions in joints",
        )
    chosen = shown[np.arange(len(found)), named.argmax(axis=1)]
    chosen -= TURN * np.rint(chosen / TURN)
    chosen[:, -1] += TURN * configuration.turns[rows, -1]
    joints: Array = np.where(named.any(axis=1)[:, None], cell.robot.from_controller(chosen), np.nan)
    return joints


def _nearest(found: Array, free: Mask, before: Array) -> Array:
    """(k, axes) one of the solutions (k, configurations, axes) of each row, next to that of the row before, the first one
    next to `before`, turns counted on. free: (k, axes) what stays as it is, whatever the solutions say."""
    first = int(_apart(found[0], before).argmin())
    chosen = [first]
    for some in pieces(np.arange(len(found) - 1)):
        apart = _apart(found[some, :, None], found[some + 1, None])
        nearest = np.where(
            np.isfinite(apart).any(axis=2), apart.argmin(axis=2), np.arange(found.shape[1])
        )
        for after in nearest.tolist():
            chosen.append(after[chosen[-1]])
    joints = np.vstack([before, found[np.arange(len(found)), chosen]])
    # what is free takes the value of the last row that had one
    bound = np.vstack([np.ones(len(before), dtype=bool), ~free])
    held = np.maximum.accumulate(np.where(bound, np.arange(len(joints))[:, None], 0), axis=0)
    joints = np.take_along_axis(joints, held, axis=0)
    known = np.isfinite(joints).all(axis=1)
    joints[known] = np.unwrap(joints[known], axis=0)
    return joints[1:]


def _apart(one: Array, other: Array) -> Array:
    """(...) how far joints (..., axes) are from others, turns left out; infinite where there are none."""
    turned = one - other
    apart = np.abs(turned - TURN * np.rint(turned / TURN)).max(axis=-1)
    return np.where(np.isnan(apart), np.inf, apart)
