# SPDX-License-Identifier: LGPL-2.1-or-later
"""A layer: a surface that unrolls without stretching, and the regions of the part on it.

Fillings work only on the plane. Their results are wrapped onto the surface by an
isometry, so spacings, areas and angles within the layer are those of the plane.
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
        """The turn around the surface on the plane; None if it does not close.

        Regions with the same borders on surfaces with the same period are filled alike.
        """

    @property
    def bends_freely(self) -> bool:
        """Whether it bends as it comes, so that directions may depart from its normals to turn slower."""

    def unroll(self, points: Array) -> Array:
        """Return points (n, 3) of the surface unrolled, (n, 2) mm."""

    def wrap(self, flat: Array) -> Wrapped:
        """A curve (n, 2) on the plane brought back."""

    def heights(self, flat: Array) -> Array | None:
        """Return the layer heights (n,) mm at points (n, 2); None if the layer height is constant."""

    def for_sheet(self, flat: Array, sheet: float) -> LayerSurface:
        """Return the surface for a curve (n, 2) about u = `sheet` mm (`strip.Period`)."""

    def plane_rotation(self, azimuth: float) -> float:
        """Return the rotation, rad, of the plane from its orientation about another azimuth, rad."""

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """In how many pieces (n - 1,) the edges of a polyline (n, 2) keep within the chord error, mm, when wrapped."""

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """Two unit directions (n, 3) each within the surface where it has these normals (n, 3), at right angles, the second
        to the left of the first seen from outside."""


class Slice(NamedTuple):
    """One layer of a part: its number, the base in whose frame it is, its surface, its unrolled
    regions, and issues.

    azimuth: rad about the axis of the base, of the middle of the solid. buried: parts of the
    plane away from tops and bottoms (`over_and_under`); None if not required. heights:
    smallest, mean and largest height, mm; None if the layer height is constant. share_before:
    the share of all layers before this one.
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
        """The borders of its regions, (n, 2) on the plane, and whether each is closed; around the
        hub in all adjacent turns.
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
        """A point (2,) of the plane in the part, as text."""
        return self.base.where(self.surface.wrap(point[None]).points[0])
