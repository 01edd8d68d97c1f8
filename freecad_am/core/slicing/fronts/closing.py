# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads that close what fronts leave between them.

Where fronts meet, come together at a corner, or run along the edge of an opening or a side of the wall, points are left that
no front passes: up to a layer height deep in a front that closes on itself, and between two that run into each other. What
lies deeper than COVERED in there gets a bead of its own along the middle of the gap. Within a layer height of an edge at
which layers finish nothing is asked: there the wall ends.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.mesh.triangle_mesh import LevelLine, Mesh, chains
from ...geometry.mesh.triangles import cut_evenly
from ...geometry.step_count import step_count
from ...geometry.walls.surface import dot
from ...types import Array, Index, Mask
from .feet import Feet, feet
from .gap_middle import middle
from .slicing import Slicing

COVERED = 0.594  # of the height; no point is to be farther from a bead, and is found to less than the rest to 0.6
LEVELS = (
    0.5,
    0.42,
    0.34,
)  # of the height; how deep the border of what is closed lies, for a bead that is long enough
SHORTEST = 0.5  # of the height
COARSE, FINE = 0.2, 0.1  # of the height; edges of the mesh on which gaps are sought, and are seen
LONGEST = 2.0  # of the height; of a bead in a gap whose border is not as deep as layers leave the wall anyway
SAMPLED = 0.05  # of the height; between points along the beads
ROUNDS = 4
SEEN = 0.02  # of the height; gaps deeper by this than half the spacing of layers are looked at
LEFT = 0.005  # of the height, likewise; what is left open
ON_EDGE_MM = 1e-5  # mm; what is nearer to an edge of the mesh lies on it
UNSURE = 0.07  # of the height; how far off the depth of a gap may be that is told by the vertices of the fine mesh
AROUND, CLIMB, SHORTER = (
    8,
    14,
    0.7,
)  # directions in which deeper points are sought, how often, how much shorter each time


def closing(
    slicing: Slicing, below: list[SpaceCurve], above: list[SpaceCurve], passed: Index
) -> list[SpaceCurve]:
    """The beads, along the middle of gaps, that cover the wall between fronts; what was deposited below is on their right.

    below, above: the fronts of two layers that follow each other, those above none where the wall ends. passed: (n,) the
    vertices of the wall's mesh between them.
    """
    if not len(passed):
        return []
    fronts, height, mesh = [*below, *above], slicing.height, slicing.wall.mesh
    faces = mesh.faces[mesh.faces_at(passed)]
    near = _near_gaps(slicing, below, above, mesh.vertices[faces])
    if not near.any():
        return []
    fine = Mesh(mesh.vertices, faces[near]).finer(FINE * height)
    cut = np.setdiff1d(fine.border_edges, _on_rims(mesh, np.unique(faces), fine))
    gaps = _Gaps(slicing, fine, slicing.rims.from_upper(fine.vertices) > height, cut)
    depth = _depth(fine.vertices, fronts, height)
    beads: list[SpaceCurve] = []
    for _ in range(ROUNDS):
        more = gaps.closed(depth, [*fronts, *beads])
        if not more:
            break
        beads += more
        depth = np.minimum(depth, _depth(fine.vertices, more, height))
    return [_on_left(slicing, bead, below) for bead in beads]


def _near_gaps(
    slicing: Slicing, below: list[SpaceCurve], above: list[SpaceCurve], corners: Array
) -> Mask:
    """Which of the triangles (m, 3, 3) between fronts are where gaps may be."""
    height = slicing.height
    points = cut_evenly(corners, COARSE * height)[0]
    deep: Mask = (
        _depth(points, [*below, *above], height, height) > (0.5 * slicing.widest + SEEN) * height
    )
    if not deep.any() or (len(above) and not _between(below, above, points, corners, deep)):
        return np.zeros(len(corners), dtype=bool)
    # the gap ends within a layer height of where it is deep
    gap = corners[deep.any(axis=1)]
    extent = np.linalg.norm(np.ptp(gap, axis=1), axis=1).max()
    return np.asarray(
        cKDTree(gap.mean(axis=1)).query(corners.mean(axis=1))[0] < height + 2.0 * extent
    )


