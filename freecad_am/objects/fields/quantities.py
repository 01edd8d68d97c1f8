# SPDX-License-Identifier: LGPL-2.1-or-later
"""Converter of quantities and poses, used by job files, properties and macros.

Outer numbers without a unit are in mm, deg, mm/s, s or %. Inner values are in mm, rad, mm/s, s or
plain numbers.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

import FreeCAD as App

from ...core.issues import InputError, Text, Word
from ...core.parameters import field as f
from . import pendants

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
    NONE: "has no unit",
}
_OTHER_DIMENSION = (-99, 0, 0)  # placeholder for dimensions with mass, current and so on
_UNIT = "[^\\s\\d/*^+().,%-]+"
_SIMPLE_QUANTITY = re.compile(
    rf"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(?:({_UNIT})(?:\s*/\s*({_UNIT}))?|(%))?",
    re.ASCII,
)
# characters that FreeCAD skips, which would change the meaning
_FOREIGN_SIGNS = re.compile("[^A-Za-z0-9\\s.+*/^()'\"\u00b5\u00b0\u2032\u2033\u2212-]")
_INFINITE_NUMBER = re.compile(r"([+-]?)\.?inf(?:\s*[a-z/\u00b0]+)?", re.IGNORECASE)
# non-ASCII characters that FreeCAD reads in a quantity
_OTHER_SIGNS = "\N{DEGREE SIGN}\N{MICRO SIGN}\N{PRIME}\N{DOUBLE PRIME}\N{MINUS SIGN}"
# a comma that may be a decimal comma, or a no-break space that may group digits
_TWO_WAYS = re.compile(r"(?:^|\s),\d|\d,\d.*\s|\s.*\d,\d|\d[\u00a0\u2009\u202f]\d", re.DOTALL)
_MILLISECONDS = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*ms\s*", re.ASCII)
_DECIMAL_COMMA = re.compile(r"\s*[-+]?\d*,\d+(?:[eE][-+]?\d+)?(?:\s*[^\d\s,.].*)?", re.ASCII)
# end of a term in a sum without exponents: a sign, or a number directly after a unit
_TERMS = re.compile(
    r"(?<=[^\s(*/^+\u2212-])\s*[-+\u2212]|"
    "(?<=[A-Za-z\u00b5'\"\u00b0\u2032\u2033])\\s*(?=[\\d.])"
)
_FACTORS = re.compile(
    "(/?)[\\s\\d.(]*([A-Za-z\u00b5\u00b0\u2032\u2033'\"]+)(?:\\s*\\^\\s*(-?\\d+))?"
)
_POSE_KINDS = (f.LENGTH,) * 3 + (f.ANGLE,) * 3
_FUNCTIONS = re.compile(r"[A-Za-z]+\([^()]*\)")
_EXPONENTS = re.compile(r"(?<=[\d.])[eE][-+]?\d+", re.ASCII)
_PARTS_OF_DEGREE = ("\u2032", "\u2033")  # minutes and seconds of arc
_FORM_OF_POSE = "x y z in mm and RX RY RZ in deg"

_Reading = tuple[float, Dimension | None]  # in the outer unit; None for a number without a unit


def read(
    value: Any, kind: str, where: str, words: Sequence[str] = (), unreadable: str = "BAD_UNIT"
) -> float:
    """Convert a string, number or FreeCAD quantity to the inner unit; the result may be infinite.

    Parameters
    ----------
    value : object
        A number without a unit is in the outer unit of `kind` (mm, deg, mm/s, s, %).
    kind : str
        A key of `WANTED`.
    where : str
        Name of the value in errors.
    words : sequence of str
        Words that the caller accepts instead of a number, for messages.
    unreadable : str
        Error code for a string that is not a quantity: BAD_UNIT for job files, BAD_VALUE for
        properties and macros.

    Returns
    -------
    float
        Value in mm, rad, mm/s or s, or a plain number.

    Raises
    ------
    InputError
        BAD_VALUE for another type, an empty string, a comma, NaN or a number too large; BAD_UNIT
        for another dimension; `unreadable` for any other string.
    """
    expected, example = WANTED[kind]
    example = Text.joined(" or ", (example, *words))
    if isinstance(value, str):
        number, dimension = _read_text(value, kind, where, example, unreadable)
    else:
        number, dimension = _read_number(value, expected, where, example)
    if math.isnan(number):
        raise InputError("BAD_VALUE", where, "{} is not a number; give {}", quote(value), example)
    if dimension is not None and dimension != expected:
        code = unreadable if expected == NONE else "BAD_UNIT"
        actual = DIMENSION_NAMES.get(dimension, "has another dimension")
        raise InputError(code, where, "{} {}; give {}", quote(value), actual, example)
    return number * f.TO_INNER.get(kind, 1.0)


def too_large(value: Any, kind: str, where: str) -> InputError:
    """Return the error for a number that is too large."""
    return InputError("BAD_VALUE", where, "{} is too large; give {}", quote(value), WANTED[kind][1])


def quote(value: Any) -> str:
    """Return a value as the user wrote it, truncated if long."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, App.Units.Quantity):
        return str(value)
    if isinstance(value, str):
        text = repr(plain_blanks(value))
    elif value is None or value == {}:
        text = "null" if value is None else "nothing"
    else:
        text = safe_repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def safe_repr(value: Any) -> str:
    """Return the repr of a value for a message, even if its object is deleted."""
    try:
        return repr(value)
    except ReferenceError:
        return Text("the deleted object")


