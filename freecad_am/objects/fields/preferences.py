# SPDX-License-Identifier: LGPL-2.1-or-later
"""Preferences of the user in FreeCAD's parameters; only this module reads and writes them.

Preferences belong to the window: its proposals, its display and its folders. They have no effect
without a window, so that a job gives the same program on every computer.
"""

from __future__ import annotations

import math
import os
import re
from typing import Any

import FreeCAD as App

from ...core.number_texts import (
    UNITS,
    exact_or_rounded,
    expand_exponents,
    in_other_units,
    significant,
)
from ...core.parameters.cell import CellParameters
from ...core.parameters.process import ProcessParameters
from . import rows

_NAMES = {'"': "in", "'": "ft", "sqft": "ft²", "cft": "ft³"}
_ORDINARY_MM = 10.0  # a length that identifies a scheme: 10 mm, 0.394 in


def scheme_unit(value: float, unit: str) -> tuple[float, str]:
    """Return the unit in which FreeCAD's scheme shows a value: its size in `unit`, and its name."""
    quantity = App.Units.Quantity(f"{value!r} {unit}")
    per_unit = App.Units.Quantity(f"1 {unit}").Value
    _, factor, name = quantity.getUserPreferred()
    if "*" in name or "(" in name or not factor > 0.0:
        return 1.0, unit
    return factor / per_unit, str(name)


def plain_name(name: str) -> str:
    """Return the name of a unit in words: `in` for FreeCAD's double prime."""
    return _NAMES.get(name, name)


def is_metric() -> bool:
    """Whether the scheme shows lengths of usual parts in mm."""
    return scheme_unit(_ORDINARY_MM, "mm")[1] == "mm"


def scheme_speed_unit() -> str:
    """Return the unit in which the scheme shows travel speeds."""
    return plain_name(scheme_unit(6.0, "mm/s")[1])


GROUP = "User parameter:BaseApp/Preferences/Mod/RoboticAM"
UNIT_SETTINGS, SCHEME = "User parameter:BaseApp/Preferences/Units", "UserSchema"  # of FreeCAD
SPEED_UNITS = {  # factor from mm/s
    "mm/s": 1.0,
    "mm/min": 60.0,
    "m/min": 0.06,
    "in/min": 60.0 / 25.4,
    "ft/min": 60.0 / 304.8,
}
SHOWN = ("SpeedUnit", "Ramp", "MachineColour")  # entries that affect display and texts
RAMPS = ("blue to yellow", "violet to orange", "grey")
MACHINE_COLOUR = (0.86, 0.87, 0.88)
# parameters of the process that are proposed for new toolpaths, by row key
PROCESS = (
    "travel_speed",
    "bead_width",
    "wire_diameter",
    "wire_feed",
    "density",
    "lead_on",
    "lead_off",
    "between_layers_wait",
)


def text(name: str, default: str = "") -> str:
    """Return a text entry."""
    return str(App.ParamGet(GROUP).GetString(name, default)) if App.GuiUp else default


def keep(name: str, value: str) -> None:
    """Store a text entry; '' removes the entry."""
    if value:
        App.ParamGet(GROUP).SetString(name, value)
    else:
        App.ParamGet(GROUP).RemString(name)


def builtin_machine() -> str:
    """Return the machine of new cells without a preference."""
    return CellParameters().machine


def machine() -> str:
    """Return the machine of new cells."""
    return text("Machine") or builtin_machine()


def post() -> str:
    """Return the post of new programs, '' for the post that the controller of the machine reads."""
    return text("Post")


def machine_folder() -> str:
    """Return the additional folder of machine files, '' for none."""
    return text("MachineFolder")


def programs_folder() -> str:
    """Return the default folder of programs: the preferred folder, else the last one used.

    '' means next to the document.
    """
    return text("ProgramsFolder") or text("ExportFolder")


def process_rows() -> tuple[rows.Row, ...]:
    """Return the process parameters with a preference."""
    return tuple(row for row in rows.rows(ProcessParameters) if row.key in PROCESS)


def label(row: rows.Row) -> str:
    """Return the label on the preferences page: 'Wire diameter', 'Wait between layers'."""
    *leading, final = (str(step).replace("_", " ") for step in row.path)
    words = [final, *leading] if leading and leading[0].startswith("between") else [*leading, final]
    return " ".join(words).capitalize() + (f" ({row.spec.unit})" if row.spec.unit else "")


def process() -> dict[str, Any]:
    """Return preferred process values that replace the defaults, by row key in outer units."""
    values: dict[str, Any] = {}
    for row in process_rows() if App.GuiUp else ():
        number = App.ParamGet(GROUP).GetFloat(row.name, math.nan)
        value = (
            text(row.name) or number if row.form == rows.MIXED else number
        )  # entries with words were numbers in earlier versions
        if value != row.outer(row.default) and value == value:
            values[row.key] = value
    return values