def _depth(
    points: Array, beads: list[SpaceCurve], height: float, farthest: float = np.inf
) -> Array:
    """Distances of points (..., 3) to beads that are sampled, infinite beyond the farthest."""
    samples = []
    for bead in beads:
        count = step_count(bead.length, SAMPLED * height, 2)
        samples.append(
            bead.at(np.union1d(np.linspace(bead.w[0], bead.w[-1], count + 1), bead.w))[0]
        )
    return np.asarray(cKDTree(np.vstack(samples)).query(points, distance_upper_bound=farthest)[0])


def _between(
    below: list[SpaceCurve], above: list[SpaceCurve], points: Array, corners: Array, deep: Mask
) -> bool:
    """Whether any of the deep ones (m, s) of points (m, s, 3) on triangles (m, 3, 3) lies between the fronts: not all of
    them above those above, which have the wall still to come on their left, or below those below."""
    face, row = np.nonzero(deep)
    points = points[face, row]
    normal = np.cross(corners[face, 1] - corners[face, 0], corners[face, 2] - corners[face, 0])

    def on_left(foot: Feet, fronts: list[SpaceCurve]) -> Mask:
        slope = np.empty_like(points)
        for k, front in enumerate(fronts):
            slope[foot.front == k] = front.at(foot.w[foot.front == k])[1]
        return dot(np.cross(normal, slope), foot.away) > 0.0

    at_below, at_above = feet(below, points), feet(above, points)
    beyond = np.where(
        at_above.distance < at_below.distance, on_left(at_above, above), ~on_left(at_below, below)
    )
    return not beyond.all()


def _on_left(slicing: Slicing, bead: SpaceCurve, below: list[SpaceCurve]) -> SpaceCurve:
    """The bead run so that what was deposited below is on its right."""
    points, left = slicing.left_of(bead)
    return bead if dot(feet(below, points).away, left).sum() >= 0.0 else bead.reversed()


class _Gaps(NamedTuple):
    """Where gaps may be: a fine mesh, and those of its vertices (n,) that must not be far from a bead.

    cut: those of its vertices (k,) that lie on its border, but on none of the wall: what reaches them is not a gap between
    fronts."""

    slicing: Slicing
    fine: Mesh
    asked: Mask
    cut: Index

    @property
    def covered(self) -> float:
        """Heights that no vertex asked for is to be farther from a bead."""
        return max(COVERED, 0.5 * self.slicing.widest + LEFT)

    def _peaks(self, depth: Array, beads: list[SpaceCurve]) -> Array:
        """The depths (n,), at the vertices nearest to the deepest points on the exact wall those of the points, where they
        are about `covered`: whether a gap is closed must not depend on where the mesh has its vertices."""
        wall, height = self.slicing.wall, self.slicing.height
        low, high = self.fine.edges.T
        deepest = np.zeros(len(depth))  # of their neighbours
        np.maximum.at(deepest, low, depth[high])
        np.maximum.at(deepest, high, depth[low])
        border = np.zeros(len(depth), dtype=bool)
        border[self.fine.border_edges] = True
        near = (
            self.asked
            & (depth >= deepest)
            & (np.abs(depth / height - self.covered) < UNSURE)
            & ~border
        )
        peaks = depth.copy()
        if not near.any():
            return peaks
        points, normal = wall.project(self.fine.vertices[near])
        best = feet(beads, points).distance
        angle = 2.0 * np.pi * np.arange(AROUND) / AROUND
        tree, step, row = cKDTree(self.fine.vertices), FINE * height, np.arange(len(points))
        for _ in range(CLIMB):
            one = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal), axis=1)])
            one /= np.linalg.norm(one, axis=1, keepdims=True)
            around = np.cos(angle)[:, None, None] * one + np.sin(angle)[:, None, None] * np.cross(
                normal, one
            )
            tried, normals = wall.project((points + step * around).reshape(-1, 3))
            found = feet(beads, tried).distance
            found[border[np.asarray(tree.query(tried)[1])]] = 0.0
            found[self.slicing.rims.from_upper(tried) <= height] = 0.0
            found = found.reshape(AROUND, -1)
            tried, normals = (column.reshape(AROUND, -1, 3) for column in (tried, normals))
            pick = np.argmax(found, axis=0)
            deeper = found[pick, row] > best
            best = np.where(deeper, found[pick, row], best)
            points = np.where(deeper[:, None], tried[pick, row], points)
            normal = np.where(deeper[:, None], normals[pick, row], normal)
            step *= SHORTER
        np.maximum.at(peaks, np.asarray(tree.query(points)[1]), best)
        return peaks

    def closed(self, depth: Array, beads: list[SpaceCurve]) -> list[SpaceCurve]:
        """One bead for each gap that is too deep somewhere; depth: (n,) of the vertices below the beads."""
        height, fine, covered = self.slicing.height, self.fine, self.covered * self.slicing.height
        peaks = self._peaks(depth, beads)
        found: list[SpaceCurve] = []
        short: list[tuple[SpaceCurve, Mask]] = []
        done = np.zeros(len(depth), dtype=bool)
        # lower ones would take in all that lies between uneven layers
        levels = LEVELS if self.slicing.widest == 1.0 else (0.5 * self.slicing.widest,)
        for level in levels:
            inside = depth > level * height
            if not (self.asked & (peaks > covered) & ~done).any():
                break
            number = _numbers(fine, inside)
            deepest = np.zeros(number.max() + 1)
            np.maximum.at(deepest, number[inside & self.asked], peaks[inside & self.asked])
            deepest[number[self.cut[inside[self.cut]]]] = 0.0
            lines = fine.level_lines(
                level * height - depth, np.arange(len(fine.faces))
            )  # gaps on their left
            own, tree = number[inside], cKDTree(fine.vertices[inside])
            # a single point of a line may lie nearer to the gap next door: most of them tell
            owner = np.array(
                [np.bincount(own[tree.query(line.points)[1]]).argmax() for line in lines]
            )
            for gap in np.flatnonzero(deepest > covered):
                members = number == gap
                loops = _loops(fine, members, [line for line, of in zip(lines, owner) if of == gap])
                bead = middle(self.slicing, loops) if loops and not done[members].any() else None
                if bead is None or (level != levels[0] and bead.length > LONGEST * height):
                    continue
                if bead.length < SHORTEST * height:
                    short.append((bead, members))
                else:
                    found.append(bead)
                    done |= members
        for bead, members in short:  # with lower borders they are no longer, or take in too much
            if not done[members].any():
                found.append(bead)
                done |= members
        return found


