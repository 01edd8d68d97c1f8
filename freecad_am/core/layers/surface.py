# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers: surfaces that can be flattened, and the regions of the part on them.

Filling works on the plane. An isometry wraps the beads onto the surface, so that spacings, areas
and angles within a layer equal those on the plane.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple, Protocol

import numpy as np

from ..geometry.on_hub import Base
from ..geometry.regions.region import Region
from ..geometry.regions.several import grow_regions, intersect_regions, subtract_regions
from ..geometry.regions.strip import Period, Strip
from ..issues import WARNING, Issue, Text
from ..parameters.filled import SolidParameters
from ..types import Array, Index


class Wrapped(NamedTuple):
    """Curve wrapped onto a surface.

    points: (n, 3) in the frame of the field, mm. normals: (n, 3) unit normals. turn: (n,) angle
    from the first direction of `axes` to the x axis of the plane, rad.
    """

    points: Array
    normals: Array
    turn: Array


class LayerSurface(Protocol):
    """Surface of a layer in the frame of the field (`on_hub.Base`)."""

    @property
    def period(self) -> Period | None:
        """Period of one turn around the surface, on the plane; None if the surface does not close.

        Regions with equal borders on surfaces with equal periods get equal beads.
        """

    @property
    def bends_freely(self) -> bool:
        """Whether the surface may bend sharply.

        If so, build directions may depart from the surface normals to limit the turn rate.
        """

    def unroll(self, points: Array) -> Array:
        """Unroll points of the surface.

        Parameters
        ----------
        points : (n, 3) array
            Points in the frame of the field, mm.

        Returns
        -------
        (n, 2) array
            Points of the plane, mm.
        """

    def wrap(self, flat: Array) -> Wrapped:
        """Wrap a curve (n, 2) of the plane onto the surface."""

    def heights(self, flat: Array) -> Array | None:
        """Return the layer heights at points.

        Parameters
        ----------
        flat : (n, 2) array
            Points of the plane, mm.

        Returns
        -------
        (n,) array or None
            Heights, mm; None if the layer height is constant.
        """

    def for_sheet(self, flat: Array, sheet: float) -> LayerSurface:
        """Return the surface for a curve that is unrolled about a sheet.

        Parameters
        ----------
        flat : (n, 2) array
            The curve on the plane, mm.
        sheet : float
            u (`strip.Period`) about which the curve is unrolled, mm.

        Returns
        -------
        LayerSurface
            This surface, unless it overlaps itself on the plane.
        """

    def plane_rotation(self, azimuth: float) -> float:
        """Return the rotation, rad, of the plane from a plane unrolled about `azimuth`, rad."""

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """Return the pieces (n - 1,) that edges of a polyline (n, 2) need for the chord error, mm."""

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """Return two perpendicular directions within the surface.

        Parameters
        ----------
        normals : (n, 3) array
            Unit normals.

        Returns
        -------
        x : (n, 3) array
            Unit vectors.
        left : (n, 3) array
            Unit vectors to the left of x, seen from outside.
        """


class Slice(NamedTuple):
    """Layer of a part.

    Attributes
    ----------
    number : int
        Layer number.
    base : Base
        Base that defines the frame of the layer.
    surface : LayerSurface
        Surface of the layer.
    regions : tuple of Region or Strip
        Regions on the plane, mm.
    issues : tuple of Issue
        Issues of the layer.
    azimuth : float
        Azimuth of the centre of the solid about the axis of the base, rad.
    buried : tuple of Region or None
        Regions away from top and bottom surfaces; None if not required.
    heights : tuple of float or None
        Minimum, mean and maximum layer height, mm; None if the layer height is constant.
    share_before : float
        Fraction of all layers that precede this layer.
    """

    number: int
    base: Base
    surface: LayerSurface
    regions: tuple[Region | Strip, ...]
    issues: tuple[Issue, ...] = ()
    azimuth: float = 0.0
    buried: tuple[Region, ...] | None = None
    heights: tuple[float, float, float] | None = None
    share_before: float = 0.0

    @property
    def borders(self) -> list[tuple[Array, bool]]:
        """Return the borders of the layer's regions.

        Returns
        -------
        list of ((n, 2) array, bool)
            Borders on the plane, mm, and whether each is closed. Borders on a strip are repeated in
            the adjacent turns.
        """
        curves = []
        for region in self.regions:
            if isinstance(region, Region):
                curves += [(border, True) for border in region.borders()]
                continue
            for border, turns in region.borders():
                if turns:
                    curves.append(
                        (
                            np.vstack(
                                [region.period.move_turns(border, k) for k in (-turns, 0, turns)]
                            ),
                            False,
                        )
                    )
                else:
                    curves += [(region.period.move_turns(border, k), True) for k in (-1, 0, 1)]
        return curves

    def where(self, point: Array) -> str:
        """Format a point of the plane.

        Parameters
        ----------
        point : (2,) array
            The point on the unrolled plane, mm.

        Returns
        -------
        str
            Coordinates of the point in the part.
        """
        return self.base.where(self.surface.wrap(point[None]).points[0])


