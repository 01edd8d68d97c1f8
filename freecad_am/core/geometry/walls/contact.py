# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a wall leaves what it grows on: level lines of the distance, brought onto both exactly, with their corners."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from ...types import Array, Index, Mask
from ..frames import unit
from ..mesh.refined import boundary
from ..mesh.solid import SHARP
from ..mesh.triangle_mesh import LevelLine, thinned
from .ground import Ground, distances
from .patch_wall import FirstCurve, PatchWall, Rim
from .surface import dot

TOUCH = 0.05  # mm; a wall that ends this short of its substrate stands on it
STEPS = 40
CORNER = np.radians(0.1)  # rad; smaller turns of the substrate are smooth joints
CLOSE = 0.3  # of the wall's typical edge; of nearer points of a chain one is enough
ROUNDS, SAGITTAS = (
    8,
    1.2,
)  # of points added between others; what a smooth curve may be off a facet, in its sagittas
WITHIN, ON_GROUND = 1e-5, 1e-6  # mm between the points of a chain and both surfaces, and at them
# of each arc; where a curvature jumps within it, its middle may be right by chance
THIRDS = np.array([1.0 / 3.0, 2.0 / 3.0])


def levels(wall: PatchWall, ground: Ground) -> Array:
    """Distances (n,) of the wall's vertices from the ground, negative inside; a boundary that ends just short of it is
    in. Farther than an edge of the wall's mesh they may be too small, see `ground.distances`."""
    value = distances(wall.vertices, ground, 2.0 * wall.mesh.longest_edge)
    edge = np.zeros(len(value), dtype=bool)
    edge[boundary(wall.triangles)[0]] = True
    value[edge & (value < TOUCH) & (value > -1e-4)] = -1e-4
    value[np.abs(value) < 1e-7] = -1e-7
    return value


def first_curves(
    wall: PatchWall, ground: Ground, value: Array, rims: tuple[Rim, ...]
) -> tuple[list[FirstCurve], float]:
    """The chains between the negative and the other values (n,) of the wall's vertices, and how far they leave wall or
    ground between the points, mm: by about WITHIN, on a ground of triangles by what they stand for.

    Points lie on wall and ground to rounding. Corners are where pieces of the ground meet at an angle; those of facets that
    stand for something round (turns under SHARP) are smoothed, see `_rounded`.
    """
    found, off = [], 0.0
    for line in wall.mesh.level_lines(value, np.arange(len(wall.triangles))):
        if len(line.points) < 3:
            continue
        curve, error = _curve(wall, ground, line, rims)
        if curve is not None:
            found.append(curve)
            off = max(off, error)
    return found, off


def _curve(
    wall: PatchWall, ground: Ground, line: LevelLine, rims: tuple[Rim, ...]
) -> tuple[FirstCurve | None, float]:
    points = thinned(line.points, line.closed, CLOSE * wall.mesh.typical_edge)
    points, piece = _converged(wall, ground, points)
    if not line.closed:
        for end in (0, -1):
            points[end] = wall.project(_on_rim(points[end], rims, ground)[None])[0][0]
        piece = ground.located(points)[2]
        for end in (0, -1):  # on a smooth surface through a mesh, which is a little off its edge
            if abs(_above(ground, points[[end]], piece[[end]])[0]) >= ON_GROUND:
                points[[end]], piece[[end]] = _converged(wall, ground, points[[end]])
    sound = np.abs(_above(ground, points, piece)) < ON_GROUND
    points, piece = points[sound], piece[sound]
    if len(points) < 4:
        return None, 0.0
    points, before, after, edge = _with_corners(wall, ground, points, piece, line.closed)
    normal = wall.project(points)[1]
    into, out = (unit(np.cross(normal, ground.on(which, points)[1])) for which in (before, after))
    chord = np.roll(points, -1, axis=0) - points
    if dot(out, chord)[: len(points) if line.closed else -1].sum() < 0.0:
        into, out = -into, -out
    if ground.facets:
        return _rounded(wall, ground, points, into, out, edge, line.closed)
    points, into, out = _ordered(points, into, out, edge, line.closed)
    return _refined(wall, ground, FirstCurve(points, into, out, line.closed))


