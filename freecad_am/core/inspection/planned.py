# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planned surfaces for the alignment of measured points, with signed distances and edges."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.curves.profile import RevolvedWall
from ..geometry.mesh.coarsen import doubled_areas
from ..geometry.mesh.solid import SolidMesh
from ..geometry.obstacles import Body
from ..geometry.on_hub import SolidsOnHub
from ..geometry.walls.patch_wall import PatchWall
from ..geometry.walls.surface import dot
from ..geometry.walls.surface_wall import SurfaceWall
from ..issues import AmError, InputError
from ..parameters.inspection import BOTH, INNER
from ..toolpath import Bead, Toolpath
from ..types import Array, Index, Mask
from .registration import Surface, by_extents, mean_square, register, roughly

PAST = 0.5  # mm; maximum distance past an edge of a point that counts
FACETED = 0.03  # maximum relative influence of rotating a round but faceted surface about its axis
TOUCHING = 1e-9  # mm; below this distance the direction away from a surface is its normal


@dataclass(frozen=True, eq=False)
class Planned:
    """A planned surface in part coordinates, mm.

    name: for messages. nearest: distances from the bounded surface, for the first alignment. exact: distances along the
    surface normals, where the surface continues past its edges. past: distances (n,) of points (n, 3) past the edges,
    mm. spread: (m, 3) points distributed over the surface. frame: (4, 4) frame with Z along the surface's axis and the
    origin at the base. wall: wall of revolution with the exact meridian, if any. chord: accuracy of the surface, mm.
    max_points: useful number of points for a fit. free: minimum influence of a motion on the distances, relative to the
    maximum influence. It is larger for facets, because their normals differ from those of the approximated surface.
    """

    name: str
    nearest: Surface
    exact: Surface
    past: Callable[[Array], Array]
    spread: Array
    frame: Array
    wall: RevolvedWall | None = None
    chord: float = 0.0
    max_points: int = 20_000
    free: float = 1e-5

    def within_edges(self, points: Array) -> Mask:
        """Return which points are not past the edges.

        Parameters
        ----------
        points : (n, 3) array
            Points in the part, mm.

        Returns
        -------
        (n,) array of bool
            True up to PAST mm past an edge.
        """
        return np.asarray(self.past(points) <= PAST)


def sided(surface: Surface, side: str, thickness: float) -> Surface:
    """Return one side of a wall, offset by half a thickness from the planned surface.

    Parameters
    ----------
    surface : Surface
        Returns signed distances (n,) and normals (n, 3) at points.
    side : str
        OUTER, INNER, or BOTH for the nearer side.
    thickness : float
        Thickness of the wall, mm.

    Returns
    -------
    Surface
        Distances and normals of the side.
    """
    if side == BOTH:

        def both(points: Array) -> tuple[Array, Array]:
            distance, normal = surface(points)
            sense = np.where(distance < 0.0, -1.0, 1.0)
            return np.abs(distance) - 0.5 * thickness, normal * sense[:, None]

        return both
    sense = -1.0 if side == INNER else 1.0

    def one(points: Array) -> tuple[Array, Array]:
        distance, normal = surface(points)
        return sense * distance - 0.5 * thickness, sense * normal

    return one


