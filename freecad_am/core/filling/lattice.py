# SPDX-License-Identifier: LGPL-2.1-or-later
"""Patterns of beads with room between them: length times spacing is the density's share of the area. They are fixed in the plane,
not to the region, so that layers rest on one another.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..geometry.curves.plane_curve import rotate_points
from ..geometry.regions.region import Region, simplified
from ..geometry.step_count import round_down, round_up
from ..types import Array

FAMILIES = {"lines": 1, "zigzag": 1, "grid": 2, "triangles": 3}  # of parallel lines, evenly turned
GYROID_LENGTH = 15.449443  # mean length of the sections of a unit gyroid (2 pi wide), within its square of 4 pi^2
SHARPEST = 6.0  # factor of the chords per period of the gyroid, the root of period by chord error, before simplification
ROUNDING = 3e-12  # of the largest coordinate


def families(
    region: Region, pattern: str, spacing: float, density: float, angle: float
) -> Iterator[list[list[Array]]]:
    """Family by family of the straight patterns, row by row the pieces (2, 2) of lines in a region, at an angle, rad."""
    count = FAMILIES[pattern]
    for number in range(count):
        yield straight(region, count * spacing / density, angle + number * math.pi / count)


def straight(region: Region, period: float, angle: float) -> list[list[Array]]:
    """Pieces (2, 2) of the lines at whole periods (mm) from the origin, at an angle, rad, in a region; row by row."""
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


def crossings(borders: list[Array], level: float) -> Array:
    """Where borders (n, 2) cross a height, ascending; an even number. Points at that height within rounding errors count as below
    it, so that a border along it is on the same side whatever its last bits.
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


def honeycomb(region: Region, spacing: float, density: float, angle: float) -> list[Array]:
    """Lines (n, 2) that bound hexagons about the region: two lines along the same side are a spacing apart.

    A side of a mm, flat ones and slanted ones in turn: 4 a of bead on 3 a of line, lines a sqrt(3) / 2 + spacing apart.
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
    """Period, mm, of a gyroid whose sections have the requested density in the mean over the heights."""
    return GYROID_LENGTH * spacing / (2.0 * math.pi * density)


def gyroid(
    region: Region, spacing: float, density: float, angle: float, height: float, chord_error: float
) -> list[Array]:
    """The section at a height (mm) of sin x cos y + sin y cos z + sin z cos x = 0 as lines (n, 2) about a region.

    For a given z each line is a function of x, or of y, whichever its normal is nearer to: A cos y + B sin y = C is solved
    for y, so that points are exactly on the surface. Lines meet only where z is an odd multiple of pi / 4.
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
    """Lowest and highest coordinates (2,) of a region in axes turned by an angle, rad."""
    border = rotate_points(region.borders()[0], -angle)
    return border.min(axis=0), border.max(axis=0)
