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
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from ...types import Array, Index, Mask
from .curve import Feet, feet
from .gap_middle import finer, middle, samples, shares

COVERED = 0.594  # of the height; no point is to be farther from a bead, and is found to less than the rest to 0.6
LEVELS = (0.5, 0.42, 0.34)  # of the height; how deep the border of what is closed lies, for a bead that is long enough
SHORTEST = 0.5  # of the height
COARSE, FINE = 0.2, 0.1  # of the height; edges of the mesh on which gaps are sought, and are seen
LONGEST = 2.0  # of the height; of a bead in a gap whose border is not as deep as layers leave the wall anyway
SAMPLED = 0.05  # of the height; places along the beads
ROUNDS = 4
SEEN = 0.02  # of the height; gaps deeper by this than half the spacing of layers are looked at
LEFT = 0.005  # of the height, likewise; what is left open
ON_EDGE_MM = 1e-5  # mm; what is nearer to an edge of the mesh lies on it
UNSURE = 0.07  # of the height; how far off the depth of a gap may be that is told by the vertices of the fine mesh
AROUND, CLIMB, SHORTER = 8, 14, 0.7  # ways in which deeper places are sought, how often, how much shorter each time


def closing(
    wall: PatchWall, below: list[SpaceCurve], above: list[SpaceCurve], passed: Index, height: float, ends: Array,
    widest: float = 1.0,
) -> list[SpaceCurve]:
    """The beads, along the middle of gaps, that cover the wall between fronts.

    below, above: the fronts of two layers that follow each other, those above none where the wall ends. passed: (n,) the
    vertices of the wall's mesh between them. ends: points (k, 3) along the edges at which layers finish. widest: heights
    that the layers may be apart.
    """
    if not len(passed):
        return []
    fronts, mesh = [*below, *above], wall.mesh
    faces = mesh.faces[mesh.faces_at(passed)]
    near = cKDTree(samples(fronts, SAMPLED * height))
    corners = mesh.vertices[faces]
    share, _ = shares(corners, COARSE * height)
    places = np.einsum("sk,mkc->msc", share, corners)
    depth = np.asarray(near.query(places, distance_upper_bound=height)[0])
    deep: Mask = depth > (0.5 * widest + SEEN) * height  # infinite where it is farther
    if not deep.any() or (len(above) and not _between(below, above, places, corners, deep)):
        return []
    deep = deep.any(axis=1)
    # the gap ends within a layer height of where it is deep
    size = np.linalg.norm(np.ptp(corners[deep], axis=1), axis=1).max()
    adjacent = cKDTree(corners[deep].mean(axis=1)).query(corners.mean(axis=1))[0] < height + 2.0 * size
    fine = finer(mesh.vertices, faces[adjacent], FINE * height)
    depth = np.asarray(near.query(fine.vertices)[0])
    asked = np.ones(len(depth), dtype=bool)
    cut = np.setdiff1d(fine.border_edges, _on_rims(mesh, np.unique(faces), fine))
    if len(ends):
        asked = np.asarray(cKDTree(ends).query(fine.vertices)[0]) > height
    levels = LEVELS if widest == 1.0 else (0.5 * widest,)  # lower ones would take all that lies between uneven layers in
    gaps = _Gaps(wall, fine, asked, cut, height, max(COVERED, 0.5 * widest + LEFT), levels, ends)
    found: list[SpaceCurve] = []
    for _ in range(ROUNDS):
        more = gaps.closed(depth, [*fronts, *found])
        if not more:
            break
        found += more
        depth = np.minimum(depth, cKDTree(samples(more, SAMPLED * height)).query(fine.vertices)[0])
    return found


def _between(below: list[SpaceCurve], above: list[SpaceCurve], places: Array, corners: Array, deep: Mask) -> bool:
    """Whether any of the deep ones (m, s) of places (m, s, 3) on triangles (m, 3, 3) lies between the fronts: not all of
    them above those above, which have the wall still to come on their left, or below those below."""
    face, spot = np.nonzero(deep)
    points = places[face, spot]
    normal = np.cross(corners[face, 1] - corners[face, 0], corners[face, 2] - corners[face, 0])
    old, new = feet(below, points), feet(above, points)

    def on_left(found: Feet, fronts: list[SpaceCurve]) -> Mask:
        slope = np.empty_like(points)
        for k, front in enumerate(fronts):
            slope[found.front == k] = front.at(found.w[found.front == k])[1]
        return dot(np.cross(normal, slope), found.away) > 0.0

    nearer = new.distance < old.distance
    beyond = np.where(nearer, on_left(new, above), ~on_left(old, below))
    return not beyond.all()


