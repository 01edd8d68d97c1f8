# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell in which the job of a toolpath in a document can be done."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Collection
from typing import Any

import numpy as np

from ...core.kinematics.arrangement import arrangement_of
from ...core.kinematics.cell import mounted
from ...core.parameters import field as f
from ...core.parameters.cell import CellParameters
from ...core.parameters.joints import JointParameters
from ...core.parameters.process import ProcessParameters
from ...core.planning.other_cells import Tried
from ...core.planning.remedies import suited
from ...core.strategies.support import stands_on
from ...core.toolpath import Toolpath
from ...core.types import Array
from .. import user_machines
from ..checks.collisions import look
from ..checks.placed import cylinders_of
from ..shapes import cell_obstacles
from ..work import progress

STEP = 5.0  # mm; diameters are rounded up to multiples
MAX_DIAMETER_MM = next(
    f.spec_of(field).high or math.inf
    for field in dataclasses.fields(CellParameters)
    if field.name == "platform_diameter"
)  # mm; beads outside get a warning
MIDDLE = 0.9  # of a diameter; a smaller diameter justifies another frame


def fitted(toolpath: Toolpath, settings: CellParameters) -> CellParameters:
    """The cell with a platform below all beads of the first layer, or the largest allowed one. The
    feature's own frame sits on it if the layer then needs a smaller platform.
    """
    frame = mounted(settings, toolpath.frame, toolpath.family)
    diameter, mount = needed(toolpath, frame), settings.mount
    feature_diameter = needed(toolpath, toolpath.frame)
    if (
        mount == "auto"
        and feature_diameter < MIDDLE * diameter
        and stands_on(toolpath, toolpath.frame, toolpath.surroundings)
    ):
        diameter, mount = feature_diameter, "feature"
    diameter = min(max(diameter, settings.platform_diameter), MAX_DIAMETER_MM)
    return dataclasses.replace(settings, platform_diameter=diameter, mount=mount)


def needed(toolpath: Toolpath, frame: Array) -> float:
    """The diameter, mm, of a disc about the origin of a frame (4, 4) in part coordinates under all of the first layer."""
    radius = 0.0
    for bead in toolpath.layers[0].beads:
        local = (bead.points - frame[:3, 3]) @ frame[:3, :2]
        wide = toolpath.bead_width if bead.width is None else float(np.max(bead.width))
        radius = max(radius, float(np.hypot(local[:, 0], local[:, 1]).max()) + 0.5 * (wide or 0.0))
    return STEP * math.ceil(2.0 * radius / STEP)


def suit_to_toolpath(
    toolpath: Any, failed_layers: Collection[int] = ()
) -> Callable[[CellParameters], CellParameters]:
    """A function that finds, without the document, the parameters of a cell that suits the job of a
    toolpath object: the given ones, or ones with another branch, position, or a positioner.
    failed_layers: indices of layers that could not be planned in the cell found before. It raises
    what resolving a cell raises.
    """
    read_toolpath, folders = toolpath.Proxy.reader(toolpath), tuple(user_machines.folders())
    process = toolpath.Proxy.parameters(toolpath, ProcessParameters)

    def of(settings: CellParameters) -> CellParameters:
        planned = read_toolpath()
        if not arrangement_of(settings.setup).planned:
            return settings
        cell = cell_obstacles.resolved(settings, planned, folders)
        job = Tried(
            lambda: planned,
            settings,
            folders,
            process,
            JointParameters(),
            shapes=cell.shapes,
            cylinders=cylinders_of(cell),
            look=look,
        )
        return suited(job, progress.report, failed_layers)

    return of
