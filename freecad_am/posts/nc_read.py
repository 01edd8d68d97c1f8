# SPDX-License-Identifier: LGPL-2.1-or-later
"""Convert the words of five-axis programs to moves; common code of the readers. Shares no code with
a writer.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..core.issues import InputError
from ..core.read_moves import Event, ReadMoves
from ..core.types import Array, Mask, NDArray
from .read_lines import Lines

# feed as the time of the move; as the speed of the linear axes; as the speed of the linear axes, or
# of the rotary axes if no linear axis moves; as the speed of the tip in part coordinates
TIME, SLIDES, AXES, TIP = "time", "slides", "axes", "tip"
_NUMBER = r"-?\d+(?:\.\d*)?|-?\.\d+"
_SHAPED = re.compile(rf"([XYZABCF]|[ABC]3(?==))(=?(?:DC\()?)({_NUMBER})(\)?)$")
_LINEAR, _VECTOR = "XYZ", ("A3", "B3", "C3")


class Shape:
    """The shape of a block with a move, without its numbers.

    Most blocks of a program have the same shape, so one pattern reads them.

    block: words that were already read one by one: an optional `ahead`, G1, and words with numbers.
    """

    def __init__(self, block: Sequence[str], ahead: str = "") -> None:
        words = [_SHAPED.match(word) for word in block if word not in (ahead, "G1")]
        self.names = [word[1] for word in words if word]
        self.shorter = {word[1] for word in words if word and word[2] == "=DC("}
        patterns = [
            f" {word[1]}{re.escape(word[2])}({_NUMBER}){re.escape(word[4])}"
            for word in words
            if word
        ]
        self._pattern = re.compile((f"(?:{ahead} )?G1" if ahead else "G1") + "".join(patterns))

    @staticmethod
    def of(text: str, ahead: str = "") -> Shape | None:
        """Return the shape of a block, or None if the block is not a single move."""
        block = text.split()
        words = block[1:] if block[0] == ahead else block
        is_move = (
            len(words) > 1 and words[0] == "G1" and all(_SHAPED.match(word) for word in words[1:])
        )
        return Shape(block, ahead) if is_move else None

    def words(self, text: str) -> dict[str, str] | None:
        """Return the words of a block by name, or None if the block has another shape."""
        match = self._pattern.fullmatch(text)
        return dict(zip(self.names, match.groups())) if match else None


@dataclass
class Track:
    """The moves read so far, the events between them, and the current settings.

    axes: names of the words of a move in axis values, in order. shorter: axes that took the shorter
    way. on: whether the deposit is on. output, wire: number (from 1) and current value of the
    analogue output. exact: whether moves stop at their ends. rounding: corner tolerance otherwise,
    mm. frame, tool: numbers of the work offset and of the tool, NaN if not set.
    """

    rows: list[tuple[str, dict[str, str]]] = field(default_factory=list)
    deposit: list[bool] = field(default_factory=list)
    axes: tuple[str, ...] = ()
    on: bool = False
    shorter: set[str] = field(default_factory=set)
    output: int = 0
    wire: str = ""
    wires: list[str] = field(default_factory=list)
    exact: bool = False
    rounding: float = math.nan
    frame: float = math.nan
    tool: float = math.nan
    corners: list[float] = field(default_factory=list)
    stops: list[bool] = field(default_factory=list)
    numbers: list[tuple[float, float]] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    checked_words: set[tuple[str, tuple[str, ...]]] = field(default_factory=set)
    lines: Lines = field(default_factory=Lines)

    def happens(self, kind: str, *value: float | str, digits: float = 0.0) -> None:
        """Record an event before the next move."""
        self.events.append(Event(len(self.rows), kind, value, digits))

    def waits(self, seconds: str) -> None:
        """Record a dwell before the next move."""
        self.happens("wait", float(seconds), digits=float(_half_digits([seconds])[0]))

    def rests(self) -> None:
        """Make the last move stop, because the next line waits for its end."""
        self.stops[-1:] = [True] * len(self.stops[-1:])

    def set_wire(self, output: int, value: str, where: str) -> None:
        """Set the analogue output from the next move on.

        Parameters
        ----------
        output : int
            Number of the output.
        value : str
            Value as in the text.
        where : str
            File and line, for messages.

        Raises
        ------
        InputError
            UNREADABLE_PROGRAM for a second output.
        """
        if self.output not in (0, output):
            raise unreadable(where, "the program sets a second analogue output")
        self.output, self.wire = output, value

    def add(self, sort: str, words: dict[str, str], where: str, stops: bool = False) -> None:
        """Add a move.

        Parameters
        ----------
        sort : str
            Kind of the feed.
        words : dict[str, str]
            Words of the move by name, including F.
        where : str
            File and line, for messages.
        stops : bool, optional
            Whether the move ends with a stop.

        Raises
        ------
        InputError
            UNREADABLE_PROGRAM for a move that cannot be understood.
        """
        if float(words.get("F", "0")) <= 0.0:
            raise unreadable(where, "the program moves without setting a feed")
        row = sort, tuple(words)
        if row not in self.checked_words:
            self._check_words(sort, tuple(name for name in words if name != "F"), where)
            self.checked_words.add(row)
        if sort in (SLIDES, AXES) and (not self.rows or self.rows[-1][0] == TIP):
            raise unreadable(where, "the length of the move, and therefore its time, is unknown")
        self.rows.append((sort, words))
        self.lines.add(where)
        self.deposit.append(self.on)
        self.wires.append(self.wire)
        self.stops.append(stops or self.exact)
        self.corners.append(0.0 if self.exact and not math.isnan(self.rounding) else self.rounding)
        self.numbers.append((self.frame if sort == TIP else math.nan, self.tool))

    def _check_words(self, sort: str, names: tuple[str, ...], where: str) -> None:
        """Check that the words form a move; the first move sets the axes."""
        if sort == TIP:
            if not set(_LINEAR) <= set(names) or not self.axes:
                raise unreadable(where, "a position needs X Y Z and a previous move in axis values")
        elif not self.axes and set(_LINEAR) <= set(names) and not set(names) & set(_VECTOR):
            self.axes = names
        elif names != self.axes:
            raise unreadable(where, "the axes of the move differ from those of the first move")

    def moves(self) -> ReadMoves:
        """Return all moves. Raises InputError UNREADABLE_PROGRAM without moves."""
        if not self.rows:
            raise unreadable("program", "the program has no moves")
        sorts = np.array([sort for sort, _ in self.rows])
        tips = sorts == TIP
        linear = np.array([name in _LINEAR for name in self.axes])
        is_given = np.where(
            tips[:, None],
            [name in self.rows[_first(tips)][1] for name in self.axes] & ~linear,
            True,
        )
        joints, digits = self._values(self.axes, is_given)
        feeds, feed_digits = self._values(
            ("F",), np.ones((len(self.rows), 1), bool), per_value=True
        )
        duration, duration_digits = _durations(
            sorts, joints, linear, feeds[:, 0], feed_digits[:, 0]
        )
        joints[:, ~linear] = np.radians(joints[:, ~linear])
        turning, sliding = (float(np.max(digits[side], initial=0.0)) for side in (~linear, linear))
        shorter = np.array([name in self.shorter for name in self.axes])
        columns = {
            "linear_digits": sliding,
            "duration_digits": duration_digits,
            "shorter_way": shorter,
        }
        columns["lines"] = self.lines.read()
        columns |= self._wire() | self._numbers(tips)
        deposit, stops, events = np.array(self.deposit), np.array(self.stops), tuple(self.events)
        if not tips.any():
            return ReadMoves(
                joints,
                math.radians(turning),
                duration,
                deposit,
                tips,
                stops,
                events,
                **columns,  # type: ignore[arg-type]
            )
        position, position_digits = self._values(_LINEAR, np.repeat(tips[:, None], 3, axis=1))
        vectors = np.repeat(
            (tips & np.array([_VECTOR[0] in words for _, words in self.rows]))[:, None], 3, axis=1
        )
        direction, direction_digits = self._values(_VECTOR, vectors)
        length = np.linalg.norm(direction, axis=1, keepdims=True)
        return ReadMoves(
            joints,
            math.radians(turning),
            duration,
            deposit,
            tips,
            stops,
            events,
            position=position,
            position_digits=float(position_digits.max()),
            speed=np.where(tips, feeds[:, 0] / 60.0, np.nan),
            speed_digits=float(np.max(feed_digits[tips, 0])) / 60.0,
            direction=direction / length if vectors.any() else None,
            direction_digits=float(direction_digits.max()),
            **columns,  # type: ignore[arg-type]
        )

    def _numbers(self, tips: Mask) -> dict[str, object]:
        corners, numbers = np.array(self.corners), np.array(self.numbers)
        columns: dict[str, object] = {
            "tool_frame": numbers[:, 1],
            "user_frame": numbers[:, 0] if tips.any() else None,
        }
        has_corners = ~np.isnan(corners).all()
        return {**columns, "rounding": corners} if has_corners else columns

    def _wire(self) -> dict[str, object]:
        if not self.output:
            return {}
        values = np.array([float(text or "nan") for text in self.wires])
        return {"wire": values, "wire_digits": _half_digits(self.wires), "wire_output": self.output}

    def _values(
        self, names: Sequence[str], is_given: Mask, per_value: bool = False
    ) -> tuple[Array, Array]:
        """Return the values (n, names) of the given rows, NaN elsewhere, and half of the last digit
        of each name, or of each value.
        """
        values = np.full(is_given.shape, np.nan)
        halves = np.zeros(is_given.shape)
        for column, name in enumerate(names):
            rows = np.flatnonzero(is_given[:, column])
            texts = [self.rows[row][1][name] for row in rows.tolist()]
            values[rows, column] = np.array(texts, dtype=np.float64)
            halves[rows, column] = _half_digits(texts)
        return values, halves if per_value else halves.max(axis=0)


def _half_digits(texts: Sequence[str]) -> Array:
    """Return half of the last digit (n,) of each number."""
    decimals = np.array([len(text.partition(".")[2]) for text in texts], dtype=np.intp)
    half: Array = np.array(
        [0.5 * 10.0**-count for count in range(int(decimals.max(initial=0)) + 1)]
    )[decimals]
    return half


def _first(mask: Mask) -> int:
    return int(np.argmax(mask))


def _durations(
    sorts: NDArray[np.str_], axes: Array, linear: Mask, feeds: Array, digits: Array
) -> tuple[Array, Array]:
    """Return the durations (n,) of moves, s, and their errors due to rounding.

    axes: (n, axes), mm and deg. The duration is NaN if the feed is the tip speed.
    """
    steps = np.diff(axes, axis=0, prepend=axes[:1])
    path_length, turn = (np.linalg.norm(steps[:, side], axis=1) for side in (linear, ~linear))
    path_length = np.where((sorts == AXES) & (path_length == 0.0), turn, path_length)
    duration = np.where(
        sorts == TIME, 60.0 / feeds, np.where(sorts == TIP, np.nan, 60.0 * path_length / feeds)
    )
    return duration, np.nan_to_num(duration * digits / (feeds - digits))


def unreadable(where: str, why: str) -> InputError:
    """Return the error for text that is not understood."""
    return InputError("UNREADABLE_PROGRAM", where, "{}; write the program again", why)
