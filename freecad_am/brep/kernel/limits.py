# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes on which the geometry kernel gives up."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import FreeCAD
import numpy as np
import Part
from scipy.spatial import cKDTree

from ...core.geometry.formatting import place
from ...core.geometry.walls.surface import dot
from ...core.issues import InputError, Text
from ...core.types import Array, Index

# since FreeCAD 1.0, the kernel raises some faults as RuntimeError, the common base class
FAULTS = (Part.OCCError, FreeCAD.Base.CADKernelError, RuntimeError)
FAULTY = "BAD_SHAPE"
MAX_NAMED = 5  # maximum number of face names in a message
SAMPLES = 720  # number of samples on an edge to test for self-crossing
CROSSED = 1e-3  # maximum distance of crossing edge segments, fraction of the step between samples


@contextmanager
def reported(label: str, shape: Any = None) -> Iterator[None]:
    """Within the context, convert faults of the geometry kernel to InputError FAULTY.

    The error names `label`, and the damaged faces or the position of the Part.Shape.
    """
    try:
        yield
    except FAULTS as error:
        what = " ".join(str(error).split()) or type(error).__name__
        raise InputError(
            FAULTY,
            label,
            "the geometry kernel cannot process the shape ({}{}); repair the shape (Part, Check "
            "geometry), or redraw its faces",
            what,
            _damaged(shape),
        ) from error


def _damaged(shape: Any) -> str:
    """Return the damaged faces of a Part.Shape with positions, as text.

    If every face is valid, return the position of the shape.
    """
    faces = list(getattr(shape, "Faces", ()))
    named = []
    for number, face in enumerate(faces, start=1):
        try:
            sound = face.isValid()
        except FAULTS:
            sound = False
        if not sound:
            named.append(Text("Face{} at {} is damaged", number, _middle(face)))
    if named:
        return Text("; {}", Text.joined(", ", named[:MAX_NAMED]))
    if faces:
        return Text("; all {} face(s), about {}, are valid", len(faces), _middle(shape))
    return ""


def _middle(shape: Any) -> str:
    """Return the centre of a shape as text, or a vertex if the bounding box is invalid."""
    try:
        if shape.BoundBox.isValid():
            return place(tuple(shape.BoundBox.Center))
        return place(tuple(shape.Vertexes[0].Point))
    except (*FAULTS, IndexError):
        return "(?)"


def refuse_bare(
    named: Sequence[tuple[str, Any]], owner: Index, label: str, narrow: float = 0.0
) -> None:
    """Raise InputError if the kernel made no triangles for a face.

    The code is SELF_INTERSECTION if an edge of the face crosses itself, else BAD_SHAPE. owner: face
    index (m,) of each triangle. narrow: maximum width, mm, of faces that need no triangles.
    """
    for k, (name, face) in enumerate(named):
        if (owner == k).any() or face.Area < 0.5 * narrow * face.Length:
            continue
        for edge in face.Edges:
            crossing = _crossing(np.array([tuple(point) for point in edge.discretize(SAMPLES)]))
            if crossing is not None:
                raise InputError(
                    "SELF_INTERSECTION",
                    f"{label} {name}",
                    "an edge of the face crosses itself at {}; redraw the edge without "
                    "crossings, or divide the face there and deposit its parts in turn",
                    place(crossing),
                )
        raise InputError(
            FAULTY,
            f"{label} {name}",
            "the geometry kernel cannot triangulate the face, about {}; repair the face (Part, "
            "Check geometry), or redraw it",
            _middle(face),
        )


def _crossing(chain: Array) -> Array | None:
    """Return the point where a chain of points (n, 3) crosses itself, or None."""
    chord = np.diff(chain, axis=0)
    step = float(np.linalg.norm(chord, axis=1).max())
    pairs = cKDTree(chain[:-1] + 0.5 * chord).query_pairs(1.01 * step, output_type="ndarray")
    separation = pairs[:, 1] - pairs[:, 0]
    i, j = pairs[(separation > 2) & (separation < len(chord) - 2)].T
    a, b, gap = chord[i], chord[j], chain[j] - chain[i]
    system = np.stack(
        [np.stack([dot(a, a), -dot(a, b)], axis=1), np.stack([-dot(a, b), dot(b, b)], axis=1)],
        axis=1,
    )
    plain = np.abs(np.linalg.det(system)) > 1e-4 * dot(a, a) * dot(b, b)
    i, j, a, b, gap = (column[plain] for column in (i, j, a, b, gap))
    if not len(i):
        return None
    shares = np.linalg.solve(
        system[plain], np.stack([dot(a, gap), -dot(b, gap)], axis=1)[..., None]
    )[..., 0]
    shares = np.clip(shares, 0.0, 1.0)
    miss = np.linalg.norm(gap + shares[:, 1:] * b - shares[:, :1] * a, axis=1)
    best = int(np.argmin(miss))
    crossing: Array = chain[i[best]] + shares[best, 0] * a[best]
    return crossing if miss[best] < CROSSED * step else None
