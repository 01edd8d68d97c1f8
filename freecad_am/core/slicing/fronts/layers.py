# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of constant local distance on any wall: fronts run over a mesh and made exact on the wall.

From the fronts of a layer the distance in space is measured to the mesh's vertices near them, with a sign: vertices
that are behind are below. The level line at the layer height is traced through the triangles, which lets fronts
split, merge, close and end at the wall's edges by themselves; each piece is then brought onto the exact wall and to the
exact distance from the curve below, and its corners are found (see front_curve). The mesh decides which pieces
there are, not where they lie: its edges should be no longer than the layer height and a quarter of the smallest radius
of curvature. What is thinner than an edge is seen or not: slivers left between fronts that meet, gaps at a rim.
A geodesic distance field over the whole wall would be simpler, but it measures distances along the wall, and adds the
layers' errors up; here each layer starts from the one before, as the deposit does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.mesh.triangle_mesh import Mesh, thinned
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from ...issues import Text
from ...types import Array, Index, Mask
from ..backstop import refuse_too_many
from ..banded import HEAVY
from .closing import closing
from .curve import exact, feet
from .rims import Rims, cut_at_rims
from .smooth import SmoothFront, Smoothing, smoothed

SHORTEST = 0.2  # of the layer height; shorter fronts are no bead
SLIVER, OFF = 10.0, 5e-4  # layer heights; mm. Fronts shorter than this may be off by no more between their nodes
THIN = 0.3  # of the typical edge; nearer points of a level line are one
BEHIND = 1e-3  # mm; vertices nearer to a first curve lie on it
ON_FRONT_MM = 1e-4  # mm; vertices nearer to a front lie on it, so that the last layer may lie on the wall's edge
NEIGHBOURS = 12  # vertices near a place of a first curve that tell on which side the wall is


@dataclass(frozen=True, eq=False)
class State:
    """Where the deposit has come to: the fronts of the last layer, the vertices (n,) behind them, those (k,) that the last
    layer passed, and which of banded.WEIGHTS smooth fronts were made with."""

    fronts: list[SpaceCurve]
    behind: Mask
    passed: Index
    weight: int = HEAVY


def start(wall: PatchWall) -> State:
    """The first layer. All fronts have the wall still to come on their left, seen from where the normals point to."""
    mesh = wall.mesh
    fronts = [_facing(wall, one.curve()) for one in wall.first]
    band = _around(mesh, _spots(fronts, mesh.longest_edge), mesh.longest_edge)
    behind = wall.behind.copy()
    behind[band] |= feet(fronts, mesh.vertices[band]).distance < BEHIND
    return State(fronts, behind, np.flatnonzero(behind))


def step(wall: PatchWall, rims: Rims, state: State, height: float, smoothing: Smoothing | None = None) -> State:
    """The next layer: all fronts at `height` mm from those of the state, which may be none; smooth ones as near to that as
    their smoothing allows. The state's `behind` is carried on: the new state has the same array, with more behind.

    Only the part of the mesh near the fronts is looked at, so that all layers together look at each vertex a few times.
    """
    spots = _spots(state.fronts, reach := height + wall.mesh.longest_edge)
    near = _around(wall.mesh, spots, reach)
    mesh, band = wall.mesh.part(wall.mesh.faces_at(near[~state.behind[near]]))
    if not len(band):
        return State([], state.behind, band, state.weight)
    behind = state.behind[band]
    below = feet(state.fronts, mesh.vertices)
    value = np.where(behind, -below.distance, below.distance) - height
    low = mesh.joined(value < -ON_FRONT_MM, behind)  # near in space is not enough: the wall must lead there
    value = np.where(low, np.minimum(value, -1e-9 * height), np.maximum(value, 1e-9 * height))
    ends = rims.reached(state.fronts, height, spots, reach, ON_FRONT_MM)
    fronts = []
    for line in cut_at_rims(mesh.level_lines(value, np.arange(len(mesh.faces))), ends, wall.mesh.longest_edge):
        points = thinned(line.points, line.closed, THIN * wall.mesh.typical_edge)
        if len(points) < (4 if line.closed else 2):
            continue
        pieces = exact(wall, state.fronts, height, points, line.closed, line.rims, line.ends)
        fronts += [front for front in pieces if front.length > SHORTEST * height and _true(front, state.fronts, height)]
    weight = state.weight
    if smoothing is not None:
        found = [smoothed(wall, rims, state.fronts, front, fronts[:k] + fronts[k + 1 :], height, smoothing, weight)
                 for k, front in enumerate(fronts)]
        doubtful = np.flatnonzero(~behind & (np.abs(below.distance - height) < 1.1 * smoothing.band * height))
        low[doubtful] = _passed(wall, fronts, found, mesh.vertices[doubtful], low[doubtful], smoothing.band * height)
        fronts, weight = [one.curve for one in found], max((one.weight for one in found), default=weight)
    passed = band[low & ~behind]
    state.behind[passed] = True
    return State(fronts, state.behind, passed, weight)


