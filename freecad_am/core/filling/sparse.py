# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sparse infill: walls, an open pattern inside them, and solid infill near top and bottom surfaces."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..geometry.curves.plane_curve import rotate_points
from ..geometry.regions.region import Region, simplified
from ..geometry.regions.several import (
    grow_regions,
    select_longer,
    select_wider,
    shrink_region,
    subtract_regions,
)
from ..geometry.step_count import round_down, round_up, step_count
from ..types import Array
from .centre import Beads, PlaneCurve, closing_beads, contours_of, outermost
from .zigzag import crossings, in_rows

# number of families of parallel lines, at equal angles
FAMILIES = {"lines": 1, "zigzag": 1, "grid": 2, "triangles": 3}
GYROID_LENGTH = 15.449443  # mean section length of a unit gyroid in one period square (side 2 pi)
# chords per gyroid period before simplification: sqrt(SHARPEST * period / chord error)
SHARPEST = 6.0


def families(
    region: Region, pattern: str, spacing: float, density: float, angle: float
) -> Iterator[list[list[Array]]]:
    """Yield the lines of a straight pattern, one family at a time.

    Parameters
    ----------
    region : Region
        The region, mm.
    pattern : str
        One of FAMILIES.
    spacing : float
        Spacing of beads, mm.
    density : float
        Fraction of the area that all families fill together.
    angle : float
        Direction of the first family from x of the plane, rad.

    Yields
    ------
    list of list of (2, 2) array
        Line segments in the region, row by row, mm.
    """
    count = FAMILIES[pattern]
    for number in range(count):
        yield straight(region, count * spacing / density, angle + number * math.pi / count)


def straight(region: Region, period: float, angle: float) -> list[list[Array]]:
    """Clip parallel lines to a region.

    Parameters
    ----------
    region : Region
        The region, mm.
    period : float
        Distance between lines, mm; one passes through the origin.
    angle : float
        Direction of the lines from x of the plane, rad.

    Returns
    -------
    list of list of (2, 2) array
        Segments in the direction of the lines, row by row, mm.
    """
    borders = [rotate_points(border, -angle) for border in region.borders()]
    low, high = float(borders[0][:, 1].min()), float(borders[0][:, 1].max())
    rows_ = []
    for k in range(round_up(low / period), round_down(high / period) + 1):
        x = crossings(borders, k * period)
        ends = np.stack([x, np.full(len(x), k * period)], axis=1).reshape(-1, 2, 2)
        rows_.append(
            [rotate_points(segment, angle) for segment in ends if segment[1, 0] > segment[0, 0]]
        )
    return rows_


def honeycomb(region: Region, spacing: float, density: float, angle: float) -> list[Array]:
    """Return the lines of a honeycomb that covers the region.

    Flat and slanted sides of length a alternate along a line. Thus 4 a of bead cover a length of 3
    a, at a pitch of a sqrt(3) / 2 + spacing. Two lines that share a side are one spacing apart
    there.

    Parameters
    ----------
    region : Region
        The region, mm; lines extend beyond its bounding box.
    spacing : float
        Spacing of beads, mm.
    density : float
        Fraction of the area that the lines fill.
    angle : float
        Direction of the lines from x of the plane, rad.

    Returns
    -------
    list of (n, 2) array
        The lines, mm, not clipped to the region.
    """
    side = (4.0 / (3.0 * density) - 1.0) * spacing * 2.0 / math.sqrt(3.0)
    slant = 0.5 * math.sqrt(3.0) * side
    period, row_distance = 3.0 * side, slant + spacing
    (left_edge, low), (right, high) = _box(region, angle)
    cells = np.arange(math.floor(left_edge / period) - 1, math.ceil(right / period) + 1)
    corners = np.array([[0.0, 0.0], [side, 0.0], [1.5 * side, slant], [2.5 * side, slant]])
    line = (corners + period * np.stack([cells, 0.0 * cells], axis=1)[:, None]).reshape(
        -1, 2
    ) - np.array([0.0, 0.5 * slant])
    lines = []
    for k in range(math.floor(low / row_distance) - 1, math.ceil(high / row_distance) + 2):
        mirrored = line * np.array([1.0, -1.0 if k % 2 else 1.0]) + np.array(
            [0.0, k * row_distance]
        )
        lines.append(rotate_points(mirrored, angle))
    return lines


def gyroid_period(spacing: float, density: float) -> float:
    """Return the gyroid period, mm, for which the mean density over all heights is `density`."""
    return GYROID_LENGTH * spacing / (2.0 * math.pi * density)


