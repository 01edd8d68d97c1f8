# SPDX-License-Identifier: LGPL-2.1-or-later
"""The volume of a part of several solids: the sum if they touch, the union if they overlap.

By Gauss's theorem over the triangles of the solids, without triangles inside of another one or present twice.
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
INWARDS = 1e-3  # of the distance to its middle, by which a corner of a triangle is moved inwards
PLACES = 10_000  # squares of the surface of the solids, for the side length of triangles
CONTACT_CHORDS = 3.0  # chord errors; surfaces that are no farther apart are one
MIN_CONTACT_MM = 1e-3  # mm; the same, however small the chord error
TOUCHING = 3e-3  # of the volume; solids that share less, as far as it can be measured, only touch


def part_volume(solids: SolidsOnHub) -> float | None:
    """Volume, mm3, of the solids outside of their hubs, shared volume counted once; None if one is open."""
    exact_volume = solids_beyond(solids)
    if exact_volume is not None:
        return exact_volume
    tolerance = max(CONTACT_CHORDS * solids.chord_error, MIN_CONTACT_MM)
    volumes = [_union_volume(group.bodies, tolerance) for group in solids.groups]
    return None if None in volumes else sum(volume for volume in volumes if volume is not None)


def _union_volume(bodies: Sequence[Body], tolerance: float) -> float | None:
    """Volume, mm3, of the union of bodies. tolerance: mm within which surfaces count as one."""
    insides = [inside_of(body) for body in bodies]
    volumes = [SolidMesh(body.vertices, body.triangles).volume for body in bodies]
    if any(inside is None for inside in insides):
        return None
    closed = [inside for inside in insides if inside is not None]
    corners = [
        body.corners() if volume > 0.0 else body.corners()[:, ::-1]
        for body, volume in zip(bodies, volumes, strict=True)
    ]
    middle = np.vstack([corner.reshape(-1, 3) for corner in corners]).mean(axis=0)
    surface = (
        sum(float(np.linalg.norm(doubled_areas(corner_), axis=1).sum()) for corner_ in corners)
        / 2.0
    )
    longest = float(np.sqrt(surface / PLACES))
    total = sum(abs(volume) for volume in volumes)
    shared = 0.0
    for number, corner in enumerate(corners):
        other_bodies = [
            (k, inside) for k, inside in enumerate(closed) if k != number and _meet(inside, corner)
        ]
        if other_bodies:
            shared += _hidden_volume(
                corner - middle, longest, _hiding(number, other_bodies, tolerance, middle)
            )
    return total if shared < TOUCHING * total else total - shared


def _meet(inside: Inside, corners: Array) -> bool:
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    return bool(((low <= inside.high) & (inside.low <= high)).all())


def _hidden_volume(corner: Array, longest: float, hidden: Callable[[Array, Array], Mask]) -> float:
    """The volume, mm3, of the hidden sections of triangles (m, 3, 3); partly hidden pieces are divided FINER times finer. hidden:
    of points (n, 3) with areas (n, 3).
    """
    pieces = _divided(corner, longest)
    areas, middles = doubled_areas(pieces) / 2.0, pieces.mean(axis=1)
    at_middle = hidden(middles, areas)
    at_corners = [
        hidden(pieces[:, k] + INWARDS * (middles - pieces[:, k]), areas) for k in range(3)
    ]
    mixed = np.any([mask != at_middle for mask in at_corners], axis=0)
    is_hidden = at_middle & ~mixed
    volume = float(dots(middles[is_hidden], areas[is_hidden]).sum()) / 3.0
    if mixed.any():
        fine = _divided(pieces[mixed], longest / FINER)
        areas, middles = doubled_areas(fine) / 2.0, fine.mean(axis=1)
        cut = hidden(middles, areas)
        volume += float(dots(middles[cut], areas[cut]).sum()) / 3.0
    return volume


def _hiding(
    number: int, other_bodies: Sequence[tuple[int, Inside]], tolerance: float, origin: Array
) -> Callable[[Array, Array], Mask]:
    """The predicate for points (n, 3) from an origin, on the surface of a body with outward areas (n, 3): inside other bodies, or on
    surfaces of others that face the other way; if surfaces face the same way the first one counts.
    """

    def hidden(points: Array, areas: Array) -> Mask:
        outwards, points = tolerance * unit_rows(areas), points + origin
        mask = np.zeros(len(points), dtype=bool)
        for k, inside in other_bodies:
            mask |= inside.holds(points + outwards)
            if k < number:
                mask |= inside.holds(points - outwards)
        return mask

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
