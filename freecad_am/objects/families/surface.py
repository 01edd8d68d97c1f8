# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls on a part, on edges or on the platform."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from ...core.geometry.obstacles import Body
from ...core.strategies.revolution import clearance
from ...core.toolpath import Toolpath
from .given import Given
from .planner import FeaturePlanner, refuse_below, share_strategy, tilt_clear


class SurfacePlanner(FeaturePlanner):
    """Plans walls, layer by layer along the surface or as fronts."""

    proxy = ("surface_feature", "SurfaceFeature")

    def plan_layers(self, inputs: Given) -> Toolpath:
        from ...core.geometry.walls.patch_wall import PatchWall

        on_another = getattr(inputs.wall, "ground", None) is None or inputs.stands is not None
        remedy = clearance.MOVE if on_another else clearance.MOUNT
        if isinstance(inputs.wall, PatchWall):
            from ...core.strategies.walls import fronts as layers

            _refuse_start_below(inputs, remedy)
        else:
            from ...core.strategies.walls import plan as layers
        toolpath = layers.plan(
            inputs.wall, inputs.strategy, inputs.build, inputs.process, share_strategy
        )
        refuse_below(toolpath, inputs, remedy)
        return dataclasses.replace(toolpath, surroundings=inputs.wall.surroundings)

    def keep_clear(
        self, toolpath: Toolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
    ) -> Toolpath:
        from ...core.strategies.walls.beads import symmetry_plane

        plane = symmetry_plane(inputs.wall, inputs.build)
        return tilt_clear(toolpath, inputs, bodies, feature, plane=plane)


def _refuse_start_below(inputs: Given, remedy: str) -> None:
    """Raise InputError OFF_PLATFORM for a wall that begins below the platform: its other layers may
    take minutes.
    """
    if inputs.cell is None or (inputs.stands is None and inputs.cell.mount == "feature"):
        return
    begins = np.vstack([start_curve.curve().points for start_curve in inputs.wall.first])
    stands = np.eye(4) if inputs.stands is None else inputs.stands
    clearance.refuse_below(inputs.wall.label, begins, stands, inputs.cell.platform_diameter, remedy)
