# SPDX-License-Identifier: LGPL-2.1-or-later
"""Format numbers in programs of five-axis machines for all controllers: axis words, direction
vectors, feeds.
"""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Sequence

import numpy as np

from ..core.issues import InputError
from ..core.program import DEPOSIT, LINEAR, LINEAR_MOVE, RAPID, ROTARY, Moves, Program, slide_feeds
from ..core.types import Array
from .catalogue import plain
from .parts import place
from .refusals import refuse_incomplete


def wrapped(text: str) -> list[str]:
    """Wrap a remark in ASCII characters to lines of at most 80 characters."""
    return textwrap.wrap(plain(text), 80)


def refuse_table(program: Program, post: str) -> None:
    """Reject programs that no five-axis post supports.

    Raises InputError UNSUPPORTED_AXES, NOTHING_TO_WRITE, UNREACHABLE or NO_POSITIONS.
    """
    refuse_incomplete(program, post, len(program.axis_names))
    linear = [
        name
        for name, kind in zip(program.axis_names, program.axis_kinds, strict=True)
        if kind == LINEAR
    ]
    rotary = [
        name
        for name, kind in zip(program.axis_names, program.axis_kinds, strict=True)
        if kind == ROTARY
    ]
    if (
        sorted(linear) != ["X", "Y", "Z"]
        or not set(rotary) <= set("ABC")
        or len(set(rotary)) != len(rotary)
    ):
        raise InputError(
            "UNSUPPORTED_AXES",
            "cell.machine",
            "the post {} writes linear axes X Y Z and rotary axes A B C, each once, but the "
            "machine has {}; name the joints of the machine mx my mz and a, b or c",
            post,
            " ".join(program.axis_names),
        )
    if program.motion == "cartesian" and any(
        run.position is None or run.direction is None
        for run in program.moves
        if run.kind == DEPOSIT
    ):
        raise InputError(
            "NO_POSITIONS", "program.motion", "the program has no positions; use `motion: joint`"
        )


def refuse_words(program: Program, reserved: frozenset[str]) -> None:
    """Reject words that cannot switch the deposit.

    Raises InputError DEPOSIT_WORD for words other than M or H words, for equal words, and for words
    with another meaning (`reserved`; 'H' stands for all H words).
    """
    words = {
        "program.nc.deposit_on": program.nc.deposit_on,
        "program.nc.deposit_off": program.nc.deposit_off,
    }
    if not any(words.values()):
        return
    for key, word in words.items():
        if not re.fullmatch(r"M\d{1,3}|H\d{1,2}=\d{1,5}", word):
            raise InputError(
                "DEPOSIT_WORD",
                key,
                "{!r} is not a word such as M7 or H2=1; give a word for on and a word for off",
                word,
            )
        if re.sub(r"^([MH])0+(?=\d)", r"\1", word) in reserved or (
            word.startswith("H") and "H" in reserved
        ):
            raise InputError(
                "DEPOSIT_WORD",
                key,
                "{} has another meaning on the controller; use another word",
                word,
            )
    if program.nc.deposit_on == program.nc.deposit_off:
        raise InputError(
            "DEPOSIT_WORD", key, "{} cannot switch both on and off; give two different words", word
        )


def refuse_wire_output(program: Program, highest: int) -> None:
    """Raise InputError WIRE_OUTPUT if the analogue output for the wire feed exceeds `highest`."""
    if any(run.wire is not None for run in program.moves) and program.nc.wire_output > highest:
        raise InputError(
            "WIRE_OUTPUT",
            "program.nc.wire_output",
            "the controller program sets analogue outputs 1 to {}, not {}; choose an output in "
            "this range",
            highest,
            program.nc.wire_output,
        )


def refuse_setup(post: str, motion: str, setup: str) -> None:
    """Reject machines without rotary axes; both motions are supported.

    Parameters
    ----------
    post : str
        Name of the post, for messages.
    motion : str
        'joint' or 'cartesian', for messages.
    setup : str
        Set-up of the cell.

    Raises
    ------
    InputError
        UNSUPPORTED_SETUP.
    """
    if setup != "rotary-table":
        raise InputError(
            "UNSUPPORTED_SETUP",
            "cell.setup",
            "the post {} cannot write {} ({} motion); use rotary-table",
            post,
            setup,
            motion,
        )


def dwell(address: str, seconds: float) -> list[str]:
    """Return the dwell command for a time, rounded to 0.001 s; empty for 0 s."""
    return [f"G4 {address}{max(seconds, 0.001):.3f}"] if seconds > 0.0 else []


