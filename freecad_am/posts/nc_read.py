# SPDX-License-Identifier: LGPL-2.1-or-later
"""What readers of programs of five-axis machines have in common: words become moves. Shares nothing with a writer."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..core.issues import InputError
from ..core.program import ReadMoves

Array = NDArray[np.float64]

# feed as the time of the move; as the speed of the linear axes; as theirs, or that of the rotary axes where these alone
# move; and as that of the tip in part coordinates
TIME, SLIDES, AXES, TIP = "time", "slides", "axes", "tip"
_LINEAR, _VECTOR = "XYZ", ("A3", "B3", "C3")


@dataclass
class Track:
    """The moves found so far, and whether the deposit is on. axes: names of the words of a move in axes, in their order;
    shorter: those that were sent the shorter way."""

    rows: list[tuple[str, dict[str, str]]] = field(default_factory=list)
    deposit: list[bool] = field(default_factory=list)
    axes: tuple[str, ...] = ()
    on: bool = False
    shorter: set[str] = field(default_factory=set)

    def add(self, sort: str, words: dict[str, str], where: str) -> None:
        """A move with these words, F among them. Raises InputError UNREADABLE_PROGRAM."""
        if float(words.get("F", "0")) <= 0.0:
            raise unreadable(where, "a move without a feed of its own")
        names = tuple(name for name in words if name != "F")
        if sort == TIP:
            if not set(_LINEAR) <= set(names) or not self.axes:
                raise unreadable(where, "a position needs X Y Z, and a move in axes before it")
        elif not self.axes and set(_LINEAR) <= set(names) and not set(names) & set(_VECTOR):
            self.axes = names
        elif names != self.axes:
            raise unreadable(where, "the move is not told in the axes of the first one")
        if sort in (SLIDES, AXES) and (not self.rows or self.rows[-1][0] == TIP):
            raise unreadable(where, "the way of the move, and so its time, is not known")
        self.rows.append((sort, words))
        self.deposit.append(self.on)

    def moves(self) -> ReadMoves:
        """All of them. Raises InputError UNREADABLE_PROGRAM when there are none."""
        if not self.rows:
            raise unreadable("program", "there are no moves")
        sorts = np.array([sort for sort, _ in self.rows])
        tips = sorts == TIP
        linear = np.array([name in _LINEAR for name in self.axes])
        told = np.where(tips[:, None], [name in self.rows[_first(tips)][1] for name in self.axes] & ~linear, True)
        joints, digits = self._values(self.axes, told)
        feeds, feed_digits = self._values(("F",), np.ones((len(self.rows), 1), bool), each=True)
        duration, duration_digits = _durations(sorts, joints, linear, feeds[:, 0], feed_digits[:, 0])
        joints[:, ~linear] = np.radians(joints[:, ~linear])
        turning, sliding = (float(np.max(digits[side], initial=0.0)) for side in (~linear, linear))
        shorter = np.array([name in self.shorter for name in self.axes])
        read = {"linear_digits": sliding, "duration_digits": duration_digits, "shorter_way": shorter}
        deposit = np.array(self.deposit)
        if not tips.any():
            return ReadMoves(joints, math.radians(turning), duration, deposit, **read)  # type: ignore[arg-type]
        position, position_digits = self._values(_LINEAR, np.repeat(tips[:, None], 3, axis=1))
        vectors = np.repeat((tips & np.array([_VECTOR[0] in words for _, words in self.rows]))[:, None], 3, axis=1)
        direction, direction_digits = self._values(_VECTOR, vectors)
        length = np.linalg.norm(direction, axis=1, keepdims=True)
        return ReadMoves(
            joints, math.radians(turning), duration, deposit, position=position,
            position_digits=float(position_digits.max()), speed=np.where(tips, feeds[:, 0] / 60.0, np.nan),
            speed_digits=float(np.max(feed_digits[tips, 0])) / 60.0,
            direction=direction / length if vectors.any() else None,
            direction_digits=float(direction_digits.max()), **read,  # type: ignore[arg-type]
        )

    def _values(self, names: Sequence[str], told: NDArray[np.bool_], each: bool = False) -> tuple[Array, Array]:
        """Values (n, names) of the rows told, else NaN, and half of the last digit of each name, or of each value."""
        values = np.full(told.shape, np.nan)
        halves = np.zeros(told.shape)
        for column, name in enumerate(names):
            rows = np.flatnonzero(told[:, column])
            texts = [self.rows[row][1][name] for row in rows.tolist()]
            values[rows, column] = np.array(texts, dtype=np.float64)
            halves[rows, column] = [0.5 * 10.0 ** -len(text.partition(".")[2]) for text in texts]
        return values, halves if each else halves.max(axis=0)


def _first(mask: NDArray[np.bool_]) -> int:
    return int(np.argmax(mask))


def _durations(
    sorts: NDArray[np.str_], axes: Array, linear: NDArray[np.bool_], feeds: Array, digits: Array
) -> tuple[Array, Array]:
    """(n,) s of the moves of axes (n, axes) in mm and deg, NaN where the feed is the speed of the tip, and by how much
    their digits may be off."""
    steps = np.diff(axes, axis=0, prepend=axes[:1])
    way, turn = (np.linalg.norm(steps[:, side], axis=1) for side in (linear, ~linear))
    way = np.where((sorts == AXES) & (way == 0.0), turn, way)
    duration = np.where(sorts == TIME, 60.0 / feeds, np.where(sorts == TIP, np.nan, 60.0 * way / feeds))
    return duration, np.nan_to_num(duration * digits / (feeds - digits))


def unreadable(where: str, why: str) -> InputError:
    """The error for what is not understood."""
    return InputError("UNREADABLE_PROGRAM", where, f"{why}; write the program anew")