def _refined(wall: PatchWall, ground: Ground, first: FirstCurve) -> tuple[FirstCurve, float]:
    """The curve with further points where it leaves wall or ground between them, as it does where their curvature jumps; and
    how far (mm) it is off either then."""
    for _ in range(ROUNDS + 4):
        curve = first.curve()
        inner = curve.at((curve.w[:-1, None] + curve.span[:, None] * THIRDS).ravel())[0]
        apart = np.maximum(
            np.linalg.norm(wall.project(inner)[0] - inner, axis=1), _off(ground, inner)
        )
        off = apart.reshape(-1, len(THIRDS)).max(axis=1)
        bad = np.flatnonzero((off > WITHIN) & (curve.span > 1e-6 * curve.period))
        if not len(bad):
            break
        middle, along, _ = curve.at(curve.w[bad] + 0.5 * curve.span[bad])
        points, piece = _converged(wall, ground, middle)
        slope = unit(np.cross(wall.project(points)[1], ground.on(piece, points)[1]))
        slope *= np.where(dot(slope, along) < 0.0, -1.0, 1.0)[:, None]
        sound = np.abs(_above(ground, points, piece)) < ON_GROUND
        sound &= np.linalg.norm(points - middle, axis=1) < 0.5 * curve.span[bad]
        if not sound.any():
            break
        at, points, slope = bad[sound] + 1, points[sound], slope[sound]
        first = FirstCurve(
            np.insert(first.points, at, points, axis=0),
            np.insert(first.into, at, slope, axis=0),
            np.insert(first.out, at, slope, axis=0),
            first.closed,
        )
    return first, float(max(off.max(), _off(ground, first.points).max()))


def _above(ground: Ground, points: Array, piece: Index) -> Array:
    """How far (n,) points are above their pieces of the ground, mm."""
    return dot(points - (at := ground.on(piece, points))[0], at[1])


def _off(ground: Ground, points: Array) -> Array:
    """Distances (n,) mm from the exact pieces of the ground."""
    return np.asarray(np.linalg.norm(points - ground.located(points)[0], axis=1))


def _converged(
    wall: PatchWall, ground: Ground, points: Array, level: Array | float = 0.0
) -> tuple[Array, Index]:
    """Points moved within the wall onto the ground, or `level` (k,) mm above it, and the piece of it that each lies on."""
    points, normal = wall.project(points)
    piece = ground.located(points)[2]
    for step in range(STEPS):
        foot, up = ground.on(piece, points)
        gap = dot(points - foot, up) - level
        slope = up - dot(up, normal)[:, None] * normal
        move = (gap / np.maximum(dot(slope, slope), 0.01))[:, None] * slope
        points, normal = wall.project(points - move)
        if step < 6:
            piece = ground.located(points)[2]
        elif np.abs(gap).max(initial=0.0) < 1e-12:
            break
    return points, piece


def _on_rim(point: Array, rims: tuple[Rim, ...], ground: Ground) -> Array:
    """The place on the nearest rim at which it meets the ground; the point as it is where there is none."""
    best = min(
        rims, key=lambda rim: float(np.linalg.norm(rim.points - point, axis=1).min()), default=None
    )
    if best is None or len(best.points) < 4:
        return point
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(best.points, axis=0), axis=1))]
    spline = CubicSpline(length, best.points)
    w = float(length[np.argmin(np.linalg.norm(best.points - point, axis=1))])
    for _ in range(STEPS):
        at, slope = spline(w)[None], spline(w, 1)[None]
        foot, up, _ = ground.located(at)
        rate = float(dot(slope, up)[0])
        if abs(rate) < 1e-3:
            return point
        step = float(dot(at - foot, up)[0]) / rate
        w = w - float(np.clip(step, -1.0, 1.0))
        if abs(step) < 1e-12:
            break
    found: Array = spline(w)
    return found if np.linalg.norm(found - point) < 5.0 * float(np.diff(length).max()) else point


def _with_corners(
    wall: PatchWall, ground: Ground, points: Array, piece: Index, closed: bool
) -> tuple[Array, Index, Index, Mask]:
    """The points with those inserted where two pieces of the ground meet at an angle; the pieces before and after each,
    and which ones those corners are."""
    count = len(points)
    following = (np.arange(count) + 1) % count
    change = piece != piece[following]
    if not closed:
        change[-1] = False
    at = np.flatnonzero(change)
    p = 0.5 * (points[at] + points[following[at]])
    one, other = piece[at], piece[following[at]]
    middle = p.copy()
    flat = np.zeros(len(at), dtype=bool)
    for _ in range(STEPS):
        on_wall, normal = wall.project(p)
        (foot_a, up_a), (foot_b, up_b) = ground.on(one, p), ground.on(other, p)
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
    span = np.linalg.norm(points[at] - points[following[at]], axis=1)
    kept = ~flat & (np.linalg.norm(p - middle, axis=1) < 2.0 * span + 1e-9)
    if (
        ground.facets and kept.any()
    ):  # planes of facets that are not neighbours meet above the solid
        kept[kept] = np.abs(ground.signed(p[kept])) < 1e-5
    key = np.r_[np.arange(count), at[kept] + 0.5]
    order = np.argsort(key, kind="stable")
    edge = np.r_[np.zeros(count, dtype=bool), np.ones(int(kept.sum()), dtype=bool)]
    before, after = np.r_[piece, one[kept]], np.r_[piece, other[kept]]
    return np.vstack([points, p[kept]])[order], before[order], after[order], edge[order]


