# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes FreeCAD importable, or raises an error that says it is missing."""

from __future__ import annotations

from ..core.issues import InputError
from . import host


def require_freecad() -> None:
    """Make FreeCAD importable. Raises InputError NO_FREECAD where this Python has none."""
    if not host.find_freecad():
        raise InputError(
            "NO_FREECAD",
            "Python",
            "FreeCAD cannot be imported; set FREECAD_AM_PYTHON to a Python that can",
        )
