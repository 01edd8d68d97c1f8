# SPDX-License-Identifier: LGPL-2.1-or-later
"""The toolpath in a document: layers and beads with build directions, made from a feature."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.cell import CellParameters, NozzleParameters
from ..core.parameters.process import ProcessParameters
from ..core.parameters.strategy import RevolutionParameters, SurfaceParameters
from ..core.strategies import revolution, surface
from ..core.toolpath import Toolpath as CoreToolpath
from .stage import Link, Outcome, Section, Stage, stage_of
from .surface_feature import SurfaceFeature


class Toolpath(Stage):
    """Result: core.toolpath.Toolpath. Without a cell the nozzle has its default shape and there is no platform."""

    kind = "toolpath"
    sections = (Section(ProcessParameters, "process", "Process"),)
    links = (
        Link("Feature", "feature", "The feature to deposit."),
        Link("Cell", "cell", "The cell, for the clearance of nozzle and platform.", required=False),
    )
    figures = (
        ("Layers", "App::PropertyInteger", "Number of layers."),
        ("Beads", "App::PropertyInteger", "Number of beads."),
        ("Points", "App::PropertyInteger", "Number of points of all beads."),
        ("Length", "App::PropertyLength", "Length of all beads."),
    )

    def compute(self, obj: Any) -> Outcome:
        linked = self.linked(obj)
        feature, cell = linked["Feature"], linked["Cell"]
        shape = stage_of(feature)
        assert shape is not None
        carried = None if cell is None else cell.Proxy.value(cell)
        family = SurfaceParameters if isinstance(shape, SurfaceFeature) else RevolutionParameters
        toolpath = planned(
            shape.value(feature), shape.parameters(feature, family), shape.parameters(feature, BuildDirectionParameters),
            self.parameters(obj, ProcessParameters), carried,
        )
        figures = (
            ("Layers", len(toolpath.layers)), ("Beads", toolpath.bead_count), ("Points", toolpath.point_count),
            ("Length", toolpath.length),
        )
        return Outcome(toolpath, toolpath.issues, figures)


def planned(
    wall: Any, strategy: RevolutionParameters | SurfaceParameters, build: BuildDirectionParameters,
    process: ProcessParameters, cell: CellParameters | None,
) -> CoreToolpath:
    """The toolpath of a wall, the result of a feature, cut by the strategy of its family."""
    if isinstance(strategy, SurfaceParameters):
        return surface.plan(wall, strategy, build, process)
    return revolution.plan(
        wall, strategy, build, process, NozzleParameters() if cell is None else cell.nozzle,
        0.0 if cell is None else cell.platform_diameter,
        np.eye(4) if cell is not None and cell.mount == "part" else None,
    )
