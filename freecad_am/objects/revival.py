# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gives objects their proxies back that were saved by a FreeCAD in which the workbench was not installed.

FreeCAD imports proxies of installed addons only and saves an object without its proxy when it could not. All else is
in properties, the class of the proxy included.
"""

from __future__ import annotations

import importlib
from typing import Any

from .stage import CLASS_PROPERTY, Stage, stage_of

_PACKAGE_PREFIX = __name__.rpartition(".")[0] + "."


def revive(document: Any) -> None:
    """Restore the proxies that the document lost."""
    for obj in document.Objects:
        if stage_of(obj) is None and CLASS_PROPERTY in obj.PropertiesList:
            cls = _stage_class(getattr(obj, CLASS_PROPERTY))
            if cls is not None:
                cls(obj)


def _stage_class(path: str) -> type[Stage] | None:
    """The stage of a class path, None unless it is one of ours."""
    module, _, name = path.rpartition(".")
    if not module.startswith(_PACKAGE_PREFIX):
        return None
    try:
        candidate = getattr(importlib.import_module(module), name, None)
    except ImportError:
        return None
    return candidate if isinstance(candidate, type) and issubclass(candidate, Stage) else None
