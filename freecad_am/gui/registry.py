# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panel and context menu of a stage, for modules that panels and menus import.

View providers open panels, and panels show what view providers draw: views call them by name through this module
and import neither. `views.attach` registers the functions and imports them at first use.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

_acts: dict[str, Callable[..., None]] = {}


def register(**acts: Callable[..., None]) -> None:
    """Say who does `edit`, `fill_menu_of_stage` and `fill_menu_of_job`."""
    _acts.update(acts)


def edit(obj: Any) -> None:
    """Open the panel of an existing stage."""
    _acts["edit"](obj)


def fill_menu_of_stage(menu: Any, obj: Any) -> None:
    """Add the entries of a stage to its context menu in the tree."""
    _acts["fill_menu_of_stage"](menu, obj)


def fill_menu_of_job(menu: Any, group: Any) -> None:
    """Add the entries of a whole job to its context menu in the tree."""
    _acts["fill_menu_of_job"](menu, group)
