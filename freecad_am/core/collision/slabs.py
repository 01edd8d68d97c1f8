# SPDX-License-Identifier: LGPL-2.1-or-later
"""Boxes about consecutive pieces of beads, oriented as the pieces.

A box along X, Y and Z about a flat bead that leans is many times as large as the bead: a nozzle
that keeps clear is close to most of these boxes. For a box oriented like the bead, one plane
decides whether its pieces need a test.
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


def build_slabs(corners: Array, radius: Array, size: int) -> Slabs:
    """Build the boxes about groups of `size` pieces: hulls of four points (m, 4, 3), start before end,
    and a rounding (m,) mm.
    """
    starts = np.arange(0, len(corners), size)
    ends = np.minimum(starts + size, len(corners)) - 1
    along = _directions(
        corners[ends, 2:].sum(axis=1) - corners[starts, :2].sum(axis=1), np.array([1.0, 0.0, 0.0])
    )
    flat = corners[starts, 1] - corners[starts, 0]
    flat -= dots(flat, along)[:, None] * along
    spare = np.zeros_like(flat)  # perpendicular to the direction, for pieces that are not flat
    spare[np.arange(len(along)), np.abs(along).argmin(axis=1)] = 1.0
    spare -= dots(spare, along)[:, None] * along
    flat = _directions(flat, unit_rows(spare))
    frames = np.stack([along, flat, np.cross(along, flat)], axis=1)
    number = np.arange(len(corners)) // size
    values = np.einsum("mij,mcj->mci", frames[number], corners)
    corner_values = [values[:, k] for k in range(values.shape[1])]
    low = np.minimum.reduceat(np.minimum.reduce(corner_values), starts)
    high = np.maximum.reduceat(np.maximum.reduce(corner_values), starts)
    centre = np.einsum("nij,ni->nj", frames, 0.5 * (low + high))
    return Slabs(
        centre, (0.5 * (high - low))[:, :, None] * frames, np.maximum.reduceat(radius, starts)
    )


def select_close(slabs: Slabs, solid: Frustum, node: Index, tip: Array, axis: Array) -> Index:
    """Return which pairs (k,) of a solid, its tip and axis (k, 3), and a box may meet.

    Where the solid is nearest to the centre a plane touches it; a box entirely beyond that plane
    misses the solid.
    """
    centre = slabs.centre.take(node, axis=0) - tip
    direction = solid.nearest(centre, axis) - centre
    gap = lengths(direction)
    extent_a, extent_b, extent_c = np.abs(
        np.einsum("kij,kj->ik", slabs.sides.take(node, axis=0), direction)
    )
    return np.flatnonzero(
        gap * (gap - slabs.rounding.take(node) - ROUNDING) <= extent_a + extent_b + extent_c
    )


def _directions(vectors: Array, otherwise: Array) -> Array:
    """Return unit vectors (n, 3) of vectors; `otherwise` where they have no length."""
    directions: Array = np.where((lengths(vectors) > 0.0)[:, None], unit_rows(vectors), otherwise)
    return directions
