# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes and meshes of a document in document coordinates, also as bodies for collision checks."""

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
    """Return the shape of an object in document coordinates, for any nesting of the object.

    Parameters
    ----------
    source : App.DocumentObject
        An object with a shape: a part, body, link, link array or container.
    path : str
        Element of the object: `""` for the complete object, `"Face3"`, `"Box.Edge1"` for an object
        in a container or link, `"1."` for the second element of a link array.

    Raises
    ------
    InputError
        NO_SHAPE for an object without a shape, SEVERAL_PLACES for an object in several link groups.
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
    """Return the shape of an object in the coordinates of its container.

    path: as in `global_shape`. Raises InputError NO_SHAPE.
    """
    if path:
        shape = Part.getShape(source, path, needSubElement=_is_element(path))
        if shape is None or shape.isNull():
            raise InputError(
                "NO_SHAPE",
                source.Label,
                "{} in the group has no shape; choose an object with a shape",
                path,
            )
        return shape
    shape = getattr(source, "Shape", None)
    if shape is None or shape.isNull():
        raise _no_shape(source)
    shape = _apply_scales(source, shape)
    return _once(shape) if _shows_group(source) else shape


def _apply_scales(source: Any, shape: Any) -> Any:
    """Return the shape, rebuilt from visible children if a container has scaled links.

    FreeCAD 0.20 scales such elements uniformly by the cube root of the volume ratio. No version
    applies the scale of an element object of a link array. Shapes of single paths are correct in
    all versions.
    """
    if shape.ShapeType != "Compound" or "Shape" in source.PropertiesList:
        return shape
    if not any(is_scaled(dependency) for dependency in dependencies_of(source).objects):
        return shape
    leaves = [Part.getShape(source, path) for path in shown_paths(source)]
    return Part.makeCompound([leaf for leaf in leaves if not leaf.isNull()])


def _no_shape(source: Any) -> InputError:
    return InputError(
        "NO_SHAPE", source.Label, "the object has no shape; choose an object with a shape"
    )


def _is_element(path: str) -> bool:
    """Whether a path ends with a face or edge name, not with a dot."""
    return bool(path) and not path.endswith(".")


def renumbers(source: Any) -> bool:
    """Whether faces and edges of a part or group have other numbers in `shape_of` than in FreeCAD.

    Numbers differ if a shape appears twice in FreeCAD's compound, before other shapes.
    """
    shape = getattr(source, "Shape", None) if _shows_group(source) else None
    distinct = [] if shape is None or shape.isNull() else _distinct_numbers(_leaves(shape))
    return distinct != list(range(len(distinct)))


def _shows_group(source: Any) -> bool:
    """Whether an object is a part or group, or a link, link array or link group to one."""
    linked_object = source.getLinkedObject(True) or source
    if any(linked_object.isDerivedFrom(kind) for kind in GROUPS):
        return True
    base = link_property(linked_object, "LinkedObject")
    base = base[0] if isinstance(base, tuple) else base
    bases = elements_of(linked_object) if base is None else [base]
    return any(_shows_group(entry) for entry in bases if entry != linked_object)


def _once(shape: Any) -> Any:
    """Return the shape of a part or group with each body once.

    FreeCAD lists the members of a group in a part twice.
    """
    leaves = _leaves(shape)
    distinct = _distinct_numbers(leaves)
    return (
        shape if len(distinct) == len(leaves) else Part.makeCompound([leaves[k] for k in distinct])
    )


def _leaves(shape: Any) -> list[Any]:
    """Return the shapes in a compound, in the order in which FreeCAD numbers faces and edges."""
    if shape.ShapeType != "Compound":
        return [shape]
    return [leaf for child in shape.childShapes() for leaf in _leaves(child)]


def _distinct_numbers(leaves: list[Any]) -> list[int]:
    """Return the indices of shapes without an earlier duplicate."""
    return [
        k
        for k, leaf in enumerate(leaves)
        if not any(_is_same(leaf, earlier_leaf) for earlier_leaf in leaves[:k])
    ]


def _is_same(shape: Any, other_shape: Any) -> bool:
    """Whether two shapes are the same shape with the same placement."""
    # most pairs differ here; comparing placements would take twenty times as long
    if not shape.isPartner(other_shape):
        return False
    return np.allclose(
        shape.Placement.toMatrix().A, other_shape.Placement.toMatrix().A, rtol=0.0, atol=1e-9
    )


def body_of(source: Any) -> Body:
    """Return the triangles of an object, solid or mesh, in document coordinates.

    Raises InputError NO_SHAPE, NO_FACES.
    """
    return snapshot_of(source).body()


@dataclass(frozen=True)
class Taken:
    """Snapshot of an object, for work that does not touch the document.

    shape: shape in document coordinates, None for a mesh. mesh, frame: mesh, and frame (4, 4) from
    mesh to document coordinates.
    """

    label: str
    shape: Any
    mesh: Any = None
    frame: Any = None

    def body(self) -> Body:
        """Return the triangles in document coordinates. Raises InputError NO_FACES."""
        if self.mesh is None:
            # tessellate a copy, because the window may be drawing the original's triangles
            return tessellate.body(self.shape.copy(False), self.label)
        triangles = tessellate.body(self.mesh, self.label)
        return dataclasses.replace(
            triangles, vertices=triangles.vertices @ self.frame[:3, :3].T + self.frame[:3, 3]
        )


def snapshot_of(source: Any) -> Taken:
    """Return a snapshot of an object. Shapes are shared, not copied. Raises InputError NO_SHAPE."""
    if is_mesh(source):
        return Taken(source.Label, None, *mesh_of(source))
    shape = global_shape(source)
    refuse_mixed(source)
    return Taken(source.Label, shape)


def fixtures_of(obj: Any) -> tuple[Taken, ...]:
    """Return snapshots of the fixtures of a feature."""
    return tuple(snapshot_of(fixture) for fixture in obj.Fixtures)


def bodies(fixtures: Sequence[Taken]) -> tuple[Body, ...]:
    """Return the triangles of each snapshot. Raises InputError NO_FACES."""
    return tuple(fixture.body() for fixture in fixtures)


CODE = "CHORD_ERROR"
KEY, PROPERTY = "chord_error", "ChordError"


def fill_in(obj: Any, parameters: Sequence[Any], values: Mapping[str, Any]) -> None:
    """Set the chord error of a new feature by its size, unless `parameters` or `values` set it."""
    if PROPERTY in obj.PropertiesList and not _is_given(parameters, values):
        chord_error = suited(obj)
        if chord_error > MIN_CHORD_ERROR:
            setattr(obj, PROPERTY, f"{chord_error!r} mm")


def suited(obj: Any) -> float:
    """Return the chord error, mm, that suits the size and the beads of a feature."""
    bead = getattr(obj, "BeadSpacing", None)
    width = BEAD_TO_LAYER * float(obj.LayerHeight) if bead is None else float(bead)
    return scaled(extent(obj), width)


def extent(obj: Any) -> float:
    """Return the maximum extent, mm, of a feature's deposit along coordinate axes; 0 if unknown."""
    sizes = [0.0]
    # FreeCAD raises ValueError for missing names, which the feature reports
    with contextlib.suppress(AmError, ValueError, *kernel.FAULTS):
        for box in _boxes(obj):
            sizes += [box.XLength, box.YLength, box.ZLength] if box.isValid() else []
    return max(sizes)


