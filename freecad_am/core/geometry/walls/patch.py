# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smooth pieces of a wall: exact surfaces, with nearest points and normals for many points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array, Index
from ..columns import columns
from .surface import dot

# ---- Rational and non-rational tensor product B-spline surfaces, evaluated at many parameters at
# once (Piegl and Tiller, The NURBS Book, algorithms A2.2 and A3.6). Surfaces are extrapolated
# linearly beyond their knots, so points may be past the edge of the surface


def derivatives(
    knots: tuple[Array, Array], poles: Array, u: Array, v: Array
) -> tuple[Array, Array, Array]:
    """Evaluate a rational B-spline surface, extrapolated linearly outside its range.

    Parameters
    ----------
    knots : tuple of array
        Knots in both directions, with repeated end knots.
    poles : (k, l, 4) array
        Poles as w x, w y, w z, w.
    u, v : (n,) array
        Parameters.

    Returns
    -------
    point : (n, 3) array
        Points, mm.
    along, around : (n, 3) array
        Derivatives along u and v.
    """
    inside = [
        np.clip(parameter, *bounds(knot, poles.shape[axis]))
        for axis, (knot, parameter) in enumerate(zip(knots, (u, v)))
    ]
    point, along, around, twist = _rational(knots, poles, *inside)
    du, dv = (u - inside[0])[:, None], (v - inside[1])[:, None]
    if du.any() or dv.any():
        point = point + du * along + dv * around + du * dv * twist
        along, around = along + dv * twist, around + du * twist
    return point, along, around


def bounds(knots: Array, count: int) -> tuple[float, float]:
    """Return the parameter range of a B-spline direction.

    Parameters
    ----------
    knots : (m,) array
        Knots of the direction.
    count : int
        Number of poles in the direction.

    Returns
    -------
    low, high : float
        The range.
    """
    degree = len(knots) - count - 1
    return float(knots[degree]), float(knots[count])


def _rational(
    knots: tuple[Array, Array], poles: Array, u: Array, v: Array
) -> tuple[Array, Array, Array, Array]:
    first_u, basis_u = _basis(knots[0], poles.shape[0], u)
    first_v, basis_v = _basis(knots[1], poles.shape[1], v)
    rows = first_u[:, None] + np.arange(basis_u.shape[2])
    columns = first_v[:, None] + np.arange(basis_v.shape[2])
    local = poles[rows[:, :, None], columns[:, None, :]]
    rows_summed = np.einsum("nap,npqk->naqk", basis_u.transpose(1, 0, 2), local)
    all_ = np.einsum("nbq,naqk->nabk", basis_v.transpose(1, 0, 2), rows_summed)
    weight = all_[:, 0, 0, 3:]
    point = all_[:, 0, 0, :3] / weight
    along = (all_[:, 1, 0, :3] - all_[:, 1, 0, 3:] * point) / weight
    around = (all_[:, 0, 1, :3] - all_[:, 0, 1, 3:] * point) / weight
    twist = (
        all_[:, 1, 1, :3]
        - all_[:, 1, 1, 3:] * point
        - all_[:, 1, 0, 3:] * around
        - all_[:, 0, 1, 3:] * along
    ) / weight
    return point, along, around, twist


def _basis(knots: Array, count: int, parameter: Array) -> tuple[Index, Array]:
    """Return the first of the degree + 1 active poles for each parameter (n,), and basis values.

    Basis values are (2, n, degree + 1): for the point and for the derivative.
    """
    degree = len(knots) - count - 1
    span = np.clip(np.searchsorted(knots, parameter, side="right") - 1, degree, count - 1)
    values = np.ones((len(parameter), 1))
    lower = values
    for p in range(1, degree + 1):
        steps = np.arange(1, p + 1)
        to_left = parameter[:, None] - knots[span[:, None] + 1 - steps]
        right = knots[span[:, None] + steps] - parameter[:, None]
        share = values / (right + to_left[:, ::-1])
        lower = values
        values = np.zeros((len(parameter), p + 1))
        values[:, :-1] += right * share
        values[:, 1:] += to_left[:, ::-1] * share
    slopes = np.zeros_like(values)
    if degree:
        steps = np.arange(1, degree + 1)
        width = knots[span[:, None] + steps] - knots[span[:, None] + steps - degree]
        share = degree * lower / width
        slopes[:, 1:] += share
        slopes[:, :-1] -= share
    return span - degree, np.stack([values, slopes])


