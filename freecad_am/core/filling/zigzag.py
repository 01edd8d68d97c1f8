# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make beads from parallel lines: separate beads, or zigzags whose links follow the border.

The lines are of nominal width, or their widths adapt to the region.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.curves.plane_curve import length, nearest, rotate_points
from ..geometry.regions.region import Region, simplified
from ..types import Array, Index
from .adaptive_widths import (
    BeadLaw,
    adapt_contours,
    adapt_walls,
    drop_hairs,
    fill_gaps,
    measure_obliquity,
    thin_out,
)
from .centre import Beads, PlaneCurve, covered_regions, long_enough

ROUNDING = 3e-12  # fraction of the maximum coordinate; points this close to a height count as below
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


def crossings(borders: list[Array], level: float) -> Array:
    """Return the x coordinates at which borders cross the line y = `level`.

    Border points at this height within rounding errors count as below. Thus a border along the line
    is on the same side regardless of its last bits.

    Parameters
    ----------
    borders : list of (n, 2) array
        Closed borders, mm, without repeated first point.
    level : float
        The height y, mm.

    Returns
    -------
    (m,) array
        x of the crossings, mm, ascending; m is even.
    """
    positions = []
    for border in borders:
        following = np.roll(border, -1, axis=0)
        below = border[:, 1] <= level + ROUNDING * float(np.abs(border).max())
        k = np.flatnonzero(below != np.roll(below, -1))
        a, b = border[k], following[k]
        share = np.clip((level - a[:, 1]) / (b[:, 1] - a[:, 1]), 0.0, 1.0)
        positions.append(a[:, 0] + share * (b[:, 0] - a[:, 0]))
    return np.sort(np.concatenate(positions))


# ---- Lines of adaptive width: the space inside the contours is divided into strips of equal height,
# one for each line. A line follows the middle of its strip and is as wide as the strip is high
# there: it moves aside and narrows next to a wall, and tapers towards a slanted wall. The links of
# zigzags follow the wall at half a bead. Where a link and a line enclose an acute angle, both taper
# into the corner.

# in spacings; regions narrower than this inside their walls get contours, because lines across them
# would hardly be longer than wide
NARROW = 4.0
SMOOTH = 0.02  # in spacings; tolerance of the borders of the space inside the walls
STEP = 0.1  # in spacings; distance between the columns at which strips are measured
HAIR = 1e-6  # in spacings; distance of columns from corners
PLAIN = 0.08  # in strips; deviation of a strip from its full height at which links may begin
SMOOTHED = 0.4  # in spacings; length to either side over which a line is smoothed
# in strips; deviation of the wall from a straight line next to a link, between and beside the lines
MAX_BEND_IN_MIDDLE, MAX_BEND_AT_SIDES = 0.15, 0.3
CLEAR = 0.05  # in spacings; distance of the points of a line from a link
# in strips; length of a line next to a link over which it leaves narrow parts of other strips open,
# because their links fill them
CLIPPED = 2.0
SIDE_POSITION = 0.9  # in half strips; place beside the lines where this deviation is measured
TAPER = 0.9  # of a strip; width at the first point of a leg that tapers into an acute corner
# fraction of the distance from an acute corner at which the legs have the minimum width; there they
# turn
TIP = 0.8
RIGHT_ANGLE = math.radians(85.0)  # smaller angles between a link and a line are acute


class _Grid(NamedTuple):
    """Strips parallel to x: lower edge of strip 0 and height of all strips, mm."""

    low: float
    height: float

    def middle(self, row: int) -> float:
        """Return the height of the middle of a strip, mm."""
        return self.low + (row + 0.5) * self.height


class _Run(NamedTuple):
    """Part of a strip: its number, and lower and upper limit (n,) at places x (n,), ascending, mm."""

    row: int
    x: Array
    low: Array
    high: Array


class _Turn(NamedTuple):
    """Link between two lines: points (n, 2), mm, and bead shares (n,) in strips."""

    points: Array
    shares: Array


