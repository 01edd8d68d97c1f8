# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan parts of revolution, with layers and build directions determined together."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...brep.shapes import part_depths
from ...core.families.revolution import Revolution
from ...core.geometry.obstacles import Body
from ...core.issues import Text
from ...core.process.deposit import on_part
from ...core.process.deposit.balance import MM3, NEGLIGIBLE, wall_balance
from ...core.strategies.clearance import nozzle_check
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
from .recognition import Proposal, Refusal, SelectedPart

if TYPE_CHECKING:
    from ...core.inspection.planned import Planned


class RevolutionPlanner(FeaturePlanner):
    """Planner of walls of parts of revolution."""

    proxy = ("feature", "RevolutionFeature")
    recognition_rank = 30

    def recognise(self, part: SelectedPart, remark: str) -> Proposal | Refusal:
        """Propose parts of revolution without a substrate, with solids no thicker than a bead."""
        if part.shape is None or part.substrate is not None or part.edges:
            return Refusal()
        if part.is_several_solids or part.revolved_wall is None:
            return Refusal()
        if part.names:
            return Proposal(
                Revolution.kind,
                Text("the selected faces of {} share one axis of revolution", part.label),
            )
        if part.is_skin:
            return Proposal(Revolution.kind, Text("{} is a surface of revolution", part.label))
        depths = part_depths.revolved_depths(part.shape, part.revolved_wall, part.label)
        balance = None if depths is None else wall_balance(depths, part.width)
        omitted = 0.0 if balance is None else balance.left_out or 0.0
        if balance is None or omitted <= NEGLIGIBLE * (balance.part_volume or 0.0):
            why = Text(
                "{} is a solid of revolution, and its wall is one bead of {:.4g} mm",
                part.label,
                part.width,
            )
            return Proposal(Revolution.kind, why)
        return Refusal(
            Text(
                "the part is a solid of revolution, but a wall of one bead would leave out "
                "{:.3g} of its {:.3g} cm3",
                omitted / MM3,
                (balance.part_volume or 0.0) / MM3,
            )
        )

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

    def planned_surface(self, value: Any, name: str) -> Planned:
        from ...core.inspection.planned import revolution_surface

        return revolution_surface(value)

    def keep_clear(
        self, toolpath: Toolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
    ) -> Toolpath:
        """Check clearance to surroundings and other features.

        The strategy has already kept the nozzle clear of the feature itself.
        """
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
        """Return distances from the faces, or from the solid for a middle wall."""
        if inputs.strategy.wall != "middle":
            return super().part_distances(toolpath, inputs, sources, places)
        if not sources[0].shape.Solids:
            return None
        limit = on_part.allowed_distance(toolpath)
        return PartDistances(places, distances_from_solids(sources, places.points, limit), limit)
