# SPDX-License-Identifier: LGPL-2.1-or-later
"""Objects of other workbenches, which a FreeCAD may be without."""

from __future__ import annotations

from typing import Any

from ..core.issues import InputError


def lacking(what: str, workbench: str, otherwise: str) -> InputError:
    """The error that a workbench is not there, and what to do."""
    return InputError(
        "NO_MODULE",
        what,
        "this FreeCAD has no {} workbench; install it or {} instead",
        workbench,
        otherwise,
    )


def added(document: Any, kind: str, name: str, label: str) -> Any:
    """A new object of such a workbench in a document."""
    obj = document.addObject(kind, name)
    obj.Label = label
    return obj
