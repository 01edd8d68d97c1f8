# SPDX-License-Identifier: LGPL-2.1-or-later
"""The motion that a program's text makes of a cell, whoever wrote it: nothing of a plan is asked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from freecad_am.core.types import Array, Index, Integers, Mask

from ..core.kinematics.cell import Cell
from ..core.motion import Motion
from ..core.program import Program
from ..core.read_moves import Event, ReadMoves
from . import followed, text_path
from .text_path import Path


@dataclass(frozen=True, eq=False)
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
        deposit=deposit,
        layer=layer,
        bead=bead,
        point=point,
        position=position,
        build=tool,
        tool=tool,
        speed=speed,
        width=np.full(len(rows), np.nan),
        joints=serial[rows],
        duration=duration,
    )


def beads(motion: Motion) -> list[DrivenBead]:
    """The beads of a motion, in order."""
    deposited = np.flatnonzero(motion.deposit)
    parts = (
        np.split(deposited, np.flatnonzero(motion.point[deposited] == 0)[1:])
        if len(deposited)
        else []
    )
    return [
        DrivenBead(motion.position[rows], motion.build[rows], motion.tool[rows]) for rows in parts
    ]


def _driven(cell: Cell, program: Program, read: ReadMoves) -> tuple[Path, Array]:
    """Where the text takes the tip, and the serial joints (n, axes) that do it."""
    machine, continuous = cell.machine, text_path.shorter_way(cell, program, read)
    if read.position is None:
        assert read.joints is not None
        shown = _in_turns(read.joints, continuous)
        return text_path.joint_path(cell, shown, text_path.digits(cell, read))[
            0
        ], machine.from_controller(shown)
    if not cell.machine.free:
        path = text_path.text_tips(cell, program, read)
        serial = followed.by_table(cell, read, path)
    else:
        path, asked, _ = text_path.text_path(cell, program, read)
        serial = followed.by_robot(cell, read, asked)
    return path, machine.from_controller(_in_turns(machine.to_controller(serial), continuous))


def _in_turns(shown: Array, continuous: Mask) -> Array:
    """Controller values (n, axes) with the axes that go the shorter way counted on from row to row."""
    unwrapped, known = np.array(shown), np.isfinite(shown).all(axis=1)
    unwrapped[np.ix_(known, continuous)] = np.unwrap(unwrapped[np.ix_(known, continuous)], axis=0)
    return unwrapped


def _durations(cell: Cell, read: ReadMoves, position: Array, serial: Array) -> Array:
    """(n,) s of each move as the text says it: by a time, a speed of the tip, or a share of the axes' largest speeds; 0 of
    the first one, which begins wherever the machine stands."""
    way = np.linalg.norm(np.diff(position, axis=0, prepend=position[:1]), axis=1)
    turned = np.abs(np.diff(cell.machine.to_controller(serial), axis=0, prepend=np.nan))
    with np.errstate(invalid="ignore"):
        quickest = np.nan_to_num((turned / cell.machine.max_speed).max(axis=1))
    taken = read.duration
    if read.speed is not None:
        by_speed = np.divide(way, read.speed, out=np.full(len(way), np.nan), where=read.speed > 0.0)
        # a speed of the tip says nothing where the tip stands still
        taken = np.where(
            np.isnan(taken), np.maximum(by_speed, np.where(way > 0.0, 0.0, quickest)), taken
        )
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


def _layers(events: tuple[Event, ...], starts: Index) -> Integers:
    """(beads,) the layer of each bead that begins with the moves `starts`, as remarks tell it; 0 where none does."""
    layers = [(event.row, int(float(event.value[0]))) for event in events if event.kind == "layer"]
    if not layers:
        return np.zeros(len(starts), dtype=np.int64)
    rows, numbers = np.array(layers, dtype=np.int64).T
    return np.asarray(
        numbers[np.maximum(np.searchsorted(rows, starts, side="right") - 1, 0)], dtype=np.int64
    )


def _places(deposit: Mask, fresh: Mask, layers: Integers) -> tuple[Integers, ...]:
    """Layer, bead and point (n,) of the rows; rapids carry the bead that they lead to. fresh: the first rows of beads."""
    if not len(layers):
        nowhere = np.zeros(len(deposit), dtype=np.int64)
        return nowhere, nowhere, np.arange(len(deposit))
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
