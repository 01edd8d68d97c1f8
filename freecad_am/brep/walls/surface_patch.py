# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces as patches: their exact surfaces as numbers that the core evaluates without FreeCAD."""

from __future__ import annotations

from typing import Any

import numpy as np
import Part
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from ...core.geometry.frames import TURN
from ...core.geometry.step_count import step_count
from ...core.geometry.walls.patch import CONE, CYLINDER, PLANE, SPHERE, SPLINE, TORUS, Patch
from ...core.geometry.walls.surface import dot
from ...core.issues import InputError
from ...core.types import Array, Index, Mask

STEPS = 8
NODE_MM = 1e-4  # mm; maximum distance between a vertex and its tessellation node
MAX_MOVE_SHARE = (
    0.7  # maximum movement of an edge midpoint on a smooth surface, fraction of half the edge
)


class Places:
    """Move new edge midpoints onto their faces and edges.

    Parameters of all vertices on spline faces are stored. Where a surface comes close to itself,
    the nearest point may be wrong, so each search starts from neighbouring parameters. nodes: for
    each face, the parameters (k, 2) of the initial vertices (n, 3), in any order.
    """

    def __init__(
        self, shape: Any, patches: list[Patch], nodes: list[Array], vertices: Array, edge: float
    ) -> None:
        self.patches, self.curves = patches, _Curves(shape, edge)
        self.uv: dict[int, Array] = {}
        for k, patch in enumerate(patches):
            if patch.kind != SPLINE:
                continue
            self.uv[k] = np.full((len(vertices), 2), np.nan)
            if len(nodes[k]):
                off, nearest_node = cKDTree(patch.at(nodes[k])[0]).query(vertices)
                self.uv[k][off < NODE_MM] = nodes[k][nearest_node[off < NODE_MM]]

    def middles(self, points: Array, adjacent: Index, ends: Index) -> Array:
        """Return the moved midpoints (n, 3) of the edges between vertices `ends` (n, 2).

        The midpoints become the next vertices. adjacent: face indices (n, 2) on both sides of each
        edge, -1 for no face.
        """
        inner = adjacent[:, 0] == adjacent[:, 1]
        placed = points.copy()
        placed[~inner] = self.curves.nearest(points[~inner])
        for k in np.unique(adjacent[inner, 0]):
            members = np.flatnonzero(inner & (adjacent[:, 0] == k))
            if k not in self.uv:
                placed[members] = self.patches[k].at(self.patches[k].inverse(points[members]))[0]
        for k, uv in self.uv.items():
            parameters = np.full((len(points), 2), np.nan)
            members = np.flatnonzero((adjacent == k).any(axis=1))
            parameters[members] = self._near(k, placed[members], ends[members], inner[members])
            on_face = members[inner[members]]
            placed[on_face] = self.patches[k].at(parameters[on_face])[0]
            self.uv[k] = np.vstack([uv, parameters])
        return placed

    def _near(self, k: int, points: Array, ends: Index, inner: Mask) -> Array:
        """Return parameters of points on patch k, searched from the parameters of the edge ends.

        inner: mask of points to move.
        """
        patch, (start_uv, end_uv) = self.patches[k], (self.uv[k][ends[:, side]] for side in (0, 1))
        for axis, period in enumerate(patch.periods):
            if period > 0.0:
                end_uv[:, axis] -= period * np.round((end_uv[:, axis] - start_uv[:, axis]) / period)
        start = 0.5 * (start_uv + end_uv)
        has_start = np.isfinite(start).all(axis=1)
        uv_found = np.empty_like(start)
        uv_found[has_start] = patch.inverse(points[has_start], start[has_start])
        half = 0.5 * np.linalg.norm(patch.at(start_uv)[0] - patch.at(end_uv)[0], axis=1)
        is_lost = ~has_start
        is_lost[has_start] = ~(
            np.linalg.norm(patch.at(uv_found[has_start])[0] - points[has_start], axis=1)
            < MAX_MOVE_SHARE * half[has_start]
        )
        uv_found[is_lost] = patch.inverse(points[is_lost])
        # across a narrow tube, the point nearest to a midpoint may be an end: halving never stops
        tips = [patch.at(side[is_lost])[0] for side in (start_uv, end_uv)]
        farther = [
            np.max([np.linalg.norm(patch.at(uv_point)[0] - tip, axis=1) for tip in tips], axis=0)
            for uv_point in (uv_found[is_lost], start[is_lost])
        ]
        halfway = (inner & has_start)[is_lost] & (farther[1] < farther[0])
        uv_found[np.flatnonzero(is_lost)[halfway]] = start[is_lost][halfway]
        return uv_found

    def parameters(self, k: int, vertices: Array, used: Index) -> Array:
        """Return parameters (n, 2) on patch k of the vertices with indices `used` (n,)."""
        patch = self.patches[k]
        if k not in self.uv:
            return patch.inverse(vertices[used])
        uv_found = self.uv[k][used]
        is_lost = ~np.isfinite(uv_found).all(axis=1)
        uv_found[is_lost] = patch.inverse(vertices[used[is_lost]])
        return uv_found


