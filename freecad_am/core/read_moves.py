# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moves and events that a reader extracts from a controller's files."""

from __future__ import annotations

from dataclasses import dataclass

from .types import Array, Index, Mask

ARC = "ARC"  # replaces the output word in an event if an arc instruction switches the deposit


@dataclass(frozen=True)
class Event:
    """An event between two moves of a text.

    row: index of the next move, n after the last move. kind and value: 'on' and 'off', number and
    word of the output, or the schedule of an arc instruction and ARC; 'schedule', number and value
    of the output; 'wait', s; 'input', number; 'below', number and value of an analogue input;
    'weave', weave number, 0 at the end; 'call', program name; 'layer', layer number in a remark.
    digits: half of the last digit of the value. ahead: s before the end of the previous move, with
    `digits`. before: mm of tip path before that end, with `digits`, in texts that use a distance.
    Both are None at standstill.
    """

    row: int
    kind: str
    value: tuple[float | str, ...]
    digits: float = 0.0
    ahead: float | None = None
    before: float | None = None


@dataclass(frozen=True, eq=False)
class Configuration:
    """Arm configuration in a text at n positions.

    flip: (n,) bool, whether joint 5 is above zero. up: (n,) bool, elbow. front: (n,) bool, shoulder.
    turns: (n, 3) turn numbers of axes; the last column is the last axis.
    """

    flip: Mask
    up: Mask
    front: Mask
    turns: Array


@dataclass(frozen=True, eq=False)
class TextLines:
    """Locations of n moves in a text.

    files: file names. file: (n,) index into `files`. line: (n,) line numbers from 1.
    """

    files: tuple[str, ...]
    file: Index
    line: Index

    def at(self, move: int) -> tuple[str, int]:
        """Return the file name and line number of a move."""
        return self.files[self.file[move]], int(self.line[move])


@dataclass(frozen=True, eq=False)
class ReadMoves:
    """Moves that a post's reader extracts from a program text, in execution order.

    joints: (n, axes) controller joint values, rad, and mm for linear axes, with exactly the digits
    of the text. Rows with Cartesian positions are NaN; None if all rows are Cartesian. A row may
    have joint values and a position: at an arc start the text repeats the position. In texts with
    positions and rotary axes, only the linear axes are NaN. digits: half of the last digit of the
    joint values, rad, scalar or (axes,). linear_digits: half of the last digit of linear axes, mm.

    duration: (n,) s, NaN if the text gives a speed. duration_digits: (n,) s, possible rounding
    error of the duration, for milliseconds and tenths by default. deposit: (n,) bool, whether the
    deposit is on during the move that ends at the point. position, rotation, position_digits (mm),
    rotation_digits (rad): as for joints, in Cartesian texts. direction (n, 3), as in `Moves`, and
    direction_digits, half of the last digit of a component, for texts without a rotation. speed:
    (n,) mm/s at the deposition point, NaN if the text gives a time or a percentage. speed_digits:
    mm/s. share: (n,) speed as a fraction of the maximum axis speed, for the fastest axis, NaN if
    the text gives a time or a path speed. share_digits: half of the last digit of the fraction.
    shorter_way: (axes,) bool, rotary axes of machine tools that take the shorter way, so that the
    text has no turns.

    For texts with explicit frames: `position` is relative to frame (4, 4) in the manufacturer's
    base frame. The moving frame is tool (n, 4, 4) on the flange, with the digits of the positions.
    lever: (n,) distance of a tool from the tool that carries it. All mm. held: linear moves are
    straight in the frame of the held part; otherwise they are straight in `frame`.

    wire: (n,) value of the analogue output during each move, NaN before it is first set; None in
    texts that do not set it. wire_digits: (n,) half of the last digit of the value. wire_output:
    number of the output, from 1. linear: (n,) bool, moves with a straight tip path; other moves are
    straight in joint space. stops: (n,) bool, moves that end at standstill. blend, percent, or
    rounding, mm: (n,) corner rounding at other points, if the text gives it; rounding is NaN at
    stops without a value. level: (n,) index among the controller's eight levels of corner rounding,
    0 at a stop. blend_radius: (n,) mm about the end of a move within which the path may blend into
    the next move, 0 at a stop, measured along the path of the tool in `tool`. near: (n, axes) rad,
    reference joint values for the solution at a position, NaN if the text gives none, with
    near_digits.

    events: events between the moves, in order. configuration: for positions of robots. user_frame,
    tool_frame: (n,) numbers of the selected frame and tool, NaN without a selection; axis moves do
    not depend on a frame and have none. unit: name in the text of the mechanism that carries the
    part and the frame of the positions, or of the track. first_external: number of the first
    external axis. Both as in `Program`. lines: locations of the moves, with all moves of a loop on
    the line of the loop; None if the moves do not come from a text.
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
