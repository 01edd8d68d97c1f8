# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planning inputs of a feature, read from the document."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...core.kinematics.cell import mounted
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.cell import CellParameters, NozzleParameters
from ...core.parameters.process import ProcessParameters
from ...core.process import wire
from ...core.process.bead_model import BeadModel
from ...core.strategies.by_place import Zone
from ...core.toolpath import Toolpath
from ...core.types import Array


@dataclass(frozen=True, eq=False)
class Given:
    """Planning inputs of a feature.

    wall: result of the feature object, a wall or solids. cell: cell reduced by `seen_of`. stands:
    frame (4, 4) on the platform in part coordinates if an earlier feature sets it, else None.
    zones: geometry of each of the process's settings by place; empty if none has any.
    """

    wall: Any
    strategy: Any
    build: BuildDirectionParameters
    process: ProcessParameters
    cell: CellParameters | None
    stands: Array | None = None
    zones: tuple[Zone, ...] = ()

    @property
    def nozzle(self) -> NozzleParameters:
        """Return the nozzle of the cell, or the default nozzle."""
        return NozzleParameters() if self.cell is None else self.cell.nozzle

    @property
    def model(self) -> BeadModel | None:
        """Return the bead model of the process, None without a model."""
        return wire.process_model(self.process)


def platform_frame(toolpath: Toolpath, inputs: Given, cell: CellParameters) -> Array:
    """Return the frame (4, 4) on the platform, in part coordinates."""
    if inputs.stands is not None:
        return inputs.stands
    return mounted(cell, toolpath.frame, toolpath.family)