def adapt_lines(
    region: Region,
    beads: Beads,
    law: BeadLaw,
    angle: float,
    walls: int,
    longest_link: float | None,
) -> list[PlaneCurve]:
    """Fill a region with lines or zigzags of adaptive width inside contours.

    A region that is narrow inside its walls is filled with contours only.

    Parameters
    ----------
    region : Region
        Plane region, mm.
    beads : Beads
        Options; spacing and width are taken from `law`.
    law : BeadLaw
        Minimum and maximum width of beads.
    angle : float
        Direction of the lines from x of the plane, rad.
    walls : int
        Number of contours around the lines, at least 1.
    longest_link : float or None
        Maximum link length, mm; None: separate lines, every second row reversed.

    Returns
    -------
    list of PlaneCurve
        Contours, lines or zigzags, and beads in the remaining gaps; empty if no bead fits.
    """
    if region.width < law.width + (2.0 * walls + NARROW - 1.0) * law.spacing:
        return adapt_contours(region, beads, law)
    curves = adapt_walls(region, beads, law, walls)
    for room in _rooms(region, curves, beads, law):
        curves += _fill_room(room, beads, law, angle, walls, longest_link)
    curves = long_enough(curves, beads.shortest)
    return curves + fill_gaps(region, curves, beads, law) if curves else []


def _rooms(
    region: Region, walls: Sequence[PlaneCurve], beads: Beads, law: BeadLaw
) -> Sequence[Region]:
    """Return the space inside the walls, which it overlaps as `beads.overlap` specifies.

    Walls count as wide as the spacing, so that lines overlap them as walls overlap each other.
    """
    least = law.narrowest * law.width
    covered = covered_regions(walls, law.spacing, beads.chord_error)
    margin = 0.5 * (law.width - law.spacing)
    rooms = [
        room
        for part in region.grown(-margin, beads.chord_error)
        for room in drop_hairs(part.without(covered, wide=least), least, beads.chord_error)
    ]
    deeper = 0.5 * beads.spacing - beads.end_inset
    return [
        part.simple(SMOOTH * law.spacing)
        for room in rooms
        for part in (room.grown_with_corners(deeper) if deeper else (room,))
    ]


def _fill_room(
    room: Region,
    beads: Beads,
    law: BeadLaw,
    angle: float,
    ring: int,
    longest_link: float | None,
) -> list[PlaneCurve]:
    """Fill the space inside walls with lines or zigzags that end on its border."""
    borders = [rotate_points(border, -angle) for border in room.borders()]
    grid = _grid(borders[0], law)
    runs = _find_runs(borders, grid, law)
    curves = []
    kind = "line" if longest_link is None else "zigzag"
    for points, shares in _chain_runs(runs, grid, borders, law, longest_link):
        points, thinned = thin_out(points, shares, False, beads)
        if thinned is not None and np.abs(thinned - 1.0).max() < 1e-3:
            thinned = None
        curves.append(PlaneCurve(rotate_points(points, angle), False, kind, ring, share=thinned))
    return curves


def _grid(border: Array, law: BeadLaw) -> _Grid:
    """Divide the extent of a border (n, 2) across the lines into strips close to the spacing."""
    low, high = float(border[:, 1].min()), float(border[:, 1].max())
    count = max(round((high - low) / law.spacing), 1)
    if high - low > law.widest * count * law.spacing:
        count += 1
    return _Grid(low, (high - low) / count)


def _find_runs(borders: Sequence[Array], grid: _Grid, law: BeadLaw) -> list[_Run]:
    """Divide the space within borders (n, 2) into runs of strips.

    A part of a strip that is lower than the narrowest bead belongs to the next strip.
    """
    x = _columns(borders, law.spacing)
    column, low, high = _intervals(borders, x)
    column, row, low, high = _pieces(column, low, high, grid, law)
    order = np.lexsort((low, column, row))
    column, row, low, high = (values[order] for values in (column, row, low, high))
    is_wide = high - low >= law.narrowest * law.spacing
    column, row, low, high = (values[is_wide] for values in (column, row, low, high))
    is_start = np.ones(len(row), dtype=bool)
    is_start[1:] = (np.diff(row) != 0) | (np.diff(column) != 1)
    is_start[1:] |= np.minimum(high[1:], high[:-1]) <= np.maximum(low[1:], low[:-1])
    starts = np.flatnonzero(is_start)
    ends = np.r_[starts[1:], len(row)]
    return [
        _Run(int(row[a]), x[column[a:b]], low[a:b], high[a:b])
        for a, b in zip(starts.tolist(), ends.tolist())
        if b - a > 1 and x[column[b - 1]] - x[column[a]] > law.narrowest * law.spacing
    ]


