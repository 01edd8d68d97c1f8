# SPDX-License-Identifier: LGPL-2.1-or-later
"""What links of a document point to, while it may be gone."""

from __future__ import annotations

from typing import Any


def broken_link(value: Any) -> str:
    """The label of a FreeCAD link whose object is gone, '' when all is well."""
    for one in value if isinstance(value, list) else [value]:
        linked = one[0] if isinstance(one, tuple) else one
        if getattr(linked, "TypeId", "") == "App::Link" and linked.getLinkedObject() in (
            None,
            linked,
        ):
            return str(linked.Label)
    return ""


def is_there(obj: Any) -> bool:
    """Whether an object is still part of an open document."""
    try:
        return obj.Document is not None and obj.Document.getObject(obj.Name) is not None
    except (ReferenceError, RuntimeError, AttributeError, TypeError):
        return False
