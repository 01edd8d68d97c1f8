# SPDX-License-Identifier: LGPL-2.1-or-later
"""Candidate axes of a shape of revolution."""

from __future__ import annotations

from typing import Any

import FreeCAD  # noqa: F401  before Part, which crashes without
import numpy as np
import Part

from ...core.types import Array, Mask
from .cylindrical import as_array, edge_points

Axis = tuple[Array, Array]

# surface types with a known axis or without an axis
ANALYTIC = tuple(
    "Part::Geom" + kind
    for kind in ("Plane", "Cylinder", "Cone", "Sphere", "Toroid", "SurfaceOfRevolution")
)
SAME_ANGLE = 1e-6  # rad; maximum angle between coincident axes
SAME_LINE = 1e-4  # mm; maximum distance between coincident axes


def candidates(faces: list[Any]) -> list[Axis]:
    """Return candidate axes as (point (3,), unit direction (3,)), the most likely axis first.

    Axes of analytic and revolved surfaces are weighted by area; axes of circular edges have lower
    weights. Axes fitted to surface normals come last and apply to any surface type.
    """
    ordered = [axis for axis, _ in sorted(_weighed(faces), key=lambda pair: -pair[1])][:6]
    free = [face for face in faces if face.Surface.TypeId not in ANALYTIC]
    for group in [[face] for face in sorted(free, key=lambda face: -face.Area)[:3]] + [faces]:
        fitted = from_normals(group)
        if fitted is not None and not any(_same(fitted, axis) for axis in ordered):
            ordered.append(fitted)
    return ordered


def _weighed(faces: list[Any]) -> list[tuple[Axis, float]]:
    """Return the distinct axes of faces and their edges, with total weights."""
    axes: list[tuple[Axis, float]] = []
    rows = np.zeros(
        (64, 6)
    )  # axes as rows for a vectorised comparison: a plate may have hundreds of holes
    for face in faces:
        for axis, weight in _face_axes(face):
            same = np.flatnonzero(_alike(rows[: len(axes)], axis))
            if len(same):
                known_axis, total = axes[same[0]]
                axes[same[0]] = (known_axis, total + weight)
                continue
            if len(axes) == len(rows):
                rows = np.vstack([rows, np.zeros_like(rows)])
            rows[len(axes)] = np.concatenate(axis)
            axes.append((axis, weight))
    return axes


def _face_axes(face: Any) -> list[tuple[Axis, float]]:
    surface, area = face.Surface, face.Area
    axes = []
    if surface.TypeId == "Part::GeomSurfaceOfRevolution":
        axes.append((_axis(surface.Location, surface.Direction), area + 1.0))
    elif surface.TypeId in ("Part::GeomCylinder", "Part::GeomCone", "Part::GeomToroid"):
        axes.append((_axis(surface.Center, surface.Axis), area))
    elif surface.TypeId == "Part::GeomSphere":
        axes.append((_axis(surface.Center, surface.Axis), 1e-6 * area))
    for edge in face.Edges:
        if edge.Degenerated or edge.isSeam(face):
            continue
        if edge.Curve.TypeId == "Part::GeomCircle":
            axes.append(
                (_axis(edge.Curve.Center, edge.Curve.Axis), 1e-3 * edge.Length * edge.Curve.Radius)
            )
        elif edge.Curve.TypeId == "Part::GeomBSplineCurve":
            fitted = _circle_through(edge_points(edge, 13))
            if fitted is not None:
                axes.append((fitted, 1e-4 * edge.Length**2))
    return axes


