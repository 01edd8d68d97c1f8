# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads of the layer being laid, next to the tip: there they count as the lines that they are laid along.

Of a long bead with points close together those are nearly all the pieces that a nozzle comes near to. Where the lines of a
node of the tree are below the nozzle's lower end, none of its pieces need be looked at.
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

    def joined(self, starts: Index) -> Lines:
        """Of the nodes from each start to the next."""
        low, high = (
            np.minimum.reduceat(self.low, starts, axis=1),
            np.maximum.reduceat(self.high, starts, axis=1),
        )
        return Lines(low, high, np.minimum.reduceat(self.foot, starts))


def of_lines(line: Array, foot: Array) -> Lines:
    """Lines (m, 2, 3) that count as such within `foot` (m,) mm of the tip, each for itself."""
    begin, end = columns(line[:, 0]), columns(line[:, 1])
    return Lines(np.minimum(begin, end), np.maximum(begin, end), foot)


def matter(
    lines: Lines,
    since: Index,
    solid: Frustum,
    query: Index,
    node: Index,
    tips: Array,
    axes: Array,
    own: Index,
) -> Index:
    """Which pairs (k,) of a query and a node are left without the nodes that hold nothing but lines below the solid's lower
    end. since: of each node the earliest moment. tips, axes: (3, queries); own: of each query the moment at which its layer
    began."""
    here = np.flatnonzero(since.take(node) >= own.take(query))
    if not len(here):
        return np.arange(len(node))
    q, n = query.take(here), node.take(here)
    tip, axis = tips.take(q, axis=1), axes.take(q, axis=1)
    low, high = lines.low.take(n, axis=1) - tip, lines.high.take(n, axis=1) - tip
    top = np.maximum(low * axis, high * axis).sum(axis=0)
    away = np.maximum(np.square(low), np.square(high)).sum(
        axis=0
    )  # squared, of the corner that is farthest from the tip
    left = np.ones(len(node), dtype=bool)
    left[here] = (top > solid.rows(q).low) | (away >= np.square(lines.foot.take(n)))
    return np.flatnonzero(left)
