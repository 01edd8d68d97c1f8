# SPDX-License-Identifier: LGPL-2.1-or-later
"""Mesh refinement: bisect the longest edges until all are short (Rivara 1984); flip edges."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...types import Array, Index, Mask
from ..walls.surface import dot

ROUNDS = 60
NEEDLE = 0.5  # maximum ratio of shortest to longest side of a needle
DIVERGED = (
    100  # permitted excess of long edges over twice their minimum; beyond it refinement diverges
)
STALLED, MIN_PROGRESS = (
    10,
    0.9,
)  # refinement stalls if so many rounds do not shorten the longest edge to this fraction
MIN_FLAT_COSINE = 0.3  # minimum cosine between normals at which a flip is always permitted
FLIPS, FEW_FLIPS, MANY_TRIANGLES = (
    40,
    4,
    6000,
)  # rounds on small meshes, where slivers are cheap to remove; on large meshes; limit between both

# edge midpoints (k, 3), owners of the adjacent triangles (k, 2), -1 for none, edge ends (k, 2)
Placement = Callable[[Array, Index, Index], Array]


class Edges:
    """The edges of triangles (m, 3).

    of_triangle: (m, 3) index of the edge from each corner to the next. ends: (k, 2) vertex indices,
    lower first. faces: (k, 2) first two triangles at each edge, -1 for none. count: (k,) number of
    triangles at each edge.
    """

    def __init__(self, triangles: Index) -> None:
        half = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
        lower, upper = np.minimum(half[:, 0], half[:, 1]), np.maximum(half[:, 0], half[:, 1])
        key = lower * (int(triangles.max(initial=0)) + 1) + upper
        # a single sort makes the sides of an edge consecutive, in the order of their triangles
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
    """Refine a mesh until all edges are within a limit; shared edges stay shared.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles.
    owner : (m,) int array
        Owner of each triangle.
    longest : float
        Maximum edge, mm.
    place_points : Placement
        Moves new edge midpoints to their positions.
    max_triangles : int
        Maximum number of triangles.
    flip : bool, optional
        Whether edges are flipped after each round.

    Returns
    -------
    tuple of array or None
        Vertices, triangles and their owners. None if `max_triangles` would be exceeded, flipped
        edges repeatedly become long again, or edges are still too long after ROUNDS rounds.

    References
    ----------
    Rivara 1984.
    """
    highest = fewest_since = 0  # number of long edges: maximum so far, and minimum since then
    tops: list[float] = []  # longest edge of each round, mm
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
        # bisect the longest edge of each affected triangle, which keeps triangles well shaped
        side_lengths = length[edges.of_triangle] + 1e-9 * length.max() * edges.of_triangle / len(
            length
        )  # avoid ties
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
    """Divide each triangle into four at its edge midpoints.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles.
    owner : (m,) int array
        Owner of each triangle.
    place_points : Placement
        Moves the edge midpoints to their positions.

    Returns
    -------
    vertices : array
        Old and new vertices, mm.
    triangles : (4 m, 3) int array
        The parts.
    owner : (4 m,) int array
        Owners of the triangles.
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
    """Return the start corner (m,) of the edge of each triangle to cut first, usually the longest.

    side_lengths: (m, 3) edge lengths. Two needles along a common longest edge, as in a long strip,
    are cut at the second longest edge: their diagonal is flipped afterwards and the strip does not
    become narrower. Such diagonals are removed from `split`.
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
    """Estimate the number of triangles after bisecting all long edges.

    Parameters
    ----------
    corners : (m, 3, 3) array
        Corners of the triangles, mm.
    longest : float
        Maximum edge, mm.

    Returns
    -------
    float
        Estimated number.
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
    """Divide triangles at the midpoints (m, 3) of their edges, -1 for none.

    longest: (m,) the edge to divide first.
    """
    row = np.arange(len(triangles))[:, None]
    turn = (longest[:, None] + np.arange(3)) % 3
    a, b, c = triangles[row, turn].T
    ab, bc, ca = middle[row, turn].T
    uncut = ab < 0
    blocks, owners = [triangles[uncut]], [owner[uncut]]
    # halves (a, ab, c) and (ab, b, c), divided again if the outer edge has a midpoint
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
    """Flip edges inside an owner's area whose opposite angles sum to more than pi.

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
        Nearly Delaunay triangles.
    """
    triangles = triangles.copy()
    # triangles that changed or that two edges compete for; all further pairs are finished
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
        # never fold: new triangles face the same way as the old and are nearly as flat, so that no
        # edge runs across a tube
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
    """Return the edges with a single triangle.

    Parameters
    ----------
    triangles : (m, 3) int array
        Triangles.

    Returns
    -------
    edges : (k, 2) int array
        Vertex indices of the edges, in the sense of their triangle.
    shared : bool array
        Whether more than two triangles share each of all edges.
    """
    edges = Edges(triangles)
    half = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    return half[edges.count[edges.of_triangle.ravel()] == 1], edges.count > 2


def split_edges(
    vertices: Array, triangles: Index, is_split: Callable[[Index], Mask]
) -> tuple[Array, Index, bool]:
    """Bisect selected edges.

    A closed mesh stays closed: an affected triangle becomes two, three or four triangles.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles.
    is_split : callable
        Returns which edges to bisect, given their vertex indices (2, k).

    Returns
    -------
    vertices : array
        Old and new vertices, mm.
    triangles : int array
        The triangles.
    changed : bool
        Whether any edge was bisected.
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
    middle = number[edges.of_triangle]  # (m, 3) midpoint of the edge from each corner to the next
    cut = middle >= 0
    count = cut.sum(axis=1)
    blocks = [triangles[count == 0]]
    # rotate corners so that the cut edges come first
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
