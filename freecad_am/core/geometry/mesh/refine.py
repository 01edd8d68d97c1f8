# SPDX-License-Identifier: LGPL-2.1-or-later
"""Mesh refinement: halve the longest edges until all are short enough (Rivara 1984), then
flip edges.
"""

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
STALLED, MIN_PROGRESS = (
    10,
    0.9,
)  # rounds in which the longest edge becomes no shorter than this share of itself: nor does it
MIN_FLAT_COSINE = 0.3  # cosine between the normals of two triangles, down to which an edge may be turned in any case
FLIPS, FEW_FLIPS, MANY_TRIANGLES = (
    40,
    4,
    6000,
)  # rounds on small meshes, where slivers are cheaply got rid of, and on large ones

# vertices (k, 3), owners of the two triangles adjacent to each (k, 2) -1 for none, ends of the edge it halves (k, 2)
Placement = Callable[[Array, Index, Index], Array]


class Edges:
    """The edges of triangles (m, 3): `of_triangle` (m, 3) the number of the edge from each corner to the next, `ends` (k, 2), lower
    vertex first, `faces` (k, 2) the triangles at it, -1 for none, `count` (k,) how many there are."""

    def __init__(self, triangles: Index) -> None:
        half = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
        lower, upper = np.minimum(half[:, 0], half[:, 1]), np.maximum(half[:, 0], half[:, 1])
        key = lower * (int(triangles.max(initial=0)) + 1) + upper
        # one sort: sides of the same edge become adjacent, in the order of their triangles
        order = np.argsort(key, kind="stable")
        new = np.ones(len(key), dtype=bool)
        new[1:] = np.diff(key[order]) != 0
        begin = np.flatnonzero(new)
        first_side = order[begin]
        self.ends: Index = np.stack([lower[first_side], upper[first_side]], axis=1)
        edge_numbers = np.empty(len(key), dtype=np.intp)
        edge_numbers[order] = np.cumsum(new) - 1
        self.of_triangle: Index = edge_numbers.reshape(-1, 3)
        self.count: Index = np.diff(np.append(begin, len(key)))
        self.faces: Index = np.full((len(first_side), 2), -1, dtype=np.intp)
        self.faces[:, 0] = first_side // 3
        two = self.count > 1
        self.faces[two, 1] = order[begin[two] + 1] // 3


def refine_mesh(
    vertices: Array,
    triangles: Index,
    owner: Index,
    longest: float,
    place_points: Placement,
    max_triangles: int,
    flip: bool = True,
) -> tuple[Array, Index, Index] | None:
    """Refine a mesh until no edge is longer than a limit.

    Shared edges stay shared.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles.
    owner : (m,) int array
        Owner of each triangle.
    longest : float
        Longest edge, mm.
    place_points : Placement
        Moves new edge middles to their positions.
    max_triangles : int
        Largest number of triangles.
    flip : bool, optional
        Whether edges are flipped after each round.

    Returns
    -------
    tuple of array or None
        Vertices, triangles and their owners. None if there would be more than
        `max_triangles` triangles, if flipped edges repeatedly become long again, or if
        edges are still too long after ROUNDS rounds.

    References
    ----------
    Rivara 1984.
    """
    highest = fewest_since = (
        0  # numbers of too long edges: the maximum so far and the minimum since
    )
    tops: list[float] = []  # mm, the longest edge in each round
    for _ in range(ROUNDS):
        edges = Edges(triangles)
        length = np.linalg.norm(vertices[edges.ends[:, 0]] - vertices[edges.ends[:, 1]], axis=1)
        split = length > longest
        long = int(split.sum())
        if not long:
            return vertices, triangles, owner
        tops.append(float(length.max()))
        highest, fewest_since = (
            (long, long) if long > highest else (highest, min(long, fewest_since))
        )
        if flip and fewest_since < 0.5 * highest and long > 2 * fewest_since + DIVERGED:
            return None
        if (
            flip
            and len(tops) > STALLED
            and min(tops[-STALLED:]) > MIN_PROGRESS * min(tops[:-STALLED])
        ):
            return None
        # halve the longest edge of each triangle with an edge to halve, which keeps triangles well shaped
        side_lengths = length[edges.of_triangle] + 1e-9 * length.max() * edges.of_triangle / len(
            length
        )  # no ties
        first_cut = (
            _first_cut(edges, side_lengths, owner, longest, split)
            if flip
            else np.argmax(side_lengths, axis=1)
        )
        top = np.take_along_axis(edges.of_triangle, first_cut[:, None], axis=1)[:, 0]
        while True:
            unfinished = split[edges.of_triangle].any(axis=1) & ~split[top]
            if not unfinished.any():
                break
            split[top[unfinished]] = True
        if len(triangles) + 2 * split.sum() > max_triangles:
            return None
        ends = edges.ends[split]
        adjacent = np.where(edges.faces[split] >= 0, owner[edges.faces[split]], -1)
        middle = place_points(0.5 * (vertices[ends[:, 0]] + vertices[ends[:, 1]]), adjacent, ends)
        number = np.full(len(split), -1, dtype=np.intp)
        number[split] = len(vertices) + np.arange(len(ends))
        vertices = np.vstack([vertices, middle])
        triangles, owner = _halve_triangles(triangles, owner, number[edges.of_triangle], first_cut)
        if flip:
            triangles = flip_edges(vertices, triangles, owner)
    return None


