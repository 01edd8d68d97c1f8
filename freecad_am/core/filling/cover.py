# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measure how beads cover a region: missed, stray and over-deposited area."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..geometry.curves.plane_curve import length
from ..geometry.regions.region import Region, measure_bands, simplified
from ..geometry.regions.strip import Strip
from ..types import Array
from .centre import Beads, PlaneCurve, near_windows, split_by_width

COARSE = 0.01  # in half bead widths; minimum chord error of beads around a hub
DOT = 1e-6  # fraction of a dot's length; length of the line whose offset is the disc of the dot

Line = tuple[Array, bool]  # points (n, 2), and whether the line is closed


class Cover(NamedTuple):
    """Areas, mm^2.

    area: regions. missed: regions without bead. outside: stray beads. covered: beads in total,
    overlaps counted once.
    """

    area: float = 0.0
    missed: float = 0.0
    outside: float = 0.0
    covered: float = 0.0

    def scaled(self, share: float) -> Cover:
        """Multiply all areas by `share`, such as for another layer height."""
        return Cover(*(share * area for area in self))

    def over(self, area: float) -> float:
        """Return the over-deposited area, mm^2, of beads whose deposited area is `area` mm^2."""
        return area - self.covered


def total(covers: Sequence[Cover]) -> Cover:
    """Sum the covers of several regions."""
    return Cover(*map(math.fsum, zip(*covers))) if covers else Cover()


def measure_cover(
    region: Region | Strip, curves: Sequence[PlaneCurve], beads: Beads, density: float = 1.0
) -> Cover:
    """Measure how beads cover a region.

    Parameters
    ----------
    region : Region or Strip
        The region, mm; a strip is measured window by window.
    curves : sequence of PlaneCurve
        Centrelines of the beads in the plane of the region.
    beads : Beads
        Nominal width and chord error, mm.
    density : float, optional
        Fraction of the area to fill. Below 1, open areas are intended and no area counts as missed.

    Returns
    -------
    Cover
        Areas of the region, missed, outside and covered, mm^2.
    """
    if isinstance(region, Strip):  # beads around a hub have the nominal width
        beads = replace(beads, chord_error=max(beads.chord_error, COARSE * beads.inset))
        cover = total(
            [
                _cover_regions(
                    region.flat(window),
                    [_lines(adjacent, beads.chord_error)],
                    beads,
                    region.pane(window),
                )
                for window, adjacent in near_windows(region, curves, 2.0 * beads.inset)
            ]
        )
    else:
        cover = _cover_regions((region,), [_widths(curve, beads) for curve in curves], beads, ())
    return cover if density == 1.0 else cover._replace(missed=0.0)


def _cover_regions(
    regions: Sequence[Region],
    widths: Sequence[tuple[list[Line], list[float]]],
    beads: Beads,
    pane: Sequence[Region],
) -> Cover:
    """Measure the cover of plane regions, limited to a pane if given.

    widths: lines of each bead, and the width of each line as a fraction of the nominal width.
    """
    lines = [line for region_lines, _ in widths for line in region_lines]
    half = beads.inset * np.array([share for _, shares in widths for share in shares])
    total_area = math.fsum(region.area for region in regions)
    if not lines:
        return Cover(total_area, total_area)
    inside, area = measure_bands(regions, lines, half, beads.chord_error, pane)
    return Cover(total_area, total_area - inside, area - inside, area)


def _lines(curves: Sequence[PlaneCurve], chord_error: float) -> tuple[list[Line], list[float]]:
    """Return beads of nominal width as lines, each with bead share 1."""
    lines = [
        (simplified(curve.points, chord_error, curve.closed), curve.closed) for curve in curves
    ]
    return lines, [1.0] * len(lines)


def _widths(curve: PlaneCurve, beads: Beads) -> tuple[list[Line], list[float]]:
    """Return a bead as lines of constant width, and the bead share of each line.

    A dot becomes a disc with the deposited area of the dot.
    """
    if curve.dot:
        share = 1.0 if curve.share is None else curve.share[0]
        fed = 2.0 * beads.inset * share * length(curve.points, curve.closed)
        middle = curve.points.mean(axis=0)
        ends = middle + DOT * (curve.points[[0, len(curve.points) // 2]] - middle)
        return [(ends, False)], [math.sqrt(fed / math.pi) / beads.inset]
    points, share = curve.deposit(beads.inset)
    return split_by_width(points, share)
