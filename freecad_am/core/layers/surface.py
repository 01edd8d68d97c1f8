# SPDX-License-Identifier: LGPL-2.1-or-later
"""A layer: a surface that can be laid flat without stretching, and what of the part lies on it.

Fillings know the plane alone. What they lay there is wrapped onto the surface: an isometry, so that spacings, areas and
angles within the layer are those of the plane.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from ..geometry.on_hub import Base
from ..geometry.regions.region import Region
from ..geometry.regions.strip import Period, Strip
from ..issues import Issue
from ..types import Array, Index


class Wrapped(NamedTuple):
    """A curve of the plane on its surface: points and unit normals (n, 3) in the frame of the field, and by what angle (n,)
    rad the x of the plane is turned there from the first direction of `axes`."""

    points: Array
    normals: Array
    turn: Array


class LayerSurface(Protocol):
    """One surface of a field of layers, in the frame of the field (`on_hub.Base`)."""

    @property
    def period(self) -> Period | None:
        """What a turn round the surface is on the plane; None where there is none. Regions with the same borders on surfaces
        with the same period are filled alike."""

    @property
    def bends_freely(self) -> bool:
        """Whether it bends as it comes, so that directions may depart from its normals to turn slower."""

    def unroll(self, points: Array) -> Array:
        """Points (n, 3) of the surface laid flat, (n, 2) mm."""

    def wrap(self, flat: Array) -> Wrapped:
        """A curve (n, 2) on the plane brought back."""

    def heights(self, flat: Array) -> Array | None:
        """How high (n,) mm the layer is at places (n, 2); None where it has the layer height everywhere."""

    def followed(self, flat: Array, sheet: float) -> LayerSurface:
        """The surface for a curve (n, 2) that lies about u = `sheet` mm (`strip.Period`)."""

    def turned(self, azimuth: float) -> float:
        """By what angle, rad, the plane is turned from where it would lie about another azimuth, rad."""

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """In how many pieces (n - 1,) the edges of a polyline (n, 2) keep within the chord error, mm, when wrapped."""

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """Two unit directions (n, 3) each within the surface where it has these normals (n, 3), at right angles, the second
        to the left of the first seen from outside."""


class Slice(NamedTuple):
    """One layer of a part: its number, the base in whose frame it is, its surface, its regions laid flat, and findings.
    azimuth: rad about the axis of the base, of the middle of the solid. buried: what of the plane is near to neither a top
    nor a bottom (`over_and_under`); None where nobody asks. heights: its least, mean and largest height, mm; None
    where it has the layer height everywhere. before: the share of all layers that come before it."""

    number: int
    base: Base
    surface: LayerSurface
    regions: tuple[Region | Strip, ...]
    issues: tuple[Issue, ...] = ()
    azimuth: float = 0.0
    buried: tuple[Region, ...] | None = None
    heights: tuple[float, float, float] | None = None
    before: float = 0.0

    @property
    def borders(self) -> list[tuple[Array, bool]]:
        """Those of its regions, (n, 2) on the plane, and whether each is closed; round the hub as often as anything near can
        ask."""
        found = []
        for region in self.regions:
            if isinstance(region, Region):
                found += [(border, True) for border in region.borders()]
                continue
            for border, turns in region.borders():
                if turns:
                    found.append(
                        (
                            np.vstack(
                                [region.period.move_turns(border, k) for k in (-turns, 0, turns)]
                            ),
                            False,
                        )
                    )
                else:
                    found += [(region.period.move_turns(border, k), True) for k in (-1, 0, 1)]
        return found

    def where(self, point: Array) -> str:
        """A point (2,) of the plane in the part, as text."""
        return self.base.where(self.surface.wrap(point[None]).points[0])
