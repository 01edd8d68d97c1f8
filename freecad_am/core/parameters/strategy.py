# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the section `strategy` of a job, one dataclass per family."""

from __future__ import annotations

from dataclasses import dataclass

from . import field as f


@dataclass(frozen=True)
class RevolutionParameters:
    """How a part of revolution is cut into layers (Chalvin 2020, section 2.1). mm and rad."""

    layer_height: float = f.parameter(
        1.0, f.LENGTH, "Distance between neighbouring layers.", low=0.0, open_low=True
    )
    chord_error: float = f.parameter(
        0.01, f.LENGTH, "Largest distance between a bead and the straight segments that stand for it.",
        low=1e-5, high=10.0,
    )
    spacing: str = f.parameter(
        "arc-length", f.CHOICE,
        "Layers equally spaced along the wall (arc-length) or along the axis (iso-height).",
        choices=("arc-length", "iso-height"),
    )
    wall: str = f.parameter(
        "outer", f.CHOICE, "Which wall of a solid is deposited; middle runs halfway between outer and inner.",
        choices=("outer", "inner", "middle"),
    )
    path: str = f.parameter(
        "layers", f.CHOICE, "Closed beads layer by layer, or one continuous spiral.", choices=("layers", "spiral")
    )
    min_points: int = f.parameter(
        24, f.COUNT, "Fewest points of a full turn, however small its radius.", low=6, high=10000, advanced=True
    )

    def __post_init__(self) -> None:
        f.check(self, "strategy")
