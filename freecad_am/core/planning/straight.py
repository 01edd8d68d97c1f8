# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adds points where motion straight in the joints would leave the bead between its points."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from ..issues import ERROR, Issue
from ..toolpath import Bead
from .joint_path import BeadPath
from .task import Task

Array = NDArray[np.float64]

INSIDE = np.array([0.25, 0.5, 0.75])
ROUNDS = 8
# a bead that turns by more than this at a point has a corner there, rad
CORNER = np.radians(35.0)
# rounding room: beads of revolution use their chord error up by themselves, mm
ROUNDING = 1e-6


def kept_straight(task: Task, path: BeadPath, chord_error: float) -> tuple[BeadPath, list[Issue]]:
    """The path with as many points added as it takes to stay within the chord error (mm) of the bead between them.

    Points are added on the curve that the points of the bead outline, not on its chords; at corners on the segments.
    """
    for _ in range(ROUNDS):
        if not path.reachable:
            return path, []
        off = deviation(task, path.bead, path.joints) > chord_error + ROUNDING
        if not off.any():
            return path, []
        path = _halved(task, path, np.flatnonzero(off))
    worst = int(deviation(task, path.bead, path.joints).argmax())
    return path, [Issue(
        ERROR, "NOT_STRAIGHT", "joint motion leaves the bead between two points however many are added: near a singularity",
        path.layer, path.index, worst,
    )]


def deviation(task: Task, bead: Bead, joints: Array) -> Array:
    """(n - 1,) how far the nozzle's tip leaves each segment of the bead when the joints run straight, mm."""
    start, end = joints[:-1], joints[1:]
    between = start[:, None] + (end - start)[:, None] * INSIDE[:, None]
    flange = task.cell.machine.chain.forward(between.reshape(-1, joints.shape[1]))
    tip, _ = task.cell.tip_in_part(flange)
    tip = tip.reshape(len(start), len(INSIDE), 3)
    origin, along = bead.points[:-1, None], np.diff(bead.points, axis=0)[:, None]
    share = np.clip(((tip - origin) * along).sum(-1) / np.maximum((along * along).sum(-1), 1e-18), 0.0, 1.0)
    distance: Array = np.linalg.norm(tip - origin - share[..., None] * along, axis=-1).max(axis=1)
    return distance


def curve_points(bead: Bead, share: float = 0.5) -> Array:
    """(n - 1, 3) points of the curve over each segment, a share of the way along it: cubics through its ends.

    The tangent at a point is that of the circle through it and its neighbours, so that a circle is met to the fourth
    order in its turn per segment; a segment next to a corner is straight.
    """
    along = np.diff(bead.points, axis=0)
    length = np.linalg.norm(along, axis=1, keepdims=True)
    along = along / np.maximum(length, 1e-12)
    rounded = bead.closed and len(along) > 2
    before = np.concatenate([along[-1:] if rounded else along[:1], along])
    after = np.concatenate([along, along[:1] if rounded else along[-1:]])
    far = np.concatenate([length[-1:] if rounded else length[:1], length])
    near = np.concatenate([length, length[:1] if rounded else length[-1:]])
    tangent = before * near + after * far
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-12)
    if not rounded and len(along) > 1:  # at an end, the circle of the point next to it
        tangent[0] = 2.0 * (along[0] @ tangent[1]) * along[0] - tangent[1]
        tangent[-1] = 2.0 * (along[-1] @ tangent[-2]) * along[-1] - tangent[-2]
    corner = (before * after).sum(axis=1) < np.cos(CORNER)
    rest = 1.0 - share
    bow = share * rest * length * (rest * (tangent[:-1] - along) - share * (tangent[1:] - along))
    bow[corner[:-1] | corner[1:]] = 0.0
    points: Array = rest * bead.points[:-1] + share * bead.points[1:] + bow
    return points


def _halved(task: Task, path: BeadPath, segments: NDArray[np.int64]) -> BeadPath:
    """The path with a point in the middle of each of the segments."""
    at = segments + 1

    def middle(column: Array) -> Array:
        return np.insert(column, at, 0.5 * (column[segments] + column[at]), axis=0)

    def middle_direction(column: Array) -> Array:
        mean = column[segments] + column[at]
        return np.insert(column, at, mean / np.linalg.norm(mean, axis=1, keepdims=True), axis=0)

    bead = path.bead
    finer = dataclasses.replace(
        bead, points=np.insert(bead.points, at, curve_points(bead)[segments], axis=0),
        build=middle_direction(bead.build), tool=middle_direction(bead.tool),
        parameter=middle(bead.parameter), speed=np.insert(bead.speed, at, bead.speed[at]),
        width=None if bead.width is None else middle(bead.width),
    )
    phi = middle(path.phi)
    new = at + np.arange(len(at))
    flange = task.cell.flange_poses(finer.points[new], finer.tool[new], phi[new])
    joints = middle(path.joints)
    found = task.inverse(flange)
    joints[new] = found - 2.0 * np.pi * np.round((found - joints[new]) / (2.0 * np.pi))
    condition = np.insert(path.condition, at, task.condition_at(flange, joints[new]))
    return dataclasses.replace(
        path, bead=finer, phi=phi, joints=joints, condition=condition, threshold=middle(path.threshold)
    )
