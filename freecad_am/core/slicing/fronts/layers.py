# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of constant local distance on any wall: fronts run over a mesh and are made exact
on the wall.

From the fronts of a layer the distance in space to nearby mesh vertices is measured, with
a sign: vertices behind are below. The level line at the layer height is traced through
the triangles, which lets fronts split, merge, close and end at the wall's edges. Each
piece is then moved onto the exact wall and to the exact distance from the curve below,
and its corners are found (see `curve`). The mesh decides which pieces exist, not their
position: its edges should be no longer than the layer height and a quarter of the
smallest radius of curvature. Features thinner than an edge may be missed: slivers between
fronts that meet, gaps at a rim. A geodesic distance field over the whole wall would be
simpler, but it measures distances along the wall and accumulates the errors of the
layers; here each layer starts from the one before, as the deposit does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.mesh.triangle_mesh import LevelLine, Mesh, chains, cut_evenly, thin_points
from ...geometry.step_count import step_count
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from ...issues import Text
from ...types import Array, Index, Mask
from ..smoothest_heights import HEAVY, refuse_too_many
from .curve import Slicing, Smoothing, fit_front, fit_to_wall
from .rims import (
    Feet,
    Rims,
    cut_at_rims,
    local_distances,
    nearest_feet,
    points_near_fronts,
    resample,
    smooth_points,
)
from .smooth import SmoothFront, smooth_front

# ---- Beads that close gaps between fronts. Where fronts meet, come together at a corner, or run
# along the edge of an opening or a side of the wall, no front passes some points: up to a layer
# height deep in a front that closes on itself, and between two that run into each other. Points
# deeper than COVERED in a gap get a separate bead along its middle. Within a layer height of an
# edge at which layers finish nothing needs closing: there the wall ends.

MIN_STRAIGHTNESS = 1.2  # of the height; shorter beads are
ROUND = 0.8  # of the height; standard deviation of the mean that rounds a bead


def gap_middle(slicing: Slicing, borders: list[Array]) -> SpaceCurve | None:
    """Return the curve midway between the sides of a gap.

    Parameters
    ----------
    slicing : Slicing
        The wall and its tolerances.
    borders : list of (k, 3) array
        Borders of the gap, mm: one, or two of a ring.

    Returns
    -------
    SpaceCurve or None
        Open for one border, closed within a ring; None if the border has no extent.
    """
    longest = max(borders, key=len)
    if len(borders) == 2:
        inner_border = next(border for border in borders if border is not longest)
        return _through(slicing, 0.5 * (longest + _opposite(longest, inner_border)), True)
    farthest = int(np.argmax(np.linalg.norm(longest - longest.mean(axis=0), axis=1)))
    border = np.roll(longest, -farthest, axis=0)
    end = int(np.argmax(np.linalg.norm(border - border[0], axis=1)))
    if end < 1 or end > len(border) - 1:
        return None
    side, back = border[: end + 1], np.vstack([border[end:], border[:1]])
    points = 0.5 * (side + _opposite(side, back))
    return _through(slicing, np.vstack([border[:1], points[1:-1], border[end : end + 1]]), False)


def _opposite(points: Array, border: Array) -> Array:
    """The nearest points (n, 3) of a border, sampled."""
    share = np.linspace(0.0, 1.0, 8, endpoint=False)[None, :, None]
    samples = np.vstack(
        [((1.0 - share) * border[:-1, None] + share * border[1:, None]).reshape(-1, 3), border[-1:]]
    )
    nearest: Array = samples[cKDTree(samples).query(points)[1]]
    return nearest


def _through(slicing: Slicing, points: Array, closed: bool) -> SpaceCurve | None:
    """A smooth curve on the wall near a line of points."""
    wall, height = slicing.wall, slicing.height
    if closed:
        points = np.vstack([points, points[:1]])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    points = points[np.r_[True, steps > 1e-9]]
    length = float(steps.sum())
    count = step_count(length, 0.5 * height, 6 if closed else 2)
    if len(points) < 2:
        return None
    # only the fine mesh knows the sides of a gap, and its middle has hooks at the ends
    line = resample(points, closed, 16 * count)
    wide = min(ROUND * height / (length / (16 * count)), 4.0 * count)
    nodes = smooth_points(line, closed, wide)[::16]
    if closed:
        nodes = np.vstack([nodes, nodes[:1]])
    elif length < MIN_STRAIGHTNESS * height:
        nodes = line[0] + np.linspace(0.0, 1.0, count + 1)[:, None] * (line[-1] - line[0])
    w = np.linspace(0.0, length, count + 1)
    nodes, normal = wall.project(nodes)
    if closed:
        nodes[-1], normal[-1] = nodes[0], normal[0]
    slope = CubicSpline(w, nodes, bc_type="periodic" if closed else "natural")(w, 1)
    slope -= dot(slope, normal)[:, None] * normal
    return fit_to_wall(wall, SpaceCurve(w, nodes, slope, slope, closed))


