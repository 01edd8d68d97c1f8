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

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.mesh.triangle_mesh import thin_points
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from ...issues import Text
from ...types import Array, Index, Mask
from ..banded import HEAVY, refuse_too_many
from .closing import close_gaps
from .curve import Slicing, Smoothing, fit_front
from .rims import Rims, cut_at_rims, local_distances, nearest_feet, points_near_fronts
from .smooth import SmoothFront, smooth_front

MIN_LENGTH = 0.2  # of the layer height; shorter fronts are no bead
SLIVER, MAX_OFFSET = (
    10.0,
    5e-4,
)  # layer heights; mm. Fronts shorter than this may be off by no more between their nodes
THIN = 0.3  # of the typical edge; nearer points of a level line are one
BEHIND_MM = 1e-3  # mm; vertices nearer to a first curve are on it
ON_FRONT_MM = (
    1e-4  # mm; vertices nearer to a front are on it, so the last layer may be on the wall's edge
)
NEIGHBOURS = 12  # vertices near a point of a first curve that decide on which side the wall is


class Sliced(NamedTuple):
    """Layers of a wall.

    fronts: of each layer. closing: the beads that close gaps between the fronts of a layer
    and the layer below; after the last layer there may be a layer of only closing beads.
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
