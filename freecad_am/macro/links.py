# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links of stages as macros give them: anything else in their place is refused before an object is made."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..core.issues import InputError
from ..core.parameters.field import unknown_choice
from ..core.strategies.sequence import BY_FEATURE, BY_HEIGHT
from ..objects.shapes.nested import resolved
from ..objects.stage_parts import Link
from .arguments import checked_names, checked_object, checked_objects, checked_text

TEXTS = {
    "ProgramName": "name",
    "File": "file",
}  # properties that stand with links, and what macros call them


def checked_links(
    doc: Any, links: Sequence[Link], values: dict[str, Any], of: Any = None
) -> dict[str, Any]:
    """Values of links, by their names, as properties take them, and of what stands with them; None as it is. of: the stage
    whose they will be, where it is there already.

    InputError BAD_INPUT by the key of the link, and that of a path to a face or edge that is not there.
    """
    known = {link.name: link for link in links}
    found = dict(values)
    for name, value in values.items():
        if name in known and value is not None:
            found[name] = _checked(doc, known[name], value)
        elif name in TEXTS:
            checked_text(value, TEXTS[name])
        elif name == "Sequence" and checked_text(value, "sequence") not in (BY_FEATURE, BY_HEIGHT):
            raise unknown_choice("sequence", value, (BY_FEATURE, BY_HEIGHT))
    after = [] if of is None else [of, *of.InListRecursive]
    for name in found.keys() & known.keys():
        for one in _objects(found[name]):
            if one in after:  # FreeCAD takes it, and falls over it
                raise InputError(
                    "BAD_INPUT",
                    known[name].key,
                    "{} is made from {} itself; choose another object",
                    one.Label,
                    of.Label,
                )
    return found


def _objects(value: Any) -> list[Any]:
    """The objects of a link as a property takes it."""
    if value is None:
        return []
    return value if isinstance(value, list) else [value[0] if isinstance(value, tuple) else value]


def _checked(doc: Any, link: Link, value: Any) -> Any:
    if link.many:
        return checked_objects(value, link.key, doc)
    if link.type_name != "App::PropertyLinkSub":
        return checked_object(value, link.key, doc)
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        return checked_object(value, link.key, doc), []
    owner = checked_object(value[0], link.key, doc)
    return resolved(owner, checked_names(value[1], link.key), link.key)
