# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes of a document: objects that are meshes, and links, link arrays and containers that show them.

A link passes on `Mesh` of its object at the object's position, not the link's. So positions are
computed here.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import FreeCAD as App
import numpy as np

from ...core.issues import InputError
from .places import children_of, outer_matrix, own_matrix


def is_mesh(source: Any) -> bool:
    """Whether an object is a mesh, or a link, link array or container that shows meshes and no shape."""
    if "Mesh" in source.PropertiesList:
        return True
    if "Shape" in source.PropertiesList:
        return False
    shape = getattr(source, "Shape", None)
    return (shape is None or shape.isNull()) and next(_shown_meshes(source), None) is not None


def mesh_of(source: Any) -> tuple[Any, np.ndarray]:
    """The mesh of an object, and the matrix (4, 4) from its coordinates to the document's.

    The meshes that a link, link array or container shows are one mesh, in document coordinates.
    Raises InputError NO_SHAPE.
    """
    if "Mesh" in source.PropertiesList:
        return source.Mesh.copy(), outer_matrix(source)  # its own placement is already applied
    combined = None
    for mesh, matrix in _shown_meshes(source):
        placed = _transformed(mesh, matrix)
        if combined is None:
            combined = placed
        else:
            combined.addMesh(placed)
    if combined is None:
        raise InputError("NO_SHAPE", source.Label, "it has no shape; choose an object with a shape")
    return combined, np.eye(4)


def refuse_mixed(source: Any) -> None:
    """Reject a container that shows shapes and meshes: one kind would be left out. InputError
    MIXED.
    """
    if "Shape" in source.PropertiesList or "Mesh" in source.PropertiesList:
        return
    if next(_shown_meshes(source), None) is not None:
        raise InputError(
            "MIXED",
            source.Label,
            "it contains shapes and meshes, which cannot be used together; choose its objects "
            "one by one",
        )


def _shown_meshes(source: Any) -> Iterator[tuple[Any, np.ndarray]]:
    """Each mesh that an object shows, and the matrix from the mesh, without its own placement, to the document."""
    return _meshes_of(source, outer_matrix(source))


def _meshes_of(obj: Any, outer: np.ndarray) -> Iterator[tuple[Any, np.ndarray]]:
    """outer: from where `obj` places itself to the document."""
    target, matrix = obj.getLinkedObject(True, App.Matrix(), True)
    yield from _inside(target, outer @ _array(matrix))


def _inside(container: Any, inside: np.ndarray) -> Iterator[tuple[Any, np.ndarray]]:
    """inside: from within `container`, its placement applied, to the document."""
    if "Mesh" in container.PropertiesList:
        if container.Mesh.CountFacets:
            yield container.Mesh, inside
        return
    if "Shape" in container.PropertiesList:
        return
    for path, child in children_of(container):
        if child.Name == path.rstrip(".") or child.TypeId == "App::LinkElement":
            yield from _meshes_of(child, inside)
        else:  # an element of a link array that is no object of its own
            # this matrix begins outside of the array, and without `transform` it would still have the array's scale
            step = np.linalg.inv(own_matrix(container)) @ _array(
                container.getSubObject(path, retType=4)
            )
            target, matrix = child.getLinkedObject(True, App.Matrix(), False)
            yield from _inside(target, inside @ step @ _array(matrix))


def _transformed(mesh: Any, matrix: np.ndarray) -> Any:
    """A copy of a mesh, without its placement, moved by a matrix; its triangles face outwards also where it mirrors."""
    placed = mesh.copy()
    placed.Placement = App.Placement()
    placed.transform(App.Matrix(*matrix.ravel().tolist()))
    if np.linalg.det(matrix[:3, :3]) < 0.0:
        placed.flipNormals()
    return placed


def _array(matrix: Any) -> np.ndarray:
    return np.array(matrix.A).reshape(4, 4)