def _ordered(
    points: Array, into: Array, out: Array, edge: Mask, closed: bool
) -> tuple[Array, Array, Array]:
    """Without the points that lie past a corner they should come before, or on it."""
    keep = np.ones(len(points), dtype=bool)
    scale = float(np.median(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    for corner in np.flatnonzero(edge):
        for side in (-1, 1):
            for away in range(1, 4):
                k = corner + side * away
                if not closed and not 0 <= k < len(points):
                    break
                k %= len(points)
                if edge[k]:
                    break
                gap = points[corner] - points[k] if side < 0 else points[k] - points[corner]
                if float(gap @ (into if side < 0 else out)[corner]) < 0.05 * scale:
                    keep[k] = False
    return points[keep], into[keep], out[keep]


def _rounded(
    wall: PatchWall,
    ground: Ground,
    points: Array,
    into: Array,
    out: Array,
    edge: Mask,
    closed: bool,
) -> tuple[FirstCurve, float]:
    """A smooth curve from one edge between facets to the next where their turns are small, with the exact corners elsewhere.

    The points at which the wall crosses the facets' edges are kept; between two of them that are less than four edges of the
    wall's mesh apart the curve does not follow the facet but runs smoothly on the wall, off the facet by about its sagitta;
    where it would be farther off, points no more than that above the facet are kept too.
    """
    points, into, out, edge = _apart(points, into, out, edge, closed)
    turn = np.arccos(np.clip(dot(into, out), -1.0, 1.0))
    sharp = edge & (turn > SHARP)
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
    points, into, out = splined(points, sharp, closed)
    for _ in range(ROUNDS):
        curve = FirstCurve(points, into, out, closed).curve()
        middle = curve.at(curve.w[:-1] + 0.5 * curve.span)[0]
        on_wall = wall.project(middle)[0]
        foot, up, piece = ground.located(on_wall)
        above, sagitta = dot(on_wall - foot, up), ground.sagitta(piece)
        far = np.abs(above) > SAGITTAS * sagitta + WITHIN
        bad = np.flatnonzero((np.linalg.norm(on_wall - middle, axis=1) > WITHIN) | far)
        if not len(bad):
            break
        # no farther than needed: what is round lies between the facet and its sagitta above
        on_wall[far] = _converged(wall, ground, on_wall[far], np.clip(above, 0.0, sagitta)[far])[0]
        order = np.argsort(np.r_[np.arange(len(points)), bad + 0.5], kind="stable")
        points = np.vstack([points, on_wall[bad]])[order]
        sharp = np.r_[sharp, np.zeros(len(bad), dtype=bool)][order]
        points, into, out = splined(points, sharp, closed)
    curve = FirstCurve(points, into, out, closed).curve()
    off = float(np.abs(ground.signed(curve.at(curve.refined(4))[0])).max())
    return FirstCurve(points, into, out, closed), off


def _apart(
    points: Array, into: Array, out: Array, edge: Mask, closed: bool
) -> tuple[Array, Array, Array, Mask]:
    """The columns without points that nearly coincide with the one before."""
    scale = float(np.median(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    keep = np.ones(len(points), dtype=bool)
    last = points[0]
    for k in range(1, len(points)):
        if np.linalg.norm(points[k] - last) < 0.2 * scale and not (
            not closed and k == len(points) - 1
        ):
            keep[k] = False
        else:
            last = points[k]
    return points[keep], into[keep], out[keep], edge[keep]


def splined(points: Array, sharp: Mask, closed: bool) -> tuple[Array, Array, Array]:
    """The chain (n, 3), started at a sharp corner (n,) if it has one, with unit tangents into and out of each point: those
    of splines from one sharp corner to the next."""
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
            piece = slice(low, high + 1)
            slope = CubicSpline(w[piece], ring[piece])(w[piece], 1)
            out[low:high], into[low + 1 : high + 1] = slope[:-1], slope[1:]
        into[0], out[-1] = (into[-1], out[0]) if closed else (out[0], into[-1])
    count = len(points)
    return points, unit(into[:count]), unit(out[:count])
