# SPDX-License-Identifier: LGPL-2.1-or-later
"""Builds the parameter dataclasses of the core from the plain values of a job file.

Nothing here knows a single parameter: kinds, choices and words come from the `Spec` of each field, so a parameter
added to the core can be written in a job file at once.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Iterable
from typing import Any, TypeVar

from ..core.issues import InputError, Text, Word
from ..core.parameters import field as f
from ..core.parameters.records import Records
from ..core.parameters.vectors import VectorText
from ..objects.fields import pendants

# ---- Quantities as FreeCAD understands them: '1 mm', '90 deg', '360 mm/min', '1/2 in'

Dimension = tuple[int, int, int]  # powers of length, time and angle

LENGTH, TIME, ANGLE, NONE = (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 0)
UNITS: dict[str, tuple[float, Dimension]] = {
    "nm": (1e-6, LENGTH),
    "um": (1e-3, LENGTH),
    "\u00b5m": (1e-3, LENGTH),
    "\u03bcm": (1e-3, LENGTH),
    "mm": (1.0, LENGTH),
    "cm": (10.0, LENGTH),
    "dm": (100.0, LENGTH),
    "m": (1e3, LENGTH),
    "km": (1e6, LENGTH),
    "in": (25.4, LENGTH),
    '"': (25.4, LENGTH),
    "ft": (304.8, LENGTH),
    "'": (304.8, LENGTH),
    "yd": (914.4, LENGTH),
    "thou": (0.0254, LENGTH),
    "mil": (0.0254, LENGTH),
    "ms": (1e-3, TIME),
    "s": (1.0, TIME),
    "min": (60.0, TIME),
    "h": (3600.0, TIME),
    "deg": (1.0, ANGLE),
    "\u00b0": (1.0, ANGLE),
    "rad": (180.0 / math.pi, ANGLE),
    "gon": (0.9, ANGLE),
}
WANTED: dict[str, tuple[Dimension, str]] = {
    f.LENGTH: (LENGTH, "a length such as 1 mm"),
    f.ANGLE: (ANGLE, "an angle such as 30 deg"),
    f.SPEED: ((1, -1, 0), "a speed such as 6 mm/s or 360 mm/min"),
    f.TIME: (TIME, "a time such as 0.1 s"),
    f.RATIO: (NONE, "a percentage such as 20 %"),
    f.TURN_RATE: ((-1, 0, 1), "a turn per length such as 10 deg/mm"),
    f.NUMBER: (NONE, "a number without a unit such as 0.1"),
}
DIMENSION_NAMES = {
    LENGTH: "is a length",
    TIME: "is a time",
    ANGLE: "is an angle",
    (1, -1, 0): "is a speed",
    (-1, 0, 1): "is a turn per length",
    NONE: "is without unit",
}
_UNIT = "[^\\s\\d/*^+().,%-]+"
_SIMPLE = re.compile(
    rf"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(?:({_UNIT})(?:\s*/\s*({_UNIT}))?|(%))?",
    re.ASCII,
)
_FOREIGN = re.compile("[^A-Za-z0-9\\s.+*/^()'\"\u00b5\u00b0\u2032\u2033-]")
_INFINITE = re.compile(r"([+-]?)\.?inf(?:\s*[a-z/\u00b0]+)?", re.IGNORECASE)


def read(value: Any, kind: str, key: str) -> float:
    """The value of `key` in inner units (mm, rad, mm/s, s, plain) from a YAML scalar; may be infinite.

    A number without a unit is in the outer unit of `kind` (mm, deg, mm/s, s, %). Raises InputError 'BAD_VALUE' for
    what is not a quantity, 'BAD_UNIT' for an unknown unit or one of the wrong dimension.
    """
    expected, example = WANTED[kind]
    if isinstance(value, bool) or value is None or not isinstance(value, (int, float, str)):
        raise InputError("BAD_VALUE", key, "{} is not a quantity; give {}", quote(value), example)
    if isinstance(value, str):
        number, dimension = _read_text(value, kind, key)
    else:
        number, dimension = float(value), None
    if math.isnan(number):
        raise InputError("BAD_VALUE", key, "{} is not a number; give {}", quote(value), example)
    if dimension is not None and dimension != expected:
        actual = DIMENSION_NAMES.get(dimension, "is of another dimension")
        raise InputError("BAD_UNIT", key, "{} {}; give {}", quote(value), actual, example)
    return number * f.TO_INNER.get(kind, 1.0)


def quote(value: Any) -> str:
    """A value as its user wrote it, cut short where it is long."""
    if isinstance(value, bool):
        return "true" if value else "false"
    text = "null" if value is None else repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _read_text(text: str, kind: str, key: str) -> tuple[float, Dimension | None]:
    """Number in outer units and its dimension, None where no unit was given."""
    example = WANTED[kind][1]
    text = text.strip()
    if "," in text:
        raise InputError(
            "BAD_VALUE",
            key,
            "{} has a comma; use a decimal point, as in {}",
            quote(text),
            text.replace(",", "."),
        )
    infinite = _INFINITE.fullmatch(text)
    if infinite:
        return (-math.inf if infinite[1] == "-" else math.inf), None
    simple = _SIMPLE.fullmatch(text)
    if simple is None:
        return _read_with_freecad(text, key, example)
    number, over, under, percent = float(simple[1]), simple[2], simple[3], simple[4]
    if not math.isfinite(number):
        raise InputError("BAD_VALUE", key, "{} is too large; give {}", quote(text), example)
    if percent:
        if kind != f.RATIO:
            raise InputError("BAD_UNIT", key, "{} is a percentage; give {}", quote(text), example)
        return number, None
    if over is None:
        return number, None
    if over not in UNITS or (under is not None and under not in UNITS):
        return _read_with_freecad(text, key, example)
    factor, dimension = UNITS[over]
    if under is not None:
        divisor, divisor_dimension = UNITS[under]
        factor /= divisor
        dimension = (
            dimension[0] - divisor_dimension[0],
            dimension[1] - divisor_dimension[1],
            dimension[2] - divisor_dimension[2],
        )
    return number * factor, None if dimension == NONE else dimension


def _read_with_freecad(text: str, key: str, example: str) -> tuple[float, Dimension | None]:
    """The same by FreeCAD's own parser, for expressions and rare units."""
    wrong = InputError(
        "BAD_UNIT", key, "{} is not a quantity with a known unit; give {}", quote(text), example
    )
    if not text:
        raise InputError("BAD_VALUE", key, "the value is missing; give {}", example)
    if _FOREIGN.search(
        text
    ):  # FreeCAD passes over signs it does not know, which changes the meaning
        raise wrong
    try:
        import FreeCAD
    except ImportError:
        raise wrong from None
    try:
        quantity = FreeCAD.Units.Quantity(text)
        length, _, time, _, _, _, _, angle = quantity.Unit.Signature
    except (
        ValueError,
        ArithmeticError,
        RuntimeError,
    ):  # FreeCAD's versions differ in what they raise
        raise wrong from None
    if (
        not math.isfinite(quantity.Value)
        or quantity.Unit.Signature[1]
        or any(quantity.Unit.Signature[3:7])
    ):
        raise wrong
    dimension = (length, time, angle)
    return quantity.Value, None if dimension == NONE else dimension