PLANE, CYLINDER, CONE, SPHERE, TORUS, SPLINE = (
    "plane",
    "cylinder",
    "cone",
    "sphere",
    "torus",
    "spline",
)
STEPS = 40
MIN_MOVE_MM = 1e-10  # mm; a shorter step ends the search for a nearest point
SAMPLES = 6  # samples per knot span, as starts of the search


@dataclass(frozen=True, eq=False)
class Patch:
    """A surface in part coordinates, mm and rad.

    u and v in the patch frame (4, 4) have the meaning of OpenCASCADE, by kind and sizes: PLANE ():
    u, v are X and Y. CYLINDER (radius): azimuth u, height v. CONE (radius at
    v = 0, half angle, growing with v): azimuth, length along the side. SPHERE (radius):
    azimuth, latitude. TORUS (bend, tube): azimuth, angle around the tube from its outside.
    SPLINE (): the B-spline of the knots and the poles (k, l, 4) as w x, w y, w z, w.

    sign: +1 if the cross product of the derivatives along u and v points to the wall's outer side,
    else -1. periods: periods of u and v, 0 where the surface does not close.
    """

    kind: str
    sizes: tuple[float, ...]
    frame: Array
    sign: float = 1.0
    periods: tuple[float, float] = (0.0, 0.0)
    knots_u: Array | None = None
    knots_v: Array | None = None
    poles: Array | None = None

    def inverse(self, points: Array, start: Array | None = None) -> Array:
        """Return the parameters of the surface points nearest to points.

        Parameters
        ----------
        points : (n, 3) array
            Points in part coordinates, mm.
        start : (n, 2) array or None, optional
            Start parameters of an iterative search; None for the nearest sample.

        Returns
        -------
        (n, 2) array
            u and v.
        """
        x, y, z = columns(self._local(points))
        if self.kind == PLANE:
            return np.stack([x, y], axis=1)
        if self.kind == SPLINE:
            return self._search(points, self._nearest_sample(points) if start is None else start)
        azimuth, reach = np.arctan2(y, x), np.hypot(x, y)
        if self.kind == CYLINDER:
            return np.stack([azimuth, z], axis=1)
        if self.kind == CONE:
            radius, slope = self.sizes
            along = (reach - radius) * np.sin(slope) + z * np.cos(slope)
            apex = -radius / np.sin(slope)
            return np.stack(
                [azimuth, np.maximum(along, apex) if slope > 0.0 else np.minimum(along, apex)],
                axis=1,
            )
        return np.stack(
            [azimuth, np.arctan2(z, reach - (self.sizes[0] if self.kind == TORUS else 0.0))], axis=1
        )

    def at(self, uv: Array) -> tuple[Array, Array]:
        """Evaluate the surface.

        Parameters
        ----------
        uv : (n, 2) array
            Parameters u and v.

        Returns
        -------
        points : (n, 3) array
            Points in part coordinates, mm.
        normals : (n, 3) array
            Unit normals to the outer side.
        """
        if self.kind == SPLINE:
            point, along, around = self._derivatives(uv)
            return point, self.sign * self._spline_normal(uv, np.cross(along, around))
        u, v = columns(uv)
        zero = np.zeros_like(u)
        if self.kind == PLANE:
            return self._to_part(
                np.stack([u, v, zero], axis=1), np.stack([zero, zero, zero + 1.0], axis=1)
            )
        out, axis = np.stack([np.cos(u), np.sin(u), zero], axis=1), np.array([0.0, 0.0, 1.0])
        if self.kind == CYLINDER:
            return self._to_part(self.sizes[0] * out + v[:, None] * axis, out)
        if self.kind == CONE:
            radius, slope = self.sizes
            point = (radius + v * np.sin(slope))[:, None] * out + (v * np.cos(slope))[
                :, None
            ] * axis
            return self._to_part(point, np.cos(slope) * out - np.sin(slope) * axis)
        normal = np.cos(v)[:, None] * out + np.sin(v)[:, None] * axis
        if self.kind == SPHERE:
            return self._to_part(self.sizes[0] * normal, normal)
        return self._to_part(self.sizes[0] * out + self.sizes[1] * normal, normal)

    def area(self, uv: Array) -> Array:
        """Return the area of a spline surface per unit of u and v.

        Parameters
        ----------
        uv : (n, 2) array
            Parameters u and v.

        Returns
        -------
        (n,) array
            Area relative to its typical value.
        """
        _, along, around = self._derivatives(uv)
        share: Array = np.linalg.norm(np.cross(along, around), axis=1) / self._typical_area
        return share

    def unwrap(self, uv: Array) -> Array:
        """Shift the parameters of triangles by periods, next to those of the first corner.

        Parameters
        ----------
        uv : (m, 3, 2) array
            Parameters of the corners.

        Returns
        -------
        (m, 3, 2) array
            Shifted parameters.
        """
        uv = uv.copy()
        for axis, period in enumerate(self.periods):
            if period > 0.0:
                gap = uv[:, 1:, axis] - uv[:, :1, axis]
                uv[:, 1:, axis] -= period * np.round(gap / period)
        return uv

    def _local(self, points: Array) -> Array:
        local: Array = (points - self.frame[:3, 3]) @ self.frame[:3, :3]
        return local

    def _to_part(self, points: Array, normals: Array) -> tuple[Array, Array]:
        turn = self.frame[:3, :3].T
        return points @ turn + self.frame[:3, 3], self.sign * (normals @ turn)

    # ---- splines, whose poles are in part coordinates

    @cached_property
    def _spline(self) -> tuple[tuple[Array, Array], Array]:
        if self.knots_u is None or self.knots_v is None or self.poles is None:
            raise ValueError("a spline needs knots and poles")
        return (self.knots_u, self.knots_v), self.poles

    @cached_property
    def bounds(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Parameter ranges of a spline in u and v."""
        (u, v), poles = self._spline
        return bounds(u, poles.shape[0]), bounds(v, poles.shape[1])

    def _derivatives(self, uv: Array) -> tuple[Array, Array, Array]:
        knots, poles = self._spline
        uv = uv.copy()
        for axis, period in enumerate(self.periods):
            if period > 0.0:
                low = self.bounds[axis][0]
                uv[:, axis] = low + np.mod(uv[:, axis] - low, period)
        return derivatives(knots, poles, uv[:, 0], uv[:, 1])

    @cached_property
    def _samples(self) -> tuple[cKDTree, Array]:
        knots, _ = self._spline
        lines = []
        for knot, (low, high) in zip(knots, self.bounds):
            spans = np.unique(np.clip(knot, low, high))
            fine = spans[:-1, None] + np.diff(spans)[:, None] * (np.arange(SAMPLES) + 0.5) / SAMPLES
            lines.append(np.r_[low, fine.ravel(), high])
        uv = np.stack([grid.ravel() for grid in np.meshgrid(*lines, indexing="ij")], axis=1)
        return cKDTree(self._derivatives(uv)[0]), uv

    def _nearest_sample(self, points: Array) -> Array:
        tree, uv = self._samples
        nearest: Array = uv[tree.query(points)[1]]
        return nearest

    def _search(self, points: Array, start: Array) -> Array:
        """Search by Gauss-Newton; converged points skip further steps."""
        uv, busy = start.copy(), np.arange(len(points))
        reach = np.array([high - low for low, high in self.bounds])
        for _ in range(STEPS):
            feet, along, around = self._derivatives(uv[busy])
            gap = points[busy] - feet
            a, b, c = dot(along, along), dot(along, around), dot(around, around)
            p, q = dot(along, gap), dot(around, gap)
            determinant = np.maximum(a * c - b * b, 1e-14 * a * c + 1e-300)
            step = np.stack([c * p - b * q, a * q - b * p], axis=1) / determinant[:, None]
            step = np.clip(step, -0.1 * reach, 0.1 * reach)
            uv[busy] += step
            moved = np.abs(step[:, 0]) * np.sqrt(a) + np.abs(step[:, 1]) * np.sqrt(c)
            busy = busy[moved > MIN_MOVE_MM]
            if not len(busy):
                break
        return uv

    def _spline_normal(self, uv: Array, cross: Array) -> Array:
        """Return unit normals; at degenerate points, the normals slightly inside the surface."""
        length = np.linalg.norm(cross, axis=1)
        thin = np.flatnonzero(
            length < 1e-9 * max(float(length.max(initial=0.0)), self._typical_area)
        )
        if len(thin):
            middle = np.array([0.5 * (low + high) for low, high in self.bounds])
            _, along, around = self._derivatives(uv[thin] + 1e-4 * (middle - uv[thin]))
            cross[thin] = np.cross(along, around)
            length[thin] = np.linalg.norm(cross[thin], axis=1)
        unit: Array = cross / np.maximum(length, 1e-300)[:, None]
        return unit

    @cached_property
    def _typical_area(self) -> float:
        _, along, around = self._derivatives(self._samples[1])
        return float(np.median(np.linalg.norm(np.cross(along, around), axis=1)))
