# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closes the gap between a joint path and its bound: the best course of the rotation along a bead, each point free."""

from __future__ import annotations

import dataclasses

import numpy as np

from ...issues import Issue
from ...types import Array, Mask
from ..beads.chord_error import refined_to_chord_error
from ..joint_path import BeadPath
from ..points import gather, steps
from ..rotation import given
from ..task import Task, condition_margin
from . import course

POINTWISE_REASON = "each point free"
MIN_GAIN = 1e-3  # share of the objective that has to be won, else the polynomial stays


def close_gaps(
    task: Task, paths: list[tuple[BeadPath, list[Issue]]]
) -> list[tuple[BeadPath, list[Issue]]]:
    """Return the paths and their issues, with gaps closed if the task asks for it.

    New courses get the points that straight motion needs.
    """
    if not task.parameters.close_gap or not task.cell.machine.free or task.arm.followed:
        return paths
    return [
        (path, issues)
        if (best := closed(task, path)) is path
        else refined_to_chord_error(task, best, task.chord_error)
        for path, issues in paths
    ]


def closed(task: Task, path: BeadPath) -> BeadPath:
    """Return the path with the best rotation course that the search finds, if it is better.

    The course keeps limits, condition and range of the rotation, joined beads and link clearance.
    Given paths and infeasible paths stay unchanged.
    """
    if (
        task.parameters.objective != "displacement"
        or path.reason == given.GIVEN
        or not path.reachable
        or len(path.phi) < 3
    ):
        return path
    points = gather([path.bead], task.cell)

    def broken(phi: Array, joints: Array) -> Mask:
        return course.broken_by(task, points, path.threshold, phi, joints)

    def joints_at(phi: Array) -> Array:
        return task.raw_joints(points, phi)

    scale = np.broadcast_to(task.weights, (len(path.phi) - 1, len(task.weights)))
    phi, objective = course.best(
        joints_at, scale, path.phi, task.joined and path.bead.closed, broken
    )
    step = steps(path.joints, points)
    if not objective < (1.0 - MIN_GAIN) * float(((step * step) @ task.weights).sum()):
        return path
    joints, condition = task.joints(points, phi), task.condition(points, phi, joints_at(phi))
    if task.kept is not None:
        deposited = np.full(len(phi), task.kept.moment((path.layer, path.index)), dtype=np.int64)
        if task.kept.contact.touches(joints, deposited).any.any():
            return path
    margin = np.minimum(task.rows.margin(joints), condition_margin(condition, path.threshold))
    return dataclasses.replace(
        path,
        phi=phi,
        joints=joints,
        condition=condition,
        objective=objective,
        margin=float(margin.min()),
        coefficients=None,
        reason=POINTWISE_REASON,
    )
