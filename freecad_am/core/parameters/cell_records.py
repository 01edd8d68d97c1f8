# SPDX-License-Identifier: LGPL-2.1-or-later
"""Records of a cell: external axes, obstacles, touched points and the shape of the nozzle."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

from ..issues import InputError
from . import field as f
from .records import (
    Point,
    Pose,
    Records,
    entry,
    inner_pose,
    joined,
    numbers,
    pose_text,
    split,
)

PART, ROBOT = "part", "robot"
EXTERNAL_KEY, OBSTACLES_KEY = "cell.external", "cell.obstacles"
TOUCHED_KEY, SHAPE_KEY = "cell.touched", "cell.nozzle.shape"
MAX_BOX_SIZE = 1e5  # mm, of a box
_EXTERNAL_TEXT = re.compile(r"(?P<machine>.+?)\s+at\s+(?P<pose>.+?)\s+carries\s+(?P<carries>\S+)")
_EXTERNAL_FORM = "write, for example: motoman-motopos-d500 at 1500 0 0 0 0 0 carries part"
_BOX = re.compile(r"box\s+(?P<box>[-+\d.,eE\s]+)")
_OBSTACLE_TEXT = re.compile(r"(?:(?P<name>[^=;]+?)\s+=\s+)?(?P<what>.+?)\s+at\s+(?P<pose>[^;]+)")
_OBSTACLE_FORM = "write, for example: table = table.step at 0 0 -200 0 0 0; post = box 60 60 400 at 900 200 0 0 0 0"
_TOUCHED_FORM = (
    "write, for example: 0 0 0 = 900.4 2.1 -99.7; 100 0 0 = 1000.3 1.2 -99.9; 0 80 0 = 901 82 -99.5"
)


@dataclass(frozen=True)
class ExternalMechanism:
    """A mechanism with one or more external axes.

    machine: its id, or the path of a machine file. pose: of its base in the world, mm and rad
    (Bryant). carries: part or robot. Its text has degrees.
    """

    machine: str = entry(f.TEXT)
    pose: Pose = entry(f.POSE)
    carries: str = entry(f.TEXT, PART)

    def __post_init__(self) -> None:
        if self.carries not in (PART, ROBOT):
            raise InputError(
                "BAD_VALUE",
                EXTERNAL_KEY,
                "{!r} cannot be carried; use {} or {}",
                self.carries,
                PART,
                ROBOT,
            )
        if len(self.pose) != 6 or not all(math.isfinite(number) for number in self.pose):
            raise InputError(
                "BAD_VALUE",
                EXTERNAL_KEY,
                "{!r} is not a pose; give six numbers x y z RX RY RZ",
                self.pose,
            )

    def where(self) -> str:
        """Return the pose in the notation of the text."""
        return f"at {pose_text(self.pose)}"

    def __str__(self) -> str:
        return f"{self.machine} {self.where()} carries {self.carries}"


def parse_external(text: str) -> tuple[ExternalMechanism, ...]:
    """Return the mechanisms of a text, in its order. Raises InputError BAD_VALUE."""
    return tuple(map(_external, split(text)))


def _external(text: str) -> ExternalMechanism:
    parts = _EXTERNAL_TEXT.fullmatch(text)
    if parts is None:
        raise InputError(
            "BAD_VALUE", EXTERNAL_KEY, "{!r} names no external axes; {}", text, _EXTERNAL_FORM
        )
    try:
        values = [float(word) for word in parts["pose"].replace(",", " ").split()]
    except ValueError:
        raise InputError(
            "BAD_VALUE", EXTERNAL_KEY, "{!r} is not a pose; {}", parts["pose"], _EXTERNAL_FORM
        ) from None
    if len(values) != 6:
        raise InputError(
            "BAD_VALUE",
            EXTERNAL_KEY,
            "{!r} has {} numbers, a pose has six; {}",
            parts["pose"],
            len(values),
            _EXTERNAL_FORM,
        )
    return ExternalMechanism(parts["machine"], inner_pose(values), parts["carries"])


@dataclass(frozen=True)
class Obstacle:
    """An obstacle of a cell besides part and machine.

    file: its path, '' for a box with edges of `box` mm about its pose's origin. pose: of the file's
    origin, or of the middle of the box, in the world, which is the manufacturer's base frame, mm
    and rad (Bryant). Its text has degrees. name: its name in messages.
    """

    name: str = entry(f.TEXT)
    pose: Pose = entry(f.POSE)
    file: str = entry(f.TEXT, "")
    box: Point | None = entry(f.POINT, None)

    def __post_init__(self) -> None:
        if len(self.pose) != 6 or not all(math.isfinite(number) for number in self.pose):
            raise InputError(
                "BAD_VALUE",
                OBSTACLES_KEY,
                "{}: {!r} is not a pose; give six numbers x y z RX RY RZ",
                self.name,
                self.pose,
            )
        if (self.box is None) == (not self.file):
            raise InputError(
                "BAD_VALUE",
                OBSTACLES_KEY,
                "{} needs either a file or a box; give exactly one of the two",
                self.name,
            )
        if self.box is not None and not all(0.0 < edge <= MAX_BOX_SIZE for edge in self.box):
            edges = " ".join(f"{edge:g}" for edge in self.box)
            raise InputError(
                "BAD_VALUE",
                OBSTACLES_KEY,
                "{}: {} mm is not a box; give three positive lengths of at most {:g} mm",
                self.name,
                edges,
                MAX_BOX_SIZE,
            )
        if any(sign in self.name for sign in "=;") or not self.name.strip():
            raise InputError(
                "BAD_VALUE",
                OBSTACLES_KEY,
                "{!r} is not a name; use words without = and ;",
                self.name,
            )

    def __str__(self) -> str:
        what = self.file if self.box is None else f"box {numbers(self.box)}"
        return f"{self.name} = {what} at {pose_text(self.pose)}"


def parse_obstacles(text: str) -> tuple[Obstacle, ...]:
    """Return the obstacles of a text, in its order. Raises InputError BAD_VALUE."""
    obstacles = tuple(_obstacle(part, number) for number, part in enumerate(split(text), 1))
    check_names(obstacles)
    return obstacles


def check_names(obstacles: tuple[Obstacle, ...]) -> None:
    """Raises InputError BAD_VALUE if two obstacles have the same name."""
    names = [obstacle.name for obstacle in obstacles]
    for name in names:
        if names.count(name) > 1:
            raise InputError(
                "BAD_VALUE",
                OBSTACLES_KEY,
                "{} obstacles are called {!r}; use unique names",
                names.count(name),
                name,
            )


def usual_name(file: str, number: int) -> str:
    """Return the default name of an obstacle: from its file, or "box" with its number, from 1."""
    return Path(file).stem.replace("=", "-") if file else f"box {number}"


def _obstacle(text: str, number: int) -> Obstacle:
    parts = _OBSTACLE_TEXT.fullmatch(text)
    if parts is None:
        raise InputError(
            "BAD_VALUE", OBSTACLES_KEY, "{!r} is not an obstacle; {}", text, _OBSTACLE_FORM
        )
    pose = inner_pose(_numbers(parts["pose"], 6))
    box = _BOX.fullmatch(parts["what"])
    if box is None:
        file = parts["what"].strip()
        return Obstacle(parts["name"] or usual_name(file, number), pose, file)
    width, depth, height = _numbers(box["box"], 3)
    return Obstacle(parts["name"] or usual_name("", number), pose, box=(width, depth, height))


def _numbers(text: str, count: int) -> list[float]:
    try:
        values = [float(word) for word in text.replace(",", " ").split()]
    except ValueError:
        values = []
    if len(values) != count:
        raise InputError(
            "BAD_VALUE",
            OBSTACLES_KEY,
            "{!r} are not {} numbers; {}",
            text.strip(),
            count,
            _OBSTACLE_FORM,
        )
    return values


@dataclass(frozen=True)
class TouchedPoint:
    """A point of the part that the robot has touched.

    part: in the coordinates of the part file. robot: of the tip as the controller shows it, in the
    manufacturer's base frame. mm.
    """

    part: Point = entry(f.POINT)
    robot: Point = entry(f.POINT)

    def __str__(self) -> str:
        return f"{numbers(self.part)} = {numbers(self.robot)}"


def parse_touched(text: str) -> tuple[TouchedPoint, ...]:
    """Return the touched points of a text, in its order. Raises InputError BAD_VALUE."""
    return tuple(map(_touched_point, split(text)))


def _touched_point(text: str) -> TouchedPoint:
    try:
        points = [
            [float(word) for word in end.replace(",", " ").split()] for end in text.split("=")
        ]
    except ValueError:
        points = []
    if len(points) != 2 or not all(
        len(point) == 3 and all(map(math.isfinite, point)) for point in points
    ):
        raise InputError(
            "BAD_VALUE", TOUCHED_KEY, "{!r} is not a touched point; {}", text, _TOUCHED_FORM
        )
    (x, y, z), (u, v, w) = points
    return TouchedPoint((x, y, z), (u, v, w))


@dataclass(frozen=True)
class NozzleShape:
    """The torch as closed solids. file: its path, in mm, the tip at the origin, Z out of the nozzle."""

    file: str = entry(f.TEXT)

    def __str__(self) -> str:
        return self.file


def parse_shape(text: str) -> tuple[NozzleShape, ...]:
    """Return the shape of a text, which is the path of its file."""
    return (NozzleShape(text),)


EXTERNAL = Records(ExternalMechanism, parse_external, joined)
OBSTACLES = Records(Obstacle, parse_obstacles, joined)
TOUCHED = Records(TouchedPoint, parse_touched, joined)
NOZZLE_SHAPE = Records(NozzleShape, parse_shape, joined, single=True)
