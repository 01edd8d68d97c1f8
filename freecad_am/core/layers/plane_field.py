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
from ..geometry.ramps import limit_growth
from ..geometry.regions.region import Region
from ..geometry.step_count import round_up
from ..issues import InputError, Issue
from ..parameters.filled import SolidParameters
from ..slicing.solids.plane_sections import PlaneCuts
from ..types import Array, Index, Mask
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

    x and y of the plane are x and y of the frame. layer_height: mm, None if it is constant.
    """

    height: float
    layer_height: float | None = None

    def unroll(self, points: Array) -> Array:
        """Return x and y, (n, 2), mm."""
        return points[:, :2].copy()

    def wrap(self, flat: Array) -> Wrapped:
        """Return the points at the height of the plane."""
        count = len(flat)
        points = np.column_stack([flat, np.full(count, self.height)])
        return Wrapped(points, np.tile([0.0, 0.0, 1.0], (count, 1)), np.zeros(count))

    def heights(self, flat: Array) -> Array | None:
        """Return the layer height at points, None if it is constant."""
        return None if self.layer_height is None else np.full(len(flat), self.layer_height)

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


class Levels(NamedTuple):
    """Layers that adapt their heights to the slope of a part, from the base up.

    planes, heights: (k,) height of the plane of each layer above the base, and layer height, mm.
    top: height of the part, mm. cusp: largest cusp of all layers, mm. constant: layer height, mm,
    with which layers of one height have this cusp.
    """

    planes: Array
    heights: Array
    top: float
    cusp: float
    constant: float

    def cuts(self, share: float) -> Array:
        """Return the heights at which the part is cut.

        Parameters
        ----------
        share : float
            Height of the cut above the plane of a layer, as a share of its height.

        Returns
        -------
        (k,) array
            Heights above the base, mm.
        """
        return self.planes + share * self.heights

    def layers_of(self, levels: Array) -> Index:
        """Return the layers that contain heights.

        Parameters
        ----------
        levels : (n,) array
            Heights above the base, mm.

        Returns
        -------
        (n,) array of int
            Indices of layers.
        """
        return np.maximum(np.searchsorted(self.planes, levels, side="right") - 1, 0)


def slices(
    base: Base, bodies: Sequence[Body], strategy: SolidParameters, levels: Levels | None = None
) -> Iterator[Slice]:
    """Yield the layers of bodies upwards, on planes above the base.

    The planes are at 0, h, 2 h ... mm, or at levels; layers without regions are skipped.

    Parameters
    ----------
    base : Base
        The base.
    bodies : sequence of Body
        The bodies.
    strategy : SolidParameters
        Layer height, cut, margin and chord error.
    levels : Levels or None, optional
        Layers that adapt their heights; None for layers of one height.

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
    if levels is not None:
        for number, regions, issues in cut_together(
            cuts, len(levels.planes), strategy, levels.cuts(strategy.share_of_cut)
        ):
            height = float(levels.heights[number])
            surface = PlaneLayer(float(levels.planes[number]), height)
            yield Slice(
                number,
                base,
                surface,
                regions,
                issues,
                heights=(height, height, height),
                share_before=number / len(levels.planes),
            )
        return
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
    cuts: Sequence[PlaneCuts],
    layers: int,
    strategy: SolidParameters,
    heights: Array | None = None,
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
    heights : (layers,) array or None, optional
        Heights of the cuts, mm; None for layers of one height.

    Yields
    ------
    number : int
        Layer number.
    regions : tuple of Region
        Regions of the layer, mm.
    issues : tuple of Issue
        Repairs.
    """
    if heights is None:
        heights = strategy.layer_height * (
            np.arange(layers, dtype=np.float64) + strategy.share_of_cut
        )
    return sections([cut.loops(_off_faces(cut, heights, strategy)) for cut in cuts], strategy)


def _off_faces(cut: PlaneCuts, heights: Array, strategy: SolidParameters) -> Array:
    """Move heights off coplanar facets, because rounding would decide a cut through such facets.

    The heights move slightly upwards, or downwards if `cut_at` is 'top'.
    """
    aside = _clearance(cut.vertices, strategy)
    corners = cut.vertices[cut.faces]
    low, high = corners[..., 2].min(axis=1), corners[..., 2].max(axis=1)
    lying = np.sort(0.5 * (low + high)[_is_horizontal(corners, aside)])
    is_near = np.searchsorted(lying, heights - aside) < np.searchsorted(
        lying, heights + aside, side="right"
    )
    return np.where(is_near, heights + (-2.0 if strategy.cut_at == "top" else 2.0) * aside, heights)


def _clearance(vertices: Array, strategy: SolidParameters) -> float:
    """Return the minimum clearance of a plane from coplanar faces of vertices (n, 3), mm."""
    return max(
        CLEARANCE_SHARE * strategy.chord_error,
        ROUNDING * float(np.abs(vertices).max(initial=0.0)),
    )


def _is_horizontal(corners: Array, aside: float) -> Mask:
    """Whether facets (m, 3, 3) count as horizontal: they rise by less than `aside`, mm."""
    rise = np.ptp(corners[..., 2], axis=1)
    size = np.ptp(corners[..., :2], axis=1).max(axis=1)
    return np.asarray((rise < aside) & (rise <= MAX_RISE_SHARE * size))


# ---- Layers that adapt their heights to the slope of the part (Dolenc and Makela 1994)

CHANGE = 0.2  # fraction of a layer's height by which the next layer may differ
STEPS, MAX_STEPS = 100, 100_000  # steps of the least height, and of the whole part at most
HALVINGS = 50  # of the factor with which layers end at the top of the part


class _Slopes(NamedTuple):
    """Facets that are not horizontal: lowest and highest point (m,), mm, and |z| of their unit normals (m,).

    middle: (m, 3) centroids in the frame of the base, mm.
    """

    low: Array
    high: Array
    flatness: Array
    middle: Array


def find_levels(group: Group, strategy: SolidParameters) -> Levels:
    """Return the highest layers of a part whose cusps stay below a limit.

    The cusp is the height of the step between two layers, measured normal to the surface: layer
    height times |cos| of the angle between the surface normal and the stacking direction, at the
    flattest facet of the layer. Horizontal facets have no steps. Heights change by at most `CHANGE`
    from layer to layer, and all layers are lowered together so that the last ends at the top.

    Parameters
    ----------
    group : Group
        The bodies and their base.
    strategy : SolidParameters
        Least and most height, cusp and cut.

    Returns
    -------
    Levels
        The layers.

    Raises
    ------
    InputError
        TOO_LOW if no layer reaches into the bodies, CUSP if a layer of the least height has a
        larger cusp.

    References
    ----------
    Dolenc and Makela 1994, Slicing procedures for layered manufacturing techniques.
    """
    slopes, top = _slopes(group, strategy)
    lowest = strategy.lowest_height
    if not strategy.share_of_cut * lowest < top - EXACT * lowest:
        raise InputError(
            "TOO_LOW",
            "strategy.layer_height",
            "the least height, {:g} mm, is too high for {}, {:.4g} mm high along "
            "strategy.direction: no layer is cut in its {}; use at most {:.3g} mm",
            lowest,
            ", ".join(body.name for body in group.bodies),
            top,
            strategy.cut_at,
            0.99 * top / max(strategy.share_of_cut, 0.001),
        )
    planes, heights = _stack_layers(*_limit_heights(slopes, top, strategy), top, lowest)
    cuts = planes + strategy.share_of_cut * heights
    slack = EXACT * heights
    is_cut = cuts <= top + slack if strategy.cut_at == "top" else cuts < top - slack
    planes, heights = planes[is_cut], heights[is_cut]
    flattest = _flattest(slopes, planes, heights)
    cusps = np.zeros(len(planes))
    slanted = flattest >= 0  # layers between vertical walls only meet no other facet
    cusps[slanted] = (heights * slopes.flatness[flattest])[slanted] if slanted.any() else 0.0
    _refuse_cusps(group.base, slopes, flattest, heights, cusps, strategy)
    cusp, greatest = float(cusps.max()), float(slopes.flatness.max(initial=0.0))
    constant = strategy.layer_height
    if greatest > 0.0:
        constant = min(constant, cusp / greatest)
    return Levels(planes, heights, top, cusp, constant)


def _slopes(group: Group, strategy: SolidParameters) -> tuple[_Slopes, float]:
    """Return the slopes of the facets above the base, and the height of the part, mm."""
    all_corners = []
    top = 0.0
    for body in group.bodies:
        vertices = group.base.inside(body.vertices)
        top = max(top, float(vertices[:, 2].max()))
        corners = vertices[body.triangles]
        all_corners.append(corners[~_is_horizontal(corners, _clearance(vertices, strategy))])
    corners = np.concatenate(all_corners)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1)
    low, high = corners[..., 2].min(axis=1), corners[..., 2].max(axis=1)
    rows = (size > 0.0) & (high > 0.0)
    flatness = np.abs(normal[rows, 2]) / size[rows]
    return _Slopes(low[rows], high[rows], flatness, corners[rows].mean(axis=1)), top


def _limit_heights(slopes: _Slopes, top: float, strategy: SolidParameters) -> tuple[Array, Array]:
    """Return levels (k,) and the permitted height (k,) of a layer that begins there, mm.

    Between levels the permitted heights are linear, never above those of the facets that the layer
    meets, and change by `CHANGE` per mm of level.
    """
    assert strategy.cusp is not None
    lowest, highest = strategy.lowest_height, strategy.layer_height
    step = max(lowest / STEPS, top / MAX_STEPS)
    count = math.ceil(top / step - EXACT) + 1
    with np.errstate(divide="ignore"):
        ceiling = np.minimum(strategy.cusp / slopes.flatness, highest)
    first = np.clip(np.floor(slopes.low / step), 0, count - 1).astype(np.intp)
    last = np.clip(np.ceil(slopes.high / step) - 1.0, first, count - 1).astype(np.intp)
    in_bin = _lowest_over(first, last, ceiling, count, highest)
    permitted = in_bin.copy()
    for ahead in range(1, int(highest / step) + 2):  # a layer may end before flatter facets begin
        reach = (ahead - 1) * step
        if ahead >= count or reach >= highest:
            break
        np.minimum(permitted[:-ahead], np.maximum(in_bin[ahead:], reach), out=permitted[:-ahead])
    at_ends = np.minimum(np.r_[permitted[:1], permitted], np.r_[permitted, permitted[-1:]])
    levels = step * np.arange(count + 1)
    return levels, limit_growth(np.clip(at_ends, lowest, highest), CHANGE * levels)


def _lowest_over(first: Index, last: Index, ceiling: Array, places: int, highest: float) -> Array:
    """Return the lowest ceiling (m,) at each of the places; each ceiling spans `first` to `last`.

    Places without a ceiling have `highest`. Each span is covered by two spans whose length is a power of
    two, which pass their ceiling on to their halves.
    """
    power = np.frexp(last - first + 1)[1] - 1
    powers = int(power.max(initial=0))
    lowest_ceiling = np.full((powers + 1, places), highest)
    np.minimum.at(lowest_ceiling, (power, first), ceiling)
    np.minimum.at(lowest_ceiling, (power, last - (1 << power) + 1), ceiling)
    for level in range(powers, 0, -1):
        half = 1 << (level - 1)
        np.minimum(lowest_ceiling[level - 1], lowest_ceiling[level], out=lowest_ceiling[level - 1])
        np.minimum(
            lowest_ceiling[level - 1, half:],
            lowest_ceiling[level, :-half],
            out=lowest_ceiling[level - 1, half:],
        )
    return np.asarray(lowest_ceiling[0])


def _stack_layers(
    levels: Array, permitted: Array, top: float, lowest: float
) -> tuple[Array, Array]:
    """Return planes and heights (k,), mm, of layers that end at the top, or less than `lowest` above it."""

    def layers(factor: float, count: int | None) -> list[float]:
        planes = [0.0]
        while len(planes) <= count if count else planes[-1] < top - EXACT * lowest:
            height = factor * float(np.interp(planes[-1], levels, permitted))
            planes.append(planes[-1] + max(lowest, height))
        return planes

    planes = layers(1.0, None)
    count = len(planes) - 1
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        factor = 0.5 * (low + high)
        trial = layers(factor, count)
        if trial[-1] >= top:
            high, planes = factor, trial
        else:
            low = factor
    return np.array(planes[:-1]), np.diff(planes)


def _flattest(slopes: _Slopes, planes: Array, heights: Array) -> Index:
    """Return the flattest facet (k,) of each layer, -1 without any."""
    order = np.argsort(slopes.low)
    low, high, flatness = (column[order] for column in slopes[:3])
    ends = np.searchsorted(low, planes + (1.0 - EXACT) * heights)
    flattest = np.full(len(planes), -1, dtype=np.intp)
    for layer, (plane, height, end) in enumerate(zip(planes, heights, ends, strict=True)):
        flat = np.where(high[:end] > plane + EXACT * height, flatness[:end], -1.0)
        if len(flat) and flat.max() >= 0.0:
            flattest[layer] = order[int(flat.argmax())]
    return flattest


def _refuse_cusps(
    base: Base,
    slopes: _Slopes,
    flattest: Index,
    heights: Array,
    cusps: Array,
    strategy: SolidParameters,
) -> None:
    """Raise InputError CUSP at the layer with the largest cusp if it exceeds the limit."""
    assert strategy.cusp is not None
    high = np.flatnonzero(cusps > strategy.cusp * (1.0 + EXACT))
    if not len(high):
        return
    worst = int(cusps.argmax())
    flatness = float(slopes.flatness[flattest[worst]])
    raise InputError(
        "CUSP",
        "strategy.cusp",
        "{:g} mm is exceeded in {} of {} layers: layer {}, {:.4g} mm high, has a step of {:.4g} mm "
        "normal to the surface at {}; set strategy.cusp to {} mm, or the least "
        "strategy.layer_height to {} mm",
        strategy.cusp,
        len(high),
        len(heights),
        worst,
        heights[worst],
        cusps[worst],
        base.where(slopes.middle[flattest[worst]]),
        f"{math.ceil(1e3 * cusps[worst]) / 1e3:g}",
        f"{math.floor(1e3 * strategy.cusp / flatness) / 1e3:g}",
    )


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


def slabs(group: Group, layer_height: float | Array, points: Array, volumes: Array) -> Slabs:
    """Return the volumes of bodies and deposit in planar layers.

    Overlaps of bodies count twice.

    Parameters
    ----------
    group : Group
        The bodies and their base.
    layer_height : float or (l,) array
        Layer height, or the heights of all layers, mm.
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
    levels = group.base.inside(points)[:, 2]
    if isinstance(layer_height, np.ndarray):
        planes = np.r_[0.0, np.cumsum(layer_height)]
        if planes[-1] < top - EXACT * float(layer_height[-1]):
            planes = np.r_[planes, top]
        count = len(planes) - 1
        layer = np.searchsorted(0.5 * (planes[1:-1] + planes[:-2]), levels)
    else:
        layer = np.maximum(np.rint(levels / layer_height), 0).astype(np.intp)
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
