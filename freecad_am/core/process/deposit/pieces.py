# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads cut into short pieces, for checks along their whole length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.columns import lengths
from ...geometry.step_count import step_counts
from ...toolpath import Toolpath
from ...types import Array, Index, Mask


@dataclass(frozen=True, eq=False)
class Pieces:
    """Beads cut into n short pieces in the order of deposit: middles, build and travel directions (n, 3), lengths (n,) mm, widths
    (n,) mm; along: mm from the start of the bead; layer, bead (counted over the toolpath), point: where each begins; closing (n,).
    """

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


def cut_beads(toolpath: Toolpath, share: float) -> Pieces:
    """Cut every bead of a toolpath into pieces no longer than a share of its width, or than the chord error.

    ValueError if the width of the beads is not known.
    """
    beads, width = list(toolpath), toolpath.bead_width
    if width is None:
        raise ValueError("it is not known how wide the beads count")
    size = np.array([len(bead) for _, _, bead in beads])
    points = np.concatenate([bead.points for _, _, bead in beads])
    build = np.concatenate([bead.build for _, _, bead in beads])
    wide = np.concatenate(
        [np.full(len(bead), width) if bead.width is None else bead.width for _, _, bead in beads]
    )
    bead_row = np.repeat(np.arange(len(beads)), size)
    start = np.delete(
        np.arange(len(points)), np.cumsum(size) - 1
    )  # of segments; beads end in points without one
    chord = points[start + 1] - points[start]
    length = lengths(chord)
    is_proper = length > 0.0
    start, chord, length = start[is_proper], chord[is_proper], length[is_proper]
    longest = np.maximum(share * 0.5 * (wide[start] + wide[start + 1]), toolpath.chord_error)
    count = step_counts(length, longest)
    row = np.repeat(np.arange(len(start)), count)
    number = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)
    middle = (number + 0.5) / count[row]
    start_row, piece_length = start[row], length[row] / count[row]
    mixed = build[start_row] + middle[:, None] * (build[start_row + 1] - build[start_row])
    bead = bead_row[start_row]
    along = np.cumsum(piece_length) - 0.5 * piece_length
    begins = np.flatnonzero(np.diff(bead, prepend=-1))
    along -= np.repeat(along[begins], np.diff(np.r_[begins, len(bead)]))
    return Pieces(
        points[start_row] + middle[:, None] * chord[row],
        mixed / lengths(mixed)[:, None],
        chord[row] / length[row, None],
        piece_length,
        wide[start_row] + middle * (wide[start_row + 1] - wide[start_row]),
        along,
        np.array([layer for layer, _, _ in beads])[bead],
        bead,
        start_row - (np.cumsum(size) - size)[bead],
        np.array([bead_.closing for _, _, bead_ in beads])[bead],
    )


def join_pieces(pieces: Pieces, share: float) -> Pieces:
    """Join the pieces of beads with dense points to pieces of about a share of the bead's width."""
    if not len(pieces):
        return pieces
    step = np.floor(pieces.along / (share * pieces.width)).astype(np.intp)
    new = (np.diff(pieces.bead, prepend=-1) != 0) | (np.diff(step, prepend=-1) != 0)
    starts = np.flatnonzero(new)
    if len(starts) == len(pieces):
        return pieces
    length = np.add.reduceat(pieces.length, starts)

    def mean(column: Array) -> Array:
        weighted = column * (pieces.length if column.ndim == 1 else pieces.length[:, None])
        means: Array = np.add.reduceat(weighted, starts, axis=0) / (
            length if column.ndim == 1 else length[:, None]
        )
        return means

    build, travel = mean(pieces.build), mean(pieces.travel)
    norm = np.maximum(
        lengths(travel), 1e-12
    )  # a piece that turns round within itself leads nowhere
    return Pieces(
        mean(pieces.middle),
        build / lengths(build)[:, None],
        travel / norm[:, None],
        length,
        mean(pieces.width),
        mean(pieces.along),
        pieces.layer[starts],
        pieces.bead[starts],
        pieces.point[starts],
        pieces.closing[starts],
    )
