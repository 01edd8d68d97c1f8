# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bead classes and their process overrides, in the notation of a job and as text."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from ..issues import InputError
from . import field as f
from .records import SEPARATOR, Records, entry, split

WHERE = "process.classes"
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
_FORM = "write, for example: contour: travel_speed 8, schedule 3; fill: lead 5"
_INNER = {f.ANGLE: math.radians}
_TO_OUTER_UNITS = {f.ANGLE: math.degrees}
START, END = "start", "end"


@dataclass(frozen=True)
class PhaseParameters:
    """The settings that differ at an end of every bead, over a length of the bead."""

    length: float = f.parameter(0.0, f.LENGTH, "Length of bead with these settings.", low=0.0)
    travel_speed: float | None = f.parameter(
        None, f.SPEED, "Travel speed in this length.", low=0.0, open_low=True, optional=True
    )
    schedule: int | None = f.parameter(
        None,
        f.COUNT,
        "Schedule for this length, sent without a stop.",
        low=1,
        high=LARGEST_SCHEDULE,
        optional=True,
    )
    ramp: float = f.parameter(
        0.0,
        f.LENGTH,
        "Length of the adjacent ramp, in which the speed changes in steps to that of the bead.",
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
    """The settings of a bead class; None means the value of the process, or of the build direction.

    name: of CLASSES; '' for a class without settings.
    """

    name: str = entry(f.TEXT, "")
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

    def __post_init__(self) -> None:
        if self.name and self.name not in CLASSES:
            raise f.unknown_choice(WHERE, self.name, CLASSES)
        for key, value in self.own_values().items():
            f.check_value(SPECS[key], value, f"{WHERE}.{self.name}.{key}")

    def own_values(self) -> dict[str, float]:
        """Return the overrides of the class by name, in internal units."""
        return {
            key: value for key, value in vars(self).items() if value is not None and key in SPECS
        }

    def __str__(self) -> str:
        outer = {
            key: _TO_OUTER_UNITS.get(SPECS[key].kind, float)(value)
            for key, value in self.own_values().items()
        }
        return f"{self.name}: {', '.join(f'{key} {value:.12g}' for key, value in outer.items())}"


SPECS = {
    field.name: f.spec_of(field) for field in dataclasses.fields(BeadClass) if field.name != "name"
}


def number_of(name: str) -> int:
    """The place of a class in CLASSES; -1 of none."""
    return CLASSES.index(name) if name in CLASSES else -1


def check_twice(classes: Sequence[BeadClass]) -> None:
    """Raises InputError BAD_VALUE if two classes have the same name."""
    names = [bead_class.name for bead_class in classes]
    for name in names:
        if names.count(name) > 1:
            raise InputError("BAD_VALUE", WHERE, "{} is defined twice; merge the two entries", name)


def in_order(classes: Sequence[BeadClass]) -> tuple[BeadClass, ...]:
    """Return the classes that have overrides, in the usual order."""
    with_overrides = [bead_class for bead_class in classes if bead_class.own_values()]
    return tuple(sorted(with_overrides, key=lambda bead_class: number_of(bead_class.name)))


def parse_classes(text: str) -> tuple[BeadClass, ...]:
    """Return the classes of a text, in its order. Raises InputError BAD_VALUE."""
    classes = []
    for part in split(text):
        name, colon, rest = (piece.strip() for piece in part.partition(":"))
        if not colon:
            raise InputError("BAD_VALUE", WHERE, "{!r} is not a class of beads; {}", part, _FORM)
        if not name:
            raise f.unknown_choice(WHERE, name, CLASSES)
        classes.append(BeadClass(name, **_values(name, rest)))  # type: ignore[arg-type]
    check_twice(classes)
    return tuple(classes)


def format_classes(classes: Sequence[BeadClass]) -> str:
    """Return the text of the classes that have overrides, in the usual order."""
    return f"{SEPARATOR} ".join(map(str, in_order(classes)))


def _values(name: str, text: str) -> dict[str, float | int | None]:
    values: dict[str, float | int | None] = {}
    for setting in filter(str.strip, text.split(",")):
        key, _, number = setting.strip().partition(" ")
        if key not in SPECS:
            raise InputError(
                "BAD_VALUE",
                WHERE,
                "{} has no setting {!r}; use one of {}",
                name,
                key,
                ", ".join(SPECS),
            )
        try:
            value = float(number)
        except ValueError:
            raise InputError(
                "BAD_VALUE", WHERE, "{}: {!r} has no number; {}", name, setting.strip(), _FORM
            ) from None
        whole = SPECS[key].kind == f.COUNT and value.is_integer()
        values[key] = int(value) if whole else _INNER.get(SPECS[key].kind, float)(value)
    return values


BEAD_CLASSES = Records(BeadClass, parse_classes, format_classes)
