# SPDX-License-Identifier: LGPL-2.1-or-later
"""A tree of bounding volumes over things in space: things in an order in which neighbours follow each other, so many of
which make a node, so many nodes a node of the next level."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..geometry.columns import columns
from ..types import Array, Index

BRANCH = 8
PAIRS = 50_000  # of queries and nodes looked at together: memory does not grow with either


def packed(points: Array) -> Index:
    """An order of points (n, 3) in which every node of the tree holds neighbours: halves along the longest side of their
    box again and again, cut between whole nodes; the last of these, whose nodes hold single things, are slices across it."""
    order = np.arange(len(points))
    if not len(points):
        return order
    by_axis = columns(points)
    last = BRANCH * BRANCH
    waiting = [(0, len(points), BRANCH ** int(np.log(len(points)) / np.log(BRANCH) + 1))]
    while waiting:
        low, high, ball = waiting.pop()
        if high - low <= last:
            continue
        while ball >= high - low:
            ball //= BRANCH
        mine = order[low:high]
        some = by_axis.take(mine, axis=1)
        cut = -(-(high - low) // ball) // 2 * ball
        # np.ptp takes twice as long for a few
        longest = (np.maximum.reduce(some, axis=1) - np.minimum.reduce(some, axis=1)).argmax()
        order[low:high] = mine[some[longest].argpartition(cut)]
        waiting += [(low, low + cut, ball), (low + cut, high, ball)]
    some, starts = by_axis.take(order, axis=1), np.arange(0, len(points), last)
    longest = (
        np.maximum.reduceat(some, starts, axis=1) - np.minimum.reduceat(some, starts, axis=1)
    ).argmax(axis=0)
    node = np.arange(len(points)) // last
    found: Index = order[np.lexsort((some[longest[node], np.arange(len(points))], node))]
    return found


def chained(points: Array) -> Index:
    """The same of points (n, 3) of which those that follow each other are near each other: BRANCH of them in a row stay one
    node, which takes a fraction of the time."""
    whole = len(points) // BRANCH
    middle = (
        np.add.reduceat(points[: whole * BRANCH], np.arange(whole) * BRANCH)
        if whole
        else points[:0]
    )
    node = packed(middle)
    rest = np.arange(whole * BRANCH, len(points))
    return np.concatenate([(node[:, None] * BRANCH + np.arange(BRANCH)).ravel(), rest])


def sizes(count: int) -> list[int]:
    """How many things a node holds, level by level from the single ones up, of so many things in all."""
    found = [1]
    while -(-count // found[-1]) > 2 * BRANCH:
        found.append(BRANCH * found[-1])
    return found


def each_with_each(queries: int, nodes: int) -> tuple[Index, Index]:
    """All pairs of so many queries and nodes: np.repeat takes many times as long."""
    query, node = np.empty((2, queries, nodes), dtype=np.intp)
    query[:], node[:] = np.arange(queries)[:, None], np.arange(nodes)
    return query.ravel(), node.ravel()


def below(query: Index, node: Index, count: int) -> tuple[Index, Index]:
    """Queries and nodes of the next level down, of which there are `count`."""
    node = (node[:, None] * BRANCH + np.arange(BRANCH)).ravel()
    every = np.empty((len(query), BRANCH), dtype=np.intp)  # np.repeat takes many times as long
    every[:] = query[:, None]
    real = np.flatnonzero(node < count)
    if len(real) == len(node):
        return every.ravel(), node
    return every.ravel().take(real), node.take(real)


def parts(query: Index, node: Index) -> Iterator[tuple[Index, Index]]:
    """Pairs, so many at a time."""
    for first in range(0, len(query), PAIRS):
        yield query[first : first + PAIRS], node[first : first + PAIRS]
