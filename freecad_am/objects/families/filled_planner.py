# SPDX-License-Identifier: LGPL-2.1-or-later
"""Base planner of filled solids, for all layer kinds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.geometry.obstacles import Body
from ...core.process.deposit import on_part
from ...core.strategies.revolution import clearance
from ...core.toolpath import Toolpath
from ..shapes.bodies import Taken
from .given import Given
from .planner import (
    FeaturePlanner,
    PartDistances,
    distances_from_solids,
    share_strategy,
    tilt_clear,
)

if TYPE_CHECKING:
    from ...core.inspection.planned import Planned


class FilledPlanner(FeaturePlanner):
    """Base of planners for filled solids."""

    allowance_remedy = "Increase strategy.margin by {} mm, or use wider beads"

    def plan_layers(self, inputs: Given) -> Toolpath:
        from ...core.strategies.solids import plan

        if inputs.stands is not None and inputs.cell is not None:
            clearance.refuse_solids_below(inputs.wall, inputs.stands, inputs.cell.platform_diameter)
        elif (
            inputs.cell is not None and inputs.cell.mount != "feature"
        ):  # the feature's own frame is at its lowest end
            clearance.refuse_solids_below(inputs.wall, np.eye(4), inputs.cell.platform_diameter)
        return plan.plan(
            inputs.wall, inputs.strategy, inputs.build, inputs.process, inputs.model, share_strategy
        )

    def planned_surface(self, value: Any, name: str) -> Planned:
        from ...core.inspection.planned import solids_surface

        return solids_surface(value)

    def keep_clear(
        self, toolpath: Toolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
    ) -> Toolpath:
        """Tilt the tool axes; on a hub without a limit, because the machine rotates the part."""
        from ...core.strategies.solids import plan

        if not inputs.wall.has_plane_layers():
            return tilt_clear(
                toolpath, inputs, bodies, feature, plan.lift_axis_limits(inputs.build)
            )
        if feature is None and plan.clear_by_itself(toolpath, inputs.wall):
            return toolpath
        return tilt_clear(toolpath, inputs, bodies, feature)

    def part_distances(
        self, toolpath: Toolpath, inputs: Given, sources: Sequence[Taken], places: on_part.Places
    ) -> PartDistances | None:
        limit = on_part.allowed_distance(toolpath, inputs.strategy.margin)
        return PartDistances(places, distances_from_solids(sources, places.points, limit), limit)

    def bodies_to_cover(self, wall: Any) -> list[Body] | None:
        return [body for group in wall.groups for body in group.bodies]
