# SPDX-License-Identifier: LGPL-2.1-or-later
"""Containers of objects: parts, assemblies, bodies and link groups."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any


def members_of(container: Any) -> tuple[Any, ...]:
    """Return the objects that a container places; () for other objects."""
    members: list[Any] = []
    for name in ("Group", "ElementList"):
        value = getattr(container, name, None)
        if isinstance(value, (list, tuple)):
            members += [member for member in value if hasattr(member, "InList")]
    return tuple(members)


def containers_of(obj: Any) -> list[Any]:
    """Return all containers of an object, the innermost first."""
    nested: list[Any] = []
    waiting = [obj]
    while waiting:
        inner = waiting.pop(0)
        for outer in inner.InList:
            if outer not in nested and inner in members_of(outer):
                nested.append(outer)
                waiting.append(outer)
    return nested


def dependents_of(obj: Any) -> tuple[list[Any], list[Any]]:
    """Return two lists of objects that a change of an object affects.

    The first list contains objects made from the object, or placed by a container whose expression
    refers to the object. The second list contains objects inside the object, which may have moved.
    Neighbours in a container of the object are not included.
    """
    made_of: dict[Any, None] = {}
    waiting = [(obj, False)]
    while waiting:
        inner, moves = waiting.pop()
        if moves:
            made_of |= _followers_within(inner)
        for outer in inner.InList:
            if outer not in made_of:
                made_of[outer] = None
                waiting.append((outer, inner not in members_of(outer)))
    return list(made_of), [
        follower for follower in _followers_within(obj) if follower not in made_of
    ]


def _followers_within(container: Any) -> dict[Any, None]:
    """Return the members of a container, and all objects made from them."""
    members = list(_walk_members(members_of(container)))
    return dict.fromkeys(
        follower for member in members for follower in (member, *member.InListRecursive)
    )


def _walk_members(members: tuple[Any, ...]) -> Iterator[Any]:
    """Yield members and their contents."""
    visited: set[str] = set()
    waiting = list(members)
    while waiting:
        member = waiting.pop()
        if member.FullName not in visited:
            visited.add(member.FullName)
            yield member
            waiting += members_of(member)


# ---- Links of a document with possibly deleted targets

LINKS = ("App::Link", "App::LinkElement")


def broken_link(value: Any) -> str:
    """Return the label of the first FreeCAD link with a missing target, '' without such a link."""
    for entry in value if isinstance(value, list) else [value]:
        linked = entry[0] if isinstance(entry, tuple) else entry
        if linked is not None and links_to_nothing(linked):
            return str(linked.Label)
    return ""


def links_to_nothing(obj: Any) -> bool:
    """Whether an object is a FreeCAD link whose target is deleted or not loaded.

    A link array is its own linked object.
    """
    if getattr(obj, "TypeId", "") not in LINKS:
        return False
    target = obj.LinkedObject[0] if isinstance(obj.LinkedObject, tuple) else obj.LinkedObject
    return target is None or obj.getLinkedObject() is None


def is_there(obj: Any) -> bool:
    """Whether an object still exists in an open document."""
    try:
        return obj.Document is not None and obj.Document.getObject(obj.Name) is not None
    except (ReferenceError, RuntimeError, AttributeError, TypeError):
        return False
