# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangle meshes made finer: longest edges halved until all are short enough (Rivara 1984), then edges flipped."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...types import Array, Index, Mask
from ..walls.surface import dot

ROUNDS = 60
NEEDLE = 0.5  # of the shortest to the longest side
DIVERGED = (
    100  # more edges that are too long than twice the least there were: halving them does not end
)
STALLED, SHORTER = (
    10,
    0.9,
)  # rounds in which the longest edge becomes no shorter than this share of itself: nor does it
LEVEL = 0.3  # cosine between the normals of two triangles, down to which an edge may be turned in any case
FLIPS, FEW_FLIPS, MANY = (
    40,
    4,
    6000,
)  # rounds on small meshes, where slivers are cheaply got rid of, and on large ones

# vertices (k, 3), owners of the triangles beside each new one (k, 2) -1 for none, ends of the edge it halves (k, 2)
Placed = Callable[[Array, Index, Index], Array]


class Edges:
    """The edges of triangles (m, 3): `of` (m, 3) the number of the edge from each corner to the next, `ends` (k, 2), lower
    vertex first, `faces` (k, 2) the triangles at it, -1 for none, `count` (k,) how many there are."""

    def __init__(self, triangles: Index) -> None:
        half = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
        lower, upper = np.minimum(half[:, 0], half[:, 1]), np.maximum(half[:, 0], half[:, 1])
        key = lower * (int(triangles.max(initial=0)) + 1) + upper
        # one sort for all: sides of the same edge come next to each other, in the order of their triangles
        order = np.argsort(key, kind="stable")
        new = np.ones(len(key), dtype=bool)
        new[1:] = np.diff(key[order]) != 0
        begin = np.flatnonzero(new)
        first = order[begin]
        self.ends: Index = np.stack([lower[first], upper[first]], axis=1)
        of = np.empty(len(key), dtype=np.intp)
        of[order] = np.cumsum(new) - 1
        self.of: Index = of.reshape(-1, 3)
        self.count: Index = np.diff(np.append(begin, len(key)))
        self.faces: Index = np.full((len(first), 2), -1, dtype=np.intp)
        self.faces[:, 0] = first // 3
        two = self.count > 1
        self.faces[two, 1] = order[begin[two] + 1] // 3


def refined(
    vertices: Array,
    triangles: Index,
    owner: Index,
    longest: float,
    place: Placed,
    most: int,
    turned: bool = True,
) -> tuple[Array, Index, Index] | None:
    """Vertices, triangles and their owners (m,) with no edge longer than `longest` mm; None when there would be more than
    `most` triangles, edges that are turned come back as long as they were, again and again, or some are still too long after
    ROUNDS of halving.

    place: moves the new middles of edges to where they belong. What was shared stays shared. turned: whether edges are
    turned after each round of halving.
    """
    highest = least = 0  # edges that are too long: at most so far, and at least since
    tops: list[float] = []  # mm, the longest edge in each round
    for _ in range(ROUNDS):
        edges = Edges(triangles)
        length = np.linalg.norm(vertices[edges.ends[:, 0]] - vertices[edges.ends[:, 1]], axis=1)
        split = length > longest
        long = int(split.sum())
        if not long:
            return vertices, triangles, owner
        tops.append(float(length.max()))
        highest, least = (long, long) if long > highest else (highest, min(long, least))
        if turned and least < 0.5 * highest and long > 2 * least + DIVERGED:
            return None
        if turned and len(tops) > STALLED and min(tops[-STALLED:]) > SHORTER * min(tops[:-STALLED]):
            return None
        # halve the longest edge of each triangle that has an edge to halve, so that triangles stay in shape
        own = length[edges.of] + 1e-9 * length.max() * edges.of / len(length)  # no ties
        first = _first_cut(edges, own, owner, longest, split) if turned else np.argmax(own, axis=1)
        top = np.take_along_axis(edges.of, first[:, None], axis=1)[:, 0]
        while True:
            more = split[edges.of].any(axis=1) & ~split[top]
            if not more.any():
                break
            split[top[more]] = True
        if len(triangles) + 2 * split.sum() > most:
            return None
        ends = edges.ends[split]
        adjacent = np.where(edges.faces[split] >= 0, owner[edges.faces[split]], -1)
        middle = place(0.5 * (vertices[ends[:, 0]] + vertices[ends[:, 1]]), adjacent, ends)
        number = np.full(len(split), -1, dtype=np.intp)
        number[split] = len(vertices) + np.arange(len(ends))
        vertices = np.vstack([vertices, middle])
        triangles, owner = _halved(triangles, owner, number[edges.of], first)
        if turned:
            triangles = flipped(vertices, triangles, owner)
    return None


