# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces of a shape that are certainly not of revolution about an axis, judged by a few normals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import Part

from ...core.types import Array, Index, Mask
from .cylindrical import AxisFrame, as_array
from .patch import planar

ACROSS = 5  # places along each parameter of a face that is not flat
SLOPE = 0.2  # of a normal around the axis; rounding of files is far below
NARROW = 0.1  # mm; a face as narrow as this may be of revolution within its tolerance all the same
ON_AXIS = 1e-3  # mm


class Normals(NamedTuple):
    """Points (n, 3) on faces, their unit normals (n, 3), and the number (n,) of the face of each.
    flat: (faces,) bool; wide: (faces,) bool, faces that are wide enough for a judgement by their
    normals.
    """

    points: Array
    normals: Array
    face: Index
    flat: Mask
    wide: Mask


def normals_of(faces: Sequence[Any]) -> Normals:
    """A few normals of each face, taken where the face is and not only its surface."""
    flat = np.array([planar(face) for face in faces], dtype=bool)
    points: list[Any] = []
    directions: list[Any] = []
    counts = []
    for face, is_flat in zip(faces, flat.tolist(), strict=True):
        samples = _flat(face) if is_flat else _curved(face)
        points += [point for point, _ in samples]
        directions += [normal for _, normal in samples]
        counts.append(len(samples))
    wide = np.array([2.0 * face.Area > NARROW * face.Length for face in faces], dtype=bool)
    return Normals(
        as_array(points), as_array(directions), np.repeat(np.arange(len(faces)), counts), flat, wide
    )


def surely_off(samples: Normals, frame: AxisFrame) -> Mask:
    """(faces,) bool: faces with a normal that leans around the axis, so that they are not of
    revolution about it; planes along the axis, which only bound a part of a turn, are excluded.
    """
    points, normals = frame.local(samples.points), samples.normals @ frame.rotation
    radius = np.hypot(points[:, 0], points[:, 1])
    around = np.abs(points[:, 0] * normals[:, 1] - points[:, 1] * normals[:, 0]) / np.maximum(
        radius, ON_AXIS
    )
    through = np.abs((points[:, :2] * normals[:, :2]).sum(axis=1)) < NARROW
    ends = samples.flat[samples.face] & through & (np.abs(normals[:, 2]) < SLOPE)
    leans = (around > SLOPE) & (radius > NARROW) & ~ends
    return np.bincount(samples.face[leans], minlength=len(samples.flat)).astype(bool) & samples.wide


def _flat(face: Any) -> list[tuple[Any, Any]]:
    """Starts of its first edges: its normal is the same everywhere."""
    u, v = (0.5 * (low + high) for low, high in (face.ParameterRange[:2], face.ParameterRange[2:]))
    return [
        (edge.valueAt(edge.FirstParameter), face.Surface.normal(u, v)) for edge in face.Edges[:4]
    ]


def _curved(face: Any) -> list[tuple[Any, Any]]:
    u0, u1, v0, v1 = face.ParameterRange
    inner = (np.arange(ACROSS) + 0.5) / ACROSS
    samples = []
    for u in (u0 + inner * (u1 - u0)).tolist():
        for v in (v0 + inner * (v1 - v0)).tolist():
            if face.isPartOfDomain(u, v):
                try:
                    samples.append((face.Surface.value(u, v), face.Surface.normal(u, v)))
                except (RuntimeError, Part.OCCError):
                    continue  # where the surface is degenerate
    return samples
