# SPDX-License-Identifier: LGPL-2.1-or-later
"""Intersection curves of a wall and its ground, where the wall starts, with exact corners.

Level lines of the distance are moved onto both surfaces.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.interpolate import CubicSpline

from ...types import Array, Index, Mask
from ..frames import unit
from ..mesh.refine import boundary
from ..mesh.solid import SHARP_EDGE_RAD, SolidMesh
from ..mesh.triangle_mesh import LevelLine, thin_points
from .patch import Patch
from .patch_wall import FirstCurve, PatchWall, Rim
from .surface import dot


class Ground(Protocol):
    """A solid that carries a wall."""

    facets: bool  # whether the pieces are flat facets that may approximate a round surface

    def signed(self, points: Array) -> Array:
        """Return the signed distances of points from the solid.

        Parameters
        ----------
        points : (k, 3) array
            Points, mm.

        Returns
        -------
        (k,) array
            Distances, mm, negative inside.
        """

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """Return the nearest points of the boundary.

        Parameters
        ----------
        points : (k, 3) array
            Points, mm.

        Returns
        -------
        feet : (k, 3) array
            Nearest points, mm.
        normals : (k, 3) array
            Outer unit normals.
        piece : (k,) int array
            Index of the smooth piece of each point.
        """

    def on(self, piece_numbers: Index, points: Array) -> tuple[Array, Array]:
        """Return the nearest points on given pieces, extended beyond their edges.

        Parameters
        ----------
        piece_numbers : (k,) int array
            Indices of the pieces.
        points : (k, 3) array
            Points, mm.

        Returns
        -------
        feet : (k, 3) array
            Nearest points, mm.
        normals : (k, 3) array
            Outer unit normals.
        """

    def sagitta(self, piece_numbers: Index) -> Array:
        """Return the maximum deviation of pieces from the surface that they approximate.

        Parameters
        ----------
        piece_numbers : (k,) int array
            Indices of the pieces.

        Returns
        -------
        (k,) array
            Deviations, mm.
        """


class ExactGround:
    """A solid with exact faces.

    solid: triangles within `chord` mm. face: (m,) face index of each triangle. patches: the faces,
    with outward normals. edge: approximate spacing of query points, mm.
    """

    facets = False

    def __init__(
        self, solid: SolidMesh, face: Index, patches: tuple[Patch, ...], chord: float, edge: float
    ) -> None:
        self.face, self.patches, self.near = face, patches, 3.0 * chord
        self.search = solid.searched(edge)

    def signed(self, points: Array) -> Array:
        """Return signed distances, exact near the boundary."""
        distance, _, triangle = self.search.signed(points)
        near_points = np.flatnonzero(np.abs(distance) < self.near)
        if len(near_points):
            foot, normal = self.on(self.face[triangle[near_points]], points[near_points])
            exact = dot(points[near_points] - foot, normal)
            plain = (
                np.abs(exact - distance[near_points]) < self.near
            )  # not beyond an edge of the solid
            distance[near_points[plain]] = exact[plain]
        return distance

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """Return the nearest points on the exact faces."""
        piece_numbers = self.face[self.search.signed(points)[2]]
        return *self.on(piece_numbers, points), piece_numbers

    def on(self, piece_numbers: Index, points: Array) -> tuple[Array, Array]:
        """Return the nearest points on the surfaces of given faces."""
        feet, normals = np.empty_like(points), np.empty_like(points)
        for k in np.unique(piece_numbers):
            patch, on_patch = self.patches[k], piece_numbers == k
            feet[on_patch], normals[on_patch] = patch.at(patch.inverse(points[on_patch]))
        return feet, normals

    def sagitta(self, piece_numbers: Index) -> Array:
        """Return zeros: the ground is exact."""
        return np.zeros(len(piece_numbers))


class FacetGround:
    """A solid of triangles."""

    facets = True

    def __init__(self, solid: SolidMesh, edge: float) -> None:
        self.solid, self.search = solid, solid.searched(edge)

    def signed(self, points: Array) -> Array:
        """Return signed distances from the triangles."""
        return self.search.signed(points)[0]

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """Return projections onto the planes of the nearest triangles."""
        piece_numbers = self.search.signed(points)[2]
        return *self.on(piece_numbers, points), piece_numbers

    def on(self, piece_numbers: Index, points: Array) -> tuple[Array, Array]:
        """Return projections onto the planes of given triangles."""
        normal = self.solid.units[piece_numbers]
        corner = self.solid.vertices[self.solid.triangles[piece_numbers, 0]]
        return points - dot(points - corner, normal)[:, None] * normal, normal

    def sagitta(self, piece_numbers: Index) -> Array:
        """Return the sagitta of triangles, from the angles between them."""
        return self.solid.sagitta[piece_numbers]


class PlaneGround:
    """The half space below z = `height` mm: a platform."""

    facets = False

    def __init__(self, height: float) -> None:
        self.height = height

    def signed(self, points: Array) -> Array:
        """Return heights above the plane."""
        above: Array = points[:, 2] - self.height
        return above

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """Return vertical projections onto the plane."""
        piece_numbers = np.zeros(len(points), dtype=np.intp)
        return *self.on(piece_numbers, points), piece_numbers

    def on(self, piece_numbers: Index, points: Array) -> tuple[Array, Array]:
        """Return vertical projections onto the plane."""
        foot = points.copy()
        foot[:, 2] = self.height
        return foot, np.broadcast_to(np.array([0.0, 0.0, 1.0]), points.shape)

    def sagitta(self, piece_numbers: Index) -> Array:
        """Return zeros: the ground is exact."""
        return np.zeros(len(piece_numbers))


def distances(points: Array, ground: Ground, near_distance: float) -> Array:
    """Return the distances of points from the ground.

    The distance changes by no more than the distance between points. A single point is therefore
    enough for a cube that is farther away than its size.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.
    ground : Ground
        The ground.
    near_distance : float
        Distance up to which values are exact, mm.

    Returns
    -------
    (n,) array
        Distances, mm, negative inside. Values of farther points have the correct sign and at
        most the true magnitude.
    """
    value, open_ = np.empty(len(points)), np.arange(len(points))
    size = float(np.ptp(points, axis=0).max(initial=0.0)) / 4.0
    while len(open_) and size > near_distance:
        cube = np.floor((points[open_] - points.min(axis=0)) / size).astype(np.intp)
        _, representative, cube_of_point = np.unique(
            cube @ np.array([1, 1 << 20, 1 << 40]), return_index=True, return_inverse=True
        )
        probes = open_[representative]
        probe_values, cube_of_point = ground.signed(points[probes]), np.ravel(cube_of_point)
        offset = np.linalg.norm(points[open_] - points[probes][cube_of_point], axis=1)
        bound = np.abs(probe_values[cube_of_point]) - offset
        certain = bound > near_distance
        value[open_[certain]] = (np.sign(probe_values[cube_of_point]) * bound)[certain]
        open_, size = open_[~certain], 0.5 * size
    value[open_] = ground.signed(points[open_])
    return value


def nearest_point(points: Array, ground: Ground, value: Array) -> tuple[int, float]:
    """Return the point nearest to the boundary of the ground.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.
    ground : Ground
        The ground.
    value : (n,) array
        `distances` of the points.

    Returns
    -------
    point : int
        Index of the point.
    distance : float
        Distance of the point, mm.
    """
    order = np.argsort(np.abs(value), kind="stable")
    best, min_distance = int(order[0]), np.inf
    for block in np.array_split(order, max(1, len(order) // 256)):
        if abs(float(value[block[0]])) > min_distance:
            break
        exact = np.abs(ground.signed(points[block]))
        if exact.min() < min_distance:
            best, min_distance = int(block[np.argmin(exact)]), float(exact.min())
    return best, min_distance


TOUCH_MM = 0.05  # mm; a wall that ends within this distance of its substrate starts on it
STEPS = 40
CORNER = np.radians(0.1)  # rad; smaller angles between ground pieces are smooth joints
MIN_STEP_SHARE = 0.3  # of the wall's typical edge; minimum distance of points in a chain
ROUNDS, SAGITTAS = (
    8,
    1.2,
)  # rounds of added points; maximum offset of a smooth curve from a facet, in sagittas
TOLERANCE_MM, ON_GROUND = (
    1e-5,
    1e-6,
)  # mm; maximum distance from both surfaces between the points of a chain, and at the points
# fractions of each arc to check; a midpoint may match by chance where the curvature jumps
THIRDS = np.array([1.0 / 3.0, 2.0 / 3.0])


def ground_distances(wall: PatchWall, ground: Ground) -> Array:
    """Return the distances of the wall's vertices from the ground.

    A boundary that ends just short of the ground counts as inside. Large distances may be
    underestimated, see `distances`.

    Parameters
    ----------
    wall : PatchWall
        Wall with n vertices.
    ground : Ground
        The ground.

    Returns
    -------
    (n,) array
        Distances, mm, negative inside, never 0.
    """
    value = distances(wall.vertices, ground, 2.0 * wall.mesh.longest_edge)
    edge = np.zeros(len(value), dtype=bool)
    edge[boundary(wall.triangles)[0]] = True
    value[edge & (value < TOUCH_MM) & (value > -1e-4)] = -1e-4
    value[np.abs(value) < 1e-7] = -1e-7
    return value


def first_curves(
    wall: PatchWall, ground: Ground, value: Array, rims: tuple[Rim, ...]
) -> tuple[list[FirstCurve], float]:
    """Return the curves in which the wall leaves the ground.

    Points are on wall and ground except for rounding. Corners are where pieces of the ground meet
    at an angle. Facets that approximate a round surface (angles below SHARP_EDGE_RAD) are smoothed,
    see `_round_curve`.

    Parameters
    ----------
    wall : PatchWall
        Wall with n vertices.
    ground : Ground
        The ground.
    value : (n,) array
        Distances of the vertices; the curves separate negative from other values.
    rims : tuple of Rim
        Rims of the wall, on which open curves end.

    Returns
    -------
    curves : list of FirstCurve
        The curves.
    error : float
        Maximum error between the points of the curves, mm: about TOLERANCE_MM; on a ground of
        triangles, measured to the surface that they approximate.
    """
    curves, max_error = [], 0.0
    for line in wall.mesh.level_lines(value, np.arange(len(wall.triangles))):
        if len(line.points) < 3:
            continue
        curve, error = _curve(wall, ground, line, rims)
        if curve is not None:
            curves.append(curve)
            max_error = max(max_error, error)
    return curves, max_error


def _curve(
    wall: PatchWall, ground: Ground, line: LevelLine, rims: tuple[Rim, ...]
) -> tuple[FirstCurve | None, float]:
    points = thin_points(line.points, line.closed, MIN_STEP_SHARE * wall.mesh.typical_edge)
    points, ground_piece = _move_onto_ground(wall, ground, points)
    if not line.closed:
        for end in (0, -1):
            points[end] = wall.project(_intersect_rim(points[end], rims, ground)[None])[0][0]
        ground_piece = ground.located(points)[2]
        # a smooth surface through a mesh deviates slightly at the edge of the mesh
        for end in (0, -1):
            if abs(_above(ground, points[[end]], ground_piece[[end]])[0]) >= ON_GROUND:
                points[[end]], ground_piece[[end]] = _move_onto_ground(wall, ground, points[[end]])
    sound = np.abs(_above(ground, points, ground_piece)) < ON_GROUND
    points, ground_piece = points[sound], ground_piece[sound]
    if len(points) < 4:
        return None, 0.0
    points, piece_before, piece_after, edge = _insert_corners(
        wall, ground, points, ground_piece, line.closed
    )
    normal = wall.project(points)[1]
    into, out = (
        unit(np.cross(normal, ground.on(piece_numbers, points)[1]))
        for piece_numbers in (piece_before, piece_after)
    )
    chord = np.roll(points, -1, axis=0) - points
    if dot(out, chord)[: len(points) if line.closed else -1].sum() < 0.0:
        into, out = -into, -out
    if ground.facets:
        return _round_curve(wall, ground, points, into, out, edge, line.closed)
    points, into, out = _drop_misordered(points, into, out, edge, line.closed)
    return _refine_curve(wall, ground, FirstCurve(points, into, out, line.closed))


def _refine_curve(
    wall: PatchWall, ground: Ground, start_curve: FirstCurve
) -> tuple[FirstCurve, float]:
    """Add points where the curve deviates from wall or ground, as at a jump of curvature.

    Returns the curve and its remaining maximum distance from wall and ground, mm.
    """
    for _ in range(ROUNDS + 4):
        curve = start_curve.curve()
        inner = curve.at((curve.w[:-1, None] + curve.span[:, None] * THIRDS).ravel())[0]
        gaps = np.maximum(
            np.linalg.norm(wall.project(inner)[0] - inner, axis=1),
            _distance_from_ground(ground, inner),
        )
        off = gaps.reshape(-1, len(THIRDS)).max(axis=1)
        bad = np.flatnonzero((off > TOLERANCE_MM) & (curve.span > 1e-6 * curve.period))
        if not len(bad):
            break
        middle, along, _ = curve.at(curve.w[bad] + 0.5 * curve.span[bad])
        points, ground_piece = _move_onto_ground(wall, ground, middle)
        slope = unit(np.cross(wall.project(points)[1], ground.on(ground_piece, points)[1]))
        slope *= np.where(dot(slope, along) < 0.0, -1.0, 1.0)[:, None]
        sound = np.abs(_above(ground, points, ground_piece)) < ON_GROUND
        sound &= np.linalg.norm(points - middle, axis=1) < 0.5 * curve.span[bad]
        if not sound.any():
            break
        index, points, slope = bad[sound] + 1, points[sound], slope[sound]
        start_curve = FirstCurve(
            np.insert(start_curve.points, index, points, axis=0),
            np.insert(start_curve.into, index, slope, axis=0),
            np.insert(start_curve.out, index, slope, axis=0),
            start_curve.closed,
        )
    return start_curve, float(
        max(off.max(), _distance_from_ground(ground, start_curve.points).max())
    )


def _above(ground: Ground, points: Array, ground_piece: Index) -> Array:
    """Return the heights (n,) of points above their ground pieces, mm."""
    return dot(points - (foot := ground.on(ground_piece, points))[0], foot[1])


def _distance_from_ground(ground: Ground, points: Array) -> Array:
    """Return the distances (n,) of points from the ground pieces, mm."""
    return np.asarray(np.linalg.norm(points - ground.located(points)[0], axis=1))


def _move_onto_ground(
    wall: PatchWall, ground: Ground, points: Array, level: Array | float = 0.0
) -> tuple[Array, Index]:
    """Move points along the wall onto the ground, or `level` (k,) mm above the ground.

    Also returns the ground piece of each point.
    """
    points, normal = wall.project(points)
    ground_piece = ground.located(points)[2]
    for step in range(STEPS):
        foot, up = ground.on(ground_piece, points)
        gap = dot(points - foot, up) - level
        slope = up - dot(up, normal)[:, None] * normal
        move = (gap / np.maximum(dot(slope, slope), 0.01))[:, None] * slope
        points, normal = wall.project(points - move)
        if step < 6:
            ground_piece = ground.located(points)[2]
        elif np.abs(gap).max(initial=0.0) < 1e-12:
            break
    return points, ground_piece


def _intersect_rim(point: Array, rims: tuple[Rim, ...], ground: Ground) -> Array:
    """Intersect the nearest rim with the ground; return `point` if they do not meet."""
    best = min(
        rims, key=lambda rim: float(np.linalg.norm(rim.points - point, axis=1).min()), default=None
    )
    if best is None or len(best.points) < 4:
        return point
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(best.points, axis=0), axis=1))]
    spline = CubicSpline(length, best.points)
    w = float(length[np.argmin(np.linalg.norm(best.points - point, axis=1))])
    for _ in range(STEPS):
        position, slope = spline(w)[None], spline(w, 1)[None]
        foot, up, _ = ground.located(position)
        rate = float(dot(slope, up)[0])
        if abs(rate) < 1e-3:
            return point
        step = float(dot(position - foot, up)[0]) / rate
        w = w - float(np.clip(step, -1.0, 1.0))
        if abs(step) < 1e-12:
            break
    intersection: Array = spline(w)
    return (
        intersection
        if np.linalg.norm(intersection - point) < 5.0 * float(np.diff(length).max())
        else point
    )


def _insert_corners(
    wall: PatchWall, ground: Ground, points: Array, ground_piece: Index, closed: bool
) -> tuple[Array, Index, Index, Mask]:
    """Insert corners where two pieces of the ground meet at an angle.

    Also returns the pieces before and after each point, and which points are corners.
    """
    count = len(points)
    following = (np.arange(count) + 1) % count
    change = ground_piece != ground_piece[following]
    if not closed:
        change[-1] = False
    index = np.flatnonzero(change)
    p = 0.5 * (points[index] + points[following[index]])
    piece_a, piece_b = ground_piece[index], ground_piece[following[index]]
    middle = p.copy()
    flat = np.zeros(len(index), dtype=bool)
    for _ in range(STEPS):
        on_wall, normal = wall.project(p)
        (foot_a, up_a), (foot_b, up_b) = ground.on(piece_a, p), ground.on(piece_b, p)
        system = np.stack([normal, up_a, up_b], axis=1)
        gaps = np.stack(
            [dot(on_wall - p, normal), dot(foot_a - p, up_a), dot(foot_b - p, up_b)], axis=1
        )
        flat = np.linalg.norm(np.cross(up_a, up_b), axis=1) < CORNER
        system[flat] = np.eye(3)
        singular = np.abs(np.linalg.det(system)) < 1e-6
        system[singular] = np.eye(3)
        flat |= singular
        step = np.linalg.solve(system, gaps[..., None])[..., 0]
        step[flat] = 0.0
        p = p + step
        if np.abs(step).max(initial=0.0) < 1e-12:
            break
    span = np.linalg.norm(points[index] - points[following[index]], axis=1)
    accepted = ~flat & (np.linalg.norm(p - middle, axis=1) < 2.0 * span + 1e-9)
    if ground.facets and accepted.any():  # the planes of non-adjacent facets meet above the solid
        accepted[accepted] = np.abs(ground.signed(p[accepted])) < 1e-5
    key = np.r_[np.arange(count), index[accepted] + 0.5]
    order = np.argsort(key, kind="stable")
    edge = np.r_[np.zeros(count, dtype=bool), np.ones(int(accepted.sum()), dtype=bool)]
    piece_before = np.r_[ground_piece, piece_a[accepted]]
    piece_after = np.r_[ground_piece, piece_b[accepted]]
    return (
        np.vstack([points, p[accepted]])[order],
        piece_before[order],
        piece_after[order],
        edge[order],
    )


def _drop_misordered(
    points: Array, into: Array, out: Array, edge: Mask, closed: bool
) -> tuple[Array, Array, Array]:
    """Drop points at a corner or on its wrong side."""
    keep = np.ones(len(points), dtype=bool)
    scale = float(np.median(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    for corner in np.flatnonzero(edge):
        for side in (-1, 1):
            for steps in range(1, 4):
                k = corner + side * steps
                if not closed and not 0 <= k < len(points):
                    break
                k %= len(points)
                if edge[k]:
                    break
                gap = points[corner] - points[k] if side < 0 else points[k] - points[corner]
                if float(gap @ (into if side < 0 else out)[corner]) < 0.05 * scale:
                    keep[k] = False
    return points[keep], into[keep], out[keep]


def _round_curve(
    wall: PatchWall,
    ground: Ground,
    points: Array,
    into: Array,
    out: Array,
    edge: Mask,
    closed: bool,
) -> tuple[FirstCurve, float]:
    """Return a curve that is smooth across edges of facets at small angles, with exact corners.

    Points where the wall crosses facet edges are kept. Between two such points less than four mesh
    edges apart, the curve does not follow the facet. It runs smoothly on the wall, about the
    sagitta above the facet. Where it would be farther away, points at most the sagitta above the
    facet are added.
    """
    points, into, out, edge = _drop_coincident(points, into, out, edge, closed)
    turn = np.arccos(np.clip(dot(into, out), -1.0, 1.0))
    sharp = edge & (turn > SHARP_EDGE_RAD)
    gap = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    length = np.r_[0.0, np.cumsum(gap)][:-1]
    corners = np.flatnonzero(edge)
    keep = np.ones(len(points), dtype=bool)
    reach = 4.0 * wall.mesh.longest_edge
    if len(corners) > 1:
        for k, start in enumerate(corners):
            end = corners[(k + 1) % len(corners)]
            if end <= start and not closed:
                continue
            span = (length[end] - length[start]) % (gap.sum() if closed else np.inf)
            if span < reach:
                inner = np.arange(start + 1, end if end > start else end + len(points)) % len(
                    points
                )
                keep[inner] = False
    points, sharp = points[keep], sharp[keep]
    points, into, out = fit_splines(points, sharp, closed)
    for _ in range(ROUNDS):
        curve = FirstCurve(points, into, out, closed).curve()
        middle = curve.at(curve.w[:-1] + 0.5 * curve.span)[0]
        on_wall = wall.project(middle)[0]
        foot, up, ground_piece = ground.located(on_wall)
        above, sagitta = dot(on_wall - foot, up), ground.sagitta(ground_piece)
        too_far = np.abs(above) > SAGITTAS * sagitta + TOLERANCE_MM
        bad = np.flatnonzero((np.linalg.norm(on_wall - middle, axis=1) > TOLERANCE_MM) | too_far)
        if not len(bad):
            break
        # the round surface is between the facet and the sagitta above it
        on_wall[too_far] = _move_onto_ground(
            wall, ground, on_wall[too_far], np.clip(above, 0.0, sagitta)[too_far]
        )[0]
        order = np.argsort(np.r_[np.arange(len(points)), bad + 0.5], kind="stable")
        points = np.vstack([points, on_wall[bad]])[order]
        sharp = np.r_[sharp, np.zeros(len(bad), dtype=bool)][order]
        points, into, out = fit_splines(points, sharp, closed)
    curve = FirstCurve(points, into, out, closed).curve()
    max_error = float(np.abs(ground.signed(curve.at(curve.refined(4))[0])).max())
    return FirstCurve(points, into, out, closed), max_error


def _drop_coincident(
    points: Array, into: Array, out: Array, edge: Mask, closed: bool
) -> tuple[Array, Array, Array, Mask]:
    """Drop points that nearly coincide with the previous point, in all arrays."""
    scale = float(np.median(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    keep = np.ones(len(points), dtype=bool)
    previous = points[0]
    for k in range(1, len(points)):
        if np.linalg.norm(points[k] - previous) < 0.2 * scale and not (
            not closed and k == len(points) - 1
        ):
            keep[k] = False
        else:
            previous = points[k]
    return points[keep], into[keep], out[keep], edge[keep]


def fit_splines(points: Array, sharp: Mask, closed: bool) -> tuple[Array, Array, Array]:
    """Fit splines between the sharp corners of a chain and return unit tangents.

    Parameters
    ----------
    points : (n, 3) array
        The chain, mm.
    sharp : (n,) bool array
        Sharp corners of the chain.
    closed : bool
        Whether the chain is closed.

    Returns
    -------
    points : (n, 3) array
        The chain; a closed chain starts at a sharp corner if it has any.
    into, out : (n, 3) array
        Unit tangents before and after each point.
    """
    start = int(np.argmax(sharp)) if closed and sharp.any() else 0
    points, sharp = np.roll(points, -start, axis=0), np.roll(sharp, -start)
    ring = np.vstack([points, points[:1]]) if closed else points
    w = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(ring, axis=0), axis=1))]
    into, out = np.empty_like(ring), np.empty_like(ring)
    if closed and not sharp.any():
        slope = CubicSpline(w, ring, bc_type="periodic")(w, 1)
        into, out = slope.copy(), slope.copy()
    else:
        ends = np.unique(np.r_[0, np.flatnonzero(sharp), len(ring) - 1])
        for low, high in zip(ends[:-1], ends[1:]):
            rows = slice(low, high + 1)
            slope = CubicSpline(w[rows], ring[rows])(w[rows], 1)
            out[low:high], into[low + 1 : high + 1] = slope[:-1], slope[1:]
        into[0], out[-1] = (into[-1], out[0]) if closed else (out[0], into[-1])
    count = len(points)
    return points, unit(into[:count]), unit(out[:count])
