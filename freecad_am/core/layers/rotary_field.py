# SPDX-License-Identifier: LGPL-2.1-or-later
"""Slice solids by equidistant cylinders or cones around a hub (Dai 2020, section 2).

The cuts are unrolled and grown by the machining margin.
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
    """Cylinder or cone about the Z axis of its frame, a `LayerSurface`.

    middle: azimuth of x = 0 on the plane, rad.
    """

    surface: Developable
    middle: float = 0.0

    @property
    def period(self) -> Period:
        """Period of one turn: a length for a cylinder, an angle about the apex for a cone."""
        if self.surface.is_cylinder:
            return Period(TURN * self.surface.radius)
        return Period(self.surface.flat_turn, self.surface.slant)

    @property
    def bends_freely(self) -> bool:
        """False: the layer bends as the hub does."""
        return False

    def unroll(self, points: Array) -> Array:
        """Unroll points, (n, 2), mm."""
        return self.surface.unroll(points, self.middle)

    def wrap(self, flat: Array) -> Wrapped:
        """Wrap a curve of the plane; azimuths are continuous beyond a full turn."""
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
        """Return None: the layer height is constant."""

    def for_sheet(self, flat: Array, sheet: float) -> RoundLayer:
        """Return the surface for a curve about `sheet`.

        On a wide cone a curve may pass behind the apex, which is not visible on the plane.
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
        """Return the number of pieces of each edge that keeps the chord error.

        An edge is a geodesic. Its curvature is the curvature of the surface around the axis times
        the squared component of the edge in this direction (Euler).
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
        # an edge is closer to the apex than its ends by at most its sagitta as seen from the apex
        min_rho = np.minimum(rho[:-1], rho[1:]) * np.cos(0.5 * np.abs(np.diff(phi)))
        curvature = math.cos(self.surface.taper) * share**2 / min_rho
        count = np.maximum(np.ceil(length * np.sqrt(curvature / (8.0 * chord_error)) - 1e-9), 1.0)
        return np.asarray(count.astype(np.intp))

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """Return the directions around the axis and upwards along the surface."""
        x, y = columns(normals[:, :2])
        level = np.hypot(x, y)
        around = np.stack([-y / level, x / level, np.zeros(len(x))], axis=1)
        return around, np.cross(normals, around)


def _unwrapped(flat: Array, surface: Developable) -> tuple[Array, Array]:
    """Return azimuth, unwrapped, and height (n,) along a curve (n, 2) of the plane."""
    theta, z = surface.from_unrolled(flat)
    if surface.is_cylinder:
        return theta, z
    sine = math.sin(surface.taper)
    return np.unwrap(theta * sine) / sine, z


CUT = 0.25  # fraction of the chord error; chord error of cuts


def slices(base: Base, body: Body, strategy: FilledParameters) -> Iterator[Slice]:
    """Yield the layers of a solid from the hub outwards.

    The layers are at 0, h, 2 h ... mm from the hub; layers without regions are skipped.

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
    """Return the loops of the `thick` layers under and over the current layer, with layer offsets.

    The current layer is the last in `below`. Missing layers have no loops. Loops around the hub are
    dropped.
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
    """Return the approximate point (3,) at which the axis ends within loops around the axis."""
    round_it = np.vstack([loop.points for loop in loops if loop.turns])
    return np.array(
        [0.0, 0.0, float(round_it[:, 2].mean()) if surface.is_cylinder else surface.height]
    )


def _all_round(
    lots: Sequence[tuple[float, list[Loop]]], surface: Developable, strategy: FilledParameters
) -> tuple[Region | Strip, ...]:
    """Return the strips and regions of a layer with loops around the hub.

    Surfaces that end below such a layer get no margin above them.
    """
    margin, loops = next((lot for lot in lots if lot[1]), lots[0])
    bands = strips(
        [(surface.unroll(loop.points), loop.turns) for loop in loops], RoundLayer(surface).period
    )
    return bands if margin == 0.0 else grow_regions(bands, margin, ARCS * strategy.chord_error)
