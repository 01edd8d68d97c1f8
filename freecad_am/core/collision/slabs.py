# SPDX-License-Identifier: LGPL-2.1-or-later
"""Boxes about pieces of beads that follow each other, which lie as the pieces do.

A box along X, Y and Z about a flat bead that leans is many times as large as the bead: a nozzle that stands off it comes
near to most of them. Of a box that lies as the bead does, one plane tells whether any of its pieces need be looked at.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..geometry.columns import dots, lengths, unit_rows
from ..types import Array, Index
from .frustum import Frustum
from .tolerances import ROUNDING


class Slabs(NamedTuple):
    """Boxes (n,): centres (n, 3), three unit vectors square to each other and half sizes along them times these, (n, 3, 3),
    with a rounding (n,) mm about them."""

    centre: Array
    sides: Array
    rounding: Array


def of_pieces(corners: Array, radius: Array, size: int) -> Slabs:
    """The boxes about so many pieces each: hulls of four points (m, 4, 3), start before end, and a rounding (m,) mm."""
    starts = np.arange(0, len(corners), size)
    ends = np.minimum(starts + size, len(corners)) - 1
    along = _directions(
        corners[ends, 2:].sum(axis=1) - corners[starts, :2].sum(axis=1), np.array([1.0, 0.0, 0.0])
    )
    flat = corners[starts, 1] - corners[starts, 0]
    flat -= dots(flat, along)[:, None] * along
    spare = np.zeros_like(flat)  # square to the way along, for what is not flat
    spare[np.arange(len(along)), np.abs(along).argmin(axis=1)] = 1.0
    spare -= dots(spare, along)[:, None] * along
    flat = _directions(flat, unit_rows(spare))
    frames = np.stack([along, flat, np.cross(along, flat)], axis=1)
    number = np.arange(len(corners)) // size
    values = np.einsum("mij,mcj->mci", frames[number], corners)
    each = [values[:, k] for k in range(values.shape[1])]
    low = np.minimum.reduceat(np.minimum.reduce(each), starts)
    high = np.maximum.reduceat(np.maximum.reduce(each), starts)
    centre = np.einsum("nij,ni->nj", frames, 0.5 * (low + high))
    return Slabs(
        centre, (0.5 * (high - low))[:, :, None] * frames, np.maximum.reduceat(radius, starts)
    )


def near(slabs: Slabs, solid: Frustum, node: Index, tip: Array, axis: Array) -> Index:
    """Which pairs (k,) of a solid, its tip and axis (k, 3), and a box are left without those that surely miss each other:
    where the solid is nearest to the centre a plane touches it, which the whole box is beyond."""
    centre = slabs.centre.take(node, axis=0) - tip
    way = solid.nearest(centre, axis) - centre
    gap = lengths(way)
    first, second, third = np.abs(np.einsum("kij,kj->ik", slabs.sides.take(node, axis=0), way))
    return np.flatnonzero(
        gap * (gap - slabs.rounding.take(node) - ROUNDING) <= first + second + third
    )


def _directions(ways: Array, otherwise: Array) -> Array:
    """Unit vectors (n, 3) of ways; those others where they have no length."""
    found: Array = np.where((lengths(ways) > 0.0)[:, None], unit_rows(ways), otherwise)
    return found
