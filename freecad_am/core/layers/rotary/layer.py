# SPDX-License-Identifier: LGPL-2.1-or-later
"""A layer on a cylinder or cone, its plane cut open half a turn from an azimuth (Dai 2020, section 2.2)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.angles import TURN
from ...geometry.columns import columns
from ...geometry.developable import Developable
from ...geometry.regions.strip import Period
from ...types import Array, Index
from ..surface import Wrapped


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
        """It bends as its hub does."""
        return False

    def unroll(self, points: Array) -> Array:
        """(n, 2) mm."""
        return self.surface.unroll(points, self.middle)

    def wrap(self, flat: Array) -> Wrapped:
        """Azimuths are counted on where the curve goes far round."""
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
        """The layer height everywhere."""

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
