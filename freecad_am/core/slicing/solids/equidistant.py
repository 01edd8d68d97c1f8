# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cut a closed mesh by equidistant cones or cylinders (Dai 2020, section 2.1).

The distance from the base surface is a convex function along any straight line. The part of a facet
below a cone is therefore convex: a cone crosses an edge at most twice and a facet border at most
six times, and a cut that leaves a facet at one point of the border enters at the next. This pairs
the points in all cases of the paper without distinguishing the cases. A vertex on the cone always
counts as outside, so that loops always close (step 0 of the paper can leave an odd number of
points). A facet pierced by the axis of the hub can have a closed cut that crosses no edge. Within a
facet the cut is a conic, which is sampled to the chord error.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from typing import NamedTuple

import numpy as np

from ...geometry.columns import columns
from ...geometry.curves.plane_curve import doubled_area, winding
from ...geometry.developable import Developable
from ...geometry.frames import TURN
from ...geometry.mesh.triangle_mesh import chains
from ...geometry.step_count import step_count
from ...issues import InputError
from ...types import Array, Index, Mask, NDArray

Edges = NDArray[np.int32]

NEWTON = 60  # maximum number of Newton steps
HALVINGS = 14  # maximum number of successive halvings of the cut through a facet
MIN_EDGE_MM = 1e-9  # mm; closer points are merged
ROUNDING = 1e-12  # relative to the summed terms; smaller values are rounding errors


@dataclass(frozen=True, eq=False)
class Loop:
    """Closed cut.

    points: (n, 3) in the frame of the hub, mm, without repeated first point; the solid is on the
    left as seen from outside the hub. turns: signed number of turns around the hub; 0 for the
    contour of a blade.
    """

    points: Array
    turns: int


