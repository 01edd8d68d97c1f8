# SPDX-License-Identifier: LGPL-2.1-or-later
"""The joint path in a document: the joint values of a toolpath in a cell, and the motion with its rapids."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.kinematics import cell as cells
from ..core.motion import Motion
from ..core.parameters.joints import JointParameters
from ..core.parameters.process import ProcessParameters
from ..core.planning.joint_path import JointPath as JointsOfBeads
from ..core.planning.motion import assemble
from ..core.planning.plan import plan_joints
from . import progress, user_machines
from .stage import Link, Outcome, Section, Stage


@dataclass(frozen=True)
class Planned:
    """The result of a joint path: the joints of the deposit and the motion with all rapid moves."""

    joint_path: JointsOfBeads
    motion: Motion


class JointPath(Stage):
    """Result: `Planned`. An infeasible one is kept too, to be looked at."""

    kind = "joint path"
    sections = (Section(JointParameters, "joints", "Joints"),)
    links = (
        Link("Toolpath", "toolpath", "The toolpath to run."),
        Link("Cell", "cell", "The cell that runs it."),
    )
    figures = (
        ("Duration", "App::PropertyFloat", "Time of all moves (s)."),
        ("SmallestCondition", "App::PropertyFloat", "Smallest condition of the Jacobian while depositing."),
    )

    def compute(self, obj: Any) -> Outcome:
        linked = self.linked(obj)
        toolpath_object, cell_object = linked["Toolpath"], linked["Cell"]
        toolpath = toolpath_object.Proxy.value(toolpath_object)
        cell = cells.resolve(
            cell_object.Proxy.value(cell_object), toolpath.frame, toolpath.family, user_machines.folders()
        )
        process = toolpath_object.Proxy.parameters(toolpath_object, ProcessParameters)
        joint_path = plan_joints(toolpath, cell, self.parameters(obj, JointParameters), progress.report)
        motion, rapid_issues = assemble(joint_path, cell, process, toolpath.surroundings)
        condition = np.concatenate([bead.condition for bead in joint_path.beads])
        smallest = float(np.nanmin(condition)) if np.isfinite(condition).any() else 0.0
        figures = (("Duration", float(np.nansum(motion.duration))), ("SmallestCondition", smallest))
        return Outcome(Planned(joint_path, motion), (*joint_path.issues, *rapid_issues), figures)
