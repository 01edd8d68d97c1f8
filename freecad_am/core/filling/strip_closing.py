# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads in what other beads leave open of a region that runs all the way round a hub: window by window on the plane."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ..geometry.regions.region import Region, regions
from ..geometry.regions.strip import Strip, Window
from ..types import Array
from .centre import centre_beads, left_open
from .curve import Beads, PlaneCurve, long_enough

REACH = 3.0  # spacings beside a window that tell what is open in it


def strip_closing(strip: Strip, curves: Sequence[PlaneCurve], beads: Beads, ring: int, kind: str) -> list[PlaneCurve]:
    """Beads in what curves leave open, wider than the gap allowed; cut where windows meet."""
    found = []
    for window, left, inner in _open(strip, curves, beads):
        for curve in centre_beads(left, beads, ring, inner, kind):
            cover = strip.period.unrolled(curve.points) + np.array([window.about, 0.0])
            found.append(replace(curve, points=strip.period.unroll(cover), sheet=float(cover[:, 0].mean())))
    return long_enough(found, beads.shortest)


def strip_left_open(strip: Strip, curves: Sequence[PlaneCurve], beads: Beads) -> list[tuple[Array, float]]:
    """Places (2,) on the plane that curves leave open, wider than the gap allowed, and how wide (mm) each is."""
    return [
        (strip.period.unroll(strip.period.unrolled(part.inside()[None]) + np.array([window.about, 0.0]))[0], part.width)
        for window, left, _ in _open(strip, curves, beads) for part in left
    ]


def _open(
    strip: Strip, curves: Sequence[PlaneCurve], beads: Beads
) -> list[tuple[Window, list[Region], tuple[Region, ...]]]:
    """Window by window, laid flat about its middle, what is open and where beads may lie."""
    period, found = strip.period, []
    for window, near in near_windows(strip, curves, REACH * beads.spacing):
        here = [
            part for cover in strip.between(window.low - window.margin, window.high + window.margin)
            for part in regions([period.unroll(line, window.about) for line in cover.rings()])
        ]
        inner = tuple(piece for part in here for piece in part.grown(-beads.inset, beads.chord_error))
        if inner:
            pane = regions([period.unroll(strip.pane(window), window.about)])
            left = [piece for part in left_open(near, inner, beads) for piece in part.common(pane)]
            found.append((window, left, inner))
    return found


def near_windows(
    strip: Strip, curves: Sequence[PlaneCurve], reach: float
) -> Iterator[tuple[Window, list[tuple[Array, bool]]]]:
    """Windows of a strip with what of curves lies in each or up to `reach` mm beside it, laid flat about its middle: points
    (n, 2), and whether they close."""
    period = strip.period
    covers = [(_unrolled(strip, curve), curve.closed and not curve.turns) for curve in curves]
    for window in strip.windows(reach):
        yield window, [
            (period.unroll(line, window.about), closed) for cover, whole in covers
            for line, closed in _near(cover, whole, window, period.around)
        ]


def _unrolled(strip: Strip, curve: PlaneCurve) -> Array:
    """A curve in (u, v), one round the hub to where it begins again."""
    cover, turn = strip.period.followed(curve.points, curve.sheet), strip.period.around
    return np.vstack([cover, cover[:1] + np.array([curve.turns * turn, 0.0])]) if curve.turns else cover


def _near(cover: Array, whole: bool, window: Window, turn: float) -> list[tuple[Array, bool]]:
    """What of a curve lies in a window or beside it, in all turns; `whole`: it is closed on the plane."""
    low, high = window.low - window.margin, window.high + window.margin
    found = []
    first, last = np.ceil((low - cover[:, 0].max()) / turn), np.floor((high - cover[:, 0].min()) / turn)
    for k in range(int(first), int(last) + 1):
        line = cover + np.array([k * turn, 0.0])
        if whole:
            found.append((line, True))
            continue
        within = (line[:, 0] >= low) & (line[:, 0] <= high)
        edge = within[1:] | within[:-1] | ((line[1:, 0] < low) & (line[:-1, 0] > high)) | (
            (line[1:, 0] > high) & (line[:-1, 0] < low))
        change = np.diff(np.r_[False, edge, False].astype(int))
        runs = zip(np.flatnonzero(change > 0), np.flatnonzero(change < 0))
        found += [(line[a : b + 1], False) for a, b in runs]
    return found
