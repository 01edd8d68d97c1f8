# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of constant local distance on any wall: trace fronts on a mesh, fit them to the wall.

The signed distance in space from the fronts of a layer to nearby mesh vertices is negative for
vertices behind the fronts. The level line at the layer height is traced through the triangles, so
that fronts can split, merge, close and end at the edges of the wall. Each piece is then moved onto
the exact wall and to the exact distance from the curve below, and its corners are computed (see
`curve`).

The mesh determines which pieces exist, but not their position. Mesh edges should not exceed the
layer height or a quarter of the minimum radius of curvature. Features thinner than an edge can be
missed: slivers between fronts that meet, and gaps at a rim. A geodesic distance field over the
complete wall would be simpler, but it measures distances along the wall and accumulates errors over
the layers. Here each layer starts from the previous layer, as the deposit does.
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

# ---- Beads that close gaps between fronts. Gaps occur where fronts meet, converge at a corner, or
# run along the edge of an opening or a side of the wall. They are up to one layer height deep in a
# front that closes on itself and between two fronts that collide. A gap with points deeper than
# COVERED gets a separate bead along its centreline. Within one layer height of an edge at which
# layers finish, gaps stay open because the wall ends there.

MIN_STRAIGHTNESS = 1.2  # in layer heights; shorter beads are straight
ROUND = 0.8  # in layer heights; standard deviation of the Gaussian mean that rounds a bead


def gap_middle(slicing: Slicing, borders: list[Array]) -> SpaceCurve | None:
    """Compute the centreline of a gap.

    Parameters
    ----------
    slicing : Slicing
        The wall and its tolerances.
    borders : list of (k, 3) array
        Borders of the gap, mm: one, or two for an annular gap.

    Returns
    -------
    SpaceCurve or None
        Open curve for one border, closed curve for two; None if the border has no extent.
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
    """Return the nearest points (n, 3) of a sampled border."""
    share = np.linspace(0.0, 1.0, 8, endpoint=False)[None, :, None]
    samples = np.vstack(
        [((1.0 - share) * border[:-1, None] + share * border[1:, None]).reshape(-1, 3), border[-1:]]
    )
    nearest: Array = samples[cKDTree(samples).query(points)[1]]
    return nearest


def _through(slicing: Slicing, points: Array, closed: bool) -> SpaceCurve | None:
    """Fit a smooth curve on the wall to a line of points."""
    wall, height = slicing.wall, slicing.height
    if closed:
        points = np.vstack([points, points[:1]])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    points = points[np.r_[True, steps > 1e-9]]
    length = float(steps.sum())
    count = step_count(length, 0.5 * height, 6 if closed else 2)
    if len(points) < 2:
        return None
    # the sides of a gap are known only on the fine mesh, and the centreline has hooks at the ends
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


# in layer heights; maximum distance of a point from a bead; the difference to 0.6 covers sampling
# errors
COVERED = 0.594
# in layer heights; depths of gap borders, tried in this order until the bead is long enough
LEVELS = (0.5, 0.42, 0.34)
MIN_CLOSING_LENGTH = 0.5  # in layer heights; minimum length of a gap-closing bead
COARSE, FINE = (
    0.2,
    0.1,
)  # in layer heights; mesh edges in the search for gaps and in their measurement
# in layer heights; maximum bead length in a gap with a border shallower than the normal gap between
# layers
MAX_LENGTH = 2.0
SAMPLED = 0.05  # in layer heights; sample distance along beads
ROUNDS = 4  # maximum number of passes
MIN_PEAK = 0.02  # in layer heights; minimum depth beyond half the layer spacing of an examined gap
MAX_OPEN_DEPTH = (
    0.005  # in layer heights; depth beyond half the layer spacing of gaps that stay open
)
ON_EDGE_MM = 1e-5  # mm; points closer to an edge of the mesh are on this edge
DEPTH_UNCERTAINTY = 0.07  # in layer heights; error of a gap depth sampled at fine mesh vertices
# pattern search for deeper points: directions, steps, and reduction factor of the step length
SEARCH_DIRECTIONS, SEARCH_STEPS, STEP_REDUCTION = 8, 14, 0.7


def close_gaps(
    slicing: Slicing, below: list[SpaceCurve], above: list[SpaceCurve], passed: Index
) -> list[SpaceCurve]:
    """Close gaps between the fronts of two layers with beads along the centrelines of the gaps.

    Parameters
    ----------
    slicing : Slicing
        Wall, rims and layer height.
    below, above : list of SpaceCurve
        The fronts of two consecutive layers; `above` is empty where the wall ends.
    passed : (n,) int array
        Vertices of the wall's mesh between these layers.

    Returns
    -------
    list of SpaceCurve
        The beads, with the deposit below on the right.
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
    """Return a mask of the triangles (m, 3, 3) between fronts that may be in gaps."""
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
    # a gap ends within one layer height of its deep points
    gap = corners[deep.any(axis=1)]
    extent = np.linalg.norm(np.ptp(gap, axis=1), axis=1).max()
    return np.asarray(
        cKDTree(gap.mean(axis=1)).query(corners.mean(axis=1))[0] < height + 2.0 * extent
    )