def triangle_surface(
    name: str,
    vertices: Array,
    triangles: Index,
    frame: Array | None = None,
    exact: Surface | None = None,
    chord: float = 0.0,
    max_points: int = 20_000,
) -> Planned:
    """Build a planned surface from triangles.

    Parameters
    ----------
    name : str
        Name for messages.
    vertices : (n, 3) array
        Vertices in part coordinates, mm.
    triangles : (m, 3) int array
        Vertex indices, counter-clockwise seen from outside for a solid.
    frame : (4, 4) array or None, optional
        Frame of the surface; None for the part frame.
    exact : Surface or None, optional
        The surface that the triangles approximate; None to use the triangles.
    chord : float, optional
        Accuracy of the triangles, mm.
    max_points : int, optional
        Useful number of points for a fit.

    Returns
    -------
    Planned
        The surface.
    """
    mesh = SolidMesh(vertices, triangles)
    extent = float(np.ptp(vertices, axis=0).max())
    search = mesh.searched(0.02 * extent)

    def nearest(points: Array) -> tuple[Array, Array]:
        distance, foot, triangle = search.signed(points)
        return distance, _directions_away(points, foot, distance, mesh.units[triangle])

    def past(points: Array) -> Array:
        if exact is None:
            return np.zeros(len(points))
        distance, normal = exact(points)
        foot = points - distance[:, None] * normal
        off = np.linalg.norm(foot - search.signed(points)[1], axis=1)
        return np.asarray(np.where(off > 4.0 * chord, off, 0.0))

    corners = vertices[triangles]
    area = np.linalg.norm(mesh.normals, axis=1)
    area_positions = (np.arange(4000) + 0.5) / 4000.0 * area.sum()
    triangle_rows = np.searchsorted(np.cumsum(area), area_positions).clip(max=len(area) - 1)
    own_frame, middles = np.eye(4) if frame is None else frame, corners[triangle_rows].mean(axis=1)
    free = 1e-5 if exact is not None else FACETED
    return Planned(
        name,
        nearest,
        exact or nearest,
        past,
        middles,
        own_frame,
        chord=chord,
        max_points=max_points,
        free=free,
    )


def bead_surface(name: str, samples: Array, normals: Array, frame: Array, step: float) -> Planned:
    """Build a planned surface from beads.

    Parameters
    ----------
    name : str
        Name for messages.
    samples : (n, 3) array
        Points along the beads, mm.
    normals : (n, 3) array
        Unit normals of the wall at the points.
    frame : (4, 4) array
        Frame of the surface.
    step : float
        Maximum distance between the points, mm.

    Returns
    -------
    Planned
        The surface.
    """
    tree = cKDTree(samples)

    def surface(points: Array) -> tuple[Array, Array]:
        _, nearest_row = tree.query(points)
        return dot(points - samples[nearest_row], normals[nearest_row]), normals[nearest_row]

    def off(points: Array) -> tuple[Array, Index, Array]:
        query = tree.query(points)
        distance, nearest_row = np.asarray(query[0]), np.asarray(query[1])
        along = dot(points - samples[nearest_row], normals[nearest_row])
        return (
            along,
            nearest_row,
            np.maximum(np.sqrt(np.maximum(distance**2 - along**2, 0.0)) - step, 0.0),
        )

    def nearest(points: Array) -> tuple[Array, Array]:
        along, nearest_row, over = off(points)
        distance = np.hypot(along, over) * np.where(along < 0.0, -1.0, 1.0)
        signed = np.linalg.norm(points - samples[nearest_row], axis=1) * np.where(
            along < 0.0, -1.0, 1.0
        )
        direction = _directions_away(points, samples[nearest_row], signed, normals[nearest_row])
        return distance, np.where((over > 0.0)[:, None], direction, normals[nearest_row])

    def past(points: Array) -> Array:
        return off(points)[2]

    sample = np.unique(np.linspace(0, len(samples) - 1, 4000).astype(np.intp))
    return Planned(name, nearest, surface, past, samples[sample], frame, free=FACETED)


def revolution_surface(wall: RevolvedWall) -> Planned:
    """Build a planned surface from the exact meridian of a wall of revolution.

    The normals point to the right of the meridian: away from the axis where the meridian rises.
    """
    meridian = _Meridian(wall)

    def exact(points: Array) -> tuple[Array, Array]:
        distance, normal, _, _ = meridian.along_normals(points)
        return distance, normal

    def nearest(points: Array) -> tuple[Array, Array]:
        distance, normal, past, foot = meridian.along_normals(points)
        signed = np.linalg.norm(points - foot, axis=1) * np.where(distance < 0.0, -1.0, 1.0)
        return np.where(past > 0.0, signed, distance), np.where(
            (past > 0.0)[:, None], _directions_away(points, foot, signed, normal), normal
        )

    def past(points: Array) -> Array:
        return meridian.along_normals(points)[2]

    s = np.linspace(0.0, wall.meridian.length, 60)
    radius, height, _ = wall.meridian.at(s)
    spread = np.concatenate(
        [
            wall.points(
                np.full(count, r),
                np.full(count, z),
                np.linspace(wall.start, wall.end, count, endpoint=not wall.full),
            )
            for count, r, z in zip(
                np.ceil(60.0 * radius / radius.max()).astype(int).clip(1),
                radius,
                height,
                strict=True,
            )
        ]
    )
    return Planned(wall.label, nearest, exact, past, spread, wall.frame, wall)