def _true(front: SpaceCurve, below: list[SpaceCurve], height: float) -> bool:
    """Whether a front keeps its distance between the nodes too: slivers between fronts that meet head on may not; a bead
    that closes the gap takes their place."""
    return front.length > SLIVER * height or bool(np.abs(local_distances(front, below, 10) - height).max() < OFF)


def _passed(
    wall: PatchWall, exact_ones: list[SpaceCurve], found: list[SmoothFront], points: Array, low: Mask, far: float
) -> Mask:
    """Whether points (n, 3) lie behind the fronts found, where these are not the exact ones; low: of the latter."""
    fronts = [one.curve for one in found]
    if not fronts or not len(points):
        return low
    place = feet(fronts, points)
    moved = np.array([one.curve is not before for one, before in zip(found, exact_ones)])
    slope = np.empty_like(points)
    for k, front in enumerate(fronts):
        mine = place.front == k
        slope[mine] = front.at(place.w[mine])[1]
    left = np.cross(wall.project(points)[1], slope)
    side = dot(points - place.point, left / np.linalg.norm(left, axis=1, keepdims=True))
    near = moved[place.front] & (place.distance < 2.0 * far)
    return np.where(near, side < -ON_FRONT_MM, low)


class Sliced(NamedTuple):
    """fronts: of each layer. closing: the beads that close gaps between the fronts of a layer and those of the layer below;
    behind the last layer there may be closing beads alone."""

    fronts: list[list[SpaceCurve]]
    closing: list[list[SpaceCurve]]


def layers(
    wall: PatchWall, height: float, smoothing: Smoothing | None = None,
    progress: Callable[[float, str], None] = lambda fraction, text: None,
) -> Sliced:
    """All layers, from the first until the wall is covered or its edges are reached. progress(fraction, text) is told the
    share of the wall that is covered."""
    state, rims = start(wall), Rims.of(wall.rims)
    ends = np.vstack([np.empty((0, 3)), *(rim.points for rim in wall.rims if rim.end)])
    widest = 1.0 if smoothing is None else 1.0 + smoothing.band
    done, closed = [state.fronts], [list[SpaceCurve]()]
    left = len(state.behind) - len(state.passed)
    while left:
        progress(1.0 - left / len(state.behind), Text("finding layer {}", len(done)))
        below = state
        state = step(wall, rims, below, height, smoothing)
        left -= len(state.passed)
        gaps = [_on_left(wall, gap, below.fronts)
                for gap in closing(wall, below.fronts, state.fronts, state.passed, height, ends, widest)]
        if state.fronts or gaps:
            closed.append(gaps)
        if not state.fronts:
            break
        refuse_too_many(len(done), height, wall.label)
        done.append(state.fronts)
    return Sliced(done, closed)


def _on_left(wall: PatchWall, curve: SpaceCurve, below: list[SpaceCurve]) -> SpaceCurve:
    """The curve run so that what was deposited below is on its right."""
    place, slope, _ = curve.at(curve.w[:-1] + 0.5 * curve.span)
    left = np.cross(wall.project(place)[1], slope)
    return curve if dot(feet(below, place).away, left).sum() >= 0.0 else curve.reversed()


def local_distances(front: SpaceCurve, below: list[SpaceCurve], finer: int = 1) -> Array:
    """Distance (n,) mm from a front to the nearest point of those below, at its nodes and `finer` - 1 places between."""
    return feet(below, front.at(front.refined(finer))[0]).distance


def _spots(fronts: list[SpaceCurve], reach: float) -> Array:
    """Points (k, 3) along the fronts, closer together than `reach` mm."""
    spots = []
    for front in fronts:
        count = max(4, int(np.ceil(front.length / (0.5 * reach))))
        spots.append(front.at(np.linspace(front.w[0], front.w[-1], 2 * count))[0])
    return np.vstack(spots)


def _around(mesh: Mesh, spots: Array, reach: float) -> Index:
    """Vertices within `reach` mm of the curves the spots are from, and some more."""
    found: Any = mesh.tree.query_ball_point(spots, 1.3 * reach)
    near: Index = np.unique(np.fromiter(chain.from_iterable(found), dtype=np.intp))
    return near


def _facing(wall: PatchWall, curve: SpaceCurve) -> SpaceCurve:
    """The curve run so that the vertices still to come are on its left."""
    place, slope, _ = curve.at(curve.w[:-1] + 0.5 * curve.span)
    left = np.cross(wall.project(place)[1], slope)
    mesh = wall.mesh
    adjacent = np.asarray(mesh.tree.query(place, k=min(NEIGHBOURS, len(mesh.vertices)))[1])
    ahead = np.where(wall.behind[adjacent], 0.0, dot(mesh.vertices[adjacent] - place[:, None], left[:, None]))
    return curve if ahead.sum() >= 0.0 else curve.reversed()
