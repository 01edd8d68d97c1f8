# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much of solids their beads lay, leave out, lay beside them, and lay twice."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from ...filling.cover import Cover, total
from ...geometry.beyond_hub import volume_beyond
from ...geometry.developable import Developable
from ...geometry.mesh.solid import SolidMesh
from ...geometry.obstacles import Body
from ...geometry.on_hub import SolidsOnHub
from ...parameters.filled import FilledParameters
from .beads import Wrapped


def of_layers(strategy: FilledParameters, covers: Sequence[Cover]) -> tuple[float, float, float]:
    """mm3 of all layers, of what beads leave of them, and of what of beads lies beside."""
    whole, left, outside, _ = (strategy.layer_height * area for area in total(covers))
    return whole, left, outside


def volumes(
    solids: SolidsOnHub, strategy: FilledParameters, covers: Sequence[Cover]
) -> tuple[float, float, float]:
    """mm3 of the part, of what beads leave of it, and of what of them lies beside it; what is cut of it counts as high as
    its layers, so that what is above the last cut is left, and what layers reach beyond it lies beside. A part to which a
    margin is added, or in solids that may overlap, is as large as its layers are."""
    whole, left, outside = of_layers(strategy, covers)
    part = None if strategy.margin else _outside(solids)
    if part is None:
        return whole, left, outside
    return part, left + max(part - whole, 0.0), outside + max(whole - part, 0.0)


def twice(made: Sequence[Wrapped], strategy: FilledParameters, covers: Sequence[Cover], width: float) -> float:
    """mm3 of beads that count as `width` mm wide, each as wide as they are apart, beyond what they cover."""
    area = 0.0
    for bead in (one.bead for one in made):
        step = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
        wide = np.full(len(bead), width) if bead.width is None else bead.width
        high = np.ones(len(bead)) if bead.height is None else bead.height / strategy.layer_height
        section = wide * high * strategy.bead_spacing / width
        area += float((0.5 * (section[1:] + section[:-1])) @ step)
    return max(area - total(covers).once, 0.0) * strategy.layer_height


def _outside(solids: SolidsOnHub) -> float | None:
    """mm3 of all solids outside of their hubs; None where they may overlap."""
    found = 0.0
    for group in solids.groups:
        surface = group.base.surface
        if isinstance(surface, Developable):  # those that overlap are refused
            found += sum(volume_beyond(surface, group.base.inside(body.vertices), body.triangles) for body in group.bodies)
        elif any(_may_meet(*pair) for pair in combinations(group.bodies, 2)):
            return None
        else:
            found += sum(abs(SolidMesh(body.vertices, body.triangles).volume) for body in group.bodies)
    return found


def _may_meet(one: Body, other: Body) -> bool:
    return bool((
        (one.vertices.min(axis=0) < other.vertices.max(axis=0)) & (other.vertices.min(axis=0) < one.vertices.max(axis=0))
    ).all())
