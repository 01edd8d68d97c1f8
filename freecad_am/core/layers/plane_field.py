# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cut bodies by parallel planes, together or separately, and compute the volumes of the layers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..geometry.developable import Plane
from ..geometry.obstacles import Body
from ..geometry.on_hub import Base, Group, SolidsOnHub
from ..geometry.regions.region import Region
from ..geometry.step_count import round_up
from ..issues import InputError, Issue
from ..parameters.filled import SolidParameters
from ..slicing.solids.plane_sections import PlaneCuts
from ..types import Array, Index
from .margins import sections
from .surface import Slice, Wrapped


class Flat:
    """Members of `LayerSurface` common to all planes."""

    @property
    def period(self) -> None:
        """None: a plane does not close."""
        return None

    @property
    def bends_freely(self) -> bool:
        """False: a plane does not bend."""
        return False

    def plane_rotation(self, azimuth: float) -> float:
        """Return 0: the plane has only one orientation."""
        return 0.0

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """Return 1 for each edge: edges stay straight."""
        return np.ones(len(flat) - 1, dtype=np.intp)


@dataclass(frozen=True)
class PlaneLayer(Flat):
    """Plane at a height, mm, along the Z of its frame, a `LayerSurface`.

    x and y of the plane are x and y of the frame.
    """

    height: float

    def unroll(self, points: Array) -> Array:
        """Return x and y, (n, 2), mm."""
        return points[:, :2].copy()

    def wrap(self, flat: Array) -> Wrapped:
        """Return the points at the height of the plane."""
        count = len(flat)
        points = np.column_stack([flat, np.full(count, self.height)])
        return Wrapped(points, np.tile([0.0, 0.0, 1.0], (count, 1)), np.zeros(count))

    def heights(self, flat: Array) -> None:
        """Return None: the layer height is constant."""

    def for_sheet(self, flat: Array, sheet: float) -> PlaneLayer:
        """Return this plane."""
        return self

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """Return the x and y axes of the plane."""
        count = len(normals)
        return np.tile([1.0, 0.0, 0.0], (count, 1)), np.tile([0.0, 1.0, 0.0], (count, 1))


CLEARANCE_SHARE = (
    0.02  # fraction of the chord error; minimum clearance of a plane from coplanar faces
)
ROUNDING = 4e-7  # fraction of the maximum coordinate; rounding of vertices stored as 32-bit floats
EXACT = 1e-6  # fraction of a layer; tolerance of layer counts
MAX_RISE_SHARE = (
    1e-3  # fraction of the facet size; maximum rise of a facet that counts as horizontal
)


def count(top: float, strategy: SolidParameters) -> int:
    """Return the number of layers of a part that reaches to `top` mm above the first plane.

    The count includes the layers cut below `top` and the layers of the margin. A cut exactly at
    `top` counts if `cut_at` is 'top'.
    """
    levels = top / strategy.layer_height - strategy.share_of_cut
    layers_cut = (
        math.floor(levels + EXACT) + 1 if strategy.cut_at == "top" else math.ceil(levels - EXACT)
    )
    return (
        layers_cut + max(round_up(strategy.margin / strategy.layer_height) - 1, 0)
        if layers_cut > 0
        else 0
    )


def slices(base: Base, bodies: Sequence[Body], strategy: SolidParameters) -> Iterator[Slice]:
    """Yield the layers of bodies upwards, on planes above the base.

    The planes are at 0, h, 2 h ... mm; layers without regions are skipped.

    Parameters
    ----------
    base : Base
        The base.
    bodies : sequence of Body
        The bodies.
    strategy : SolidParameters
        Layer height, cut, margin and chord error.

    Yields
    ------
    Slice
        The layers in order.

    Raises
    ------
    InputError
        TOO_LOW if no layer reaches into the bodies.
    """
    cuts = [PlaneCuts(base.inside(body.vertices), body.triangles) for body in bodies]
    top = max(cut.top for cut in cuts)
    layers = count(top, strategy)
    if not layers:
        points = np.vstack([cut.vertices for cut in cuts])
        raise InputError(
            "TOO_LOW",
            "strategy.layer_height",
            "{:g} mm is too high for {}, {:.4g} mm high along strategy.direction (top at {}): no "
            "layer is cut in its {}; use at most {:.3g} mm",
            strategy.layer_height,
            ", ".join(body.name for body in bodies),
            top,
            base.where(points[points[:, 2].argmax()]),
            strategy.cut_at,
            0.99 * top / max(strategy.share_of_cut, 0.001),
        )
    for number, regions, issues in cut_together(cuts, layers, strategy):
        yield Slice(
            number,
            base,
            PlaneLayer(number * strategy.layer_height),
            regions,
            issues,
            share_before=number / layers,
        )


