# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes and meshes of a document: in its coordinates, as fingerprints, and as bodies that the nozzle is kept clear of."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..brep import tessellate
from ..core.geometry.surroundings import Body
from ..core.issues import InputError
from .stage import Link

FIXTURES = Link(
    "Fixtures", "", "Clamps and other bodies around the part, which the nozzle is kept clear of.", required=False,
    type_name="App::PropertyLinkList",
)


def global_shape(source: Any) -> Any:
    """The shape of an object in the coordinates of the document, wherever it is nested. InputError 'NO_SHAPE'."""
    shape = getattr(source, "Shape", None)
    if shape is None or shape.isNull():
        raise InputError("NO_SHAPE", source.Label, "it has no shape; choose an object with a shape")
    if hasattr(source, "getGlobalPlacement") and hasattr(source, "Placement"):
        outer = source.getGlobalPlacement().multiply(source.Placement.inverse())
        if not outer.isIdentity():
            shape = shape.copy()
            shape.Placement = outer.multiply(shape.Placement)
    return shape


def body_of(source: Any) -> Body:
    """The triangles of an object, solid or mesh, in the coordinates of the document. InputError NO_SHAPE, NO_FACES."""
    return taken(source).body()


@dataclass(frozen=True)
class Taken:
    """The shape of an object in the coordinates of the document, or its mesh and the frame (4, 4) that puts it there, as
    they are now: for work that does not touch the document."""

    label: str
    shape: Any
    mesh: Any = None
    frame: Any = None

    def body(self) -> Body:
        """Its triangles in the coordinates of the document. InputError NO_FACES."""
        if self.mesh is None:
            # of a copy: the window draws the triangles of the original, maybe at this very moment
            return tessellate.body(self.shape.copy(False), self.label)
        found = tessellate.body(self.mesh, self.label)
        return dataclasses.replace(found, vertices=found.vertices @ self.frame[:3, :3].T + self.frame[:3, 3])


def taken(source: Any) -> Taken:
    """What an object is now; costs little, as shapes are shared. InputError 'NO_SHAPE'."""
    mesh = getattr(source, "Mesh", None)
    if mesh is None:
        return Taken(source.Label, global_shape(source))
    # a mesh stands where its own placement puts it
    outer = source.getGlobalPlacement().multiply(source.Placement.inverse()).toMatrix()
    return Taken(source.Label, None, mesh.copy(), np.array(outer.A).reshape(4, 4))


def fixtures_of(obj: Any) -> tuple[Taken, ...]:
    """The fixtures of a feature."""
    return tuple(taken(fixture) for fixture in obj.Fixtures)


def bodies(fixtures: Sequence[Taken]) -> tuple[Body, ...]:
    """The triangles of each. InputError NO_FACES."""
    return tuple(fixture.body() for fixture in fixtures)


def shape_fingerprint(shape: Any) -> str:
    """A text that changes with the shape but not with the last digits that saving drops."""
    lines = [f"{shape.ShapeType} {len(shape.Faces)} {len(shape.Edges)} {len(shape.Vertexes)}"]
    for face in shape.Faces:
        inertia = face.MatrixOfInertia
        kind = f"{face.Surface.TypeId} {face.Orientation}"
        lines.append(f"{kind} {face.Area:.8g} {digits(face.CenterOfMass)} {inertia.A11:.6g} {inertia.A33:.6g}")
    lines += [f"{edge.Length:.8g}" for edge in shape.Edges]
    lines += [digits(vertex.Point) for vertex in shape.Vertexes]
    return "\n".join(lines)


def digits(*vectors: Any) -> str:
    """Numbers of vectors to six decimals."""
    return " ".join(f"{round(number, 6) + 0.0:.6f}" for vector in vectors for number in vector)


def fingerprint(source: Any) -> str:
    """A text that changes with the solid or mesh but not with the last digits that saving drops."""
    if getattr(source, "Mesh", None) is None:
        return shape_fingerprint(global_shape(source))
    body = body_of(source)
    rounded = np.round(body.vertices, 4) + 0.0
    return hashlib.sha256(rounded.tobytes() + body.triangles.tobytes()).hexdigest()
