# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tree of bounding volumes over items in space.

Items are sorted so that neighbours are consecutive. BRANCH items make a node, and BRANCH nodes make
a node of the next level.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..geometry.columns import columns
from ..types import Array, Index

BRANCH = 8
PAIRS = 50_000  # pairs of queries and nodes per block, which bounds the memory


def packed(points: Array) -> Index:
    """Return an order of points in which every node of the tree holds neighbours.

    Split the bounding box repeatedly across its longest side, between whole nodes. Sort the lowest
    groups, whose nodes hold single points, into slices across the longest side.

    Parameters
    ----------
    points : (n, 3) array
        The points, mm.

    Returns
    -------
    (n,) array of int
        Point indices in the new order.
    """
    order = np.arange(len(points))
    if not len(points):
        return order
    by_axis = columns(points)
    slice_size = BRANCH * BRANCH
    waiting = [(0, len(points), BRANCH ** int(np.log(len(points)) / np.log(BRANCH) + 1))]
    while waiting:
        low, high, ball = waiting.pop()
        if high - low <= slice_size:
            continue
        while ball >= high - low:
            ball //= BRANCH
        members = order[low:high]
        coordinates = by_axis.take(members, axis=1)
        cut = -(-(high - low) // ball) // 2 * ball
        # np.ptp takes twice as long for few points
        longest = (
            np.maximum.reduce(coordinates, axis=1) - np.minimum.reduce(coordinates, axis=1)
        ).argmax()
        order[low:high] = members[coordinates[longest].argpartition(cut)]
        waiting += [(low, low + cut, ball), (low + cut, high, ball)]
    coordinates, starts = by_axis.take(order, axis=1), np.arange(0, len(points), slice_size)
    longest = (
        np.maximum.reduceat(coordinates, starts, axis=1)
        - np.minimum.reduceat(coordinates, starts, axis=1)
    ).argmax(axis=0)
    node = np.arange(len(points)) // slice_size
    order_in_slices: Index = order[
        np.lexsort((coordinates[longest[node], np.arange(len(points))], node))
    ]
    return order_in_slices


def chained(points: Array) -> Index:
    """Return an order as `packed` does, for points that are close to their successors.

    BRANCH consecutive points stay one node, which takes a fraction of the time.

    Parameters
    ----------
    points : (n, 3) array
        The points, mm.

    Returns
    -------
    (n,) array of int
        Point indices in the new order.
    """
    node_count = len(points) // BRANCH
    middle = (
        np.add.reduceat(points[: node_count * BRANCH], np.arange(node_count) * BRANCH)
        if node_count
        else points[:0]
    )
    node = packed(middle)
    remainder = np.arange(node_count * BRANCH, len(points))
    return np.concatenate([(node[:, None] * BRANCH + np.arange(BRANCH)).ravel(), remainder])


def sizes(count: int) -> list[int]:
    """Return the items per node of each tree level over `count` items, from single items up."""
    node_sizes = [1]
    while -(-count // node_sizes[-1]) > 2 * BRANCH:
        node_sizes.append(BRANCH * node_sizes[-1])
    return node_sizes


def each_with_each(queries: int, nodes: int) -> tuple[Index, Index]:
    """Return all pairs of queries and nodes.

    Parameters
    ----------
    queries, nodes : int
        Number of queries and of nodes.

    Returns
    -------
    query, node : (queries nodes,) int array
        The pairs.
    """
    query, node = np.empty((2, queries, nodes), dtype=np.intp)
    query[:], node[:] = np.arange(queries)[:, None], np.arange(nodes)
    return query.ravel(), node.ravel()


def below(query: Index, node: Index, count: int) -> tuple[Index, Index]:
    """Return the pairs of the next level down.

    Parameters
    ----------
    query, node : (k,) int array
        Pairs of the current level.
    count : int
        Number of nodes on the next level.

    Returns
    -------
    query, node : int array
        Pairs of each query with the children of its nodes.
    """
    node = (node[:, None] * BRANCH + np.arange(BRANCH)).ravel()
    repeated = np.empty((len(query), BRANCH), dtype=np.intp)  # np.repeat is many times slower
    repeated[:] = query[:, None]
    real = np.flatnonzero(node < count)
    if len(real) == len(node):
        return repeated.ravel(), node
    return repeated.ravel().take(real), node.take(real)


def parts(query: Index, node: Index) -> Iterator[tuple[Index, Index]]:
    """Yield pairs in blocks of PAIRS.

    Parameters
    ----------
    query, node : (k,) int array
        The pairs.

    Yields
    ------
    query, node : int array
        A block.
    """
    for begin in range(0, len(query), PAIRS):
        yield query[begin : begin + PAIRS], node[begin : begin + PAIRS]
