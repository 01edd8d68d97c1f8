# SPDX-License-Identifier: LGPL-2.1-or-later
"""Volume of a part between the planes of its layers, compared with the deposit there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.on_hub import Group, SolidsOnHub
from ..geometry.plane import Plane
from ..slicing.solids.plane_sections import PlaneCuts
from ..types import Array, Index

EXACT = 1e-6  # of a layer


class Slabs(NamedTuple):
    """Volumes of each layer (k,), mm3: the part from its plane to the next, and the deposit on
    it.

    The part below the first half of a layer at its top is a separate layer, which may have no
    deposit.
    """

    part_volume: Array
    deposited: Array


def group_of(solids: SolidsOnHub) -> Group | None:
    """Return the bodies in plane layers; None for other layers."""
    groups = solids.groups
    return groups[0] if len(groups) == 1 and isinstance(groups[0].base.surface, Plane) else None


def slabs(group: Group, layer_height: float, points: Array, volumes: Array) -> Slabs:
    """Return the volumes of bodies in plane layers.

    Deposits of the volumes (n,) mm3 end at points (n, 3) of the part on those planes. Bodies
    that overlap count twice there.
    """
    top = max(float(group.base.inside(body.vertices)[:, 2].max()) for body in group.bodies)
    layer = np.maximum(np.rint(group.base.inside(points)[:, 2] / layer_height), 0).astype(np.intp)
    used = int(layer[volumes > 0.0].max(initial=-1)) + 1
    count = max(int(np.ceil(top / layer_height - EXACT)), used)
    planes = layer_height * np.arange(count + 1)
    part_volumes = sum(
        (
            np.diff(volumes_below(group.base.inside(body.vertices), body.triangles, planes))
            for body in group.bodies
        ),
        np.zeros(count),
    )
    deposited: Array = np.bincount(
        layer[volumes > 0.0], volumes[volumes > 0.0], minlength=count
    ).astype(np.float64)
    return Slabs(part_volumes, deposited)


def volumes_below(vertices: Array, triangles: Index, heights: Sequence[float] | Array) -> Array:
    """Return the volumes (k,) mm3 of a closed mesh, with outward facets, below heights (k,).

    By the divergence of (0, 0, z - height), which is 0 on the plane itself: each facet counts
    by its part below.
    """
    corners = np.sort(vertices[triangles][..., 2], axis=1)
    edges = vertices[triangles][..., :2]
    across, along = edges[:, 1] - edges[:, 0], edges[:, 2] - edges[:, 0]
    area = 0.5 * (
        across[:, 0] * along[:, 1] - across[:, 1] * along[:, 0]
    )  # as seen from above, with its sign
    return np.array([_volume_below(corners, area, float(height)) for height in heights])


def _volume_below(corners: Array, area: Array, height: float) -> float:
    """Return the volume for facets whose corners (m, 3) rise from the first to the last."""
    low, middle, high = (corners[:, number] - height for number in range(3))
    fully_below = high <= 0.0
    total = float((area[fully_below] * (low + middle + high)[fully_below]).sum() / 3.0)
    cut = (low < 0.0) & ~fully_below
    one_below = cut & (middle >= 0.0)  # a corner below
    share = low[one_below] ** 2 / ((middle - low)[one_below] * (high - low)[one_below])
    total += float((area[one_below] * share * low[one_below]).sum() / 3.0)
    two_below = cut & (middle < 0.0)  # a corner above
    share = high[two_below] ** 2 / ((high - low)[two_below] * (high - middle)[two_below])
    upper_moment = (low + middle + high)[two_below] - share * high[two_below]
    return total + float((area[two_below] * upper_moment).sum() / 3.0)


def outline(group: Group, height: float) -> list[Array]:
    """Return the cut of the bodies by the plane `height` mm above the base: closed loops (n, 2),
    first point repeated.

    Each body is cut separately, in the frame of the base.
    """
    cuts = [PlaneCuts(group.base.inside(body.vertices), body.triangles) for body in group.bodies]
    loops = [loop for cut in cuts for loop in next(cut.loops([height]))]
    return [np.vstack([loop, loop[:1]]) for loop in loops]