def quartered(
    vertices: Array, triangles: Index, owner: Index, place: Placed
) -> tuple[Array, Index, Index]:
    """Vertices, triangles and their owners (m,), each triangle divided into four at the middles of its edges, which `place`
    moves to where they belong."""
    edges = Edges(triangles)
    adjacent = np.where(edges.faces >= 0, owner[edges.faces], -1)
    middle = place(vertices[edges.ends].mean(axis=1), adjacent, edges.ends)
    a, b, c = triangles.T
    ab, bc, ca = (edges.of + len(vertices)).T
    four = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return (
        np.vstack([vertices, middle]),
        np.concatenate([np.stack(one, axis=1) for one in four]),
        np.tile(owner, 4),
    )


def _first_cut(edges: Edges, own: Array, owner: Index, longest: float, split: Mask) -> Index:
    """The corner (m,) of each triangle at which the edge begins that is cut first, its longest one, given the lengths
    (m, 3) of its edges.

    Of two needles along a common longest edge, as they make up a long strip, the next one: what was their diagonal is
    turned afterwards, and the strip does not become narrower. Takes such diagonals out of `split`.
    """
    order = np.argsort(own, axis=1)
    row = np.arange(len(own))
    short, middle, long = own[row[:, None], order].T
    top = edges.of[row, order[:, 2]]
    needle = (short < NEEDLE * long) & (middle > longest)
    count = np.bincount(top[needle], minlength=len(split))
    adjacent = owner[edges.faces]
    diagonal = (count == 2) & (edges.count == 2) & (adjacent[:, 0] == adjacent[:, 1])
    split[diagonal] = False
    return np.where(diagonal[top], order[:, 1], order[:, 2])


def count_halved(corners: Array, longest: float) -> float:
    """How many triangles without edges longer than `longest` mm become of triangles with the corners (m, 3, 3), about."""
    square = np.sort(((np.roll(corners, -1, axis=1) - corners) ** 2).sum(axis=2), axis=1)
    each: Array = np.ones(len(square))
    count = 0.0
    for _ in range(ROUNDS):
        small = square[:, 2] <= longest * longest
        count += each[small].sum()
        short, middle, long = square[~small].T
        if not len(long):
            break
        cut = 0.5 * (short + middle) - 0.25 * long
        halves = np.stack([np.stack([0.25 * long, cut, one], axis=1) for one in (short, middle)])
        needle = (short < NEEDLE**2 * long) & (middle > longest * longest)
        halves[:, needle] = np.stack([short, 0.25 * middle, long - 0.75 * middle], axis=1)[needle]
        halves = halves.reshape(-1, 3)
        # alike ones together
        _, first, of = np.unique(
            np.round(np.log2(np.maximum(np.sort(halves, axis=1), 1e-12)), 1) @ [1e6, 1e3, 1.0],
            return_index=True,
            return_inverse=True,
        )
        each = np.bincount(np.ravel(of), weights=np.tile(each[~small], 2)).astype(np.float64)
        square = np.sort(halves[first], axis=1)
    return float(count)


