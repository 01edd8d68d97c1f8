# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the section `cell` of a job."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..issues import InputError
from . import field as f
from .cell_records import (
    EXTERNAL,
    NOZZLE_SHAPE,
    OBSTACLES,
    TOUCHED,
    ExternalMechanism,
    NozzleShape,
    Obstacle,
    TouchedPoint,
    check_names,
)
from .records import Point, Pose, convert_texts
from .vectors import direction_text

SHOULDERS, ELBOWS, WRISTS = ("front", "back"), ("up", "down"), ("noflip", "flip")


@dataclass(frozen=True)
class NozzleParameters:
    """The nozzle as a cone: a flat tip of `diameter`, opening by `half_angle` over `length`. mm and rad."""

    half_angle: float = f.parameter(
        math.radians(20.0),
        f.ANGLE,
        "Angle between the nozzle's axis and its side.",
        low=0.0,
        high=math.radians(89.0),
    )
    diameter: float = f.parameter(
        1.0, f.LENGTH, "Diameter of the nozzle's flat tip.", low=0.0, high=1000.0
    )
    length: float = f.parameter(
        60.0,
        f.LENGTH,
        "Length of the nozzle, measured from the tip.",
        low=0.0,
        high=10_000.0,
        open_low=True,
    )
    tool: Pose = f.parameter(
        (0.0, 0.0, 200.0, 0.0, 0.0, 0.0),
        f.POSE,
        "Tool on robot only: pose of the tip on the flange, its Z pointing out of the nozzle. "
        "mm, RX RY RZ.",
    )
    shape: NozzleShape | None = f.parameter(
        None,
        f.RECORDS,
        "Robots: file of the torch as closed solids, mm, with the tip at the origin and Z out of "
        "the nozzle; parts above the length of the nozzle keep the arm clearance, like links.",
        advanced=True,
        records=NOZZLE_SHAPE,
    )

    def __post_init__(self) -> None:
        convert_texts(self)
        f.check(self, "cell.nozzle")


@dataclass(frozen=True)
class CellParameters:
    """Machine, set-up and tooling. Angles of poses in rad: X Y Z RX RY RZ, Bryant (Chalvin 2020, eq. 9)."""

    machine: str = f.parameter(
        "fanuc-arcmate120ic", f.TEXT, "A machine from the list, or the path of a machine file."
    )
    limits: str = f.parameter("maker", f.TEXT, "Set of joint limits of the machine file to use.")
    setup: str = f.parameter(
        "part-on-robot",
        f.CHOICE,
        "The robot carries the tool or the part, or the machine has rotary axes.",
        choices=("part-on-robot", "tool-on-robot", "rotary-table", "tool-on-robot+positioner"),
    )
    deposition_point: Pose = f.parameter(
        (1045.747, -630.155, 653.167, 0.0, 0.0, 0.0),
        f.POSE,
        "Robots: deposition point, with its Z towards the tool; with the tool on the robot, the "
        "fixed platform. In the manufacturer's base frame.",
    )
    platform: float | Pose = f.parameter(
        5.0,
        f.LENGTH,
        "Distance along Z from the flange, or from the face of a rotary table, to the mounting "
        "plane; or the pose of the mounting plane.",
    )
    platform_diameter: float = f.parameter(
        113.0, f.LENGTH, "Diameter of the platform, used for clearance.", low=0.0, high=10_000.0
    )
    mount: str = f.parameter(
        "auto",
        f.CHOICE,
        "Frame to place on the platform: the frame of the feature, or of the part file.",
        choices=("auto", "feature", "part"),
    )
    branch: str | tuple[str, str, str] = f.parameter(
        ("front", "up", "flip"),
        f.TEXT,
        "Robots: shoulder, elbow and wrist, or auto to search all eight.",
    )
    nozzle: NozzleParameters = f.group(NozzleParameters, "The nozzle.")
    external: tuple[ExternalMechanism, ...] = f.parameter(
        (),
        f.RECORDS,
        "Robots: external axes that carry the part or the robot, such as: motoman-motopos-d500 "
        "at 1500 0 0 0 0 0 carries part. x y z mm, RX RY RZ deg of the base in the world, the "
        "base frame of the robot; separate several mechanisms with semicolons.",
        advanced=True,
        poses=True,
        records=EXTERNAL,
    )
    world_up: Point = f.parameter(
        (0.0, 0.0, 1.0),
        f.VECTOR,
        "Direction against gravity, as x y z in the world.",
        advanced=True,
        records=direction_text("cell.world_up"),
    )
    arm_clearance: float | None = f.parameter(
        None,
        f.LENGTH,
        "Robots: smallest distance between the links and part, deposit, platform, fixtures and "
        "nozzle, rapids included; if not set, planning ignores the links.",
        low=0.0,
        high=1000.0,
        optional=True,
    )
    obstacles: tuple[Obstacle, ...] = f.parameter(
        (),
        f.RECORDS,
        "Robots: obstacles in the cell that nozzle, part and links must clear, such as: table = "
        "table.step at 0 0 -200 0 0 0; post = box 60 60 400 at 900 200 0 0 0 0. x y z mm, RX RY "
        "RZ deg of the origin of the file, or of the centre of the box, in the manufacturer's "
        "base frame.",
        advanced=True,
        records=OBSTACLES,
    )

    touched: tuple[TouchedPoint, ...] = f.parameter(
        (),
        f.RECORDS,
        "Tool on robot only: points of the part and the positions where the tip touched them, at "
        "least three, which replace the deposition point, such as: 0 0 0 = 900.4 2.1 -99.7; 100 "
        "0 0 = 1000.3 1.2 -99.9; 0 80 0 = 901 82 -99.5. In the part file and in the "
        "manufacturer's base frame, mm.",
        advanced=True,
        records=TOUCHED,
    )
    touched_tolerance: float = f.parameter(
        1.0,
        f.LENGTH,
        "Maximum distance of a touched point from the best fit.",
        low=0.0,
        high=100.0,
        open_low=True,
        advanced=True,
    )

    def __post_init__(self) -> None:
        convert_texts(self)
        check_names(self.obstacles)
        if isinstance(self.platform, (tuple, list)):
            if len(self.platform) != 6:
                raise InputError(
                    "BAD_VALUE",
                    "cell.platform",
                    "{!r} is neither a length nor six numbers; give a value such as 300, or x y "
                    "z RX RY RZ",
                    self.platform,
                )
            object.__setattr__(self, "platform", tuple(self.platform))
        if not isinstance(self.branch, str):
            object.__setattr__(self, "branch", checked_branch(self.branch))
        elif self.branch != "auto":
            object.__setattr__(
                self, "branch", checked_branch(tuple(self.branch.replace(",", " ").split()))
            )
        skip = {
            name
            for name in ("platform", "branch")
            if not isinstance(getattr(self, name), (int, float))
        }
        f.check(self, "cell", skip=frozenset(skip))


def checked_branch(words: tuple[str, ...]) -> tuple[str, str, str]:
    """The three words of a branch in their order; raises InputError 'BAD_VALUE' when one is unknown."""
    wanted = (SHOULDERS, ELBOWS, WRISTS)
    if len(words) != 3 or any(word not in known for word, known in zip(words, wanted)):
        raise InputError(
            "BAD_VALUE",
            "cell.branch",
            "{!r} is not a branch; use [front|back, up|down, flip|noflip] or auto",
            list(words),
        )
    return (words[0], words[1], words[2])