# of the height; maximum distance of a point from a bead, with an error below the remainder to 0.6
COVERED = 0.594
LEVELS = (
    0.5,
    0.42,
    0.34,
)  # of the height; depth of the border of a closed gap whose bead is long enough
MIN_CLOSING_LENGTH = 0.5  # of the height
COARSE, FINE = 0.2, 0.1  # of the height; edges of the mesh on which gaps are sought, and are seen
MAX_LENGTH = 2.0  # of the height; length of a bead in a gap with a border shallower than the normal gap between layers
SAMPLED = 0.05  # of the height; between points along the beads
ROUNDS = 4
MIN_PEAK = 0.02  # of the height; gaps deeper by this than half the layer spacing are examined
MAX_OPEN_DEPTH = 0.005  # of the height, likewise; gaps that stay open
ON_EDGE_MM = 1e-5  # mm; points nearer to an edge of the mesh are on it
DEPTH_UNCERTAINTY = (
    0.07  # of the height; error of a gap depth sampled at the vertices of the fine mesh
)
SEARCH_DIRECTIONS, SEARCH_STEPS, STEP_REDUCTION = (
    8,
    14,
    0.7,
)  # directions in which deeper points are sought, how often, how much shorter each time


def close_gaps(
    slicing: Slicing, below: list[SpaceCurve], above: list[SpaceCurve], passed: Index
) -> list[SpaceCurve]:
    """Return the beads that cover the wall between fronts, along the middle of gaps.

    Parameters
    ----------
    slicing : Slicing
        Wall, rims and layer height.
    below, above : list of SpaceCurve
        The fronts of two consecutive layers; `above` is empty where the wall ends.
    passed : (n,) int array
        Vertices of the wall's mesh between them.

    Returns
    -------
    list of SpaceCurve
        The beads; the deposit below is on their right.
    """
    if not len(passed):
        return []
    fronts, height, mesh = [*below, *above], slicing.height, slicing.wall.mesh
    faces = mesh.faces[mesh.faces_at(passed)]
    has_gap = _near_gaps(slicing, below, above, mesh.vertices[faces])
    if not has_gap.any():
        return []
    fine = Mesh(mesh.vertices, faces[has_gap]).finer(FINE * height)
    cut = np.setdiff1d(fine.border_edges, _find_rim_vertices(mesh, np.unique(faces), fine))
    gaps = _Gaps(slicing, fine, slicing.rims.from_upper(fine.vertices) > height, cut)
    depth = _depth(fine.vertices, fronts, height)
    beads: list[SpaceCurve] = []
    for _ in range(ROUNDS):
        new_beads = gaps.close(depth, [*fronts, *beads])
        if not new_beads:
            break
        beads += new_beads
        depth = np.minimum(depth, _depth(fine.vertices, new_beads, height))
    return [_orient_bead(slicing, bead, below) for bead in beads]


def _near_gaps(
    slicing: Slicing, below: list[SpaceCurve], above: list[SpaceCurve], corners: Array
) -> Mask:
    """Which of the triangles (m, 3, 3) between fronts are where gaps may be."""
    height = slicing.height
    points = cut_evenly(corners, COARSE * height)[0]
    deep: Mask = (
        _depth(points, [*below, *above], height, height)
        > (0.5 * slicing.widest + MIN_PEAK) * height
    )
    if not deep.any() or (
        len(above) and not _is_between_fronts(below, above, points, corners, deep)
    ):
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


