# SPDX-License-Identifier: LGPL-2.1-or-later
"""The planning inputs of a feature, read from the document."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...core.kinematics.cell import mounted
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.cell import CellParameters, NozzleParameters
from ...core.parameters.process import ProcessParameters
from ...core.process import wire
from ...core.process.bead_model import BeadModel
from ...core.toolpath import Toolpath
from ...core.types import Array


@dataclass(frozen=True, eq=False)
class Given:
    """The planning inputs of a feature: its wall or solids, which the feature object has found, and
    parameters. cell: as `seen_of` leaves it. stands: (4, 4) in part coordinates, the frame on the
    platform if an earlier feature sets it; else None.
    """

    wall: Any
    strategy: Any
    build: BuildDirectionParameters
    process: ProcessParameters
    cell: CellParameters | None
    stands: Array | None = None

    @property
    def nozzle(self) -> NozzleParameters:
        """The nozzle of the cell, or the usual one."""
        return NozzleParameters() if self.cell is None else self.cell.nozzle

    @property
    def model(self) -> BeadModel | None:
        """The bead model of the process."""
        return wire.process_model(self.process)


def platform_frame(toolpath: Toolpath, inputs: Given, cell: CellParameters) -> Array:
    """Return the frame (4, 4) on the platform, in part coordinates."""
    if inputs.stands is not None:
        return inputs.stands
    return mounted(cell, toolpath.frame, toolpath.family)
