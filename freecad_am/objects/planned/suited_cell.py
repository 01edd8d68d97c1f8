# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adapt a cell so that the job of a toolpath is feasible."""

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

STEP = 5.0  # mm; diameters are rounded up to multiples of this step
MAX_DIAMETER_MM = next(
    f.spec_of(field).high or math.inf
    for field in dataclasses.fields(CellParameters)
    if field.name == "platform_diameter"
)  # mm; beads outside this diameter cause a warning
MIDDLE = 0.9  # maximum ratio of diameters for which the feature frame replaces the part frame


def fitted(toolpath: Toolpath, settings: CellParameters) -> CellParameters:
    """Return the cell with a platform below all beads of the first layer, up to MAX_DIAMETER_MM.

    Mount the feature frame on the platform if the layer then needs a clearly smaller platform.
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
    """Return the diameter, mm, of a disc below the whole first layer.

    frame: (4, 4) frame in part coordinates, whose origin is the disc centre.
    """
    radius = 0.0
    for bead in toolpath.layers[0].beads:
        local = (bead.points - frame[:3, 3]) @ frame[:3, :2]
        wide = toolpath.bead_width if bead.width is None else float(np.max(bead.width))
        radius = max(radius, float(np.hypot(local[:, 0], local[:, 1]).max()) + 0.5 * (wide or 0.0))
    return STEP * math.ceil(2.0 * radius / STEP)


def suit_to_toolpath(
    toolpath: Any, failed_layers: Collection[int] = ()
) -> Callable[[CellParameters], CellParameters]:
    """Return a function that adapts cell parameters to the job of a toolpath object.

    The function does not use the document. It returns the given parameters, or parameters with
    another branch or pose, or with a positioner. failed_layers: indices of layers that failed in
    the previous cell. The function raises the errors of resolving a cell.
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