class _Gaps(NamedTuple):
    """Where gaps may be: a fine mesh, and its vertices (n,) that must not be farther than `covered` heights from a bead.

    cut: those of its vertices (k,) that lie on its border, but on none of the wall: what reaches them is not a gap between
    fronts. levels: heights, where borders of gaps are drawn. ends: points (k, 3) where layers finish."""

    wall: PatchWall
    fine: Mesh
    asked: Mask
    cut: Index
    height: float
    covered: float
    levels: tuple[float, ...]
    ends: Array

    def _peaks(self, depth: Array, beads: list[SpaceCurve]) -> Array:
        """The depths (n,), at the vertices nearest to the deepest places on the exact wall those of the places, where they
        are about `covered`: whether a gap is closed must not depend on where the mesh has its vertices."""
        low, high = self.fine.edges.T
        over = np.zeros(len(depth))
        np.maximum.at(over, low, depth[high])
        np.maximum.at(over, high, depth[low])
        near = self.asked & (depth >= over) & (np.abs(depth / self.height - self.covered) < UNSURE)
        near[self.fine.border_edges] = False
        top = np.flatnonzero(near)
        peaks = depth.copy()
        if not len(top):
            return peaks
        place, normal = self.wall.project(self.fine.vertices[top])
        best = feet(beads, place).distance
        angle = 2.0 * np.pi * np.arange(AROUND) / AROUND
        tree, border = cKDTree(self.fine.vertices), np.zeros(len(depth), dtype=bool)
        border[self.fine.border_edges] = True
        step = FINE * self.height
        for _ in range(CLIMB):
            one = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal), axis=1)])
            one /= np.linalg.norm(one, axis=1, keepdims=True)
            other = np.cross(normal, one)
            way = np.cos(angle)[:, None, None] * one + np.sin(angle)[:, None, None] * other
            tried, out = self.wall.project((place + step * way).reshape(-1, 3))
            found = feet(beads, tried).distance
            found[border[np.asarray(tree.query(tried)[1])]] = 0.0
            if len(self.ends):
                found[np.asarray(cKDTree(self.ends).query(tried)[0]) <= self.height] = 0.0
            found, tried, out = found.reshape(AROUND, -1), tried.reshape(AROUND, -1, 3), out.reshape(AROUND, -1, 3)
            row, pick = np.arange(len(top)), np.argmax(found, axis=0)
            up = found[pick, row] > best
            best = np.where(up, found[pick, row], best)
            place = np.where(up[:, None], tried[pick, row], place)
            normal = np.where(up[:, None], out[pick, row], normal)
            step *= SHORTER
        np.maximum.at(peaks, np.asarray(tree.query(place)[1]), best)
        return peaks

    def closed(self, depth: Array, beads: list[SpaceCurve]) -> list[SpaceCurve]:
        """One bead for each gap that is too deep somewhere; depth: (n,) of the vertices below the beads."""
        height, fine = self.height, self.fine
        peaks = self._peaks(depth, beads)
        found: list[SpaceCurve] = []
        short: list[tuple[SpaceCurve, Mask]] = []
        done = np.zeros(len(depth), dtype=bool)
        for level in self.levels:
            inside = depth > level * height
            if not (self.asked & (peaks > self.covered * height) & ~done).any():
                break
            label = _labels(fine, inside)
            deepest = np.zeros(label.max() + 1)
            np.maximum.at(deepest, label[inside & self.asked], peaks[inside & self.asked])
            deepest[label[self.cut[inside[self.cut]]]] = 0.0
            lines = fine.level_lines(level * height - depth, np.arange(len(fine.faces)))  # gaps on their left
            places, tree = np.flatnonzero(inside), cKDTree(fine.vertices[inside])
            # a single point of a line may lie nearer to the gap next door: most of them tell
            owner = np.array([np.bincount(label[places[tree.query(line.points)[1]]]).argmax() for line in lines])
            for gap in np.flatnonzero(deepest > self.covered * height):
                members = label == gap
                loops = _loops(fine, members, [line for line, own in zip(lines, owner) if own == gap])
                bead = middle(self.wall, loops, height) if loops and not done[members].any() else None
                if bead is None or (level != self.levels[0] and bead.length > LONGEST * height):
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
    near = cKDTree(0.5 * (start + end)).query(fine.vertices[border], k=min(4, len(edges)))[1].reshape(len(border), -1)
    along, ahead = (end - start)[near], fine.vertices[border][:, None] - start[near]
    share = np.clip((along * ahead).sum(-1) / (along * along).sum(-1), 0.0, 1.0)
    off = np.linalg.norm(ahead - share[..., None] * along, axis=-1).min(axis=1)
    on: Index = border[off < ON_EDGE_MM]
    return on


def _loops(fine: Mesh, members: Mask, lines: list[LevelLine]) -> list[Array]:
    """The borders (k, 3) of a gap, all the way around: its level lines, and where they end the mesh's own border."""
    loops = [line.points for line in lines if line.closed]
    pieces = [line.points for line in lines if not line.closed]
    begin, end = fine.border_edges[members[fine.border_edges].all(axis=1)].T
    own, place = np.unique(np.r_[begin, end, fine.border_edges[:, 0][members[fine.border_edges[:, 0]]]], return_inverse=True)
    following = np.full(len(own), -1, dtype=np.intp)
    following[place[: len(begin)]] = place[len(begin) : 2 * len(begin)]
    for chain, closed in chains(following) if len(own) else ():
        (loops if closed else pieces).append(fine.vertices[own[chain]])
    while pieces:
        loop = [pieces.pop(0)]
        while pieces:
            here = loop[-1][-1]
            steps = [np.linalg.norm(piece[0] - here) for piece in pieces]
            following_one = int(np.argmin(steps))
            if steps[following_one] > np.linalg.norm(loop[0][0] - here):
                break
            loop.append(pieces.pop(following_one))
        loops.append(np.vstack(loop))
    return [loop for loop in loops if len(loop) > 2]


def _labels(fine: Mesh, inside: Mask) -> Index:
    """The number (n,) of the gap that each vertex is in; vertices in none have one of their own."""
    edges = fine.edges[inside[fine.edges].all(axis=1)]
    n = len(fine.vertices)
    links = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(n, n))
    label: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return label