def _columns(borders: Sequence[Array], spacing: float) -> Array:
    """Return places x (n,) at regular steps, and on both sides of all corners."""
    corners = np.concatenate([border[:, 0] for border in borders])
    low, high = float(corners.min()), float(corners.max())
    regular = np.linspace(low, high, max(int((high - low) / (STEP * spacing)), 2) + 1)
    hair = HAIR * spacing
    x = np.unique(np.concatenate([regular, corners - hair, corners + hair]))
    x = x[(x > low) & (x < high)]
    return np.asarray(x[np.r_[True, np.diff(x) > 0.5 * hair]])


def _intervals(borders: Sequence[Array], x: Array) -> tuple[Index, Array, Array]:
    """Return the intervals of columns x (n,) inside borders: column, low and high end (m,)."""
    start = np.concatenate(borders)
    end = np.concatenate([np.roll(border, -1, axis=0) for border in borders])
    first = np.searchsorted(x, np.minimum(start[:, 0], end[:, 0]))
    past = np.searchsorted(x, np.maximum(start[:, 0], end[:, 0]))
    count = past - first
    edge = np.repeat(np.arange(len(start)), count)
    column = np.arange(len(edge)) - np.repeat(np.cumsum(count) - count - first, count)
    share = (x[column] - start[edge, 0]) / (end[edge, 0] - start[edge, 0])
    y = start[edge, 1] + share * (end[edge, 1] - start[edge, 1])
    order = np.lexsort((y, column))
    column, y = column[order].reshape(-1, 2), y[order].reshape(-1, 2)
    return column[:, 0], y[:, 0], y[:, 1]


def _pieces(
    column: Index, low: Array, high: Array, grid: _Grid, law: BeadLaw
) -> tuple[Index, Index, Array, Array]:
    """Cut intervals at the edges of strips; return column, strip, low and high end of the pieces.

    An edge closer to an end of the interval than the narrowest bead does not cut it.
    """
    margin = law.narrowest * law.spacing / grid.height
    bottom, top = (low - grid.low) / grid.height, (high - grid.low) / grid.height
    first = np.ceil(bottom + margin - 1e-9).astype(np.intp)
    last = np.floor(top - margin + 1e-9).astype(np.intp)
    # too wide for one bead, although its edges are close to the ends
    is_split = (last < first) & (top - bottom > law.widest)
    first = np.where(is_split, np.round(0.5 * (top + bottom)).astype(np.intp), first)
    last = np.where(is_split, first, last)
    cuts = np.maximum(last - first + 1, 0)
    count = cuts + 1
    source = np.repeat(np.arange(len(low)), count)
    number = np.arange(len(source)) - np.repeat(np.cumsum(count) - count, count)
    middle = np.floor(0.5 * (bottom + top)).astype(np.intp)
    row = np.where(cuts[source] > 0, first[source] - 1 + number, middle[source])
    edge_below, edge_above = grid.low + row * grid.height, grid.low + (row + 1) * grid.height
    lower = np.where(number == 0, low[source], edge_below)
    upper = np.where(number == cuts[source], high[source], edge_above)
    return column[source], row, lower, upper


def _chain_runs(
    runs: Sequence[_Run],
    grid: _Grid,
    borders: Sequence[Array],
    law: BeadLaw,
    longest_link: float | None,
) -> list[tuple[Array, Array]]:
    """Return beads along runs, linked where the limit allows: points (n, 2), mm, and shares (n,)."""
    rows: dict[int, list[_Run]] = {}
    for run in runs:
        rows.setdefault(run.row, []).append(run)
    beads = []
    for row in sorted(rows):
        while rows[row]:
            beads.append(_zigzag(rows, row, grid, borders, law, longest_link))
    return beads


