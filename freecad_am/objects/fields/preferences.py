# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a user prefers, from FreeCAD's parameters: the only place that reads and writes them.

Preferences belong to the window: its proposals, its display and its folders. They have no effect
without a window, so that a job gives the same program on every computer.
"""

from __future__ import annotations

import math
import os
from typing import Any

import FreeCAD as App

from ...core.parameters.cell import CellParameters
from ...core.parameters.process import ProcessParameters
from . import rows
from .unit_scheme import scheme_speed_unit

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
    """An entry that is a text."""
    return str(App.ParamGet(GROUP).GetString(name, default)) if App.GuiUp else default


def keep(name: str, value: str) -> None:
    """Keep a text as an entry; '' removes it."""
    if value:
        App.ParamGet(GROUP).SetString(name, value)
    else:
        App.ParamGet(GROUP).RemString(name)


def builtin_machine() -> str:
    """The machine of new cells where none is preferred."""
    return CellParameters().machine


def machine() -> str:
    """The machine of new cells."""
    return text("Machine") or builtin_machine()


def post() -> str:
    """The post of new programs, '' for what the controller of the machine reads."""
    return text("Post")


def machine_folder() -> str:
    """A further folder of machine files, '' for none."""
    return text("MachineFolder")


def programs_folder() -> str:
    """Where programs are written first: the preferred folder, else the last one; '' for next to the
    document.
    """
    return text("ProgramsFolder") or text("ExportFolder")


def process_rows() -> tuple[rows.Row, ...]:
    """The parameters of the process that have an entry."""
    return tuple(row for row in rows.rows(ProcessParameters) if row.key in PROCESS)


def label(row: rows.Row) -> str:
    """What the page calls it: 'Wire diameter', 'Wait between layers'."""
    *leading, final = (str(step).replace("_", " ") for step in row.path)
    words = [final, *leading] if leading and leading[0].startswith("between") else [*leading, final]
    return " ".join(words).capitalize() + (f" ({row.spec.unit})" if row.spec.unit else "")


def process() -> dict[str, Any]:
    """Preferred process values in place of the defaults, by row key in outer units."""
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
    """Keep figures in outer units by row key, as texts for rows with words; defaults leave no
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
    """Raises InputError where a process cannot have this inner value."""
    rows.build(ProcessParameters, {row.key: value})


def proposed(section: str, row: rows.Row) -> Any:
    """The inner value that the panel of a new stage proposes for a parameter: the preferred one,
    else its default.
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
    """The unit of speeds that the user has chosen, '' for the unit of FreeCAD's scheme."""
    unit = text("SpeedUnit")
    return unit if unit in SPEED_UNITS else ""


def speed_unit() -> str:
    """The unit of speeds in read-outs: the chosen one, else the unit of FreeCAD's scheme."""
    return preferred_speed_unit() or scheme_speed_unit()


def speed(value: float) -> float:
    """A speed in mm/s in that unit."""
    unit = speed_unit()
    if unit in SPEED_UNITS:
        return value * SPEED_UNITS[unit]
    return float(value * App.Units.Quantity("1 mm/s").getValueAs(unit).Value)


def ramp() -> str:
    """Which of RAMPS colours go by."""
    name = text("Ramp", RAMPS[0])
    return name if name in RAMPS else RAMPS[0]


def machine_colour() -> tuple[float, float, float]:
    """The colour of machines that are drawn plain, 0..1 each."""
    packed = text("MachineColour")
    try:
        red, green, blue = (int(packed[start : start + 2], 16) / 255.0 for start in (1, 3, 5))
    except ValueError:
        return MACHINE_COLOUR
    return red, green, blue


def existing(folder: str) -> bool:
    """Whether a folder is named and there."""
    return bool(folder) and os.path.isdir(folder)
