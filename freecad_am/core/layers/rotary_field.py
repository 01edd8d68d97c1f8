# SPDX-License-Identifier: LGPL-2.1-or-later
"""The field of equidistant cylinders or cones around a hub: cut, unroll, grow by the margin
(Dai 2020, section 2).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..geometry.columns import columns
from ..geometry.developable import Developable
from ..geometry.frames import TURN
from ..geometry.obstacles import Body
from ..geometry.on_hub import Base, middle_azimuth
from ..geometry.regions.region import Region, regions
from ..geometry.regions.several import grow_regions
from ..geometry.regions.strip import Period, Strip, strips
from ..issues import InputError
from ..parameters.filled import FilledParameters
from ..slicing.solids.equidistant import Facets, Loop, count, cut, unroll_layers
from ..types import Array, Index
from .margins import ARCS, regions_of, within_margin
from .surface import Slice, Wrapped, common_regions


@dataclass(frozen=True)
class RoundLayer:
    """A cylinder or cone about the Z of its frame. middle: azimuth (rad) of x = 0 on the plane. As `LayerSurface`."""

    surface: Developable
    middle: float = 0.0

    @property
    def period(self) -> Period:
        """A turn: a length of a cylinder, an angle about the apex of a cone."""
        if self.surface.is_cylinder:
            return Period(TURN * self.surface.radius)
        return Period(self.surface.flat_turn, self.surface.slant)

    @property
    def bends_freely(self) -> bool:
        """False: it bends as its hub does."""
        return False

    def unroll(self, points: Array) -> Array:
        """(n, 2) mm."""
        return self.surface.unroll(points, self.middle)

    def wrap(self, flat: Array) -> Wrapped:
        """Wrap a flat curve; its azimuths are unwrapped beyond a full turn."""
        theta, z = _unwrapped(flat, self.surface)
        rho = (
            np.full(len(z), self.surface.radius)
            if self.surface.is_cylinder
            else ((self.surface.height - z) * math.tan(self.surface.taper))
        )
        angle = theta + self.middle
        points = np.stack([rho * np.cos(angle), rho * np.sin(angle), z], axis=1)
        return Wrapped(points, self.surface.normals(points), theta * math.sin(self.surface.taper))

    def heights(self, flat: Array) -> None:
        """Return None: the layer height is the same everywhere."""

    def for_sheet(self, flat: Array, sheet: float) -> RoundLayer:
        """Return the surface for a curve about `sheet`: on a wide cone a curve may pass behind the
        apex, which the plane does not show.
        """
        if self.surface.is_cylinder:
            return replace(self, middle=self.middle + 0.0)
        sine = math.sin(self.surface.taper)
        angle = sheet / self.surface.slant - float(_unwrapped(flat, self.surface)[0].mean()) * sine
        return replace(self, middle=self.middle + TURN * round(angle / TURN) / sine)

    def plane_rotation(self, azimuth: float) -> float:
        """Return the rotation for a cone; the plane of a cylinder is only shifted."""
        return (self.middle - azimuth) * math.sin(self.surface.taper)

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """Return the pieces of each edge, a geodesic: its curvature is that of the surface around
        the axis times its squared share of that direction.
        """
        edge = np.diff(flat, axis=0)
        length = np.linalg.norm(edge, axis=1)
        theta, z = _unwrapped(flat, self.surface)
        phi = theta * math.sin(self.surface.taper)
        along, across = columns(edge)
        heading = np.arctan2(across, along)
        share = np.maximum(np.abs(np.cos(heading - phi[:-1])), np.abs(np.cos(heading - phi[1:])))
        share = np.minimum(share + np.abs(np.diff(phi)), 1.0)
        rho = (
            np.full(len(z), self.surface.radius)
            if self.surface.is_cylinder
            else ((self.surface.height - z) * math.tan(self.surface.taper))
        )
        # an edge comes nearer to the apex than its ends by no more than its sagitta seen from there
        min_rho = np.minimum(rho[:-1], rho[1:]) * np.cos(0.5 * np.abs(np.diff(phi)))
        curvature = math.cos(self.surface.taper) * share**2 / min_rho
        count = np.maximum(np.ceil(length * np.sqrt(curvature / (8.0 * chord_error)) - 1e-9), 1.0)
        return np.asarray(count.astype(np.intp))

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """Around the axis, and up along the surface."""
        x, y = columns(normals[:, :2])
        level = np.hypot(x, y)
        around = np.stack([-y / level, x / level, np.zeros(len(x))], axis=1)
        return around, np.cross(normals, around)


def _unwrapped(flat: Array, surface: Developable) -> tuple[Array, Array]:
    """Azimuth and height (n,) along a curve (n, 2) on the plane, the azimuth counted on where the curve goes far round."""
    theta, z = surface.from_unrolled(flat)
    if surface.is_cylinder:
        return theta, z
    sine = math.sin(surface.taper)
    return np.unwrap(theta * sine) / sine, z


CUT = 0.25  # share of the chord error, of cuts


def slices(base: Base, body: Body, strategy: FilledParameters) -> Iterator[Slice]:
    """Yield the layers of a solid from the hub outwards.

    The layers are at 0, h, 2 h ... mm from the hub; layers without regions are left out.

    Parameters
    ----------
    base : Base
        The hub.
    body : Body
        The solid.
    strategy : FilledParameters
        Layer height, margin and chord error.

    Yields
    ------
    Slice
        The layers in order.

    Raises
    ------
    InputError
        APEX_INSIDE, TOO_FAR_ROUND.
    """
    assert isinstance(base.surface, Developable)
    azimuth = middle_azimuth(base, body.vertices)
    facets = Facets(base.surface, base.inside(body.vertices), body.triangles, body.name)
    error, height = strategy.chord_error, strategy.layer_height
    below: list[list[Loop]] = []
    ahead: list[list[Loop]] = []
    layers, thick = count(facets, height, strategy.margin, error), strategy.thick
    for number in range(layers):
        while len(ahead) <= thick and number + len(ahead) < layers:
            ahead.append(cut(facets, (number + len(ahead)) * height, CUT * error))
        loops = ahead.pop(0)
        where = f"{body.name} layer {number}"
        surface = base.surface.offset(number * height)
        if sum(loop.turns for loop in loops):
            raise InputError(
                "APEX_INSIDE",
                where,
                "the solid crosses the hub axis beyond its end, at {}, where equidistant "
                "surfaces have an apex or an end; end the solid before the axis",
                base.where(_apex(loops, surface)),
            )
        below.append(loops)
        lots = within_margin(below, height, strategy.margin, facets.offset_loops)
        if any(loop.turns for _, loops in lots for loop in loops):
            buried = () if thick > min(number, layers - 1 - number) else None
            layer = Slice(
                number,
                base,
                RoundLayer(surface),
                _all_round(lots, surface, strategy),
                (),
                azimuth,
                buried,
            )
        else:
            neighbours = [
                facets.offset_loops(loops, -k * height)
                for k, loops in _neighbours(below, ahead, thick)
            ]
            flat = unroll_layers(
                surface, [*(loops for _, loops in lots), *neighbours], azimuth, where
            )
            layer = Slice(
                number,
                base,
                RoundLayer(surface, flat.middle),
                *regions_of(
                    [(distance, borders) for (distance, _), borders in zip(lots, flat.borders)],
                    strategy.margin,
                    error,
                    number,
                ),
                azimuth,
            )
            if thick:
                layer = layer._replace(
                    buried=common_regions(
                        [
                            grow_regions(regions(borders), strategy.margin, ARCS * error)
                            for borders in flat.borders[len(lots) :]
                        ]
                    )
                )
        if layer.regions:
            yield layer._replace(share_before=number / layers)


def _neighbours(
    below: Sequence[list[Loop]], ahead: Sequence[list[Loop]], thick: int
) -> list[tuple[int, list[Loop]]]:
    """Return the `thick` layers under and over the last one below: offset in layers, and loops.

    Loops of missing layers and loops around the hub are left out.
    """
    current = len(below) - 1
    neighbours = []
    for k in (k for step in range(1, thick + 1) for k in (-step, step)):
        layer_loops: list[Loop] = []
        if -current <= k < 0:
            layer_loops = below[current + k]
        elif 0 < k <= len(ahead):
            layer_loops = ahead[k - 1]
        neighbours.append((k, [loop for loop in layer_loops if not loop.turns]))
    return neighbours


def _apex(loops: Sequence[Loop], surface: Developable) -> Array:
    """About where (3,) the axis ends within loops that go round it."""
    round_it = np.vstack([loop.points for loop in loops if loop.turns])
    return np.array(
        [0.0, 0.0, float(round_it[:, 2].mean()) if surface.is_cylinder else surface.height]
    )


def _all_round(
    lots: Sequence[tuple[float, list[Loop]]], surface: Developable, strategy: FilledParameters
) -> tuple[Region | Strip, ...]:
    """Return the strips and regions of a layer that goes all around the hub; above a surface
    that ends below it has no margin.
    """
    margin, loops = next((lot for lot in lots if lot[1]), lots[0])
    bands = strips(
        [(surface.unroll(loop.points), loop.turns) for loop in loops], RoundLayer(surface).period
    )
    return bands if margin == 0.0 else grow_regions(bands, margin, ARCS * strategy.chord_error)
