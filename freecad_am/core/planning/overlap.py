# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs closed beads on past their seam, over their own beginning."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from .joint_path import BeadPath
from .points import TURN
from .task import Task

Array = NDArray[np.float64]


def run_on(task: Task, path: BeadPath, overlap: float) -> BeadPath:
    """The path of a closed bead with its beginning repeated over `overlap` mm, at most once round; then it is open.

    The rotation goes on from where it has come to, and the joints are those it then takes.
    """
    bead = path.bead
    if overlap <= 0.0 or not bead.closed or not path.reachable:
        return path
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(bead.points, axis=0), axis=1))])
    overlap = min(overlap, float(along[-1]))
    count = max(1, int(np.searchsorted(along, overlap)))
    share = (overlap - along[count - 1]) / (along[count] - along[count - 1])

    def again(column: Array, on: float = 0.0) -> Array:
        end = column[count - 1] + share * (column[count] - column[count - 1])
        return np.concatenate([column[1:count], [end]]) + on

    def directions(column: Array) -> Array:
        repeated = again(column)
        return np.asarray(repeated / np.linalg.norm(repeated, axis=1, keepdims=True))

    position, tool = again(bead.points), directions(bead.tool)
    last, along_last = bead.outline.at(np.array([count - 1]), float(share))
    position[-1] = last[0]
    phi = again(path.phi, float(path.phi[-1] - path.phi[0]))
    flange = task.cell.flange_poses(position, tool, phi)
    joints = _counted_from(path.joints[-1], task.inverse(flange))
    longer = dataclasses.replace(
        bead, points=np.concatenate([bead.points, position]), tool=np.concatenate([bead.tool, tool]),
        build=np.concatenate([bead.build, directions(bead.build)]),
        parameter=np.concatenate([bead.parameter, again(bead.parameter, bead.parameter[-1] - bead.parameter[0])]),
        speed=np.concatenate([bead.speed, bead.speed[1 : count + 1]]), closed=False,
        width=None if bead.width is None else np.concatenate([bead.width, again(bead.width)]),
        tangents=None if bead.tangents is None else _run_on(bead.tangents, count, along_last),
    )
    return dataclasses.replace(
        path, bead=longer, phi=np.concatenate([path.phi, phi]), joints=np.concatenate([path.joints, joints]),
        condition=np.concatenate([path.condition, task.condition_at(flange, joints)]),
        threshold=np.concatenate([path.threshold, again(path.threshold)]),
    )


def _run_on(tangents: Array, count: int, last: Array) -> Array:
    """Tangents (n, 2, 3) of a bead gone on to its point `count`, but ending along `last` (1, 3)."""
    seam = np.stack([tangents[-1, 0], tangents[0, 1]])[None]
    return np.concatenate([tangents[:-1], seam, tangents[1:count], np.repeat(last[:, None], 2, axis=1)])


def _counted_from(start: Array, joints: Array) -> Array:
    """Joints (n, axes) in the turns that go on from the joints before them (axes,)."""
    step = np.diff(joints, axis=0, prepend=start[None])
    step -= TURN * np.round(step / TURN)
    return np.asarray(start + np.cumsum(step, axis=0))