def gyroid(
    region: Region, spacing: float, density: float, angle: float, height: float, chord_error: float
) -> list[Array]:
    """Return the section of the gyroid sin x cos y + sin y cos z + sin z cos x = 0 at a height.

    At a given z, the equation has the form A cos y + B sin y = C, or the same form in x, and is
    solved for y(x) or x(y). Points are therefore exactly on the surface. Lines meet only where z is
    an odd multiple of pi / 4.

    Parameters
    ----------
    region : Region
        The region, mm; lines extend beyond its bounding box.
    spacing : float
        Spacing of beads, mm.
    density : float
        Fraction of the area that lines fill, mean over all heights.
    angle : float
        Direction of x of the gyroid from x of the plane, rad.
    height : float
        Height of the layer above the origin of the gyroid, mm.
    chord_error : float
        Chord error of the lines, mm.

    Returns
    -------
    list of (n, 2) array
        The lines, mm, not clipped to the region.
    """
    unit = gyroid_period(spacing, density) / (2.0 * math.pi)
    z = height / unit
    low, high = (edge / unit for edge in _box(region, angle))
    of_x = math.cos(z) ** 2 >= 0.5
    along, across = (0, 1) if of_x else (1, 0)
    step = (
        2.0
        * math.pi
        / (4 * math.ceil(0.25 * math.sqrt(SHARPEST * 2.0 * math.pi * unit / chord_error)))
    )
    t = step * np.arange(math.floor(low[along] / step) - 1, math.ceil(high[along] / step) + 2)
    if of_x:
        a, b, c = np.sin(t), np.full(len(t), math.cos(z)), -math.sin(z) * np.cos(t)
    else:
        a, b, c = np.full(len(t), math.sin(z)), np.cos(t), -math.cos(z) * np.sin(t)
    middle = np.unwrap(np.arctan2(b, a))
    half = np.arccos(np.clip(c / np.hypot(a, b), -1.0, 1.0))
    lines = []
    first_turn = math.floor((low[across] - float(middle.max())) / (2.0 * math.pi)) - 1
    last_turn = math.ceil((high[across] - float(middle.min())) / (2.0 * math.pi)) + 1
    for turn in range(first_turn, last_turn + 1):
        for branch in (middle - half, middle + half):
            value = branch + 2.0 * math.pi * turn
            flat = np.stack([t, value] if of_x else [value, t], axis=1) * unit
            lines.append(rotate_points(simplified(flat, chord_error), angle))
    return lines


def _box(region: Region, angle: float) -> tuple[Array, Array]:
    """Return minimum and maximum coordinates (2,) of a region in axes rotated by `angle` rad."""
    border = rotate_points(region.borders()[0], -angle)
    return border.min(axis=0), border.max(axis=0)


# distance of links from the edge of the contour bead: at 0 half of the link overlaps the contour,
# at 0.5 its corners stay open
LINK_INSET_SPACINGS = 0.4
# in spacings; maximum change of the spacing to fit a whole number of lines
MAX_NARROWING, MAX_WIDENING = 0.01, 0.002


class Frame(NamedTuple):
    """Space for lines.

    curves: contours around the lines, if any. regions: regions whose extent determines the heights
    of the lines. ends: regions that the lines cross; they overlap the innermost contour. thin:
    beads in regions narrower than a bead.
    """

    curves: list[PlaneCurve]
    regions: tuple[Region, ...]
    ends: tuple[Region, ...]
    thin: list[PlaneCurve]


def frame(region: Region, inner: tuple[Region, ...], beads: Beads, walls: int) -> Frame:
    """Return the space for lines: half a bead inside the border, or a spacing inside the last wall.

    Parameters
    ----------
    region : Region
        The region to fill, mm.
    inner : tuple of Region
        The region shrunk by `beads.inset`, mm; bead centrelines stay inside.
    beads : Beads
        Spacing, width and chord error, mm.
    walls : int
        Number of contours deposited first; lines end on the innermost contour.

    Returns
    -------
    Frame
        Contours, regions for lines and line ends, and beads in thin regions.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and the region is locally narrower than a bead.
    """
    half, error = 0.5 * beads.spacing, beads.chord_error
    inner, thin = outermost(region, inner, beads)
    if not walls or not inner:
        return Frame([], inner, inner, thin)
    curves = []
    for k in range(walls):
        if k:
            inner = select_longer(
                shrink_region(region, beads.inset + 2 * k * half, error), beads.shortest
            )
        curves += contours_of(inner, beads, k)
        if not inner:
            break
    return Frame(
        curves,
        grow_regions(inner, -2.0 * half, error),
        grow_regions(inner, -beads.end_inset, error),
        thin,
    )


