# SPDX-License-Identifier: LGPL-2.1-or-later
"""Look up panel and context menu of a stage without importing panels and menus.

View providers open panels, and panels show the drawings of view providers. Views therefore call
panels and menus by name through this module. `views.attach` registers the functions and imports
them at first use.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

_acts: dict[str, Callable[..., None]] = {}


def register(**acts: Callable[..., None]) -> None:
    """Register the functions `edit`, `fill_menu_of_stage` and `fill_menu_of_job`."""
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
