# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads laid over others of their layer, where none of them fill a region: walls that come near to each other or to
themselves, curves that meet, cross or are there twice.

A piece of a bead shares with another beside it what of their widths is more than they are apart; each has half of that. Of
beads that cross at an angle that comes to their widths over its sine, which is what they share.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.columns import dots, lengths
from ...toolpath import Toolpath
from ...types import Array, Index, Mask
from .pieces import Pieces, cut, joined

PIECE = 0.125  # of a bead's width
LEVEL = 0.5  # layer heights above or below; what is farther is of another turn of a spiral
ROUND = 1.6  # arc over chord; a bead comes beside itself where it returns farther round than half a circle
ACROSS = 0.3  # cosine of the angle between beads that cross rather than run beside each other
BEYOND = (
    0.75  # of a piece's length from its middle along it; what is farther is past the end of a bead
)


def deposited_twice(toolpath: Toolpath) -> float:
    """mm3 of beads that lie where others of their layer do, or the same bead does."""
    pieces = joined(cut(toolpath, PIECE), PIECE)
    ends = np.searchsorted(pieces.layer, np.arange(len(toolpath.layers) + 1))
    closed = np.array([bead.closed for _, _, bead in toolpath])
    around = np.where(
        closed, np.bincount(pieces.bead, pieces.length, minlength=len(closed)), np.inf
    )
    shared = 0.0
    for start, end in zip(ends.tolist(), ends[1:].tolist()):
        if end - start > 1:
            shared += _shared(pieces, slice(start, end), around, LEVEL * toolpath.layer_height)
    return toolpath.layer_height * shared


def _shared(pieces: Pieces, layer: slice, around: Array, level: float) -> float:
    """mm2 that the beads of a layer share, counted once."""
    middle, width = pieces.middle[layer], pieces.width[layer]
    pairs: Index = (
        cKDTree(middle).query_pairs(float(width.max()), output_type="ndarray").astype(np.intp)
    )
    one, other = np.vstack([pairs, pairs[:, ::-1]]).T
    kept = _side_by_side(pieces, layer.start + one, layer.start + other, around)
    if not kept.any():  # of most layers with one bead
        return 0.0
    one, other = one[kept], other[kept]
    build, travel = pieces.build[layer][one], pieces.travel[layer][one]
    way = middle[other] - middle[one]
    up = dots(way, build)
    level_way = way - up[:, None] * build
    along = pieces.travel[layer][other]
    ahead = dots(level_way, along)
    over = 0.5 * (width[one] + width[other]) - lengths(level_way - ahead[:, None] * along)
    past = np.abs(ahead) > BEYOND * pieces.length[layer][other]
    some = (over > 0.0) & (np.abs(up) < level) & ~past
    across = np.abs(dots(travel, along)) < ACROSS  # it is on both sides, and there once
    side = (dots(np.cross(build, travel), level_way) > 0.0) & ~across
    most = np.zeros((2, len(middle)))
    for k in (0, 1):
        mine = some & (side == bool(k))
        np.maximum.at(most[k], one[mine], over[mine])
    return float(0.5 * np.minimum(most.sum(axis=0), width) @ pieces.length[layer])


def _side_by_side(pieces: Pieces, one: Index, other: Index, around: Array) -> Mask:
    """Which pairs of pieces are of two beads, or of one that comes beside itself."""
    arc = np.abs(pieces.along[one] - pieces.along[other])
    arc = np.minimum(arc, around[pieces.bead[one]] - arc)
    chord = lengths(pieces.middle[one] - pieces.middle[other])
    found: Mask = (pieces.bead[one] != pieces.bead[other]) | (
        arc > ROUND * np.maximum(chord, pieces.width[one] / 2.0)
    )
    return found
