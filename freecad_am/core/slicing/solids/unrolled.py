# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of a solid on a hub: cut by equidistant surfaces, cut open where no contour is,
unrolled (Dai 2020, 2.2).

The cutting line is turned by the paper's steps of 11 deg, which reach every whole degree,
until no contour crosses it. A contour that winds around the hub so far that every line
crosses it, such as a screw thread, is followed instead: its azimuth is unwrapped past a
turn, so it stays in one piece.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import islice
from typing import NamedTuple

import numpy as np

from ...geometry.angles import TURN
from ...geometry.curves.plane_curve import doubled_area, winding
from ...geometry.developable import Developable
from ...geometry.step_count import step_count
from ...issues import InputError
from ...types import Array
from .equidistant import Facets, Loop

STEP = math.radians(11.0)
TRIES = 360
CLEARANCE_RATIO = 2.0  # chord errors; clearance of a cut from facets in its surface
TOUCH = 0.004  # chord errors of cuts; a face that comes that near to a surface touches it
REACH = 0.05  # mm; a solid that begins no further from a surface is based on it


class Flat(NamedTuple):
    """Unrolled borders (n, 2) mm of layers, the solid to their left; middle: azimuth (rad) of x
    = 0.
    """

    borders: list[list[Array]]
    middle: float


def count(facets: Facets, height: float, margin: float, chord_error: float) -> int:
    """How many layers there are, at 0, `height`, twice that ... mm from the base."""
    top = float(facets.distances.max()) + margin
    return step_count(top - CLEARANCE_RATIO * chord_error, height, 0)


def cut(facets: Facets, distance: float, chord_error: float) -> list[Loop]:
    """Return the loops (in the base's frame) of the solid just outside the surface at `distance`
    mm, moved onto it.

    Where facets coincide with that surface, as the foot of a blade with its hub, or the solid
    begins slightly outside it, the cut is further out: noise would decide a cut through them.
    A face that only touches the surface, as a flat top along a generatrix, touches it within
    TOUCH after rounding: it is not cut.
    """
    corners = facets.distances[facets.triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    lying = (low > distance - chord_error) & (high < distance + chord_error)
    lowest = float(facets.distances.min())
    gap = lowest - distance if distance < lowest < distance + REACH else 0.0
    aside = gap + CLEARANCE_RATIO * chord_error if gap or lying.any() else -TOUCH * chord_error
    loops_aside = facets.cut(distance + aside, chord_error)
    return facets.offset_loops(loops_aside, -aside)


def unroll_layers(
    surface: Developable, layers: Sequence[Sequence[Loop]], centre: float, where: str
) -> Flat:
    """Unroll loops of layers moved onto one surface, none of which goes around it, together.

    They are cut open opposite the azimuth `centre`, or near that. Raises InputError
    TOO_FAR_ROUND if a contour winds so far around a cone that it would overlap itself.
    """
    loops = [loop for layer in layers for loop in layer]
    azimuths = [_unwrap_azimuths(loop.points, surface) for loop in loops]
    spans = np.array([[azimuth.min(), azimuth.max()] for azimuth in azimuths]).reshape(-1, 2)
    for k in range(TRIES):
        middle = centre + k * STEP
        cutting = middle + 0.5 * TURN
        if (
            np.floor((spans[:, 0] - cutting) / TURN) == np.floor((spans[:, 1] - cutting) / TURN)
        ).all():
            return Flat(
                [[surface.unroll(loop.points, middle) for loop in layer] for layer in layers],
                middle,
            )
    flat = iter(_in_one_piece(surface, loops, azimuths, centre, where))
    return Flat([list(islice(flat, len(layer))) for layer in layers], centre)


def _unwrap_azimuths(points: Array, surface: Developable) -> Array:
    """Return azimuths (n,) along a loop, unwrapped."""
    azimuths: Array = np.unwrap(surface.azimuth(points))
    return azimuths


def _in_one_piece(
    surface: Developable,
    loops: Sequence[Loop],
    azimuths: Sequence[Array],
    centre: float,
    where: str,
) -> tuple[Array, ...]:
    """Unroll loops by azimuths beyond a turn; holes are moved by whole turns into the contours
    around them.
    """
    shifted = [
        azimuth - centre - TURN * np.round((azimuth.mean() - centre) / TURN) for azimuth in azimuths
    ]
    widest = max(float(np.ptp(azimuth)) for azimuth in shifted)
    if not surface.is_cylinder and widest * math.sin(surface.taper) > 0.98 * TURN:
        raise InputError(
            "TOO_FAR_ROUND",
            where,
            "it winds {:.3g} times around the cone and would overlap when unrolled; divide it "
            "into shorter solids",
            widest / TURN,
        )
    flat = [
        surface.unroll_at(azimuth, loop.points[:, 2])
        for azimuth, loop in zip(shifted, loops, strict=True)
    ]
    outer = [points for points in flat if doubled_area(points) > 0.0]
    turns = math.ceil(widest / TURN) + 1
    for k, points in enumerate(flat):
        if doubled_area(points) > 0.0:
            continue
        for turn in sorted(range(-turns, turns + 1), key=abs):
            shifted_points = surface.unroll_at(shifted[k] + TURN * turn, loops[k].points[:, 2])
            if winding(outer, shifted_points[:1])[0] > 0:
                flat[k] = shifted_points
                break
    return tuple(flat)
