# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings by place: where they apply, and what they set, in the notation of panels and as JSON."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from ..issues import InputError
from . import bead_classes
from . import field as f
from .records import SEPARATOR, Records, entry, numbers, split

WHERE = "settings"
MAX_SETTINGS = 52  # the places of a row are the bits of one float
VALUE_KEYS = ("travel_speed", "schedule", "weave", "lead_on", "lead_off")  # of the process
# sections of an entry with the keys that they may have, and those that are not supported yet
SECTIONS = {"process": VALUE_KEYS, "strategy": (), "build_direction": ()}
FUTURE_KEYS = {
    "process": ("wire", "seam"),
    "strategy": ("fill", "fill_angle", "fill_density", "walls", "narrowest", "widest"),
    "build_direction": ("lead", "tilt"),
}
SPECS = {name: bead_classes.SPECS[name] for name in VALUE_KEYS}
_FORM = (
    "write it as in: layers 0 to 4: travel_speed 4, schedule 3; height 20 to 35 and inside Zone: "
    "lead_on 0.5; box 0 0 0 10 20 30: weave 2; faces Face7 Face8 within 8: travel_speed 5"
)
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_RANGE = rf"(?:from\s+)?(?P<low>{_NUMBER})?(?:\s*to\s+(?P<high>{_NUMBER}))?"
_CONDITIONS = {
    "layers": re.compile(rf"layers\s+{_RANGE}"),
    "height": re.compile(rf"height\s+{_RANGE}"),
    "box": re.compile(rf"box\s+(?P<numbers>{_NUMBER}(?:[\s,]+{_NUMBER}){{5}})"),
    "inside": re.compile(r"inside\s+(?P<name>.+)"),
    "faces": re.compile(rf"faces\s+(?P<names>\w+(?:[\s,]+\w+)*?)\s+within\s+(?P<within>{_NUMBER})"),
}


def _value(name: str) -> Any:
    return dataclasses.field(default=None, metadata={"spec": SPECS[name]})


@dataclass(frozen=True)
class Setting:
    """The values of one place; those left out are None. All conditions given must hold.

    first_layer, last_layer: both included. low, high: mm along the stacking direction above the
    lowest point of the toolpath, both included. box: x0, y0, z0, x1, y1, z1, mm in part
    coordinates. inside: name or label of a closed solid or mesh. faces: faces of the part, and
    within: largest distance from them, mm.
    """

    first_layer: int | None = entry(f.COUNT, None)
    last_layer: int | None = entry(f.COUNT, None)
    low: float | None = entry(f.LENGTH, None)
    high: float | None = entry(f.LENGTH, None)
    box: tuple[float, ...] | None = entry(f.TEXT, None)
    inside: str = entry(f.TEXT, "")
    faces: tuple[str, ...] = entry(f.TEXT, ())
    within: float | None = entry(f.LENGTH, None)
    travel_speed: float | None = _value("travel_speed")
    schedule: int | None = _value("schedule")
    weave: int | None = _value("weave")
    lead_on: float | None = _value("lead_on")
    lead_off: float | None = _value("lead_off")

    def __post_init__(self) -> None:
        # JSON has lists
        object.__setattr__(self, "faces", tuple(self.faces))
        if self.box is not None:
            object.__setattr__(self, "box", tuple(float(number) for number in self.box))
        self._check_ranges()
        self._check_zones()
        if not self.conditions():
            raise _wrong("where", "it has no condition; give layers, height, inside or faces")
        if not self.own_values():
            raise _wrong("process", "it sets nothing; give one of {}", ", ".join(VALUE_KEYS))
        for key, value in self.own_values().items():
            f.check_value(SPECS[key], value, f"{WHERE}.process.{key}")

    def _check_ranges(self) -> None:
        for key, low, high in (
            ("layers", self.first_layer, self.last_layer),
            ("height", self.low, self.high),
        ):
            ends = [end for end in (low, high) if end is not None]
            for end in ends:
                kind = f.COUNT if key == "layers" else f.LENGTH
                f.check_value(f.Spec(kind, "", low=0.0), end, f"{WHERE}.where.{key}")
            if len(ends) == 2 and ends[0] > ends[1]:
                raise _wrong(
                    f"where.{key}",
                    "{:g} to {:g} is not a range; give the lower end first",
                    *ends,
                )

    def _check_zones(self) -> None:
        if self.box is not None:
            spans = zip(self.box[:3], self.box[3:])
            finite = len(self.box) == 6 and all(abs(number) <= 1e9 for number in self.box)
            if not finite or not all(low < high for low, high in spans):
                raise _wrong(
                    "where.inside.box",
                    "{} is not a box; give [x0, y0, z0, x1, y1, z1] in mm, the lower corner first",
                    numbers(self.box),
                )
        if self.box is not None and self.inside:
            raise _wrong(
                "where.inside",
                "it has a box and a solid; give one of them, and cut the solid if both are meant",
            )
        if bool(self.faces) != (self.within is not None):
            raise _wrong(
                "where.within" if self.faces else "where.faces",
                "faces and within belong together; give both, such as faces: [Face7], within: 8 mm",
            )
        if self.within is not None:
            spec = f.Spec(f.LENGTH, "", low=0.0, open_low=True)
            f.check_value(spec, self.within, f"{WHERE}.where.within")
        if any(sign in self.inside for sign in ":;") or " and " in self.inside:
            raise _wrong(
                "where.inside",
                "{!r} cannot be named, because it has a colon, a semicolon or the word and; rename "
                "the object",
                self.inside,
            )

    def own_values(self) -> dict[str, Any]:
        """Return the values that the setting gives, by name, in internal units."""
        return {name: value for name in VALUE_KEYS if (value := getattr(self, name)) is not None}

    def conditions(self) -> tuple[str, ...]:
        """Return the texts of the conditions."""
        return tuple(self._conditions())

    def _conditions(self) -> Iterator[str]:
        for name, low, high in (
            ("layers", self.first_layer, self.last_layer),
            ("height", self.low, self.high),
        ):
            if low is not None or high is not None:
                start = "" if low is None else f" {'from ' if high is None else ''}{low:.12g}"
                yield f"{name}{start}{'' if high is None else f' to {high:.12g}'}"
        if self.box is not None:
            yield f"box {numbers(self.box)}"
        if self.inside:
            yield f"inside {self.inside}"
        if self.faces:
            yield f"faces {' '.join(self.faces)} within {self.within:.12g}"

    def __str__(self) -> str:
        values = (f"{key} {value:.12g}" for key, value in self.own_values().items())
        return f"{' and '.join(self.conditions())}: {', '.join(values)}"


