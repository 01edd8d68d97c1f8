# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a part has between the planes of its layers, beside what is deposited there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...geometry.on_hub import Group, SolidsOnHub
from ...geometry.plane import Plane
from ...slicing.solids.plane_sections import PlaneCuts
from ...types import Array, Index

EXACT = 1e-6  # of a layer


class Slabs(NamedTuple):
    """Of each layer (k,), mm3: what the part has from its plane to the next, and what is deposited on it. What the part has
    below the first half of a layer at its top is a layer of its own, on which nothing may be deposited."""

    part: Array
    deposited: Array


def group_of(solids: SolidsOnHub) -> Group | None:
    """The bodies in plane layers, None where layers are others."""
    groups = solids.groups
    return groups[0] if len(groups) == 1 and isinstance(groups[0].base.surface, Plane) else None


def slabs(group: Group, layer_height: float, points: Array, volumes: Array) -> Slabs:
    """Of bodies in plane layers, where deposit of the volumes (n,) mm3 ends at points (n, 3) of the part on those planes.
    Bodies that overlap count twice where they do."""
    top = max(float(group.base.inside(body.vertices)[:, 2].max()) for body in group.bodies)
    layer = np.maximum(np.rint(group.base.inside(points)[:, 2] / layer_height), 0).astype(np.intp)
    used = int(layer[volumes > 0.0].max(initial=-1)) + 1
    count = max(int(np.ceil(top / layer_height - EXACT)), used)
    planes = layer_height * np.arange(count + 1)
    part = sum(
        (
            np.diff(below(group.base.inside(body.vertices), body.triangles, planes))
            for body in group.bodies
        ),
        np.zeros(count),
    )
    deposited: Array = np.bincount(
        layer[volumes > 0.0], volumes[volumes > 0.0], minlength=count
    ).astype(np.float64)
    return Slabs(part, deposited)


def below(vertices: Array, triangles: Index, heights: Sequence[float] | Array) -> Array:
    """(k,) mm3 of a closed mesh, its facets turned outwards, that lie below heights (k,).

    By the divergence of (0, 0, z - height), which is 0 on the plane itself: each facet counts by what of it lies below.
    """
    corners = np.sort(vertices[triangles][..., 2], axis=1)
    edges = vertices[triangles][..., :2]
    across, along = edges[:, 1] - edges[:, 0], edges[:, 2] - edges[:, 0]
    area = 0.5 * (
        across[:, 0] * along[:, 1] - across[:, 1] * along[:, 0]
    )  # as seen from above, with its sign
    return np.array([_below(corners, area, float(height)) for height in heights])


def _below(corners: Array, area: Array, height: float) -> float:
    """Of facets whose corners (m, 3) rise from the first to the last."""
    low, middle, high = (corners[:, number] - height for number in range(3))
    whole = high <= 0.0
    total = float((area[whole] * (low + middle + high)[whole]).sum() / 3.0)
    cut = (low < 0.0) & ~whole
    one = cut & (middle >= 0.0)  # a corner below
    share = low[one] ** 2 / ((middle - low)[one] * (high - low)[one])
    total += float((area[one] * share * low[one]).sum() / 3.0)
    two = cut & (middle < 0.0)  # a corner above
    share = high[two] ** 2 / ((high - low)[two] * (high - middle)[two])
    rest = (low + middle + high)[two] - share * high[two]
    return total + float((area[two] * rest).sum() / 3.0)


def outline(group: Group, height: float) -> list[Array]:
    """Where the plane `height` mm above that of the base cuts the bodies: closed loops (n, 2) of its frame, the first point
    repeated, each body by itself."""
    cuts = [PlaneCuts(group.base.inside(body.vertices), body.triangles) for body in group.bodies]
    found = [loop for cut in cuts for loop in next(cut.loops([height]))]
    return [np.vstack([loop, loop[:1]]) for loop in found]
