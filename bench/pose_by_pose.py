# SPDX-License-Identifier: LGPL-2.1-or-later
"""A peer of planning: the search over rotations, one pose after the other through PyKDL."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np

from freecad_am import kdl
from freecad_am.core.planning.points import gather
from freecad_am.core.planning.rotation import global_search
from freecad_am.core.planning.task import Task
from freecad_am.core.toolpath import Bead


def time_call(function: Callable[[], object]) -> float:
    """Return the elapsed seconds of a call."""
    start = time.perf_counter()
    function()
    return time.perf_counter() - start


def pose_by_pose(task: Task, beads: Sequence[Bead], sampled: int) -> Callable[[], None]:
    """Inverse kinematics by the fastest seeded solver, limits, Jacobian and singular values of the
    robot for every `sampled`-th candidate, seeded within 2 deg of the solution."""
    points = gather(beads, task.cell, global_search.POINTS_PER_BEAD)
    grid = [
        (offset, slope)
        for offset in np.arange(global_search.OFFSETS) * (2 * np.pi / global_search.OFFSETS) - np.pi
        for slope in global_search.SLOPES
    ][::sampled]
    phi = np.array([offset + slope * points.parameter for offset, slope in grid])
    flange = points.frames.flange_poses(phi).reshape(-1, 4, 4)
    joints = task.inverse(flange)
    reached = np.isfinite(joints).all(axis=1)
    flange, joints = flange[reached], joints[reached]
    seeds = joints + np.random.default_rng(1).uniform(-1, 1, joints.shape) * np.radians(2.0)
    arm = kdl.KdlArm(task.cell.robot)
    solver = arm.solver("nr", 1e-5)
    jacobians = arm.kdl.ChainJntToJacSolver(arm.chain)
    lower, upper = task.cell.limits.lower[:6], task.cell.limits.upper[:6]

    def call() -> None:
        angles, matrix = arm.kdl.JntArray(6), arm.kdl.Jacobian(6)
        for seed, pose in zip(seeds, flange, strict=True):
            solver.CartToJnt(arm.angles(seed), arm.frame(pose), angles)
            q = np.array([angles[k] for k in range(6)])
            if (q < lower).any() or (q > upper).any():
                continue
            jacobians.JntToJac(angles, matrix)
            scaled = np.array([[matrix[row, column] for column in range(6)] for row in range(6)])
            scaled[:3] /= task.parameters.characteristic_length
            np.linalg.svd(scaled, compute_uv=False)

    return call
