# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell in a document: machine, set-up, platform and nozzle."""

from __future__ import annotations

import hashlib
import os
from typing import Any

import numpy as np

from ..core.kinematics import cell as cells
from ..core.parameters.cell import CellParameters
from .stage import Outcome, Section, Stage


class Cell(Stage):
    """Checks that machine, limits and set-up are known; its result is the CellParameters."""

    kind = "cell"
    sections = (Section(CellParameters, "cell", "Cell"),)
    figures = (("MachineTitle", "App::PropertyString", "Maker and model of the machine."),)

    def compute(self, obj: Any) -> Outcome:
        parameters = self.parameters(obj, CellParameters)
        resolved = cells.resolve(parameters, np.eye(4))
        return Outcome(parameters, figures=(("MachineTitle", resolved.machine.title),))

    def further_inputs(self, obj: Any) -> list[str]:
        if not os.path.isfile(obj.Machine):
            return []
        with open(obj.Machine, "rb") as file:
            return [hashlib.sha256(file.read()).hexdigest()]
