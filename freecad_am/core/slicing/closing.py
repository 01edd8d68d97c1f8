# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads that close what fronts leave between them.

Where fronts meet, or come together at a corner, points are left that no front passes: up to a layer height deep in a
front that closes on itself, and between two that run into each other. What lies deeper than COVERED in there gets a bead
of its own along the middle of the gap. Gaps that reach an edge of the wall are left: there the wall ends.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..geometry.mesh import Mesh
from ..geometry.space_curve import SpaceCurve
from .front_curve import Wall

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

COVERED = 0.59  # of the height; no point is to be farther from a bead
LEVELS = (0.5, 0.42, 0.34)  # of the height; how deep the border of what is closed lies, for a bead that is long enough
SHORTEST = 0.5  # of the height
FINE = 0.2  # of the height; edges of the mesh on which gaps are seen
SAMPLED = 0.05  # of the height; places along the beads
ROUNDS = 4
SEEN = 0.56  # of the height; gaps this deep at one of those edges' ends are looked at
ALIKE = 6  # decimals of mm to which vertices of the fine mesh are told apart


def closing(wall: Wall, mesh: Mesh, fronts: list[SpaceCurve], passed: Mask, height: float) -> list[SpaceCurve]:
    """The beads, along the middle of gaps, that cover the wall between fronts.

    fronts: of two layers that follow each other, or of the last one. passed: (n,) the vertices of the mesh between them.
    """
    faces = mesh.faces[passed[mesh.faces].any(axis=1)]
    if not len(faces):
        return []
    near = cKDTree(_samples(fronts, SAMPLED * height))
    corners = mesh.vertices[faces]
    share, _ = _parts(corners, FINE * height)
    depth = np.asarray(near.query(np.einsum("sk,mkc->msc", share, corners), distance_upper_bound=height)[0])
    deep: Mask = np.any(depth > SEEN * height, axis=1)  # infinite where it is farther
    edge = np.unique(faces[mesh.border[faces]])
    bare = edge[near.query(mesh.vertices[edge])[0] > LEVELS[0] * height] if len(edge) else edge
    if len(bare) and deep.any():  # of the gaps that reach an edge of the wall nothing is asked
        deep[deep] = cKDTree(mesh.vertices[bare]).query(corners[deep].mean(axis=1))[0] > height
    if not deep.any():
        return []
    # the gap ends within a layer height of where it is deep
    size = np.linalg.norm(np.ptp(corners[deep], axis=1), axis=1).max()
    beside = cKDTree(corners[deep].mean(axis=1)).query(corners.mean(axis=1))[0] < height + 2.0 * size
    fine = _finer(mesh.vertices, faces[beside], FINE * height)
    depth = np.asarray(near.query(fine.vertices)[0])
    found: list[SpaceCurve] = []
    for _ in range(ROUNDS):
        if depth.max() <= COVERED * height:
            break
        more = _closed_gaps(wall, fine, depth, height)
        if not more:
            break
        found += more
        depth = np.minimum(depth, cKDTree(_samples(more, SAMPLED * height)).query(fine.vertices)[0])
    return found


def _closed_gaps(wall: Wall, fine: Mesh, depth: Array, height: float) -> list[SpaceCurve]:
    """One bead for each gap that is deeper than COVERED somewhere."""
    found: list[SpaceCurve] = []
    done = np.zeros(len(depth), dtype=bool)
    for level in LEVELS:
        inside = depth > level * height
        label = _labels(fine, inside)
        deepest = np.zeros(label.max() + 1)
        np.maximum.at(deepest, label[inside], depth[inside])
        lines = fine.level_lines(depth - level * height, np.arange(len(fine.faces)))
        if not lines or not inside.any():
            continue
        places, tree = np.flatnonzero(inside), cKDTree(fine.vertices[inside])
        owner = np.array([label[places[tree.query(line.points.mean(axis=0) if len(line.points) < 3 else line.points[0])[1]]]
                          for line in lines])
        for gap in np.unique(owner):
            its = [lines[k] for k in np.flatnonzero(owner == gap)]
            members = label == gap
            if deepest[gap] <= COVERED * height or done[members].any() or not all(line.closed for line in its):
                continue
            bead = _middle(wall, [line.points for line in its], height)
            if bead is not None and (bead.length >= SHORTEST * height or level == LEVELS[-1]):
                found.append(bead)
                done |= members
    return found


def _labels(fine: Mesh, inside: Mask) -> Index:
    """The number (n,) of the gap that each vertex is in; vertices in none have one of their own."""
    edges = fine.edges[inside[fine.edges].all(axis=1)]
    n = len(fine.vertices)
    links = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(n, n))
    label: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return label