def quarter_triangles(
    vertices: Array, triangles: Index, owner: Index, place_points: Placement
) -> tuple[Array, Index, Index]:
    """Divide each triangle into four at its edge middles.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles.
    owner : (m,) int array
        Owner of each triangle.
    place_points : Placement
        Moves the edge middles to their positions.

    Returns
    -------
    vertices : array
        Old and new vertices, mm.
    triangles : (4 m, 3) int array
        The parts.
    owner : (4 m,) int array
        Their owners.
    """
    edges = Edges(triangles)
    adjacent = np.where(edges.faces >= 0, owner[edges.faces], -1)
    middle = place_points(vertices[edges.ends].mean(axis=1), adjacent, edges.ends)
    a, b, c = triangles.T
    ab, bc, ca = (edges.of_triangle + len(vertices)).T
    four = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return (
        np.vstack([vertices, middle]),
        np.concatenate([np.stack(corners, axis=1) for corners in four]),
        np.tile(owner, 4),
    )


def _first_cut(
    edges: Edges, side_lengths: Array, owner: Index, longest: float, split: Mask
) -> Index:
    """Return the corner (m,) of each triangle at which its first cut edge, the longest, begins.

    `side_lengths` (m, 3) are the lengths of its edges. Two needles along a common longest
    edge, as in a long strip, are cut at the next edge: their diagonal is flipped afterwards
    and the strip does not become narrower. Such diagonals are removed from `split`.
    """
    order = np.argsort(side_lengths, axis=1)
    row = np.arange(len(side_lengths))
    short, middle, long = side_lengths[row[:, None], order].T
    top = edges.of_triangle[row, order[:, 2]]
    needle = (short < NEEDLE * long) & (middle > longest)
    count = np.bincount(top[needle], minlength=len(split))
    adjacent = owner[edges.faces]
    diagonal = (count == 2) & (edges.count == 2) & (adjacent[:, 0] == adjacent[:, 1])
    split[diagonal] = False
    return np.where(diagonal[top], order[:, 1], order[:, 2])


