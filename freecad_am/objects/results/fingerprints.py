# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes and meshes as texts that change with them, but not with the last digits that saving drops.

A stage needs the fingerprints of its inputs at each recompute. So the last ones are cached: for
shapes as long as the kernel's objects of the shape and of its faces are identical (a macro may put
further shapes into a compound in place, but cannot change a face so); for meshes, which can change
in place, by their bytes.
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

MOST_KEPT = 64  # shapes, and meshes

_shapes: list[
    tuple[Any, tuple[Any, ...], str]
] = []  # shape, further criteria, text; most recent first
_meshes: dict[str, str] = {}


def fingerprint(source: Any) -> str:
    """The text of an object's solid or mesh, at its position in the document. Raises InputError NO_SHAPE,
    NO_FACES.
    """
    return _mesh_fingerprint(source) if is_mesh(source) else shape_fingerprint(source)


def shape_fingerprint(source: Any) -> str:
    """The text of an object's shape, at its position in the document. Raises InputError NO_SHAPE."""
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


# ---- The key of a stage's inputs: the origin of a stored result, as a text that differs after any
# change

SCHEMA_VERSION = 2  # version of the properties of stages
_counted_version: ContextVar[int] = ContextVar("counted_version", default=0)  # an earlier one


def key_of_inputs(stage: Any, obj: Any, input_key: Callable[[str, Any], str]) -> str:
    """The key of an object's parameters, of its linked stages by `input_key(link, object)`, and of
    further inputs of `stage`, its proxy. Raises InputError for a missing or failed one.
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
    """The complete key of a linked stage."""
    return str(linked.Key)


def is_of_earlier_version(obj: Any) -> bool:
    """Whether an earlier version of the properties computed a stage from the inputs that it has now."""
    return any(_key_in(version, obj) == obj.Key for version in range(1, SCHEMA_VERSION))


def _key_in(version: int, obj: Any) -> str:
    with _counted_as(version):
        return str(obj.Proxy.key(obj))


@contextlib.contextmanager
def _counted_as(version: int) -> Iterator[None]:
    """Keys as an earlier version made them."""
    token = _counted_version.set(version)
    try:
        yield
    finally:
        _counted_version.reset(token)
