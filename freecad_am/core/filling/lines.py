# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parallel lines at an angle, half a bead inside the border or inside contours, separate or linked to zigzags."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..geometry.curves.plane_curve import rotate_points
from ..geometry.regions.region import Region
from ..geometry.regions.several import grow_regions, select_longer, shrink_region
from ..geometry.step_count import round_down, step_count
from ..types import Array
from .centre import outermost
from .curve import Beads, PlaneCurve, contours_of
from .lattice import crossings
from .zigzag import in_rows

LINK_INSET_SPACINGS = 0.4  # of the spacing; a link on the edge of a contour's bead is half on it, one at 0.5 leaves its corners open
MAX_NARROWING, MAX_WIDENING = (
    0.01,
    0.002,
)  # of the spacing; lines are moved no more than that so that they come out even


class Frame(NamedTuple):
    """Room for lines. curves: the contours round the lines, if any; regions: the borders between which lines are spread; ends: the
    regions that lines run through, which reach onto the contour; thin: beads in regions narrower than a bead.
    """

    curves: list[PlaneCurve]
    regions: tuple[Region, ...]
    ends: tuple[Region, ...]
    thin: list[PlaneCurve]


def frame(region: Region, inner: tuple[Region, ...], beads: Beads, walls: int) -> Frame:
    """The room for lines: half a bead inside the border, or a spacing inside of the last of `walls` contours deposited first, on
    which they end. inner: allowed positions of bead middles.
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
        curves, grow_regions(inner, -2.0 * half, error), grow_regions(inner, -half, error), thin
    )


def lines(
    framed: Frame, beads: Beads, angle: float, walls: int, longest_link: float | None
) -> list[PlaneCurve]:
    """Lines at an angle (rad) within a frame of `walls` contours, every other one reversed.

    First and last line are half a bead inside the border (with walls: a spacing inside of the last), and the rest at the spacing
    from these. If the breadth is not a multiple of the spacing the lines move evenly by at most MAX_NARROWING and MAX_WIDENING;
    otherwise the remainder is in the middle and has its own line. With walls, lines end on the last.

    longest_link: mm; lines are linked to zigzags along the border of the beads' room, so that no link is outside; next to contours
    links are inside of their beads, to reduce over-deposition. None: no line is linked.
    """
    inside = LINK_INSET_SPACINGS * beads.spacing if walls else 0.0
    return in_rows(rows(framed, beads, angle), framed.ends, beads, walls, longest_link, inside)


def rows(framed: Frame, beads: Beads, angle: float) -> list[list[Array]]:
    """Level by level the segments (2, 2) of lines, all in the direction of the angle (rad)."""
    if (
        not framed.regions or not framed.ends
    ):  # too narrow for lines; such regions get beads along their middle
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
    """Heights of lines from `low` to `high`, see `lines`."""
    spacing, breadth = beads.spacing, high - low
    hair = 1e-7 * spacing + 1e-12 * max(
        abs(low), abs(high)
    )  # lines along the border cross it for sure
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
