# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a path names that leads through what holds it, as FreeCAD's selection has it: 'Body.Pad.Face3' of a part."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from typing import Any

import Part

from ...core.issues import InputError
from .array_elements import ArrayElement, is_hidden_array, object_of
from .bodies import global_shape, renumbers
from .marks import EDGE, FACE, PLANE
from .meshes import is_mesh
from .places import GROUPS, containers_of, elements_of

LINES = ("App::Line", "PartDesign::Line")
SKETCH_AXES = ("V_Axis", "H_Axis", "N_Axis")
CODES = {FACE: "BAD_FACES", EDGE: "BAD_EDGES"}
TOLERANCE_MM = 1e-6  # of two faces or edges that are the same


def owner_of(top: Any, path: str) -> tuple[Any, str]:
    """The object that an element at the end of a path belongs to for its user, and the name of the
    face or edge on it: '' for the complete object, and for an element that it does not have.

    A click within an assembly selects 'Body.Pad.Face3' of its outermost group: that is Face3 of the
    body, or of the feature where it is not the body's tip. An element shown by a link belongs to
    the link. An element shown by a link group or link array belongs to the object in it, and to the
    array where its elements are no objects.
    """
    return _owner(top, path, element=False)


def clicked(top: Any, path: str) -> tuple[Any, str]:
    """As `owner_of`, but an element of a link array is an `ArrayElement` where it is no object."""
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
    """The object that a container, link group or link array has by a name of a path; None for
    elements of `container` itself, and for an object that several link groups show.
    """
    if any(container.isDerivedFrom(kind) for kind in GROUPS):
        return container.getSubObject(f"{name}.", retType=1)
    for k, obj in enumerate(elements_of(container)):
        if name in (obj.Name, f"${obj.Label}", str(k)):
            with contextlib.suppress(InputError):
                return obj if containers_of(obj) else None
    return None


def line_of(top: Any, path: str) -> tuple[Any, str]:
    """The possible rotation axis of a path: an object and its edge or axis of a sketch, or a line
    of an origin, deep within its part; else the whole object.
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
    """A link to some faces or edges, without the paths that lead to them: the object that they
    belong to, and their names on it. InputError BAD_FACES, BAD_EDGES, BAD_AXIS for a path without
    such an element, and for elements of several objects.
    """
    if not any("." in name for name in names):
        return obj, list(names)
    owners = [_resolve(obj, name, where) for name in names]
    other_labels = [owner.Label for owner, _ in owners if owner != owners[0][0]]
    if other_labels:
        raise InputError(
            _code(names[0]),
            where,
            "{} names faces or edges of several objects ({}, {}); choose from one object",
            ", ".join(names),
            owners[0][0].Label,
            other_labels[0],
        )
    return owners[0][0], [name for _, name in owners]


def refuse_paths(obj: Any, names: Sequence[str], where: str) -> None:
    """Refuse paths to faces and edges of other objects than the one that is linked: the same names are others on it. And
    names of a part that has something twice. InputError as `resolved`."""
    element_paths = [
        name for name in names if not name.rsplit(".", maxsplit=1)[-1].startswith("?")
    ]  # FreeCAD knows the others lost
    plain = [name for name in element_paths if "." not in name]
    if plain and renumbers(obj):
        raise InputError(
            _code(plain[0]),
            where,
            "{} of {} is ambiguous: FreeCAD lists the contents of its group twice and numbers "
            "both; choose it on the original object",
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
                "{} of {} is {} of {}; choose it on the latter",
                name,
                obj.Label,
                own_name or element,
                owner.Label,
            )


def _resolve(obj: Any, name: str, where: str) -> tuple[Any, str]:
    """As `line_of`. InputError for a missing element."""
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
            "{} does not exist in {}; choose it in the 3D view, or on the original object",
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
    """The face or edge at the end of a path, in the coordinates of the document, or None."""
    try:
        return global_shape(top, path)
    except (InputError, Part.OCCError, ValueError, RuntimeError):
        return None


def _own_name(obj: Any, document_shape: Any, element: str) -> str:
    """The name on an object itself of a face or edge in document coordinates, preferably its
    present name; '' if it has none.
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