def _zigzag(
    rows: dict[int, list[_Run]],
    row: int,
    grid: _Grid,
    borders: Sequence[Array],
    law: BeadLaw,
    longest_link: float | None,
) -> tuple[Array, Array]:
    """Chain a zigzag upwards from the first run of a row; its runs are removed from `rows`."""
    run = rows[row].pop(0)
    sense = 1 if longest_link is not None or row % 2 == 0 else -1
    begin = -math.inf  # x, in the direction of motion, where the line begins
    points: list[Array] = []
    shares: list[Array] = []
    while True:
        found = None
        if longest_link is not None:
            found = _next(
                rows.get(run.row + 1, ()), run, sense, begin, grid, borders, longest_link, law
            )
        end = math.inf if found is None else sense * float(found[1].points[0, 0])
        line, widths = _line(run, sense, begin, end, grid, law)
        points.append(line)
        shares.append(widths)
        if found is None:
            break
        number, turn = found
        points.append(turn.points)
        shares.append(turn.shares * grid.height / law.spacing)
        run = rows[run.row + 1].pop(number)
        sense = -sense
        begin = sense * float(turn.points[-1, 0])
    return np.vstack(points), np.concatenate(shares)


def _next(
    candidates: Sequence[_Run],
    run: _Run,
    sense: int,
    begin: float,
    grid: _Grid,
    borders: Sequence[Array],
    longest_link: float,
    law: BeadLaw,
) -> tuple[int, _Turn] | None:
    """Return the number of the run that follows by the shortest link, and the link."""
    turns = [
        (number, turn)
        for number, candidate in enumerate(candidates)
        if (turn := _link_runs(run, candidate, sense, begin, grid, borders, longest_link, law))
        is not None
    ]
    return min(
        turns, key=lambda item: abs(float(np.diff(item[1].points[[0, -1], 0])[0])), default=None
    )


def _line(
    run: _Run, sense: int, begin: float, end: float, grid: _Grid, law: BeadLaw
) -> tuple[Array, Array]:
    """Return points (n, 2) and bead shares (n,) of a line, in the direction of motion.

    begin, end: x in the direction of motion between which the line runs, mm.
    """
    way = sense * run.x
    clear = CLEAR * law.spacing  # the link has points at these places
    is_inside = (way > begin + clear) & (way < end - clear)
    x, low, high, way = (values[is_inside] for values in (run.x, run.low, run.high, way))
    if not len(x):
        return np.zeros((0, 2)), np.zeros(0)
    below, above = grid.low + run.row * grid.height, grid.low + (run.row + 1) * grid.height
    is_near_link = (way < begin + CLIPPED * grid.height) | (way > end - CLIPPED * grid.height)
    low = np.where(is_near_link, np.maximum(low, below), low)
    high = np.where(is_near_link, np.minimum(high, above), high)
    off = np.maximum(np.abs(low - below), np.abs(high - above))
    if (off < PLAIN * grid.height).all():
        x = x[[0, -1]]
        points = np.stack([x, np.full(2, grid.middle(run.row))], axis=1)
        return points[::sense], np.full(2, grid.height / law.spacing)
    reach = SMOOTHED * law.spacing
    middle, height = _smooth(x, 0.5 * (low + high), reach), _smooth(x, high - low, reach)
    points = np.stack([x, middle], axis=1)
    across = np.tile([0.0, 1.0], (len(x), 1))
    shares = height / law.spacing * measure_obliquity(points, across, False)
    shares = np.clip(shares, law.narrowest, law.widest)
    return points[::sense], shares[::sense]


def _smooth(x: Array, values: Array, reach: float) -> Array:
    """Average values (n,) at places x (n,) over `reach` mm to either side, less towards the ends."""
    sums = np.r_[0.0, np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(x))]
    reaches = np.minimum(reach, np.minimum(x - x[0], x[-1] - x))
    low, high = x - reaches, x + reaches
    means = (np.interp(high, x, sums) - np.interp(low, x, sums)) / np.maximum(high - low, 1e-300)
    return np.asarray(np.where(reaches > 0.0, means, values))