class _Meridian:
    """Projection of points onto the meridian of a wall."""

    def __init__(self, wall: RevolvedWall) -> None:
        self.wall, self.curve = wall, wall.meridian
        self.s = np.unique(
            np.concatenate([self.curve.s, np.linspace(0.0, self.curve.length, 2001)])
        )
        self.step = float(np.diff(self.s).max())
        radius, height, _ = self.curve.at(self.s)
        self.tree = cKDTree(np.column_stack([radius, height]))

    def local(self, points: Array) -> tuple[Array, Array, Array, Array]:
        """Return radius, height, azimuth limited to the wall's sector, and distance past the sector, mm; (n,) each."""
        frame = self.wall.frame
        local_points = (points - frame[:3, 3]) @ frame[:3, :3]
        radius = np.hypot(local_points[:, 0], local_points[:, 1])
        azimuth = np.arctan2(local_points[:, 1], local_points[:, 0])
        if self.wall.full:
            return radius, local_points[:, 2], azimuth, np.zeros(len(points))
        span = self.wall.end - self.wall.start
        middle = self.wall.start + 0.5 * span
        off = np.remainder(azimuth - middle + np.pi, 2.0 * np.pi) - np.pi
        clipped = np.clip(off, -0.5 * span, 0.5 * span)
        beyond = np.abs(off - clipped)
        over = np.where(beyond < 0.5 * np.pi, radius * np.sin(beyond), radius)
        return radius, local_points[:, 2], middle + clipped, over

    def nearest(self, radius: Array, height: Array) -> Array:
        """Return the arc lengths (n,) of the nearest points on the meridian."""
        nearest_row = self.tree.query(np.column_stack([radius, height]))[1]
        start = self.s[nearest_row]
        low = np.maximum(start - self.step, 0.0)
        high = np.minimum(start + self.step, self.curve.length)
        f_low, f_high = self._slope(low, radius, height), self._slope(high, radius, height)
        s = start
        for _ in range(3):  # false position; the slope of the distance is locally almost linear
            straddled = (f_low > 0.0) & (f_high < 0.0)
            s = np.where(
                straddled, low + (high - low) * f_low / np.where(straddled, f_low - f_high, 1.0), s
            )
            s = np.where(f_low <= 0.0, low, np.where(f_high >= 0.0, high, s))
            f = self._slope(s, radius, height)
            low, f_low = np.where(f > 0.0, s, low), np.where(f > 0.0, f, f_low)
            high, f_high = np.where(f > 0.0, high, s), np.where(f > 0.0, f_high, f)
        return np.asarray(
            np.where(
                self._distance(s, radius, height) <= self._distance(start, radius, height), s, start
            )
        )

    def _slope(self, s: Array, radius: Array, height: Array) -> Array:
        r, z, tangent = self.curve.at(s)
        return np.asarray((radius - r) * tangent[:, 0] + (height - z) * tangent[:, 1])

    def _distance(self, s: Array, radius: Array, height: Array) -> Array:
        r, z, _ = self.curve.at(s)
        return np.asarray(np.hypot(radius - r, height - z))

    def along_normals(self, points: Array) -> tuple[Array, Array, Array, Array]:
        """Project points onto the wall.

        Returns distances (n,) along the normals, normals (n, 3) at the nearest points, distances (n,) past the edges,
        mm, and the nearest points (n, 3).
        """
        radius, height, azimuth, off_plane = self.local(points)
        s = self.nearest(radius, height)
        r, z, tangent = self.curve.at(s)
        normal = np.column_stack([tangent[:, 1], np.zeros(len(s)), -tangent[:, 0]])
        distance = (radius - r) * normal[:, 0] + (height - z) * normal[:, 2]
        over = np.abs((radius - r) * tangent[:, 0] + (height - z) * tangent[:, 1])
        at_end = ((s <= 0.0) & (self.curve.points[0, 0] > 0.0)) | (
            (s >= self.curve.length) & (not self.curve.closed_top)
        )
        past = np.hypot(np.where(at_end, over, 0.0), off_plane)
        # all points between the two normals of a corner project onto the corner; the normal of such a point is the
        # direction from the corner
        inside = ~at_end & (over > 1e-6) & (over > 1e-3 * np.abs(distance))
        off = np.hypot(radius - r, height - z)
        side = np.where(distance < 0.0, -1.0, 1.0)
        distance = np.where(inside, side * off, distance)
        direction = (
            np.column_stack([radius - r, np.zeros(len(s)), height - z])
            * (side / np.maximum(off, 1e-300))[:, None]
        )
        normal = np.where(inside[:, None], direction, normal)
        return (
            distance,
            self.wall.directions(normal, azimuth),
            past,
            self.wall.points(r, z, azimuth),
        )


