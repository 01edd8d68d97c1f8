# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotation polynomials given by the user; they get the same checks as computed ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...issues import WARNING, Issue, Text
from ...parameters.joints import JointParameters
from ...toolpath import Bead
from ..joint_path import BeadPath
from ..points import gather
from ..task import Task
from . import local_optimisation
from .local_optimisation import evaluate_paths

Place = tuple[int, int]

METHOD, GIVEN = "layer-by-layer", "given"


def coefficients(
    parameters: JointParameters, bead_ids: Sequence[Place]
) -> dict[int, tuple[float, ...]]:
    """Return the coefficients given by the user.

    Parameters
    ----------
    parameters : JointParameters
        Joint parameters, including `given`.
    bead_ids : sequence of Place
        Layer and index of each bead.

    Returns
    -------
    dict[int, tuple[float, ...]]
        Coefficients in ascending order, by bead index; beads without a given polynomial are
        missing.
    """
    polynomials = {polynomial.bead: polynomial.coefficients for polynomial in parameters.given}
    default = polynomials.get(None)
    by_number = {k: polynomials.get(bead_id, default) for k, bead_id in enumerate(bead_ids)}
    return {k: values for k, values in by_number.items() if values is not None}


def paths(
    task: Task,
    beads: Sequence[Bead],
    bead_ids: Sequence[Place],
    fixed: Mapping[int, tuple[float, ...]],
) -> dict[int, BeadPath]:
    """Return the paths for given coefficients.

    Parameters
    ----------
    task : Task
        The plan.
    beads : sequence of Bead
        All beads.
    bead_ids : sequence of Place
        Layer and index of each bead.
    fixed : Mapping[int, tuple[float, ...]]
        Coefficients by bead index.

    Returns
    -------
    dict[int, BeadPath]
        Paths by bead index.
    """
    if not fixed:
        return {}
    numbers = sorted(fixed)
    rows = np.zeros((len(numbers), max(map(len, fixed.values()))))
    for row, k in zip(rows, numbers):
        row[: len(fixed[k])] = fixed[k]
    given_beads = [beads[k] for k in numbers]
    points = gather([beads[k] for k in numbers], task.cell)
    count = len(numbers)
    none = local_optimisation.Refined(rows, np.zeros(count), (GIVEN,) * count, (0,) * count)
    bead_paths = evaluate_paths(
        task,
        given_beads,
        [bead_ids[k] for k in numbers],
        points,
        task.thresholds(points),
        rows,
        none,
    )
    return dict(zip(numbers, bead_paths))


def not_used(parameters: JointParameters, bead_ids: Sequence[Place]) -> list[Issue]:
    """Return a warning about given polynomials of unknown beads, or if the method ignores them."""
    if parameters.given and parameters.method != METHOD:
        return [
            Issue(
                WARNING,
                "GIVEN_NOT_USED",
                Text(
                    "joints.given has no effect with the method {}; use {}, or remove joints.given",
                    parameters.method,
                    METHOD,
                ),
            )
        ]
    missing = sorted(
        polynomial.bead
        for polynomial in parameters.given
        if polynomial.bead is not None and polynomial.bead not in set(bead_ids)
    )
    if not missing:
        return []
    named = ", ".join(f"{layer}/{bead}" for layer, bead in missing[:5]) + (
        " ..." if len(missing) > 5 else ""
    )
    return [
        Issue(
            WARNING,
            "GIVEN_NOT_USED",
            Text("joints.given names unknown beads: {}; remove these entries", named),
        )
    ]