def count_halved(corners: Array, longest: float) -> float:
    """Estimate the number of triangles after halving until no edge is too long.

    Parameters
    ----------
    corners : (m, 3, 3) array
        Corners of the triangles, mm.
    longest : float
        Longest edge allowed, mm.

    Returns
    -------
    float
        The number.
    """
    square = np.sort(((np.roll(corners, -1, axis=1) - corners) ** 2).sum(axis=2), axis=1)
    weight: Array = np.ones(len(square))
    count = 0.0
    for _ in range(ROUNDS):
        small = square[:, 2] <= longest * longest
        count += weight[small].sum()
        short, middle, long = square[~small].T
        if not len(long):
            break
        cut = 0.5 * (short + middle) - 0.25 * long
        halves = np.stack([np.stack([0.25 * long, cut, leg], axis=1) for leg in (short, middle)])
        needle = (short < NEEDLE**2 * long) & (middle > longest * longest)
        halves[:, needle] = np.stack([short, 0.25 * middle, long - 0.75 * middle], axis=1)[needle]
        halves = halves.reshape(-1, 3)
        # merge similar triangles
        _, representative, group = np.unique(
            np.round(np.log2(np.maximum(np.sort(halves, axis=1), 1e-12)), 1) @ [1e6, 1e3, 1.0],
            return_index=True,
            return_inverse=True,
        )
        weight = np.bincount(np.ravel(group), weights=np.tile(weight[~small], 2)).astype(np.float64)
        square = np.sort(halves[representative], axis=1)
    return float(count)


def _halve_triangles(
    triangles: Index, owner: Index, middle: Index, longest: Index
) -> tuple[Index, Index]:
    """Divide triangles at the middles (m, 3) of their edges, -1 for none, first at the longest
    edge (m,).
    """
    row = np.arange(len(triangles))[:, None]
    turn = (longest[:, None] + np.arange(3)) % 3
    a, b, c = triangles[row, turn].T
    ab, bc, ca = middle[row, turn].T
    uncut = ab < 0
    blocks, owners = [triangles[uncut]], [owner[uncut]]
    # halves (a, ab, c) and (ab, b, c), each divided again if its outer edge has a middle
    for tip, opposite, cut, forward in ((a, ab, ca, True), (b, ab, bc, False)):
        for once in (True, False):
            selected = ~uncut & ((cut < 0) if once else (cut >= 0))
            t, o, m, apex = tip[selected], opposite[selected], cut[selected], c[selected]
            halves = [(t, o, apex)] if once else [(t, o, m), (m, o, apex)]
            for corners in halves:
                blocks.append(np.stack(corners if forward else corners[::-1], axis=1))
                owners.append(owner[selected])
    return np.concatenate(blocks), np.concatenate(owners)


def flip_edges(vertices: Array, triangles: Index, owner: Index) -> Index:
    """Flip edges within one owner's area whose opposite angles sum to more than pi.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles.
    owner : (m,) int array
        Owner of each triangle.

    Returns
    -------
    (m, 3) int array
        Triangles that are nearly Delaunay.
    """
    triangles = triangles.copy()
    # triangles that have changed, or that two edges compete for; pairs of others are done
    open_ = np.ones(len(triangles), dtype=bool)
    for _ in range(FLIPS if len(triangles) < MANY_TRIANGLES else FEW_FLIPS):
        edges = Edges(triangles)
        pair = np.flatnonzero(
            (edges.count == 2) & (owner[edges.faces[:, 0]] == owner[edges.faces[:, 1]])
        )
        pair = pair[open_[edges.faces[pair]].any(axis=1)]
        face_a, face_b = edges.faces[pair].T
        turn = np.argmax(edges.of_triangle[face_a] == pair[:, None], axis=1)
        back = np.argmax(edges.of_triangle[face_b] == pair[:, None], axis=1)
        a, b = triangles[face_a, turn], triangles[face_a, (turn + 1) % 3]
        c, d = triangles[face_a, (turn + 2) % 3], triangles[face_b, (back + 2) % 3]
        excess = _angle(vertices, c, a, b) + _angle(vertices, d, a, b) - np.pi
        admissible = (triangles[face_b, back] == b) & (c != d) & (excess > 1e-6)
        a, b, c, d, face_a, face_b, excess = (
            column[admissible] for column in (a, b, c, d, face_a, face_b, excess)
        )
        # never fold: the new triangles face the same way as the old ones and are nearly as flat, so no edge runs across a tube
        old = _normal(vertices, a, b, c), _normal(vertices, b, a, d)
        new = _normal(vertices, a, d, c), _normal(vertices, d, b, c)
        normal = old[0] + old[1]
        sound = (dot(new[0], normal) > 0.0) & (dot(new[1], normal) > 0.0)
        level = _cosine(*new)
        sound &= (level > MIN_FLAT_COSINE) | (level >= _cosine(*old))
        wish = np.flatnonzero(sound)
        if not len(wish):
            break
        wish = wish[np.argsort(-excess[wish], kind="stable")]
        rank = np.full(len(triangles), len(wish), dtype=np.intp)
        for faces in (face_a[wish], face_b[wish]):
            np.minimum.at(rank, faces, np.arange(len(wish)))
        flips = wish[
            (rank[face_a[wish]] == np.arange(len(wish)))
            & (rank[face_b[wish]] == np.arange(len(wish)))
        ]
        open_ = rank < len(wish)
        triangles[face_a[flips]] = np.stack([a[flips], d[flips], c[flips]], axis=1)
        triangles[face_b[flips]] = np.stack([d[flips], b[flips], c[flips]], axis=1)
    return triangles