def _directions_away(points: Array, foot: Array, distance: Array, normal: Array) -> Array:
    """Return the unit vectors (n, 3) along which the signed distances from the foot points increase."""
    off = np.abs(distance)[:, None]
    sense = np.where(distance < 0.0, -1.0, 1.0)[:, None]
    return np.asarray(
        np.where(off > TOUCHING, sense * (points - foot) / np.maximum(off, TOUCHING), normal)
    )


NEIGHBOURS = 8
ALONE = 3.0  # times the median distance to neighbours; points beyond this are outliers
FITTED = 3000  # maximum number of points in the fit
TRIAL_POINTS, HOPEFUL = (
    300,
    12,
)  # points for the comparison of attitudes; attitudes that are refined
OUTLYING = (
    5.0  # standard deviations, estimated from the median; maximum residual of an aligned point
)
EQUAL_RATIO = 1.1  # times the minimum mean square; attitudes within this are equivalent
LOOSE = 0.1  # of the maximum influence; a motion with less slides along a flat face
STILL = 0.01  # mm; maximum last step of a valid fit, which converges slowly on flat faces of a bent body
MIN_DIFFERENCE_RAD = np.radians(10.0)  # minimum angle between different attitudes
PLAIN = np.radians(
    45.0
)  # maximum angle from the measured attitude of an attitude chosen among equivalent attitudes


def align_scan(points: Array, body: Body, label: str) -> Array:
    """Align measured points with a body.

    Parameters
    ----------
    points : (n, 3) array
        Measured points, mm.
    body : Body
        The body in part coordinates.
    label : str
        Name of the scan, for messages.

    Returns
    -------
    (4, 4) array
        Rigid motion of the points onto the body.

    Raises
    ------
    InputError
        SCAN_OTHER if the fit fails, SCAN_AMBIGUOUS if several attitudes are equivalent.
    """
    planned = triangle_surface(body.name, body.vertices, body.triangles)
    neighbour_distance = np.asarray(
        cKDTree(points).query(points, k=min(NEIGHBOURS + 1, len(points)))[0]
    )[:, -1]
    together = points[neighbour_distance <= ALONE * np.median(neighbour_distance)]
    sample = together[np.unique(np.linspace(0, len(together) - 1, FITTED).astype(np.intp))]
    start = _attitude(sample, planned.nearest, by_extents(sample, planned.spread), label)
    try:
        for _ in range(2):
            registration = register(
                sample, planned.nearest, start[None], label, free=LOOSE, still=STILL
            )
            start = registration.motion
            off = np.abs(registration.distance)
            sample = sample[off <= max(OUTLYING * 1.4826 * float(np.median(off)), 1e-6)]
    except AmError as error:
        raise InputError(
            "SCAN_OTHER", label, "the scan cannot be aligned with {}: {}", body.name, error.message
        ) from None
    return start


