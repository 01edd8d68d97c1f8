# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads in what other beads leave open of a region that runs all the way round a hub: window by window on the plane."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ..geometry.regions.region import Region
from ..geometry.regions.several import grow_regions, intersect_regions
from ..geometry.regions.strip import Strip, Window
from .centre import centre_beads, left_open
from .curve import Beads, PlaneCurve

REACH = 3.0  # spacings beside a window that tell what is open in it


def strip_closing(
    strip: Strip, curves: Sequence[PlaneCurve], beads: Beads, ring: int, kind: str
) -> list[PlaneCurve]:
    """Beads in what curves leave open, wider than the gap allowed; cut where windows meet."""
    return [
        replace(curve, points=points, sheet=sheet)
        for window, gaps, inner in open_windows(strip, curves, beads)
        for curve in centre_beads(gaps, beads, ring, inner, kind)
        for points, sheet in (strip.moved_back(window, curve.points),)
    ]


def open_windows(
    strip: Strip, curves: Sequence[PlaneCurve], beads: Beads
) -> list[tuple[Window, list[Region], tuple[Region, ...]]]:
    """Window by window, laid flat about its middle, what is open and where beads may lie."""
    found = []
    for window, adjacent in near_windows(strip, curves, REACH * beads.spacing):
        inner = grow_regions(strip.flat(window, with_margin=True), -beads.inset, beads.chord_error)
        if inner:
            found.append(
                (
                    window,
                    list(intersect_regions(left_open(adjacent, inner, beads), strip.pane(window))),
                    inner,
                )
            )
    return found


def near_windows(
    strip: Strip, curves: Sequence[PlaneCurve], reach: float
) -> Iterator[tuple[Window, list[PlaneCurve]]]:
    """Windows of a strip with what of curves lies in each or up to `reach` mm beside it, laid flat about its middle."""
    curves = [
        replace(curve, points=strip.period.unwrap_curve(curve.points, curve.sheet, curve.turns))
        for curve in curves
    ]
    for window in strip.windows(reach):
        yield (
            window,
            [
                PlaneCurve(points, closed, curve.kind, curve.ring)
                for curve in curves
                for points, closed in strip.near(
                    window, curve.points, curve.closed and not curve.turns
                )
            ],
        )
