# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cell stage: machine, set-up, platform and nozzle."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.geometry.job_files import digest
from ..core.kinematics import cell as cells
from ..core.kinematics.urdf.elements import MAX_FILE_MB
from ..core.parameters.cell import CellParameters
from . import user_machines
from .shapes import cell_obstacles
from .stage import Stage
from .stage_parts import Outcome, Section, Work


class Cell(Stage):
    """Result: CellParameters, with machine, limits and set-up checked."""

    kind = "cell"
    sections = (Section(CellParameters, "cell", "Cell"),)
    figures = (("MachineTitle", "App::PropertyString", "Manufacturer and model of the machine."),)

    def prepare(self, obj: Any) -> Work:
        parameters, folders = self.parameters(obj, CellParameters), user_machines.folders()

        def work() -> Outcome:
            resolved = cells.resolve(parameters, np.eye(4), folders=folders)
            cell_obstacles.bodies_of(parameters)  # check that obstacle files can be read
            cell_obstacles.torch_of(parameters)
            return Outcome(parameters, figures=(("MachineTitle", resolved.machine.title),))

        return work

    def further_inputs(self, obj: Any) -> list[str]:
        parameters = self.parameters(obj, CellParameters)
        named = [obj.Machine, *(mechanism.machine for mechanism in parameters.external)]
        files = [
            digest(path, MAX_FILE_MB, "BAD_MACHINE", f"{obj.Label}.Machine")
            for name in named
            for path in user_machines.files_of(name)
        ]
        return [*files, *cell_obstacles.hashes_of(parameters)]
