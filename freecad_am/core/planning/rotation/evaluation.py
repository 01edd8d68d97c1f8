# SPDX-License-Identifier: LGPL-2.1-or-later
"""Evaluates polynomials of the rotation at all points of their beads."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...toolpath import Bead
from ...types import Array
from .. import criteria
from ..joint_path import BeadPath
from ..points import Points, whole_turns
from ..task import Task, condition_margin
from . import refine

Place = tuple[int, int]


def evaluate_paths(
    task: Task,
    beads: Sequence[Bead],
    bead_ids: Sequence[Place],
    points: Points,
    threshold: Array,
    coefficients: Array,
    refined: refine.Refined,
) -> list[BeadPath]:
    """Return the paths of all beads for given coefficients (B, degree + 1), evaluated at all their points."""
    phi, _ = task.rotation(points, points.polynomial(coefficients))
    joints = task.joints(points, phi)
    condition = task.condition(points, phi, joints)
    matrix = None
    if task.parameters.objective not in criteria.JOINT_ONLY and np.isfinite(joints).all():
        matrix = task.jacobian_at(points.frames, phi, joints)
    objective = (
        criteria.value(task, points, joints, matrix)
        if matrix is not None or task.parameters.objective in criteria.JOINT_ONLY
        else np.full(points.beads, np.nan)
    )
    margin = points.worst(
        np.minimum(task.rows.margin(joints), condition_margin(condition, threshold))
    )
    ends = np.append(points.first, len(points))
    # like the joints: on a bead of few points a steep polynomial makes whole turns between two points, the same at both
    turned = phi - whole_turns(np.diff(phi), points)
    return [
        BeadPath(
            layer,
            index,
            bead,
            turned[a:b],
            joints[a:b],
            condition[a:b],
            threshold[a:b],
            float(objective[k]),
            float(margin[k]),
            coefficients[k],
            refined.reason[k],
            refined.iterations[k],
        )
        for k, (bead, (layer, index), a, b) in enumerate(zip(beads, bead_ids, ends[:-1], ends[1:]))
    ]
