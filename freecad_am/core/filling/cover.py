# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coverage of a region by its beads: missed area and stray area."""

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

COARSE = 0.01  # of half a bead; finest chord error of beads round a hub
DOT = 1e-6  # of a dot's length: the line about which its disc is drawn

Line = tuple[Array, bool]  # points (n, 2), and whether they close


class Cover(NamedTuple):
    """Areas, mm^2: of regions, their missed area, the stray area of beads, and the area covered inside and outside."""

    area: float = 0.0
    missed: float = 0.0
    outside: float = 0.0
    covered: float = 0.0

    def scaled(self, share: float) -> Cover:
        """The cover of a layer with another height, as a share."""
        return Cover(*(share * area for area in self))

    def over(self, area: float) -> float:
        """Over-deposited area of beads of an area, mm^2."""
        return area - self.covered


def total(covers: Sequence[Cover]) -> Cover:
    """The sum over several regions."""
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
        Middles of the beads in the plane of the region.
    beads : Beads
        The usual width and the chord error, mm.
    density : float, optional
        Share of the area to fill; below 1 open areas are intended and count as not missed.

    Returns
    -------
    Cover
        Areas of the region, missed, outside and covered, mm^2.
    """
    if isinstance(
        region, Strip
    ):  # window by window; beads of regions round a hub are as wide as usual
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
    """The cover of regions of the plane, limited to a pane if given. widths: lines of beads, and the share of the usual width of
    each.
    """
    lines = [line for region_lines, _ in widths for line in region_lines]
    half = beads.inset * np.array([share for _, shares in widths for share in shares])
    total_area = math.fsum(region.area for region in regions)
    if not lines:
        return Cover(total_area, total_area)
    inside, area = measure_bands(regions, lines, half, beads.chord_error, pane)
    return Cover(total_area, total_area - inside, area - inside, area)


def _lines(curves: Sequence[PlaneCurve], chord_error: float) -> tuple[list[Line], list[float]]:
    """Beads as wide as usual in lines, and the share of the usual width of each."""
    lines = [
        (simplified(curve.points, chord_error, curve.closed), curve.closed) for curve in curves
    ]
    return lines, [1.0] * len(lines)


def _widths(curve: PlaneCurve, beads: Beads) -> tuple[list[Line], list[float]]:
    """A bead as lines of constant width, and the share of the usual width of each. A dot is a disc as large as its fed volume."""
    if curve.dot:
        share = 1.0 if curve.share is None else curve.share[0]
        fed = 2.0 * beads.inset * share * length(curve.points, curve.closed)
        middle = curve.points.mean(axis=0)
        ends = middle + DOT * (curve.points[[0, len(curve.points) // 2]] - middle)
        return [(ends, False)], [math.sqrt(fed / math.pi) / beads.inset]
    points, share = curve.deposit(beads.inset)
    return split_by_width(points, share)
