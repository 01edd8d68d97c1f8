# SPDX-License-Identifier: LGPL-2.1-or-later
"""The motion that a program's text makes of a cell, whoever wrote it: nothing of a plan is asked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.issues import InputError
from ..core.kinematics import opw
from ..core.kinematics.cell import ROTARY_TABLE, Cell
from ..core.motion import Motion
from ..core.program import Event, Program, ReadMoves
from ..core.geometry import frames
from . import text_path
from .planned import pieces
from .text_path import Path

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

WHERE = "program"


@dataclass(frozen=True)
class DrivenBead:
    """A bead of a motion, as those who look at collisions ask for it; it tells neither width nor height."""

    points: Array
    build: Array
    tool: Array
    width: None = None
    height: None = None


def driven(cell: Cell, program: Program, read: ReadMoves) -> Motion:
    """The rows that a text makes the machine pass, in part coordinates, joints NaN where a position is not reached.

    program: what it is told of the cell, its moves left out. Build directions are tool axes, widths are not known. Raises
    InputError NO_CONFIGURATION where a text does not say by which configuration of the arm it begins.
    """
    path, serial = _driven(cell, program, read)
    seconds = _durations(cell, read, path.position, serial)
    starts = _starts(read)
    # the first row of a bead repeats where the machine stands
    inserted = np.maximum(starts - 1, 0)
    rows = np.insert(np.arange(len(read.deposit)), starts, inserted)
    fresh = np.insert(np.zeros(len(read.deposit), dtype=bool), starts, True)
    deposit = read.deposit[rows] | fresh
    layer, bead, point = _places(deposit, fresh, _layers(read.events, starts))
    duration = np.where(fresh, 0.0, seconds[rows])
    position, tool = path.position[rows], path.tool[rows]
    way = np.linalg.norm(np.diff(position, axis=0, prepend=position[:1]), axis=1)
    speed = np.divide(way, duration, out=np.zeros(len(way)), where=duration > 0.0)
    return Motion(
        deposit=deposit, layer=layer, bead=bead, point=point, position=position, build=tool, tool=tool, speed=speed,
        width=np.full(len(rows), np.nan), joints=serial[rows], duration=duration,
    )


def beads(motion: Motion) -> list[DrivenBead]:
    """The beads of a motion, in order."""
    laid = np.flatnonzero(motion.deposit)
    parts = np.split(laid, np.flatnonzero(motion.point[laid] == 0)[1:]) if len(laid) else []
    return [DrivenBead(motion.position[rows], motion.build[rows], motion.tool[rows]) for rows in parts]


def _driven(cell: Cell, program: Program, read: ReadMoves) -> tuple[Path, Array]:
    """Where the text takes the tip, and the serial joints (n, axes) that do it."""
    half = text_path.digits(cell, read)
    if read.position is None:
        assert read.joints is not None
        shown = _in_turns(read.joints, text_path.shorter_way(cell, program, read))
        return text_path.joint_path(cell, shown, half)[0], cell.machine.from_controller(shown)
    if cell.setup == ROTARY_TABLE:
        assert read.joints is not None
        path = text_path.text_tips(cell, program, read)
        # the tip goes along with the axes that slide: one step from anywhere is there
        near = cell.machine.from_controller(np.where(np.isnan(read.joints), 0.0, read.joints))
        serial = text_path.text_joints(cell, near, read.joints, half, path, None).serial
        shown = _in_turns(cell.machine.to_controller(serial), text_path.shorter_way(cell, program, read))
        return path, cell.machine.from_controller(shown)
    path, asked, _ = text_path.text_path(cell, program, read)
    return path, _followed(cell, read, asked)


def _in_turns(shown: Array, endless: Mask) -> Array:
    """Controller values (n, axes) with the axes that go the shorter way counted on from row to row."""
    counted = np.array(shown)
    counted[:, endless] = np.unwrap(counted[:, endless], axis=0)
    return counted


def _followed(cell: Cell, read: ReadMoves, asked: Array) -> Array:
    """(n, axes) serial joints of a robot whose flange is at `asked` (n, 4, 4): its values where the text has them, else of the
    inverse the solution that lies next to the row before."""
    machine, own = cell.machine, cell.robot.chain.axes
    shown = np.full((len(asked), machine.chain.axes), np.nan) if read.joints is None else read.joints
    unknown = np.isnan(shown[:, :own]).any(axis=1)
    serial = np.full_like(shown, np.nan)
    serial[~unknown] = machine.from_controller(shown[~unknown])
    if own < machine.chain.axes:  # the axes beside the robot are told with every position
        beside = machine.from_controller(np.where(np.isnan(shown), 0.0, shown))[:, own:]
        asked = frames.inverse(cell.external.base(beside)) @ asked if cell.external is not None else asked
        serial[unknown, own:] = beside[unknown]
    edges = np.flatnonzero(np.diff(unknown, prepend=False, append=False))
    for start, end in zip(edges[::2].tolist(), edges[1::2].tolist()):
        before = serial[start - 1, :own] if start else None
        serial[start:end, :own] = _run(cell, read, asked[start:end], start, before)
    return serial


def _run(cell: Cell, read: ReadMoves, poses: Array, start: int, before: Array | None) -> Array:
    """(k, 6) joints of the arm for flange poses (k, 4, 4) that follow each other from row `start` of the text on."""
    arm = cell.robot.arm
    assert arm is not None
    found = np.concatenate([np.moveaxis(arm.solutions(poses[rows])[0], 0, 1) for rows in pieces(np.arange(len(poses)))])
    chosen = [_first(cell, read, found[0], start, before)]
    for rows in pieces(np.arange(len(found) - 1)):
        apart = _apart(found[rows, :, None], found[rows + 1, None])
        nearest = np.where(np.isfinite(apart).any(axis=2), apart.argmin(axis=2), np.arange(found.shape[1]))
        for after in nearest.tolist():
            chosen.append(after[chosen[-1]])
    joints: Array = found[np.arange(len(found)), chosen]
    if before is None or not np.isfinite(before).all():
        return _counted_on(joints)
    return _counted_on(np.vstack([before, joints]))[1:]


def _counted_on(joints: Array) -> Array:
    """Joints (n, 6) in [-pi, pi] with their turns counted from the first row on; rows that are not reached stay NaN."""
    known = np.isfinite(joints).all(axis=1)
    counted = np.array(joints)
    counted[known] = np.unwrap(joints[known], axis=0)
    return counted


def _first(cell: Cell, read: ReadMoves, found: Array, row: int, before: Array | None) -> int:
    """Which of the solutions (configurations, 6) a text means by the position of a row that follows joints `before`."""
    if read.near is not None and np.isfinite(read.near[row]).all():
        before = cell.machine.from_controller(read.near[row])[: found.shape[1]]
    if before is not None and np.isfinite(before).all():
        return int(_apart(before, found).argmin())
    told = read.configuration
    if told is not None:
        words = (
            "front" if told.front[row] else "back", "up" if told.up[row] else "down",
            "noflip" if told.flip[row] == (cell.machine.controller_matrix[4, 4] > 0.0) else "flip",
        )
        return opw.branch_index(words)
    if cell.branch is None:
        raise InputError(
            "NO_CONFIGURATION", WHERE, "it begins with a position and does not say by which configuration of the arm; name it "
            "as cell.branch, such as [front, up, flip]",
        )
    return cell.branch


def _apart(one: Array, other: Array) -> Array:
    """(...) how far joints (..., 6) are from others, turns left out; infinite where there are none."""
    turned = one - other
    apart = np.abs(turned - 2.0 * np.pi * np.rint(turned / (2.0 * np.pi))).max(axis=-1)
    return np.where(np.isnan(apart), np.inf, apart)


def _durations(cell: Cell, read: ReadMoves, position: Array, serial: Array) -> Array:
    """(n,) s of each move as the text says it: by a time, a speed of the tip, or a share of the axes' largest speeds; 0 of the
    first one, which begins wherever the machine stands."""
    way = np.linalg.norm(np.diff(position, axis=0, prepend=position[:1]), axis=1)
    turned = np.abs(np.diff(cell.machine.to_controller(serial), axis=0, prepend=np.nan))
    with np.errstate(invalid="ignore"):
        quickest = np.nan_to_num((turned / cell.machine.max_speed).max(axis=1))
    taken = read.duration
    if read.speed is not None:
        by_speed = np.divide(way, read.speed, out=np.full(len(way), np.nan), where=read.speed > 0.0)
        # a speed of the tip says nothing where the tip stands still
        taken = np.where(np.isnan(taken), np.maximum(by_speed, np.where(way > 0.0, 0.0, quickest)), taken)
    if read.share is not None:
        taken = np.where(np.isnan(taken), quickest / read.share, taken)
    taken = np.where(np.isnan(taken), quickest, taken)
    taken[:1] = 0.0
    return taken


def _starts(read: ReadMoves) -> Index:
    """The moves that are the first ones of beads: with which the deposit begins, or begins anew."""
    begun = np.diff(read.deposit, prepend=False) & read.deposit
    on = [event.row for event in read.events if event.kind == "on" and event.row < len(begun)]
    begun[on] |= read.deposit[on]
    return np.flatnonzero(begun)


def _layers(events: tuple[Event, ...], starts: Index) -> NDArray[np.int64]:
    """(beads,) the layer of each bead that begins with the moves `starts`, as remarks tell it; 0 where none does."""
    told = [(event.row, int(float(event.value[0]))) for event in events if event.kind == "layer"]
    if not told:
        return np.zeros(len(starts), dtype=np.int64)
    rows, numbers = np.array(told, dtype=np.int64).T
    return np.asarray(numbers[np.maximum(np.searchsorted(rows, starts, side="right") - 1, 0)], dtype=np.int64)


def _places(deposit: Mask, fresh: Mask, layers: NDArray[np.int64]) -> tuple[NDArray[np.int64], ...]:
    """Layer, bead and point (n,) of the rows; rapids carry the bead that they lead to. fresh: the first rows of beads."""
    if not len(layers):
        return np.zeros((2, len(deposit)), dtype=np.int64)[0], np.zeros(len(deposit), dtype=np.int64), np.arange(len(deposit))
    # beads are counted anew in each layer
    numbers = np.zeros(len(layers), dtype=np.int64)
    for layer in np.unique(layers):
        same = layers == layer
        numbers[same] = np.arange(same.sum())
    begun = np.cumsum(fresh)
    which = np.minimum(np.where(deposit, begun - 1, begun), len(layers) - 1)
    changed = np.flatnonzero(fresh | np.append(True, deposit[1:] != deposit[:-1]))
    point = np.arange(len(deposit)) - np.repeat(changed, np.diff(np.append(changed, len(deposit))))
    return layers[which], numbers[which], point
