# SPDX-License-Identifier: LGPL-2.1-or-later
"""Elements of link arrays that FreeCAD does not show as objects (`ShowElement` or, of Draft, `ExpandArray` is false)."""

from __future__ import annotations

from typing import Any

import Part

from ...core.issues import InputError
from .places import elements_of, link_property


class ArrayElement:
    """An element of a link array, with the attributes that readers of shapes need.

    Links of a document can only hold objects: `object_of` makes one.
    """

    TypeId = "App::LinkElement"
    PropertiesList = ("Label", "Shape")
    Visibility = True

    def __init__(self, array: Any, index: int) -> None:
        self.array, self.index = array, index
        self.path = f"{index}."

    @property
    def Name(self) -> str:
        """Not a name in the document, but as unique."""
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
        """The object whose containers place it: the shape of the element has the place in its array already."""
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
    """How many elements a link array has, 0 for other objects."""
    return int(link_property(obj, "ElementCount") or 0)


def is_hidden_array(obj: Any) -> bool:
    """Whether an object is a link array whose elements are no objects."""
    return element_count(obj) > 0 and not elements_of(obj)


def object_of(array: Any, index: int) -> Any:
    """The object that represents an element of a link array, created if missing.

    It is the element itself where FreeCAD shows elements as objects, else a hidden link to it, next
    to the array. InputError BAD_INPUT for another object than a link array, and for an element that
    it does not have.
    """
    count = max(element_count(array), len(elements_of(array)))
    if not count:
        raise InputError(
            "BAD_INPUT", array.Label, "it is not a link array; choose the object itself"
        )
    if not 0 <= index < count:
        raise InputError(
            "BAD_INPUT",
            array.Label,
            "it has no element {}; its {} elements are numbered from 0",
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