def _on_rims(mesh: Mesh, vertices: Index, fine: Mesh) -> Index:
    """The vertices of the fine mesh that lie on the border of the mesh, near some vertices of that."""
    edges = mesh.border_edges[np.isin(mesh.border_edges, vertices).all(axis=1)]
    if not len(edges):
        return np.empty(0, dtype=np.intp)
    border = np.unique(fine.border_edges)
    start, end = mesh.vertices[edges].transpose(1, 0, 2)
    near = (
        cKDTree(0.5 * (start + end))
        .query(fine.vertices[border], k=min(4, len(edges)))[1]
        .reshape(len(border), -1)
    )
    chord, away = (end - start)[near], fine.vertices[border][:, None] - start[near]
    share = np.clip((chord * away).sum(-1) / (chord * chord).sum(-1), 0.0, 1.0)
    off = np.linalg.norm(away - share[..., None] * chord, axis=-1).min(axis=1)
    found: Index = border[off < ON_EDGE_MM]
    return found


def _loops(fine: Mesh, members: Mask, lines: list[LevelLine]) -> list[Array]:
    """The borders (k, 3) of a gap, all the way around: its level lines, and where they end the mesh's own border."""
    loops = [line.points for line in lines if line.closed]
    parts = [line.points for line in lines if not line.closed]
    start, end = fine.border_edges[members[fine.border_edges].all(axis=1)].T
    own, row = np.unique(
        np.r_[start, end, fine.border_edges[:, 0][members[fine.border_edges[:, 0]]]],
        return_inverse=True,
    )
    following = np.full(len(own), -1, dtype=np.intp)
    following[row[: len(start)]] = row[len(start) : 2 * len(start)]
    for chain, closed in chains(following) if len(own) else ():
        (loops if closed else parts).append(fine.vertices[own[chain]])
    while parts:
        loop = [parts.pop(0)]
        while parts:
            last = loop[-1][-1]
            distances = [np.linalg.norm(part[0] - last) for part in parts]
            nearest = int(np.argmin(distances))
            if distances[nearest] > np.linalg.norm(loop[0][0] - last):
                break
            loop.append(parts.pop(nearest))
        loops.append(np.vstack(loop))
    return [loop for loop in loops if len(loop) > 2]


def _numbers(fine: Mesh, inside: Mask) -> Index:
    """The number (n,) of the gap that each vertex is in; vertices in none have one of their own."""
    edges = fine.edges[inside[fine.edges].all(axis=1)]
    n = len(fine.vertices)
    links = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(n, n))
    number: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return number
