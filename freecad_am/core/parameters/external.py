# SPDX-License-Identifier: LGPL-2.1-or-later
"""External axes of a cell: the mechanism, its position and its load."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from ..issues import InputError

Pose = tuple[float, float, float, float, float, float]

NONE = "none"
PART, ROBOT = "part", "robot"
WHERE = "cell.external"
SEPARATOR = ";"  # separator of mechanisms
_TEXT = re.compile(r"(?P<machine>.+?)\s+at\s+(?P<pose>.+?)\s+carries\s+(?P<carries>\S+)")
_FORM = "write such as: motoman-motopos-d500 at 1500 0 0 0 0 0 carries part"


@dataclass(frozen=True)
class External:
    """A mechanism with one or more external axes.

    machine: its id, or the path of a machine file. pose: of its base in the world, mm and rad
    (Bryant). carries: part or robot. Its text has degrees.
    """

    machine: str
    pose: Pose
    carries: str = PART

    def __post_init__(self) -> None:
        if self.carries not in (PART, ROBOT):
            raise InputError(
                "BAD_VALUE",
                WHERE,
                "{!r} cannot be carried; use {} or {}",
                self.carries,
                PART,
                ROBOT,
            )
        if len(self.pose) != 6 or not all(math.isfinite(number) for number in self.pose):
            raise InputError(
                "BAD_VALUE", WHERE, "{!r} is not a pose; give six numbers x y z RX RY RZ", self.pose
            )

    def where(self) -> str:
        """Return the pose in the notation of the text."""
        numbers = (*self.pose[:3], *(math.degrees(angle) for angle in self.pose[3:]))
        return f"at {' '.join(f'{number:.12g}' for number in numbers)}"

    def __str__(self) -> str:
        return f"{self.machine} {self.where()} carries {self.carries}"


def externals(text: str) -> tuple[External, ...]:
    """Return the mechanisms of a text, in its order; empty for none. Raises InputError BAD_VALUE."""
    if text.strip() == NONE:
        return ()
    return tuple(_external(part.strip()) for part in text.split(SEPARATOR) if part.strip())


def _external(text: str) -> External:
    found = _TEXT.fullmatch(text)
    if found is None:
        raise InputError("BAD_VALUE", WHERE, "{!r} names no external axes; {}", text, _FORM)
    words = found["pose"].replace(",", " ").split()
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        raise InputError(
            "BAD_VALUE", WHERE, "{!r} is not a pose; {}", found["pose"], _FORM
        ) from None
    if len(numbers) != 6:
        raise InputError(
            "BAD_VALUE",
            WHERE,
            "{!r} has {} numbers, a pose has six; {}",
            found["pose"],
            len(numbers),
            _FORM,
        )
    x, y, z, *angles = numbers
    a, b, c = (math.radians(angle) for angle in angles)
    return External(found["machine"], (x, y, z, a, b, c), found["carries"])
