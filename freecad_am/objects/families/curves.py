# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan beads along edges and along the curves of point tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...brep.shapes.off_part import off_edges
from ...core.families.curves import Curves
from ...core.issues import Text, Word
from ...core.process.deposit import on_part
from ...core.toolpath import Toolpath
from ..shapes.bodies import Taken
from .given import Given
from .planner import FeaturePlanner, PartDistances, refuse_below, share_strategy
from .recognition import Proposal, Refusal, SelectedPart


class CurvesPlanner(FeaturePlanner):
    """Planner of beads along curves."""

    proxy = ("curves_feature", "CurvesFeature")
    has_faces = False
    recognition_rank = 10

    def recognise(self, part: SelectedPart, remark: str) -> Proposal | Refusal:
        """Propose selected edges, and shapes without faces."""
        selects_edges = any(name.startswith("Edge") for name in part.names)
        if part.shape is None or (part.shape.Faces and not selects_edges):
            return Refusal()
        what = (
            Text("edges of {} are selected", part.label)
            if part.names
            else Text("{} has edges but no faces", part.label)
        )
        return Proposal(Curves.kind, Text("{}, to be deposited as beads", Word(what)))

    def plan_layers(self, inputs: Given) -> Toolpath:
        from ...core.strategies import curves

        toolpath = curves.plan(
            inputs.wall, inputs.strategy, inputs.build, inputs.process, share_strategy
        )
        refuse_below(toolpath, inputs)
        return toolpath

    def is_on_part(self, wall: Any) -> bool:
        """Whether the curves come from edges; a point table has no part to compare with."""
        return wall.edges is not None

    def part_distances(
        self, toolpath: Toolpath, inputs: Given, sources: Sequence[Taken], places: on_part.Places
    ) -> PartDistances | None:
        """Return the deviation of layers from their heights above the edges."""
        up = (
            places.layer
            // (len(toolpath.layers) // inputs.strategy.repeat)
            * inputs.strategy.layer_height
        )
        feet = places.points - up[:, None] * places.build
        off = off_edges(sources[0].shape, inputs.wall.edges, feet)
        return PartDistances(places, off, toolpath.chord_error + on_part.ROUNDED)
