# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes and meshes as texts that change with them, but not with the last digits that saving drops.

A stage needs the fingerprints of its inputs at each recompute. So the last ones are cached: for
shapes as long as the kernel's objects of the shape and of its faces are identical (a macro may put
further shapes into a compound in place, but cannot change a face so); for meshes, which can change
in place, by their bytes.
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
] = []  # shape, further criteria, text; most recent first
_meshes: dict[str, str] = {}


def fingerprint(source: Any) -> str:
    """The text of an object's solid or mesh, at its position in the document. InputError NO_SHAPE,
    NO_FACES.
    """
    return _mesh_fingerprint(source) if is_mesh(source) else shape_fingerprint(source)


def shape_fingerprint(source: Any) -> str:
    """The text of an object's shape, at its position in the document. InputError NO_SHAPE."""
    shape = shape_of(source)
    element_codes = tuple(
        element.hashCode() for element in shape.Faces or shape.Edges or shape.Vertexes
    )
    criteria = (
        element_codes,
        shape.Orientation,
        shape.Placement.toMatrix().A,
        outer_matrix(source).tobytes(),
    )
    for k, (cached, decided, text) in enumerate(_shapes):
        if cached.isPartner(shape) and decided == criteria:
            _shapes.insert(0, _shapes.pop(k))
            return text
    text = _shape_text(global_shape(source))
    _shapes.insert(0, (shape, criteria, text))
    del _shapes[MOST_KEPT:]
    return text


def _shape_text(shape: Any) -> str:
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
    cache_key = f"{_digest(mesh)} {frame.tobytes()}"
    if cache_key not in _meshes:
        body = body_of(source)
        rounded = np.round(body.vertices, 4) + 0.0
        _meshes[cache_key] = hashlib.sha256(
            rounded.tobytes() + body.triangles.tobytes()
        ).hexdigest()
        for oldest in list(_meshes)[:-MOST_KEPT]:
            del _meshes[oldest]
    return _meshes[cache_key]


def _digest(mesh: Any) -> str:
    """The digest of all bytes of a mesh and its own placement."""
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