Parameters = TypeVar("Parameters")
_BOUND = 1e9  # a quantity beyond is a slip of the pen, and its square must stay finite


def build(
    factory: type[Parameters], values: Any, prefix: str, also: Iterable[str] = ()
) -> Parameters:
    """A `factory` from the mapping `values`; keys left out keep their default, keys in `also` are ignored.

    Raises InputError whose place is the dotted key: UNKNOWN_KEY, BAD_VALUE, BAD_UNIT.
    """
    section = mapping(values, prefix)
    fields = {field.name: field for field in dataclasses.fields(factory)}  # type: ignore[arg-type]
    known_keys(section, (*fields, *also), prefix)
    arguments = {
        name: _value(f.spec_of(field), field, section[name], f"{prefix}.{name}")
        for name, field in fields.items()
        if name in section
    }
    return factory(**arguments)


def mapping(values: Any, prefix: str) -> dict[str, Any]:
    """`values` if it is a mapping. Raises InputError BAD_VALUE otherwise."""
    if not isinstance(values, dict):
        raise InputError(
            "BAD_VALUE",
            prefix,
            "{} is not a section; write its keys below {}:",
            quote(values),
            prefix,
        )
    return values


def known_keys(section: dict[str, Any], names: Iterable[str], prefix: str) -> None:
    """Raises InputError UNKNOWN_KEY for the first key that is not known, naming the nearest one."""
    names = tuple(names)
    for key in section:
        if key not in names:
            raise unknown_key(f"{prefix}.{key}" if prefix else key, key, names)


def unknown_key(dotted: str, key: str, names: tuple[str, ...]) -> InputError:
    """The error for a key nobody reads."""
    import difflib

    matches = difflib.get_close_matches(key.lower().replace("-", "_"), names, n=1)
    hint = (
        Text("did you mean {}?", matches[0]) if matches else Text("use one of {}", ", ".join(names))
    )
    return InputError("UNKNOWN_KEY", dotted, "there is no key {!r}; {}", key, Word(hint))


def text(value: Any, key: str) -> str:
    """`value` if it is a text that is not empty. Raises InputError BAD_VALUE otherwise."""
    if not isinstance(value, str) or not value.strip():
        raise InputError(
            "BAD_VALUE",
            key,
            "{} is not a text; put numbers in quotes",
            _quote(value),
        )
    return value


