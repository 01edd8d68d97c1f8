# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of a solid on a hub: cut by equidistant surfaces, cut open where no contour is, laid flat (Dai 2020, 2.2).

The cutting line is turned by the paper's steps of 11 deg, which come by every whole degree, until no contour crosses it.
A contour that winds about the hub so far that none does, as a screw thread, is followed instead: its azimuth is counted on
past a turn, so that it stays in one piece.
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
ASIDE = 2.0  # chord errors; a cut keeps that far from facets that lie in its surface
TOUCH = 0.004  # chord errors of cuts; a face that comes that near to a surface touches it
REACH = 0.05  # mm; a solid that begins no further from a surface stands on it


class Flat(NamedTuple):
    """Borders (n, 2) mm of layers laid flat, the solid to their left; middle: azimuth (rad) of x = 0."""

    borders: list[list[Array]]
    middle: float


def count(facets: Facets, height: float, margin: float, chord_error: float) -> int:
    """How many layers there are, at 0, `height`, twice that ... mm from the base."""
    top = float(facets.distances.max()) + margin
    return step_count(top - ASIDE * chord_error, height, 0)


def cut(facets: Facets, distance: float, chord_error: float) -> list[Loop]:
    """The loops (in the base's frame) of the solid just outside of the surface at `distance` mm, moved onto it.

    Where facets lie in that surface, as the foot of a blade does in its hub, or the solid begins a hair outside of it, it
    is cut further out: a cut through them would be what noise makes of it. A face that only touches the surface, as a
    flat top does along a generatrix, touches it within TOUCH, wherever rounding has put it: it is not cut.
    """
    corners = facets.distances[facets.triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    lying = (low > distance - chord_error) & (high < distance + chord_error)
    lowest = float(facets.distances.min())
    gap = lowest - distance if distance < lowest < distance + REACH else 0.0
    aside = gap + ASIDE * chord_error if gap or lying.any() else -TOUCH * chord_error
    found = facets.cut(distance + aside, chord_error)
    return facets.moved(found, -aside)


def opened(
    surface: Developable, layers: Sequence[Sequence[Loop]], centre: float, where: str
) -> Flat:
    """Loops of layers moved onto one surface, none of which goes round it, laid flat together; cut open opposite to the
    azimuth `centre`, or near that.

    InputError TOO_FAR_ROUND where a contour winds so far about a cone that it would lie on itself.
    """
    loops = [loop for layer in layers for loop in layer]
    azimuths = [_followed(loop.points, surface) for loop in loops]
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


def _followed(points: Array, surface: Developable) -> Array:
    """Azimuths (n,) along a loop, counted on past half a turn."""
    found: Array = np.unwrap(surface.azimuth(points))
    return found


def _in_one_piece(
    surface: Developable,
    loops: Sequence[Loop],
    azimuths: Sequence[Array],
    centre: float,
    where: str,
) -> tuple[Array, ...]:
    """Loops laid flat by azimuths that go on past a turn; holes are moved by whole turns into what is about them."""
    shifted = [
        azimuth - centre - TURN * np.round((azimuth.mean() - centre) / TURN) for azimuth in azimuths
    ]
    widest = max(float(np.ptp(azimuth)) for azimuth in shifted)
    if not surface.is_cylinder and widest * math.sin(surface.taper) > 0.98 * TURN:
        raise InputError(
            "TOO_FAR_ROUND",
            where,
            "it winds {:.3g} times about the cone and would lie on itself when laid flat; divide it "
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
            there = surface.unroll_at(shifted[k] + TURN * turn, loops[k].points[:, 2])
            if winding(outer, there[:1])[0] > 0:
                flat[k] = there
                break
    return tuple(flat)