def lines(
    framed: Frame, beads: Beads, angle: float, walls: int, longest_link: float | None
) -> list[PlaneCurve]:
    """Fill a frame with lines, every second line reversed, or with zigzags.

    The first and the last line are half a bead inside the border, or one spacing inside the last
    wall. The distance between lines changes by at most MAX_NARROWING and MAX_WIDENING to fit a
    whole number of lines. If this is not enough, the lines keep the spacing, and the remainder at
    the centre gets an additional line. With walls, lines end on the last wall.

    Links follow the border of `framed.ends`, so that no link leaves the region. Next to contours,
    links are inset from the contour beads to reduce over-deposition.

    Parameters
    ----------
    framed : Frame
        The space for lines, see `frame`.
    beads : Beads
        Spacing and shortest length of beads, mm.
    angle : float
        Direction of the lines from x of the plane, rad.
    walls : int
        Number of contours of the frame.
    longest_link : float or None
        Maximum link length, mm; None: separate lines.

    Returns
    -------
    list of PlaneCurve
        Lines or zigzags in the plane of the frame.
    """
    inside = 0.0
    if walls:
        inside = LINK_INSET_SPACINGS * beads.spacing + 0.5 * beads.spacing - beads.end_inset
    return in_rows(rows(framed, beads, angle), framed.ends, beads, walls, longest_link, inside)


def rows(framed: Frame, beads: Beads, angle: float) -> list[list[Array]]:
    """Return the line segments in a frame, level by level.

    Parameters
    ----------
    framed : Frame
        The space for lines, see `frame`.
    beads : Beads
        The spacing, mm.
    angle : float
        Direction of the lines from x of the plane, rad.

    Returns
    -------
    list of list of (2, 2) array
        Segments of each level in the direction of the lines, mm; empty if the frame has no space.
    """
    # regions too narrow for lines get beads along their centreline
    if not framed.regions or not framed.ends:
        return []
    borders = [
        rotate_points(border, -angle) for region in framed.ends for border in region.borders()
    ]
    height = np.concatenate(
        [rotate_points(region.borders()[0], -angle)[:, 1] for region in framed.regions]
    )
    rows_ = []
    for level in levels_between(float(height.min()), float(height.max()), beads):
        x = crossings(borders, level)
        ends = np.stack([x, np.full(len(x), level)], axis=1).reshape(-1, 2, 2)
        rows_.append(
            [rotate_points(segment, angle) for segment in ends if segment[1, 0] > segment[0, 0]]
        )
    return rows_


def levels_between(low: float, high: float, beads: Beads) -> Array:
    """Return the heights of lines between two borders, spaced as in `lines`.

    Parameters
    ----------
    low, high : float
        Heights of the borders, perpendicular to the lines, mm.
    beads : Beads
        The spacing, mm.

    Returns
    -------
    (n,) array
        Heights, mm, ascending, slightly inside the borders. Borders that nearly coincide get a
        single line halfway.
    """
    spacing, breadth = beads.spacing, high - low
    # inset that makes sure that the outermost lines cross the region
    hair = 1e-7 * spacing + 1e-12 * max(abs(low), abs(high))
    if breadth <= 4.0 * hair:
        return np.array([0.5 * (low + high)])
    count = step_count(breadth, (1.0 + MAX_WIDENING) * spacing)
    if breadth / count >= (1.0 - MAX_NARROWING) * spacing:
        levels = np.linspace(low, high, count + 1)
    else:
        count_ = round_down(breadth / spacing)
        below, above = (count_ + 2) // 2, (count_ + 1) // 2
        low_levels, high_levels = (
            low + spacing * np.arange(below),
            high - spacing * np.arange(above)[::-1],
        )
        levels = (
            np.r_[low_levels, 0.5 * (low_levels[-1] + high_levels[0]), high_levels]
            if len(high_levels)
            else np.array([low, high])
        )
    clipped: Array = np.clip(levels, low + hair, high - hair)
    return clipped


LEAST_HEIGHT = 2.0  # in spacings; sparse regions narrower than this are filled solid


