# SPDX-License-Identifier: LGPL-2.1-or-later
"""What objects are nested in: parts, assemblies, bodies, groups of links."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any


def members_of(container: Any) -> tuple[Any, ...]:
    """The objects that stand where a container puts them; () for what is none."""
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
    """What follows a change of an object: objects that are made of it, or stand where an expression of it puts their container
    once that is recomputed; and those that may stand elsewhere by now, as the object contains them. Neighbours in a container
    that holds the object are not among them."""
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
    return list(made_of), [one for one in _followers_within(obj) if one not in made_of]


def _followers_within(container: Any) -> dict[Any, None]:
    """What a container holds, and all that is made of that."""
    members = list(_with_members(members_of(container)))
    return dict.fromkeys(each for member in members for each in (member, *member.InListRecursive))


def _with_members(members: tuple[Any, ...]) -> Iterator[Any]:
    """Members and what they contain."""
    visited: set[str] = set()
    waiting = list(members)
    while waiting:
        member = waiting.pop()
        if member.FullName not in visited:
            visited.add(member.FullName)
            yield member
            waiting += members_of(member)