def _is_between_fronts(
    below: list[SpaceCurve], above: list[SpaceCurve], points: Array, corners: Array, deep: Mask
) -> bool:
    """Return whether any of the deep points is between the fronts.

    deep: (m, s) of points (m, s, 3) on triangles (m, 3, 3). False if all are beyond the
    fronts above, which have the rest of the wall on their left, or before the fronts below.
    """
    face, row = np.nonzero(deep)
    points = points[face, row]
    normal = np.cross(corners[face, 1] - corners[face, 0], corners[face, 2] - corners[face, 0])

    def is_on_left(foot: Feet, fronts: list[SpaceCurve]) -> Mask:
        slope = np.empty_like(points)
        for k, front in enumerate(fronts):
            slope[foot.front == k] = front.at(foot.w[foot.front == k])[1]
        return dot(np.cross(normal, slope), foot.away) > 0.0

    at_below, at_above = nearest_feet(below, points), nearest_feet(above, points)
    beyond = np.where(
        at_above.distance < at_below.distance,
        is_on_left(at_above, above),
        ~is_on_left(at_below, below),
    )
    return not beyond.all()


def _orient_bead(slicing: Slicing, bead: SpaceCurve, below: list[SpaceCurve]) -> SpaceCurve:
    """Return the bead oriented so that the deposit below is on its right."""
    points, left_vectors = slicing.left_of(bead)
    return (
        bead
        if dot(nearest_feet(below, points).away, left_vectors).sum() >= 0.0
        else bead.reversed()
    )


class _Gaps(NamedTuple):
    """Regions that may have gaps: a fine mesh, and its vertices (n,) that must not be far from a
    bead.

    cut: its vertices (k,) on its border but not on a border of the wall: a gap that reaches
    them is not a gap between fronts.
    """

    slicing: Slicing
    fine: Mesh
    must_cover: Mask
    cut: Index

    @property
    def covered(self) -> float:
        """Heights that no vertex asked for is to be farther from a bead."""
        return max(COVERED, 0.5 * self.slicing.widest + MAX_OPEN_DEPTH)

    def _peaks(self, depth: Array, beads: list[SpaceCurve]) -> Array:
        """Return the depths (n,), refined at vertices nearest to the deepest points on the exact
        wall.

        Only depths of about `covered` are refined: whether a gap is closed must not depend on
        where the mesh has its vertices.
        """
        wall, height = self.slicing.wall, self.slicing.height
        low, high = self.fine.edges.T
        deepest = np.zeros(len(depth))  # of their neighbours
        np.maximum.at(deepest, low, depth[high])
        np.maximum.at(deepest, high, depth[low])
        border = np.zeros(len(depth), dtype=bool)
        border[self.fine.border_edges] = True
        uncertain = (
            self.must_cover
            & (depth >= deepest)
            & (np.abs(depth / height - self.covered) < DEPTH_UNCERTAINTY)
            & ~border
        )
        peaks = depth.copy()
        if not uncertain.any():
            return peaks
        points, normal = wall.project(self.fine.vertices[uncertain])
        best = nearest_feet(beads, points).distance
        angle = 2.0 * np.pi * np.arange(SEARCH_DIRECTIONS) / SEARCH_DIRECTIONS
        tree, step, row = cKDTree(self.fine.vertices), FINE * height, np.arange(len(points))
        for _ in range(SEARCH_STEPS):
            tangent = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal), axis=1)])
            tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
            around = np.cos(angle)[:, None, None] * tangent + np.sin(angle)[
                :, None, None
            ] * np.cross(normal, tangent)
            candidates, normals = wall.project((points + step * around).reshape(-1, 3))
            distances = nearest_feet(beads, candidates).distance
            distances[border[np.asarray(tree.query(candidates)[1])]] = 0.0
            distances[self.slicing.rims.from_upper(candidates) <= height] = 0.0
            distances = distances.reshape(SEARCH_DIRECTIONS, -1)
            candidates, normals = (
                column.reshape(SEARCH_DIRECTIONS, -1, 3) for column in (candidates, normals)
            )
            pick = np.argmax(distances, axis=0)
            deeper = distances[pick, row] > best
            best = np.where(deeper, distances[pick, row], best)
            points = np.where(deeper[:, None], candidates[pick, row], points)
            normal = np.where(deeper[:, None], normals[pick, row], normal)
            step *= STEP_REDUCTION
        np.maximum.at(peaks, np.asarray(tree.query(points)[1]), best)
        return peaks

    def close(self, depth: Array, beads: list[SpaceCurve]) -> list[SpaceCurve]:
        """Return one bead for each gap that is too deep somewhere; depth: (n,) of the vertices below
        the beads.
        """
        height, fine, covered = self.slicing.height, self.fine, self.covered * self.slicing.height
        peaks = self._peaks(depth, beads)
        new_beads: list[SpaceCurve] = []
        short: list[tuple[SpaceCurve, Mask]] = []
        is_closed = np.zeros(len(depth), dtype=bool)
        # lower levels would include everything between uneven layers
        levels = LEVELS if self.slicing.widest == 1.0 else (0.5 * self.slicing.widest,)
        for level in levels:
            inside = depth > level * height
            if not (self.must_cover & (peaks > covered) & ~is_closed).any():
                break
            number = _numbers(fine, inside)
            deepest = np.zeros(number.max() + 1)
            np.maximum.at(
                deepest, number[inside & self.must_cover], peaks[inside & self.must_cover]
            )
            deepest[number[self.cut[inside[self.cut]]]] = 0.0
            lines = fine.level_lines(
                level * height - depth, np.arange(len(fine.faces))
            )  # gaps on the left
            gap_number, tree = number[inside], cKDTree(fine.vertices[inside])
            # a single point of a line may be nearer to the adjacent gap: the majority decides
            owner = np.array(
                [np.bincount(gap_number[tree.query(line.points)[1]]).argmax() for line in lines]
            )
            for gap in np.flatnonzero(deepest > covered):
                members = number == gap
                loops = _loops(
                    fine,
                    members,
                    [line for line, line_owner in zip(lines, owner) if line_owner == gap],
                )
                bead = (
                    gap_middle(self.slicing, loops)
                    if loops and not is_closed[members].any()
                    else None
                )
                if bead is None or (level != levels[0] and bead.length > MAX_LENGTH * height):
                    continue
                if bead.length < MIN_CLOSING_LENGTH * height:
                    short.append((bead, members))
                else:
                    new_beads.append(bead)
                    is_closed |= members
        # lower borders would not make these beads longer, or would include too much
        for bead, members in short:
            if not is_closed[members].any():
                new_beads.append(bead)
                is_closed |= members
        return new_beads