CODE = "OVERHANG"
ARC = 0.1  # fraction of the allowed reach; arc error of compared borders, at least the chord error
NEVER = math.radians(89.9)  # maximum overhang; a limit of this or more disables the check
MIN_SIDE_SHARE = 0.25  # in bead spacings; side of the smallest square to report


def report_overhangs(slices: Iterable[Slice], strategy: SolidParameters) -> Iterator[Slice]:
    """Yield planar layers, with an issue for each layer that overhangs by more than `max_overhang`.

    The overhang angle is measured from the stacking direction. The issue reports the total area and
    the position of the largest region.
    """
    reach = strategy.layer_height * math.tan(strategy.max_overhang) + strategy.chord_error
    min_area = (MIN_SIDE_SHARE * strategy.bead_spacing) ** 2
    previous: Slice | None = None
    for layer in slices:
        issues = layer.issues
        if previous is not None and strategy.max_overhang < NEVER:
            over = _overhanging_regions(
                layer,
                previous if previous.number == layer.number - 1 else None,
                reach,
                strategy.chord_error,
                min_area,
            )
            if over:
                largest = max(over, key=lambda region: region.area)
                issues = (
                    *issues,
                    Issue(
                        WARNING,
                        CODE,
                        Text(
                            "{:.4g} mm^2 overhang the layer below by more than {:.4g} deg, the "
                            "largest piece at {}; deposit a support first, choose another "
                            "strategy.direction, or raise strategy.max_overhang",
                            math.fsum(region.area for region in over),
                            math.degrees(strategy.max_overhang),
                            layer.where(largest.inside()),
                        ),
                        layer.number,
                    ),
                )
        previous = layer
        yield layer._replace(issues=issues)


def _overhanging_regions(
    layer: Slice, below: Slice | None, reach: float, chord_error: float, min_area: float
) -> list[Region]:
    """Return the regions of a layer more than `reach` mm beyond the layer below."""
    own_regions, under = (
        [region for region in regions if isinstance(region, Region)]
        for regions in (layer.regions, () if below is None else below.regions)
    )
    carried = grow_regions(under, reach, max(ARC * reach, chord_error))
    return [
        remainder
        for remainder in subtract_regions(own_regions, carried)
        if remainder.area > min_area
    ]


def common_regions(neighbours: Sequence[Sequence[Region]]) -> tuple[Region, ...]:
    """Return the common regions of adjacent layers, which are away from top and bottom surfaces.

    Parameters
    ----------
    neighbours : sequence of sequence of Region
        Regions of each layer; a missing layer is an empty sequence.

    Returns
    -------
    tuple of Region
        The common regions; empty if any layer is missing.
    """
    if not all(neighbours):
        return ()
    common = tuple(neighbours[0])
    for neighbour in neighbours[1:]:
        common = intersect_regions(common, neighbour)
    return common


def mark_buried(slices: Iterator[Slice], thick: int) -> Iterator[Slice]:
    """Yield planar layers, each with the common regions of the `thick` layers below and above."""
    if not thick:
        yield from slices
        return
    nearby: deque[Slice] = deque(maxlen=2 * thick + 1)
    waiting: deque[Slice] = deque()
    for layer in slices:
        while waiting and waiting[0].number + thick < layer.number:
            yield _buried(waiting.popleft(), nearby, thick)
        nearby.append(layer)
        waiting.append(layer)
    for layer in waiting:
        yield _buried(layer, nearby, thick)


def _buried(layer: Slice, nearby: Sequence[Slice], thick: int) -> Slice:
    regions_by_number = {
        neighbour.number: [region for region in neighbour.regions if isinstance(region, Region)]
        for neighbour in nearby
    }
    return layer._replace(
        buried=common_regions(
            [
                regions_by_number.get(layer.number + k, [])
                for step in range(1, thick + 1)
                for k in (-step, step)
            ]
        )
    )
