# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parallel lines at an angle, half a spacing inside the border or inside a contour round them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.plane_curve import Array, turned
from ..geometry.region import Region, along
from .centre import centre_beads, necks, single_beads
from .curve import Beads, PlaneCurve, begun, long_enough

STRETCH = 0.01  # relative; lines are moved apart or together no more than that


class Frame(NamedTuple):
    """curves: the contour round the lines, if any; room: the regions that the lines fill from border to border; thin: the
    region, or necks of it, narrower than a bead."""

    curves: list[PlaneCurve]
    room: tuple[Region, ...]
    thin: tuple[Region, ...]


def frame(region: Region, beads: Beads, ring: bool) -> Frame:
    """Where lines may run: half a spacing inside the border, or of a contour that is laid first, onto which they end."""
    half, error = 0.5 * beads.spacing, beads.chord_error
    inner = region.grown(-half, error)
    if not inner:
        return Frame([], (), (region,))
    if not ring:
        return Frame([], inner, necks(region, inner, beads))
    curves = [begun(PlaneCurve(line, True, "contour", 0), beads) for part in inner for line in part.rings()]
    return Frame(curves, tuple(piece for part in inner for piece in part.grown(-half, error)), necks(region, inner, beads))


def lines(region: Region, beads: Beads, angle: float = 0.0, ring: bool = False) -> list[PlaneCurve]:
    """Lines at an angle (rad), every other one the other way round; with `ring` a contour round them comes first.

    First and last line are half a spacing inside the border (with a ring: half a spacing inside of that), and the rest
    at the spacing from these. Where the breadth is no multiple of the spacing the lines move evenly if that takes less
    than STRETCH; otherwise what is left over is in the middle, with a line of its own where it is wider than the gap
    allowed. What lines leave open elsewhere, beside borders almost along them, is filled too. InfeasibleError
    THIN_REGION, see `Beads`.
    """
    place = frame(region, beads, ring)
    curves = single_beads(place.thin, beads) + place.curves
    for row, cuts in enumerate(rows(place.room, beads, angle)):
        curves += [PlaneCurve(cut[::-1] if row % 2 else cut, False, "line", int(ring)) for cut in cuts]
    curves += rest(region, curves, beads, int(ring) + 1)
    return long_enough(curves, beads.shortest)


def rest(region: Region, curves: Sequence[PlaneCurve], beads: Beads, ring: int) -> list[PlaneCurve]:
    """Beads in what curves leave open of the part of a region that beads can reach."""
    half, error = 0.5 * beads.spacing, beads.chord_error
    inner = region.grown(-half, error)
    if not inner:
        return []
    covered = along([(curve.points, curve.closed) for curve in curves], half, error)
    reached = [part for piece in inner for part in piece.grown(half, error)]
    left = [part for piece in reached for part in piece.without(covered)]
    return centre_beads(left, beads, ring, inner)


def rows(room: Sequence[Region], beads: Beads, angle: float) -> list[list[Array]]:
    """Level by level the pieces (2, 2) of lines inside of regions, all in the direction of the angle (rad)."""
    if not room:
        return []
    rings = [turned(ring, -angle) for part in room for ring in part.rings()]
    height = np.concatenate([ring[:, 1] for ring in rings])
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
    count = max(round(breadth / spacing), 1)
    if abs(breadth / count - spacing) <= STRETCH * spacing:
        levels = np.linspace(low, high, count + 1)
    else:
        whole = math.floor(breadth / spacing)
        below, above = (whole + 2) // 2, (whole + 1) // 2
        first, last = low + spacing * np.arange(below), high - spacing * np.arange(above)[::-1]
        between = [0.5 * (first[-1] + last[0])] if len(last) and last[0] - first[-1] - spacing > beads.gap else []
        if not len(last):
            between = [high] if breadth > beads.gap else []
        levels = np.r_[first, between, last]
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
