# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell in a document: machine, set-up, platform and nozzle."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np

from ..core.kinematics import cell as cells
from ..core.parameters.cell import CellParameters
from . import user_machines
from .stage import Outcome, Section, Stage


class Cell(Stage):
    """Checks that machine, limits and set-up are known; its result is the CellParameters."""

    kind = "cell"
    sections = (Section(CellParameters, "cell", "Cell"),)
    figures = (("MachineTitle", "App::PropertyString", "Maker and model of the machine."),)

    def compute(self, obj: Any) -> Outcome:
        parameters = self.parameters(obj, CellParameters)
        resolved = cells.resolve(parameters, np.eye(4), folders=user_machines.folders())
        return Outcome(parameters, figures=(("MachineTitle", resolved.machine.title),))

    def further_inputs(self, obj: Any) -> list[str]:
        path = user_machines.file_of(obj.Machine)
        if path is None:
            return []
        with open(path, "rb") as file:
            return [hashlib.sha256(file.read()).hexdigest()]
