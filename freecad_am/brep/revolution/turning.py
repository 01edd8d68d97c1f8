# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which faces of a shape certainly do not turn about an axis, told by a few of their normals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import Part

from freecad_am.core.types import Array, Index, Mask

from .cylindrical import AxisFrame, as_array
from .patch import planar

ACROSS = 5  # places along each parameter of a face that is not flat
SLOPE = 0.2  # of a normal around the axis; rounding of files is far below
NARROW = 0.1  # mm; a face as narrow as this may be of revolution within its tolerance all the same
ON_AXIS = 1e-3  # mm


class Normals(NamedTuple):
    """Places (n, 3) on faces, the unit normals (n, 3) there, and the number (n,) of the face of each. flat: (faces,) bool;
    wide: (faces,) bool, which are wide enough to be told by their normals."""

    points: Array
    normals: Array
    face: Index
    flat: Mask
    wide: Mask


def normals_of(faces: Sequence[Any]) -> Normals:
    """A few normals of each face, taken where the face is and not only its surface."""
    flat = np.array([planar(face) for face in faces], dtype=bool)
    places: list[Any] = []
    directions: list[Any] = []
    counts = []
    for face, is_flat in zip(faces, flat.tolist(), strict=True):
        found = _flat(face) if is_flat else _curved(face)
        places += [point for point, _ in found]
        directions += [normal for _, normal in found]
        counts.append(len(found))
    wide = np.array([2.0 * face.Area > NARROW * face.Length for face in faces], dtype=bool)
    return Normals(
        as_array(places), as_array(directions), np.repeat(np.arange(len(faces)), counts), flat, wide
    )


def surely_off(of: Normals, frame: AxisFrame) -> Mask:
    """(faces,) bool: faces that lean around the axis somewhere, so that they are not of revolution about it; those that lie
    along it, and only end a part of a turn, are not among them."""
    points, normals = frame.local(of.points), of.normals @ frame.rotation
    radius = np.hypot(points[:, 0], points[:, 1])
    around = np.abs(points[:, 0] * normals[:, 1] - points[:, 1] * normals[:, 0]) / np.maximum(
        radius, ON_AXIS
    )
    through = np.abs((points[:, :2] * normals[:, :2]).sum(axis=1)) < NARROW
    ends = of.flat[of.face] & through & (np.abs(normals[:, 2]) < SLOPE)
    leans = (around > SLOPE) & (radius > NARROW) & ~ends
    return np.bincount(of.face[leans], minlength=len(of.flat)).astype(bool) & of.wide


def _flat(face: Any) -> list[tuple[Any, Any]]:
    """Starts of its first edges: its normal is the same everywhere."""
    u, v = (0.5 * (low + high) for low, high in (face.ParameterRange[:2], face.ParameterRange[2:]))
    return [
        (edge.valueAt(edge.FirstParameter), face.Surface.normal(u, v)) for edge in face.Edges[:4]
    ]


def _curved(face: Any) -> list[tuple[Any, Any]]:
    u0, u1, v0, v1 = face.ParameterRange
    inner = (np.arange(ACROSS) + 0.5) / ACROSS
    found = []
    for u in (u0 + inner * (u1 - u0)).tolist():
        for v in (v0 + inner * (v1 - v0)).tolist():
            if face.isPartOfDomain(u, v):
                try:
                    found.append((face.Surface.value(u, v), face.Surface.normal(u, v)))
                except (RuntimeError, Part.OCCError):
                    continue  # where the surface is degenerate
    return found
