# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the section `build_direction` of a job."""

from __future__ import annotations

import math
from dataclasses import dataclass

from . import field as f


@dataclass(frozen=True)
class BuildDirectionParameters:
    """Which way the deposit grows and how the tool is held against it. rad."""

    mode: str = f.parameter(
        "local", f.CHOICE,
        "local: tangent to the wall at each point; layer: one direction per layer; fixed: the axis of the part.",
        choices=("local", "layer", "symmetry-plane", "fixed"),
    )
    lead: float = f.parameter(
        0.0, f.ANGLE, "Tool axis turned forward along the bead, from the build direction.",
        low=-math.pi / 2, high=math.pi / 2,
    )
    tilt: float = f.parameter(
        0.0, f.ANGLE, "Tool axis turned sideways, towards the outside of the wall, from the build direction.",
        low=-math.pi / 2, high=math.pi / 2,
    )
    max_tilt: float = f.parameter(
        math.pi / 2, f.ANGLE, "Largest angle between the tool axis and the vertical of the part.", low=0.0, high=math.pi
    )
    clearance: str = f.parameter(
        "nozzle", f.CHOICE, "nozzle: tilt no more than needed to keep the nozzle clear of deposit and platform.",
        choices=("none", "nozzle"),
    )

    def __post_init__(self) -> None:
        f.check(self, "build_direction")
