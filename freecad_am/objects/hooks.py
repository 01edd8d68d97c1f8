# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the GUI hooks in: objects never import it, they only say that they are there.

InitGui names the module; it is imported when the first object of ours appears.
"""

from __future__ import annotations

import importlib
from typing import Any

import FreeCAD as App

_module: str | None = None


def register(module: str) -> None:
    """Name the module whose function `attach(obj)` gives an object its view provider and draws what is stored."""
    global _module
    _module = module


def attach(obj: Any) -> None:
    """Show the object where there is a window: when it is made, and when a document (also a headless one) opens."""
    if App.GuiUp and _module and getattr(obj, "ViewObject", None) is not None:
        importlib.import_module(_module).attach(obj)
