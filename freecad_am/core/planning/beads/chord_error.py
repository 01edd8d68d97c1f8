# SPDX-License-Identifier: LGPL-2.1-or-later
"""Add points where joint motion would deviate from a bead between its points."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from ...issues import ERROR, Issue
from ...kinematics.cell import Cell
from ...toolpath import Bead
from ...types import Array, Index, Integers
from ..joint_path import BeadPath
from ..task import Task

INNER_SHARES = np.array([0.25, 0.5, 0.75])
FINE_SHARES = (
    np.array([1.0, 2.0, 4.0, 5.0]) / 6.0
)  # samples of segments that use more than half of the chord error
# (4, 3) weights: interpolate the deviations at INNER_SHARES to FINE_SHARES, with zero deviation at
# both ends
INTERPOLATION = np.array(
    [
        [
            np.prod(
                [(x - node) / (own - node) for node in (0.0, *INNER_SHARES, 1.0) if node != own]
            )
            for own in INNER_SHARES
        ]
        for x in FINE_SHARES
    ]
)
ROUNDS = 8
POINTS_PER_BATCH = 4096  # approximate number of points per batch
# mm; margin for rounding: beads of revolution use their whole chord error
ROUNDING = 1e-6


def refined_to_chord_error(
    task: Task, path: BeadPath, chord_error: float
) -> tuple[BeadPath, list[Issue]]:
    """Add points to a path until joint motion keeps the chord error.

    Added points lie on the curve of the bead, not on its chords; at corners they lie on the
    segments.

    Parameters
    ----------
    task : Task
        The plan of the path.
    path : BeadPath
        The path; returned unchanged if unreachable.
    chord_error : float
        Maximum deviation of the tip between two points, mm.

    Returns
    -------
    path : BeadPath
        The path, including added points.
    issues : list of Issue
        Error NOT_STRAIGHT if the path still deviates after ROUNDS rounds.
    """
    for _ in range(ROUNDS):
        if not path.reachable:
            return path, []
        off = deviation(task, path.bead, path.joints, chord_error) > chord_error + ROUNDING
        if not off.any():
            return path, []
        path = _halved(task, path, np.flatnonzero(off))
    worst = int(deviation(task, path.bead, path.joints, chord_error).argmax())
    return path, [
        Issue(
            ERROR,
            "NOT_STRAIGHT",
            "the joint motion deviates from the bead between two points near a singularity, no "
            "matter how many points are added; move the part in the cell, or choose another "
            "cell.branch",
            path.layer,
            path.index,
            worst,
        )
    ]


def all_refined(
    task: Task, paths: Sequence[BeadPath], chord_error: float
) -> list[tuple[BeadPath, list[Issue]]]:
    """Apply `refined_to_chord_error` to each path.

    Most paths need no added points. A batched check finds these paths fastest.

    Parameters
    ----------
    task : Task
        The plan of the paths.
    paths : sequence of BeadPath
        The paths, reachable or not.
    chord_error : float
        Maximum deviation of the tip between two points, mm.

    Returns
    -------
    list of (BeadPath, list of Issue)
        Each path, including added points, with its issues.
    """
    reachable = [k for k, path in enumerate(paths) if path.reachable]
    ends = np.cumsum([len(paths[k].bead) for k in reachable])
    bent: set[int] = set()
    for together in np.split(
        np.array(reachable), np.flatnonzero(np.diff(ends // POINTS_PER_BATCH)) + 1
    ):
        batch_paths = [paths[k] for k in together.tolist()]
        if not batch_paths:
            continue
        last_points = np.cumsum([len(path.bead) for path in batch_paths]) - 1
        points, joints = (
            np.concatenate(rows)
            for rows in zip(*((path.bead.points, path.joints) for path in batch_paths))
        )
        segments = np.delete(np.arange(len(points)), last_points)
        off = _deviation(task, points, joints, segments, chord_error) > chord_error + ROUNDING
        bent.update(together[np.searchsorted(last_points, segments[off])].tolist())
    return [
        refined_to_chord_error(task, path, chord_error) if k in bent else (path, [])
        for k, path in enumerate(paths)
    ]


def deviation(task: Task, bead: Bead, joints: Array, chord_error: float) -> Array:
    """Return the deviation of the tip from each segment of a bead during joint motion.

    Parameters
    ----------
    task : Task
        The plan of the bead.
    bead : Bead
        The bead of n points.
    joints : (n, axes) array
        Joint values at the bead points, rad or mm.
    chord_error : float
        Allowed deviation, mm; segments close to it are sampled more finely.

    Returns
    -------
    (n - 1,) array
        Deviation on each segment, mm.
    """
    return _deviation(task, bead.points, joints, np.arange(len(joints) - 1), chord_error)


def _deviation(
    task: Task, points: Array, joints: Array, segments: Index, chord_error: float
) -> Array:
    """Return the deviation (k,) of segments; `segments` (k,) gives the indices of their starts.

    points: (n, 3). joints: (n, axes).
    """
    distances = _looked_at(task, points, joints, segments, INNER_SHARES)
    deviation: Array = np.maximum.reduce(distances)
    # the deviation of nearly all segments is smooth with its maximum near the midpoint, so few
    # samples suffice
    doubtful = np.flatnonzero(
        (deviation > 0.5 * chord_error) & (np.maximum.reduce(INTERPOLATION @ distances) > deviation)
    )
    if len(doubtful):
        deviation[doubtful] = np.maximum.reduce(
            [
                deviation[doubtful],
                *_looked_at(task, points, joints, segments[doubtful], FINE_SHARES),
            ]
        )
    return deviation


def leaning(cell: Cell, bead: Bead, joints: Array) -> Array:
    """Return the deviation of the tool axis on each segment during joint motion.

    Parameters
    ----------
    cell : Cell
        The cell.
    bead : Bead
        The bead of n points.
    joints : (n, axes) array
        Joint values at the bead points, rad or mm.

    Returns
    -------
    (n - 1,) array
        Maximum angle to the tool axis interpolated between the segment ends, rad.
    """
    joint_step, count = np.diff(joints, axis=0)[:, None], len(INNER_SHARES)
    flange = cell.machine.chain.forward(
        (joints[:-1, None] + INNER_SHARES[:, None] * joint_step).reshape(-1, joints.shape[1])
    )
    tool = cell.tip_in_part(flange)[1].reshape(-1, count, 3)
    wanted_tool = bead.tool[:-1, None] + INNER_SHARES[:, None] * np.diff(bead.tool, axis=0)[:, None]
    sine = np.linalg.norm(np.cross(wanted_tool, tool), axis=-1)
    angle: Array = np.arctan2(sine, (wanted_tool * tool).sum(-1)).max(axis=1)
    return angle


def _looked_at(task: Task, points: Array, joints: Array, segments: Index, shares: Array) -> Array:
    """Return the deviations (s, k) of segments (k,) at fractions `shares` (s,), mm."""
    start, joint_step = joints[segments], joints[segments + 1] - joints[segments]
    offset = (
        task.cell.tip_at(start[:, None] + joint_step[:, None] * shares[:, None])
        - points[segments, None]
    )
    along = points[segments + 1] - points[segments]
    length = np.maximum(np.einsum("ni,ni->n", along, along), 1e-18)
    share = np.clip(np.einsum("nki,ni->nk", offset, along) / length[:, None], 0.0, 1.0)
    offset -= share[..., None] * along[:, None]
    distance: Array = np.sqrt(np.einsum("nki,nki->kn", offset, offset))
    return distance


def _halved(task: Task, path: BeadPath, segments: Integers) -> BeadPath:
    """Add a point at the midpoint of each of the segments."""
    insert_rows = segments + 1

    def middle(column: Array) -> Array:
        return np.insert(
            column, insert_rows, 0.5 * (column[segments] + column[insert_rows]), axis=0
        )

    finer = path.bead.halved(segments)
    phi = middle(path.phi)
    new = insert_rows + np.arange(len(insert_rows))
    joints = middle(path.joints)
    flange = task.cell.flange_poses(finer.points[new], finer.tool[new], phi[new], joints[new])
    solved = task.inverse(flange, joints[new])
    joints[new] = solved - 2.0 * np.pi * np.round((solved - joints[new]) / (2.0 * np.pi))
    condition = np.insert(path.condition, insert_rows, task.condition_at(flange, joints[new]))
    return dataclasses.replace(
        path,
        bead=finer,
        phi=phi,
        joints=joints,
        condition=condition,
        threshold=middle(path.threshold),
    )
