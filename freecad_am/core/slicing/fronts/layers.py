# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of constant local distance on any wall: fronts run over a mesh and made exact on the wall.

From the fronts of a layer the distance in space is measured to the mesh's vertices near them, with a sign: vertices
that are behind are below. The level line at the layer height is traced through the triangles, which lets fronts
split, merge, close and end at the wall's edges by themselves; each piece is then brought onto the exact wall and to the
exact distance from the curve below, and its corners are found (see `curve`). The mesh decides which pieces
there are, not where they lie: its edges should be no longer than the layer height and a quarter of the smallest radius
of curvature. What is thinner than an edge is seen or not: slivers left between fronts that meet, gaps at a rim.
A geodesic distance field over the whole wall would be simpler, but it measures distances along the wall, and adds the
layers' errors up; here each layer starts from the one before, as the deposit does.
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
from ..backstop import refuse_too_many
from ..banded import HEAVY
from .closing import closing
from .curve import exact
from .feet import feet, local_distances, within
from .rims import Rims, cut_at_rims
from .slicing import Slicing, Smoothing
from .smooth import SmoothFront, smoothed

SHORTEST = 0.2  # of the layer height; shorter fronts are no bead
SLIVER, OFF = (
    10.0,
    5e-4,
)  # layer heights; mm. Fronts shorter than this may be off by no more between their nodes
THIN = 0.3  # of the typical edge; nearer points of a level line are one
BEHIND = 1e-3  # mm; vertices nearer to a first curve lie on it
ON_FRONT_MM = 1e-4  # mm; vertices nearer to a front lie on it, so that the last layer may lie on the wall's edge
NEIGHBOURS = 12  # vertices near a place of a first curve that tell on which side the wall is


class Sliced(NamedTuple):
    """fronts: of each layer. closing: the beads that close gaps between the fronts of a layer and those of the layer below;
    behind the last layer there may be closing beads alone. rims: the edges at which fronts end."""

    fronts: list[list[SpaceCurve]]
    closing: list[list[SpaceCurve]]
    rims: Rims


def layers(
    wall: PatchWall,
    height: float,
    smoothing: Smoothing | None = None,
    progress: Callable[[float, str], None] = lambda fraction, text: None,
) -> Sliced:
    """All layers, from the first until the wall is covered or its edges are reached. progress(fraction, text) is told the
    share of the wall that is covered."""
    slicing = Slicing(wall, Rims.of(wall.rims), height, smoothing)
    state = start(slicing)
    fronts, beads = [state.fronts], [list[SpaceCurve]()]
    remaining = len(state.behind) - len(state.passed)
    while remaining:
        progress(1.0 - remaining / len(state.behind), Text("finding layer {}", len(fronts)))
        state = step(slicing, state)
        remaining -= len(state.passed)
        found = closing(slicing, fronts[-1], state.fronts, state.passed)
        if state.fronts or found:
            beads.append(found)
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


def start(slicing: Slicing) -> State:
    """The first layer. All fronts have the wall still to come on their left, seen from where the normals point to."""
    wall, mesh, fronts = slicing.wall, slicing.wall.mesh, []
    for first in wall.first:
        curve = first.curve()
        points, left = slicing.left_of(curve)
        near = np.asarray(mesh.tree.query(points, k=min(NEIGHBOURS, len(mesh.vertices)))[1])
        ahead = np.where(
            wall.behind[near], 0.0, dot(mesh.vertices[near] - points[:, None], left[:, None])
        )
        fronts.append(curve if ahead.sum() >= 0.0 else curve.reversed())
    behind, near = wall.behind.copy(), within(mesh.tree, fronts, mesh.longest_edge)
    behind[near] |= feet(fronts, mesh.vertices[near]).distance < BEHIND
    return State(fronts, behind, np.flatnonzero(behind))


def step(slicing: Slicing, state: State) -> State:
    """The next layer: all fronts at the layer height from those of the state, which may be none; smooth ones as near to that
    as their smoothing allows. The state's `behind` is carried on: the new state has the same array, with more behind.

    Only the part of the mesh near the fronts is looked at, so that all layers together look at each vertex a few times.
    """
    height, below, mesh = slicing.height, state.fronts, slicing.wall.mesh
    reach = height + mesh.longest_edge
    near = within(mesh.tree, below, reach)
    part, near = mesh.part(mesh.faces_at(near[~state.behind[near]]))
    if not len(near):
        return State([], state.behind, near, state.weight)
    behind, distance = state.behind[near], feet(below, part.vertices).distance
    value = np.where(behind, -distance, distance) - height
    low = part.connected_members(
        value < -ON_FRONT_MM, behind
    )  # near in space is not enough: the wall must lead there
    value = np.where(low, np.minimum(value, -1e-9 * height), np.maximum(value, 1e-9 * height))
    ends = slicing.rims.reached(below, height, reach, ON_FRONT_MM)
    fronts: list[SpaceCurve] = []
    for line in cut_at_rims(
        part.level_lines(value, np.arange(len(part.faces))), ends, mesh.longest_edge
    ):
        points = thin_points(line.points, line.closed, THIN * mesh.typical_edge)
        if len(points) >= (4 if line.closed else 2):
            found = exact(slicing, below, line._replace(points=points))
            fronts += [front for front in found if _is_bead(front, below, height)]
    weight = state.weight
    if slicing.smoothing is not None:
        band = slicing.smoothing.band * height
        smooth = [
            smoothed(slicing, below, front, fronts[:k] + fronts[k + 1 :], weight)
            for k, front in enumerate(fronts)
        ]
        doubtful = np.flatnonzero(~behind & (np.abs(distance - height) < 1.1 * band))
        low[doubtful] = _passed(
            slicing.wall, fronts, smooth, part.vertices[doubtful], low[doubtful], band
        )
        fronts, weight = (
            [one.curve for one in smooth],
            max((one.weight for one in smooth), default=weight),
        )
    passed = near[low & ~behind]
    state.behind[passed] = True
    return State(fronts, state.behind, passed, weight)


def _is_bead(front: SpaceCurve, below: list[SpaceCurve], height: float) -> bool:
    """Whether a front is long enough, and keeps its distance between the nodes too: slivers between fronts that meet head on
    may not; a bead that closes the gap takes their place."""
    if front.length <= SHORTEST * height:
        return False
    return front.length > SLIVER * height or bool(
        np.abs(local_distances(front, below, 10) - height).max() < OFF
    )


def _passed(
    wall: PatchWall,
    unsmoothed: list[SpaceCurve],
    smooth: list[SmoothFront],
    points: Array,
    low: Mask,
    band: float,
) -> Mask:
    """Whether points (n, 3) lie behind smooth fronts, where these are not the exact ones; low: of the latter. band: mm."""
    fronts = [one.curve for one in smooth]
    if not fronts or not len(points):
        return low
    foot = feet(fronts, points)
    moved = np.array([front is not before for front, before in zip(fronts, unsmoothed)])
    slope = np.empty_like(points)
    for k, front in enumerate(fronts):
        own = foot.front == k
        slope[own] = front.at(foot.w[own])[1]
    left = np.cross(wall.project(points)[1], slope)
    side = dot(points - foot.point, left / np.linalg.norm(left, axis=1, keepdims=True))
    near = moved[foot.front] & (foot.distance < 2.0 * band)
    return np.where(near, side < -ON_FRONT_MM, low)
