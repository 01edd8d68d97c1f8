# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links of stages as macros give them: anything else in their place is refused before an object is made."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..objects.shapes.nested import resolved
from ..objects.stage_parts import Link
from .arguments import checked_names, checked_object, checked_objects


def checked_links(doc: Any, links: Sequence[Link], values: dict[str, Any]) -> dict[str, Any]:
    """Values of links, by their names, as properties take them; what is no link, and None, as it is. InputError BAD_INPUT by
    the key of the link, and that of a path to a face or edge that is not there."""
    known = {link.name: link for link in links}
    return {name: _checked(doc, known[name], value) if name in known and value is not None else value
            for name, value in values.items()}


def _checked(doc: Any, link: Link, value: Any) -> Any:
    if link.many:
        return checked_objects(value, link.key, doc)
    if link.type_name != "App::PropertyLinkSub":
        return checked_object(value, link.key, doc)
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        return checked_object(value, link.key, doc), []
    owner = checked_object(value[0], link.key, doc)
    return resolved(owner, checked_names(value[1], link.key), link.key)