def _middle(wall: Wall, borders: list[Array], height: float) -> SpaceCurve | None:
    """The line halfway between the sides of a gap with the borders (k, 3): open along one that has a single border, closed
    within a ring."""
    longest = max(borders, key=len)
    if len(borders) == 2:
        other = next(border for border in borders if border is not longest)
        return _through(wall, 0.5 * (longest + _beside(longest, other)), height, True)
    ahead = longest - longest.mean(axis=0)
    one = int(np.argmax(np.linalg.norm(ahead, axis=1)))
    line = np.roll(longest, -one, axis=0)
    other_end = int(np.argmax(np.linalg.norm(line - line[0], axis=1)))
    if other_end < 1 or other_end > len(line) - 1:
        return None
    side, back = line[: other_end + 1], np.vstack([line[other_end:], line[:1]])
    middle = 0.5 * (side + _beside(side, back))
    return _through(wall, np.vstack([line[:1], middle[1:-1], line[other_end : other_end + 1]]), height, False)


def _beside(points: Array, line: Array) -> Array:
    """The nearest places (n, 3) of a polyline, sampled."""
    share = np.linspace(0.0, 1.0, 8, endpoint=False)[None, :, None]
    dense = np.vstack([((1.0 - share) * line[:-1, None] + share * line[1:, None]).reshape(-1, 3), line[-1:]])
    nearest: Array = dense[cKDTree(dense).query(points)[1]]
    return nearest


def _through(wall: Wall, points: Array, height: float, closed: bool) -> SpaceCurve | None:
    """A smooth curve on the wall near a chain of points."""
    if closed:
        points = np.vstack([points, points[:1]])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    points = points[np.r_[True, steps > 1e-9]]
    s = np.r_[0.0, np.cumsum(steps[steps > 1e-9])]
    count = max(2 if not closed else 6, int(np.ceil(s[-1] / (0.5 * height))))
    if len(s) < 2:
        return None
    at = np.linspace(0.0, s[-1], count + 1)
    # means over the way to the neighbours: the sides of a gap are known to the fine mesh alone
    fine = np.linspace(0.0, s[-1], 16 * count + 1)
    dense = np.column_stack([np.interp(fine, s, column) for column in points.T])
    means = np.stack([dense[np.clip(16 * np.arange(count + 1) + k, 0, 16 * count)] for k in range(-6, 7)]).mean(axis=0)
    means[[0, -1]] = dense[[0, -1]] if not closed else 0.5 * (means[0] + means[-1])
    nodes = wall.project(means)[0]
    if closed:
        nodes[-1] = nodes[0]
    slope = CubicSpline(at, nodes, bc_type="periodic" if closed else "natural")(at, 1)
    return SpaceCurve(at, nodes, slope, slope, closed)


def _samples(curves: list[SpaceCurve], step: float) -> Array:
    """Points all along the curves, no farther apart than about `step` mm."""
    parts = []
    for curve in curves:
        count = max(2, int(np.ceil(curve.length / step)))
        w = np.union1d(np.linspace(curve.w[0], curve.w[-1], count + 1), curve.w)
        parts.append(curve.at(w)[0])
    return np.vstack(parts)


def _parts(corners: Array, longest: float) -> tuple[Array, Index]:
    """Triangles (m, 3, 3) cut evenly so that no edge is longer than `longest` mm: the corners' shares (k, 3) in the parts'
    vertices, and the vertices (l, 3) of each part."""
    edge = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max()
    n = max(1, int(np.ceil(edge / longest)))
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
    i, j = i[i + j <= n], j[i + j <= n]
    number = np.full((n + 2, n + 2), -1)
    number[i, j] = np.arange(len(i))
    up, down = i + j < n, i + j < n - 1
    parts = np.vstack([
        np.stack([number[i[up], j[up]], number[i[up] + 1, j[up]], number[i[up], j[up] + 1]], axis=1),
        np.stack([number[i[down] + 1, j[down]], number[i[down] + 1, j[down] + 1], number[i[down], j[down] + 1]], axis=1),
    ])
    return np.stack([n - i - j, i, j], axis=1) / n, parts.astype(np.intp)


def _finer(vertices: Array, faces: Index, longest: float) -> Mesh:
    """The mesh of the faces (m, 3), cut evenly so that no edge is longer than `longest` mm."""
    corners = vertices[faces]
    share, parts = _parts(corners, longest)
    points = np.einsum("sk,mkc->msc", share, corners).reshape(-1, 3)
    every = (np.arange(len(faces))[:, None, None] * len(share) + parts[None]).reshape(-1, 3)
    _, first, same = np.unique(np.round(points, ALIKE) + 0.0, axis=0, return_index=True, return_inverse=True)
    return Mesh(points[first], np.ravel(same)[every].astype(np.intp))
