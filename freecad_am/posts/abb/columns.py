# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collect the moves of RAPID modules column by column, and convert them to `ReadMoves`."""

from __future__ import annotations

import dataclasses
import re
from array import array
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ...core.issues import Text
from ...core.read_moves import ARC, Event, ReadMoves
from ...core.types import Array
from ..read_lines import Lines, floats
from .modules import Frames, Module, ProcessData, rotation_of_quaternions, unreadable

_DECIMALS = re.compile(r"\.(\d+)")


class Move(NamedTuple):
    """A move as in its line: joint values, or position and orientation, and the external axes.

    amount: s for joint moves, mm/s for linear moves. half: half of the last digit of `amount`.
    wire: value of the analogue output, and half of its last digit.
    """

    linear: bool
    values: tuple[str, ...]
    axes: str
    amount: float
    half: float
    zone: str
    frames: Frames
    wire: float = np.nan
    wire_half: float = 0.0


@dataclass
class Run:
    """The state while routines are executed, column by column.

    external: values of the external axes. used: numbers of the axes with values. unit: mechanical
    unit of these axes. slides: axes that a remark marks as the track. active: mechanical unit that
    the module activated.

    placed: whether a move has a position, stored in positions and turns. joints: values of joint
    moves. rounding: mm, NaN for moves that stop. nearest: ConfL is off, and the arm reaches
    positions in the nearest configuration. process_data: data of the module. output, on: output and
    state of the deposit. seam, weave: data of the active arc. struck: weave at the start of the
    arc, until the robot moves. last_weld: weld data and weave of the arc's start or last move.
    feeding: whether the wire feeds. fed: whether it stopped within the bead.
    """

    modules: dict[str, Module]
    linear: bytearray = field(default_factory=bytearray)
    deposit: bytearray = field(default_factory=bytearray)
    placed: bytearray = field(default_factory=bytearray)
    time_or_speed: array[float] = field(default_factory=floats)
    half: array[float] = field(default_factory=floats)
    rounding: array[float] = field(default_factory=floats)
    wire: array[float] = field(default_factory=floats)
    wire_half: array[float] = field(default_factory=floats)
    joints: list[str] = field(default_factory=list)
    positions: list[str] = field(default_factory=list)
    turns: list[str] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    followed: list[str] = field(default_factory=list)
    frames: Frames | None = None
    external: list[str] = field(default_factory=list)
    used: tuple[int, ...] | None = None
    unit: str = ""
    slides: tuple[int, ...] = ()
    active: str = ""
    output: str = ""
    on: bool = False
    nearest: bool = False
    process_data: ProcessData = field(default_factory=ProcessData)
    seam: int = 0
    weave: int = 0
    struck: int | None = None
    last_weld: tuple[str, int] = ("", 0)
    feeding: bool = False
    fed: bool = False
    analogue: int | None = None
    lines: Lines = field(default_factory=Lines)

    @property
    def moving(self) -> bool:
        """Whether the last move passes through its end."""
        return bool(self.time_or_speed) and not np.isnan(self.rounding[-1])

    def happens(
        self, kind: str, *value: float | str, digits: float = 0.0, before: float | None = None
    ) -> None:
        """Add an event before the next move, or ahead of the end of the last move.

        Parameters
        ----------
        kind : str
            Kind of the event.
        *value : float or str
            Values of the event.
        digits : float, optional
            Half of the last digit of a number.
        before : float or None, optional
            Distance before the end of the last move, mm; None for an event before the next move.
        """
        self.events.append(Event(len(self.time_or_speed), kind, value, digits, before=before))

    def keep_switch(
        self,
        output: str,
        on: bool,
        word: str,
        where: str,
        digits: float = 0.0,
        before: float | None = None,
    ) -> None:
        """Record that an output or the arc switches the deposit.

        Parameters
        ----------
        output : str
            Number of the output.
        on : bool
            Whether it switches on.
        word : str
            Instruction that switches the deposit; ARC for the arc.
        where : str
            File and line, for messages.
        digits : float, optional
            Half of the last digit of `before`.
        before : float or None, optional
            Distance before the end of the last move, mm; None for a switch before the next move.

        Raises
        ------
        InputError
            UNREADABLE_PROGRAM for a second output.
        """
        if self.output not in ("", output if word != ARC else ARC):
            raise unreadable(where, "the program switches a second output")
        self.output, self.on, self.fed = ARC if word == ARC else output, on, False
        self.happens("on" if on else "off", float(output), word, digits=digits, before=before)

    def keep_move(self, module: Module, move: Move, where: str) -> None:
        """Record a move.

        Parameters
        ----------
        module : Module
            The module, with its zones.
        move : Move
            The move as in its line.
        where : str
            File and line, for messages.

        Raises
        ------
        InputError
            UNREADABLE_PROGRAM for a move that cannot be understood.
        """
        if move.linear and not self.nearest:
            raise unreadable(
                where,
                "configuration supervision (ConfL) is on, but the positions name no configurations",
            )
        if move.zone != "fine" and move.zone not in module.zones:
            raise unreadable(where, Text("the module does not define the zone {}", move.zone))
        if self.feeding and np.isnan(move.wire):
            raise unreadable(where, "the wire feed continues after the bead")
        self._framed(move.frames, where)
        self._external_axes(move.axes.split(","), move.frames, where)
        for column, value in zip(
            (self.positions, self.turns) if move.linear else (self.joints,),
            move.values,
            strict=True,
        ):
            column.append(value)
        self.lines.add(where)
        self.linear.append(move.linear)
        self.placed.append(move.linear)
        self.deposit.append(self.on)
        self.time_or_speed.append(move.amount)
        self.half.append(move.half)
        self.rounding.append(np.nan if move.zone == "fine" else module.zones[move.zone])
        self.wire.append(move.wire)
        self.wire_half.append(move.wire_half)

    def stands_at(self, move: Move, where: str) -> bool:
        """Whether the position of an instruction equals the robot's current position.

        If the text has given only joint values so far, the position also applies to the last move.
        """
        if not self.time_or_speed or self.moving or move.zone != "fine":
            return False
        if self.external and self.external[-1] != self._used_of(move.axes.split(",")):
            raise unreadable(
                where, "external axes would move although the instruction does not move the robot"
            )
        if self.placed[-1]:
            return (self.positions[-1], self.turns[-1]) == move.values
        self._framed(move.frames, where)
        self.placed[-1] = True
        self.positions.append(move.values[0])
        self.turns.append(move.values[1])
        return True

    def _framed(self, frames: Frames, where: str) -> None:
        if self.frames is None:
            self.frames = frames
        elif frames is not self.frames and not frames.same(self.frames):
            raise unreadable(where, "moves use more than one tool or work object")

    def _used_of(self, texts: list[str]) -> str:
        return ",".join(text for text in texts if text != "9E9")

    def _external_axes(self, texts: list[str], frames: Frames, where: str) -> None:
        """Store the values of the external axes: the axes of the active unit below the work object,
        and the track.

        All moves must use the same axes. With a fixed work object, only the track is allowed.
        """
        used = tuple(number for number, text in enumerate(texts, 1) if text != "9E9")
        if used != tuple(range(used[0], used[0] + len(used)) if used else ()) or self.used not in (
            None,
            used,
        ):
            raise unreadable(
                where,
                "the external axes of the move differ from earlier moves, or have gaps between "
                "them",
            )
        if len(self.slides) > 1 or not {*self.slides} <= {*used}:
            raise unreadable(
                where, "more than one axis is marked as the track, or the track has no value"
            )
        turned_ones = set(used) - set(self.slides)
        if bool(turned_ones) != bool(frames.unit) or (
            self.active != frames.unit and (turned_ones or not used)
        ):
            raise unreadable(
                where,
                "external axes have no value, or their mechanical unit is not active or does not "
                "carry the work object",
            )
        if self.used is not None and self.unit != self.active:
            raise unreadable(where, "the active mechanical unit differs from earlier moves")
        self.used, self.unit = used, self.active
        self.external += [self._used_of(texts)] if used else []


