# SPDX-License-Identifier: LGPL-2.1-or-later
"""What programs of five-axis machines say in numbers, whatever the controller: axis words, direction vectors, feeds."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from freecad_am.core.types import Array

from ...core.issues import InputError
from ...core.program import LINEAR, LINEAR_MOVE, RAPID, Moves, Program, slide_feeds
from ..parts import place

# of mm and deg; Siemens' manual on 5-axis machining asks for 5 of positions and 6 of direction vectors
DECIMALS, VECTOR_DECIMALS = 5, 6
# significant digits of a feed, within the range of every controller; digits of the wire speed
# output
FEED_DIGITS, WIRE_DIGITS = 7, 5
SLOWEST, FASTEST = 0.001, 999_999.0
# mm: where the linear axes go less than this, their speed is no measure of the time of a move
SHORTEST_WAY = 0.01
# feed as one over the time of the move, and as a speed
TIME, PATH = "G93", "G94"


def controller_values(joints: Array, kinds: Sequence[str]) -> Array:
    """Joint values (n, axes) in mm and deg, as the text has them."""
    factor = np.array([1.0 if kind == LINEAR else math.degrees(1.0) for kind in kinds])
    values: Array = np.round(joints * factor, DECIMALS) + 0.0
    return values


def rows(template: str, values: Array) -> list[str]:
    """One text per row of the values (n, columns)."""
    return [template % row for row in zip(*values.T.tolist(), strict=True)]


def template(names: Sequence[str]) -> str:
    """Plain words with these addresses: X%.5f Y%.5f."""
    return " ".join(f"{name}%.{DECIMALS}f" for name in names)


def feed(value: float) -> str:
    """A feed with its significant digits, never in exponents."""
    return f"F{_significant(value, FEED_DIGITS)}"


def _significant(value: float, digits: int) -> str:
    return f"{value:.{max(digits - 1 - math.floor(math.log10(value)), 0)}f}"


def level(value: float) -> str:
    """A value of an analogue input, never in exponents."""
    text = f"{value:.6f}".rstrip("0")
    return f"{text}0" if text.endswith(".") else text


def wire(program: Program, speeds: Sequence[float]) -> list[str]:
    """Values of the analogue output at speeds of the wire, mm/s."""
    values = [program.nc.wire_gain * 0.06 * speed for speed in speeds]
    return [_significant(value, WIRE_DIGITS) if value > 1e-9 else "0" for value in values]


def insert_wire_statements(
    program: Program, moves: Moves, lines: Sequence[str], statement: str
) -> list[str]:
    """The lines of a run of moves, the last ones one per move, with the statement that sets the
    analogue output in front of each move at which its value changes. The first value was set before
    the run.
    """
    if moves.wire is None:
        return list(lines)
    values = wire(program, moves.wire.tolist())
    changed = [value != previous for previous, value in zip(values, values[1:])]
    head_count = len(lines) - len(values) + 1
    statements = [
        [statement.format(value)] if new else []
        for new, value in zip(changed, values[1:], strict=True)
    ]
    return [
        *lines[:head_count],
        *(
            line
            for words, move in zip(statements, lines[head_count:], strict=True)
            for line in (*words, move)
        ),
    ]


class Feeds:
    """Feed words of the moves of a program, asked for run by run in the order of motion.

    Moves of axes last as long as planned: F is one over that time in minutes (G93). With
    `program.nc.path_feed` it is the speed of the linear axes in mm/min (G94) wherever these move.
    Beads in positions run at the speed of the tip. slowest: mm/min or deg/min, a controller's lower
    limit for any programmed time; slower moves get this speed for the linear axes, or for the
    rotary ones if only these move.
    """

    def __init__(self, program: Program, slowest: float = 0.0) -> None:
        self.linear = np.array([kind == LINEAR for kind in program.axis_kinds])
        self.kinds, self.by_tip = program.axis_kinds, program.motion == "cartesian"
        self.path_feed, self.slowest = program.nc.path_feed and not self.by_tip, slowest
        self.before: Array | None = None
        self.after_tip = False

    def __call__(self, moves: Moves) -> list[str]:
        """One text per move: the sort of feed and its value, such as 'G93 F120.0000' or 'G94 F300.0000'.

        Raises InputError MOVE_SPEED or MOVE_TIME, naming the bead.
        """
        axis_values = controller_values(moves.joints, self.kinds)
        start = axis_values[0] if self.before is None else self.before
        self.before = axis_values[-1]
        if moves.interpolation == LINEAR_MOVE:
            self.after_tip = True
            return [f"{PATH} {feed(value)}" for value in _tip_feeds(moves).tolist()]
        inverse = _inverse_times(moves)
        steps = np.diff(np.concatenate([start[None], axis_values]), axis=0)
        slide_lengths = np.linalg.norm(steps[:, self.linear], axis=1)
        speeds = 60.0 * slide_feeds(start, axis_values, 60.0 / inverse, self.kinds)
        turning = slide_lengths == 0.0
        speeds[turning] = (np.linalg.norm(steps[:, ~self.linear], axis=1) * inverse)[turning]
        by_speed = (speeds > 0.0) & (speeds < self.slowest)
        if self.path_feed and moves.kind != RAPID:
            by_speed |= (slide_lengths >= SHORTEST_WAY) & (speeds >= SLOWEST) & (speeds <= FASTEST)
        by_speed[
            0
        ] &= not self.after_tip  # a text that ended in a position does not give the path length
        self.after_tip = False
        return [
            f"{PATH} {feed(speed)}" if is_slow else f"{TIME} {feed(by_time)}"
            for is_slow, speed, by_time in zip(
                by_speed.tolist(), speeds.tolist(), inverse.tolist(), strict=True
            )
        ]


def blocks(words: Sequence[str], feeds: Sequence[str]) -> list[str]:
    """G1 blocks with words and feeds; the first block, and blocks that change it, have the sort of
    feed in front.
    """
    lines, sort = [], ""
    for word, (sort_of_feed, value) in zip(words, (feed.split() for feed in feeds), strict=True):
        if not sort:
            lines.append(sort_of_feed)
        lines.append(
            f"{sort_of_feed} G1 {word} {value}"
            if sort not in ("", sort_of_feed)
            else f"G1 {word} {value}"
        )
        sort = sort_of_feed
    return lines


def _inverse_times(moves: Moves) -> Array:
    """(n,) 1/min of the moves."""
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse: Array = 60.0 / moves.duration
    if moves.kind == RAPID:  # one that hardly moves may take no time at all
        inverse = np.clip(np.nan_to_num(inverse, nan=FASTEST, posinf=FASTEST), SLOWEST, FASTEST)
    wrong = ~((inverse >= SLOWEST) & (inverse <= FASTEST))
    if wrong.any():
        raise InputError(
            "MOVE_TIME",
            place(moves),
            "a move of {:.4g} s cannot be written; the range is {:.2g} to {:.0f} s: use another "
            "speed or a larger chord error",
            moves.duration[wrong][0],
            60.0 / FASTEST,
            60.0 / SLOWEST,
        )
    return inverse


def _tip_feeds(moves: Moves) -> Array:
    """(n,) mm/min at the tip."""
    feeds: Array = 60.0 * moves.speed
    wrong = ~((feeds >= SLOWEST) & (feeds <= FASTEST))
    if wrong.any():
        raise InputError(
            "MOVE_SPEED",
            place(moves),
            "{:.4g} mm/s cannot be written; use {:.2g} to {:.0f} mm/s",
            moves.speed[wrong][0],
            SLOWEST / 60.0,
            FASTEST / 60.0,
        )
    return feeds
