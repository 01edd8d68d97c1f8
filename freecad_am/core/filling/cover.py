# SPDX-License-Identifier: LGPL-2.1-or-later
"""How well beads, as wide as they are laid, cover a region: what they leave of it, and what of them lies beside it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..geometry.regions.region import Region, along, regions
from ..geometry.regions.strip import Strip
from ..types import Array
from .centre import thinned
from .curve import Beads, PlaneCurve
from .strip_closing import near_windows

COARSE = 0.01  # of half a bead; beads round a hub are looked at no finer
SHARES = 0.02  # of a bead's usual width; shares that differ by less are one

Piece = tuple[Array, bool]  # points (n, 2), and whether they close


class Cover(NamedTuple):
    """Areas, mm^2: of regions, what beads leave of them, what of beads lies beside them, and what beads cover, in and beside
    them."""

    whole: float = 0.0
    left: float = 0.0
    outside: float = 0.0
    once: float = 0.0


def total(covers: Sequence[Cover]) -> Cover:
    """Of all of several regions."""
    return Cover(*map(math.fsum, zip(*covers))) if covers else Cover()


def covered(region: Region | Strip, curves: Sequence[PlaneCurve], beads: Beads, density: float = 1.0) -> Cover:
    """How well beads cover a region; what they leave open on purpose, at a density below 1, does not count."""
    if isinstance(region, Strip):
        found = _of_strip(region, curves, beads)
    else:
        found = _of_parts((region,), [_widths(curve) for curve in curves], beads, ())
    return found if density == 1.0 else found._replace(left=0.0)


def _of_parts(
    parts: Sequence[Region], lines: Sequence[tuple[list[Piece], list[float]]], beads: Beads, pane: Sequence[Region]
) -> Cover:
    """Of parts of the plane, with what lies in a pane of it alone where there is one. lines: pieces of beads, and the share
    of the usual width of each."""
    pieces = [piece for some, _ in lines for piece in some]
    half = beads.inset * np.array([share for _, shares in lines for share in shares])
    covered = along(pieces, half, beads.chord_error) if pieces else ()
    covered = tuple(piece for part in covered for piece in part.common(pane)) if pane else covered
    whole = math.fsum(part.area for part in parts)
    inside = math.fsum(piece.area for part in parts for piece in part.common(covered)) if covered else 0.0
    once = math.fsum(piece.area for piece in covered)
    return Cover(whole, whole - inside, once - inside, once)


def _of_strip(strip: Strip, curves: Sequence[PlaneCurve], beads: Beads) -> Cover:
    """Window by window; beads of regions round a hub are as wide as usual."""
    period, found = strip.period, []
    beads = replace(beads, chord_error=max(beads.chord_error, COARSE * beads.inset))
    for window, near in near_windows(strip, curves, 2.0 * beads.inset):
        lines = [(thinned(points, closed, beads.chord_error), closed) for points, closed in near]
        parts = [
            part for cover in strip.between(window.low, window.high)
            for part in regions([period.unroll(ring, window.about) for ring in cover.rings()])
        ]
        pane = regions([period.unroll(strip.pane(window), window.about)])
        found.append(_of_parts(parts, [(lines, [1.0] * len(lines))], beads, pane))
    return total(found)


def _widths(curve: PlaneCurve) -> tuple[list[Piece], list[float]]:
    """A bead in pieces along which its width is one, and the share of the usual width of each."""
    if curve.share is None:
        return [(curve.points, curve.closed)], [1.0]
    share, points = curve.share, curve.points
    if np.ptp(share) < SHARES:
        return [(points, curve.closed)], [float(share.mean())]
    if curve.closed:
        share, points = np.r_[share, share[:1]], np.vstack([points, points[:1]])
    level = np.round(0.5 * (share[1:] + share[:-1]) / SHARES)
    starts = np.flatnonzero(np.diff(level, prepend=np.nan))
    ends = np.r_[starts[1:], len(level)]
    return (
        [(points[a : b + 1], False) for a, b in zip(starts.tolist(), ends.tolist())],
        [float(SHARES * level[a]) for a in starts.tolist()],
    )
