# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads cut into short pieces, for what is looked at all along them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.columns import lengths
from ...geometry.step_count import step_counts
from ...toolpath import Toolpath
from ...types import Array, Index, Mask


@dataclass(frozen=True, eq=False)
class Pieces:
    """Beads cut into n short pieces in the order of deposit: middles, build and travel directions (n, 3), lengths (n,) mm,
    widths (n,) mm; along: mm from the start of the bead; layer, bead (of all), point: where each begins; closing (n,)."""

    middle: Array
    build: Array
    travel: Array
    length: Array
    width: Array
    along: Array
    layer: Index
    bead: Index
    point: Index
    closing: Mask

    def __len__(self) -> int:
        return len(self.middle)


def cut(toolpath: Toolpath, share: float) -> Pieces:
    """All beads of a toolpath in pieces no longer than a share of their width, but for the chord error, by which they count
    as wider. ValueError where it is not known how wide they are."""
    beads, width = list(toolpath), toolpath.bead_width
    if width is None:
        raise ValueError("it is not known how wide the beads count")
    size = np.array([len(bead) for _, _, bead in beads])
    points = np.concatenate([bead.points for _, _, bead in beads])
    build = np.concatenate([bead.build for _, _, bead in beads])
    wide = np.concatenate(
        [np.full(len(bead), width) if bead.width is None else bead.width for _, _, bead in beads]
    )
    of = np.repeat(np.arange(len(beads)), size)
    start = np.delete(
        np.arange(len(points)), np.cumsum(size) - 1
    )  # of segments; beads end in points without one
    way = points[start + 1] - points[start]
    length = lengths(way)
    kept = length > 0.0
    start, way, length = start[kept], way[kept], length[kept]
    longest = np.maximum(share * 0.5 * (wide[start] + wide[start + 1]), toolpath.chord_error)
    count = step_counts(length, longest)
    row = np.repeat(np.arange(len(start)), count)
    number = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)
    middle = (number + 0.5) / count[row]
    first, part = start[row], length[row] / count[row]
    mixed = build[first] + middle[:, None] * (build[first + 1] - build[first])
    bead = of[first]
    along = np.cumsum(part) - 0.5 * part
    begins = np.flatnonzero(np.diff(bead, prepend=-1))
    along -= np.repeat(along[begins], np.diff(np.r_[begins, len(bead)]))
    return Pieces(
        points[first] + middle[:, None] * way[row],
        mixed / lengths(mixed)[:, None],
        way[row] / length[row, None],
        part,
        wide[first] + middle * (wide[first + 1] - wide[first]),
        along,
        np.array([layer for layer, _, _ in beads])[bead],
        bead,
        first - (np.cumsum(size) - size)[bead],
        np.array([one.closing for _, _, one in beads])[bead],
    )


def joined(pieces: Pieces, share: float) -> Pieces:
    """Those of beads with points close together, which else are as many as there are points, joined to pieces of about a
    share of the bead's width."""
    if not len(pieces):
        return pieces
    step = np.floor(pieces.along / (share * pieces.width)).astype(np.intp)
    new = (np.diff(pieces.bead, prepend=-1) != 0) | (np.diff(step, prepend=-1) != 0)
    first = np.flatnonzero(new)
    if len(first) == len(pieces):
        return pieces
    length = np.add.reduceat(pieces.length, first)

    def mean(column: Array) -> Array:
        weighted = column * (pieces.length if column.ndim == 1 else pieces.length[:, None])
        found: Array = np.add.reduceat(weighted, first, axis=0) / (
            length if column.ndim == 1 else length[:, None]
        )
        return found

    build, travel = mean(pieces.build), mean(pieces.travel)
    known = np.maximum(
        lengths(travel), 1e-12
    )  # a piece that turns round within itself leads nowhere
    return Pieces(
        mean(pieces.middle),
        build / lengths(build)[:, None],
        travel / known[:, None],
        length,
        mean(pieces.width),
        mean(pieces.along),
        pieces.layer[first],
        pieces.bead[first],
        pieces.point[first],
        pieces.closing[first],
    )
