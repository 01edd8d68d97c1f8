# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fingerprints of shapes and meshes, independent of the last digits that saving drops.

Each recompute needs the fingerprints of a stage's inputs, so recent fingerprints are cached. A
shape matches if the kernel objects of the shape and its faces are identical: a macro may add shapes
to a compound in place, but cannot change a face in place. A mesh can change in place and matches by
its bytes.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import tempfile
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from typing import Any

import numpy as np

from ..fields import properties
from ..shapes.bodies import body_of, global_shape, is_mesh, mesh_of, shape_of
from ..shapes.places import outer_matrix

MOST_KEPT = 64  # maximum number of cached shapes, and of cached meshes

_shapes: list[
    tuple[Any, tuple[Any, ...], str]
] = []  # shape, further criteria, fingerprint; most recent first
_meshes: dict[str, str] = {}


def fingerprint(source: Any) -> str:
    """Return the fingerprint of an object's shape or mesh at its position in the document.

    Raises InputError NO_SHAPE, NO_FACES.
    """
    return _mesh_fingerprint(source) if is_mesh(source) else shape_fingerprint(source)


def shape_fingerprint(source: Any) -> str:
    """Return the fingerprint of an object's shape at its position in the document.

    Raises InputError NO_SHAPE.
    """
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
    """Return the digest of all bytes of a mesh and its placement."""
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
    """Format vector components with six decimals."""
    return " ".join(f"{round(number, 6) + 0.0:.6f}" for vector in vectors for number in vector)


# ---- Key of a stage's inputs: identifies the inputs of a stored result and changes with any input

SCHEMA_VERSION = 2  # version of the properties of stages
_counted_version: ContextVar[int] = ContextVar("counted_version", default=0)  # earlier version


def key_of_inputs(stage: Any, obj: Any, input_key: Callable[[str, Any], str]) -> str:
    """Return the key of an object's parameters, linked stages and further inputs.

    stage: proxy of the object. input_key: function of link and object that returns the key of a
    linked stage. Raises InputError for a missing or failed input.
    """
    texts = [type(stage).__name__, str(_counted_version.get() or SCHEMA_VERSION)]
    for section in stage.sections:
        texts += properties.fingerprint(obj, section.cls)
    for link, linked in stage.linked(obj).items():
        stage_objects = linked if isinstance(linked, list) else [linked]
        texts += [
            input_key(link, stage_object)
            for stage_object in stage_objects
            if stage_object is not None
        ]
    return hashlib.sha256("\n".join(texts + stage.further_inputs(obj)).encode()).hexdigest()[:32]


def key_of_stage(link: str, linked: Any) -> str:
    """Return the complete key of a linked stage."""
    return str(linked.Key)


def is_of_earlier_version(obj: Any) -> bool:
    """Whether an earlier property version computed a stage from its current inputs."""
    return any(_key_in(version, obj) == obj.Key for version in range(1, SCHEMA_VERSION))


def _key_in(version: int, obj: Any) -> str:
    with _counted_as(version):
        return str(obj.Proxy.key(obj))


@contextlib.contextmanager
def _counted_as(version: int) -> Iterator[None]:
    """Within the context, compute keys as in an earlier version."""
    token = _counted_version.set(version)
    try:
        yield
    finally:
        _counted_version.reset(token)
