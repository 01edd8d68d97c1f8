# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make beads from parallel lines: separate beads, or zigzags whose links follow the border."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..geometry.curves.plane_curve import length, nearest
from ..geometry.regions.region import Region, simplified
from ..types import Array
from .centre import Beads, PlaneCurve

LINK = 3.0  # in spacings; maximum link length
# ratio of link length to chord; a link above this ratio stays on the border, because an inset link
# might leave the region
BOWED = 1.02
FLOOR = 4.0  # in chord errors; minimum edge length


def in_rows(
    rows: Sequence[Sequence[Array]],
    ends: Sequence[Region],
    beads: Beads,
    ring: int,
    longest_link: float | None,
    inside: float = 0.0,
) -> list[PlaneCurve]:
    """Make beads from lines that end on region borders: separate beads, or zigzags.

    Parameters
    ----------
    rows : sequence of sequence of (n, 2) array
        Lines row by row, mm, all in one direction. Links need lines of two points.
    ends : sequence of Region
        Regions whose borders the links follow.
    beads : Beads
        Spacing, chord error and shortest length of beads, mm.
    ring : int
        Contour index stored in the curves.
    longest_link : float or None
        Maximum link length, mm; None: separate lines, every second row reversed.
    inside : float, optional
        Inset of links from a border that is perpendicular to the lines, mm.

    Returns
    -------
    list of PlaneCurve
        Open beads of kind 'line' or 'zigzag', none shorter than `beads.shortest`.
    """
    if longest_link is None:
        return [
            PlaneCurve(line[::-1] if row % 2 else line, False, "line", ring)
            for row, lines in enumerate(rows)
            for line in lines
            if length(line, False) >= beads.shortest
        ]
    borders = [border for region in ends for border in region.borders()]
    min_edge = max(FLOOR * beads.chord_error, 1e-6 * beads.spacing)
    levels = [[line for line in lines if length(line, False) > min_edge] for lines in rows]
    open_ = [list(range(len(level))) for level in levels]
    curves = []
    for row in range(len(levels)):
        while open_[row]:
            points = _chain(levels, open_, row, borders, longest_link, min_edge, inside)
            if length(points, False) >= beads.shortest:
                curves.append(PlaneCurve(points, False, "zigzag", ring))
    return curves


def _chain(
    levels: Sequence[Sequence[Array]],
    open_: list[list[int]],
    row: int,
    borders: Sequence[Array],
    limit: float,
    min_edge: float,
    inside: float,
) -> Array:
    """Chain a zigzag upwards from the first unused line of a row.

    The zigzag has no edges shorter than `min_edge` mm. Its lines are removed from `open_`.
    """
    line_ = levels[row][open_[row].pop(0)]
    sections, far_end = [line_], 1
    while row + 1 < len(levels):
        row += 1
        links = [
            (length(way, False), number, way)
            for number in open_[row]
            if (way := _link(sections[-1][-1], levels[row][number][far_end], borders, limit))
            is not None
        ]
        if not links:
            break
        _, number, way = min(links, key=lambda link: link[:2])
        open_[row].remove(number)
        far_end = 1 - far_end
        line = levels[row][number][:: 1 if far_end else -1]
        sections[-1], way, line = _moved_inside(sections[-1], way, line, inside)
        sections += [_clean(way, min_edge), line]
    return np.vstack(sections)


def _moved_inside(
    line: Array, link: Array, following: Array, inside: float
) -> tuple[Array, Array, Array]:
    """Shift a link (n, 2), with the ends of the lines it joins, back along the lines (2, 2).

    The shift is `inside` mm where the border is perpendicular to the lines. It decreases with the
    slant of the border, because a slanted border leaves a larger gap at the ends of the lines.
    """
    back = line[0] - line[1]
    long = float(np.hypot(*back))
    back = back / max(long, 1e-300)
    chord = link[-1] - link[0]
    straight = max(float(np.hypot(*chord)), 1e-300)
    by = inside * max(1.0 - abs(float(chord @ back)) / straight, 0.0)
    if (
        length(link, False) > BOWED * straight
        or min(long, length(following, False)) < 2.0 * by + inside
    ):
        return line, link, following
    shift = by * back
    return (
        np.vstack([line[:1], line[1:] + shift]),
        link + shift,
        np.vstack([following[:1] + shift, following[1:]]),
    )


def _clean(link: Array, min_edge: float) -> Array:
    """Simplify the inner points (m, 2) of a link and remove edges shorter than `min_edge` mm.

    Such an edge would change the direction of motion over almost no distance.
    """
    points = simplified(link, min_edge / FLOOR)
    points_ = [points[0]]
    for point in points[1:-1]:
        if (
            np.hypot(*(point - points_[-1])) >= min_edge
            and np.hypot(*(point - points[-1])) >= min_edge
        ):
            points_.append(point)
    return np.array(points_[1:]).reshape(-1, 2)


def _link(start: Array, end: Array, borders: Sequence[Array], limit: float) -> Array | None:
    """Return the shorter border path (n, 2) between two points; None if longer than `limit` mm."""
    if float(np.hypot(*(end - start))) > limit:
        return None
    ends = np.stack([start, end])
    feet = [nearest(border, ends, closed=True) for border in borders]
    best = int(np.argmin([foot.distance.max() for foot in feet]))
    border, foot = borders[best], feet[best]
    if foot.distance.max() > 1e-6 * limit:
        return None
    paths = [_way(border, start, end, *foot.edge, *foot.share)]
    paths.append(_way(border, end, start, *foot.edge[::-1], *foot.share[::-1])[::-1])
    path = min(paths, key=lambda points: length(points, False))
    return path if length(path, False) <= limit else None


def _way(
    border: Array,
    start: Array,
    end: Array,
    leaves: int,
    arrives: int,
    share: float,
    share_at: float,
) -> Array:
    """Follow a ring forwards from `start` on edge `leaves` to `end` on edge `arrives`."""
    count = (arrives - leaves) % len(border)
    if count == 0 and share_at < share:
        count = len(border)
    between = border[(leaves + 1 + np.arange(count)) % len(border)]
    return np.vstack([start[None], between, end[None]])
