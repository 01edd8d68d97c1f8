# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads of the current layer, next to the tip: there they count as the lines of their points.

For a long bead with points close together these are nearly all the pieces that a nozzle comes
near to. Where the lines of a node of the tree are below the nozzle's lower end, its pieces need
no test.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..geometry.columns import columns
from ..types import Array, Index
from .frustum import Frustum


class Lines(NamedTuple):
    """What bounds the lines of pieces of beads, of nodes (n,): boxes by their lower and upper ends, by columns (3, n), and
    how near to the tip those count as lines that do so least; mm."""

    low: Array
    high: Array
    foot: Array

    def merge(self, starts: Index) -> Lines:
        """Merge the nodes from each start to the next."""
        low, high = (
            np.minimum.reduceat(self.low, starts, axis=1),
            np.maximum.reduceat(self.high, starts, axis=1),
        )
        return Lines(low, high, np.minimum.reduceat(self.foot, starts))


def build_lines(line: Array, foot: Array) -> Lines:
    """Lines (m, 2, 3) that count as such within `foot` (m,) mm of the tip, each for itself."""
    begin, end = columns(line[:, 0]), columns(line[:, 1])
    return Lines(np.minimum(begin, end), np.maximum(begin, end), foot)


def select_pairs(
    lines: Lines,
    since: Index,
    solid: Frustum,
    query: Index,
    node: Index,
    tips: Array,
    axes: Array,
    layer_start: Index,
) -> Index:
    """Return which pairs (k,) of a query and a node remain without the nodes that hold only lines below
    the solid's lower end.

    since: the earliest moment of each node. tips, axes: (3, queries). layer_start: the moment at
    which the layer of each query began.
    """
    in_layer = np.flatnonzero(since.take(node) >= layer_start.take(query))
    if not len(in_layer):
        return np.arange(len(node))
    q, n = query.take(in_layer), node.take(in_layer)
    tip, axis = tips.take(q, axis=1), axes.take(q, axis=1)
    low, high = lines.low.take(n, axis=1) - tip, lines.high.take(n, axis=1) - tip
    top = np.maximum(low * axis, high * axis).sum(axis=0)
    square_distance = np.maximum(np.square(low), np.square(high)).sum(
        axis=0
    )  # squared, of the corner that is farthest from the tip
    keep = np.ones(len(node), dtype=bool)
    keep[in_layer] = (top > solid.rows(q).low) | (square_distance >= np.square(lines.foot.take(n)))
    return np.flatnonzero(keep)
