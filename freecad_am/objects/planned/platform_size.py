# SPDX-License-Identifier: LGPL-2.1-or-later
"""The platform that a new job is given: as large as its first layer needs it."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from ...core.kinematics.cell import mounted
from ...core.parameters import field as f
from ...core.parameters.cell import CellParameters
from ...core.strategies.support import stands_on
from ...core.toolpath import Toolpath
from ...core.types import Array

STEP = 5.0  # mm; diameters are rounded up to multiples
MAX_DIAMETER_MM = next(
    f.spec_of(field).high or math.inf
    for field in dataclasses.fields(CellParameters)
    if field.name == "platform_diameter"
)  # mm; beads outside get a warning
MIDDLE = 0.9  # of a diameter; a smaller one is worth another frame


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
