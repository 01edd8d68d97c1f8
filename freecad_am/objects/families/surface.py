# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan walls on a part, on edges or on the platform."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...brep.walls.patch_wall import stand
from ...core.families.surface import Surface
from ...core.geometry.obstacles import Body
from ...core.issues import Text, Word
from ...core.strategies.revolution import clearance
from ...core.toolpath import Toolpath
from ..shapes.bodies import Taken
from .given import Given
from .planner import FeaturePlanner, refuse_below, share_strategy, tilt_clear
from .recognition import Proposal, Refusal, SelectedPart

if TYPE_CHECKING:
    from ...core.inspection.planned import Planned


class SurfacePlanner(FeaturePlanner):
    """Planner of walls, in layers along the surface or as offset fronts."""

    proxy = ("surface_feature", "SurfaceFeature")
    recognition_rank = 50

    def recognise(self, part: SelectedPart, remark: str) -> Proposal | Refusal:
        """Propose open meshes, skins, selected faces, parts with start edges, and thin shells.

        Thin shells must be on a substrate.
        """
        if part.shape is None:
            return _recognise_mesh(part)
        if part.edges:
            return Proposal(Surface.kind, Text("{} names its start edges", part.label))
        if part.substrate is not None:
            return _recognise_on_substrate(part, part.substrate)
        if part.names:
            return _propose_for_faces(part)
        return _propose_for_skin(part) if part.is_skin else Refusal()

    def plan_layers(self, inputs: Given) -> Toolpath:
        on_another = getattr(inputs.wall, "ground", None) is None or inputs.stands is not None
        remedy = clearance.MOVE if on_another else clearance.MOUNT
        if inputs.wall.closes_around:
            from ...core.strategies.walls import plan as layers
        else:
            from ...core.strategies.walls import fronts as layers

            _refuse_start_below(inputs, remedy)
        toolpath = layers.plan(
            inputs.wall, inputs.strategy, inputs.build, inputs.process, share_strategy
        )
        refuse_below(toolpath, inputs, remedy)
        return dataclasses.replace(toolpath, surroundings=inputs.wall.surroundings)

    def planned_surface(self, value: Any, name: str) -> Planned:
        from ...core.inspection.planned import wall_surface

        return wall_surface(value)

    def keep_clear(
        self, toolpath: Toolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
    ) -> Toolpath:
        from ...core.strategies.walls.beads import symmetry_plane

        plane = symmetry_plane(inputs.wall, inputs.build)
        return tilt_clear(toolpath, inputs, bodies, feature, plane=plane)


def _refuse_start_below(inputs: Given, remedy: str) -> None:
    """Raise InputError OFF_PLATFORM for a wall that starts below the platform.

    Checking the start first avoids planning all layers, which may take minutes.
    """
    if inputs.cell is None or (inputs.stands is None and inputs.cell.mount == "feature"):
        return
    begins = np.vstack([start_curve.curve().points for start_curve in inputs.wall.first])
    stands = np.eye(4) if inputs.stands is None else inputs.stands
    clearance.refuse_below(inputs.wall.label, begins, stands, inputs.cell.platform_diameter, remedy)


def _recognise_mesh(part: SelectedPart) -> Proposal | Refusal:
    if not part.mesh.is_sheet:
        return Refusal()
    where = (
        "starts on the platform"
        if part.substrate is None
        else Text("grows on {}", part.substrate.label)
    )
    return Proposal(
        Surface.kind,
        Text("{} is an open mesh, and becomes a thin wall that {}", part.label, Word(where)),
    )


def _recognise_on_substrate(part: SelectedPart, substrate: Taken) -> Proposal | Refusal:
    if part.names or part.is_skin:
        return Proposal(
            Surface.kind,
            Text("{} is a thin wall that grows on {}", part.label, substrate.label),
        )
    if part.is_several_solids or not part.is_one_bead_thick:
        return Refusal()
    return Proposal(
        Surface.kind,
        Text(
            "{} is a thin shell, one bead of {:.4g} mm, on {}",
            part.label,
            part.width,
            substrate.label,
        ),
    )


def _propose_for_faces(part: SelectedPart) -> Proposal:
    if stand([part.shape.getElement(name) for name in part.names]):
        return Proposal(
            Surface.kind,
            Text(
                "the selected faces of {} share no axis of revolution, so these faces are a "
                "wall, which starts on the platform without another support",
                part.label,
            ),
            stands=True,
        )
    return Proposal(
        Surface.kind,
        Text(
            "the selected faces of {} share no axis of revolution, so these faces are a wall; "
            "choose a substrate, or start edges",
            part.label,
        ),
    )


def _propose_for_skin(part: SelectedPart) -> Proposal:
    if stand(part.shape.Faces):
        return Proposal(
            Surface.kind,
            Text(
                "{} is an open surface without an axis of revolution, and becomes a thin wall, "
                "which starts on the platform without another support",
                part.label,
            ),
            stands=True,
        )
    return Proposal(
        Surface.kind,
        Text(
            "{} is an open surface without an axis of revolution, and no other strategy applies; "
            "choose a substrate or start edges: regions that do not grow from there are omitted",
            part.label,
        ),
    )