def _angle(vertices: Array, tip: Index, a: Index, b: Index) -> Array:
    to_a, to_b = vertices[a] - vertices[tip], vertices[b] - vertices[tip]
    angle: Array = np.arctan2(np.linalg.norm(np.cross(to_a, to_b), axis=1), dot(to_a, to_b))
    return angle


def _normal(vertices: Array, a: Index, b: Index, c: Index) -> Array:
    normal: Array = np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a])
    return normal


def _cosine(u: Array, v: Array) -> Array:
    size = np.linalg.norm(u, axis=1) * np.linalg.norm(v, axis=1)
    cosine: Array = dot(u, v) / np.maximum(size, 1e-300)
    return cosine


def boundary(triangles: Index) -> tuple[Index, Mask]:
    """Return the edges with one triangle only.

    Parameters
    ----------
    triangles : (m, 3) int array
        Triangles.

    Returns
    -------
    edges : (k, 2) int array
        Ends of these edges, in the sense of their triangle.
    shared : bool array
        Which of all edges more than two triangles share.
    """
    edges = Edges(triangles)
    half = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    return half[edges.count[edges.of_triangle.ravel()] == 1], edges.count > 2


def split_edges(
    vertices: Array, triangles: Index, is_split: Callable[[Index], Mask]
) -> tuple[Array, Index, bool]:
    """Halve selected edges.

    A closed mesh stays closed: a triangle becomes two, three or four.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles.
    is_split : callable
        Returns which edges to halve, by their ends (2, k).

    Returns
    -------
    vertices : array
        Old and new vertices, mm.
    triangles : int array
        The triangles.
    changed : bool
        Whether any edge was halved.
    """
    edges = Edges(triangles)
    halved = np.flatnonzero(is_split(edges.ends.T))
    if not len(halved):
        return vertices, triangles, False
    number = np.full(len(edges.ends), -1, dtype=np.intp)
    number[halved] = len(vertices) + np.arange(len(halved))
    vertices = np.vstack(
        [vertices, 0.5 * (vertices[edges.ends[halved, 0]] + vertices[edges.ends[halved, 1]])]
    )
    middle = number[edges.of_triangle]  # (m, 3) of the edges from each corner to the next
    cut = middle >= 0
    count = cut.sum(axis=1)
    blocks = [triangles[count == 0]]
    # turned so that the first edge is cut (with two cuts: the first two edges)
    turn = np.where(count == 2, (np.argmin(cut, axis=1) + 1) % 3, np.argmax(cut, axis=1))
    column = (turn[:, None] + np.arange(3)) % 3
    (a, b, c), (ab, bc, ca) = (
        np.take_along_axis(rows, column, axis=1).T for rows in (triangles, middle)
    )
    single, two, three = count == 1, count == 2, count == 3
    for rows, corners in (
        (single, ((a, ab, c), (ab, b, c))),
        (two, ((a, ab, c), (ab, bc, c), (ab, b, bc))),
        (three, ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))),
    ):
        blocks += [np.stack([corner[rows] for corner in triple], axis=1) for triple in corners]
    return vertices, np.concatenate(blocks), True
