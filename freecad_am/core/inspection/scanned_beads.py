# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads with the offset of a scan: with points enough to follow it, and moved to it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..toolpath import Bead
from ..types import Array, Index, Mask

Ways = Callable[[Bead], Array]
Off = Callable[[Array, Array], Array]  # points (n, 3) and directions (n, 3): mm (n,) along these

MAX_SEGMENT_MM, MIN_SEGMENT_MM = 8.0, 0.5  # mm between points, where the scan bends between them
NOISE_MM = 0.02  # mm that a scan may be off between points; less is within its noise
STEP = 0.25  # mm between samples
ROUNDS = 12
CORNER = 1e-6  # of the cosine: tangents that differ by more make a corner


@dataclass(frozen=True, eq=False)
class Scanned:
    """A bead with directions (n, 3) and offsets (n,) mm of the scan along them."""

    bead: Bead
    directions: Array
    off: Array

    def samples(self) -> tuple[Array, Array]:
        """Points (k, 3) along the bead, at most STEP apart, and offsets (k,) of the scan there."""
        arc = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(self.bead.points, axis=0), axis=1))]
        samples_ = np.linspace(0.0, arc[-1], max(2, int(np.ceil(arc[-1] / STEP)) + 1))
        points = np.column_stack(
            [np.interp(samples_, arc, column) for column in self.bead.points.T]
        )
        return points, np.interp(samples_, arc, self.off)


def along_beads(
    beads: Sequence[Bead], directions_of: Ways, off: Off, share: float, tolerance: float
) -> list[Scanned]:
    """The beads with as many points as `share` of the scan offset needs to be linear between them, within `tolerance` mm."""
    close = max(tolerance, NOISE_MM)
    points, directions = (
        np.concatenate([bead.points for bead in beads]),
        np.concatenate([directions_of(bead) for bead in beads]),
    )
    offsets = np.split(off(points, directions), np.cumsum([len(bead) for bead in beads])[:-1])
    refined, open_ = list(beads), [np.ones(len(bead) - 1, dtype=np.bool_) for bead in beads]
    for _ in range(ROUNDS):
        pending = [k for k, rows in enumerate(open_) if rows.any()]
        if not pending:
            break
        segments = [np.flatnonzero(open_[k]) for k in pending]
        middles = [
            refined[k].outline.at(rows, 0.5)[0] for k, rows in zip(pending, segments, strict=True)
        ]
        between = [
            _between(directions_of(refined[k]), rows)
            for k, rows in zip(pending, segments, strict=True)
        ]
        heights = np.split(
            off(np.concatenate(middles), np.concatenate(between)),
            np.cumsum([len(rows) for rows in segments])[:-1],
        )
        for k, rows, high in zip(pending, segments, heights, strict=True):
            refined[k], offsets[k], open_[k] = _halved(
                refined[k], offsets[k], rows, high, share, close
            )
    return [
        Scanned(bead, directions_of(bead), heights)
        for bead, heights in zip(refined, offsets, strict=True)
    ]


def _between(directions: Array, segments: Index) -> Array:
    mean = directions[segments] + directions[segments + 1]
    return np.asarray(mean / np.linalg.norm(mean, axis=1, keepdims=True))


def _halved(
    bead: Bead, off: Array, segments: Index, middle: Array, share: float, close: float
) -> tuple[Bead, Array, Mask]:
    """The bead with the needed segments halved, its scan offsets, and the segments to check next."""
    length = np.linalg.norm(bead.points[segments + 1] - bead.points[segments], axis=1)
    bent = share * np.abs(middle - 0.5 * (off[segments] + off[segments + 1])) > close
    cut = (length > 2.0 * MIN_SEGMENT_MM) & (bent | (length > MAX_SEGMENT_MM))
    halved_rows = segments[cut]
    again = np.zeros(len(bead) - 1 + len(halved_rows), dtype=np.bool_)
    if len(halved_rows):
        new_rows = halved_rows + np.arange(len(halved_rows))
        again[new_rows] = again[new_rows + 1] = True
        bead, off = bead.halved(halved_rows), np.insert(off, halved_rows + 1, middle[cut])
    return bead, off, again


def move_bead(scanned: Scanned, share: float, thinner: float, height: float) -> Bead:
    """The bead moved by a share of the scan offset. thinner: 1/mm, reduction of the layer height, mm, per mm of offset, as a share;
    the bead is deposited as much faster.
    """
    bead, shift = scanned.bead, share * scanned.off[:, None] * scanned.directions
    if bead.closed:
        shift[-1] = shift[0]
    high = 1.0 - thinner * scanned.off
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
    """Tangents of the bead when its points are shifted (n, 3); equal on both sides without a corner."""
    if bead.tangents is None:
        return None
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)[:, None]
    rise = np.diff(shift, axis=0) / np.maximum(length, 1e-12)
    ends = (rise[-1:], rise[:1]) if bead.closed else (rise[:1], rise[-1:])
    incoming, outgoing = np.vstack([ends[0], rise]), np.vstack([rise, ends[1]])
    smooth = ((bead.tangents[:, 0] * bead.tangents[:, 1]).sum(axis=1) > 1.0 - CORNER)[:, None]
    mean = 0.5 * (incoming + outgoing)
    turned = bead.tangents + np.stack(
        [np.where(smooth, mean, incoming), np.where(smooth, mean, outgoing)], axis=1
    )
    return np.asarray(turned / np.linalg.norm(turned, axis=2, keepdims=True))
