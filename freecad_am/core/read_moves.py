# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a reader finds in a controller's files."""

from __future__ import annotations

from dataclasses import dataclass

from .types import Array, Index, Mask

ARC = (
    "ARC"  # in place of the word of an output, where the deposit is switched by an arc instruction
)


@dataclass(frozen=True)
class Event:
    """What a text does between its moves: before the move `row`, n after the last.

    kind and value: 'on' and 'off', number and word of the output, or the schedule that an arc instruction names, and ARC;
    'schedule', number of the output and what it is set to; 'wait', s; 'input', number; 'below', number and value of
    an analogue input; 'weave', its number, 0 where it ends; 'call', the program's name; 'layer', its number in a remark.
    digits: half of the last digit. ahead: s before the end of the move before that it happens, with `digits`; before: mm of
    the tip's way, in texts that tell these, `digits` too; both None where the machine stands there.
    """

    row: int
    kind: str
    value: tuple[float | str, ...]
    digits: float = 0.0
    ahead: float | None = None
    before: float | None = None


@dataclass(frozen=True, eq=False)
class Configuration:
    """What a text says of the arm at each of n positions: flip (n,) bool, joint 5 above zero; up (n,) the elbow; front (n,)
    the shoulder; turns (n, 3) of axes, the last of them those of the last axis."""

    flip: Mask
    up: Mask
    front: Mask
    turns: Array


@dataclass(frozen=True, eq=False)
class TextLines:
    """Where n moves stand in a text. files: names; file: (n,) which of them; line: (n,) from 1."""

    files: tuple[str, ...]
    file: Index
    line: Index

    def at(self, move: int) -> tuple[str, int]:
        """File and line of a move."""
        return self.files[self.file[move]], int(self.line[move])


@dataclass(frozen=True, eq=False)
class ReadMoves:
    """What a post's reader found in a program's text, all moves in the order of execution.

    joints: (n, axes) controller values, rad, and mm of linear axes, exactly as many digits as the text has; rows told in
    Cartesian positions are NaN, None when all are (a row may have both: where an arc is struck the text tells
    the place again); of texts that give positions and rotary axes, the linear axes alone
    are NaN. digits: half of the last digit of the joint values, rad, one or (axes,); linear_digits: of linear axes, mm.
    duration: (n,) s,
    NaN where the text gives a speed; duration_digits: (n,) s by which its digits may be off, milliseconds and tenths
    when left out. deposit: (n,) bool, whether the deposit is on during the move that ends at the point.
    position, rotation, position_digits (mm), rotation_digits (rad): the same for Cartesian texts; direction (n, 3), as
    in `Moves`, and direction_digits, half of the last digit of its numbers, for texts that tell of no rotation.
    speed: (n,) mm/s at the deposition point, NaN where the text gives a time or a percentage; speed_digits: mm/s.
    share: (n,) of the axes' largest speeds that the fastest axis runs at, NaN where the text gives a time or a path
    speed; share_digits: half of its last digit.
    shorter_way: (axes,) rotary axes of machine tools that the text sends the shorter way, so that it tells no turns.
    Where the text holds its own frames: frame (4, 4), in the maker's base frame, is what `position` is seen in;
    tool (n, 4, 4) on the flange is what is taken there, with the digits of the positions. lever: (n,) how far out a tool
    stands on another one that carries it. All mm. held: linear moves run straight as what the robot holds sees them, where
    else they do as seen from the frame.
    wire: (n,) value of the analogue output that the text sets, during each move, NaN before the first; None in texts that
    set none. wire_digits: (n,) half of its last digit. wire_output: its number, from 1.
    linear: (n,) bool, moves whose tip runs straight, where joints do not. stops: (n,) bool, moves at whose end the machine
    stands still. blend, percent, or rounding, mm: (n,) how far corners are rounded where it does not, if the text says so;
    rounding is NaN at stops that name none.
    level: (n,) of the eight by which the controller grades rounded corners, 0 where it stops.
    blend_radius: (n,) mm about the end of a move in which it may be left for the next one, 0 where it stops, counted on the
    way of the tool in `tool`. near: (n, axes) rad, joint values that those of a position are to be next to, NaN where the
    text gives none, with near_digits.
    events: what happens between the moves, in order. configuration: of positions of robots.
    user_frame, tool_frame: (n,) numbers of the frame and the tool that a text selects, NaN where it selects none; the frame
    of moves of bare axes, which count on none, is left out.
    unit: what a text calls the mechanism that carries the part, and that its positions are seen from, or the track;
    first_external: the number of the first external axis. Both as in `Program`.
    lines: where the moves stand, those of a loop all on its line; None of what is not of a text.
    """

    joints: Array | None
    digits: float | Array
    duration: Array
    deposit: Mask
    linear: Mask
    stops: Mask
    events: tuple[Event, ...]
    position: Array | None = None
    rotation: Array | None = None
    position_digits: float = 0.0
    rotation_digits: float = 0.0
    speed: Array | None = None
    speed_digits: float = 0.05
    share: Array | None = None
    share_digits: float = 0.0
    frame: Array | None = None
    tool: Array | None = None
    lever: Array | None = None
    held: bool = False
    direction: Array | None = None
    direction_digits: float = 0.0
    linear_digits: float = 0.0
    duration_digits: Array | None = None
    shorter_way: Mask | None = None
    wire: Array | None = None
    wire_digits: Array | float = 0.0
    wire_output: int | None = None
    blend: Array | None = None
    rounding: Array | None = None
    level: Array | None = None
    blend_radius: Array | None = None
    near: Array | None = None
    near_digits: float = 0.0
    configuration: Configuration | None = None
    user_frame: Array | None = None
    tool_frame: Array | None = None
    unit: str = ""
    first_external: int = 1
    lines: TextLines | None = None
