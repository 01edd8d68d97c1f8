# SPDX-License-Identifier: LGPL-2.1-or-later
"""Obstacles of a cell besides part and machine: files or boxes, and their poses."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

from ..issues import InputError

Pose = tuple[float, float, float, float, float, float]
Size = tuple[float, float, float]

NONE = "none"
WHERE = "cell.obstacles"
SEPARATOR = ";"  # separator of obstacles
MAX_BOX_SIZE = 1e5  # mm, of a box
_BOX = re.compile(r"box\s+(?P<size>[-+\d.,eE\s]+)")
_TEXT = re.compile(r"(?:(?P<name>[^=;]+?)\s+=\s+)?(?P<what>.+?)\s+at\s+(?P<pose>[^;]+)")
_FORM = (
    "write such as: table = table.step at 0 0 -200 0 0 0; post = box 60 60 400 at 900 200 0 0 0 0"
)


@dataclass(frozen=True)
class Obstacle:
    """An obstacle.

    file: its path, '' for a box of `size` mm about its pose's origin. pose: of the file's origin,
    or of the middle of the box, in the world, which is the manufacturer's base frame, mm and rad
    (Bryant). Its text has degrees. name: its name in messages.
    """

    name: str
    pose: Pose
    file: str = ""
    size: Size | None = None

    def __post_init__(self) -> None:
        if len(self.pose) != 6 or not all(math.isfinite(number) for number in self.pose):
            raise InputError(
                "BAD_VALUE",
                WHERE,
                "{}: {!r} is not a pose; give six numbers x y z RX RY RZ",
                self.name,
                self.pose,
            )
        if (self.size is None) == (not self.file):
            raise InputError(
                "BAD_VALUE",
                WHERE,
                "{} must be either a file or a box; give exactly one",
                self.name,
            )
        if self.size is not None and not all(0.0 < edge <= MAX_BOX_SIZE for edge in self.size):
            edges = " ".join(f"{edge:g}" for edge in self.size)
            raise InputError(
                "BAD_VALUE",
                WHERE,
                "{}: {} mm is not a box; give three positive lengths of at most {:g} mm",
                self.name,
                edges,
                MAX_BOX_SIZE,
            )
        if any(sign in self.name for sign in "=;") or not self.name.strip():
            raise InputError(
                "BAD_VALUE", WHERE, "{!r} is not a name; use words without = and ;", self.name
            )

    def __str__(self) -> str:
        what = (
            self.file
            if self.size is None
            else "box " + " ".join(f"{edge:.12g}" for edge in self.size)
        )
        numbers = (*self.pose[:3], *(math.degrees(angle) for angle in self.pose[3:]))
        return f"{self.name} = {what} at {' '.join(f'{number:.12g}' for number in numbers)}"


def obstacles(text: str) -> tuple[Obstacle, ...]:
    """Return the obstacles of a text, in its order; empty for none. Raises InputError BAD_VALUE."""
    if text.strip() == NONE:
        return ()
    found = tuple(
        _obstacle(part.strip(), k)
        for k, part in enumerate(text.split(SEPARATOR), 1)
        if part.strip()
    )
    names = [one.name for one in found]
    for name in names:
        if names.count(name) > 1:
            raise InputError(
                "BAD_VALUE",
                WHERE,
                "{} obstacles are called {!r}; use unique names",
                names.count(name),
                name,
            )
    return found


def usual_name(file: str, number: int) -> str:
    """Return the default name of an obstacle: from its file, or "box" with its number, from 1."""
    return Path(file).stem.replace("=", "-") if file else f"box {number}"


def _obstacle(text: str, number: int) -> Obstacle:
    found = _TEXT.fullmatch(text)
    if found is None:
        raise InputError("BAD_VALUE", WHERE, "{!r} is not an obstacle; {}", text, _FORM)
    pose = _numbers(found["pose"], 6)
    x, y, z, *angles = pose
    a, b, c = (math.radians(angle) for angle in angles)
    box = _BOX.fullmatch(found["what"])
    if box is None:
        file = found["what"].strip()
        return Obstacle(found["name"] or usual_name(file, number), (x, y, z, a, b, c), file)
    width, depth, height = _numbers(box["size"], 3)
    return Obstacle(
        found["name"] or usual_name("", number), (x, y, z, a, b, c), size=(width, depth, height)
    )


def _numbers(text: str, count: int) -> list[float]:
    try:
        numbers = [float(word) for word in text.replace(",", " ").split()]
    except ValueError:
        numbers = []
    if len(numbers) != count:
        raise InputError(
            "BAD_VALUE", WHERE, "{!r} are not {} numbers; {}", text.strip(), count, _FORM
        )
    return numbers
