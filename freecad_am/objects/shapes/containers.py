# SPDX-License-Identifier: LGPL-2.1-or-later
"""What objects are nested in: parts, assemblies, bodies, groups of links."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any


def members_of(container: Any) -> tuple[Any, ...]:
    """The objects that a container places; () for other objects."""
    members: list[Any] = []
    for name in ("Group", "ElementList"):
        value = getattr(container, name, None)
        if isinstance(value, (list, tuple)):
            members += [member for member in value if hasattr(member, "InList")]
    return tuple(members)


def containers_of(obj: Any) -> list[Any]:
    """All that an object is nested in, the innermost first."""
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
    """The objects affected by a change of an object: first the ones made from it, or placed by a
    container whose expression refers to it, once that is recomputed; then the ones that it contains
    and may have moved. Neighbours in a container of the object are not included.
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
    """The members of a container, and everything made from them."""
    members = list(_walk_members(members_of(container)))
    return dict.fromkeys(
        follower for member in members for follower in (member, *member.InListRecursive)
    )


def _walk_members(members: tuple[Any, ...]) -> Iterator[Any]:
    """Members and their contents."""
    visited: set[str] = set()
    waiting = list(members)
    while waiting:
        member = waiting.pop()
        if member.FullName not in visited:
            visited.add(member.FullName)
            yield member
            waiting += members_of(member)


# ---- What links of a document point to, while it may be gone

LINKS = ("App::Link", "App::LinkElement")


def broken_link(value: Any) -> str:
    """Label of the first FreeCAD link whose object is gone; '' if there is none."""
    for entry in value if isinstance(value, list) else [value]:
        linked = entry[0] if isinstance(entry, tuple) else entry
        if linked is not None and links_to_nothing(linked):
            return str(linked.Label)
    return ""


def links_to_nothing(obj: Any) -> bool:
    """Whether an object is a FreeCAD link whose object is gone or was not loaded. A link array is its own linked object."""
    if getattr(obj, "TypeId", "") not in LINKS:
        return False
    target = obj.LinkedObject[0] if isinstance(obj.LinkedObject, tuple) else obj.LinkedObject
    return target is None or obj.getLinkedObject() is None


def is_there(obj: Any) -> bool:
    """Whether an object is still part of an open document."""
    try:
        return obj.Document is not None and obj.Document.getObject(obj.Name) is not None
    except (ReferenceError, RuntimeError, AttributeError, TypeError):
        return False
