# SPDX-License-Identifier: LGPL-2.1-or-later
"""Quantities as FreeCAD understands them: '1 mm', '90 deg', '360 mm/min', '1/2 in'.

What everybody writes - one number, one unit, perhaps a second one after a slash - is read here, because
starting FreeCAD takes longer than reading a whole job. Any other text goes to FreeCAD itself, so that both
always mean the same. Percentages, 'inf', 'ms' and a leading plus are ours; FreeCAD has no word for them.
"""

from __future__ import annotations

import math
import re
from typing import Any

from ..core.issues import InputError
from ..core.parameters import field as f

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
