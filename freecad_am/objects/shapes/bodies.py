# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes and meshes of a document: in its coordinates, and as bodies that the nozzle is kept clear of."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import FreeCAD as App
import numpy as np
import Part

from ...brep.files.read import MAX_COORDINATE_MM
from ...brep.kernel import limits as kernel
from ...brep.shapes import tessellate
from ...core.geometry.obstacles import Body
from ...core.issues import NOTE, AmError, InputError, Issue, Text
from ...core.parameters.strategy import (
    BEAD_TO_LAYER,
    MIN_CHORD_ERROR,
    SMALL_PART_SIZE,
    DefaultLength,
    scaled,
)
from ..stage_parts import Link
from .places import (
    GROUPS,
    children_of,
    dependencies_of,
    elements_of,
    is_rigid,
    is_scaled,
    link_property,
    outer_matrix,
    outer_placement,
    own_matrix,
    path_from_top,
    shown_paths,
)

FIXTURES = Link(
    "Fixtures",
    "",
    "Clamps and other bodies around the part that the nozzle must clear.",
    required=False,
    type_name="App::PropertyLinkList",
)


def global_shape(source: Any, path: str = "") -> Any:
    """The shape of an object in the coordinates of its document, wherever the object is nested.

    Parameters
    ----------
    source : App.DocumentObject
        An object with a shape: a part, body, link, link array, container.
    path : str
        The element: `""` for the complete object, `"Face3"`, `"Box.Edge1"` of an object that a
        container or link shows, `"1."` for the second element of a link array.

    Raises
    ------
    InputError
        NO_SHAPE for an object without a shape, SEVERAL_PLACES for an object that several link
        groups show.
    """
    shape, outer = shape_of(source, path), outer_matrix(source)
    if is_rigid(outer):
        placement = outer_placement(source)
        if not placement.isIdentity():
            shape = shape.copy()
            shape.Placement = placement.multiply(shape.Placement)
        return shape
    top, whole_path = path_from_top(source, path)
    if path or shape.ShapeType != "Compound":
        document_shape = Part.getShape(top, whole_path, needSubElement=_is_element(path))
    else:
        leaves = [Part.getShape(top, whole_path + leaf) for leaf in shown_paths(source)]
        document_shape = Part.makeCompound([leaf for leaf in leaves if not leaf.isNull()])
    if document_shape.isNull():
        raise _no_shape(source)
    return _once(document_shape) if _shows_group(source) else document_shape


def shape_of(source: Any, path: str = "") -> Any:
    """The shape of an object where it places itself. path: as of `global_shape`. Raises InputError 'NO_SHAPE'."""
    if path:
        shape = Part.getShape(source, path, needSubElement=_is_element(path))
        if shape is None or shape.isNull():
            raise InputError(
                "NO_SHAPE",
                source.Label,
                "{} in it has no shape; choose an object with a shape",
                path,
            )
        return shape
    shape = getattr(source, "Shape", None)
    if shape is None or shape.isNull():
        raise _no_shape(source)
    shape = _apply_scales(source, shape)
    return _once(shape) if _shows_group(source) else shape


def _apply_scales(source: Any, shape: Any) -> Any:
    """The shape of an object; for a container or link array with scaled links in it, assembled from
    its visible children.

    FreeCAD 0.20 scales such elements of a compound by the cube root of the volume's factor in all directions, and no
    version applies the scale that an element object of a link array has. The shape of a single path is right in all.
    """
    if shape.ShapeType != "Compound" or "Shape" in source.PropertiesList:
        return shape
    if not any(is_scaled(dependency) for dependency in dependencies_of(source).objects):
        return shape
    leaves = [Part.getShape(source, path) for path in shown_paths(source)]
    return Part.makeCompound([leaf for leaf in leaves if not leaf.isNull()])


def _no_shape(source: Any) -> InputError:
    return InputError("NO_SHAPE", source.Label, "it has no shape; choose an object with a shape")


def _is_element(path: str) -> bool:
    """Whether a path ends with the name of a face or an edge, and not with a dot."""
    return bool(path) and not path.endswith(".")


