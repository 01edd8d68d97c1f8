# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads in the gaps of a region that runs all the way round a hub: window by window on the plane."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ..geometry.regions.region import Region
from ..geometry.regions.several import grow_regions, intersect_regions
from ..geometry.regions.strip import Strip, Window
from .centre import centre_beads, open_regions
from .curve import Beads, PlaneCurve

REACH = 3.0  # spacings around a window that decide about its open regions


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
    """Window by window, unrolled about its middle: the open regions and the room for bead middles."""
    windows = []
    for window, adjacent in near_windows(strip, curves, REACH * beads.spacing):
        inner = grow_regions(strip.flat(window, with_margin=True), -beads.inset, beads.chord_error)
        if inner:
            windows.append(
                (
                    window,
                    list(
                        intersect_regions(open_regions(adjacent, inner, beads), strip.pane(window))
                    ),
                    inner,
                )
            )
    return windows


def near_windows(
    strip: Strip, curves: Sequence[PlaneCurve], reach: float
) -> Iterator[tuple[Window, list[PlaneCurve]]]:
    """Windows of a strip with the sections of curves within `reach` mm, unrolled about the middle of the window."""
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
