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


def driven(cell: Cell, program: Program, text: ReadMoves) -> Motion:
    """The rows that a text makes the machine pass, in part coordinates, joints NaN where a position is not reached.

    program: what it is told of the cell, its moves left out. Build directions are tool axes, widths are not known. Raises
    InputError NO_CONFIGURATION where a text does not say by which configuration of the arm it begins.
    """
    path, serial = _driven(cell, program, text)
    seconds = _durations(cell, text, path.position, serial)
    starts = _starts(text)
    # the first row of a bead repeats where the machine stands
    inserted = np.maximum(starts - 1, 0)
    rows = np.insert(np.arange(len(text.deposit)), starts, inserted)
    fresh = np.insert(np.zeros(len(text.deposit), dtype=bool), starts, True)
    deposit = text.deposit[rows] | fresh
    layer, bead, point = _places(deposit, fresh, _layers(text.events, starts))
    duration = np.where(fresh, 0.0, seconds[rows])
    position, tool = path.position[rows], path.tool[rows]
    step_lengths = np.linalg.norm(np.diff(position, axis=0, prepend=position[:1]), axis=1)
    speed = np.divide(step_lengths, duration, out=np.zeros(len(step_lengths)), where=duration > 0.0)
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
    row_groups = (
        np.split(deposited, np.flatnonzero(motion.point[deposited] == 0)[1:])
        if len(deposited)
        else []
    )
    return [
        DrivenBead(motion.position[rows], motion.build[rows], motion.tool[rows])
        for rows in row_groups
    ]


def _driven(cell: Cell, program: Program, text: ReadMoves) -> tuple[Path, Array]:
    """Where the text takes the tip, and the serial joints (n, axes) that do it."""
    machine, continuous = cell.machine, text_path.shorter_way(cell, program, text)
    if text.position is None:
        assert text.joints is not None
        controller_values = _in_turns(text.joints, continuous)
        return text_path.joint_path(cell, controller_values, text_path.digits(cell, text))[
            0
        ], machine.from_controller(controller_values)
    if not cell.machine.free:
        path = text_path.text_tips(cell, program, text)
        serial = followed.by_table(cell, text, path)
    else:
        path, flanges, _ = text_path.text_path(cell, program, text)
        serial = followed.by_robot(cell, text, flanges)
    return path, machine.from_controller(_in_turns(machine.to_controller(serial), continuous))


def _in_turns(controller_values: Array, continuous: Mask) -> Array:
    """Controller values (n, axes) with the axes that go the shorter way counted on from row to row."""
    unwrapped, reached = np.array(controller_values), np.isfinite(controller_values).all(axis=1)
    unwrapped[np.ix_(reached, continuous)] = np.unwrap(
        unwrapped[np.ix_(reached, continuous)], axis=0
    )
    return unwrapped


def _durations(cell: Cell, text: ReadMoves, position: Array, serial: Array) -> Array:
    """(n,) s of each move as the text says it: by a time, a speed of the tip, or a share of the axes' largest speeds; 0 of
    the first one, which begins wherever the machine stands."""
    step_lengths = np.linalg.norm(np.diff(position, axis=0, prepend=position[:1]), axis=1)
    turned = np.abs(np.diff(cell.machine.to_controller(serial), axis=0, prepend=np.nan))
    with np.errstate(invalid="ignore"):
        quickest = np.nan_to_num((turned / cell.machine.max_speed).max(axis=1))
    seconds = text.duration
    if text.speed is not None:
        by_speed = np.divide(
            step_lengths, text.speed, out=np.full(len(step_lengths), np.nan), where=text.speed > 0.0
        )
        # a speed of the tip says nothing where the tip stands still
        seconds = np.where(
            np.isnan(seconds),
            np.maximum(by_speed, np.where(step_lengths > 0.0, 0.0, quickest)),
            seconds,
        )
    if text.share is not None:
        seconds = np.where(np.isnan(seconds), quickest / text.share, seconds)
    seconds = np.where(np.isnan(seconds), quickest, seconds)
    seconds[:1] = 0.0
    return seconds


def _starts(text: ReadMoves) -> Index:
    """The moves that are the first ones of beads: with which the deposit begins, or begins anew."""
    begins = np.diff(text.deposit, prepend=False) & text.deposit
    on = [event.row for event in text.events if event.kind == "on" and event.row < len(begins)]
    begins[on] |= text.deposit[on]
    return np.flatnonzero(begins)


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
    bead_counts = np.cumsum(fresh)
    bead_numbers = np.minimum(np.where(deposit, bead_counts - 1, bead_counts), len(layers) - 1)
    changed = np.flatnonzero(fresh | np.append(True, deposit[1:] != deposit[:-1]))
    point = np.arange(len(deposit)) - np.repeat(changed, np.diff(np.append(changed, len(deposit))))
    return layers[bead_numbers], numbers[bead_numbers], point
