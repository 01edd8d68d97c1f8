# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the section `build_direction` of a job."""

from __future__ import annotations

import math
from dataclasses import dataclass

from . import field as f
from .records import Point, convert_texts
from .vectors import direction_text

TURN_ON_WALLS, TURN_ON_HUBS = (
    math.radians(30.0),
    math.radians(3.0),
)  # rad/mm, the value of max_turn = auto


@dataclass(frozen=True)
class BuildDirectionParameters:
    """Which way the deposit grows and how the tool is held against it. rad."""

    mode: str = f.parameter(
        "local",
        f.CHOICE,
        "local: tangent to the wall at each point; layer: one direction per layer; fixed: the "
        "axis of the part.",
        choices=("local", "layer", "symmetry-plane", "fixed"),
    )
    lead: float = f.parameter(
        0.0,
        f.ANGLE,
        "Tool axis tilted forward along the bead, from the build direction.",
        low=-math.pi / 2,
        high=math.pi / 2,
    )
    tilt: float = f.parameter(
        0.0,
        f.ANGLE,
        "Tool axis tilted sideways, towards the outside of the wall, from the build direction.",
        low=-math.pi / 2,
        high=math.pi / 2,
    )
    max_tilt: float = f.parameter(
        math.pi / 2,
        f.ANGLE,
        "Largest angle between the tool axis and the vertical of the part.",
        low=0.0,
        high=math.pi,
    )
    max_turn: float | str = f.parameter(
        "auto",
        f.TURN_RATE,
        "Largest turn of build direction and tool axis along a bead, on walls on an existing "
        "part, on hubs and in curved layers; faster turns, as at corners, are spread out, and "
        "the deviation is reported.",
        low=0.0,
        open_low=True,
        words=("auto", "inf"),
    )
    plane: Point | None = f.parameter(
        None,
        f.VECTOR,
        "Normal of the plane of symmetry-plane, as x y z in the part's coordinates; auto: the plane of a "
        "bend.",
        advanced=True,
        records=direction_text("build_direction.plane", "auto"),
    )
    clearance: str = f.parameter(
        "nozzle",
        f.CHOICE,
        "nozzle: tilt only as far as clearance to deposit and platform requires.",
        choices=("none", "nozzle"),
    )
    max_from_vertical: float = f.parameter(
        math.pi,
        f.ANGLE,
        "Robots with a positioner: largest angle between the tool axis and the vertical of the "
        "cell while depositing; the positioner turns the part to keep this limit. 180 deg: the "
        "positioner does not move.",
        low=0.0,
        high=math.pi,
        advanced=True,
    )

    def __post_init__(self) -> None:
        if self.max_turn == math.inf:
            object.__setattr__(self, "max_turn", "inf")
        convert_texts(self)
        f.check(self, "build_direction")

    def turn(self, auto: float = TURN_ON_WALLS) -> float:
        """Return `max_turn`, rad/mm, infinite for inf; for auto the value for walls, or the given
        one.
        """
        return auto if self.max_turn == "auto" else float(self.max_turn)