def renumbers(source: Any) -> bool:
    """Whether faces and edges of a part or group have other numbers in its `shape_of` than FreeCAD gives them: something is
    there twice, and others follow."""
    shape = getattr(source, "Shape", None) if _shows_group(source) else None
    distinct = [] if shape is None or shape.isNull() else _distinct_numbers(_leaves(shape))
    return distinct != list(range(len(distinct)))


def _shows_group(source: Any) -> bool:
    """Whether an object is a part or group, or a link, link array or link group that shows one."""
    linked_object = source.getLinkedObject(True) or source
    if any(linked_object.isDerivedFrom(kind) for kind in GROUPS):
        return True
    base = link_property(linked_object, "LinkedObject")
    base = base[0] if isinstance(base, tuple) else base
    bases = elements_of(linked_object) if base is None else [base]
    return any(_shows_group(entry) for entry in bases if entry != linked_object)


def _once(shape: Any) -> Any:
    """The shape of a part or group, with each body once: FreeCAD lists the members of a group in a
    part a second time.
    """
    leaves = _leaves(shape)
    distinct = _distinct_numbers(leaves)
    return (
        shape if len(distinct) == len(leaves) else Part.makeCompound([leaves[k] for k in distinct])
    )


def _leaves(shape: Any) -> list[Any]:
    """What a compound is made of, in the order in which FreeCAD numbers its faces and edges."""
    if shape.ShapeType != "Compound":
        return [shape]
    return [leaf for child in shape.childShapes() for leaf in _leaves(child)]


def _distinct_numbers(leaves: list[Any]) -> list[int]:
    """The numbers of shapes that no earlier one is the same as."""
    return [
        k
        for k, leaf in enumerate(leaves)
        if not any(_is_same(leaf, earlier_leaf) for earlier_leaf in leaves[:k])
    ]


def _is_same(shape: Any, other_shape: Any) -> bool:
    """Whether two shapes are the same shape in the same place."""
    # most pairs end here; comparing their placements would take twenty times as long
    if not shape.isPartner(other_shape):
        return False
    return np.allclose(
        shape.Placement.toMatrix().A, other_shape.Placement.toMatrix().A, rtol=0.0, atol=1e-9
    )


def body_of(source: Any) -> Body:
    """The triangles of an object, solid or mesh, in the coordinates of the document.
    Raises InputError NO_SHAPE, NO_FACES."""
    return snapshot_of(source).body()


@dataclass(frozen=True)
class Taken:
    """The shape of an object in the coordinates of the document, or its mesh and the frame (4, 4) that puts it there, as
    they are now: for work that does not touch the document."""

    label: str
    shape: Any
    mesh: Any = None
    frame: Any = None

    def body(self) -> Body:
        """Its triangles in the coordinates of the document. Raises InputError NO_FACES."""
        if self.mesh is None:
            # of a copy: the window draws the triangles of the original, maybe at this very moment
            return tessellate.body(self.shape.copy(False), self.label)
        triangles = tessellate.body(self.mesh, self.label)
        return dataclasses.replace(
            triangles, vertices=triangles.vertices @ self.frame[:3, :3].T + self.frame[:3, 3]
        )


def snapshot_of(source: Any) -> Taken:
    """The current state of an object; cheap, as shapes are shared. Raises InputError 'NO_SHAPE'."""
    if is_mesh(source):
        return Taken(source.Label, None, *mesh_of(source))
    shape = global_shape(source)
    refuse_mixed(source)
    return Taken(source.Label, shape)


def fixtures_of(obj: Any) -> tuple[Taken, ...]:
    """The fixtures of a feature."""
    return tuple(snapshot_of(fixture) for fixture in obj.Fixtures)


def bodies(fixtures: Sequence[Taken]) -> tuple[Body, ...]:
    """The triangles of each. Raises InputError NO_FACES."""
    return tuple(fixture.body() for fixture in fixtures)


CODE = "CHORD_ERROR"
KEY, PROPERTY = "chord_error", "ChordError"