def _link_runs(
    run: _Run,
    following: _Run,
    sense: int,
    begin: float,
    grid: _Grid,
    borders: Sequence[Array],
    longest_link: float,
    law: BeadLaw,
) -> _Turn | None:
    """Return the link from the end of a run to the run above it, along the wall at half a strip.

    Both runs have their full height next to the wall, and the wall is straight there. Otherwise
    there is no link.

    sense: 1 at the upper end of x, -1 at the lower end. begin: x in the direction of motion where
    the line of the run begins.
    """
    near, far = (_end(each, sense, grid, borders) for each in (run, following))
    if near is None or far is None:
        return None
    height, rise = grid.height, far - near
    if math.hypot(rise, height) > longest_link:
        return None
    if not _is_straight(run.row, near, rise, sense, grid, borders):
        return None
    points, shares = _turn(rise, height, law)
    x = near + points[:, 0]
    if x[0] < begin + 0.5 * height or not (
        _is_whole(run, sense, x[0], near - 0.5 * abs(rise), grid)
        and _is_whole(following, sense, x[-1], far - 0.5 * abs(rise), grid)
    ):
        return None
    y = grid.middle(run.row) + points[:, 1]
    return _Turn(np.stack([sense * x, y], axis=1), shares)


def _turn(rise: float, height: float, law: BeadLaw) -> tuple[Array, Array]:
    """Return points (n, 2) and bead shares (n,) of a link, relative to where its first line meets the wall.

    rise: how much farther the second line goes, mm. The link keeps half a strip from the wall.
    """
    long = math.hypot(rise, height)
    corners = np.array([[-0.5 * long, 0.0], [rise - 0.5 * long, height]])
    angle = math.atan2(height, abs(rise))
    if angle >= RIGHT_ANGLE:
        return corners, np.ones(2)
    # at the acute corner both legs run from half a strip towards the tip, half as deep as the space
    # between wall and edge of the strip is wide
    tip = np.array([rise, height]) + 0.5 * np.array([rise, height])
    wall = -np.array([rise, height]) / long
    if rise < 0.0:
        tip = -0.5 * np.array([rise, height])
        wall = -wall
    edge = np.array([-1.0, 0.0])
    normals = [edge - (edge @ wall) * wall, wall - (wall @ edge) * edge]
    reach = height / math.tan(0.5 * angle)
    scales = (1.0, TAPER, TIP * law.narrowest)
    legs = [
        tip + scale * (reach * way + 0.5 * height * normal / np.hypot(*normal))
        for scale, way, normal in (
            *((scale, wall, normals[0]) for scale in scales),
            *((scale, edge, normals[1]) for scale in scales[::-1]),
        )
    ]
    slant = math.cos(math.atan(0.5 * math.tan(0.5 * angle)))
    widths = [1.0, TAPER * slant, law.narrowest * slant]
    shares = np.array([1.0, *widths, *widths[::-1]])
    if rise > 0.0:
        return np.array([corners[0], *legs]), shares
    return np.array([*legs[::-1], corners[1]]), shares[::-1]


def _end(run: _Run, sense: int, grid: _Grid, borders: Sequence[Array]) -> float | None:
    """Return where the middle of a strip meets the wall at the end of a run: x times `sense`, mm."""
    middle = grid.middle(run.row)
    x = run.x[(run.low < middle) & (middle < run.high)]
    places = sense * crossings(list(borders), middle)
    if not len(x):
        return None
    places = places[places >= float((sense * x).max()) - HAIR * grid.height]
    return float(places.min()) if len(places) else None


def _is_whole(run: _Run, sense: int, begin: float, end: float, grid: _Grid) -> bool:
    """Whether a run has at least the height of its strip next to a link.

    begin, end: x times `sense` where the link begins, and where the wall enters the strip, mm.
    """
    x = sense * run.x
    below = grid.low + run.row * grid.height
    lack = np.maximum(run.low - below, below + grid.height - run.high)
    tolerance = PLAIN * grid.height
    is_next = (x > begin - 0.5 * grid.height) & (x < end - tolerance)
    return bool(x.min() <= begin - 0.5 * grid.height and (lack[is_next] < tolerance).all())


def _is_straight(
    row: int, near: float, rise: float, sense: int, grid: _Grid, borders: Sequence[Array]
) -> bool:
    """Whether the wall next to a link is straight, between and beside the two lines."""
    for share, tolerance in (
        (0.5, MAX_BEND_IN_MIDDLE),
        (-0.5 * SIDE_POSITION, MAX_BEND_AT_SIDES),
        (1.0 + 0.5 * SIDE_POSITION, MAX_BEND_AT_SIDES),
    ):
        level = grid.middle(row) + share * grid.height
        places = sense * crossings(list(borders), level)
        if not len(places) or np.abs(places - near - share * rise).min() > tolerance * grid.height:
            return False
    return True
