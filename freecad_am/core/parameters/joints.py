# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the section `joints` of a job."""

from __future__ import annotations

import math
from dataclasses import dataclass

from . import field as f

METHODS = ("layer-by-layer", "point-by-point", "constant")
OBJECTIVES = (
    "displacement", "limits-liegeois", "limits-fournier", "limits-klein", "manipulability", "condition",
)


@dataclass(frozen=True)
class JointParameters:
    """How the rotation about the tool axis is used (Chalvin 2020, section 4). rad, mm."""

    method: str = f.parameter(
        "layer-by-layer", f.CHOICE, "One polynomial per layer, one value per point, or one value for the whole job.",
        choices=METHODS,
    )
    rz: float | str = f.parameter("auto", f.ANGLE, "Method constant: the one RZ, or auto to search it.", words=("auto",))
    degree: int = f.parameter(1, f.COUNT, "Degree of the polynomial of a layer.", low=0, high=6)
    parameter: str = f.parameter(
        "rotation", f.CHOICE,
        "What the polynomial gives: the true rotation about the tool axis, or RZ of the paper.",
        choices=("rotation", "rz"),
    )
    rotation_range: tuple[float, float] = f.parameter(
        (-math.pi, math.pi), f.ANGLE_RANGE,
        "Allowed rotation about the tool axis; a full turn means free, narrower for a torch that is not coaxial.",
    )
    objective: str = f.parameter("displacement", f.CHOICE, "What a joint path is judged by.", choices=OBJECTIVES)
    min_condition: float | str = f.parameter(
        "auto", f.NUMBER,
        "Smallest condition allowed; auto: at each point a quarter of its value at RZ = 0, but at least 0.02.",
        low=0.0, high=1.0, words=("auto",),
    )
    characteristic_length: float = f.parameter(
        1000.0, f.LENGTH, "Divides the translation rows of the Jacobian.", low=0.0, open_low=True
    )
    tolerance: float = f.parameter(
        1e-8, f.NUMBER, "Change of the objective and of the coefficients at which the optimiser stops.",
        low=0.0, open_low=True, high=1.0, advanced=True,
    )
    max_iterations: int = f.parameter(
        1000, f.COUNT, "Iterations after which the optimiser gives up on a layer.", low=1, high=1_000_000, advanced=True
    )
    lock: str = f.parameter(
        "none", f.CHOICE,
        "Rotary table only: which of the two turning axes, counted from the torch, stands still (four axes).",
        choices=("none", "first", "second"),
    )
    lock_at: float | str = f.parameter(
        "auto", f.ANGLE, "Where the locked axis stands; auto: where the largest angle left is least.", words=("auto",)
    )
    max_residual: float = f.parameter(
        math.radians(45.0), f.ANGLE, "Four axes only: by how much the tool may miss the direction asked for.",
        low=0.0, high=math.pi,
    )
    compare: tuple[str, ...] = f.parameter((), f.TEXT, "Further methods planned for the comparison of the report.")

    def __post_init__(self) -> None:
        f.check(self, "joints", skip=frozenset({"compare"}))
        object.__setattr__(self, "compare", tuple(self.compare))
        for method in self.compare:
            if method not in METHODS:
                raise f.unknown_choice("joints.compare", method, METHODS)
