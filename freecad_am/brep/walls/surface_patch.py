# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces as patches: their exact surfaces as numbers that the core evaluates without FreeCAD."""

from __future__ import annotations

from typing import Any

import numpy as np
import Part

from freecad_am.core.geometry.angles import TURN
from freecad_am.core.types import Array

from ...core.geometry.walls.patch import CONE, CYLINDER, PLANE, SPHERE, SPLINE, TORUS, Patch
from ...core.issues import InputError

ERROR = 5e-5  # mm that a patch may be off its face
KINK = np.radians(1.0)  # a surface that turns more across a line of knots has an edge there


def patch_of(face: Any, where: str) -> Patch:
    """The patch of a face; its sign is still open. Surfaces of revolution and extrusion become splines, exactly.

    Raises InputError ROUGH_WALL where the spline departs from the face, or has an edge.
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
                "its surface ({}) cannot be converted to a spline; rebuild the face, for instance "
                "as a loft",
                surface.TypeId.removeprefix("Part::Geom"),
            ) from None
    else:
        surface = surface.copy()
    if surface.isUPeriodic() or surface.isVPeriodic():
        # segment makes it not periodic with its ends repeated, which setUNotPeriodic does not do of a single span
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
    """InputError ROUGH_WALL where the spline has an edge along a line of knots."""
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
                    "at ({}) the face has an inner crease of {:.3g} deg; round it, or divide the "
                    "face there and deposit its parts in turn",
                    position,
                    np.degrees(turn.max()),
                )


def _checked(patch: Patch, face: Any, where: str) -> Patch:
    """The patch, if it is the face's surface. InputError ROUGH_WALL."""
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
            "at ({}) the spline that approximates it is {:.3g} mm off, more than {:g} mm; "
            "rebuild the face, for instance as a loft or a sweep",
            position,
            off.max(),
            ERROR,
        )
    return patch
