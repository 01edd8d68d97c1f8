# SPDX-License-Identifier: LGPL-2.1-or-later
"""Optimisation of the paper's sphere with 5 mm layers, the paper's limits and an inverse condition
number of at least 0.15 (1,000 mm). Peers: the same search pose by pose with PyKDL's fastest seeded
solver, seeded within 2 deg of the solution; and scipy's SLSQP per layer from one start, with finite
differences, on our own kinematics."""

from __future__ import annotations

from statistics import median

import numpy as np
from pose_by_pose import pose_by_pose, time_call
from scipy.optimize import minimize

from freecad_am import kdl
from freecad_am.brep.files import read
from freecad_am.brep.revolution import wall as revolution
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.inverse import spherical_wrist
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.planning import criteria
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.points import gather
from freecad_am.core.planning.task import Task
from freecad_am.core.strategies.revolution import plan as strategy

from rows import Row
from sizes import choose
from whole import EXAMPLE

ROUNDS, LAYER_HEIGHT = choose((5, 5.0), (1, 15.0))
PARAMETERS = JointParameters(min_condition=0.15, characteristic_length=1000.0)
# the peer evaluates every n-th candidate, and its time is multiplied by n
SAMPLE_STEP = choose(8, 640)


def run() -> list[Row]:
    """Return both comparisons; an infeasible layer is an error."""
    wall = revolution.find_wall(read.read_shape(str(EXAMPLE)))
    cell_parameters = CellParameters(limits="paper")
    toolpath = strategy.plan(
        wall,
        RevolutionParameters(layer_height=LAYER_HEIGHT),
        BuildDirectionParameters(),
        ProcessParameters(),
        cell_parameters.nozzle,
        cell_parameters.platform_diameter,
    )
    cell = cells.resolve(cell_parameters, toolpath.frame)
    task = Task(cell, spherical_wrist.branch_index(("front", "up", "flip")), PARAMETERS)
    beads = [bead for _, _, bead in toolpath]

    def ours() -> None:
        if not plan_joints(toolpath, cell, PARAMETERS).feasible:
            raise AssertionError("a layer of the sphere is not feasible")

    single = _single_start(task, beads)
    peers = {
        "SLSQP": single,
        **({"PyKDL": pose_by_pose(task, beads, SAMPLE_STEP)} if kdl.available() else {}),
    }
    ours()
    times: dict[str, list[float]] = {"ours": [], **{name: [] for name in peers}}
    for number in range(ROUNDS):
        times["ours"].append(time_call(ours))
        for name, peer in peers.items():
            if number < 2 or name != "PyKDL":
                times[name].append(time_call(peer) * (SAMPLE_STEP if name == "PyKDL" else 1))
    middle = {name: median(values) for name, values in times.items()}
    infeasible = single()
    return [
        Row(
            f"optimised sphere, {len(beads)} layers, all feasible; the same search pose by pose with PyKDL's NR",
            middle["ours"],
            middle.get("PyKDL"),
            "s",
            20.0,
        ),
        Row(
            f"the same; SLSQP from one start per layer, finite differences ({infeasible} of {len(beads)} layers lost)",
            middle["ours"],
            middle["SLSQP"],
            "s",
            0.5,
        ),
    ]


def _single_start(task: Task, beads: list):
    """SLSQP per layer from offset and slope 0; the returned call counts infeasible layers."""
    layers = [gather([bead], task.cell) for bead in beads]

    def constraints(points, x):
        phi = points.polynomial(x[None])
        joints = task.joints(points, phi)
        if np.isnan(joints).any():
            return np.full(len(task.rows.labels) + 1, -1.0)
        offset = task.rows.offset(joints)
        return np.append(
            1.0 - np.abs(offset).max(axis=0), (task.condition(points, phi, joints) - 0.15).min()
        )

    def objective(points, x):
        joints = task.joints(points, points.polynomial(x[None]))
        return (
            1e6 if np.isnan(joints).any() else float(criteria.displacement(task, points, joints)[0])
        )

    def call() -> int:
        infeasible = 0
        for points in layers:
            optimum = minimize(
                lambda x, p=points: objective(p, x),
                np.zeros(2),
                method="SLSQP",
                constraints=[{"type": "ineq", "fun": lambda x, p=points: constraints(p, x)}],
                options={"ftol": PARAMETERS.tolerance, "maxiter": PARAMETERS.max_iterations},
            )
            infeasible += int(constraints(points, optimum.x).min() < -1e-6)
        return infeasible

    return call