class _Curves:
    """Edges of a shape as splines, for nearest-point searches."""

    def __init__(self, shape: Any, edge: float) -> None:
        self.splines, points, spline_numbers, parameters = [], [], [], []
        for curve in shape.Edges:
            if curve.Degenerated or curve.Length < 1e-9:
                continue
            low, high = curve.ParameterRange
            count = min(step_count(4.0 * curve.Length, edge, 32), 4000) + 1
            t = np.linspace(low, high, count)
            samples = np.array([tuple(curve.valueAt(parameter)) for parameter in t.tolist()])
            spline_numbers.append(np.full(count, len(self.splines)))
            self.splines.append(CubicSpline(t, samples))
            points.append(samples)
            parameters.append(t)
        self.tree = cKDTree(np.vstack(points))
        self.which, self.at = np.concatenate(spline_numbers), np.concatenate(parameters)

    def nearest(self, points: Array) -> Array:
        """Return the nearest points (n, 3) on the edges."""
        if not len(points):
            return points
        nearest_sample = self.tree.query(points)[1]
        feet = np.empty_like(points)
        for k in np.unique(self.which[nearest_sample]):
            on_spline = self.which[nearest_sample] == k
            spline, t, p = self.splines[k], self.at[nearest_sample[on_spline]], points[on_spline]
            for _ in range(STEPS):
                point, slope, bend = (spline(t, order) for order in range(3))
                rate = dot(slope, slope)
                t = t + dot(p - point, slope) / np.maximum(rate - dot(p - point, bend), 0.1 * rate)
                t = np.clip(t, spline.x[0], spline.x[-1])
            feet[on_spline] = spline(t)
        return feet


ERROR = 5e-5  # mm; maximum deviation of a patch from its face
KINK = np.radians(1.0)  # minimum angle of a crease along a knot line


def patch_of(face: Any, where: str) -> Patch:
    """Return the patch of a face, with undetermined sign.

    Surfaces of revolution and extrusion are converted to splines exactly. Raises InputError
    ROUGH_WALL if the spline deviates from the face or has a crease.
    """
    surface = face.Surface
    kind = surface.TypeId.removeprefix("Part::Geom")
    if kind == "Plane":
        return Patch(PLANE, (), _frame(surface.Position, surface.Axis))
    if kind == "Cylinder":
        return Patch(
            CYLINDER,
            (float(surface.Radius),),
            _frame(surface.Center, surface.Axis),
            periods=(TURN, 0.0),
        )
    if kind == "Cone":
        sizes = (float(surface.Radius), float(surface.SemiAngle))
        return _checked(
            Patch(CONE, sizes, _frame(surface.Center, surface.Axis), periods=(TURN, 0.0)),
            face,
            where,
        )
    if kind == "Sphere":
        return Patch(
            SPHERE, (float(surface.Radius),), _frame(surface.Center, (0, 0, 1)), periods=(TURN, 0.0)
        )
    if kind == "Toroid" and surface.MajorRadius > surface.MinorRadius:
        sizes = (float(surface.MajorRadius), float(surface.MinorRadius))
        return Patch(TORUS, sizes, _frame(surface.Center, surface.Axis), periods=(TURN, TURN))
    patch = _spline(face, where)
    _refuse_kinks(patch, face, where)
    return _checked(patch, face, where)


