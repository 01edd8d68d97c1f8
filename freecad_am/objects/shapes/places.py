# SPDX-License-Identifier: LGPL-2.1-or-later
"""The position of an object in its document, determined by containers, links and linked objects.

FreeCAD stores a placement relative to the container. `getGlobalPlacement` gives the position in the
document, but objects of type App::Link and App::LinkElement do not have this function, and it
ignores link groups and link arrays. Therefore this module walks up the containers.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import FreeCAD as App
import numpy as np
import Part

from ...core.issues import InputError

GROUPS = ("App::Part", "App::DocumentObjectGroup")
RIGID = 1e-9  # by which rows of a rotation may differ from unit vectors at right angles


@dataclass(frozen=True)
class Dependencies:
    """Everything that determines the shape and the position of an object.

    Attributes
    ----------
    objects : tuple
        The object itself, its sources, and the objects shown by its links, in any document.
    containers : tuple
        The containers that place the object, from the innermost to the outermost.
    documents : tuple
        The documents of these objects, the object's own first.
    """

    objects: tuple[Any, ...]
    containers: tuple[Any, ...]
    documents: tuple[Any, ...]


def containers_of(source: Any) -> tuple[Any, ...]:
    """Return the containers of an object, from the innermost to the outermost.

    These are App::Part, PartDesign::Body, assemblies, link groups, link arrays (of their elements)
    and plain groups. Raises InputError SEVERAL_PLACES for an object that several link groups show.
    """
    chain: list[Any] = []
    container = _container_of(getattr(source, "placed_as", source))
    while container is not None and container != source and container not in chain:
        chain.append(container)
        container = _container_of(container)
    return tuple(chain)


def _container_of(obj: Any) -> Any:
    """Return the container that places an object, None for a top-level object."""
    group = obj.getParentGeoFeatureGroup()
    if group is not None:
        return group
    linking = [
        candidate for candidate in dict.fromkeys(obj.InList) if obj in elements_of(candidate)
    ]
    if len(linking) > 1:
        raise InputError(
            "SEVERAL_PLACES",
            obj.Label,
            "several link groups show the object ({}), each in its own place; choose one group, "
            "or make a link to the object",
            ", ".join(candidate.Label for candidate in linking),
        )
    return linking[0] if linking else obj.getParentGroup()


def elements_of(obj: Any) -> list[Any]:
    """Return the objects that a link group or a link array shows, [] for other objects."""
    return list(link_property(obj, "ElementList") or ())


def link_property(obj: Any, name: str) -> Any:
    """Return a property of a link by its role, whatever its name on the object; None for an object
    that is not a link.
    """
    try:
        return obj.getLinkExtProperty(name)
    except (AttributeError, RuntimeError, TypeError):
        return None


def outer_matrix(source: Any) -> np.ndarray:
    """Return the matrix (4, 4) from the coordinates of an object's container to those of the
    document.
    """
    chain = containers_of(source)
    if _asks_freecad(source, chain):
        placement = source.getGlobalPlacement().multiply(source.Placement.inverse())
        return _array(placement.toMatrix())
    matrix = np.eye(4)
    for container in chain:
        matrix = own_matrix(container) @ matrix
    return matrix


def outer_placement(source: Any) -> Any:
    """Return `outer_matrix` as a placement.

    Raises InputError SCALED_CONTAINER if a container scales or mirrors the object.
    """
    chain = containers_of(source)
    if _asks_freecad(source, chain):
        return source.getGlobalPlacement().multiply(source.Placement.inverse())
    scaling = [outer for outer in chain if not is_rigid(own_matrix(outer))]
    if not scaling:
        placement = App.Placement()
        for container in chain:
            if hasattr(container, "Placement"):
                placement = container.Placement.multiply(placement)
        return placement
    matrix = outer_matrix(source)
    if is_rigid(matrix):
        return App.Placement(App.Matrix(*matrix.ravel().tolist()))
    raise InputError(
        "SCALED_CONTAINER",
        source.Label,
        "{} scales or mirrors the object; choose {} itself",
        scaling[0].Label,
        scaling[0].Label,
    )


def global_placement(source: Any) -> Any:
    """Return the placement of an object in document coordinates. Raises InputError as
    `outer_placement`.
    """
    own_placement = getattr(source, "Placement", None)
    chain = containers_of(source)
    if _asks_freecad(source, chain):
        return source.getGlobalPlacement()
    outer = outer_placement(source)
    return outer if own_placement is None else outer.multiply(own_placement)


def is_rigid(matrix: np.ndarray) -> bool:
    """Whether a matrix (4, 4) is a rigid motion, without scale or reflection."""
    turn = matrix[:3, :3]
    is_unit = np.allclose(turn.T @ turn, np.eye(3), rtol=0.0, atol=RIGID)
    return bool(is_unit and np.linalg.det(turn) > 0.0)


def path_from_top(source: Any, path: str = "") -> tuple[Any, str]:
    """Return the outermost container of an object, or the object itself, and the path from there.

    The path leads to the object and to the element that `path` names in it.
    """
    top, steps = source, path
    for container in containers_of(source):
        steps, top = f"{top.Name}.{steps}", container
    return top, steps


def _asks_freecad(source: Any, chain: tuple[Any, ...]) -> bool:
    """Whether FreeCAD itself knows the position: true for a feature outside link groups and link
    arrays.
    """
    if not hasattr(source, "getGlobalPlacement") or not hasattr(source, "Placement"):
        return False
    return all(link_property(container, "ElementList") is None for container in chain)


def own_matrix(container: Any) -> np.ndarray:
    """Return the transform of a container on its members as a matrix (4, 4): placement, and scale
    of a link array.
    """
    placement = getattr(container, "Placement", None)
    matrix = np.eye(4) if placement is None else _array(placement.toMatrix())
    scale = link_property(container, "ScaleVector")
    if scale is not None:
        matrix[:3, :3] = matrix[:3, :3] * np.array([scale.x, scale.y, scale.z])
    return matrix


def is_scaled(obj: Any) -> bool:
    """Whether an object is a link that scales or mirrors its target, or an element of such a link."""
    scales = [link_property(obj, "ScaleVector"), *(link_property(obj, "ScaleList") or ())]
    return any(scale is not None and tuple(scale) != (1.0, 1.0, 1.0) for scale in scales)


def shown_paths(source: Any) -> list[str]:
    """Return the paths to the objects shown by a container, link group or link array, in FreeCAD's
    order.

    `[""]` for an object with its own shape. Hidden objects are omitted, as in FreeCAD.
    """
    linked_object = source.getLinkedObject(True) or source
    if "Shape" in linked_object.PropertiesList or "Mesh" in linked_object.PropertiesList:
        return [""]
    return [
        path + child_path
        for path, child in children_of(source)
        for child_path in shown_paths(child)
    ]


def children_of(container: Any) -> list[tuple[str, Any]]:
    """Return the visible children of a container, link group or link array, by their path from it.

    The child of a link array without element objects is the linked object of the array.
    """
    elements = elements_of(container)
    children = []
    for k, path in enumerate(container.getSubObjects()):
        child = elements[k] if k < len(elements) else container.getSubObject(path, retType=1)
        if child is not None and _is_visible(container, path.rstrip("."), child):
            children.append((path, child))
    return children


def _is_visible(container: Any, name: str, child: Any) -> bool:
    """Whether a member is visible; if FreeCAD has no separate visibility (-1), the object's own
    counts.
    """
    visible = container.isElementVisible(name)
    return bool(child.Visibility if visible < 0 else visible)


def _array(matrix: Any) -> np.ndarray:
    return np.array(matrix.A).reshape(4, 4)


def dependencies_of(source: Any) -> Dependencies:
    """Return everything that determines the shape of an object and its position in the document.

    A change of any property of these objects may change or move the shape. Stages of the workbench
    are excluded.
    """
    chain = containers_of(source)
    sources = _made_from([source])
    placed_by: list[Any] = []
    for container in chain:
        placed_by += [entry for entry in container.OutList if not _is_held(entry, container)]
    sources = _made_from([*sources, *placed_by], (*chain, *sources))
    documents = dict.fromkeys(entry.Document for entry in (source, *sources, *chain))
    return Dependencies(tuple(sources), chain, tuple(documents))


def _made_from(start: list[Any], excluded: tuple[Any, ...] = ()) -> list[Any]:
    """Return objects with all their sources, each once. excluded: objects whose inputs are not
    followed.
    """
    sources = dict.fromkeys(start)
    waiting = [entry for entry in start if entry not in excluded]
    while waiting:
        for entry in _inputs_of(waiting.pop()):
            if (
                entry not in sources
                and entry not in excluded
                and not hasattr(entry, "ResultLayout")
            ):
                sources[entry] = None
                waiting.append(entry)
    return list(sources)


def _inputs_of(obj: Any) -> Iterator[Any]:
    yield from (entry for entry in obj.OutList if entry is not None)
    linked = obj.getLinkedObject(False)
    if linked is not None and linked != obj:
        yield linked


def _is_held(obj: Any, container: Any) -> bool:
    """Whether an object is in a container, and therefore does not place the container."""
    members = (*getattr(container, "Group", ()), *elements_of(container))
    return obj in members or obj == getattr(container, "Origin", None)


class ArrayElement:
    """An element of a link array, with the attributes that readers of shapes need.

    Links of a document can only refer to objects: `object_of` creates an object.
    """

    TypeId = "App::LinkElement"
    PropertiesList = ("Label", "Shape")
    Visibility = True

    def __init__(self, array: Any, index: int) -> None:
        self.array, self.index = array, index
        self.path = f"{index}."

    @property
    def Name(self) -> str:
        """A unique string that is not the name of an object in the document."""
        return f"{self.array.Name}.{self.index}"

    @property
    def Label(self) -> str:
        return f"{self.array.Label}.{self.index}"

    @property
    def Document(self) -> Any:
        return self.array.Document

    @property
    def Shape(self) -> Any:
        return Part.getShape(self.array, self.path)

    @property
    def OutList(self) -> list[Any]:
        return [self.array]

    @property
    def OutListRecursive(self) -> list[Any]:
        return [self.array, *self.array.OutListRecursive]

    @property
    def InList(self) -> list[Any]:
        return list(self.array.InList)

    @property
    def InListRecursive(self) -> list[Any]:
        return list(self.array.InListRecursive)

    def getLinkedObject(self, *_: Any) -> Any:
        return self

    @property
    def placed_as(self) -> Any:
        """The object whose containers place the element; its shape includes the placement in the
        array already.
        """
        return self.array

    def isDerivedFrom(self, kind: str) -> bool:
        return kind == self.TypeId

    def __eq__(self, value: object) -> bool:
        if not isinstance(value, ArrayElement):
            return False
        return bool(self.array == value.array and self.index == value.index)

    def __hash__(self) -> int:
        return hash((self.array, self.index))


def element_count(obj: Any) -> int:
    """Return the number of elements of a link array, 0 for other objects."""
    return int(link_property(obj, "ElementCount") or 0)


def is_hidden_array(obj: Any) -> bool:
    """Whether an object is a link array without element objects."""
    return element_count(obj) > 0 and not elements_of(obj)


def object_of(array: Any, index: int) -> Any:
    """Return the object that represents an element of a link array, created if missing.

    If FreeCAD shows elements as objects, it is the element itself, otherwise a hidden link to it
    next to the array. Raises InputError BAD_INPUT for other objects and for missing elements.
    """
    count = max(element_count(array), len(elements_of(array)))
    if not count:
        raise InputError(
            "BAD_INPUT", array.Label, "the object is not a link array; choose the object itself"
        )
    if not 0 <= index < count:
        raise InputError(
            "BAD_INPUT",
            array.Label,
            "the array has no element {}; its {} elements are numbered from 0",
            index,
            count,
        )
    if elements_of(array):
        return elements_of(array)[index]
    path = f"{index}."
    for obj in array.InList:
        if obj.TypeId == "App::Link" and obj.LinkedObject == (array, path):
            return obj
    link = array.Document.addObject("App::Link", f"{array.Name}_{index}")
    link.Label = f"{array.Label}.{index}"
    link.setLink(array, path)
    link.LinkTransform = True  # the element is placed by the array
    link.Visibility = False  # the array shows it already
    group = array.getParentGeoFeatureGroup() or array.getParentGroup()
    if group is not None:
        group.addObject(link)
    link.recompute()
    link.purgeTouched()
    return link