def all_moves(run: Run) -> ReadMoves:
    """Convert the moves of the routines. Raises InputError UNREADABLE_PROGRAM."""
    linear, deposit = (np.array(column, dtype=np.bool_) for column in (run.linear, run.deposit))
    time_or_speed = np.array(run.time_or_speed)
    half = np.array(run.half)
    rounding = np.array(run.rounding)
    used = run.used or ()
    joints = np.full((len(time_or_speed), 6 + len(used)), np.nan)
    joints[~linear, :6] = np.radians(_numbers(run.joints, 6))
    if used:
        external = _numbers(run.external, len(used))
        joints[:, 6:] = np.where(np.isin(used, run.slides), external, np.radians(external))
    turning = run.joints if used == run.slides else run.joints + run.external
    read_moves = ReadMoves(
        None if np.isnan(joints).all() else joints,
        float(np.radians(_half_digit(turning))),
        np.where(linear, np.nan, time_or_speed),
        deposit,
        linear,
        np.isnan(rounding),
        tuple(run.events),
        speed=np.where(linear, time_or_speed, np.nan),
        speed_digits=float(half[linear].max(initial=0.0)),
        duration_digits=half,
        rounding=rounding,
        unit=run.unit if used else "",
        first_external=used[0] if used else 1,
        linear_digits=_half_digit(run.external) if run.slides else 0.0,
        lines=run.lines.read(),
    )
    if run.analogue is not None:
        read_moves = dataclasses.replace(
            read_moves,
            wire=np.array(run.wire),
            wire_digits=np.array(run.wire_half),
            wire_output=run.analogue,
        )
    return _add_positions(read_moves, run) if linear.any() else read_moves