def _frame(origin: Any, axis: Any) -> Array:
    z = np.array(tuple(axis), dtype=float)
    z /= np.linalg.norm(z)
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    frame = np.eye(4)
    frame[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    frame[:3, 3] = tuple(origin)
    return frame


def _spline(face: Any, where: str) -> Patch:
    surface = face.Surface
    if surface.TypeId != "Part::GeomBSplineSurface":
        try:
            surface = face.toNurbs().Faces[0].Surface
            if surface.TypeId != "Part::GeomBSplineSurface":
                surface = surface.toBSpline()
        except (RuntimeError, AttributeError, Part.OCCError):
            raise InputError(
                "ROUGH_WALL",
                where,
                "the surface of the face ({}) cannot be converted to a spline; rebuild the face, "
                "for instance as a loft",
                surface.TypeId.removeprefix("Part::Geom"),
            ) from None
    else:
        surface = surface.copy()
    if surface.isUPeriodic() or surface.isVPeriodic():
        # segment() removes periodicity and repeats the ends, unlike setUNotPeriodic for one span
        surface.segment(*surface.bounds())
    weights = np.array(surface.getWeights(), dtype=float)
    points = np.array([[tuple(point) for point in row] for row in surface.getPoles()])
    poles = np.concatenate([points * weights[..., None], weights[..., None]], axis=-1)
    knots_u, knots_v = (
        np.repeat(np.array(knots), np.array(counts))
        for knots, counts in (
            (surface.getUKnots(), surface.getUMultiplicities()),
            (surface.getVKnots(), surface.getVMultiplicities()),
        )
    )
    low_u, high_u, low_v, high_v = surface.bounds()
    periods = (
        high_u - low_u if surface.isUClosed() else 0.0,
        high_v - low_v if surface.isVClosed() else 0.0,
    )
    return Patch(SPLINE, (), np.eye(4), 1.0, periods, knots_u, knots_v, poles)


def _refuse_kinks(patch: Patch, face: Any, where: str) -> None:
    """Raise InputError ROUGH_WALL if the spline has a crease along a knot line."""
    ranges = np.reshape(face.ParameterRange, (2, 2))
    for axis, (knots, count) in enumerate(
        ((patch.knots_u, patch.poles.shape[0]), (patch.knots_v, patch.poles.shape[1]))
    ):
        degree = len(knots) - count - 1
        knot_values, times = np.unique(knots, return_counts=True)
        low, high = max(ranges[axis, 0], knots[degree]), min(ranges[axis, 1], knots[count])
        step = 1e-7 * (knots[count] - knots[degree])
        for knot in knot_values[
            (times >= degree) & (knot_values > low + 9.0 * step) & (knot_values < high - 9.0 * step)
        ]:
            uv = np.empty((9, 2))
            uv[:, axis], uv[:, 1 - axis] = knot, np.linspace(*ranges[1 - axis], 11)[1:-1]
            side = step * np.eye(2)[axis]
            (points, normals_before), (_, normals_after) = patch.at(uv - side), patch.at(uv + side)
            turn = np.arccos(np.clip((normals_before * normals_after).sum(axis=1), -1.0, 1.0))
            if turn.max() > KINK:
                position = ", ".join(f"{number:.4g}" for number in points[np.argmax(turn)])
                raise InputError(
                    "ROUGH_WALL",
                    where,
                    "at ({}) the face has an inner crease of {:.3g} deg; round the crease, or "
                    "divide the face there and deposit its parts in turn",
                    position,
                    np.degrees(turn.max()),
                )


def _checked(patch: Patch, face: Any, where: str) -> Patch:
    """Return the patch if it matches the surface of the face. Raises InputError ROUGH_WALL."""
    low_u, high_u, low_v, high_v = face.ParameterRange
    surface = face.Surface
    parameters = [
        (u, v)
        for u in np.linspace(low_u, high_u, 9)[1:-1]
        for v in np.linspace(low_v, high_v, 9)[1:-1]
    ]
    points = np.array([tuple(surface.value(u, v)) for u, v in parameters])
    off = np.linalg.norm(patch.at(patch.inverse(points, np.array(parameters)))[0] - points, axis=1)
    if off.max() > ERROR:
        position = ", ".join(f"{number:.4g}" for number in points[np.argmax(off)])
        raise InputError(
            "ROUGH_WALL",
            where,
            "at ({}) the spline that approximates the face is {:.3g} mm off, more than {:g} mm; "
            "rebuild the face, for instance as a loft or a sweep",
            position,
            off.max(),
            ERROR,
        )
    return patch
