# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes and meshes of a document: in its coordinates, and as bodies that the nozzle is kept clear of."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import FreeCAD as App
import numpy as np
import Part

from ...brep.shapes import tessellate
from ...core.geometry.obstacles import Body
from ...core.issues import InputError
from ..stage_parts import Link

GROUPS = ("App::Part", "App::DocumentObjectGroup")
FIXTURES = Link(
    "Fixtures",
    "",
    "Clamps and other bodies around the part, which the nozzle is kept clear of.",
    required=False,
    type_name="App::PropertyLinkList",
)


def global_shape(source: Any) -> Any:
    """The shape of an object in the coordinates of the document, wherever it is nested. InputError 'NO_SHAPE'."""
    shape, outer = shape_of(source), outer_placement(source)
    if not outer.isIdentity():
        shape = shape.copy()
        shape.Placement = outer.multiply(shape.Placement)
    return shape


def shape_of(source: Any) -> Any:
    """The shape of an object where it places itself. InputError 'NO_SHAPE'."""
    shape = getattr(source, "Shape", None)
    if shape is None or shape.isNull():
        raise InputError("NO_SHAPE", source.Label, "it has no shape; choose an object with a shape")
    return _once(shape) if _is_group(source) else shape


def renumbers(source: Any) -> bool:
    """Whether faces and edges of a part or group have other numbers in its `shape_of` than FreeCAD gives them: something is
    there twice, and others follow."""
    shape = getattr(source, "Shape", None) if _is_group(source) else None
    kept = [] if shape is None or shape.isNull() else _kept(_leaves(shape))
    return kept != list(range(len(kept)))


def _is_group(source: Any) -> bool:
    return any(source.isDerivedFrom(kind) for kind in GROUPS)


def _once(shape: Any) -> Any:
    """The shape of a part or group, with each body once: FreeCAD has what is in a group of a part a second time."""
    leaves = _leaves(shape)
    kept = _kept(leaves)
    return shape if len(kept) == len(leaves) else Part.makeCompound([leaves[k] for k in kept])


def _leaves(shape: Any) -> list[Any]:
    """What a compound is made of, in the order in which FreeCAD numbers its faces and edges."""
    if shape.ShapeType != "Compound":
        return [shape]
    return [leaf for one in shape.childShapes() for leaf in _leaves(one)]


def _kept(leaves: list[Any]) -> list[int]:
    """The numbers of shapes that no earlier one is the same as."""
    return [
        k for k, one in enumerate(leaves) if not any(_is_same(one, other) for other in leaves[:k])
    ]


def _is_same(one: Any, other: Any) -> bool:
    """Whether two shapes are one in the same place, however they came there."""
    if not one.isPartner(other):  # of most pairs, whose placements would take twenty times as long
        return False
    return np.allclose(
        one.Placement.toMatrix().A, other.Placement.toMatrix().A, rtol=0.0, atol=1e-9
    )


def outer_placement(source: Any) -> Any:
    """What moves an object as it places itself to where it stands in the document: the placements of all it is nested in."""
    if hasattr(source, "getGlobalPlacement") and hasattr(source, "Placement"):
        return source.getGlobalPlacement().multiply(source.Placement.inverse())
    return App.Placement()


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
        return dataclasses.replace(
            found, vertices=found.vertices @ self.frame[:3, :3].T + self.frame[:3, 3]
        )


def taken(source: Any) -> Taken:
    """What an object is now; costs little, as shapes are shared. InputError 'NO_SHAPE'."""
    mesh = getattr(source, "Mesh", None)
    if mesh is None:
        return Taken(source.Label, global_shape(source))
    # a mesh stands where its own placement puts it
    frame = np.array(outer_placement(source).toMatrix().A).reshape(4, 4)
    return Taken(source.Label, None, mesh.copy(), frame)


def fixtures_of(obj: Any) -> tuple[Taken, ...]:
    """The fixtures of a feature."""
    return tuple(taken(fixture) for fixture in obj.Fixtures)


def bodies(fixtures: Sequence[Taken]) -> tuple[Body, ...]:
    """The triangles of each. InputError NO_FACES."""
    return tuple(fixture.body() for fixture in fixtures)