def _attitude(points: Array, surface: Surface, starts: Array, label: str) -> Array:
    """Return the best attitude; among equivalent attitudes, the nearest to the measured attitude.

    Raises InputError SCAN_AMBIGUOUS if several attitudes are equivalent and none is near the measured attitude.
    """
    sample = points[:: max(1, len(points) // TRIAL_POINTS)]
    order = np.argsort([mean_square(sample, surface, start) for start in starts], kind="stable")
    motions = [
        roughly(sample, surface, start[None], free=LOOSE) for start in starts[order[:HOPEFUL]]
    ]
    squares = np.array([mean_square(sample, surface, motion) for motion in motions])
    alike = [
        motion
        for motion, square in zip(motions, squares, strict=True)
        if square <= EQUAL_RATIO * squares.min() + 1e-12
    ]
    turns = np.array([_turn(motion[:3, :3]) for motion in alike])
    best = alike[int(turns.argmin())]
    different = [
        motion for motion in alike if _turn(motion[:3, :3] @ best[:3, :3].T) > MIN_DIFFERENCE_RAD
    ]
    if different and turns.min() > PLAIN:
        angle = np.degrees(_turn(different[0][:3, :3] @ best[:3, :3].T))
        raise InputError(
            "SCAN_AMBIGUOUS",
            label,
            "the scan fits equally well on the part rotated by {:.0f} deg, so its orientation is "
            "ambiguous; give three pairs of points as substrate.scan_pairs, or measure in part "
            "coordinates",
            angle,
        )
    return best


def _turn(rotation: Array) -> float:
    """Return the angle of a rotation (3, 3), rad."""
    return float(np.arccos(np.clip(0.5 * (np.trace(rotation) - 1.0), -1.0, 1.0)))


def as_pairs(motion: Array, size: float) -> str:
    """Format a motion as pairs of points for the start of an inspection.

    Parameters
    ----------
    motion : (4, 4) array
        Rigid motion from measuring to part coordinates, mm.
    size : float
        Distance of the points from the origin, mm.

    Returns
    -------
    str
        Four pairs of a measured point and a point of the part.
    """
    points = size * np.vstack([np.zeros(3), np.eye(3)])
    moved_points = points @ motion[:3, :3].T + motion[:3, 3]
    return "; ".join(
        " ".join(repr(float(x)) for x in measured_point)
        + " > "
        + " ".join(repr(float(x)) for x in part_point)
        for measured_point, part_point in zip(points, moved_points, strict=True)
    )


# ---- Planned surfaces of walls, solids and toolpaths

ROWS, COLUMNS = (
    80,
    240,
)  # size of the triangle grid that locates points on a wall of one surface
PLAIN_LOOP = 0.2  # mean radial component of a loop's normals; below it the adjacent bead decides which side is outside
FINE = 0.25  # mm; maximum distance between samples of a bead


def solids_surface(solids: SolidsOnHub) -> Planned:
    """Build a planned surface from the triangles of all solids."""
    bodies = [body for group in solids.groups for body in group.bodies]
    counts = np.cumsum([0, *(len(body.vertices) for body in bodies)])
    triangles = np.concatenate(
        [body.triangles + start for body, start in zip(bodies, counts[:-1], strict=True)]
    )
    vertices = np.concatenate([body.vertices for body in bodies])
    return triangle_surface(
        solids.label, vertices, triangles, solids.groups[0].base.frame, chord=solids.chord_error
    )


def wall_surface(wall: SurfaceWall | PatchWall) -> Planned:
    """Build a planned surface from a wall on a part."""
    return _tube_surface(wall) if wall.closes_around else _patches_surface(wall)


def _patches_surface(wall: PatchWall) -> Planned:
    def exact(points: Array) -> tuple[Array, Array]:
        foot, normal = wall.project(points)
        return dot(points - foot, normal), normal

    longest = np.linalg.norm(np.ptp(wall.vertices[wall.triangles], axis=1), axis=1).mean()
    return triangle_surface(
        wall.label, wall.vertices, wall.triangles, exact=exact, chord=0.02 * float(longest)
    )


def _tube_surface(wall: SurfaceWall) -> Planned:
    surface = wall.surface()
    period = surface.period or 2.0 * np.pi
    u, v = surface.inverse(wall.first)
    order = np.argsort(np.remainder(v, period))
    around = np.linspace(0.0, period, COLUMNS, endpoint=False)
    start = np.interp(around, np.remainder(v, period)[order], u[order], period=period)
    share = np.linspace(0.0, 1.0, ROWS)[:, None]
    up = np.asarray(start[None] + share * (wall.end - start)[None], float)
    grid = surface.point(up, np.broadcast_to(around, up.shape))
    row, column = np.meshgrid(np.arange(ROWS - 1), np.arange(COLUMNS), indexing="ij")
    a, b = row * COLUMNS + column, row * COLUMNS + (column + 1) % COLUMNS
    triangles = np.concatenate(
        [np.stack([a, b, b + COLUMNS], -1), np.stack([a, b + COLUMNS, a + COLUMNS], -1)]
    )
    middle = ROWS // 2
    sense = _outward(grid[middle], _normals(surface.derivatives(up[middle], around)))
    triangles = triangles.reshape(-1, 3)
    corners = grid.reshape(-1, 3)[triangles]
    turned = doubled_areas(corners)
    where = corners.mean(axis=1)
    normals_ = _normals(surface.derivatives(*surface.inverse(where)))
    if float(dot(turned, normals_).sum()) * sense < 0.0:
        triangles = triangles[:, ::-1]

    def exact(points: Array) -> tuple[Array, Array]:
        derivatives = surface.derivatives(*surface.inverse(points))
        normal = sense * _normals(derivatives)
        return dot(points - derivatives[0], normal), normal

    chord = float(np.linalg.norm(np.diff(grid, axis=1), axis=2).max()) * np.pi / COLUMNS
    return triangle_surface(wall.label, grid.reshape(-1, 3), triangles, wall.frame, exact, chord)


def _normals(derivatives: tuple[Array, Array, Array]) -> Array:
    normal = np.cross(derivatives[1], derivatives[2])
    return np.asarray(normal / np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-300))


def _outward(loop: Array, normals: Array) -> float:
    """Return 1 if normals (n, 3) point out of a loop of points (n, 3), -1 if they point into it."""
    return 1.0 if float(dot(loop - loop.mean(axis=0), normals).sum()) >= 0.0 else -1.0


def toolpath_surface(toolpath: Toolpath, name: str) -> Planned:
    """Build a planned surface from the wall that the beads form.

    At each bead the wall is tangential to the bead and its build direction. Raises InputError NOT_FOR_FAMILY for `name`
    if the beads fill solids.
    """
    if toolpath.traits.is_filled:
        raise InputError(
            "NOT_FOR_FAMILY",
            name,
            "most beads are inside the solids that they fill; compare the points with the feature",
        )
    samples: list[Array] = []
    normals: list[Array] = []
    for _, _, bead in toolpath:
        points, normal = _sampled(bead)
        if toolpath.traits.has_axis:
            sense = _turning(points, toolpath.frame)
        elif samples and not (bead.closed and _is_radial(points, normal)):
            nearest = cKDTree(samples[-1]).query(points)[1]
            sense = 1.0 if float(dot(normals[-1][nearest], normal).sum()) >= 0.0 else -1.0
        else:
            sense = _outward(points, normal)
        samples.append(points)
        normals.append(sense * normal)
    step = max(FINE, 0.75 * toolpath.layer_height)
    return bead_surface(
        name, np.concatenate(samples), np.concatenate(normals), toolpath.frame, step
    )


def _turning(points: Array, frame: Array) -> float:
    """Return 1 if points (n, 3) run counter-clockwise about Z of a frame, -1 if clockwise.

    The normals of a counter-clockwise bead agree with the meridian's normals.
    """
    x, y = ((points - frame[:3, 3]) @ frame[:3, :2]).T
    return 1.0 if float((x[:-1] * y[1:] - y[:-1] * x[1:]).sum()) >= 0.0 else -1.0


def _is_radial(loop: Array, normals: Array) -> bool:
    """Whether normals (n, 3) of a loop of points (n, 3) are radial rather than axial."""
    offsets = loop - loop.mean(axis=0)
    return bool(
        abs(float(dot(offsets, normals).sum()))
        > PLAIN_LOOP * float(np.linalg.norm(offsets, axis=1).sum())
    )


def _sampled(bead: Bead) -> tuple[Array, Array]:
    """Sample a bead at most FINE apart; return points and unit normals of the wall."""
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    count = np.maximum(np.ceil(length / FINE).astype(np.intp), 1)
    segment = np.repeat(np.arange(len(count)), count)
    share = (
        (np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)) / count[segment]
    )[:, None]
    points, tangent = bead.outline.at(segment, share[:, 0])
    build = bead.build[segment] * (1.0 - share) + bead.build[segment + 1] * share
    normal = np.cross(tangent, build)
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    is_proper = size[:, 0] > 1e-12
    return points[is_proper], normal[is_proper] / size[is_proper]
