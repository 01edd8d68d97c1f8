# SPDX-License-Identifier: LGPL-2.1-or-later
"""The volume of a part of several solids: of those that touch the sum, of those that overlap the union.

By Gauss's theorem over the triangles of all solids, without what of them lies inside of another one or is there twice.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...collision.inside import Inside, inside_of
from ...geometry.beyond_hub import solids_beyond
from ...geometry.columns import dots, unit_rows
from ...geometry.mesh.facets import doubled_areas
from ...geometry.mesh.solid import SolidMesh
from ...geometry.obstacles import Body
from ...geometry.on_hub import SolidsOnHub
from ...types import Array, Mask

FINER = 8.0  # times, where a solid cuts another one
INWARDS = 1e-3  # of the way to its middle, by which a corner of a triangle is looked at
PLACES = 10_000  # of the surface of all solids, if their triangles were squares
NEAR = 3.0  # chord errors; surfaces that are no farther apart are one
LEAST = 1e-3  # mm; the same, however small the chord error
TOUCHING = 3e-3  # of the volume; solids that share less, as far as it can be measured, only touch


def part_volume(solids: SolidsOnHub) -> float | None:
    """Volume, mm3, of all solids outside of their hubs, what they share counted once; None where one of them is open."""
    known = solids_beyond(solids)
    if known is not None:
        return known
    near = max(NEAR * solids.chord_error, LEAST)
    volumes = [_union_volume(group.bodies, near) for group in solids.groups]
    return None if None in volumes else sum(volume for volume in volumes if volume is not None)


def _union_volume(bodies: Sequence[Body], near: float) -> float | None:
    """Volume, mm3, of the union of bodies. near: mm within which surfaces count as one."""
    insides = [inside_of(body) for body in bodies]
    whole = [SolidMesh(body.vertices, body.triangles).volume for body in bodies]
    if any(inside is None for inside in insides):
        return None
    closed = [inside for inside in insides if inside is not None]
    corners = [
        body.corners() if volume > 0.0 else body.corners()[:, ::-1]
        for body, volume in zip(bodies, whole, strict=True)
    ]
    middle = np.vstack([corner.reshape(-1, 3) for corner in corners]).mean(axis=0)
    surface = sum(float(np.linalg.norm(doubled_areas(one), axis=1).sum()) for one in corners) / 2.0
    longest = float(np.sqrt(surface / PLACES))
    total = sum(abs(volume) for volume in whole)
    shared = 0.0
    for number, corner in enumerate(corners):
        others = [
            (k, inside) for k, inside in enumerate(closed) if k != number and _meet(inside, corner)
        ]
        if others:
            shared += _hidden_volume(
                corner - middle, longest, _hiding(number, others, near, middle)
            )
    return total if shared < TOUCHING * total else total - shared


def _meet(inside: Inside, corners: Array) -> bool:
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    return bool(((low <= inside.high) & (inside.low <= high)).all())


def _hidden_volume(corner: Array, longest: float, hidden: Callable[[Array, Array], Mask]) -> float:
    """What triangles (m, 3, 3), as far as they are hidden, add to the volume, mm3; pieces that are hidden in part are
    divided FINER times finer. hidden: of places (n, 3) with areas (n, 3)."""
    pieces = _divided(corner, longest)
    areas, middles = doubled_areas(pieces) / 2.0, pieces.mean(axis=1)
    at_middle = hidden(middles, areas)
    at_corners = [
        hidden(pieces[:, k] + INWARDS * (middles - pieces[:, k]), areas) for k in range(3)
    ]
    mixed = np.any([one != at_middle for one in at_corners], axis=0)
    whole = at_middle & ~mixed
    volume = float(dots(middles[whole], areas[whole]).sum()) / 3.0
    if mixed.any():
        fine = _divided(pieces[mixed], longest / FINER)
        areas, middles = doubled_areas(fine) / 2.0, fine.mean(axis=1)
        cut = hidden(middles, areas)
        volume += float(dots(middles[cut], areas[cut]).sum()) / 3.0
    return volume


def _hiding(
    number: int, others: Sequence[tuple[int, Inside]], near: float, origin: Array
) -> Callable[[Array, Array], Mask]:
    """The function that tells which places (n, 3) from an origin, of the surface of a body with areas (n, 3) outwards, lie
    in others or on surfaces of others that face the other way; of surfaces that face the same way the first one counts."""

    def hidden(places: Array, areas: Array) -> Mask:
        outwards, places = near * unit_rows(areas), places + origin
        found = np.zeros(len(places), dtype=bool)
        for k, inside in others:
            found |= inside.holds(places + outwards)
            if k < number:
                found |= inside.holds(places - outwards)
        return found

    return hidden


def _divided(corner: Array, longest: float) -> Array:
    """Triangles (n, 3, 3): those given, (m, 3, 3), halved until no side is longer than `longest`."""
    pieces = []
    while len(corner):
        side = np.linalg.norm(np.roll(corner, -1, axis=1) - corner, axis=2)
        top = np.argmax(side, axis=1)
        small = side[np.arange(len(top)), top] <= longest
        pieces.append(corner[small])
        corner, top = corner[~small], top[~small]
        a, b, c = (corner[np.arange(len(top)), (top + k) % 3] for k in range(3))
        middle = 0.5 * (a + b)
        corner = np.concatenate(
            [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        )
    return np.concatenate(pieces)
