# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads with how far a scan is off them: with points enough to follow it, and moved to it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..toolpath import Bead
from ..types import Array, Index, Mask

Ways = Callable[[Bead], Array]
Off = Callable[[Array, Array], Array]  # points (n, 3) and directions (n, 3): mm (n,) along these

LONGEST, SHORTEST = 8.0, 0.5  # mm between points, where the scan bends between them
CLOSE = 0.02  # mm that a scan may be off between points; less is not told from its noise
STEP = 0.25  # mm between samples
ROUNDS = 12
CORNER = 1e-6  # of the cosine: tangents that differ by more make a corner


@dataclass(frozen=True, eq=False)
class Scanned:
    """A bead with directions (n, 3) and how far (n,) mm along these the scan is off."""

    bead: Bead
    ways: Array
    off: Array

    def samples(self) -> tuple[Array, Array]:
        """Places (k, 3) along the bead, no farther apart than STEP, and how far (k,) the scan is off there."""
        way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(self.bead.points, axis=0), axis=1))]
        at = np.linspace(0.0, way[-1], max(2, int(np.ceil(way[-1] / STEP)) + 1))
        points = np.column_stack([np.interp(at, way, column) for column in self.bead.points.T])
        return points, np.interp(at, way, self.off)


def along_beads(
    beads: Sequence[Bead], ways: Ways, off: Off, share: float, tolerance: float
) -> list[Scanned]:
    """The beads with as many points as it takes for `share` of what a scan is off them to run straight from one to the
    next, within `tolerance` mm."""
    close = max(tolerance, CLOSE)
    points, directions = (
        np.concatenate([bead.points for bead in beads]),
        np.concatenate([ways(bead) for bead in beads]),
    )
    found = np.split(off(points, directions), np.cumsum([len(bead) for bead in beads])[:-1])
    known, open_ = list(beads), [np.ones(len(bead) - 1, dtype=np.bool_) for bead in beads]
    for _ in range(ROUNDS):
        asked = [k for k, some in enumerate(open_) if some.any()]
        if not asked:
            break
        segments = [np.flatnonzero(open_[k]) for k in asked]
        middles = [
            known[k].outline.at(some, 0.5)[0] for k, some in zip(asked, segments, strict=True)
        ]
        between = [_between(ways(known[k]), some) for k, some in zip(asked, segments, strict=True)]
        heights = np.split(
            off(np.concatenate(middles), np.concatenate(between)),
            np.cumsum([len(some) for some in segments])[:-1],
        )
        for k, some, high in zip(asked, segments, heights, strict=True):
            known[k], found[k], open_[k] = _halved(known[k], found[k], some, high, share, close)
    return [Scanned(bead, ways(bead), heights) for bead, heights in zip(known, found, strict=True)]


def _between(ways: Array, segments: Index) -> Array:
    mean = ways[segments] + ways[segments + 1]
    return np.asarray(mean / np.linalg.norm(mean, axis=1, keepdims=True))


def _halved(
    bead: Bead, off: Array, segments: Index, middle: Array, share: float, close: float
) -> tuple[Bead, Array, Mask]:
    """The bead with those of the segments halved that need it, what the scan is off it, and which segments to look at
    next."""
    length = np.linalg.norm(bead.points[segments + 1] - bead.points[segments], axis=1)
    bent = share * np.abs(middle - 0.5 * (off[segments] + off[segments + 1])) > close
    cut = (length > 2.0 * SHORTEST) & (bent | (length > LONGEST))
    chosen = segments[cut]
    again = np.zeros(len(bead) - 1 + len(chosen), dtype=np.bool_)
    if len(chosen):
        first = chosen + np.arange(len(chosen))
        again[first] = again[first + 1] = True
        bead, off = bead.halved(chosen), np.insert(off, chosen + 1, middle[cut])
    return bead, off, again


def moved(of: Scanned, share: float, thinner: float, height: float) -> Bead:
    """The bead moved by a share of what the scan is off it. thinner: 1/mm, by what share of the layer height, mm, it is
    thinner there for each mm that the scan is off; it is laid as much faster."""
    bead, shift = of.bead, share * of.off[:, None] * of.ways
    if bead.closed:
        shift[-1] = shift[0]
    high = 1.0 - thinner * of.off
    rise = np.r_[high[:1], 0.5 * (high[1:] + high[:-1])]
    changed = (
        {}
        if not thinner
        else {
            "speed": bead.speed / rise,
            "height": high * (height if bead.height is None else bead.height),
        }
    )
    return replace(bead, points=bead.points + shift, tangents=_tangents(bead, shift), **changed)


def _tangents(bead: Bead, shift: Array) -> Array | None:
    """Tangents of the bead when its points are shifted (n, 3); both alike where there is no corner."""
    if bead.tangents is None:
        return None
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)[:, None]
    rise = np.diff(shift, axis=0) / np.maximum(length, 1e-12)
    ends = (rise[-1:], rise[:1]) if bead.closed else (rise[:1], rise[-1:])
    before, after = np.vstack([ends[0], rise]), np.vstack([rise, ends[1]])
    smooth = ((bead.tangents[:, 0] * bead.tangents[:, 1]).sum(axis=1) > 1.0 - CORNER)[:, None]
    mean = 0.5 * (before + after)
    turned = bead.tangents + np.stack(
        [np.where(smooth, mean, before), np.where(smooth, mean, after)], axis=1
    )
    return np.asarray(turned / np.linalg.norm(turned, axis=2, keepdims=True))
