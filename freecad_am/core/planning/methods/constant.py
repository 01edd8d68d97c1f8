# SPDX-License-Identifier: LGPL-2.1-or-later
"""One RZ for the whole job, without optimisation: a reference, and sufficient for simple parts."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...geometry.frames import TURN, shortest
from ...geometry.tie_breaking import first_most
from ...issues import NOTE, Issue, Text
from ...toolpath import Bead
from ...types import Array
from .. import clear_rotations, criteria
from ..joint_path import BeadPath, numbered
from ..points import Points, gather
from ..rotation import global_search
from ..task import Task, condition_margin

Progress = Callable[[float, str], None]

RZ_CANDIDATES, RZ_FINE_CANDIDATES = 360, 21
LOOKED = 72  # number of RZ values for the link check
POINT_STRIDE = 8  # stride of the points to check first

Clear = Callable[[float], bool]  # whether all links are clear for an RZ, rad


def plan(
    task: Task, beads: Sequence[Bead], bead_ids: Sequence[tuple[int, int]], progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    """Plan the paths with one RZ for the whole job.

    Parameters
    ----------
    task : Task
        The plan; `joints.rz` is the angle, or 'auto' for the maximum worst-case margin.
    beads : sequence of Bead
        The beads in print order.
    bead_ids : Sequence[tuple[int, int]]
        Layer and index of each bead.
    progress : callable
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    paths : list of BeadPath
        The paths.
    issues : list of Issue
        Notes if no RZ is feasible or keeps the links clear.
    """
    requested = task.parameters.rz
    full = gather(beads, task.cell)
    threshold = task.thresholds(full)
    issues: list[Issue] = []
    if isinstance(requested, str):
        coarse = gather(beads, task.cell, global_search.POINTS_PER_BEAD)
        progress(0.1, "searching for one RZ for the whole job")
        clear = None if task.kept is None else _keeps_clear(task, beads, bead_ids)
        rz, margin, served = best_rz(task, coarse, task.thresholds(coarse), clear)
        if not served:
            issues.append(
                Issue(
                    NOTE,
                    "RZ_CONSTANT",
                    Text(
                        "none of the {} tested values of RZ keeps the links clear in the whole "
                        "job; joints.method: layer-by-layer uses one value per bead",
                        LOOKED,
                    ),
                )
            )
        if margin < 0.0:
            issues.append(
                Issue(
                    NOTE,
                    "RZ_CONSTANT",
                    Text(
                        "none of the {} tested values of RZ is feasible for the whole job, and "
                        "the best value is {:.1f} deg; joints.method: layer-by-layer uses one "
                        "polynomial per bead",
                        RZ_CANDIDATES,
                        np.degrees(rz),
                    ),
                )
            )
    else:
        rz = float(requested)
    progress(0.7, "following the beads")
    return _paths(task, beads, bead_ids, full, threshold, rz), issues


def best_rz(
    task: Task, points: Points, thresholds: Array, clear: Clear | None = None
) -> tuple[float, float, bool]:
    """Return the RZ with the maximum worst-case margin over all points.

    Parameters
    ----------
    task : Task
        The plan.
    points : Points
        T points.
    thresholds : (T,) array
        Required minimum condition.
    clear : Clear or None, optional
        Returns whether the links are clear for an RZ; None to skip this check.

    Returns
    -------
    rz : float
        The angle, rad; with clear links if possible.
    margin : float
        Its worst-case margin; negative if no RZ is feasible.
    is_clear : bool
        False if no feasible RZ has clear links.
    """
    rough = np.linspace(-np.pi, np.pi, RZ_CANDIDATES, endpoint=False)
    rough_margins = margins(task, points, thresholds, rough)
    best, served = int(first_most(rough_margins)), True
    if clear is not None and rough_margins[best] >= 0.0 and not clear(rough[best]):
        spread_rows = np.arange(0, RZ_CANDIDATES, RZ_CANDIDATES // LOOKED)
        order = spread_rows[np.argsort(-rough_margins[spread_rows], kind="stable")]
        first_clear = next(
            (k for k in order.tolist() if rough_margins[k] >= 0.0 and clear(rough[k])), None
        )
        best, served = (best, False) if first_clear is None else (first_clear, True)
    fine_values: Array = rough[best] + np.linspace(-1.0, 1.0, RZ_FINE_CANDIDATES) * (
        TURN / RZ_CANDIDATES
    )
    fine = margins(task, points, thresholds, fine_values)
    if (
        clear is not None
        and served
        and fine.max() >= 0.0
        and not clear(fine_values[int(first_most(fine))])
    ):
        return float(rough[best]), float(rough_margins[best]), True
    return float(fine_values[int(first_most(fine))]), float(fine.max()), served


def _keeps_clear(task: Task, beads: Sequence[Bead], bead_ids: Sequence[tuple[int, int]]) -> Clear:
    """Return a check whether the links are clear at all bead points for an RZ.

    It checks a few points first.
    """
    assert task.kept is not None
    arm_clearance, points = task.kept, gather(beads, task.cell, clear_rotations.POINTS_PER_BEAD)
    few_points = np.zeros(len(points), dtype=bool)
    few_points[::POINT_STRIDE] = True

    def clear(rz: float) -> bool:
        phi, _ = task.cell.poses.phi_of_rz(points.tool, np.full(len(points), rz))
        joints = task.joints(points, phi)
        return not any(
            arm_clearance.touches(
                np.where(subset[:, None], joints, np.nan), points, bead_ids
            ).any.any()
            for subset in (few_points, ~few_points)
        )

    return clear


def margins(task: Task, points: Points, thresholds: Array, values: Array) -> Array:
    """Return the minimum margin over all points for constant values of RZ.

    Parameters
    ----------
    task : Task
        The plan, including limits.
    points : Points
        T points.
    thresholds : (T,) array
        Required minimum condition.
    values : (C,) array
        RZ values, rad.

    Returns
    -------
    (C,) array
        Margin of limits and condition; -inf if a point is unreachable.
    """
    result = np.empty(len(values))
    for index, rz in enumerate(values):
        phi, _ = task.cell.poses.phi_of_rz(points.tool, np.full(len(points), rz))
        joints = task.joints(points, phi)
        margin = float(task.rows.margin(joints).min())
        if margin >= 0.0:
            condition = task.condition(points, phi, joints)
            margin = min(margin, float(condition_margin(condition, thresholds).min()))
        result[index] = margin
    return result


def _paths(
    task: Task,
    beads: Sequence[Bead],
    bead_ids: Sequence[tuple[int, int]],
    points: Points,
    threshold: Array,
    rz: float,
) -> list[BeadPath]:
    phi, _ = task.cell.poses.phi_of_rz(points.tool, np.full(len(points), rz))
    phi = _unwrapped(phi, points)
    joints = task.joints(points, phi)
    return bead_paths(
        task,
        beads,
        bead_ids,
        points,
        threshold,
        phi,
        joints,
        f"constant RZ {np.degrees(rz):.4f} deg",
    )


def bead_paths(
    task: Task,
    beads: Sequence[Bead],
    bead_ids: Sequence[tuple[int, int]],
    points: Points,
    threshold: Array,
    phi: Array,
    joints: Array,
    reason: str,
) -> list[BeadPath]:
    """Return paths without polynomials, given the rotation and joints at all points.

    Parameters
    ----------
    task : Task
        The plan.
    beads : sequence of Bead
        The B beads.
    bead_ids : Sequence[tuple[int, int]]
        Layer and index of each bead.
    points : Points
        T points of the B beads.
    threshold : (T,) array
        Required minimum condition.
    phi : (T,) array
        Rotation about the tool axis, rad.
    joints : (T, axes) array
        Joints, rad or mm; NaN out of reach.
    reason : str
        Report text on how the rotation was found.

    Returns
    -------
    list of BeadPath
        The paths, renumbered within each layer.
    """
    condition = task.condition(points, phi, joints)
    margin = points.worst(
        np.minimum(task.rows.margin(joints), condition_margin(condition, threshold))
    )
    objective = criteria.displacement(task, points, joints)
    ends = np.append(points.first, len(points))
    return numbered(
        [
            BeadPath(
                layer,
                index,
                bead,
                phi[a:b],
                joints[a:b],
                condition[a:b],
                threshold[a:b],
                float(objective[k]),
                float(margin[k]),
                None,
                reason,
            )
            for k, (bead, (layer, index), a, b) in enumerate(
                zip(beads, bead_ids, ends[:-1], ends[1:])
            )
        ]
    )


def _unwrapped(phi: Array, points: Points) -> Array:
    step = np.diff(phi, prepend=phi[:1])
    step = shortest(step)
    step[points.first] = 0.0
    rising = np.cumsum(step)
    return np.asarray(rising + (phi[points.first] - rising[points.first])[points.bead])
