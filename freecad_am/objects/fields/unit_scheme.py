# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's unit scheme: the unit in which it shows a quantity (Edit > Preferences > General > Units)."""

from __future__ import annotations

import FreeCAD as App

_NAMES = {'"': "in", "'": "ft", "sqft": "ft²", "cft": "ft³"}
_ORDINARY_MM = 10.0  # a length that identifies a scheme: 10 mm, 0.394 in


def scheme_unit(value: float, unit: str) -> tuple[float, str]:
    """How many of `unit` one of the unit is in which FreeCAD's scheme shows a value, and that unit's name."""
    quantity = App.Units.Quantity(f"{value!r} {unit}")
    per_unit = App.Units.Quantity(f"1 {unit}").Value
    _, factor, name = quantity.getUserPreferred()
    if "*" in name or "(" in name or not factor > 0.0:
        return 1.0, unit
    return factor / per_unit, str(name)


def plain_name(name: str) -> str:
    """The name of a unit in words: `in` for FreeCAD's double prime."""
    return _NAMES.get(name, name)


def is_metric() -> bool:
    """Whether the scheme shows lengths of usual parts in mm."""
    return scheme_unit(_ORDINARY_MM, "mm")[1] == "mm"


def scheme_speed_unit() -> str:
    """The unit that the scheme shows travel speeds in."""
    return plain_name(scheme_unit(6.0, "mm/s")[1])