def _value(spec: f.Spec, field: dataclasses.Field[Any], value: Any, key: str) -> Any:
    if spec.kind == f.GROUP:
        factory: Any = field.default_factory
        return factory() if value is None else build(factory, value, key)
    if spec.optional and value in (None, {}):
        return None
    if isinstance(spec.records, Records):
        return spec.records.read(value)
    if isinstance(spec.records, VectorText):
        numbers = _vector(value, key) if isinstance(value, list) else text(value, key)
        return spec.records.read(numbers)
    if isinstance(value, str) and value in spec.words:
        return math.inf if value == "inf" else value
    if _is_pose(spec, field) and (pose := as_shown(value, key)) is not None:
        return pose
    if isinstance(value, list):
        return _list(spec, field, value, key)
    if spec.kind == f.POSE or spec.kind in f.END_OF:
        example = "[x, y, z, RX, RY, RZ]" if spec.kind == f.POSE else "[smallest, largest]"
        also = Text.joined("", (Text(" or {}", word) for word in spec.words))
        raise InputError(
            "BAD_VALUE", key, "{} is not a list; give {}{}", _quote(value), Word(example), also
        )
    if spec.kind in WANTED:
        return _number(value, spec, key)
    return _plain(spec, value, key)


def _vector(values: list[Any], key: str) -> list[float]:
    """The numbers of a direction, or of an axis: a list of a point and a direction."""
    is_axis = bool(values) and all(isinstance(entry, list) for entry in values)
    rows = values if is_axis else [values]
    numbers = [
        read(number, f.LENGTH if k == 0 and len(rows) == 2 else f.NUMBER, key)
        for k, row in enumerate(rows)
        for number in row
    ]
    return [float(f"{number:.15g}") for number in numbers]  # as exact as texts of documents were


def _is_pose(spec: f.Spec, field: dataclasses.Field[Any]) -> bool:
    """Whether a field takes a pose, it alone or as well as a length."""
    return spec.kind == f.POSE or (spec.kind == f.LENGTH and "Pose" in str(field.type))


def as_shown(value: Any, key: str) -> tuple[float, float, float, float, float, float] | None:
    """The pose that a text or list says as a pendant shows it, mm and rad: kuka 1000 0 300 90 0 0; None of other values."""
    words = (
        value.split()
        if isinstance(value, str)
        else list(map(str, value))
        if isinstance(value, list)
        else []
    )
    return pendants.six(words, key) if pendants.named(words) else None


def _plain(spec: f.Spec, value: Any, key: str) -> Any:
    if spec.kind == f.CHOICE and value not in spec.choices:
        raise _unknown_choice(key, value, spec.choices)
    if spec.kind == f.FLAG and not isinstance(value, bool):
        raise InputError(
            "BAD_VALUE", key, "{} is neither true nor false; use true or false", _quote(value)
        )
    if spec.kind == f.COUNT and (isinstance(value, bool) or not isinstance(value, int)):
        raise InputError(
            "BAD_VALUE", key, "{} is not a whole number; give one such as 3", _quote(value)
        )
    if spec.kind in (f.TEXT, f.RECORDS):
        return text(value, key)
    return value


def _unknown_choice(key: str, value: Any, choices: tuple[str, ...]) -> InputError:
    import difflib

    matches = difflib.get_close_matches(str(value).lower().replace("_", "-"), choices, n=1)
    hint = Text("did you mean {}? ", matches[0]) if matches else ""
    return InputError(
        "BAD_VALUE",
        key,
        "{} is not known; {}use one of {}",
        _quote(value),
        Word(hint),
        ", ".join(choices),
    )


def _list(spec: f.Spec, field: dataclasses.Field[Any], value: list[Any], key: str) -> Any:
    if _is_pose(spec, field):
        if len(value) != 6:
            raise InputError(
                "BAD_VALUE",
                key,
                "a pose has six numbers, not {}; give [x, y, z, RX, RY, RZ]",
                len(value),
            )
        kinds = (f.LENGTH,) * 3 + (f.ANGLE,) * 3
        return tuple(_finite(number, kind, key) for number, kind in zip(value, kinds))
    if spec.kind in f.END_OF:
        if len(value) != 2:
            what = "angles" if spec.kind == f.ANGLE_RANGE else "percentages"
            raise InputError(
                "BAD_VALUE",
                key,
                "a range has two {}, not {}; give [smallest, largest]",
                Word(what),
                len(value),
            )
        return tuple(_finite(number, f.END_OF[spec.kind], key) for number in value)
    if spec.kind == f.TEXT and "tuple" in str(field.type):
        return tuple(text(word, key) for word in value)
    if spec.records is not None:
        return spec.records.read([text(word, key) for word in value])
    raise InputError("BAD_VALUE", key, "{} is a list; give one value", quote(value))


def _number(value: Any, spec: f.Spec, key: str) -> float:
    if isinstance(value, str) and spec.words and not any(sign.isdigit() for sign in value):
        raise InputError(
            "BAD_VALUE",
            key,
            "{} is not known; give {} or {}",
            _quote(value),
            Text.joined(" or ", spec.words),
            WANTED[spec.kind][1],
        )
    return _finite(value, spec.kind, key)


def _finite(value: Any, kind: str, key: str) -> float:
    if value == {}:
        raise InputError("BAD_VALUE", key, "the value is missing; give {}", WANTED[kind][1])
    number = read(value, kind, key)
    if abs(number) > _BOUND:
        raise InputError(
            "BAD_VALUE", key, "{} is too large; give {}", _quote(value), WANTED[kind][1]
        )
    return number


def _quote(value: Any) -> str:
    return "nothing" if value == {} else quote(value)
