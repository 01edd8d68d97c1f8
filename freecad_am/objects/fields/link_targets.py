# SPDX-License-Identifier: LGPL-2.1-or-later
"""What links of a document point to, while it may be gone."""

from __future__ import annotations

from typing import Any

LINKS = ("App::Link", "App::LinkElement")


def broken_link(value: Any) -> str:
    """The label of a FreeCAD link that shows nothing because its object is gone, '' when all is well."""
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
