# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan cladding layers on faces."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...core.families.cladding import Cladding
from ...core.geometry.obstacles import Body
from ...core.issues import Text
from ...core.process.deposit import on_part
from ...core.toolpath import Toolpath
from ..shapes.bodies import Taken
from .given import Given
from .planner import (
    FeaturePlanner,
    PartDistances,
    distances_from_faces,
    refuse_below,
    share_strategy,
    tilt_clear,
)
from .recognition import LYING, Proposal, Refusal, SelectedPart


class CladdingPlanner(FeaturePlanner):
    """Planner of cladding layers on faces."""

    proxy = ("cladding_feature", "CladdingFeature")
    allowance_remedy = "Add one layer, or use a smaller allowance"
    recognition_rank = 40

    def recognise(self, part: SelectedPart, remark: str) -> Proposal | Refusal:
        """Propose faces of a part thicker than a bead, and mostly level open meshes and skins."""
        if part.substrate is not None or part.edges:
            return Refusal()
        if part.shape is None:
            return self._recognise_mesh(part)
        if part.is_skin and not part.names and part.lying_share >= LYING:
            return Proposal(
                Cladding.kind,
                Text(
                    "{} is an open surface, flat rather than upright ({:.0%} at less than 45 deg "
                    "to the platform), and is covered as a face",
                    part.label,
                    part.lying_share,
                ),
            )
        if part.names and part.solids and not part.is_one_bead_thick:
            return Proposal(
                Cladding.kind,
                Text(
                    "the selected faces of {} share no axis of revolution, and the part is "
                    "thicker there than a bead of {:.4g} mm, so these faces are covered",
                    part.label,
                    part.width,
                ),
            )
        return Refusal()

    def _recognise_mesh(self, part: SelectedPart) -> Proposal | Refusal:
        if not part.mesh.is_sheet or part.lying_share < LYING:
            return Refusal()
        return Proposal(
            Cladding.kind,
            Text(
                "{} is an open mesh, flat rather than upright ({:.0%} at less than 45 deg to the "
                "platform), and is covered as a face",
                part.label,
                part.lying_share,
            ),
        )

    def plan_layers(self, inputs: Given) -> Toolpath:
        from ...core.strategies import cladding

        toolpath = cladding.plan(
            inputs.wall, inputs.strategy, inputs.build, inputs.process, inputs.model, share_strategy
        )
        refuse_below(toolpath, inputs)
        return toolpath

    def keep_clear(
        self, toolpath: Toolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
    ) -> Toolpath:
        """Tilt the tool axes without a limit, because the machine rotates the part."""
        free = dataclasses.replace(inputs.build, max_tilt=np.pi)
        return tilt_clear(toolpath, inputs, bodies, feature, free)

    def part_distances(
        self, toolpath: Toolpath, inputs: Given, sources: Sequence[Taken], places: on_part.Places
    ) -> PartDistances | None:
        """Return the deviation of layers from their heights above the faces."""
        up = (places.layer % inputs.strategy.layers) * inputs.strategy.layer_height
        limit = toolpath.chord_error + on_part.ROUNDED
        feet = places.points - up[:, None] * places.build
        return PartDistances(
            places, distances_from_faces(inputs.wall, sources[0], feet, limit), limit
        )

    def faces_to_cover(self, wall: Any, selected: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(wall.faces)