def _find_rim_vertices(mesh: Mesh, vertices: Index, fine: Mesh) -> Index:
    """Return the vertices of the fine mesh on the border of the mesh, near the given vertices of
    the mesh.
    """
    edges = mesh.border_edges[np.isin(mesh.border_edges, vertices).all(axis=1)]
    if not len(edges):
        return np.empty(0, dtype=np.intp)
    border = np.unique(fine.border_edges)
    start, end = mesh.vertices[edges].transpose(1, 0, 2)
    nearest_edges = (
        cKDTree(0.5 * (start + end))
        .query(fine.vertices[border], k=min(4, len(edges)))[1]
        .reshape(len(border), -1)
    )
    chord = (end - start)[nearest_edges]
    offset = fine.vertices[border][:, None] - start[nearest_edges]
    share = np.clip((chord * offset).sum(-1) / (chord * chord).sum(-1), 0.0, 1.0)
    off = np.linalg.norm(offset - share[..., None] * chord, axis=-1).min(axis=1)
    on_edge: Index = border[off < ON_EDGE_MM]
    return on_edge


def _loops(fine: Mesh, members: Mask, lines: list[LevelLine]) -> list[Array]:
    """Return the borders (k, 3) of a gap, all the way around: level lines, continued along the
    mesh's border.
    """
    loops = [line.points for line in lines if line.closed]
    open_chains = [line.points for line in lines if not line.closed]
    start, end = fine.border_edges[members[fine.border_edges].all(axis=1)].T
    border_vertices, row = np.unique(
        np.r_[start, end, fine.border_edges[:, 0][members[fine.border_edges[:, 0]]]],
        return_inverse=True,
    )
    following = np.full(len(border_vertices), -1, dtype=np.intp)
    following[row[: len(start)]] = row[len(start) : 2 * len(start)]
    for chain, closed in chains(following) if len(border_vertices) else ():
        (loops if closed else open_chains).append(fine.vertices[border_vertices[chain]])
    while open_chains:
        loop = [open_chains.pop(0)]
        while open_chains:
            tip = loop[-1][-1]
            distances = [np.linalg.norm(chain_points[0] - tip) for chain_points in open_chains]
            nearest = int(np.argmin(distances))
            if distances[nearest] > np.linalg.norm(loop[0][0] - tip):
                break
            loop.append(open_chains.pop(nearest))
        loops.append(np.vstack(loop))
    return [loop for loop in loops if len(loop) > 2]