def _wrong(key: str, message: str, *values: Any) -> InputError:
    return InputError("BAD_VALUE", f"{WHERE}.{key}", message, *values)


def parse_settings(text: str) -> tuple[Setting, ...]:
    """Return the settings of a text, in its order. Raises InputError BAD_VALUE."""
    return tuple(map(_parse_one, split(text)))


def _parse_one(text: str) -> Setting:
    where, colon, values_text = (text_part.strip() for text_part in text.partition(":"))
    if not colon:
        raise InputError("BAD_VALUE", WHERE, "{!r} is not a setting by place; {}", text, _FORM)
    values: dict[str, Any] = {}
    for condition in re.split(r"\s+and\s+", where):
        fields = _condition(condition)
        if fields.keys() & values.keys():
            raise _wrong("where", "{!r} has a condition twice; give it once", where)
        values |= fields
    for value in filter(str.strip, values_text.split(",")):
        key, _, number = value.strip().partition(" ")
        if key not in SPECS:
            raise InputError(
                "BAD_VALUE",
                WHERE,
                "{!r} cannot vary by place; use one of {}",
                key,
                ", ".join(SPECS),
            )
        values[key] = _number(key, number, value)
    return Setting(**values)


def _number(key: str, number: str, text: str) -> float:
    try:
        value = float(number)
    except ValueError:
        raise InputError(
            "BAD_VALUE", WHERE, "{!r} has no number; {}", text.strip(), _FORM
        ) from None
    return int(value) if SPECS[key].kind == f.COUNT and value.is_integer() else value


def _condition(text: str) -> dict[str, Any]:
    """Return the fields of one condition. Raises InputError BAD_VALUE."""
    parsed = next(
        (
            (name, match)
            for name, pattern in _CONDITIONS.items()
            if (match := pattern.fullmatch(text)) is not None
        ),
        None,
    )
    if parsed is None:
        raise InputError("BAD_VALUE", WHERE, "{!r} is not a condition; {}", text, _FORM)
    name, match = parsed
    if name in ("layers", "height"):
        ends = {"layers": ("first_layer", "last_layer"), "height": ("low", "high")}[name]
        limits = {
            key: float(end)
            for key, end in zip(ends, (match["low"], match["high"]))
            if end is not None
        }
        return {
            key: int(end) if name == "layers" and end.is_integer() else end
            for key, end in limits.items()
        }
    if name == "box":
        return {"box": tuple(map(float, match["numbers"].replace(",", " ").split()))}
    if name == "inside":
        return {"inside": match["name"].strip()}
    names = tuple(match["names"].replace(",", " ").split())
    return {"faces": names, "within": float(match["within"])}


def format_settings(settings: Sequence[Setting]) -> str:
    """Return the text of settings."""
    return f"{SEPARATOR} ".join(map(str, settings))


def check_number(settings: Sequence[Setting]) -> None:
    """Raises InputError BAD_VALUE for more settings than can be told apart."""
    if len(settings) > MAX_SETTINGS:
        raise InputError(
            "BAD_VALUE",
            WHERE,
            "{} entries are too many; use at most {}, for instance wider ranges of layers",
            len(settings),
            MAX_SETTINGS,
        )


def deciding_entry(active: int) -> int | None:
    """Return the number of the last entry of a sum of 2^entry, None of 0."""
    return active.bit_length() - 1 if active else None


def entries_of(active: int) -> list[int]:
    """Return the numbers of the entries of a sum of 2^entry, ascending."""
    return [number for number in range(active.bit_length()) if active >> number & 1]


SETTINGS = Records(Setting, parse_settings, format_settings)