def _halved(triangles: Index, owner: Index, middle: Index, longest: Index) -> tuple[Index, Index]:
    """The triangles divided at the middles (m, 3) of their edges, -1 for none; first at the longest edge (m,)."""
    row = np.arange(len(triangles))[:, None]
    turn = (longest[:, None] + np.arange(3)) % 3
    a, b, c = triangles[row, turn].T
    ab, bc, ca = middle[row, turn].T
    whole = ab < 0
    parts, owners = [triangles[whole]], [owner[whole]]
    # halves (a, ab, c) and (ab, b, c), each divided once more where its own outer edge has a middle
    for tip, other, cut, forward in ((a, ab, ca, True), (b, ab, bc, False)):
        for once in (True, False):
            chosen = ~whole & ((cut < 0) if once else (cut >= 0))
            t, o, m, far = tip[chosen], other[chosen], cut[chosen], c[chosen]
            pieces = [(t, o, far)] if once else [(t, o, m), (m, o, far)]
            for piece in pieces:
                parts.append(np.stack(piece if forward else piece[::-1], axis=1))
                owners.append(owner[chosen])
    return np.concatenate(parts), np.concatenate(owners)


def flipped(vertices: Array, triangles: Index, owner: Index) -> Index:
    """The triangles with the edges inside of one owner's area turned where the angles beyond them are larger than pi
    together (Delaunay)."""
    triangles = triangles.copy()
    open_ = np.ones(
        len(triangles), dtype=bool
    )  # changed, or wished for by two edges: between others nothing is new
    for _ in range(FLIPS if len(triangles) < MANY else FEW_FLIPS):
        edges = Edges(triangles)
        pair = np.flatnonzero(
            (edges.count == 2) & (owner[edges.faces[:, 0]] == owner[edges.faces[:, 1]])
        )
        pair = pair[open_[edges.faces[pair]].any(axis=1)]
        one, other = edges.faces[pair].T
        at, back = (
            np.argmax(edges.of[one] == pair[:, None], axis=1),
            np.argmax(edges.of[other] == pair[:, None], axis=1),
        )
        a, b = triangles[one, at], triangles[one, (at + 1) % 3]
        c, d = triangles[one, (at + 2) % 3], triangles[other, (back + 2) % 3]
        excess = _angle(vertices, c, a, b) + _angle(vertices, d, a, b) - np.pi
        asked = (triangles[other, back] == b) & (c != d) & (excess > 1e-6)
        a, b, c, d, one, other, excess = (
            column[asked] for column in (a, b, c, d, one, other, excess)
        )
        # never fold: the new triangles look the same way as the old ones, and hardly less alike: no edge across a tube
        old = _normal(vertices, a, b, c), _normal(vertices, b, a, d)
        new = _normal(vertices, a, d, c), _normal(vertices, d, b, c)
        normal = old[0] + old[1]
        sound = (dot(new[0], normal) > 0.0) & (dot(new[1], normal) > 0.0)
        level = _cosine(*new)
        sound &= (level > LEVEL) | (level >= _cosine(*old))
        wish = np.flatnonzero(sound)
        if not len(wish):
            break
        wish = wish[np.argsort(-excess[wish], kind="stable")]
        rank = np.full(len(triangles), len(wish), dtype=np.intp)
        for faces in (one[wish], other[wish]):
            np.minimum.at(rank, faces, np.arange(len(wish)))
        chosen = wish[
            (rank[one[wish]] == np.arange(len(wish))) & (rank[other[wish]] == np.arange(len(wish)))
        ]
        open_ = rank < len(wish)
        triangles[one[chosen]] = np.stack([a[chosen], d[chosen], c[chosen]], axis=1)
        triangles[other[chosen]] = np.stack([d[chosen], b[chosen], c[chosen]], axis=1)
    return triangles


def _angle(vertices: Array, tip: Index, a: Index, b: Index) -> Array:
    one, other = vertices[a] - vertices[tip], vertices[b] - vertices[tip]
    angle: Array = np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), dot(one, other))
    return angle


def _normal(vertices: Array, a: Index, b: Index, c: Index) -> Array:
    normal: Array = np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a])
    return normal


def _cosine(one: Array, other: Array) -> Array:
    size = np.linalg.norm(one, axis=1) * np.linalg.norm(other, axis=1)
    cosine: Array = dot(one, other) / np.maximum(size, 1e-300)
    return cosine


def boundary(triangles: Index) -> tuple[Index, Mask]:
    """The edges (k, 2) of one triangle alone, along its own sense, and which of them more than two triangles share."""
    edges = Edges(triangles)
    half = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    return half[edges.count[edges.of.ravel()] == 1], edges.count > 2