def keep_process(values: dict[str, Any]) -> None:
    """Store values in outer units by row key, as texts for rows with words; defaults leave no
    entry.
    """
    for row in process_rows():
        if row.key in values and row.form == rows.MIXED:
            App.ParamGet(GROUP).RemFloat(row.name)
            keep(row.name, "" if values[row.key] == row.outer(row.default) else values[row.key])
        elif row.key in values and values[row.key] != row.outer(row.default):
            App.ParamGet(GROUP).SetFloat(row.name, values[row.key])
        elif row.key in values:
            App.ParamGet(GROUP).RemFloat(row.name)


def check(row: rows.Row, value: Any) -> None:
    """Raise InputError if the process parameters reject the inner value."""
    rows.build(ProcessParameters, {row.key: value})


def proposed(section: str, row: rows.Row) -> Any:
    """Return the proposed inner value of a parameter in the panel of a new stage.

    This is the preferred value, or else the default.
    """
    preferred: dict[str, Any] = {}
    if section == "cell":
        preferred = {"machine": machine()}
    elif section == "process":
        preferred = process()
    elif section == "program" and post():
        preferred = {"post": post()}
    return row.inner(preferred[row.key], row.name) if row.key in preferred else row.default


# ---- display


def preferred_speed_unit() -> str:
    """Return the unit of speeds that the user has chosen, '' for the unit of FreeCAD's scheme."""
    unit = text("SpeedUnit")
    return unit if unit in SPEED_UNITS else ""


def speed_unit() -> str:
    """Return the unit of displayed speeds: the chosen unit, else the unit of FreeCAD's scheme."""
    return preferred_speed_unit() or scheme_speed_unit()


def speed(value: float) -> float:
    """Format a speed in mm/s in the unit of displayed speeds."""
    unit = speed_unit()
    if unit in SPEED_UNITS:
        return value * SPEED_UNITS[unit]
    return float(value * App.Units.Quantity("1 mm/s").getValueAs(unit).Value)


def ramp() -> str:
    """Return the name of the colour ramp, a key of RAMPS."""
    name = text("Ramp", RAMPS[0])
    return name if name in RAMPS else RAMPS[0]


def machine_colour() -> tuple[float, float, float]:
    """Return the colour of machines without own colours, 0..1 each."""
    packed = text("MachineColour")
    try:
        red, green, blue = (int(packed[start : start + 2], 16) / 255.0 for start in (1, 3, 5))
    except ValueError:
        return MACHINE_COLOUR
    return red, green, blue


def existing(folder: str) -> bool:
    """Whether a folder is named and exists."""
    return bool(folder) and os.path.isdir(folder)


ORDINARY = {"mm": 10.0, "mm/s": 6.0}  # values that decide the unit of a field without a number
_BARE = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_LEAST_OF_FEET = 0.1  # square or cubic feet; less is in inches
_METRIC = re.compile(r"(?:µ|n|m|c|k)?m(?:\^[23]|²|³)?(?:/.*)?|ml|l|k?g|t")


def conversion(value: float, unit: str) -> tuple[float, str] | None:
    """Return the number of displayed units per `unit` and the name of the displayed unit.

    This has the form that `core.number_texts.in_other_units` needs; None if the quantity is
    displayed unchanged.
    """
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
    """Return square or cubic inches for square or cubic feet."""
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
    preferred, display_unit = preferred_speed_unit(), speed_unit()
    if display_unit == unit or (not preferred and display_unit == "mm/s"):
        return None  # mm/min and m/min, as is usual of torches and wire, are metric as well
    return float(App.Units.Quantity(f"1 {unit}").getValueAs(display_unit).Value), display_unit


def _is_length(unit: str) -> bool:
    return bool(App.Units.Quantity(f"1 {unit}").Unit == App.Units.Length)


def _format_powers(name: str) -> str:
    return name.replace("^2", "²").replace("^3", "³")


def window_is_open() -> bool:
    """Whether FreeCAD runs with its window."""
    return bool(App.GuiUp)


def in_user_units(text: str) -> str:
    """Convert the quantities in a text in mm, mm/s and so on to the user's units, without
    exponents.

    The text must not contain names chosen by users.
    """
    return in_other_units(expand_exponents(text), conversion)


def quantity_text(value: float, unit: str, digits: int = 4) -> str:
    """Format a quantity in the user's units.

    value: in `unit`, one of `core.number_texts.UNITS`, or deg, s or %.
    """
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
    """Format the value in feet and fractions of inches.

    '' if the scheme has no fractions, or if the fraction would be another value.
    """
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
    """Convert a text such as `1' 7+5/8"` or `1 1/2 in` to millimetres; None for other texts.

    FreeCAD reads `-1' 3"` as -12 + 3 in.
    """
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
    """Round a converted number to the digits that were typed."""
    return float(f"{value:.14g}")


def typed_text(text: str, unit: str, per_bare: float) -> str:
    """Complete a text typed for a parameter in `unit`: multiply a number without unit by
    `per_bare`.

    Other texts, such as words, are unchanged.
    """
    inches = feet_and_inches(text) if unit == "mm" else None
    if inches is not None:
        return f"{round_conversion(inches)!r} mm"
    if per_bare != 1.0 and _BARE.fullmatch(text):
        return f"{round_conversion(float(text) * per_bare)!r} {unit}"
    return text
