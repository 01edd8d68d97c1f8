# SPDX-License-Identifier: LGPL-2.1-or-later
"""Resolve selection paths that lead through containers, such as 'Body.Pad.Face3' of a part."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Sequence
from typing import Any, NamedTuple

import FreeCAD as App
import numpy as np
import Part

from ...core.issues import InputError
from .bodies import global_shape, is_mesh, renumbers
from .places import GROUPS, ArrayElement, containers_of, elements_of, is_hidden_array, object_of

FACE, EDGE = "Face", "Edge"  # prefixes of their names
WHOLE_PART = "Shape"  # the name of the mark of a whole part
PLANE, LINE = "Part::GeomPlane", "Part::GeomLine"
AXIAL_SURFACES = (
    "Part::GeomCylinder",
    "Part::GeomCone",
    "Part::GeomToroid",
    "Part::GeomCircle",
    "Part::GeomEllipse",
)  # an axis
LEANS = np.radians(1.0)  # by which a face or an edge may turn and be the same
TOLERANCE = 1e-6  # of the part's size, squared of an area: by how much one may have moved, or grown, and be the same


class Mark(NamedTuple):
    """The mark of a face, an edge or a whole part in the part's own coordinates.

    It holds the kind of surface or curve (for a whole part the number of faces, edges or both), the
    direction of a plane's normal, a line or an axis (0 for others), area (mm2) or length (mm), and
    centre (mm).
    """

    name: str
    form: str
    direction: tuple[float, float, float]
    extent: float
    middle: tuple[float, float, float]

    def text(self) -> str:
        """Return the stored form of the path."""
        return " ".join(
            (
                self.name,
                self.form,
                *(repr(value) for value in (*self.direction, self.extent, *self.middle)),
            )
        )

    def is_same(self, other_mark: Mark, size: float, flat: bool = True) -> bool:
        """Whether nothing changed, for a part of a size (mm). flat: whether the extents are areas."""
        is_near = (
            float(np.abs(np.subtract(self.middle, other_mark.middle)).max()) <= TOLERANCE * size
        )
        return (
            self.is_alike(other_mark)
            and is_near
            and abs(self.extent - other_mark.extent) <= TOLERANCE * size ** (2 if flat else 1)
        )

    def is_alike(self, other_mark: Mark) -> bool:
        """Whether surface or curve kind and direction are the same, which a growing part keeps."""
        along = float(np.dot(self.direction, other_mark.direction))
        lies = not any(self.direction) or (along if self.form == PLANE else abs(along)) > np.cos(
            LEANS
        )
        return self.form == other_mark.form and lies

    def is_along(self, other_mark: Mark, size: float) -> bool:
        """Whether two straight edges are collinear and overlap, or two plane faces are coplanar and
        near.

        size: size of the part, mm.
        """
        if self.form not in (LINE, PLANE) or not self.is_alike(other_mark):
            return False
        offset, extents = (
            np.subtract(other_mark.middle, self.middle),
            (self.extent, other_mark.extent),
        )
        along, across = (
            float(abs(offset @ self.direction)),
            float(np.linalg.norm(np.cross(offset, self.direction))),
        )
        if self.form == LINE:
            return across <= TOLERANCE * size and along < 0.5 * sum(extents)
        return along <= TOLERANCE * size and across < 0.5 * max(extents) ** 0.5

    def is_turned_about(self, other_mark: Mark, size: float) -> bool:
        """Whether two straight edges share an end or the middle, as after dragging an end."""
        if self.form != LINE or other_mark.form != LINE:
            return False
        own_points, other_points = self._places(), other_mark._places()
        distances = [
            np.abs(own_points[1] - other_points[1]),
            *(
                np.abs(own_point - other_point)
                for own_point in own_points[::2]
                for other_point in other_points[::2]
            ),
        ]
        return bool(min(map(np.max, distances)) <= TOLERANCE * size)

    def _places(self) -> tuple[Any, Any, Any]:
        """Return start, middle and end of a straight edge."""
        middle, half = np.array(self.middle), 0.5 * self.extent * np.array(self.direction)
        return middle - half, middle, middle + half


def read(text: str) -> Mark | None:
    """Read a stored mark; None if it is damaged."""
    try:
        name, form, *values = text.split(" ")
        i, j, k, extent, x, y, z = map(float, values)
    except ValueError:
        return None
    return Mark(name, form, (i, j, k), extent, (x, y, z))


def marks_of(shape: Any, kind: str, names: Collection[str] = ()) -> list[Mark]:
    """Return the marks of the faces or edges of a shape, or of the named ones only."""
    inverse_placement = shape.Placement.inverse()
    all_ = enumerate(shape.Faces if kind == FACE else shape.Edges, start=1)
    return [
        _mark(f"{kind}{k}", element, inverse_placement)
        for k, element in all_
        if not names or f"{kind}{k}" in names
    ]


def whole_of(shape: Any, kinds: Collection[str]) -> Mark:
    """Return the mark of a whole shape, by its faces, its edges or both."""
    count = (len(shape.Faces) if FACE in kinds else 0) + (len(shape.Edges) if EDGE in kinds else 0)
    middle = shape.Placement.inverse().multVec(shape.BoundBox.Center)
    return Mark(
        WHOLE_PART,
        str(count),
        (0.0, 0.0, 0.0),
        shape.Area if FACE in kinds else shape.Length,
        tuple(middle),
    )


def _mark(name: str, element: Any, inverse_placement: Any) -> Mark:
    face = element.ShapeType == FACE
    try:
        geometry = element.Surface if face else element.Curve
        form, direction = geometry.TypeId, App.Vector()
        if form == PLANE:
            direction = inverse_placement.Rotation.multVec(element.normalAt(0.0, 0.0))
        elif form == LINE:
            direction = inverse_placement.Rotation.multVec(geometry.Direction)
        elif form in AXIAL_SURFACES:
            direction = inverse_placement.Rotation.multVec(geometry.Axis)
    except (
        AttributeError,
        TypeError,
        RuntimeError,
        Part.OCCError,
    ):  # a kind that FreeCAD has no name for, or without length
        form, direction = "other", App.Vector()
    return Mark(
        name,
        form,
        tuple(direction),
        element.Area if face else element.Length,
        tuple(inverse_placement.multVec(element.CenterOfMass)),
    )


LINES = ("App::Line", "PartDesign::Line")
SKETCH_AXES = ("V_Axis", "H_Axis", "N_Axis")
CODES = {FACE: "BAD_FACES", EDGE: "BAD_EDGES"}
TOLERANCE_MM = 1e-6  # of two faces or edges that are the same


def owner_of(top: Any, path: str) -> tuple[Any, str]:
    """Return the object that an element at the end of a path belongs to, and the name of the
    element on it.

    The name is '' for the complete object, and for an element that the object does not have. A
    click within an assembly selects 'Body.Pad.Face3' of its outermost group, which is Face3 of the
    body, or of the feature if the feature is not the tip of the body. An element shown by a link
    belongs to the link. An element shown by a link group or link array belongs to the object in it,
    or to the array if the elements of the array are not objects.
    """
    return _owner(top, path, element=False)


def clicked(top: Any, path: str) -> tuple[Any, str]:
    """Return owner and name as `owner_of`, with an `ArrayElement` for an element that is not an
    object.
    """
    return _owner(top, path, element=True)


def _owner(top: Any, path: str, element: bool) -> tuple[Any, str]:
    *steps, name = path.split(".")
    steps = [
        step for step in steps if step[:1] not in (";", "?")
    ]  # names of FreeCAD 1.0 that outlive changes
    obj, is_own = top, not steps
    while steps:
        child = _child_named(obj, steps[0])
        if child is None:
            break
        obj = child
        steps.pop(0)
    if steps and any(obj.isDerivedFrom(kind) for kind in GROUPS):
        return top, ""
    if steps and obj.isDerivedFrom("PartDesign::Body"):
        feature = obj.Document.getObject(steps[-1])
        if feature is not None and feature != obj.Tip and _has_shape(feature):
            obj = feature
    if steps and element and is_hidden_array(obj) and steps[0].isdigit():
        clicked_element = ArrayElement(obj, int(steps[0]))
        obj = clicked_element if _has_shape(clicked_element) else obj
    if not name.startswith((FACE, EDGE)) or is_mesh(obj):
        return obj, ""
    return obj, name if is_own else _own_name(obj, _element_shape(top, path), name)


def _child_named(container: Any, name: str) -> Any:
    """Return the child of a container, link group or link array with a name of a path.

    None for elements of `container` itself, and for an object that several link groups show.
    """
    if any(container.isDerivedFrom(kind) for kind in GROUPS):
        return container.getSubObject(f"{name}.", retType=1)
    for k, obj in enumerate(elements_of(container)):
        if name in (obj.Name, f"${obj.Label}", str(k)):
            with contextlib.suppress(InputError):
                return obj if containers_of(obj) else None
    return None


def line_of(top: Any, path: str) -> tuple[Any, str]:
    """Return the possible rotation axis of a path: an object, and its edge, sketch axis or origin
    line.

    The line may be deep within its part. Otherwise return the whole object.
    """
    obj, name = owner_of(top, path)
    element = path.rsplit(".", maxsplit=1)[-1]
    if name.startswith(EDGE):
        return obj, name
    if element in SKETCH_AXES and obj.isDerivedFrom("Sketcher::SketchObject"):
        return obj, element
    leaf = (top.getSubObjectList(path) or [obj])[-1]
    return (leaf if leaf.TypeId in LINES else obj), ""


def resolved(obj: Any, names: Sequence[str], where: str) -> tuple[Any, list[str]]:
    """Return a link to faces or edges without paths: the object that owns them, and their names on
    it.

    Raises InputError BAD_FACES, BAD_EDGES, BAD_AXIS for a path without such an element, and for
    elements of several objects.
    """
    if not any("." in name for name in names):
        return obj, list(names)
    owners = [_resolve(obj, name, where) for name in names]
    other_labels = [owner.Label for owner, _ in owners if owner != owners[0][0]]
    if other_labels:
        raise InputError(
            _code(names[0]),
            where,
            "{} names faces or edges of several objects ({}, {}); choose from a single object",
            ", ".join(names),
            owners[0][0].Label,
            other_labels[0],
        )
    return owners[0][0], [name for _, name in owners]


def refuse_paths(obj: Any, names: Sequence[str], where: str) -> None:
    """Reject paths to faces and edges of other objects than the linked object, and ambiguous names.

    The same names mean other elements on the linked object. Names are ambiguous if a part contains
    an object twice. Raises the InputErrors of `resolved`.
    """
    element_paths = [
        name for name in names if not name.rsplit(".", maxsplit=1)[-1].startswith("?")
    ]  # FreeCAD knows the others lost
    plain = [name for name in element_paths if "." not in name]
    if plain and renumbers(obj):
        raise InputError(
            _code(plain[0]),
            where,
            "{} of {} is ambiguous: FreeCAD lists the contents of its group twice and numbers "
            "both; choose the face or edge on the original object",
            plain[0],
            obj.Label,
        )
    for name in element_paths:
        if name in plain:
            continue
        element = name.rsplit(".", maxsplit=1)[-1]
        owner, own_name = _resolve(obj, name, where)
        if owner != obj or own_name != element:
            raise InputError(
                _code(name),
                where,
                "{} of {} is {} of {}; choose it on the original object",
                name,
                obj.Label,
                own_name or element,
                owner.Label,
            )


def _resolve(obj: Any, name: str, where: str) -> tuple[Any, str]:
    """Resolve a path as `line_of`. Raises InputError for a missing element."""
    if "." not in name:
        return obj, name
    if not name.endswith(".") and obj.getSubObject(f"{name}.", retType=1) is not None:
        name = f"{name}."  # an object, which FreeCAD would have the path end with a dot for
    element = name.rsplit(".", maxsplit=1)[-1]
    owner, own_name = (owner_of if element.startswith(FACE) else line_of)(obj, name)
    if not element and isinstance(array_element := clicked(obj, name)[0], ArrayElement):
        return object_of(array_element.array, array_element.index), ""
    gapped = "" in name.split(".")[:-1]  # which FreeCAD 1.0 takes for a path without the gap
    if gapped or obj.getSubObject(name, retType=1) is None or (element and not own_name):
        raise InputError(
            _code(name),
            where,
            "{} does not exist in {}; choose the face or edge in the 3D view, or on the original "
            "object",
            name,
            obj.Label,
        )
    return owner, own_name


def _code(name: str) -> str:
    element = name.rsplit(".", maxsplit=1)[-1]
    return next((code for kind, code in CODES.items() if element.startswith(kind)), "BAD_AXIS")


def _has_shape(obj: Any) -> bool:
    shape = getattr(obj, "Shape", None)
    return shape is not None and not shape.isNull()


def _element_shape(top: Any, path: str) -> Any:
    """Return the face or edge at the end of a path in document coordinates, or None."""
    try:
        return global_shape(top, path)
    except (InputError, Part.OCCError, ValueError, RuntimeError):
        return None


def _own_name(obj: Any, document_shape: Any, element: str) -> str:
    """Return the name of a face or edge, given in document coordinates, on the object itself.

    The present name is preferred; '' if the object has no such element.
    """
    kind = FACE if element.startswith(FACE) else EDGE
    try:
        shape = global_shape(obj)
    except InputError:
        return ""
    if document_shape is None or document_shape.isNull():
        return ""
    elements = {
        f"{kind}{k}": element_shape
        for k, element_shape in enumerate(shape.Faces if kind == FACE else shape.Edges, start=1)
    }
    same = [
        name for name, element_shape in elements.items() if _is_same(element_shape, document_shape)
    ]
    return element if element in same else next(iter(same), "")


def _is_same(shape: Any, other_shape: Any) -> bool:
    is_near = (shape.CenterOfMass - other_shape.CenterOfMass).Length < TOLERANCE_MM
    if not is_near or abs(shape.Length - other_shape.Length) >= TOLERANCE_MM * max(
        1.0, shape.Length
    ):
        return False
    if (
        shape.ShapeType != FACE
        or shape.Surface.TypeId != PLANE
        or other_shape.Surface.TypeId != PLANE
    ):
        return True
    return bool(
        shape.normalAt(0.0, 0.0).dot(other_shape.normalAt(0.0, 0.0)) > 0.0
    )  # of two touching faces, the intended one