def _add_positions(read_moves: ReadMoves, run: Run) -> ReadMoves:
    """Add the positions of the tool in the work object.

    If the robot holds the work object, the poses are inverted to poses of the work object at the
    tool.
    """
    used, placed = run.frames, np.array(run.placed, dtype=np.bool_)
    assert used is not None
    turns = _numbers(run.turns, 4)
    length = np.linalg.norm(turns, axis=1)
    if (np.abs(length - 1.0) > 1e-5).any():
        raise unreadable("program", "an orientation is not a unit quaternion")
    positions, rotation = np.full((len(placed), 3), np.nan), np.full((len(placed), 3, 3), np.nan)
    positions[placed], rotation[placed] = (
        _numbers(run.positions, 3),
        rotation_of_quaternions(turns / length[:, None]),
    )
    if used.part_held:
        rotation = np.swapaxes(rotation, 1, 2)
        positions = -np.einsum("nij,nj->ni", rotation, positions)
    stands, carried = (
        (used.tool, used.work_object) if used.part_held else (used.work_object, used.tool)
    )
    return dataclasses.replace(
        read_moves,
        position=positions,
        rotation=rotation,
        position_digits=_half_digit(run.positions),
        # rounding four components by half a digit each rotates by at most four half digits, as much
        # as three angles with this error
        rotation_digits=4.0 / 3.0 * _half_digit(run.turns),
        frame=stands,
        tool=np.broadcast_to(carried, (len(placed), 4, 4)),
        held=used.part_held,
    )


def _numbers(texts: list[str], columns: int) -> Array:
    """Parse the numbers (n, columns) of texts."""
    return np.array(",".join(texts).split(",") if texts else [], dtype=np.float64).reshape(
        -1, columns
    )


def _half_digit(texts: list[str]) -> float:
    """Return half of the last digit of the numbers, or 0 without numbers."""
    return 0.5 * 10.0 ** -min(map(len, _DECIMALS.findall(" ".join(texts))), default=99)