def _circle_through(points: Array) -> Axis | None:
    """Return the axis of the circle through points (n, 3), None if they are not on a circle."""
    middle = points.mean(axis=0)
    _, sizes, basis = np.linalg.svd(points - middle, full_matrices=False)
    if sizes[1] < 1e-6 * sizes[0] or sizes[2] > 1e-7 * sizes[0]:
        return None
    flat = (points - middle) @ basis[:2].T
    # |p|^2 = 2 c.p + k is linear in the centre c and k
    solved = np.linalg.lstsq(
        np.c_[2.0 * flat, np.ones(len(flat))], (flat**2).sum(axis=1), rcond=None
    )[0]
    radii = np.hypot(*(flat - solved[:2]).T)
    if np.ptp(radii) > 1e-6 * radii.mean():
        return None
    return middle + solved[:2] @ basis[:2], basis[2]


def _axis(point: Any, direction: Any) -> Axis:
    z = np.array(tuple(direction), dtype=np.float64)
    return np.array(tuple(point), dtype=np.float64), z / np.linalg.norm(z)


def _same(axis: Axis, other_axis: Axis) -> bool:
    return bool(_alike(np.concatenate(axis)[None], other_axis)[0])


def _alike(rows: Array, axis: Axis) -> Mask:
    """Return a mask (n,) of the axes (n, 6), points and directions, that coincide with `axis`."""
    offset, along = rows[:, :3] - axis[0], rows[:, 3:]
    across = offset - (offset * along).sum(axis=1)[:, None] * along
    turned = np.linalg.norm(np.cross(along, axis[1]), axis=1)
    return np.asarray((turned < SAME_ANGLE) & (np.linalg.norm(across, axis=1) < SAME_LINE))


def from_normals(faces: list[Any]) -> Axis | None:
    """Return the line that every surface normal meets, None without such a line.

    On a sphere, return the vertical line through the centre. A normal n at p meets the axis (point
    c, direction a) if n . (c x a) + (p x n) . a = 0. With m = c x a, this is linear in (a, m): the
    axis is the null direction of all samples with zero pitch (a . m = 0).
    """
    points, normals = [], []
    for face in faces:
        u0, u1, v0, v1 = face.ParameterRange
        for u in np.linspace(u0, u1, 9)[1:-1]:
            for v in np.linspace(v0, v1, 9)[1:-1]:
                try:
                    normals.append(face.Surface.normal(u, v))
                except (RuntimeError, Part.OCCError):
                    continue  # degenerate point of the surface
                points.append(face.Surface.value(u, v))
    p, n = as_array(points), as_array(normals)
    good = np.isfinite(n).all(axis=1)
    p, n = p[good], n[good]
    if len(p) < 6:
        return None
    middle = p.mean(axis=0)
    size = np.abs(p - middle).max()
    rows = np.hstack([np.cross((p - middle) / size, n), n])
    # full_matrices=False avoids a square first factor over all samples
    values, vectors = np.linalg.svd(rows, full_matrices=False)[1:]
    exact = int((values < 1e-6 * values[0]).sum())
    # a cylinder that is not quite round is still exactly invariant to translation along its axis,
    # so try the next best motion too
    for count in (max(exact, 1), max(exact, 1) + 1):
        null = vectors[-count:]
        directions = null[:, :3]
        strength, basis = np.linalg.svd(directions)[1:]
        if strength[0] > 1e-6:
            break
    else:
        return None
    if len(strength) > 1 and strength[1] > 1e-6:
        return _through_centre(middle, size, null)
    a = basis[0]
    moment = np.linalg.lstsq(directions.T, a, rcond=None)[0] @ null[:, 3:]
    moment = moment - (moment @ a) * a
    return middle + size * np.cross(a, moment), a


def _through_centre(middle: Array, size: float, null: Array) -> Axis | None:
    """Return the vertical axis through the centre of a sphere-like shape, None without a centre."""
    # m = c x a for every null direction (a, m) is linear in the centre c
    rows = np.vstack([np.cross(np.eye(3), a).T for a in null[:, :3]])
    centre, _, rank, _ = np.linalg.lstsq(rows, null[:, 3:].ravel(), rcond=None)
    off = np.abs(rows @ centre - null[:, 3:].ravel()).max()
    return (middle + size * centre, np.array([0.0, 0.0, 1.0])) if rank == 3 and off < 1e-6 else None
