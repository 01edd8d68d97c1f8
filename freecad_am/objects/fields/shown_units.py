# SPDX-License-Identifier: LGPL-2.1-or-later
"""The units that a user reads and types: FreeCAD's unit scheme, and the preferred unit of speeds.

Job files, CSV, programs and reports of commands are metric whatever the scheme is.
"""

from __future__ import annotations

import math
import re

import FreeCAD as App

from ...core.quantities import (
    UNITS,
    exact_or_rounded,
    in_other_units,
    significant,
    without_exponents,
)
from . import preferences
from .unit_scheme import is_metric, plain_name, scheme_unit

ORDINARY = {"mm": 10.0, "mm/s": 6.0}  # values that decide the unit of a field without a number
_BARE = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_LEAST_OF_FEET = 0.1  # square or cubic feet; less is in inches
_METRIC = re.compile(r"(?:µ|n|m|c|k)?m(?:\^[23]|²|³)?(?:/.*)?|ml|l|k?g|t")


def conversion(value: float, unit: str) -> tuple[float, str] | None:
    """How many of the unit that is shown make one `unit`, and its name, as `core.quantities.in_other_units` asks; None
    where the quantity is shown as it is."""
    if App.Units.Quantity(f"1 {unit}").Unit == App.Units.Velocity:
        return _speed_conversion(unit)
    if is_metric() or not math.isfinite(value):
        return None
    per_unit, name = scheme_unit(value, unit)
    if plain_name(name).startswith("ft") and abs(value) < _LEAST_OF_FEET * per_unit:
        per_unit, name = _in_inches(per_unit, plain_name(name))
    if name == unit or (_METRIC.fullmatch(name) and not _is_length(unit)):
        return None
    return 1.0 / per_unit, _format_powers(plain_name(name))


def _in_inches(per_unit: float, name: str) -> tuple[float, str]:
    """Square or cubic inches for square or cubic feet."""
    power = {"ft^2": 2, "ft²": 2, "ft^3": 3, "ft³": 3}.get(name)
    return (per_unit, name) if power is None else (per_unit / 12.0**power, f"in^{power}")


def scale_of(largest: float, unit: str) -> tuple[float, str]:
    """The factor from `unit` to the displayed unit, and the name of the displayed unit, for values
    up to `largest` on a plot axis, legend or column.
    """
    base, per_hour, _ = unit.partition("/h")
    converted = conversion(largest, UNITS[base]) if base in UNITS else None
    return (1.0, unit) if converted is None else (converted[0], converted[1] + per_hour)


def _speed_conversion(unit: str) -> tuple[float, str] | None:
    preferred, display_unit = preferences.preferred_speed_unit(), preferences.speed_unit()
    if display_unit == unit or (not preferred and display_unit == "mm/s"):
        return None  # mm/min and m/min, as is usual of torches and wire, are metric as well
    return float(App.Units.Quantity(f"1 {unit}").getValueAs(display_unit).Value), display_unit


def _is_length(unit: str) -> bool:
    return bool(App.Units.Quantity(f"1 {unit}").Unit == App.Units.Length)


def _format_powers(name: str) -> str:
    return name.replace("^2", "²").replace("^3", "³")


def window_is_open() -> bool:
    """Whether this is FreeCAD with its window, and not a command."""
    return bool(App.GuiUp)


def in_user_units(text: str) -> str:
    """A text of numbers in mm, mm/s and so on, with these in the user's units and without exponents; no names of users may
    be in it."""
    return in_other_units(without_exponents(text), conversion)


def quantity_text(value: float, unit: str, digits: int = 4) -> str:
    """A quantity for people, in the user's units. value: in `unit`, one of `core.quantities.UNITS`, or deg, s or %."""
    converted = conversion(value, UNITS[unit]) if unit in UNITS else None
    factor, name = (1.0, unit) if converted is None else converted
    return f"{significant(value * factor, digits)} {name}"


def field_text(value: float, unit: str, display: str = "") -> tuple[str, float, str]:
    """The display of a value in `unit` in a field: the text, the number of `unit` per bare number,
    and the unit's name.

    display: the display unit; '' for FreeCAD's scheme. A fraction of inches is shown where it is
    the value.
    """
    if display:
        per_unit = App.Units.Quantity(f"1 {display}").getValueAs(unit).Value
        return f"{exact_or_rounded(value / per_unit)} {display}", per_unit, display
    per_unit, name = scheme_unit(value or ORDINARY.get(unit, 0.0), unit)
    fraction = _fraction(value, unit, name)
    display_name = plain_name(name) if name in ('"', "'") else name
    return (
        fraction or f"{exact_or_rounded(value / per_unit)} {display_name}",
        per_unit,
        display_name,
    )


def _fraction(value: float, unit: str, name: str) -> str:
    """The value in feet and fractions of inches, '' where the scheme has none or it would be another value."""
    if name != "in" or value == 0.0:
        return ""
    quantity = App.Units.Quantity(f"{value!r} {unit}")
    text = str(quantity.UserString)
    if not text.endswith(("'", '"')):
        return ""
    parsed = feet_and_inches(text)
    return text if parsed is not None and math.isclose(parsed, quantity.Value, rel_tol=1e-9) else ""


_FEET = re.compile(
    r"\s*(?P<sign>[-+]?)\s*(?:(?P<feet>\d+(?:\.\d+)?)\s*')?\s*"
    r"(?:(?P<inches>(?:\d+(?:\.\d+)?\"?(?:\s*\+\s*|\s+))?\d+\s*/\s*\d+|\d+(?:\.\d+)?)\s*(?:\"|in))?\s*"
)


def feet_and_inches(text: str) -> float | None:
    """Millimetres of `1' 7+5/8"`, `1 1/2 in` and the like; None for another text. FreeCAD reads `-1' 3"` as -12 + 3 in."""
    match = _FEET.fullmatch(text.replace("′", "'").replace("″", '"'))
    if match is None or (match["feet"] is None and match["inches"] is None):
        return None
    inches = 12.0 * float(match["feet"] or 0.0)
    for summand in re.split(
        r"\s*\+\s*|(?<=\d)\s+(?=\d)", (match["inches"] or "0").replace('"', "")
    ):
        above, _, below = summand.partition("/")
        if below and float(below) == 0.0:
            return None
        inches += float(above) / float(below or 1.0)
    return 25.4 * (-inches if match["sign"] == "-" else inches)


def round_conversion(value: float) -> float:
    """A number typed in one unit, in another one, without the last digits that conversion leaves."""
    return float(f"{value:.14g}")


def typed_text(text: str, unit: str, per_bare: float) -> str:
    """A text typed into a plain line, for a parameter in `unit`: a number without a unit is
    multiplied by `per_bare`. Other texts, such as words, stay.
    """
    inches = feet_and_inches(text) if unit == "mm" else None
    if inches is not None:
        return f"{round_conversion(inches)!r} mm"
    if per_bare != 1.0 and _BARE.fullmatch(text):
        return f"{round_conversion(float(text) * per_bare)!r} {unit}"
    return text