def _read_number(value: Any, expected: Dimension, where: str, example: str) -> _Reading:
    """Return number and dimension of a value that is not a string. Raises InputError BAD_VALUE."""
    if isinstance(value, App.Units.Quantity):
        # for plain numbers, ignore the unit: a coefficient may have one, as may its expression
        return float(value.Value), None if expected == NONE else _dimension(value)
    try:
        if isinstance(value, bool):
            raise TypeError
        return float(value), None
    except (TypeError, ValueError, ArithmeticError, ReferenceError):
        raise InputError(
            "BAD_VALUE", where, "{} is not a quantity; give {}", quote(value), example
        ) from None


def _read_text(text: str, kind: str, where: str, example: str, unreadable: str) -> _Reading:
    """Return the number in the outer unit and the dimension of a string. Raises InputError."""
    plain = plain_blanks(text).strip()
    if not plain:
        raise InputError("BAD_VALUE", where, "the value is missing; give {}", example)
    if "," in plain:
        raise _comma(plain, where, example)
    if infinite := _INFINITE_NUMBER.fullmatch(plain):
        return (-math.inf if infinite[1] == "-" else math.inf), None
    simple = _SIMPLE_QUANTITY.fullmatch(plain)
    if simple is None:
        return _read_other(text, kind, where, example, unreadable)
    number, over, under, percent = float(simple[1]), simple[2], simple[3], simple[4]
    if not math.isfinite(number):
        raise too_large(text, kind, where)
    if percent:
        if kind != f.RATIO:
            raise InputError(unreadable, where, "{} is a percentage; give {}", quote(text), example)
        return number, None
    if over is None:
        return number, None
    if over not in UNITS or (under is not None and under not in UNITS):
        return _read_other(text, kind, where, example, unreadable)
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


def _read_other(text: str, kind: str, where: str, example: str, unreadable: str) -> _Reading:
    """Read a string that needs Python or FreeCAD.

    Python reads plain numbers in Python notation. FreeCAD reads calculations and rare units.
    """
    if WANTED[kind][0] == NONE:
        bare = text.rstrip().removesuffix("%") if kind == f.RATIO else text
        if (number := _plain_number(bare)) is not None:
            return number, None
    wrong = InputError(
        unreadable, where, "{} is not a quantity with a known unit; give {}", quote(text), example
    )
    if _FOREIGN_SIGNS.search(
        plain_blanks(text).replace("\N{GREEK SMALL LETTER MU}", "\N{MICRO SIGN}")
    ):
        raise wrong
    try:
        value = quantity(text)
    except (ValueError, TypeError, ArithmeticError, OSError, RuntimeError):
        raise wrong from None  # FreeCAD versions raise different errors
    if not math.isfinite(value.Value):
        raise wrong
    return float(value.Value), _dimension(value)


def _plain_number(text: str) -> float | None:
    """Return the finite number of a string in Python notation, such as '1_000', or None."""
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def _dimension(value: Any) -> Dimension | None:
    """Return the dimension of a FreeCAD quantity, None for a plain number."""
    length, mass, time, *others, angle = value.Unit.Signature
    if mass or any(others):
        return _OTHER_DIMENSION
    return None if (length, time, angle) == NONE else (length, time, angle)


def _comma(text: str, where: str, example: str) -> InputError:
    """Return the error for a string with a comma; suggest a decimal point if appropriate."""
    if not _DECIMAL_COMMA.fullmatch(text):
        return InputError("BAD_VALUE", where, "{} is not a quantity; give {}", quote(text), example)
    return InputError(
        "BAD_VALUE",
        where,
        "{} has a comma; use a decimal point, as in {}",
        quote(text),
        text.replace(",", "."),
    )


# ---- poses


