# SPDX-License-Identifier: LGPL-2.1-or-later
"""Filling of regions that run all the way round a hub: contours, lines round it and lines along it.

Closed beads that go round close over the period of the plane: `PlaneCurve.turns` tells which way.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..geometry.medial import spine
from ..geometry.plane_curve import Array
from ..geometry.region import Region, regions, simplified
from ..geometry.strip import Strip
from ..issues import InfeasibleError
from .centre import FINE, centre_beads
from .curve import Beads, PlaneCurve, begun, long_enough
from .lines import levels_between


def strip_contours(strip: Strip, beads: Beads) -> list[PlaneCurve]:
    """As `contours`: from both borders and from the holes inwards, then what they leave open."""
    half, error = 0.5 * beads.spacing, beads.chord_error
    inner = strip.grown(-half, error)
    if not inner:
        return _single(strip, beads)
    curves: list[PlaneCurve] = []
    k = 0
    while inner:
        curves += _borders(inner, beads, k)
        left = strip.made(lambda part, k=k: _left(part, k, beads), (k + 2.5) * beads.spacing)  # type: ignore[misc]
        for part in left:
            if isinstance(part, Region):
                curves += [begun(curve, beads) for curve in centre_beads((part,), beads, k + 1)]
            elif part.grown(-0.5 * beads.gap, error):
                curves += _middle(part, beads, k + 1)
        k += 1
        inner = strip.grown(-(2 * k + 1) * half, error)
    return long_enough(curves, beads.shortest)


def lines_round(strip: Strip, beads: Beads) -> list[PlaneCurve]:
    """Lines round the hub, half a spacing inside the borders' farthest places and at the spacing between, see `lines`.
    Closed where nothing interrupts them."""
    inner = strip.grown(-0.5 * beads.spacing, beads.chord_error)
    if not inner:
        return _single(strip, beads)
    low, high = strip.levels
    turn, room = strip.period.around, _Room(strip, inner)
    curves = []
    for row, level in enumerate(levels_between(low + 0.5 * beads.spacing, high - 0.5 * beads.spacing, beads)):
        count = _round_count(strip, level, beads)
        u = -0.5 * turn + turn / count * np.arange(count + 1)
        inside = room.contains(np.stack([u, np.full(len(u), level)], axis=1))
        for a, b in _runs(inside[:-1]):
            points = strip.period.laid(np.stack([u[0] + turn / count * np.arange(a, b), np.full(b - a, level)], axis=1))
            whole = b - a == count
            back = (row % 2 == 1) if not whole else beads.clockwise
            sense = 0 if not whole else (-1 if back else 1)
            curves.append(PlaneCurve(points[::-1] if back else points, whole, "line", 0, sense))
    return long_enough(curves, beads.shortest)


def lines_along(strip: Strip, beads: Beads) -> list[PlaneCurve]:
    """Lines along generatrices, evenly round the hub, no farther apart than the spacing; on a cone that is where they are
    farthest from the apex, and they come nearer to each other towards it. Every other one runs the other way."""
    inner = strip.grown(-0.5 * beads.spacing, beads.chord_error)
    if not inner:
        return _single(strip, beads)
    turn, room = strip.period.around, _Room(strip, inner)
    count = max(1, math.ceil(turn * _stretch(strip) / beads.spacing - 0.01 * turn / beads.spacing))
    low, high = strip.levels
    v = np.linspace(low, high, max(2, math.ceil((high - low) / (0.02 * beads.spacing))))
    curves = []
    for number in range(count):
        cover = np.stack([np.full(len(v), -0.5 * turn + turn / count * (number + 0.5)), v], axis=1)
        for a, b in _runs(room.contains(cover), closed=False):
            ends = strip.period.laid(cover[[a, b - 1]])
            curves.append(PlaneCurve(ends[::-1] if number % 2 else ends, False, "line", 0))
    return long_enough(curves, beads.shortest)


def _left(part: Region, k: int, beads: Beads) -> tuple[Region, ...]:
    """What contour k leaves open on its inner side."""
    half, error = 0.5 * beads.spacing, beads.chord_error
    covered = [piece for inner in part.grown(-(2 * k + 3) * half, error) for piece in inner.grown(half, error)]
    open_ = part.grown(-(2 * k + 2) * half, error)
    return tuple(piece for whole in open_ for piece in (whole.without(covered) if covered else (whole,)))


def _borders(parts: Sequence[Strip | Region], beads: Beads, ring: int) -> list[PlaneCurve]:
    curves = []
    for part in parts:
        if isinstance(part, Region):
            curves += [begun(PlaneCurve(line, True, "contour", ring), beads) for line in part.rings()]
            continue
        for line, turns in part.rings():
            against = turns != 0 and (turns < 0) != beads.clockwise
            curve = PlaneCurve(line[::-1] if against else line, True, "contour", ring, -turns if against else turns)
            curves.append(begun(curve, beads))
    return curves


def _middle(strip: Strip, beads: Beads, ring: int) -> list[PlaneCurve]:
    """A bead round the hub in the middle of a thin strip."""
    turn = strip.period.around
    width = strip.levels[1] - strip.levels[0]
    room = min(2.0 * width + beads.spacing, 0.5 * turn)
    parts = strip.between(-0.5 * turn - room, 0.5 * turn + room)
    largest = max(parts, key=lambda part: part.area)
    points, _ = spine(largest, 0.25 * beads.gap, FINE * beads.spacing)
    if len(points) and points[0, 0] > points[-1, 0]:
        points = points[::-1]
    if not len(points) or points[0, 0] > -0.5 * turn or points[-1, 0] < 0.5 * turn:  # somewhere too narrow for a bead
        halves = [part for k in (-0.5, 0.0) for part in strip.between(k * turn, (k + 0.5) * turn)]
        laid = [piece for half in halves for piece in regions([strip.period.laid(ring) for ring in half.rings()])]
        return centre_beads(laid, beads, ring)
    points = simplified(points, 0.2 * beads.chord_error)
    v = np.interp(-0.5 * turn, points[:, 0], points[:, 1])
    within = points[(points[:, 0] > -0.5 * turn) & (points[:, 0] < 0.5 * turn)]
    if not math.isinf(strip.period.apex):  # what is straight in (u, v) is an arc on the plane
        count = _round_count(strip, 0.5 * sum(strip.levels), beads)
        u = np.union1d(within[:, 0], -0.5 * turn + turn / count * np.arange(1, count))
        within = np.stack([u, np.interp(u, points[:, 0], points[:, 1])], axis=1)
    flat = strip.period.laid(np.vstack([[[-0.5 * turn, v]], within]))
    sense = -1 if beads.clockwise else 1
    return [PlaneCurve(flat[::-1] if beads.clockwise else flat, True, "centre", ring, sense)]


def _single(strip: Strip, beads: Beads) -> list[PlaneCurve]:
    if beads.thin == "refuse":
        raise InfeasibleError(
            "THIN_REGION", "filling", f"a region round the hub is nowhere as wide as a bead ({beads.spacing:.3g} mm); "
            "choose thin = single, a smaller bead spacing or a margin",
        )
    return _middle(strip, beads, 0)


class _Room:
    """Parts of a strip that are asked often what lies in them."""

    def __init__(self, strip: Strip, parts: Sequence[Strip | Region]) -> None:
        reach = 0.75 * strip.period.around
        self.period = strip.period
        self.unrolled = [piece for part in parts if isinstance(part, Strip) for piece in part.between(-reach, reach)]
        self.laid = [part for part in parts if isinstance(part, Region)]

    def contains(self, cover: Array) -> NDArray[np.bool_]:
        """Which of (u, v) (n, 2) within one turn lie in one of them."""
        inside = np.zeros(len(cover), dtype=bool)
        for piece in self.unrolled:
            inside |= piece.contains(cover)
        for turns in (-1, 0, 1) if self.laid else ():
            flat = self.period.moved(self.period.laid(cover), turns)
            for part in self.laid:
                inside |= part.contains(flat)
        return inside


def _runs(inside: NDArray[np.bool_], closed: bool = True) -> list[tuple[int, int]]:
    """First and one past the last of each run of members; one across the end of a closed list goes past its length."""
    count = len(inside)
    if inside.all():
        return [(0, count)]
    change = np.diff(np.r_[False, inside, False].astype(int))
    runs = [(int(a), int(b)) for a, b in zip(np.flatnonzero(change > 0), np.flatnonzero(change < 0))]
    if closed and len(runs) > 1 and runs[0][0] == 0 and runs[-1][1] == count:
        runs = [*runs[1:-1], (runs[-1][0], count + runs[0][1])]
    return [run for run in runs if run[1] - run[0] > 1]


def _round_count(strip: Strip, level: float, beads: Beads) -> int:
    """Points of a line once round the hub, within the chord error on the plane."""
    radius = max(_radius(strip, level), beads.spacing)
    return max(24, math.ceil(strip.period.around / math.sqrt(8.0 * beads.chord_error * radius)))


def _radius(strip: Strip, level: float) -> float:
    """Radius (mm) of a line round the hub on the plane."""
    return 1e6 if math.isinf(strip.period.apex) else abs(strip.period.apex - level)


def _stretch(strip: Strip) -> float:
    """How much longer a turn is where it is longest than at the reference."""
    return 1.0 if math.isinf(strip.period.apex) else (strip.period.apex - strip.levels[0]) / abs(strip.period.apex)
