# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bead classes and their process overrides, in the notation of a job and as text."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar

from ..issues import InputError
from . import field as f

NONE = "none"
WHERE = "process.classes"
SEPARATOR = ";"  # separator of classes
FIRST_LAYER, CONTOUR, FILL, CLOSING, LINK, WALL = CLASSES = (
    "first_layer",
    "contour",
    "fill",
    "closing",
    "link",
    "wall",
)
LARGEST_SCHEDULE = 65535  # 16 bits
LARGEST_WEAVE = 255  # files of weaving conditions of a Yaskawa
_FORM = "write such as: contour: travel_speed 8, schedule 3; fill: lead 5"
_INNER = {f.ANGLE: math.radians}
_TO_OUTER_UNITS = {f.ANGLE: math.degrees}
START, END = "start", "end"


@dataclass(frozen=True)
class PhaseParameters:
    """The settings that differ at an end of every bead, over a length of the bead."""

    length: float = f.parameter(0.0, f.LENGTH, "Length of the bead that it covers.", low=0.0)
    travel_speed: float | None = f.parameter(
        None, f.SPEED, "Travel speed there.", low=0.0, open_low=True, optional=True
    )
    schedule: int | None = f.parameter(
        None,
        f.COUNT,
        "Schedule to send there, without a stop.",
        low=1,
        high=LARGEST_SCHEDULE,
        optional=True,
    )
    ramp: float = f.parameter(
        0.0,
        f.LENGTH,
        "Length next to it over which the speed changes in steps to the speed of the bead.",
        low=0.0,
        advanced=True,
    )

    where: ClassVar[str] = WHERE

    def __post_init__(self) -> None:
        f.check(self, self.where)

    @property
    def there(self) -> bool:
        """Whether anything differs."""
        return self.length + self.ramp > 0.0 and (
            self.travel_speed is not None or self.schedule is not None
        )


class BeadStart(PhaseParameters):
    """The settings at the start of beads."""

    where = "process.start"


class BeadEnd(PhaseParameters):
    """The settings at the end of beads."""

    where = "process.end"


def _phase(name: str) -> Any:
    """The key of a class for one of a phase."""
    spec = next(f.spec_of(one) for one in dataclasses.fields(PhaseParameters) if one.name == name)
    return dataclasses.field(
        default=None, metadata={"spec": dataclasses.replace(spec, optional=True, advanced=True)}
    )


@dataclass(frozen=True)
class BeadClass:
    """The settings of a bead class; None means the value of the process, or of the build direction."""

    travel_speed: float | None = f.parameter(
        None,
        f.SPEED,
        "Travel speed along beads of the class.",
        low=0.0,
        open_low=True,
        optional=True,
    )
    schedule: int | None = f.parameter(
        None,
        f.COUNT,
        "Schedule number with which the welder or extruder deposits beads of the class.",
        low=1,
        high=LARGEST_SCHEDULE,
        optional=True,
    )
    lead: float | None = f.parameter(
        None,
        f.ANGLE,
        "Tool axis tilted forward, along the bead.",
        low=-0.5 * math.pi,
        high=0.5 * math.pi,
        optional=True,
    )
    tilt: float | None = f.parameter(
        None,
        f.ANGLE,
        "Tool axis tilted sideways.",
        low=-0.5 * math.pi,
        high=0.5 * math.pi,
        optional=True,
    )
    lead_on: float | None = f.parameter(
        None,
        f.TIME,
        "Time by which the deposit is switched on before a bead of the class starts.",
        low=0.0,
        optional=True,
    )
    lead_off: float | None = f.parameter(
        None,
        f.TIME,
        "Time by which the deposit is switched off after a bead of the class ends.",
        low=0.0,
        optional=True,
    )
    weave: int | None = f.parameter(
        None,
        f.COUNT,
        "Weave number of the controller for beads of the class; 0: straight.",
        low=0,
        high=LARGEST_WEAVE,
        optional=True,
        advanced=True,
    )
    start_length: float | None = _phase("length")
    start_travel_speed: float | None = _phase("travel_speed")
    start_schedule: int | None = _phase("schedule")
    start_ramp: float | None = _phase("ramp")
    end_length: float | None = _phase("length")
    end_travel_speed: float | None = _phase("travel_speed")
    end_schedule: int | None = _phase("schedule")
    end_ramp: float | None = _phase("ramp")

    def own_values(self) -> dict[str, float]:
        """Return the overrides of the class by name, in internal units."""
        return {name: value for name, value in vars(self).items() if value is not None}

    def __str__(self) -> str:
        fields = {one.name: f.spec_of(one).kind for one in dataclasses.fields(self)}
        outer = {
            name: _TO_OUTER_UNITS.get(fields[name], float)(value)
            for name, value in self.own_values().items()
        }
        return ", ".join(f"{name} {value:.12g}" for name, value in outer.items())


SPECS = {one.name: f.spec_of(one) for one in dataclasses.fields(BeadClass)}


def number_of(name: str) -> int:
    """The place of a class in CLASSES; -1 of none."""
    return CLASSES.index(name) if name in CLASSES else -1


def build_class(name: str, values: dict[str, float | int | None], where: str = WHERE) -> BeadClass:
    """Build the class of this name from values in internal units.

    Raises InputError BAD_VALUE with `where`, the class and the key.
    """
    if name not in CLASSES:
        raise f.unknown_choice(where, name, CLASSES)
    for key, value in values.items():
        f.check_value(SPECS[key], value, f"{where}.{name}.{key}")
    return BeadClass(**values)  # type: ignore[arg-type]


def text_of(classes: dict[str, BeadClass]) -> str:
    """Return the text of the classes that have overrides, in the usual order; NONE without any."""
    parts = [
        f"{name}: {classes[name]}"
        for name in CLASSES
        if name in classes and classes[name].own_values()
    ]
    return f"{SEPARATOR} ".join(parts) or NONE


@lru_cache(maxsize=64)
def _parsed(text: str) -> tuple[tuple[str, BeadClass], ...]:
    if text.strip() in (NONE, ""):
        return ()
    found: dict[str, BeadClass] = {}
    for part in filter(str.strip, text.split(SEPARATOR)):
        name, colon, rest = (piece.strip() for piece in part.partition(":"))
        if not colon:
            raise InputError(
                "BAD_VALUE", WHERE, "{!r} is not a class of beads; {}", part.strip(), _FORM
            )
        if name in found:
            raise InputError("BAD_VALUE", WHERE, "{} is defined twice; merge the two entries", name)
        found[name] = build_class(name, _values(name, rest))
    return tuple(found.items())


def classes(text: str) -> dict[str, BeadClass]:
    """Return the classes of a text; empty for none. Raises InputError BAD_VALUE."""
    return dict(_parsed(text))


def _values(name: str, text: str) -> dict[str, float | int | None]:
    values: dict[str, float | int | None] = {}
    for entry in filter(str.strip, text.split(",")):
        key, _, number = entry.strip().partition(" ")
        if key not in SPECS:
            raise InputError(
                "BAD_VALUE", WHERE, "{} has no {!r}; use one of {}", name, key, ", ".join(SPECS)
            )
        try:
            value = float(number)
        except ValueError:
            raise InputError(
                "BAD_VALUE", WHERE, "{}: {!r} has no number; {}", name, entry.strip(), _FORM
            ) from None
        whole = SPECS[key].kind == f.COUNT and value.is_integer()
        values[key] = int(value) if whole else _INNER.get(SPECS[key].kind, float)(value)
    return values
