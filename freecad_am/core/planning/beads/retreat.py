# SPDX-License-Identifier: LGPL-2.1-or-later
"""Extend beads past their end: open beads back over their end, closed beads over their start."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...geometry.columns import dots, lengths
from ...geometry.curves.outline import at_points
from ...geometry.frames import TURN, unit
from ...toolpath import Bead
from ...types import Array
from ..external import stroke
from ..joint_path import BeadPath
from ..task import Task

BACK = -0.999  # maximum cosine between arriving and leaving directions at a reversal


class _Way(NamedTuple):
    """The retreat from the end of a bead.

    It passes `past` points; the last one is at fraction `share` of its segment.
    """

    past: int
    share: float

    def of(self, column: Array) -> Array:
        """Return a bead column (n, ...) along the retreat (past, ...), without the bead end."""
        back = column[::-1]
        end_value = back[self.past - 1] + self.share * (back[self.past] - back[self.past - 1])
        return np.concatenate([back[1 : self.past], [end_value]])


def gone_back(bead: Bead, length: float) -> Bead:
    """Print the last `length` mm of an open bead once more, backwards.

    `length` is limited to the bead length. A closed bead is returned unchanged.
    """
    if length <= 0.0 or bead.closed:
        return bead
    retreat = _way(bead, length)
    end_segment = len(bead) - 1 - retreat.past  # the segment in which the retreat ends
    (point,), (tangent,) = bead.outline.at(np.array([end_segment]), 1.0 - retreat.share)
    points = retreat.of(bead.points)
    points[-1] = point

    def extended(change: Callable[[Array], Array]) -> Callable[[Array], Array]:
        return lambda column: np.concatenate([column, change(column)])

    def directions(column: Array) -> Array:
        backward = retreat.of(column)
        return np.asarray(backward / lengths(backward)[:, None])

    def both(column: Array | None) -> Array | None:
        return None if column is None else extended(retreat.of)(column)

    # compute the tangents first: near the reversal the extended points look straight
    tangents = _tangents(bead)
    back = -tangents[::-1, ::-1]
    turning = np.stack([tangents[-1, 0], back[0, 1]])[None]
    ends = np.repeat(-tangent[None, None], 2, axis=1)
    return dataclasses.replace(
        bead,
        points=np.concatenate([bead.points, points]),
        tangents=np.concatenate([tangents[:-1], turning, back[1 : retreat.past], ends]),
        build=extended(directions)(bead.build),
        tool=extended(directions)(bead.tool),
        # the parameter keeps increasing, because it is the position along the bead
        parameter=extended(lambda column: 2.0 * column[-1] - retreat.of(column))(bead.parameter),
        speed=np.concatenate([bead.speed, bead.speed[::-1][: retreat.past]]),
        settings=None
        if bead.settings is None
        else np.concatenate([bead.settings, bead.settings[::-1][: retreat.past]]),
        width=both(bead.width),
        height=both(bead.height),
        external=both(bead.external),
    )


def go_back(task: Task, path: BeadPath, length: float) -> BeadPath:
    """Extend an open bead backwards over its end.

    The retreat reuses the joints that led to the end.

    Parameters
    ----------
    task : Task
        The plan of the path.
    path : BeadPath
        The path; returned unchanged if closed or unreachable.
    length : float
        Length of the retreat, mm.

    Returns
    -------
    BeadPath
        The extended path.
    """
    if length <= 0.0 or path.bead.closed or not path.reachable:
        return path
    retreat, bead, n = _way(path.bead, length), gone_back(path.bead, length), len(path.bead)
    phi, joints = retreat.of(path.phi), retreat.of(path.joints)
    flange = task.cell.flange_poses(bead.points[n:], bead.tool[n:], phi, joints)
    joints[-1:] = unwrapped_from(task, joints[-1], task.inverse(flange[-1:], joints[-1:]))
    return longer(task, path, bead, flange, phi, joints, retreat.of(path.threshold))


def turns_back(bead: Bead) -> Array:
    """Mark the points where a bead reverses and the machine has to stop.

    Parameters
    ----------
    bead : Bead
        The bead of n points.

    Returns
    -------
    (n,) array
        1 at a reversal, otherwise 0.
    """
    if bead.tangents is None:
        return np.zeros(len(bead))
    return (dots(bead.tangents[:, 0], bead.tangents[:, 1]) < BACK).astype(float)


def _tangents(bead: Bead) -> Array:
    """Return the unit tangents (n, 2, 3) of the bead curve, arriving at and leaving each point."""
    if bead.tangents is not None:
        return bead.tangents
    return at_points(unit(bead.outline.leaving), unit(bead.outline.arriving))


def _way(bead: Bead, length: float) -> _Way:
    along = np.cumsum(lengths(np.diff(bead.points[::-1], axis=0)))
    length = min(length, float(along[-1]))
    count = int(np.searchsorted(along, length))
    length_before = float(along[count - 1]) if count else 0.0
    return _Way(count + 1, (length - length_before) / (float(along[count]) - length_before))


# ---- Extend closed beads past their seam


def extend_past_seam(task: Task, path: BeadPath, overlap: float) -> BeadPath:
    """Extend a closed bead over its start by the seam overlap, or by its scarf.

    The rotation continues from its end value, and the joints follow.

    Parameters
    ----------
    task : Task
        The plan of the path.
    path : BeadPath
        The path; returned unchanged if open or unreachable.
    overlap : float
        Overlap length, mm; at most one round.

    Returns
    -------
    BeadPath
        The extended path, with an open bead.
    """
    if path.bead.overlap_of(overlap) <= 0.0 or not path.bead.closed or not path.reachable:
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
    """Append m points to the path of a bead.

    Parameters
    ----------
    task : Task
        The plan of the path.
    path : BeadPath
        The path of n points.
    bead : Bead
        The bead, with all n + m points.
    flange : (m, 4, 4) array
        Flange poses at the new points, base_link.
    phi : (m,) array
        Rotations about the tool axis at the new points, rad.
    joints : (m, axes) array
        Joint values at the new points, rad or mm.
    threshold : (m,) array
        Required minimum condition at the new points.

    Returns
    -------
    BeadPath
        The path of n + m points.
    """
    return dataclasses.replace(
        path,
        bead=bead,
        phi=np.concatenate([path.phi, phi]),
        joints=np.concatenate([path.joints, joints]),
        condition=np.concatenate([path.condition, task.condition_at(flange, joints)]),
        threshold=np.concatenate([path.threshold, threshold]),
    )


def unwrapped_from(task: Task, start: Array, joints: Array) -> Array:
    """Unwrap joints, continuing from given joints.

    Parameters
    ----------
    task : Task
        The plan; its prismatic axes stay unchanged.
    start : (axes,) array
        Joints before the first row, rad or mm.
    joints : (n, axes) array
        Joints, known up to whole turns.

    Returns
    -------
    (n, axes) array
        Joints whose steps are at most half a turn.
    """
    step = np.diff(joints, axis=0, prepend=start[None])
    step -= np.where(task.cell.machine.chain.sliding, 0.0, TURN * np.round(step / TURN))
    return np.asarray(start + np.cumsum(step, axis=0))