@dataclass(frozen=True)
class Infill:
    """Infill of the area inside the walls.

    density: filled fraction of the area; the filled area is bead length times spacing. height:
    height of the layer above the gyroid origin, mm. angle: direction of grid, triangles, honeycomb
    and gyroid, rad, the same in all layers so that beads rest on the layer below. buried: regions
    away from top and bottom surfaces; the remaining area is filled solid. None: all of the area is
    buried.
    """

    density: float = 1.0
    height: float = 0.0
    angle: float = 0.0
    buried: Sequence[Region] | None = None


def sparse(
    framed: Frame,
    inner: Sequence[Region],
    beads: Beads,
    pattern: str,
    angle: float,
    walls: int,
    longest_link: float | None,
    infill: Infill,
) -> list[PlaneCurve]:
    """Fill the area inside the walls as `infill` specifies, and close gaps between walls.

    Parameters
    ----------
    framed : Frame
        Walls and the space for lines, see `frame`.
    inner : sequence of Region
        Regions in which bead centrelines stay, mm.
    beads : Beads
        Spacing, width, gap and chord error, mm.
    pattern : str
        One of the patterns of `fill`.
    angle : float
        Direction of lines, zigzags and the lines of solid regions from x of the plane, rad.
    walls : int
        Number of contours of the frame.
    longest_link : float or None
        Maximum link length of zigzags, mm, as in `lines`.
    infill : Infill
        Density, height, angle and buried regions.

    Returns
    -------
    list of PlaneCurve
        Gap-closing beads, beads of solid regions, then beads of the pattern; walls are not
        included.
    """
    curves = (
        closing_beads(inner, framed.thin + framed.curves, beads, walls, framed.ends)
        if framed.curves
        else []
    )
    loose, solid = _divided(framed.ends, infill.buried, beads)
    for region in solid:
        curves += _fill_solid(region, beads, angle, walls, longest_link)
    for region in loose:
        curves += _pattern(region, beads, pattern, angle, walls, longest_link, infill)
    return curves


def _divided(
    ends: Sequence[Region], buried: Sequence[Region] | None, beads: Beads
) -> tuple[Sequence[Region], Sequence[Region]]:
    """Split the regions inside the walls into sparse and solid regions.

    Solid regions are extended by one spacing, so that they end on beads of the layer below.
    """
    if buried is None:
        return ends, ()
    if not buried:
        return (), ends
    skin = grow_regions(subtract_regions(ends, buried), beads.spacing, beads.chord_error)
    loose = select_wider(
        subtract_regions(ends, skin), LEAST_HEIGHT * beads.spacing, beads.chord_error
    )
    return loose, subtract_regions(ends, loose)


def _fill_solid(
    region: Region, beads: Beads, angle: float, ring: int, longest_link: float | None
) -> list[PlaneCurve]:
    """Fill a region with lines or zigzags that end on its border, and close their gaps."""
    inner = region.grown(-0.5 * beads.spacing, beads.chord_error)
    curves = in_rows(
        rows(Frame([], inner, (region,), []), beads, angle), (region,), beads, ring, longest_link
    )
    return curves + (closing_beads(inner, curves, beads, ring) if inner and curves else [])


def _pattern(
    region: Region,
    beads: Beads,
    pattern: str,
    angle: float,
    ring: int,
    longest_link: float | None,
    infill: Infill,
) -> list[PlaneCurve]:
    """Fill a region with the beads of a pattern, which end on its border."""
    spacing, density = beads.spacing, infill.density
    if pattern == "contours":
        pitch = spacing / density
        return _rounds(
            region, beads, ring, pitch - 0.5 * spacing if ring else 0.5 * pitch - beads.inset, pitch
        )
    if pattern in ("honeycomb", "gyroid"):
        across = (
            honeycomb(region, spacing, density, infill.angle)
            if pattern == "honeycomb"
            else gyroid(
                region,
                spacing,
                density,
                infill.angle,
                infill.height,
                beads.chord_error,
            )
        )
        return in_rows([region.pieces(line) for line in across], (region,), beads, ring, None)
    turn = angle if pattern in ("lines", "zigzag") else infill.angle
    longest = None if longest_link is None else longest_link / density
    return [
        curve
        for lines in families(region, pattern, spacing, density, turn)
        for curve in in_rows(lines, (region,), beads, ring, longest)
    ]


def _rounds(
    region: Region, beads: Beads, ring: int, inset: float, pitch: float
) -> list[PlaneCurve]:
    """Fill a region with contours at `pitch` mm, the first `inset` mm inside the border."""
    curves, k = [], 0
    while inner := shrink_region(region, inset + k * pitch, beads.chord_error):
        curves += contours_of(inner, beads, ring + k)
        k += 1
    return curves
