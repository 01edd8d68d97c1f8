# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs closed beads on past their seam, over their own beginning."""

from __future__ import annotations

import dataclasses

import numpy as np

from ...geometry.angles import TURN
from ...toolpath import Bead
from ...types import Array
from ..external import stroke
from ..joint_path import BeadPath
from ..task import Task


def extend_past_seam(task: Task, path: BeadPath, overlap: float) -> BeadPath:
    """Return the path of a closed bead extended over its beginning by `overlap` mm, at most one
    round.

    The result is open. The rotation continues from its end value, and the joints follow it.
    """
    if overlap <= 0.0 or not path.bead.closed or not path.reachable:
        return path
    bead, n = path.bead.run_on(overlap), len(path.bead)
    fresh = slice(n, None)
    share = (bead.parameter - bead.parameter[0])[fresh] - (
        path.bead.parameter[-1] - path.bead.parameter[0]
    )

    def again(column: Array) -> Array:
        since = path.bead.parameter - path.bead.parameter[0]
        return np.asarray(np.interp(share * np.sign(since[-1]), since * np.sign(since[-1]), column))

    phi = again(path.phi) + float(path.phi[-1] - path.phi[0])
    reference = np.stack([again(column) for column in path.joints.T], axis=1)
    external = task.cell.external_of(reference)
    if external is not None:
        robot_axes = reference.shape[1] - external.shape[1]
        reference[:, robot_axes:] = stroke.waiting(task.cell, path.joints[:, robot_axes:], external)
    flange = task.cell.flange_poses(bead.points[fresh], bead.tool[fresh], phi, reference)
    joints = unwrapped_from(task, path.joints[-1], task.inverse(flange, reference))
    return longer(task, path, bead, flange, phi, joints, again(path.threshold))


def longer(
    task: Task,
    path: BeadPath,
    bead: Bead,
    flange: Array,
    phi: Array,
    joints: Array,
    threshold: Array,
) -> BeadPath:
    """The path of a bead that has got m more points at its end: where the flange is there (m, 4, 4), rotations (m,), joints
    (m, axes), and how near to a singularity they may come (m,)."""
    return dataclasses.replace(
        path,
        bead=bead,
        phi=np.concatenate([path.phi, phi]),
        joints=np.concatenate([path.joints, joints]),
        condition=np.concatenate([path.condition, task.condition_at(flange, joints)]),
        threshold=np.concatenate([path.threshold, threshold]),
    )


def unwrapped_from(task: Task, start: Array, joints: Array) -> Array:
    """Joints (n, axes) in the turns that go on from the joints before them (axes,)."""
    step = np.diff(joints, axis=0, prepend=start[None])
    step -= np.where(task.cell.machine.chain.sliding, 0.0, TURN * np.round(step / TURN))
    return np.asarray(start + np.cumsum(step, axis=0))