def _depth(
    points: Array, beads: list[SpaceCurve], height: float, farthest: float = np.inf
) -> Array:
    """Return the distances of points (..., 3) from sampled beads; infinite beyond `farthest` mm."""
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
    """Whether any deep point is between the fronts.

    deep: (m, s) mask of points (m, s, 3) on triangles (m, 3, 3). A point is not between the fronts
    if it is to the left of the nearest front above, where the rest of the wall is, or before the
    nearest front below.
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
    """Orient a bead so that the deposit below is on the right."""
    points, left_vectors = slicing.left_of(bead)
    return (
        bead
        if dot(nearest_feet(below, points).away, left_vectors).sum() >= 0.0
        else bead.reversed()
    )


class _Gaps(NamedTuple):
    """Regions that may have gaps.

    fine: fine mesh of the regions. must_cover: (n,) vertices that must be close to a bead. cut:
    (k,) vertices on the border of the fine mesh but not on a border of the wall. A gap that reaches
    these vertices is not a gap between fronts.
    """

    slicing: Slicing
    fine: Mesh
    must_cover: Mask
    cut: Index

    @property
    def covered(self) -> float:
        """Maximum distance of `must_cover` vertices from a bead, in layer heights."""
        return max(COVERED, 0.5 * self.slicing.widest + MAX_OPEN_DEPTH)

    def _peaks(self, depth: Array, beads: list[SpaceCurve]) -> Array:
        """Return the depths (n,), refined to the deepest points on the exact wall.

        The refined depth of a peak is stored at the nearest vertex. Only depths close to `covered`
        are refined, so that the vertices of the mesh do not decide whether a gap is closed.
        """
        wall, height = self.slicing.wall, self.slicing.height
        low, high = self.fine.edges.T
        deepest = np.zeros(len(depth))  # maximum depth of the neighbours
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
        """Return one bead for each gap that is locally too deep.

        depth: (n,) distances of the vertices from the beads, mm.
        """
        height, fine, covered = self.slicing.height, self.fine, self.covered * self.slicing.height
        peaks = self._peaks(depth, beads)
        new_beads: list[SpaceCurve] = []
        short: list[tuple[SpaceCurve, Mask]] = []
        is_closed = np.zeros(len(depth), dtype=bool)
        # with uneven layers, lower levels would include the complete area between the layers
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
            # level lines have the gaps on the left
            lines = fine.level_lines(level * height - depth, np.arange(len(fine.faces)))
            gap_number, tree = number[inside], cKDTree(fine.vertices[inside])
            # the majority of points decides, because single points can be closer to an adjacent gap
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
        # lower levels did not yield longer beads for these gaps, or included too much area
        for bead, members in short:
            if not is_closed[members].any():
                new_beads.append(bead)
                is_closed |= members
        return new_beads


def _find_rim_vertices(mesh: Mesh, vertices: Index, fine: Mesh) -> Index:
    """Return the vertices of the fine mesh on border edges of the mesh between the given vertices."""
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
    """Return the closed borders (k, 3) of a gap: level lines, continued along the mesh border."""
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
    """Return the gap index (n,) of each vertex; each vertex outside gaps has a separate index."""
    edges = fine.edges[inside[fine.edges].all(axis=1)]
    n = len(fine.vertices)
    links = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(n, n))
    number: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return number


# ---- Layers

MIN_LENGTH = 0.2  # in layer heights; shorter fronts do not become beads
# in layer heights, and mm; fronts shorter than SLIVER must keep their distance within MAX_OFFSET
SLIVER, MAX_OFFSET = 10.0, 5e-4
THIN = 0.3  # in typical edges; closer points of a level line are merged
BEHIND_MM = 1e-3  # mm; vertices closer to a first curve are on this curve
ON_FRONT_MM = (
    1e-4  # mm; closer vertices are on a front, so the last layer can be on the wall's edge
)
NEIGHBOURS = 12  # vertices per point of a first curve that determine on which side the wall is


class Sliced(NamedTuple):
    """Layers of a wall.

    fronts: the fronts of each layer. closing: beads that close gaps between the fronts of a layer
    and the layer below; the last entry can belong to a layer without fronts. rims: edges at which
    fronts end.
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
    """Compute all layers, from the first layer until the wall is covered or its edges are reached.

    Parameters
    ----------
    wall : PatchWall
        The wall.
    height : float
        Layer height, mm.
    smoothing : Smoothing or None, optional
        Smoothing of fronts; None: exact fronts.
    progress : callable, optional
        Receives the covered fraction of the wall and a text; may raise to cancel.

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
    """State of the deposition.

    fronts: fronts of the last layer. behind: (n,) mesh vertices behind these fronts. passed: (k,)
    vertices that the last layer passed. weight: index of WEIGHTS of the smooth fronts.
    """

    fronts: list[SpaceCurve]
    behind: Mask
    passed: Index
    weight: int = HEAVY


def start_state(slicing: Slicing) -> State:
    """Return the state after the first layer.

    All fronts have the rest of the wall on the left, as seen against the normals.
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
    """Compute the next layer: all fronts at the layer height from the fronts of the state.

    The layer can be empty. With smoothing, fronts are as close to the layer height as the smoothing
    allows. The new state shares and updates the array `behind`. Only the mesh near the fronts is
    examined, so that each vertex is examined only a few times in total.
    """
    height, below, mesh = slicing.height, state.fronts, slicing.wall.mesh
    reach = height + mesh.longest_edge
    nearby = points_near_fronts(mesh.tree, below, reach)
    submesh, nearby = mesh.part(mesh.faces_at(nearby[~state.behind[nearby]]))
    if not len(nearby):
        return State([], state.behind, nearby, state.weight)
    behind, distance = state.behind[nearby], nearest_feet(below, submesh.vertices).distance
    value = np.where(behind, -distance, distance) - height
    # proximity in space is not enough: the vertices must be connected along the wall
    low = submesh.connected_members(value < -ON_FRONT_MM, behind)
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
    """Whether a front is long enough and keeps its distance between the nodes.

    Slivers between fronts that meet head on may not keep their distance; a gap-closing bead
    replaces them.
    """
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
    """Return whether points (n, 3) are behind the fronts, also where smoothing moved the fronts.

    low: (n,) whether the points are behind the exact fronts. band: mm.
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
