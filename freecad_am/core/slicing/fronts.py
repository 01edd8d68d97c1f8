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

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry.implicit import Implicit
from ..geometry.mesh import Mesh
from ..geometry.space_curve import SpaceCurve
from ..geometry.surface import dot
from ..issues import InputError
from .front_curve import Wall, exact, feet

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

MOST = 20000  # layers
SHORTEST = 0.2  # of the layer height; shorter fronts are no bead
THIN = 0.3  # of the typical edge; nearer points of a level line are one
STEPS = 30


@dataclass(frozen=True)
class State:
    """Where the deposit has come to: the fronts of the last layer and the vertices (n,) behind them."""

    fronts: list[SpaceCurve]
    behind: Mask


def start(mesh: Mesh, wall: Wall, substrate: Implicit, label: str = "wall") -> State:
    """The first layer, where the wall leaves the substrate; all its pieces. InputError NO_INTERSECTION without any."""
    value = substrate.value(mesh.vertices)[0]
    fronts = []
    for line in mesh.level_lines(value, np.arange(len(mesh.faces))):
        points, normal = wall.project(_thinned(line.points, line.closed, THIN * mesh.typical_edge))
        for _ in range(STEPS):
            off, gradient = substrate.value(points)
            slope = gradient - dot(gradient, normal)[:, None] * normal
            points, normal = wall.project(points - (off / np.maximum(dot(slope, slope), 1e-6))[:, None] * slope)
        tangent = np.cross(normal, substrate.value(points)[1])
        tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
        fronts.append(_through(points, tangent, line.closed))
    if not fronts:
        raise InputError("NO_INTERSECTION", label, "the wall does not come out of the substrate: make them intersect")
    return State(fronts, value < 0.0)


def step(mesh: Mesh, wall: Wall, state: State, height: float) -> State:
    """The next layer: all fronts at `height` mm from those of the state, which may be none."""
    reach = height + mesh.longest_edge
    near = _near(mesh, state.fronts, reach)
    faces = mesh.faces_at(near)
    band = np.unique(mesh.faces[faces])
    below = feet(state.fronts, mesh.vertices[band])
    value = np.full(len(mesh.vertices), np.inf)
    value[band] = np.where(state.behind[band], -below.distance, below.distance) - height
    low = mesh.joined(faces, value < 0.0, state.behind)  # near in space is not enough: the wall must lead there
    value = np.where(low, np.minimum(value, -1e-9 * height), np.maximum(value, 1e-9 * height))
    value[~np.isfinite(value)] = reach
    fronts = []
    for line in mesh.level_lines(value, faces[np.isfinite(value[mesh.faces[faces]]).all(axis=1)]):
        points = _thinned(line.points, line.closed, THIN * mesh.typical_edge)
        if len(points) < (4 if line.closed else 2):
            continue
        front = exact(wall, state.fronts, height, points, line.closed, line.rims)
        if front is not None and front.length > SHORTEST * height:
            fronts.append(front)
    return State(fronts, state.behind | low)


def layers(mesh: Mesh, wall: Wall, first: State, height: float, label: str = "wall") -> list[list[SpaceCurve]]:
    """The fronts of all layers, from the first until the wall is covered or its edges are reached."""
    done, state = [first.fronts], first
    while not state.behind.all():
        state = step(mesh, wall, state, height)
        if not state.fronts:
            break
        if len(done) >= MOST:
            raise InputError("LAYER_HEIGHT", label, f"more than {MOST} layers of {height:g} mm: use a larger layer height")
        done.append(state.fronts)
    return done


def local_distances(front: SpaceCurve, below: list[SpaceCurve], finer: int = 1) -> Array:
    """Distance (n,) mm from a front to the nearest point of those below, at its nodes and `finer` - 1 places between."""
    return feet(below, front.at(front.refined(finer))[0]).distance


def _near(mesh: Mesh, fronts: list[SpaceCurve], reach: float) -> NDArray[np.intp]:
    """Vertices within `reach` mm of the fronts, and some more."""
    spots = []
    for front in fronts:
        count = max(4, int(np.ceil(front.length / (0.5 * reach))))
        spots.append(front.at(np.linspace(front.w[0], front.w[-1], 2 * count))[0])
    found = mesh.tree.query_ball_point(np.vstack(spots), 1.3 * reach)
    near: NDArray[np.intp] = np.unique(np.concatenate([np.asarray(one, dtype=np.intp) for one in found]))
    return near


def _thinned(points: Array, closed: bool, least: float) -> Array:
    """A chain without the points nearer to the one before than `least` mm; ends stay."""
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    keep = np.r_[True, np.diff(np.floor(length / least)) > 0]
    if not closed:
        keep[-1] = True
    elif length[-1] > least and np.linalg.norm(points[-1] - points[0]) < least:
        keep[-1] = False
    return points[keep]


def _through(points: Array, tangent: Array, closed: bool) -> SpaceCurve:
    chord = np.diff(np.vstack([points, points[:1]]), axis=0)[: len(points) if closed else -1]
    if dot(tangent[: len(chord)], chord).sum() < 0.0:
        tangent = -tangent
    if closed:
        points, tangent = np.vstack([points, points[:1]]), np.vstack([tangent, tangent[:1]])
    w = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return SpaceCurve(w, points, tangent, tangent, closed)
