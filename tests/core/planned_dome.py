# SPDX-License-Identifier: LGPL-2.1-or-later
"""A dome of few layers, planned up to its motion, for tests of motions."""

from typing import NamedTuple

import numpy as np

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, arc
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.cell import Cell
from freecad_am.core.motion import Motion
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.planning.joint_path import JointPath
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.strategies.revolution import plan as revolution
from freecad_am.core.toolpath import Toolpath


class Dome(NamedTuple):
    """The stages of planning."""

    toolpath: Toolpath
    cell: Cell
    path: JointPath
    motion: Motion


def planned_dome(layer_height, process):
    """A hemisphere of R 45 mm on the robot of the papers, with its limits."""
    wall = RevolvedWall(Meridian.chained([arc((0.0, 0.0), 45.0, 0.0, np.pi / 2)]), np.eye(4))
    strategy = RevolutionParameters(layer_height=layer_height)
    toolpath = revolution.plan(
        wall, strategy, BuildDirectionParameters(), process, NozzleParameters(), 113.0, None
    )
    cell = cells.resolve(CellParameters(limits="paper"), toolpath.frame)
    path = plan_joints(toolpath, cell, JointParameters())
    motion, _ = assemble(path, cell, process)
    return Dome(toolpath, cell, path, motion)
