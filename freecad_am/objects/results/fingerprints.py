# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes and meshes as texts that change with them, but not with the last digits that saving drops.

A stage asks for those of its inputs at each recompute, whatever was touched. So the last ones are kept: those of shapes as
long as the kernel's own object behind them, and those of their faces, are the same ones: a macro may put further shapes
into a compound in place, but no face is changed so; those of meshes, which are, by their bytes.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from typing import Any

import numpy as np

from ..shapes.bodies import body_of, global_shape, shape_of
from ..shapes.meshes import is_mesh, mesh_of
from ..shapes.places import outer_matrix

MOST_KEPT = 64  # shapes, and meshes

_shapes: list[
    tuple[Any, tuple[Any, ...], str]
] = []  # of an object, what else decides, text; the last asked for first
_meshes: dict[str, str] = {}


def fingerprint(source: Any) -> str:
    """The text of an object's solid or mesh, where it stands in the document. InputError NO_SHAPE, NO_FACES."""
    return _mesh_fingerprint(source) if is_mesh(source) else shape_fingerprint(source)


def shape_fingerprint(source: Any) -> str:
    """The text of an object's shape, where it stands in the document. InputError NO_SHAPE."""
    shape = shape_of(source)
    parts = tuple(part.hashCode() for part in shape.Faces or shape.Edges or shape.Vertexes)
    rest = (
        parts,
        shape.Orientation,
        shape.Placement.toMatrix().A,
        outer_matrix(source).tobytes(),
    )
    for k, (kept, decided, text) in enumerate(_shapes):
        if kept.isPartner(shape) and decided == rest:
            _shapes.insert(0, _shapes.pop(k))
            return text
    text = _of_shape(global_shape(source))
    _shapes.insert(0, (shape, rest, text))
    del _shapes[MOST_KEPT:]
    return text


def _of_shape(shape: Any) -> str:
    lines = [f"{shape.ShapeType} {len(shape.Faces)} {len(shape.Edges)} {len(shape.Vertexes)}"]
    for face in shape.Faces:
        inertia = face.MatrixOfInertia
        kind = f"{face.Surface.TypeId} {face.Orientation}"
        lines.append(
            f"{kind} {face.Area:.8g} {digits(face.CenterOfMass)} {inertia.A11:.6g} {inertia.A33:.6g}"
        )
    lines += [f"{edge.Length:.8g}" for edge in shape.Edges]
    lines += [digits(vertex.Point) for vertex in shape.Vertexes]
    return "\n".join(lines)


def _mesh_fingerprint(source: Any) -> str:
    mesh, frame = mesh_of(source)
    asked = f"{_digest(mesh)} {frame.tobytes()}"
    if asked not in _meshes:
        body = body_of(source)
        rounded = np.round(body.vertices, 4) + 0.0
        _meshes[asked] = hashlib.sha256(rounded.tobytes() + body.triangles.tobytes()).hexdigest()
        for oldest in list(_meshes)[:-MOST_KEPT]:
            del _meshes[oldest]
    return _meshes[asked]


def _digest(mesh: Any) -> str:
    """Of all bytes of a mesh and its own placement."""
    handle, path = tempfile.mkstemp(suffix=".bms")
    os.close(handle)
    try:
        mesh.write(path)
        with open(path, "rb") as file:
            return hashlib.sha256(
                file.read() + repr(mesh.Placement.toMatrix().A).encode()
            ).hexdigest()
    finally:
        os.remove(path)


def digits(*vectors: Any) -> str:
    """Numbers of vectors to six decimals."""
    return " ".join(f"{round(number, 6) + 0.0:.6f}" for vector in vectors for number in vector)
