# SPDX-License-Identifier: LGPL-2.1-or-later
"""Polynomials of the rotation that are given by the user instead of searched; they are judged like any other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...issues import WARNING, Issue, Text
from ...parameters.joints import JointParameters, given_polynomials
from ...toolpath import Bead
from ..joint_path import BeadPath
from ..points import gather
from ..task import Task
from . import refine
from .evaluation import judged

Place = tuple[int, int]

METHOD, GIVEN = "layer-by-layer", "given"


def coefficients(
    parameters: JointParameters, places: Sequence[Place]
) -> dict[int, tuple[float, ...]]:
    """The coefficients given, by number of the bead among the places (layer, index)."""
    found = given_polynomials(parameters.given)
    every = found.get(None)
    chosen = {k: found.get(place, every) for k, place in enumerate(places)}
    return {k: values for k, values in chosen.items() if values is not None}


def paths(
    task: Task,
    beads: Sequence[Bead],
    places: Sequence[Place],
    fixed: Mapping[int, tuple[float, ...]],
) -> dict[int, BeadPath]:
    """The paths that the given coefficients make, by number of the bead."""
    if not fixed:
        return {}
    chosen = sorted(fixed)
    rows = np.zeros((len(chosen), max(map(len, fixed.values()))))
    for row, k in zip(rows, chosen):
        row[: len(fixed[k])] = fixed[k]
    some, points = [beads[k] for k in chosen], gather([beads[k] for k in chosen], task.cell)
    count = len(chosen)
    none = refine.Refined(rows, np.zeros(count), (GIVEN,) * count, (0,) * count)
    made = judged(
        task, some, [places[k] for k in chosen], points, task.thresholds(points), rows, none
    )
    return dict(zip(chosen, made))


def not_used(parameters: JointParameters, places: Sequence[Place]) -> list[Issue]:
    """A warning of polynomials given for beads that are not there, or to a method that takes none."""
    if parameters.given and parameters.method != METHOD:
        return [
            Issue(
                WARNING,
                "GIVEN_NOT_USED",
                Text(
                    "joints.given is of no effect on the method {}; use {}, or take it out",
                    parameters.method,
                    METHOD,
                ),
            )
        ]
    lost = sorted(
        place
        for place in given_polynomials(parameters.given)
        if place is not None and place not in set(places)
    )
    if not lost:
        return []
    named = ", ".join(f"{layer}/{bead}" for layer, bead in lost[:5]) + (
        " ..." if len(lost) > 5 else ""
    )
    return [
        Issue(
            WARNING,
            "GIVEN_NOT_USED",
            Text("joints.given names beads that are not there: {}; take them out", named),
        )
    ]
