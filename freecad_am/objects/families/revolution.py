# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of revolution: layers and build directions are determined together."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from ...core.geometry.obstacles import Body
from ...core.process.deposit import on_part
from ...core.strategies.clearance import nozzle_check
from ...core.toolpath import Toolpath
from ..shapes.bodies import Taken
from .given import Given
from .planner import FeaturePlanner, PartDistances, share_strategy, tilt_clear
from .solid_distances import distances_from_solids


class RevolutionPlanner(FeaturePlanner):
    """Plans walls of parts of revolution."""

    proxy = ("feature", "RevolutionFeature")

    def plan_layers(self, inputs: Given) -> Toolpath:
        from ...core.strategies.revolution import plan

        stands = inputs.stands
        if stands is None and inputs.cell is not None and inputs.cell.mount == "part":
            stands = np.eye(4)
        toolpath = plan.plan(
            inputs.wall,
            inputs.strategy,
            inputs.build,
            inputs.process,
            inputs.nozzle,
            0.0 if inputs.cell is None else inputs.cell.platform_diameter,
            stands,
            share_strategy,
        )
        return dataclasses.replace(toolpath, surroundings=inputs.wall.surroundings)

    def keep_clear(
        self, toolpath: Toolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
    ) -> Toolpath:
        """Check clearance to the surroundings and to other features; the strategy has kept clear of
        the rest."""
        if feature is None:
            touch_issues = nozzle_check.nozzle_issues(
                toolpath, inputs.wall.surroundings, inputs.nozzle
            )
            return dataclasses.replace(toolpath, issues=(*toolpath.issues, *touch_issues))
        feature_part = toolpath.parts[feature][0]
        count = feature_part.point_count
        alone = nozzle_check.check_nozzle(feature_part, bodies, inputs.nozzle, count)
        among = nozzle_check.check_nozzle(toolpath, bodies, inputs.nozzle, count, feature)
        if among.touched <= alone.touched:
            return toolpath
        return tilt_clear(toolpath, inputs, bodies, feature)

    def part_distances(
        self, toolpath: Toolpath, inputs: Given, sources: Sequence[Taken], places: on_part.Places
    ) -> PartDistances | None:
        """Return distances from the faces; a middle wall lies between two faces."""
        if inputs.strategy.wall != "middle":
            return super().part_distances(toolpath, inputs, sources, places)
        if not sources[0].shape.Solids:
            return None
        limit = on_part.allowed_distance(toolpath)
        return PartDistances(places, distances_from_solids(sources, places.points, limit), limit)
