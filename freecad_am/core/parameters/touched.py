# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of the part that the robot has touched, as a cell names them: where they are planned, and where they were found."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..issues import InputError

Point = tuple[float, float, float]

NONE = "none"
WHERE = "cell.touched"
SEPARATOR = ";"  # separator of points
_FORM = "write such as: 0 0 0 = 900.4 2.1 -99.7; 100 0 0 = 1000.3 1.2 -99.9; 0 80 0 = 901 82 -99.5"


@dataclass(frozen=True)
class Touched:
    """A touched point.

    part: in the coordinates of the part file. robot: of the tip as the controller shows it, in the
    manufacturer's base frame. mm.
    """

    part: Point
    robot: Point

    def __str__(self) -> str:
        return " = ".join(
            " ".join(f"{number:.12g}" for number in point) for point in (self.part, self.robot)
        )


def parse_touched(text: str) -> tuple[Touched, ...]:
    """Return the touched points of a text, in its order; empty for none. Raises InputError
    BAD_VALUE.
    """
    if text.strip() == NONE:
        return ()
    return tuple(_one(part.strip()) for part in text.split(SEPARATOR) if part.strip())


def _one(text: str) -> Touched:
    ends = text.split("=")
    try:
        numbers = [[float(word) for word in end.replace(",", " ").split()] for end in ends]
    except ValueError:
        numbers = []
    if len(numbers) != 2 or not all(
        len(one) == 3 and all(map(math.isfinite, one)) for one in numbers
    ):
        raise InputError("BAD_VALUE", WHERE, "{!r} is not a touched point; {}", text, _FORM)
    (x, y, z), (u, v, w) = numbers
    return Touched((x, y, z), (u, v, w))