def fill_in(obj: Any, parameters: Sequence[Any], values: Mapping[str, Any]) -> None:
    """Set the chord error of a new feature by its size, unless `parameters` or `values` give one."""
    if PROPERTY in obj.PropertiesList and not _is_given(parameters, values):
        chord_error = suited(obj)
        if chord_error > MIN_CHORD_ERROR:
            setattr(obj, PROPERTY, f"{chord_error!r} mm")


def suited(obj: Any) -> float:
    """The chord error, mm, that suits the size and the beads of a feature."""
    bead = getattr(obj, "BeadSpacing", None)
    width = BEAD_TO_LAYER * float(obj.LayerHeight) if bead is None else float(bead)
    return scaled(extent(obj), width)


def extent(obj: Any) -> float:
    """The largest extent, mm, of a feature's deposit along a coordinate axis; 0 if unknown."""
    sizes = [0.0]
    # the feature reports names that its source lacks, for which FreeCAD raises ValueError
    with contextlib.suppress(AmError, ValueError, *kernel.FAULTS):
        for box in _boxes(obj):
            sizes += [box.XLength, box.YLength, box.ZLength] if box.isValid() else []
    return max(sizes)


def notes(obj: Any) -> tuple[Issue, ...]:
    """A note if the chord error of a feature follows from its size and is not the one of small
    parts.
    """
    chord_error = float(getattr(obj, PROPERTY, MIN_CHORD_ERROR))
    if chord_error <= MIN_CHORD_ERROR or chord_error != suited(obj):
        return ()
    text = Text(
        "the chord error is {:g} mm, suitable for a part of {:.0f} mm and its beads; set "
        "strategy.chord_error to change it",
        chord_error,
        extent(obj),
    )
    return (Issue(NOTE, CODE, text),)


def _is_given(parameters: Sequence[Any], values: Mapping[str, Any]) -> bool:
    chord_errors = [getattr(entry, KEY) for entry in parameters if hasattr(entry, KEY)]
    return KEY in values or any(not isinstance(value, DefaultLength) for value in chord_errors)


def _boxes(obj: Any) -> Iterator[Any]:
    """The boxes around the objects, or the faces, that a feature deposits."""
    source, names = (obj.Source[0], obj.Source[1]) if obj.Source else (None, ())
    for deposit_source in (source, *getattr(obj, "Further", ())):
        if deposit_source is None:
            continue
        if is_mesh(deposit_source):
            yield (
                deposit_source.Mesh.BoundBox
                if "Mesh" in deposit_source.PropertiesList
                else mesh_of(deposit_source)[0].BoundBox
            )
            continue
        shape = global_shape(deposit_source)
        elements = []
        with contextlib.suppress(
            IndexError, ValueError, Part.OCCError
        ):  # reported when it is planned
            elements = (
                [shape.getElement(name) for name in names if name]
                if deposit_source is source
                else []
            )
        for element in elements or _bounded_parts(shape):
            yield _box(element)


def _bounded_parts(shape: Any) -> list[Any]:
    """The shape, or its solids if it reaches to infinity, as a container with a datum plane does."""
    if _extent(shape.BoundBox) <= MAX_COORDINATE_MM:
        return [shape]
    return [solid for solid in shape.Solids if _extent(solid.BoundBox) <= MAX_COORDINATE_MM]


def _extent(box: Any) -> float:
    return max(box.XLength, box.YLength, box.ZLength) if box.isValid() else 0.0


def _box(shape: Any) -> Any:
    """The box around a shape. A quick box is never too small but depends on triangles that the
    shape may have, so it only decides about small shapes.
    """
    box = shape.BoundBox
    if _extent(box) > SMALL_PART_SIZE:
        return shape.copy(True, False).optimalBoundingBox()  # without its triangles
    return box


# ---- Meshes of a document: objects that are meshes, and links, link arrays and containers that
# show them
#
# A link passes on `Mesh` of its object at the object's position, not the link's. So positions are
# computed here.


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