def _numbers(fine: Mesh, inside: Mask) -> Index:
    """The number (n,) of the gap that each vertex is in; vertices in none have one of their own."""
    edges = fine.edges[inside[fine.edges].all(axis=1)]
    n = len(fine.vertices)
    links = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(n, n))
    number: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return number


# ---- The layers

MIN_LENGTH = 0.2  # of the layer height; shorter fronts do not become beads
SLIVER, MAX_OFFSET = (
    10.0,
    5e-4,
)  # layer heights; mm. Fronts shorter than this may be off by no more between their nodes
THIN = 0.3  # of the typical edge; closer points of a level line count as one
BEHIND_MM = 1e-3  # mm; vertices nearer to a first curve are on it
ON_FRONT_MM = (
    1e-4  # mm; vertices nearer to a front are on it, so the last layer may be on the wall's edge
)
NEIGHBOURS = 12  # vertices near a point of a first curve that decide on which side the wall is


class Sliced(NamedTuple):
    """Layers of a wall.

    fronts: the fronts of each layer. closing: the beads that close gaps between the fronts of a
    layer and the layer below; after the last layer there may be a layer of only closing beads.
    rims: the edges at which fronts end.
    """

    fronts: list[list[SpaceCurve]]
    closing: list[list[SpaceCurve]]
    rims: Rims


def slice_layers(
    wall: PatchWall,
    height: float,
    smoothing: Smoothing | None = None,
    progress: Callable[[float, str], None] = lambda fraction, text: None,
) -> Sliced:
    """Return all layers, from the first until the wall is covered or its edges are reached.

    Parameters
    ----------
    wall : PatchWall
        The wall.
    height : float
        Layer height, mm.
    smoothing : Smoothing or None, optional
        How fronts are smoothed; None for exact ones.
    progress : callable, optional
        Receives the share of the wall that is covered, and a text; may raise to cancel.

    Returns
    -------
    Sliced
        Fronts, closing beads and rims.

    Raises
    ------
    InputError
        LAYER_HEIGHT for too many layers.
    """
    slicing = Slicing(wall, Rims.of(wall.rims), height, smoothing)
    state = start_state(slicing)
    fronts, beads = [state.fronts], [list[SpaceCurve]()]
    remaining = len(state.behind) - len(state.passed)
    while remaining:
        progress(1.0 - remaining / len(state.behind), Text("computing layer {}", len(fronts)))
        state = next_state(slicing, state)
        remaining -= len(state.passed)
        gap_beads = close_gaps(slicing, fronts[-1], state.fronts, state.passed)
        if state.fronts or gap_beads:
            beads.append(gap_beads)
        if not state.fronts:
            break
        refuse_too_many(len(fronts), height, wall.label)
        fronts.append(state.fronts)
    return Sliced(fronts, beads, slicing.rims)


@dataclass(frozen=True, eq=False)
class State:
    """Where the deposit has come to: the fronts of the last layer, the vertices (n,) behind them, those (k,) that the last
    layer passed, and which of banded.WEIGHTS smooth fronts were made with."""

    fronts: list[SpaceCurve]
    behind: Mask
    passed: Index
    weight: int = HEAVY


def start_state(slicing: Slicing) -> State:
    """Return the first layer.

    All fronts have the rest of the wall on their left, seen from the side to which the
    normals point.
    """
    wall, mesh, fronts = slicing.wall, slicing.wall.mesh, []
    for first_curve in wall.first:
        curve = first_curve.curve()
        points, left_vectors = slicing.left_of(curve)
        neighbours = np.asarray(mesh.tree.query(points, k=min(NEIGHBOURS, len(mesh.vertices)))[1])
        ahead = np.where(
            wall.behind[neighbours],
            0.0,
            dot(mesh.vertices[neighbours] - points[:, None], left_vectors[:, None]),
        )
        fronts.append(curve if ahead.sum() >= 0.0 else curve.reversed())
    behind = wall.behind.copy()
    neighbours = points_near_fronts(mesh.tree, fronts, mesh.longest_edge)
    behind[neighbours] |= nearest_feet(fronts, mesh.vertices[neighbours]).distance < BEHIND_MM
    return State(fronts, behind, np.flatnonzero(behind))


