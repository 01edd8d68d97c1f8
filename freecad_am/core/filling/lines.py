# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parallel lines at an angle, half a bead inside the border or inside a contour round them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.plane_curve import Array, length, turned
from ..geometry.region import Region
from .centre import closing, necks, single_beads
from .curve import Beads, PlaneCurve, begun, long_enough

TOGETHER, APART = 0.01, 0.002  # of the spacing; lines are moved no more than that so that they come out even


class Frame(NamedTuple):
    """curves: the contour round the lines, if any; room: the regions between whose borders lines are spread; ends: those
    that they run through, which reach onto the contour; thin: the region, or necks of it, narrower than a bead."""

    curves: list[PlaneCurve]
    room: tuple[Region, ...]
    ends: tuple[Region, ...]
    thin: tuple[Region, ...]


def frame(region: Region, beads: Beads, ring: bool) -> Frame:
    """Where lines may run: half a bead inside the border, or a spacing inside of a contour that is laid first, onto which
    they end."""
    half, error = 0.5 * beads.spacing, beads.chord_error
    inner = region.grown(-beads.inset, error)
    if not inner:
        return Frame([], (), (), (region,))
    thin = necks(region, inner, beads)
    if not ring:
        return Frame([], inner, inner, thin)
    curves = [begun(PlaneCurve(line, True, "contour", 0), beads) for part in inner for line in part.rings()]
    room, ends = (
        tuple(piece for part in inner for piece in part.grown(-way, error)) for way in (2.0 * half, half)
    )
    return Frame(curves, room, ends, thin)


def lines(region: Region, beads: Beads, angle: float = 0.0, ring: bool = False) -> list[PlaneCurve]:
    """Lines at an angle (rad), every other one the other way round; with `ring` a contour round them comes first.

    First and last line are half a bead inside the border (with a ring: a spacing inside of that), and the rest
    at the spacing from these. Where the breadth is no multiple of the spacing the lines move evenly if that takes no more
    than TOGETHER and APART; otherwise what is left over is in the middle and has a line of its own. With a ring, lines end
    on it. What lines leave open elsewhere, beside borders almost along them, is filled too, as is the place of lines that
    would be too short. InfeasibleError THIN_REGION, see `Beads`.
    """
    place = frame(region, beads, ring)
    curves = single_beads(place.thin, beads) + place.curves
    for row, cuts in enumerate(rows(place, beads, angle)):
        cuts = [cut for cut in cuts if length(cut, False) >= beads.shortest]
        curves += [PlaneCurve(cut[::-1] if row % 2 else cut, False, "line", int(ring)) for cut in cuts]
    curves += closing(region, curves, beads, int(ring))
    return long_enough(curves, beads.shortest)


def rows(place: Frame, beads: Beads, angle: float) -> list[list[Array]]:
    """Level by level the pieces (2, 2) of lines, all in the direction of the angle (rad)."""
    if not place.room or not place.ends:  # too narrow for lines; what they would fill gets beads along its middle
        return []
    rings = [turned(ring, -angle) for part in place.ends for ring in part.rings()]
    height = np.concatenate([turned(part.rings()[0], -angle)[:, 1] for part in place.room])
    found = []
    for level in levels_between(float(height.min()), float(height.max()), beads):
        x = _crossings(rings, level)
        ends = np.stack([x, np.full(len(x), level)], axis=1).reshape(-1, 2, 2)
        found.append([turned(piece, angle) for piece in ends if piece[1, 0] > piece[0, 0]])
    return found


def levels_between(low: float, high: float, beads: Beads) -> Array:
    """Heights of lines from `low` to `high`, see `lines`."""
    spacing, breadth = beads.spacing, high - low
    hair = 1e-7 * spacing + 1e-12 * max(abs(low), abs(high))  # lines along the border cross it for sure
    if breadth <= 4.0 * hair:
        return np.array([0.5 * (low + high)])
    count = max(math.ceil(breadth / ((1.0 + APART) * spacing)), 1)
    if breadth / count >= (1.0 - TOGETHER) * spacing:
        levels = np.linspace(low, high, count + 1)
    else:
        whole = math.floor(breadth / spacing)
        below, above = (whole + 2) // 2, (whole + 1) // 2
        first, last = low + spacing * np.arange(below), high - spacing * np.arange(above)[::-1]
        levels = np.r_[first, 0.5 * (first[-1] + last[0]), last] if len(last) else np.array([low, high])
    found: Array = np.clip(levels, low + hair, high - hair)
    return found


def _crossings(rings: Sequence[Array], level: float) -> Array:
    """Where rings cross a height, ascending; an even number."""
    found = []
    for ring in rings:
        following = np.roll(ring, -1, axis=0)
        k = np.flatnonzero((ring[:, 1] <= level) != (following[:, 1] <= level))
        a, b = ring[k], following[k]
        found.append(a[:, 0] + (level - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0]))
    return np.sort(np.concatenate(found))