def cut_together(
    cuts: Sequence[PlaneCuts], layers: int, strategy: SolidParameters
) -> Iterator[tuple[int, tuple[Region, ...], tuple[Issue, ...]]]:
    """Yield the regions of each layer of bodies; empty layers are skipped.

    Parameters
    ----------
    cuts : sequence of PlaneCuts
        The bodies prepared for sections.
    layers : int
        Number of layers.
    strategy : SolidParameters
        Layer height, cut, margin and chord error.

    Yields
    ------
    number : int
        Layer number.
    regions : tuple of Region
        Regions of the layer, mm.
    issues : tuple of Issue
        Repairs.
    """
    heights: Array = strategy.layer_height * (
        np.arange(layers, dtype=np.float64) + strategy.share_of_cut
    )
    return sections([cut.loops(_off_faces(cut, heights, strategy)) for cut in cuts], strategy)


def _off_faces(cut: PlaneCuts, heights: Array, strategy: SolidParameters) -> Array:
    """Move heights off coplanar facets, because rounding would decide a cut through such facets.

    The heights move slightly upwards, or downwards if `cut_at` is 'top'.
    """
    aside = max(
        CLEARANCE_SHARE * strategy.chord_error,
        ROUNDING * float(np.abs(cut.vertices).max(initial=0.0)),
    )
    corners = cut.vertices[cut.faces]
    low, high = corners[..., 2].min(axis=1), corners[..., 2].max(axis=1)
    size = np.ptp(corners[..., :2], axis=1).max(axis=1)
    lying = np.sort(
        0.5 * (low + high)[(high - low < aside) & (high - low <= MAX_RISE_SHARE * size)]
    )
    is_near = np.searchsorted(lying, heights - aside) < np.searchsorted(
        lying, heights + aside, side="right"
    )
    return np.where(is_near, heights + (-2.0 if strategy.cut_at == "top" else 2.0) * aside, heights)


# ---- Volume of a part between layer planes, for comparison with the deposited volume


class Slabs(NamedTuple):
    """Volumes of each layer (k,), mm3.

    part_volume: volume of the part from the plane of the layer to the next plane. deposited: volume
    of the deposit on the plane. An incomplete layer at the top of the part counts as a layer, even
    without deposit.
    """

    part_volume: Array
    deposited: Array


def group_of(solids: SolidsOnHub) -> Group | None:
    """Return the group of bodies in planar layers; None for other layers."""
    groups = solids.groups
    return groups[0] if len(groups) == 1 and isinstance(groups[0].base.surface, Plane) else None


def slabs(group: Group, layer_height: float, points: Array, volumes: Array) -> Slabs:
    """Return the volumes of bodies and deposit in planar layers.

    Overlaps of bodies count twice.

    Parameters
    ----------
    group : Group
        The bodies and their base.
    layer_height : float
        Layer height, mm.
    points : (n, 3) array
        Ends of deposits on the planes, in part coordinates, mm.
    volumes : (n,) array
        Volumes of the deposits, mm3.

    Returns
    -------
    Slabs
        Volumes of each layer.
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
    """Return the volumes of a closed mesh below heights.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles with outward normals.
    heights : (k,) array
        Heights, mm.

    Returns
    -------
    (k,) array
        Volumes, mm3.

    Notes
    -----
    Divergence theorem with the field (0, 0, z - height), which is 0 on the plane. Thus only the
    part of each facet below the plane contributes.
    """
    corners = np.sort(vertices[triangles][..., 2], axis=1)
    edges = vertices[triangles][..., :2]
    across, along = edges[:, 1] - edges[:, 0], edges[:, 2] - edges[:, 0]
    # signed area of the projection onto the plane
    area = 0.5 * (across[:, 0] * along[:, 1] - across[:, 1] * along[:, 0])
    return np.array([_volume_below(corners, area, float(height)) for height in heights])


def _volume_below(corners: Array, area: Array, height: float) -> float:
    """Return the volume below `height` for facets with ascending corner heights (m, 3)."""
    low, middle, high = (corners[:, number] - height for number in range(3))
    fully_below = high <= 0.0
    total = float((area[fully_below] * (low + middle + high)[fully_below]).sum() / 3.0)
    cut = (low < 0.0) & ~fully_below
    one_below = cut & (middle >= 0.0)  # one corner below
    share = low[one_below] ** 2 / ((middle - low)[one_below] * (high - low)[one_below])
    total += float((area[one_below] * share * low[one_below]).sum() / 3.0)
    two_below = cut & (middle < 0.0)  # one corner above
    share = high[two_below] ** 2 / ((high - low)[two_below] * (high - middle)[two_below])
    upper_moment = (low + middle + high)[two_below] - share * high[two_below]
    return total + float((area[two_below] * upper_moment).sum() / 3.0)


def outline(group: Group, height: float) -> list[Array]:
    """Cut bodies by a plane above the base.

    Parameters
    ----------
    group : Group
        The bodies and their base.
    height : float
        Height above the base, mm.

    Returns
    -------
    list of (n, 2) array
        Closed loops in the frame of the base, mm, with repeated first point. Each body is cut
        separately.
    """
    cuts = [PlaneCuts(group.base.inside(body.vertices), body.triangles) for body in group.bodies]
    loops = [loop for cut in cuts for loop in next(cut.loops([height]))]
    return [np.vstack([loop, loop[:1]]) for loop in loops]