# decimals of mm and deg, and of vector components; Siemens' manual on 5-axis machining requires 5
# for positions and 6 for direction vectors
DECIMALS, VECTOR_DECIMALS = 5, 6
# significant digits of a feed, within the range of every controller, and of the wire feed output
FEED_DIGITS, WIRE_DIGITS = 7, 5
SLOWEST, FASTEST = 0.001, 999_999.0
# mm; if the linear axes move less, their speed does not determine the duration of a move
SHORTEST_WAY = 0.01
# feed as inverse time, and as a speed
TIME, PATH = "G93", "G94"


def controller_values(joints: Array, kinds: Sequence[str]) -> Array:
    """Convert joint values to the units and decimals of the program text.

    Parameters
    ----------
    joints : (n, axes) array
        Joint values, rad or mm.
    kinds : sequence of str
        Kind of each axis, 'linear' or 'rotary'.

    Returns
    -------
    (n, axes) array
        mm and degrees, rounded.
    """
    factor = np.array([1.0 if kind == LINEAR else math.degrees(1.0) for kind in kinds])
    values: Array = np.round(joints * factor, DECIMALS) + 0.0
    return values


def rows(template: str, values: Array) -> list[str]:
    """Format each row of values.

    Parameters
    ----------
    template : str
        Format string with one field per column.
    values : (n, columns) array
        Values in the units of the program text.

    Returns
    -------
    list of str
        n strings.
    """
    return [template % row for row in zip(*values.T.tolist(), strict=True)]


def template(names: Sequence[str]) -> str:
    """Return the format string of words with these addresses, such as 'X%.5f Y%.5f'."""
    return " ".join(f"{name}%.{DECIMALS}f" for name in names)


def feed(value: float) -> str:
    """Format a feed word with FEED_DIGITS significant digits, without exponent."""
    return f"F{_significant(value, FEED_DIGITS)}"


def _significant(value: float, digits: int) -> str:
    return f"{value:.{max(digits - 1 - math.floor(math.log10(value)), 0)}f}"


def level(value: float) -> str:
    """Format the value of an analogue input without exponent."""
    text = f"{value:.6f}".rstrip("0")
    return f"{text}0" if text.endswith(".") else text


def wire(program: Program, speeds: Sequence[float]) -> list[str]:
    """Return the analogue output values for wire feeds in mm/s."""
    values = [program.nc.wire_gain * 0.06 * speed for speed in speeds]
    return [_significant(value, WIRE_DIGITS) if value > 1e-9 else "0" for value in values]


def insert_wire_statements(
    program: Program, moves: Moves, lines: Sequence[str], statement: str
) -> list[str]:
    """Insert wire statements before the moves at which the wire feed changes.

    The first value is set before the run.

    Parameters
    ----------
    program : Program
        The program, with the gain of the output.
    moves : Moves
        The moves of the run.
    lines : sequence of str
        Lines of the run; the last lines are one per move.
    statement : str
        Format string of the statement that sets the analogue output.

    Returns
    -------
    list of str
        The lines with the statements.
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
    """Build the feed words of a program's moves, run by run in the order of motion.

    Moves in axis values take the planned time: F is the inverse of the time in minutes (G93). With
    `program.nc.path_feed`, F is the speed of the linear axes in mm/min (G94) wherever they move.
    Beads in positions run at the tip speed. slowest: mm/min or deg/min, the controller's lower
    limit for moves with a programmed time. Slower moves state the speed of the linear axes, or of
    the rotary axes if no linear axis moves.
    """

    def __init__(self, program: Program, slowest: float = 0.0) -> None:
        self.linear = np.array([kind == LINEAR for kind in program.axis_kinds])
        self.kinds, self.by_tip = program.axis_kinds, program.motion == "cartesian"
        self.path_feed, self.slowest = program.nc.path_feed and not self.by_tip, slowest
        self.before: Array | None = None
        self.after_tip = False

    def __call__(self, moves: Moves) -> list[str]:
        """Return feed mode and feed of each move, such as 'G93 F120.0000' or 'G94 F300.0000'.

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
        by_speed[0] &= not self.after_tip  # after a position, path length is unknown
        self.after_tip = False
        return [
            f"{PATH} {feed(speed)}" if is_slow else f"{TIME} {feed(by_time)}"
            for is_slow, speed, by_time in zip(
                by_speed.tolist(), speeds.tolist(), inverse.tolist(), strict=True
            )
        ]


def blocks(words: Sequence[str], feeds: Sequence[str]) -> list[str]:
    """Return G1 blocks with words and feeds. The feed mode is written before the first block and
    wherever it changes.
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
    """Return the inverse times (n,) of the moves, 1/min."""
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse: Array = 60.0 / moves.duration
    if moves.kind == RAPID:  # a rapid of almost zero length may take no time
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
    """Return the feeds (n,) at the tip, mm/min."""
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
