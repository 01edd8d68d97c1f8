# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's sphere in 71 layers of 1 mm under a torch on a robot with a two-axis positioner.
Peers: the paper's cell, whose six axes carry the same part; and the same search pose by pose with
PyKDL's fastest seeded solver, at the positioner's axis values from the rule, seeded within 2 deg of
the solution."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from statistics import median

from pose_by_pose import pose_by_pose, time_call

from freecad_am import kdl
from freecad_am.brep.files import read
from freecad_am.brep.revolution import wall as revolution
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.inverse import spherical_wrist
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.planning.external.level import levelled
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.task import Task
from freecad_am.core.strategies.revolution import plan as strategy
from freecad_am.core.toolpath import MotionRules, Toolpath

from rows import Row
from sizes import choose
from whole import EXAMPLE

ROUNDS, LAYER_HEIGHT = choose((3, 1.0), (1, 15.0))
MAX_TILT_DEG = 10.0  # deg from the vertical at most
SPEED = 4.0  # mm/s, limited by the turn rate of the table where the wall closes
POSITIONER = CellParameters(
    machine="kuka-kr8-r2100-2-arc-hw",
    setup="tool-on-robot",
    branch=("back", "up", "flip"),
    platform=20.0,
    nozzle=NozzleParameters(tool=(0.0, 0.0, 300.0, 0.0, 0.0, 0.0)),
    external="motoman-motopos-d500 at 1400 0 0 0 0 0 carries part",
)
SIX = CellParameters(limits="paper", branch=("front", "up", "flip"))  # the paper's cell
SAMPLE_STEP = choose(
    64, 640
)  # the peer evaluates every n-th candidate, and its time is multiplied by n


def run() -> list[Row]:
    """Return both comparisons; an infeasible layer with 6+2 axes is an error."""
    wall = revolution.find_wall(read.read_shape(str(EXAMPLE)))
    toolpath = strategy.plan(
        wall,
        RevolutionParameters(layer_height=LAYER_HEIGHT),
        BuildDirectionParameters(),
        ProcessParameters(travel_speed=SPEED),
        SIX.nozzle,
        SIX.platform_diameter,
    )
    upright = dataclasses.replace(
        toolpath, rules=MotionRules(max_from_vertical=math.radians(MAX_TILT_DEG))
    )
    six, eight = (
        cells.resolve(cell_parameters, toolpath.frame) for cell_parameters in (SIX, POSITIONER)
    )
    parameters = JointParameters()

    def ours() -> None:
        path = plan_joints(upright, eight, parameters)
        if not path.feasible:
            raise AssertionError("a layer of the sphere is not feasible with the positioner")

    def plan_six_axes() -> None:
        if not plan_joints(toolpath, six, parameters).feasible:
            raise AssertionError("a layer of the sphere is not feasible with six axes")

    peers = {
        "six": plan_six_axes,
        **({"PyKDL": _pose_by_pose(eight, upright, parameters)} if kdl.available() else {}),
    }
    ours()
    plan_six_axes()
    times: dict[str, list[float]] = {"ours": [], **{name: [] for name in peers}}
    for number in range(ROUNDS):
        times["ours"].append(time_call(ours))
        for name, peer in peers.items():
            if number == 0 or name != "PyKDL":
                times[name].append(time_call(peer) * (SAMPLE_STEP if name == "PyKDL" else 1))
    middle = {name: median(values) for name, values in times.items()}
    return [
        Row(
            f"{len(toolpath.layers)} layers with 6+2 axes, all feasible; with six, in the paper's cell",
            middle["ours"],
            middle["six"],
            "s",
            0.2,
        ),
        Row(
            "the same; the same search pose by pose with PyKDL's NR",
            middle["ours"],
            middle.get("PyKDL"),
            "s",
            20.0,
        ),
    ]


def _pose_by_pose(
    cell: cells.Cell, toolpath: Toolpath, parameters: JointParameters
) -> Callable[[], None]:
    """The search of the robot for the configuration of the plan, at the axis values from the
    rule."""
    task = Task(
        cell,
        spherical_wrist.branch_index(plan_joints(toolpath, cell, parameters).branch),
        parameters,
    )
    return pose_by_pose(task, levelled(cell, toolpath)[0], SAMPLE_STEP)