def pose(value: Any, where: str, words: Sequence[str] = ()) -> pendants.Pose:
    """Convert a pose to x y z RX RY RZ, mm and rad.

    Parameters
    ----------
    value : object
        A placement; three or six numbers in a string or a list, whose entries may have units; or a
        string or list in pendant form: kuka 1000 0 300 90 0 0.
    where : str
        Name of the value in errors.
    words : sequence of str
        Words that the caller accepts instead of a pose, for messages.

    Returns
    -------
    tuple of float

    Raises
    ------
    InputError
        BAD_VALUE for anything else, BAD_UNIT for an entry with a wrong unit.
    """
    if isinstance(value, App.Placement):
        return pendants.pose_of(value)
    if (shown := as_shown(value, where)) is not None:
        return shown
    wrong = InputError(
        "BAD_VALUE",
        where,
        "{} is not a pose; give {}",
        quote(value),
        Text.joined(" or ", (_FORM_OF_POSE, *words)),
    )
    try:
        entries = split(value, where) if isinstance(value, str) else list(value)
    except TypeError:
        raise wrong from None
    if len(entries) not in (3, 6) or (isinstance(value, str) and not _are_numbers(entries)):
        raise wrong
    numbers = [_entry(entry, kind, where) for entry, kind in zip(entries, _POSE_KINDS)]
    x, y, z, rx, ry, rz = (*numbers, 0.0, 0.0, 0.0)[:6]
    return x, y, z, rx, ry, rz


def as_shown(value: Any, where: str) -> pendants.Pose | None:
    """Return the pose of a string or list in pendant form, None for other values."""
    if isinstance(value, str):
        words = value.replace(",", " ").split()
    else:
        words = list(map(str, value)) if isinstance(value, (list, tuple)) else []
    if not pendants.named(words):
        return None
    return pendants.six(split(value, where) if isinstance(value, str) else words, where)


def is_pose(value: Any) -> bool:
    """Whether a value of a length-or-pose parameter is meant as a pose, valid or not."""
    if not isinstance(value, str):
        return isinstance(value, (list, tuple, App.Placement))
    words = value.replace(",", " ").split()
    if pendants.named(words):
        return True
    return len(words) > 2 and _are_numbers(words[:2]) and not _DECIMAL_COMMA.fullmatch(value)


def _entry(value: Any, kind: str, where: str) -> float:
    number = _plain_number(value) if isinstance(value, str) else None
    return read(value if number is None else number, kind, where)


def _are_numbers(words: list[str]) -> bool:
    """Whether all words are numbers without a unit."""
    try:
        return all(math.isfinite(float(word)) for word in words)
    except ValueError:
        return False


# ---- texts


def split(text: str, where: str) -> list[str]:
    """Split a list separated by commas or spaces.

    Raises InputError BAD_VALUE, naming `where`, for an ambiguous list: a comma may be a decimal
    comma ('10,5 20,5' is two or four numbers), or no-break spaces may group digits.
    """
    if _TWO_WAYS.search(text.strip()):
        remedy = "write decimals with a point and a single kind of separator, as in 10.5 20.5"
        raise InputError(
            "BAD_VALUE", where, "{!r} is ambiguous; {}", plain_blanks(text), Word(remedy)
        )
    return text.replace(",", " ").split()


def plain_blanks(text: str) -> str:
    """Replace no-break and thin spaces, which FreeCAD does not read, by plain spaces."""
    return re.sub(r"\s", " ", text)


def quantity(text: str) -> Any:
    """Convert a string to a FreeCAD quantity. Raises ValueError for other strings.

    Reject unknown characters too, because FreeCAD would drop the rest with the unit ('1’234 mm'
    gives 1). Reject '[', because FreeCAD would start a comment that swallows all later quantities.
    Read 'ms' here, because FreeCAD 0.20 does not know this unit.
    """
    plain = plain_blanks(text).replace("\N{GREEK SMALL LETTER MU}", "\N{MICRO SIGN}")
    if "[" in plain or any(not sign.isascii() and sign not in _OTHER_SIGNS for sign in plain):
        raise ValueError(text)
    if milliseconds := _MILLISECONDS.fullmatch(plain):
        return App.Units.Quantity(float(milliseconds[1]) * 1e-3, App.Units.TimeSpan)
    if _adds_dimensions(plain):
        raise ValueError(text)
    return App.Units.Quantity(plain)


def _adds_dimensions(text: str) -> bool:
    """Whether terms of a sum have different dimensions.

    Units outside `UNITS` count as a different dimension.
    """
    terms = _TERMS.split(_FUNCTIONS.sub("1", _EXPONENTS.sub("", text)))
    return len(terms) > 1 and len({_term_dimension(term) for term in terms} - {NONE}) > 1


def _term_dimension(term: str) -> Dimension:
    """Return the dimension of a product of numbers and units."""
    length, time, angle = NONE
    for over, unit, power in _FACTORS.findall(term):
        times = (-1 if over else 1) * int(power or 1)
        powers = ANGLE if unit in _PARTS_OF_DEGREE else UNITS.get(unit, (1.0, _OTHER_DIMENSION))[1]
        length += times * powers[0]
        time += times * powers[1]
        angle += times * powers[2]
    return length, time, angle
