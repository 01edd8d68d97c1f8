# SPDX-License-Identifier: LGPL-2.1-or-later
"""Over-deposition in a layer of beads that fill no region: walls that approach each other or themselves, curves that meet,
cross or coincide.

A piece of a bead shares with an adjacent one the excess of their widths over their distance; each has half. For beads that
cross at an angle, it is their widths over its sine, the area they share.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.columns import dots, lengths
from ...toolpath import Toolpath
from ...types import Array, Index, Mask
from .pieces import Pieces, cut_beads, join_pieces

PIECE = 0.125  # of a bead's width
SAME_LAYER_HEIGHTS = (
    0.5  # layer heights above or below; beyond, a piece belongs to another turn of a spiral
)
ROUND = 1.6  # arc over chord; a bead returns to itself after more than half a circle
ACROSS = 0.3  # cosine of the angle between beads that cross rather than run side by side
PIECE_END_SHARE = 0.75  # of a piece's length from its middle along it; beyond, a position is past the end of a bead


def deposited_twice(toolpath: Toolpath) -> float:
    """mm3 of beads deposited where another bead of the layer, or the same bead, is."""
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
    """mm2 that the beads of a layer share, counted once."""
    middle, width = pieces.middle[layer], pieces.width[layer]
    pairs: Index = (
        cKDTree(middle).query_pairs(float(width.max()), output_type="ndarray").astype(np.intp)
    )
    i, j = np.vstack([pairs, pairs[:, ::-1]]).T
    is_pair = _side_by_side(pieces, layer.start + i, layer.start + j, around)
    if not is_pair.any():  # of most layers with one bead
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
    across = np.abs(dots(travel, along)) < ACROSS  # it is on both sides, and there once
    side = (dots(np.cross(build, travel), level_way) > 0.0) & ~across
    largest = np.zeros((2, len(middle)))
    for k in (0, 1):
        on_side = is_over & (side == bool(k))
        np.maximum.at(largest[k], i[on_side], over[on_side])
    return float(0.5 * np.minimum(largest.sum(axis=0), width) @ pieces.length[layer])


def _side_by_side(pieces: Pieces, i: Index, j: Index, around: Array) -> Mask:
    """Which pairs of pieces belong to two beads, or to one bead that returns to itself."""
    arc = np.abs(pieces.along[i] - pieces.along[j])
    arc = np.minimum(arc, around[pieces.bead[i]] - arc)
    chord = lengths(pieces.middle[i] - pieces.middle[j])
    result: Mask = (pieces.bead[i] != pieces.bead[j]) | (
        arc > ROUND * np.maximum(chord, pieces.width[i] / 2.0)
    )
    return result
