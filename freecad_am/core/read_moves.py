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
    """An event of a text between its moves: before the move `row`, n after the last.

    kind and value: 'on' and 'off', number and word of the output, or the schedule named by an arc
    instruction, and ARC; 'schedule', number and value of the output; 'wait', s; 'input', number;
    'below', number and value of an analogue input; 'weave', its number, 0 at its end; 'call', the
    program's name; 'layer', its number in a remark. digits: half of the last digit. ahead: s before
    the end of the previous move, with `digits`; before: mm of the tip's path, with `digits` too, in
    texts that use a distance; both None at standstill.
    """

    row: int
    kind: str
    value: tuple[float | str, ...]
    digits: float = 0.0
    ahead: float | None = None
    before: float | None = None


@dataclass(frozen=True, eq=False)
class Configuration:
    """The arm configuration of a text at each of n positions.

    flip: (n,) bool, joint 5 above zero; up: (n,) the elbow; front: (n,) the shoulder; turns: (n, 3)
    of axes, the last column for the last axis.
    """

    flip: Mask
    up: Mask
    front: Mask
    turns: Array


@dataclass(frozen=True, eq=False)
class TextLines:
    """The locations of n moves in a text. files: names; file: (n,) index into them; line: (n,) from
    1.
    """

    files: tuple[str, ...]
    file: Index
    line: Index

    def at(self, move: int) -> tuple[str, int]:
        """File and line of a move."""
        return self.files[self.file[move]], int(self.line[move])


@dataclass(frozen=True, eq=False)
class ReadMoves:
    """The moves that a post's reader finds in a program's text, in the order of execution.

    joints: (n, axes) controller joint values, rad, and mm of linear axes, with exactly the digits
    of the text; rows with Cartesian positions are NaN, and None replaces an array with only such
    rows. A row may have both: at an arc start the text repeats the position. In texts with
    positions and rotary axes, only the linear axes are NaN. digits: half of the last digit of the
    joint values, rad, one or (axes,); linear_digits: of linear axes, mm.

    duration: (n,) s, NaN if the text gives a speed; duration_digits: (n,) s, its possible rounding
    error, for milliseconds and tenths by default. deposit: (n,) bool, whether the deposit is on
    during the move that ends at the point. position, rotation, position_digits (mm),
    rotation_digits (rad): the same for Cartesian texts; direction (n, 3), as in `Moves`, and
    direction_digits, half of the last digit of its numbers, for texts without a rotation. speed:
    (n,) mm/s at the deposition point, NaN if the text gives a time or a percentage; speed_digits:
    mm/s. share: (n,) of the axes' largest speeds, for the fastest axis, NaN if the text gives a
    time or a path speed; share_digits: half of its last digit. shorter_way: (axes,) rotary axes of
    machine tools that the text sends the shorter way, so that it has no turns.

    For texts with their own frames: frame (4, 4), in the manufacturer's base frame, is the frame of
    `position`; tool (n, 4, 4) on the flange is the frame that moves there, with the digits of the
    positions. lever: (n,) distance of a tool from another one that carries it. All mm. held: linear
    moves are straight in the frame of the held part; otherwise they are straight in `frame`.

    wire: (n,) value of the analogue output during each move, NaN before the first; None in texts
    that do not set it. wire_digits: (n,) half of its last digit. wire_output: its number, from 1.
    linear: (n,) bool, moves with a straight tip path, as opposed to straight joints. stops: (n,)
    bool, moves that end at standstill. blend, percent, or rounding, mm: (n,) corner rounding at
    other points, if the text gives it; rounding is NaN at stops without a value. level: (n,) of the
    controller's eight levels of corner rounding, 0 at a stop. blend_radius: (n,) mm about the end
    of a move within which the path may leave it for the next one, 0 at a stop, measured along the
    path of the tool in `tool`. near: (n, axes) rad, joint values close to which those of a position
    must be, NaN if the text gives none, with near_digits.

    events: between the moves, in order. configuration: for positions of robots. user_frame,
    tool_frame: (n,) numbers of the selected frame and tool, NaN without a selection; moves of bare
    axes do not depend on a frame and have none. unit: the text's name for the mechanism that
    carries the part and holds the frame of its positions, or for the track; first_external: the
    number of the first external axis. Both as in `Program`. lines: the locations of the moves, with
    all moves of a loop on its line; None if they do not come from a text.
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
