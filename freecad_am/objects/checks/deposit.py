# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks of a deposit: regions of a part that it would leave out, its distance from the part, its
contact with the substrate."""

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
    """Findings about the result of a feature (and its object, if given), with the beads of its
    toolpath, else with beads of a new one.
    """
    return deposit_balance.issues(deposit_balance.feature_balance(value, bead_width(feature)))


def bead_width(feature: Any = None) -> float:
    """Bead width of the toolpath of a feature, else of a new one, mm."""
    for following in () if feature is None else feature.InList:
        stage = stage_of(following)
        if stage is not None and stage.kind == "toolpath":
            return float(stage.parameters(following, ProcessParameters).bead_width)
    return float(preferences.process().get("bead_width", ProcessParameters().bead_width))


# ---- Distance of a finished toolpath from the shapes that it was made for

LOOKED = 0.95  # of the time, after planning


def check_on_part(toolpath: CoreToolpath, inputs: Given, sources: Sequence[Taken]) -> CoreToolpath:
    """The toolpath with a judgement of its distance from the shapes that it was made for; unchanged
    if these have no faces.
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
    ):  # these layers follow the scan and are no farther off than they were moved
        from ...core.inspection.fit_layers import max_moves  # jobs without a scan need none of it

        off = np.maximum(off - max_moves(toolpath.checks.fitted, places.layer), 0.0)
    return on_part.check_on_part(toolpath, places, off, limit)


# ---- Whether a deposit touches its named substrate

REACH = (
    1.5  # layer heights; a deposit this near to a body counts as supported by it, as in `support`
)


def gap_issues(
    label: str,
    deposited: Sequence[Body],
    points: Sequence[Array],
    ground: Sequence[Taken],
    layer_height: float,
) -> tuple[Issue, ...]:
    """A warning where nothing of bodies, or of points (n, 3) of curves, is near the substrate that is named, with how far it
    is and where it comes nearest."""
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
                        "({:.4g}, {:.4g}, {:.4g}); move it onto the substrate, or remove the "
                        "substrate",
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
