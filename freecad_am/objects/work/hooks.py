# SPDX-License-Identifier: LGPL-2.1-or-later
"""Hooks for the GUI: objects never import the GUI, they only announce themselves and long work.

InitGui names the GUI module, which is imported when our first object appears.
"""

from __future__ import annotations

import importlib
import threading
from collections.abc import Callable
from typing import Any, TypeVar

import FreeCAD as App

T = TypeVar("T")


class _Window:
    """The window, once it has registered. module: name of its module with `attach` and `carry_out`;
    '' without a window. is_waiting: whether it waits for long work.
    """

    def __init__(self) -> None:
        self.module = ""
        self.is_waiting = False


_window = _Window()


def register(module: str) -> None:
    """Name the module with the functions `attach(obj)`, which gives an object its view provider and
    draws the stored result, and `carry_out(work, title, doing)`, which does long work while the
    window stays alive.
    """
    _window.module = module


def attach(obj: Any) -> None:
    """Show the object in a window: when it is made, and when a document (also a headless one)
    opens.
    """
    if App.GuiUp and _window.module and getattr(obj, "ViewObject", None) is not None:
        importlib.import_module(_window.module).attach(obj)


def carry_out(work: Callable[[], T], title: str, doing: str = "") -> T:
    """What `work` returns or raises. It must touch no document: in the window it runs in another
    thread. doing: the text shown there until `work` reports progress.

    Raises Cancelled when the user cancels it.
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
    """Whether the window is waiting for work: what events bring about meanwhile must not start another one."""
    return _window.is_waiting