def next_state(slicing: Slicing, state: State) -> State:
    """Return the next layer: all fronts at the layer height from the fronts of the state,
    possibly none.

    With smoothing, fronts are as near to the height as the smoothing allows. The new state
    shares the array `behind`, with more vertices behind. Only the mesh near the fronts is
    examined, so all layers together examine each vertex a few times.
    """
    height, below, mesh = slicing.height, state.fronts, slicing.wall.mesh
    reach = height + mesh.longest_edge
    nearby = points_near_fronts(mesh.tree, below, reach)
    submesh, nearby = mesh.part(mesh.faces_at(nearby[~state.behind[nearby]]))
    if not len(nearby):
        return State([], state.behind, nearby, state.weight)
    behind, distance = state.behind[nearby], nearest_feet(below, submesh.vertices).distance
    value = np.where(behind, -distance, distance) - height
    low = submesh.connected_members(
        value < -ON_FRONT_MM, behind
    )  # proximity in space is not enough: the wall must lead there
    value = np.where(low, np.minimum(value, -1e-9 * height), np.maximum(value, 1e-9 * height))
    ends = slicing.rims.points_at_height(below, height, reach, ON_FRONT_MM)
    fronts: list[SpaceCurve] = []
    for line in cut_at_rims(
        submesh.level_lines(value, np.arange(len(submesh.faces))), ends, mesh.longest_edge
    ):
        points = thin_points(line.points, line.closed, THIN * mesh.typical_edge)
        if len(points) >= (4 if line.closed else 2):
            pieces = fit_front(slicing, below, line._replace(points=points))
            fronts += [front for front in pieces if _is_bead(front, below, height)]
    weight = state.weight
    if slicing.smoothing is not None:
        band = slicing.smoothing.band * height
        smooth = [
            smooth_front(slicing, below, front, fronts[:k] + fronts[k + 1 :], weight)
            for k, front in enumerate(fronts)
        ]
        doubtful = np.flatnonzero(~behind & (np.abs(distance - height) < 1.1 * band))
        low[doubtful] = _is_passed(
            slicing.wall, fronts, smooth, submesh.vertices[doubtful], low[doubtful], band
        )
        fronts = [smooth_front.curve for smooth_front in smooth]
        weight = max((smooth_front.weight for smooth_front in smooth), default=weight)
    passed = nearby[low & ~behind]
    state.behind[passed] = True
    return State(fronts, state.behind, passed, weight)


def _is_bead(front: SpaceCurve, below: list[SpaceCurve], height: float) -> bool:
    """Whether a front is long enough, and keeps its distance between the nodes too: slivers between fronts that meet head on
    may not; a bead that closes the gap takes their place."""
    if front.length <= MIN_LENGTH * height:
        return False
    return front.length > SLIVER * height or bool(
        np.abs(local_distances(front, below, 10) - height).max() < MAX_OFFSET
    )


def _is_passed(
    wall: PatchWall,
    unsmoothed: list[SpaceCurve],
    smooth: list[SmoothFront],
    points: Array,
    low: Mask,
    band: float,
) -> Mask:
    """Return whether points (n, 3) are behind smooth fronts, where these differ from the exact
    ones.

    low: whether they are behind the exact fronts. band: mm.
    """
    fronts = [smooth_front.curve for smooth_front in smooth]
    if not fronts or not len(points):
        return low
    foot = nearest_feet(fronts, points)
    moved = np.array([front is not exact_front for front, exact_front in zip(fronts, unsmoothed)])
    slope = np.empty_like(points)
    for k, front in enumerate(fronts):
        on_front = foot.front == k
        slope[on_front] = front.at(foot.w[on_front])[1]
    left_vectors = np.cross(wall.project(points)[1], slope)
    side = dot(
        points - foot.point, left_vectors / np.linalg.norm(left_vectors, axis=1, keepdims=True)
    )
    is_near = moved[foot.front] & (foot.distance < 2.0 * band)
    return np.where(is_near, side < -ON_FRONT_MM, low)