class Facets:
    """Closed mesh prepared for cuts by the equidistant surfaces of a base surface.

    vertices: (n, 3) in the frame of the hub, mm; `distances` has their distances (n,) from the base
    surface, mm. triangles: (m, 3) with outward normals; each edge has two triangles. Raises InputError
    'OPEN_MESH' with the position of an edge that does not have two triangles.
    """

    def __init__(
        self, surface: Developable, vertices: Array, triangles: Index, name: str = "part"
    ) -> None:
        self.surface, self.vertices, self.triangles, self.name = surface, vertices, triangles, name
        self.distances = surface.distance(vertices)
        self.edges = self._edges()
        ends = [self.distances.take(self.edges[:, k]) for k in range(2)]
        self.lower, self.upper = np.minimum(*ends), np.maximum(*ends)
        self.dips, self.least = self._least_on_edges()
        self.pierced, self.piercing = self._pierced()
        self.around = [
            np.flatnonzero((self.edges[:, 2:] // 6 == face).any(axis=1)) for face in self.pierced
        ]

    def _edges(self) -> Edges:
        """Return the two vertices and the two triangle sides of each edge (k, 4).

        A triangle side is encoded as 2 (3 triangle + side), plus 1 if the triangle has the
        direction of the edge. All values are in one array, because a cut accesses edges in random
        order.
        """
        following, count = self.triangles[:, [1, 2, 0]], len(self.vertices)
        low, high = np.minimum(self.triangles, following), np.maximum(self.triangles, following)
        sides = (low.astype(np.int64) * count + high).ravel()
        order = np.argsort(sides, kind="stable")
        sides = sides[order]
        if (
            len(sides) % 2
            or (sides[::2] != sides[1::2]).any()
            or (sides[2::2] == sides[1:-1:2]).any()
        ):
            edge_keys, counts = np.unique(sides, return_counts=True)
            position = self.vertices[list(divmod(int(edge_keys[counts != 2][0]), count))].mean(
                axis=0
            )
            raise InputError(
                "OPEN_MESH",
                self.name,
                "{} edges do not have two faces, for instance at ({:.4g}, {:.4g}, {:.4g}) mm "
                "from the hub base; close the mesh",
                int((counts != 2).sum()),
                position[0],
                position[1],
                position[2],
            )
        edges = np.empty((len(order) // 2, 4), dtype=np.int32)
        edges[:, 0], edges[:, 1] = np.divmod(sides[::2], count)
        edges[:, 2:] = (2 * order + (self.triangles < following).ravel().take(order)).reshape(-1, 2)
        return edges

    def cut(self, distance: float, chord_error: float) -> list[Loop]:
        """Return the loops in which the equidistant surface at `distance` mm cuts the mesh.

        The order of the loops is reproducible.
        """
        inside = self.distances < distance
        once = np.flatnonzero((self.lower < distance) & (self.upper >= distance))
        twice = self.dips[(self.least < distance) & (self.lower[self.dips] >= distance)]
        loops = [
            self._cut_about_axis(face, spot, distance, chord_error)
            for face, spot in self._islands(distance)
        ]
        if not len(once) and not len(twice):
            return loops
        single, double = self.edges.take(once, axis=0), self.edges.take(twice, axis=0)
        nodes = self._crossings(single, double, inside, distance)
        following, face = _link_nodes(single, double, inside, len(nodes))
        for chain, _ in chains(following):
            points = self._refine_loop(nodes, chain, following, face, distance, chord_error)
            if len(points) >= 3:
                loops.append(Loop(points, self._turns(points)))
        return loops

    def offset_loops(self, loops: Sequence[Loop], distance: float) -> list[Loop]:
        """Move loops along the normals of the base surface by `distance` mm."""
        return [
            Loop(loop.points + distance * self.surface.normals(loop.points), loop.turns)
            for loop in loops
        ]

    def _least_on_edges(self) -> tuple[Index, Array]:
        """Return the edges (k,) whose minimum distance is between the ends, and the minima (k,), mm."""
        maybe = self._may_dip()
        p, q = (self.vertices.take(self.edges[maybe, k], axis=0) for k in range(2))
        direction = q - p
        level = (direction[:, :2] ** 2).sum(axis=1)
        cos, sin = np.cos(self.surface.taper), np.sin(self.surface.taper)
        toward = (p[:, :2] * direction[:, :2]).sum(axis=1)
        closest = (p[:, 0] * direction[:, 1] - p[:, 1] * direction[:, 0]) ** 2 / np.maximum(
            level, 1e-300
        )
        # rho = sqrt(closest + level (t - t0)^2), where closest is the squared distance of the line
        # from the axis; at the minimum d/dt (cos rho + sin z) = 0
        slope = -sin * direction[:, 2] / np.maximum(cos * np.sqrt(level), 1e-300)
        turning = (np.abs(slope) < 1.0) & (level > 0.0)
        reach = (
            np.sqrt(closest)
            * np.where(turning, slope, 0.0)
            / np.sqrt(1.0 - np.where(turning, slope, 0.0) ** 2)
        )
        t = (-toward + reach * np.sqrt(level)) / np.maximum(level, 1e-300)
        dipping = np.flatnonzero(turning & (t > 0.0) & (t < 1.0))
        return maybe[dipping], self.surface.distance(
            p[dipping] + t[dipping, None] * direction[dipping]
        )

    def _may_dip(self) -> Index:
        """Return the edges whose distance falls at the start and rises at the end, or nearly."""
        x, y, z = columns(self.vertices)
        rho = np.hypot(x, y)
        start, end = (self.edges[:, k].astype(np.intp) for k in range(2))
        across = x.take(start) * x.take(end) + y.take(start) * y.take(end)
        start_rho, end_rho = rho.take(start), rho.take(end)
        rise = np.tan(self.surface.taper) * (z.take(end) - z.take(start))
        # rho times the slope at either end, divided by cos(taper), with an error bound relative to
        # its terms
        begins = across - start_rho * start_rho + rise * start_rho
        ends = end_rho * end_rho - across + rise * end_rho
        hair = ROUNDING * (start_rho + end_rho + np.abs(rise)) * (start_rho + end_rho)
        return np.flatnonzero((begins < hair) & (ends > -hair))

    def _pierced(self) -> tuple[Index, Array]:
        """Return the faces pierced by the axis, and the piercing points (k, 3), mm."""
        x, y = (column.take(self.triangles.T) for column in columns(self.vertices[:, :2]))
        sides = [x[k] * y[(k + 1) % 3] - y[k] * x[(k + 1) % 3] for k in range(3)]
        pierced = np.flatnonzero(
            (np.minimum.reduce(sides) > 0.0) | (np.maximum.reduce(sides) < 0.0)
        )
        share = np.stack([sides[(k + 1) % 3][pierced] for k in range(3)], axis=1)
        share = share / share.sum(axis=1)[:, None]
        z = (share * self.vertices[self.triangles[pierced]][..., 2]).sum(axis=1)
        return pierced, np.stack([np.zeros(len(z)), np.zeros(len(z)), z], axis=1)

    def _islands(self, distance: float) -> list[tuple[int, Array]]:
        """Return the faces with a closed cut that crosses no edge, with a point inside each cut."""
        if not len(self.pierced):
            return []
        low = self.surface.distance(self.piercing) < distance
        clear = (self.distances[self.triangles[self.pierced]] >= distance).all(axis=1)
        dipping = self.dips[self.least < distance]
        clear &= ~np.array([np.isin(edges, dipping).any() for edges in self.around])
        return [(int(self.pierced[k]), self.piercing[k]) for k in np.flatnonzero(low & clear)]

    def _crossings(self, single: Edges, double: Edges, inside: Mask, distance: float) -> Array:
        """Return the crossings (k, 3) of edges, mm; double crossings are ordered along the edge."""
        start, end = single[:, 0], single[:, 1]
        starts_inside = inside.take(start)
        outer, inner = np.where(starts_inside, end, start), np.where(starts_inside, start, end)
        once = self._first_intersection(
            self.vertices.take(outer, axis=0), self.vertices.take(inner, axis=0), distance
        )
        if not len(double):
            return once
        p, q = self.vertices.take(double[:, 0], axis=0), self.vertices.take(double[:, 1], axis=0)
        pairs = np.stack(
            [self._first_intersection(p, q, distance), self._first_intersection(q, p, distance)],
            axis=1,
        )
        return np.vstack([once, pairs.reshape(-1, 3)])

    def _first_intersection(self, outer: Array, target: Array, distance: float) -> Array:
        """Return the first intersections of lines from outside points with the equidistant surface.

        Newton's method on a convex function does not overshoot.
        """
        direction = target - outer
        t = np.zeros(len(outer))
        start, along = columns(outer), columns(direction)
        for _ in range(NEWTON):
            height, slope = self.surface.distance_rate(start + t * along, along)
            step = (height - distance) / np.minimum(slope, -1e-300)
            new = np.minimum(np.maximum(np.where(slope < 0.0, t - step, t), t), 1.0)
            if (new - t).max(initial=0.0) < 1e-15:
                break
            t = new
        return np.asarray(outer + t[:, None] * direction)

    def _refine_loop(
        self,
        nodes: Array,
        chain: Index,
        following: Index,
        face: Index,
        distance: float,
        chord_error: float,
    ) -> Array:
        """Return the nodes of a loop in order, with points added to keep the chord error."""
        points, normal = nodes[chain], self._normals(face[chain])
        gap = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
        points, normal = points[gap > MIN_EDGE_MM], normal[gap > MIN_EDGE_MM]
        arcs: Index = np.arange(len(points))
        for _ in range(HALVINGS):
            start, end = points[arcs], points[(arcs + 1) % len(points)]
            # the part below the cone is convex, so that the cut is on one side of each chord
            side = _cross_products(normal[arcs], end - start)
            width = np.linalg.norm(side, axis=1)
            side /= np.maximum(width, 1e-300)[:, None]
            middle = 0.5 * (start + end)
            pushed = self._push_out(middle, side, distance)
            is_off = (np.linalg.norm(pushed - middle, axis=1) > chord_error) & (width > MIN_EDGE_MM)
            arcs, pushed = arcs[is_off], pushed[is_off]
            if not len(arcs):
                break
            points = np.insert(points, arcs + 1, pushed, axis=0)
            normal = np.insert(normal, arcs + 1, normal[arcs], axis=0)
            arcs = arcs + np.arange(len(arcs))
            arcs = np.sort(np.r_[arcs, arcs + 1])
        return points

    def _push_out(self, points: Array, direction: Array, distance: float) -> Array:
        """Move inside points outwards along unit vectors (k, 3) to the equidistant surface."""
        t = np.zeros(len(points))
        start, along = columns(points), columns(direction)
        for _ in range(NEWTON):
            height, slope = self.surface.distance_rate(start + t * along, along)
            step = (distance - height) / np.maximum(slope, 1e-6)
            t += step
            if np.abs(step).max(initial=0.0) < 1e-14 * max(1.0, abs(distance)):
                break
        return np.asarray(points + t[:, None] * direction)

    def _cut_about_axis(self, face: int, spot: Array, distance: float, chord_error: float) -> Loop:
        """Return the closed cut around the axis in a facet that the axis pierces.

        The solid is on the inner side of the facet.
        """
        normal = self._normals(np.array([face]))[0]
        radius = self.surface.radius + distance
        count = int(
            np.clip(np.ceil(np.pi / np.arccos(max(1.0 - chord_error / radius, -1.0))), 12, 8192)
        )
        angle = TURN * np.arange(count) / count
        directions = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
        directions[:, 2] = -(directions[:, :2] @ normal[:2]) / normal[2]
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        # start slightly off the axis, where the gradient of the distance is discontinuous
        points = self._push_out(spot + 1e-9 * radius * directions, directions, distance)
        return Loop(points if normal[2] < 0.0 else points[::-1], -1 if normal[2] > 0.0 else 1)

    def _normals(self, faces: Index) -> Array:
        a, b, c = (
            self.vertices.take(corner, axis=0) for corner in self.triangles.take(faces, axis=0).T
        )
        normal = _cross_products(b - a, c - a)
        unit: Array = normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
        return unit

    def _turns(self, points: Array) -> int:
        step = np.diff(self.surface.azimuth(points), append=self.surface.azimuth(points[:1]))
        return int(np.round((np.remainder(step + np.pi, TURN) - np.pi).sum() / TURN))


def _link_nodes(single: Edges, double: Edges, inside: Mask, count: int) -> tuple[Index, Index]:
    """Return the successor (count,) of each node and the face in between; the solid is on the left.

    single, double: edges crossed once and twice; nodes are numbered in this order.
    """
    once = np.repeat(np.arange(len(single)), 2)
    position = single[:, 2:].ravel()
    forward = (position & 1).astype(bool)
    # on an edge crossed once, the start determines whether the edge enters or leaves the cut; an
    # edge crossed twice enters first, then leaves
    out = np.repeat(inside.take(single[:, 0]), 2) == forward
    position = position & ~1
    if len(double):
        low = np.repeat(len(single) + 2 * np.arange(len(double)), 2)
        again = double[:, 2:].ravel()
        back = (again & 1) == 0
        once = np.r_[once, low + back, low + ~back]
        position = np.r_[position, again & ~1, again | 1]
        out = np.r_[out, np.zeros(len(again), dtype=bool), np.ones(len(again), dtype=bool)]
    order = np.argsort(position)
    node, out, face = once[order], out[order], position[order] // 6
    # next crossing of the face; the last crossing is followed by the first
    is_last = np.r_[face[1:] != face[:-1], True]
    next_node = np.r_[node[1:], -1]
    next_node[is_last] = node[np.r_[True, is_last[:-1]]]
    out &= next_node != node
    following, between = np.full(count, -1, dtype=np.intp), np.full(count, -1, dtype=np.intp)
    following[next_node[out]] = node[out]
    between[next_node[out]] = face[out]
    return following, between


def _cross_products(u_rows: Array, v_rows: Array) -> Array:
    """Return cross products of rows (k, 3), three times as fast as numpy for a few thousand rows."""
    (a, b, c), (u, v, w) = columns(u_rows), columns(v_rows)
    return np.stack([b * w - c * v, c * u - a * w, a * v - b * u], axis=1)


STEP = math.radians(11.0)  # step between candidate azimuths of the seam
TRIES = 360  # number of candidate azimuths
CLEARANCE_RATIO = 2.0  # in chord errors; clearance of a cut from coincident facets
TOUCH = 0.004  # in chord errors of cuts; a face closer to a surface touches this surface
REACH = 0.05  # mm; maximum gap between a solid and a surface that it stands on


class Flat(NamedTuple):
    """Unrolled layers.

    borders: borders (n, 2) of each layer, mm, with the solid on the left. middle: azimuth of x = 0,
    rad.
    """

    borders: list[list[Array]]
    middle: float


def count(facets: Facets, height: float, margin: float, chord_error: float) -> int:
    """Return the number of layers of a solid.

    Layers are at 0, h, 2 h ... mm from the base.

    Parameters
    ----------
    facets : Facets
        The solid.
    height : float
        Layer height, mm.
    margin : float
        Machining margin above the solid, mm.
    chord_error : float
        Chord error, mm; a remainder of this order gets no layer.

    Returns
    -------
    int
        Number of layers.
    """
    top = float(facets.distances.max()) + margin
    return step_count(top - CLEARANCE_RATIO * chord_error, height, 0)


def cut(facets: Facets, distance: float, chord_error: float) -> list[Loop]:
    """Cut a solid near an equidistant surface and move the loops onto this surface.

    The cut is slightly outside the surface if facets coincide with the surface, such as the foot of
    a blade with the hub, or if the solid begins slightly outside. Otherwise noise would decide the
    cut. In all other cases the cut is TOUCH inside, so that a face that only touches the surface,
    such as a flat top along a generatrix, is not cut.

    Parameters
    ----------
    facets : Facets
        The solid.
    distance : float
        Distance of the surface from the base, mm.
    chord_error : float
        Chord error of the loops, mm.

    Returns
    -------
    list of Loop
        The loops in the frame of the base.
    """
    corners = facets.distances[facets.triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    lying = (low > distance - chord_error) & (high < distance + chord_error)
    lowest = float(facets.distances.min())
    gap = lowest - distance if distance < lowest < distance + REACH else 0.0
    aside = gap + CLEARANCE_RATIO * chord_error if gap or lying.any() else -TOUCH * chord_error
    loops_aside = facets.cut(distance + aside, chord_error)
    return facets.offset_loops(loops_aside, -aside)


def unroll_layers(
    surface: Developable, layers: Sequence[Sequence[Loop]], centre: float, where: str
) -> Flat:
    """Unroll the loops of layers together, after they were moved onto one surface.

    No loop goes around the surface.

    Parameters
    ----------
    surface : Developable
        The surface.
    layers : sequence of sequence of Loop
        Loops of each layer.
    centre : float
        Azimuth opposite to the preferred seam, rad.
    where : str
        Name for messages.

    Returns
    -------
    Flat
        The unrolled borders.

    Raises
    ------
    InputError
        TOO_FAR_ROUND if a contour winds so far around a cone that its unrolled image overlaps
        itself.
    """
    loops = [loop for layer in layers for loop in layer]
    azimuths = [_unwrap_azimuths(loop.points, surface) for loop in loops]
    spans = np.array([[azimuth.min(), azimuth.max()] for azimuth in azimuths]).reshape(-1, 2)
    for k in range(TRIES):
        middle = centre + k * STEP
        cutting = middle + 0.5 * TURN
        if (
            np.floor((spans[:, 0] - cutting) / TURN) == np.floor((spans[:, 1] - cutting) / TURN)
        ).all():
            return Flat(
                [[surface.unroll(loop.points, middle) for loop in layer] for layer in layers],
                middle,
            )
    flat = iter(_in_one_piece(surface, loops, azimuths, centre, where))
    return Flat([list(islice(flat, len(layer))) for layer in layers], centre)


def _unwrap_azimuths(points: Array, surface: Developable) -> Array:
    """Return azimuths (n,) along a loop, unwrapped."""
    azimuths: Array = np.unwrap(surface.azimuth(points))
    return azimuths


def _in_one_piece(
    surface: Developable,
    loops: Sequence[Loop],
    azimuths: Sequence[Array],
    centre: float,
    where: str,
) -> tuple[Array, ...]:
    """Unroll loops with azimuths beyond one turn; holes move by full turns into their contours."""
    shifted = [
        azimuth - centre - TURN * np.round((azimuth.mean() - centre) / TURN) for azimuth in azimuths
    ]
    widest = max(float(np.ptp(azimuth)) for azimuth in shifted)
    if not surface.is_cylinder and widest * math.sin(surface.taper) > 0.98 * TURN:
        raise InputError(
            "TOO_FAR_ROUND",
            where,
            "the solid winds {:.3g} times around the cone and would overlap when unrolled; "
            "divide the solid into shorter solids",
            widest / TURN,
        )
    flat = [
        surface.unroll_at(azimuth, loop.points[:, 2])
        for azimuth, loop in zip(shifted, loops, strict=True)
    ]
    outer = [points for points in flat if doubled_area(points) > 0.0]
    turns = math.ceil(widest / TURN) + 1
    for k, points in enumerate(flat):
        if doubled_area(points) > 0.0:
            continue
        for turn in sorted(range(-turns, turns + 1), key=abs):
            shifted_points = surface.unroll_at(shifted[k] + TURN * turn, loops[k].points[:, 2])
            if winding(outer, shifted_points[:1])[0] > 0:
                flat[k] = shifted_points
                break
    return tuple(flat)
