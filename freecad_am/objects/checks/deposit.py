# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks of a deposit: omitted regions of the part, distance from the part, substrate contact."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...core.geometry.mesh.solid import SolidMesh
from ...core.geometry.obstacles import Body
from ...core.issues import WARNING, Issue, Text
from ...core.parameters.process import ProcessParameters
from ...core.process.deposit import balance as deposit_balance
from ...core.process.deposit import on_part
from ...core.strategies.support import ABOVE_SUBSTRATE
from ...core.toolpath import Toolpath as CoreToolpath
from ...core.types import Array
from ..families.given import Given
from ..families.registry import planner_for
from ..fields import preferences
from ..shapes.bodies import Taken
from ..stage import stage_of
from ..work import progress


def expected(value: Any, feature: Any = None) -> tuple[Issue, ...]:
    """Return the deposit balance issues of a feature result.

    feature: feature object, whose toolpath sets the bead width; None for the default width.
    """
    return deposit_balance.issues(deposit_balance.feature_balance(value, bead_width(feature)))


def bead_width(feature: Any = None) -> float:
    """Return the bead width of a feature's toolpath, or the default bead width, mm."""
    for following in () if feature is None else feature.InList:
        stage = stage_of(following)
        if stage is not None and stage.kind == "toolpath":
            return float(stage.parameters(following, ProcessParameters).bead_width)
    return float(preferences.process().get("bead_width", ProcessParameters().bead_width))


# ---- Distance of a finished toolpath from its source shapes

LOOKED = 0.95  # progress fraction at the start of this check


def check_on_part(toolpath: CoreToolpath, inputs: Given, sources: Sequence[Taken]) -> CoreToolpath:
    """Check the distance of a toolpath from its source shapes; return the toolpath with the result.

    The toolpath is unchanged if the shapes have no faces.
    """
    planner = planner_for(inputs.strategy)
    if not planner.is_on_part(inputs.wall):
        return toolpath
    progress.report(LOOKED, "checking whether the deposit is on the part")
    distances = planner.part_distances(toolpath, inputs, sources, on_part.sample_places(toolpath))
    if distances is None:
        return toolpath
    places, off, limit = distances
    if (
        toolpath.checks.fitted is not None
    ):  # layers fitted to a scan may deviate by the distance that they were moved
        from ...core.inspection.fit_layers import (
            max_moves,
        )  # only jobs with a scan need this import

        off = np.maximum(off - max_moves(toolpath.checks.fitted, places.layer), 0.0)
    return on_part.check_on_part(toolpath, places, off, limit)


# ---- Contact between a deposit and its substrate

REACH = 1.5  # layer heights; maximum gap between a deposit and its support, as in `support`


def gap_issues(
    label: str,
    deposited: Sequence[Body],
    points: Sequence[Array],
    ground: Sequence[Taken],
    layer_height: float,
) -> tuple[Issue, ...]:
    """Return a warning for each substrate that the deposit does not reach.

    The warning gives the minimum distance and its location. deposited: bodies to print. points:
    (n, 3) for each curve to print.
    """
    issues = []
    for substrate in ground:
        under = substrate.body()
        deposit_points = np.vstack([*(body.vertices for body in deposited), *points])
        distance = (
            SolidMesh(under.vertices, under.triangles)
            .searched(layer_height)
            .signed(deposit_points)[0]
        )
        nearest = int(distance.argmin())
        gap, position = float(distance[nearest]), deposit_points[nearest]
        for body in deposited if gap > REACH * layer_height else ():
            search = SolidMesh(body.vertices, body.triangles).searched(layer_height)
            back = search.signed(under.vertices)[0]
            if float(back.min()) < gap:
                gap, position = float(back.min()), under.vertices[int(back.argmin())]
        if gap > REACH * layer_height:
            x, y, z = (float(value) for value in position)
            issues.append(
                Issue(
                    WARNING,
                    ABOVE_SUBSTRATE,
                    Text(
                        "{} does not touch its substrate {}: the smallest gap is {:.4g} mm, at "
                        "({:.4g}, {:.4g}, {:.4g}); move the part onto the substrate, or remove "
                        "the substrate",
                        label,
                        substrate.label,
                        gap,
                        x,
                        y,
                        z,
                    ),
                )
            )
    return tuple(issues)
