# SPDX-License-Identifier: LGPL-2.1-or-later
"""The state of reading KRL modules, and the resulting moves."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field

import numpy as np

from freecad_am.core.types import Array

from ...core.issues import InputError
from ...core.read_moves import Event, ReadMoves
from ..packed import Lines, floats
from .read_arc import ArcMove


@dataclass
class Run:
    """The state while the modules are followed, column by column.

    state: the last settings, by name; a module relies on no settings of another one. standing:
    nothing moves, as the program has waited. signals: outputs, the first and the last, by the name
    they have in the module. external: values of the external axes at each move; unit: the mechanism
    that BASE is coupled to, and numbers of its axes; slides: number of the axis that a remark calls
    the track. arc: the instruction of ArcTech that is being read. trigger: s before its end at
    which the next move switches an output, which one, and whether on.
    """

    files: dict[str, tuple[str, list[str]]]
    values: list[Array] = field(default_factory=list)
    linear: bytearray = field(default_factory=bytearray)
    deposit: bytearray = field(default_factory=bytearray)
    speed: array[float] = field(default_factory=floats)
    share: array[float] = field(default_factory=floats)
    rounding: array[float] = field(default_factory=floats)
    base: array[float] = field(default_factory=floats)
    tool: array[float] = field(default_factory=floats)
    events: list[Event] = field(default_factory=list)
    followed: list[str] = field(default_factory=list)
    state: dict[str, float] = field(default_factory=dict)
    half_digits: dict[str, float] = field(default_factory=dict)
    external: list[Array] = field(default_factory=list)
    signals: dict[str, tuple[int, int]] = field(default_factory=dict)
    unit: str | None = None
    numbers: tuple[int, ...] = ()
    slides: tuple[int, ...] = ()
    output: str = ""
    on: bool = False
    standing: bool = True
    arc: ArcMove = field(default_factory=ArcMove)
    trigger: tuple[float, str, bool] | None = None
    lines: Lines = field(default_factory=Lines)

    def happens(
        self, kind: str, *value: float | str, digits: float = 0.0, ahead: float | None = None
    ) -> None:
        """Add an event before the next move, or `ahead` s before the end of the last one."""
        self.events.append(Event(len(self.speed), kind, value, digits, ahead))

    def note_digits(self, what: str, texts: tuple[str, ...]) -> None:
        """Keep half of the last digit of numbers of a kind."""
        half = 0.5 * 10.0 ** -min(len(text.partition(".")[2]) for text in texts)
        self.half_digits[what] = max(half, self.half_digits.get(what, 0.0))


def read_moves(run: Run) -> ReadMoves:
    """The moves of the followed modules."""
    linear, deposit = (np.array(column, dtype=np.bool_) for column in (run.linear, run.deposit))
    values, rounding = np.array(run.values), np.array(run.rounding)
    half, is_linear = run.half_digits, linear[:, None]
    a, b, c = np.radians(np.where(is_linear, values[:, 3:], np.nan)).T
    any_line = bool(linear.any())
    external = np.array(run.external)
    joints = np.radians(np.hstack((np.where(is_linear, np.nan, values), external)))
    joints[:, 6:] = np.where(np.isin(run.numbers, run.slides), external, joints[:, 6:])
    return ReadMoves(
        None if np.isnan(joints).all() else joints,
        float(np.radians(half.get("joints", 0.0))),
        np.full(len(linear), np.nan),
        deposit,
        linear,
        np.isnan(rounding),
        tuple(run.events),
        position=np.where(is_linear, values[:, :3], np.nan) if any_line else None,
        rotation=_about(2, a) @ _about(1, b) @ _about(0, c) if any_line else None,
        position_digits=half.get("places", 0.0),
        rotation_digits=float(np.radians(half.get("turns", 0.0))),
        speed=np.array(run.speed),
        speed_digits=half.get("speed", 0.0),
        share=np.array(run.share),
        share_digits=0.005,
        linear_digits=half.get("slides", 0.0),
        rounding=rounding,
        user_frame=np.array(run.base),
        tool_frame=np.array(run.tool),
        unit=run.unit or "",
        first_external=run.numbers[0] if run.numbers else 1,
        lines=run.lines.read(),
    )


def _about(axis: int, angle: Array) -> Array:
    """(n, 3, 3) rotations about X, Y or Z."""
    turned = np.zeros((len(angle), 3, 3))
    next_axis, last_axis = (axis + 1) % 3, (axis + 2) % 3
    turned[:, axis, axis] = 1.0
    turned[:, next_axis, next_axis] = turned[:, last_axis, last_axis] = np.cos(angle)
    turned[:, last_axis, next_axis], turned[:, next_axis, last_axis] = np.sin(angle), -np.sin(angle)
    return turned


def not_read(where: str, why: str) -> InputError:
    """The error for a line that is not understood, or makes no sense in its position."""
    return InputError("UNREADABLE_PROGRAM", where, "{}; write the program again", why)
