# SPDX-License-Identifier: LGPL-2.1-or-later
"""Hooks for the GUI: objects never import the GUI, but announce themselves and long work.

InitGui registers the GUI module, which is imported with the first object of the workbench.
"""

from __future__ import annotations

import importlib
import threading
from collections.abc import Callable
from typing import Any, TypeVar

import FreeCAD as App

T = TypeVar("T")


class _Window:
    """State of the window.

    module: name of the module with `attach` and `carry_out`, '' without a window. is_waiting:
    whether the window waits for long work.
    """

    def __init__(self) -> None:
        self.module = ""
        self.is_waiting = False


_window = _Window()


def register(module: str) -> None:
    """Register the GUI module, which has two functions.

    `attach(obj)` gives an object its view provider and draws the stored result. `carry_out(work,
    title, doing)` runs long work while the window stays responsive.
    """
    _window.module = module


def attach(obj: Any) -> None:
    """Show an object in the window, when the object is made or its document opens."""
    if App.GuiUp and _window.module and getattr(obj, "ViewObject", None) is not None:
        importlib.import_module(_window.module).attach(obj)


def carry_out(work: Callable[[], T], title: str, doing: str = "") -> T:
    """Run `work` and return its result. In the window, `work` runs in another thread.

    `work` must not touch documents. doing: text to show until `work` reports progress. Raises
    Cancelled if the user cancels, and the errors of `work`.
    """
    if (
        not (App.GuiUp and _window.module)
        or threading.current_thread() is not threading.main_thread()
    ):
        return work()
    _window.is_waiting = True
    try:
        result: T = importlib.import_module(_window.module).carry_out(work, title, doing)
        return result
    finally:
        _window.is_waiting = False


def carrying() -> bool:
    """Whether the window waits for work. Event handlers must not start more work then."""
    return _window.is_waiting