def notes(obj: Any) -> tuple[Issue, ...]:
    """Return a note if the chord error is derived from the feature's size and not the minimum."""
    chord_error = float(getattr(obj, PROPERTY, MIN_CHORD_ERROR))
    if chord_error <= MIN_CHORD_ERROR or chord_error != suited(obj):
        return ()
    text = Text(
        "the chord error is {:g} mm, suitable for a part of {:.0f} mm and its beads; set "
        "strategy.chord_error for another value",
        chord_error,
        extent(obj),
    )
    return (Issue(NOTE, CODE, text),)


def _is_given(parameters: Sequence[Any], values: Mapping[str, Any]) -> bool:
    chord_errors = [getattr(entry, KEY) for entry in parameters if hasattr(entry, KEY)]
    return KEY in values or any(not isinstance(value, DefaultLength) for value in chord_errors)


def _boxes(obj: Any) -> Iterator[Any]:
    """Yield the bounding boxes of the objects or faces that a feature deposits."""
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
        ):  # planning reports missing elements
            elements = (
                [shape.getElement(name) for name in names if name]
                if deposit_source is source
                else []
            )
        for element in elements or _bounded_parts(shape):
            yield _box(element)


def _bounded_parts(shape: Any) -> list[Any]:
    """Return the shape, or its solids if the shape is infinite, as with a datum plane."""
    if _extent(shape.BoundBox) <= MAX_COORDINATE_MM:
        return [shape]
    return [solid for solid in shape.Solids if _extent(solid.BoundBox) <= MAX_COORDINATE_MM]


