# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which beads of a layer run along its outlines, and to which side the torch leans on them."""

from __future__ import annotations

import math

import numpy as np

from ...filling.curve import PlaneCurve
from ...geometry.curves.plane_curve import nearest_among, sines, steps
from ...layers.surface import Slice
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.filled import FilledParameters
from .lean import Lean

OUTLINE = 0.55  # of the bead spacing; beads along an outline are half a spacing inside, the next are farther
PROBES = 9  # the longest edges, which decide the side of the outline


def leaning(
    curve: PlaneCurve, layer: Slice, strategy: FilledParameters, build: BuildDirectionParameters
) -> Lean:
    """How the torch leans on a curve: as the build direction says, and by the deflection towards the outline where the curve
    is a contour or a spiral that begins along it, a spiral for as long as it does."""
    plain = Lean(build.lead, build.tilt)
    if strategy.deflection == 0.0 or curve.kind not in ("contour", "spiral") or curve.ring > 0:
        return plain
    count, until = len(curve.points), math.inf
    if not curve.closed:
        adjacent = nearest_among(layer.borders, curve.points)[1] < OUTLINE * strategy.bead_spacing
        count = len(adjacent) if adjacent.all() else int(np.argmin(adjacent))
        if count < 2:
            return plain
        if count < len(adjacent):
            until = float(np.hypot(*steps(curve.points[:count], False).T).sum())
    edges = steps(curve.points[:count], curve.closed and not curve.turns)
    longest = np.argsort(-np.hypot(*edges.T), kind="stable")[:PROBES]
    middle = curve.points[longest] + 0.5 * edges[longest]
    is_left = (
        sines(edges[longest], nearest_among(layer.borders, middle)[0] - middle).sum() > 0.0
    )  # the outline, of the curve
    side = -1.0 if is_left else 1.0
    return Lean(build.lead, build.tilt + side * strategy.deflection, build.tilt, until)
