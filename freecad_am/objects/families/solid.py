# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids in planes, curved layers, or layers along a guide."""

from __future__ import annotations

from collections.abc import Sequence

from ...core.process.deposit import on_part
from ...core.toolpath import Toolpath
from ..shapes.bodies import Taken
from .filled_planner import FilledPlanner
from .given import Given
from .planner import PartDistances


class SolidPlanner(FilledPlanner):
    """Plans solids in layers of any kind."""

    proxy = ("solid_feature", "SolidFeature")

    def part_distances(
        self, toolpath: Toolpath, inputs: Given, sources: Sequence[Taken], places: on_part.Places
    ) -> PartDistances | None:
        """Return distances where the part was cut, above the surface below the beads of a layer."""
        up = inputs.strategy.share_of_cut * inputs.strategy.layer_height * places.build
        cut_places = places._replace(points=places.points + up)
        return super().part_distances(toolpath, inputs, sources, cut_places)
