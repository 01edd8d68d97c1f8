# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads divided into short pieces, for checks along the whole length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.columns import dots, lengths
from ...geometry.step_count import step_counts
from ...toolpath import Toolpath
from ...types import Array, Index, Mask


@dataclass(frozen=True, eq=False)
class Pieces:
    """Beads divided into n short pieces in print order.

    middle: (n, 3) midpoints, mm. build, travel: (n, 3) build and travel directions. length, width: (n,) mm. along: (n,)
    arc length from the start of the bead, mm. layer, bead (counted over the toolpath), point: (n,) indices of the
    piece's start. closing: (n,) whether the bead closes a gap.
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
    """Divide every bead into pieces at most as long as a fraction of its width, or as the chord error.

    Raises ValueError if the bead width is unknown.
    """
    beads, width = list(toolpath), toolpath.bead_width
    if width is None:
        raise ValueError("the effective bead width is unknown")
    size = np.array([len(bead) for _, _, bead in beads])
    points = np.concatenate([bead.points for _, _, bead in beads])
    build = np.concatenate([bead.build for _, _, bead in beads])
    wide = np.concatenate(
        [np.full(len(bead), width) if bead.width is None else bead.width for _, _, bead in beads]
    )
    bead_row = np.repeat(np.arange(len(beads)), size)
    start = np.delete(
        np.arange(len(points)), np.cumsum(size) - 1
    )  # segments start at all points except bead ends
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
        np.array([bead_.role.closing for _, _, bead_ in beads])[bead],
    )


def join_pieces(pieces: Pieces, share: float) -> Pieces:
    """Join short pieces of beads with dense points into pieces of about a fraction of the bead width."""
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
    )  # a piece that reverses within itself has no travel direction
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


PIECE = 0.125  # fraction of the bead width; length of a piece
SAME_LAYER_HEIGHTS = (
    0.5  # layer heights; maximum height difference of pieces in the same turn of a spiral
)
ROUND = (
    1.6  # ratio of arc to chord above which a bead returns to itself, after more than half a circle
)
ACROSS = (
    0.3  # cosine of the angle between beads below which they cross rather than run side by side
)
PIECE_END_SHARE = (
    0.75  # piece lengths from the midpoint; a farther position is past the end of the bead
)


def deposited_twice(toolpath: Toolpath) -> float:
    """Return the over-deposition within layers, mm3, by other beads or by the same bead."""
    pieces = join_pieces(cut_beads(toolpath, PIECE), PIECE)
    ends = np.searchsorted(pieces.layer, np.arange(len(toolpath.layers) + 1))
    closed = np.array([bead.closed for _, _, bead in toolpath])
    around = np.where(
        closed, np.bincount(pieces.bead, pieces.length, minlength=len(closed)), np.inf
    )
    shared = 0.0
    for start, end in zip(ends.tolist(), ends[1:].tolist()):
        if end - start > 1:
            shared += _shared(
                pieces, slice(start, end), around, SAME_LAYER_HEIGHTS * toolpath.layer_height
            )
    return toolpath.layer_height * shared


def _shared(pieces: Pieces, layer: slice, around: Array, level: float) -> float:
    """Return the overlap area of the beads of a layer, counted once, mm2."""
    middle, width = pieces.middle[layer], pieces.width[layer]
    pairs: Index = (
        cKDTree(middle).query_pairs(float(width.max()), output_type="ndarray").astype(np.intp)
    )
    i, j = np.vstack([pairs, pairs[:, ::-1]]).T
    is_pair = _side_by_side(pieces, layer.start + i, layer.start + j, around)
    if not is_pair.any():  # true for most layers with a single bead
        return 0.0
    i, j = i[is_pair], j[is_pair]
    build, travel = pieces.build[layer][i], pieces.travel[layer][i]
    offset = middle[j] - middle[i]
    up = dots(offset, build)
    level_way = offset - up[:, None] * build
    along = pieces.travel[layer][j]
    ahead = dots(level_way, along)
    over = 0.5 * (width[i] + width[j]) - lengths(level_way - ahead[:, None] * along)
    past = np.abs(ahead) > PIECE_END_SHARE * pieces.length[layer][j]
    is_over = (over > 0.0) & (np.abs(up) < level) & ~past
    across = (
        np.abs(dots(travel, along)) < ACROSS
    )  # a crossing bead is on both sides but counts once
    side = (dots(np.cross(build, travel), level_way) > 0.0) & ~across
    largest = np.zeros((2, len(middle)))
    for k in (0, 1):
        on_side = is_over & (side == bool(k))
        np.maximum.at(largest[k], i[on_side], over[on_side])
    return float(0.5 * np.minimum(largest.sum(axis=0), width) @ pieces.length[layer])


def _side_by_side(pieces: Pieces, i: Index, j: Index, around: Array) -> Mask:
    """Return which pairs of pieces belong to two beads, or to one bead that returns to itself."""
    arc = np.abs(pieces.along[i] - pieces.along[j])
    arc = np.minimum(arc, around[pieces.bead[i]] - arc)
    chord = lengths(pieces.middle[i] - pieces.middle[j])
    result: Mask = (pieces.bead[i] != pieces.bead[j]) | (
        arc > ROUND * np.maximum(chord, pieces.width[i] / 2.0)
    )
    return result