def _extent(box: Any) -> float:
    return max(box.XLength, box.YLength, box.ZLength) if box.isValid() else 0.0


def _box(shape: Any) -> Any:
    """Return the bounding box of a shape.

    The quick box is never too small but depends on existing triangles, so it is only used for small
    shapes.
    """
    box = shape.BoundBox
    if _extent(box) > SMALL_PART_SIZE:
        return shape.copy(True, False).optimalBoundingBox()  # without its triangles
    return box


# ---- Meshes of a document: mesh objects, and links, link arrays and containers with meshes
#
# A link returns `Mesh` of its object at the object's position, not the link's. So positions are
# computed here.


def is_mesh(source: Any) -> bool:
    """Whether an object is a mesh, or a link, link array or container with meshes but no shape."""
    if "Mesh" in source.PropertiesList:
        return True
    if "Shape" in source.PropertiesList:
        return False
    shape = getattr(source, "Shape", None)
    return (shape is None or shape.isNull()) and next(_shown_meshes(source), None) is not None


def mesh_of(source: Any) -> tuple[Any, np.ndarray]:
    """Return the mesh of an object and the matrix (4, 4) from mesh to document coordinates.

    The meshes in a link, link array or container are joined in document coordinates. Raises
    InputError NO_SHAPE.
    """
    if "Mesh" in source.PropertiesList:
        return source.Mesh.copy(), outer_matrix(source)  # the mesh includes its placement
    combined = None
    for mesh, matrix in _shown_meshes(source):
        placed = _transformed(mesh, matrix)
        if combined is None:
            combined = placed
        else:
            combined.addMesh(placed)
    if combined is None:
        raise InputError(
            "NO_SHAPE", source.Label, "the object has no shape; choose an object with a shape"
        )
    return combined, np.eye(4)


def refuse_mixed(source: Any) -> None:
    """Raise InputError MIXED for a container with shapes and meshes; one kind would be ignored."""
    if "Shape" in source.PropertiesList or "Mesh" in source.PropertiesList:
        return
    if next(_shown_meshes(source), None) is not None:
        raise InputError(
            "MIXED",
            source.Label,
            "the group contains shapes and meshes, which cannot be used together; choose its "
            "objects one by one",
        )


def _shown_meshes(source: Any) -> Iterator[tuple[Any, np.ndarray]]:
    """Yield each mesh in an object, with the matrix from the unplaced mesh to the document."""
    return _meshes_of(source, outer_matrix(source))


def _meshes_of(obj: Any, outer: np.ndarray) -> Iterator[tuple[Any, np.ndarray]]:
    """Yield meshes as `_shown_meshes`. outer: matrix from `obj`'s container to the document."""
    target, matrix = obj.getLinkedObject(True, App.Matrix(), True)
    yield from _inside(target, outer @ _array(matrix))


def _inside(container: Any, inside: np.ndarray) -> Iterator[tuple[Any, np.ndarray]]:
    """Yield meshes as `_shown_meshes`. inside: matrix from inside `container` to the document."""
    if "Mesh" in container.PropertiesList:
        if container.Mesh.CountFacets:
            yield container.Mesh, inside
        return
    if "Shape" in container.PropertiesList:
        return
    for path, child in children_of(container):
        if child.Name == path.rstrip(".") or child.TypeId == "App::LinkElement":
            yield from _meshes_of(child, inside)
        else:  # an element of a link array without an element object
            # this matrix starts outside the array; without `transform` it would include the scale
            step = np.linalg.inv(own_matrix(container)) @ _array(
                container.getSubObject(path, retType=4)
            )
            target, matrix = child.getLinkedObject(True, App.Matrix(), False)
            yield from _inside(target, inside @ step @ _array(matrix))


def _transformed(mesh: Any, matrix: np.ndarray) -> Any:
    """Return a copy of the unplaced mesh, moved by a matrix, with normals outwards if mirrored."""
    placed = mesh.copy()
    placed.Placement = App.Placement()
    placed.transform(App.Matrix(*matrix.ravel().tolist()))
    if np.linalg.det(matrix[:3, :3]) < 0.0:
        placed.flipNormals()
    return placed


def _array(matrix: Any) -> np.ndarray:
    return np.array(matrix.A).reshape(4, 4)
