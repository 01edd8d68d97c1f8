# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads of parallel lines: each by itself, or linked to zigzags, from the end of one along the border to the next."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..geometry.curves.plane_curve import length, nearest
from ..geometry.regions.region import Region, simplified
from ..types import Array
from .curve import Beads, PlaneCurve

LINK = 3.0  # of the spacing
BOWED = 1.02  # of the straight way between its ends; a longer link stays on the border, for farther in it might leave it
FLOOR = 4.0  # chord errors; no edge is shorter


def in_rows(
    rows: Sequence[Sequence[Array]],
    ends: Sequence[Region],
    beads: Beads,
    ring: int,
    longest_link: float | None,
    inside: float = 0.0,
) -> list[PlaneCurve]:
    """Beads of lines (2, 2), row by row, that end on the borders of regions: zigzags with links no longer than that, mm;
    None: each line by itself, every other row the other way round. inside: how far (mm) links lie inside of a border square
    to the lines."""
    if longest_link is None:
        return [
            PlaneCurve(line[::-1] if row % 2 else line, False, "line", ring)
            for row, lines in enumerate(rows)
            for line in lines
            if length(line, False) >= beads.shortest
        ]
    borders = [border for region in ends for border in region.borders()]
    least = max(FLOOR * beads.chord_error, 1e-6 * beads.spacing)
    levels = [[line for line in lines if length(line, False) > least] for lines in rows]
    open_ = [list(range(len(level))) for level in levels]
    curves = []
    for row in range(len(levels)):
        while open_[row]:
            points = _chain(levels, open_, row, borders, longest_link, least, inside)
            if length(points, False) >= beads.shortest:
                curves.append(PlaneCurve(points, False, "zigzag", ring))
    return curves


def _chain(
    levels: Sequence[Sequence[Array]],
    open_: list[list[int]],
    row: int,
    borders: Sequence[Array],
    limit: float,
    least: float,
    inside: float,
) -> Array:
    """A zigzag from the first line open in a row up, without edges shorter than `least` mm; takes its lines off the list."""
    piece = levels[row][open_[row].pop(0)]
    parts, far = [piece], 1
    while row + 1 < len(levels):
        row += 1
        links = [
            (length(way, False), number, way)
            for number in open_[row]
            if (way := _link(parts[-1][-1], levels[row][number][far], borders, limit)) is not None
        ]
        if not links:
            break
        _, number, way = min(links, key=lambda link: link[:2])
        open_[row].remove(number)
        far = 1 - far
        line = levels[row][number][:: 1 if far else -1]
        parts[-1], way, line = _moved_inside(parts[-1], way, line, inside)
        parts += [_clean(way, least), line]
    return np.vstack(parts)


def _moved_inside(
    line: Array, way: Array, following: Array, inside: float
) -> tuple[Array, Array, Array]:
    """A line (2, 2), the link (n, 2) after it and the line after that, moved back along the lines by `inside` mm where the
    border is square to them, and less the more it is slanted, for what is left open beside its ends grows."""
    back = line[0] - line[1]
    long = float(np.hypot(*back))
    back = back / max(long, 1e-300)
    chord = way[-1] - way[0]
    straight = max(float(np.hypot(*chord)), 1e-300)
    by = inside * max(1.0 - abs(float(chord @ back)) / straight, 0.0)
    if (
        length(way, False) > BOWED * straight
        or min(long, length(following, False)) < 2.0 * by + inside
    ):
        return line, way, following
    shift = by * back
    return (
        np.vstack([line[:1], line[1:] + shift]),
        way + shift,
        np.vstack([following[:1] + shift, following[1:]]),
    )


def _clean(way: Array, least: float) -> Array:
    """The inner points of a link, which begins and ends on lines, without those that hardly turn it and those within `least`
    mm of others: an edge that short would turn the travel with nothing travelled."""
    points = simplified(way, least / FLOOR)
    kept = [points[0]]
    for point in points[1:-1]:
        if np.hypot(*(point - kept[-1])) >= least and np.hypot(*(point - points[-1])) >= least:
            kept.append(point)
    return np.array(kept[1:]).reshape(-1, 2)


def _link(start: Array, end: Array, borders: Sequence[Array], limit: float) -> Array | None:
    """The shorter way (n, 2) along a border that both ends lie on; None where there is none below the limit."""
    if float(np.hypot(*(end - start))) > limit:
        return None
    both = np.stack([start, end])
    found = [nearest(border, both, closed=True) for border in borders]
    best = int(np.argmin([places.distance.max() for places in found]))
    border, places = borders[best], found[best]
    if places.distance.max() > 1e-6 * limit:
        return None
    ways = [_way(border, start, end, *places.edge, *places.share)]
    ways.append(_way(border, end, start, *places.edge[::-1], *places.share[::-1])[::-1])
    way = min(ways, key=lambda points: length(points, False))
    return way if length(way, False) <= limit else None


def _way(
    border: Array,
    start: Array,
    end: Array,
    leaves: int,
    arrives: int,
    share: float,
    share_at: float,
) -> Array:
    """From a place on edge `leaves` on along a ring to one on edge `arrives`."""
    count = (arrives - leaves) % len(border)
    if count == 0 and share_at < share:
        count = len(border)
    between = border[(leaves + 1 + np.arange(count)) % len(border)]
    return np.vstack([start[None], between, end[None]])
