# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers and quantities in user-facing texts.

Texts of this package are in mm, mm/s, cm3 and kg. `in_other_units` rewrites such a text for a
window with other units, which the caller chooses.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Decimal

# units as written in our texts, and the same units as FreeCAD parses them
SPEEDS = ("mm/min", "mm/s", "m/min")
UNITS = {
    **{unit: unit for unit in (*SPEEDS, "m/s", "mm", "cm", "m", "kg", "g")},
    "mm/s²": "mm/s^2",
    "mm/s2": "mm/s^2",
    **{
        f"{unit}{sign}{power}": f"{unit}^{power}"
        for unit in ("mm", "cm")
        for sign in ("", "^")
        for power in (2, 3)
    },
    **{
        f"{unit}{sign}": f"{unit}^{power}"
        for unit in ("mm", "cm")
        for sign, power in (("²", 2), ("³", 3))
    },
    **{f"{unit}/s": f"{base}^3/s" for base in ("mm", "cm") for unit in (f"{base}3", f"{base}³")},
    **{
        f"{unit}/min": f"{base}^3/min" for base in ("mm", "cm") for unit in (f"{base}3", f"{base}³")
    },
}
# marks of input examples and of the bead model formula, whose coefficients are in mm
_EXAMPLE = re.compile(r"such as|for instance|, as (?:in )?[\d{]|v\^\(-1/3\)")
_ALONE = re.compile(r"[-+]?\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?")
# output of `core.geometry.formatting.place`
_PLACE = re.compile(r"\(-?[\d.]+(?:e-?\d+)?(?:, -?[\d.]+(?:e-?\d+)?){2}\)")
_PRIVATE = 0xE000  # first private-use code point
LARGEST_PLAIN, SMALLEST_PLAIN = 1e15, 1e-9  # numbers outside this range keep an exponent
LEAST_DIGITS, MOST_DIGITS = 3, 7  # limits of the significant digits of a converted number

_NUMBER = r"[-+−]?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:e[-+]?\d+)?"
_EXPONENT = re.compile(r"(?<![\w.])-?\d(?:\.\d+)?e[-+]\d+(?![\w.])")
_BETWEEN = r" (?:and|to|x|×|–|or|of|of the|of its|et|à|ou|sur|sur les|sur ses|de|des|de ses) "
_QUANTITY = re.compile(
    rf"(?<![\w.,/'^(-])\(?(?P<numbers>{_NUMBER}(?:, {_NUMBER}, {_NUMBER}|(?:{_BETWEEN}{_NUMBER})*))\)?"
    rf"(?P<blank>[ \N{{NO-BREAK SPACE}}])(?P<unit>{'|'.join(map(re.escape, sorted(UNITS, key=len, reverse=True)))})"
    r"(?![\w/^²³'-])"
)
_AT_MOST = re.compile(r"(?:at most|up to|no more than|less than|au plus|jusqu’à|moins de) \(?$")
_AT_LEAST = re.compile(r"(?:at least|more than|au moins|plus de) \(?$")

Convert = Callable[[float, str], tuple[float, str] | None]


def number_text(value: float, form: str) -> str:
    """Format a number with a form such as '.3g', but write 190 instead of 1.9e+02.

    Very large and very small numbers keep the exponent.
    """
    text = format(value, form)
    if "e" not in text or not SMALLEST_PLAIN <= abs(value) < LARGEST_PLAIN:
        return text
    return format(Decimal(text), "f")


def expand_exponents(text: str) -> str:
    """Write numbers such as 1.2e+04 in a text without exponent, unless very large or small."""
    return _EXPONENT.sub(_written_out, text)


def _written_out(match: re.Match[str]) -> str:
    is_ordinary = SMALLEST_PLAIN <= abs(float(match[0])) < LARGEST_PLAIN
    return format(Decimal(match[0]), "f") if is_ordinary else match[0]


def significant(value: float, digits: int, rounding: str = ROUND_HALF_EVEN) -> str:
    """Round a number to significant digits, without an exponent or trailing zeros.

    Parameters
    ----------
    value : float
        The number. Very small and very large numbers keep an exponent.
    digits : int
        Number of significant digits.
    rounding : str, optional
        A rounding mode of `decimal`.

    Returns
    -------
    str
        The text.
    """
    if not math.isfinite(value) or value == 0.0:
        return f"{value:g}"
    if not SMALLEST_PLAIN <= abs(value) < LARGEST_PLAIN:
        return f"{value:.{digits}g}"
    exact = Decimal(value)
    step = Decimal(1).scaleb(exact.adjusted() - digits + 1)
    return _strip_zeros(format(exact.quantize(step, rounding=rounding), "f"))


def exact_or_rounded(value: float) -> str:
    """Format a number for an input field.

    Numbers with up to nine significant digits are exact. Others are rounded to three decimals, but
    to at least four significant digits.
    """
    for digits in range(1, 10):
        short = f"{value:.{digits}g}"
        if math.isclose(float(short), value, rel_tol=1e-12):
            return _strip_zeros(number_text(float(short), f".{digits}g"))
    before_point = len(str(int(min(abs(value), LARGEST_PLAIN)))) if abs(value) >= 1.0 else 0
    return significant(value, max(4, before_point + 3))


def _strip_zeros(text: str) -> str:
    return text.rstrip("0").rstrip(".") if "." in text and "e" not in text else text


def in_other_units(text: str, convert: Convert) -> str:
    """Return a text with its quantities in other units.

    Parameters
    ----------
    text : str
        A text with quantities such as '5 mm', '2 to 3 mm/s' and '1, 2, 3 mm'.
    convert : callable
        `convert(value, unit)` returns the factor from our unit to the other unit and the other
        unit's name; None keeps the quantity.

    Returns
    -------
    str
        The text. Numbers after 'at most' are rounded down, numbers after 'at least' up.
    """

    def converted(match: re.Match[str]) -> str:
        numbers = re.findall(_NUMBER, match["numbers"])
        values = [float(number.replace(",", "").replace("−", "-")) for number in numbers]
        other = convert(max(values, key=abs), UNITS[match["unit"]])
        if other is None:
            return match[0]
        factor, name = other
        before = text[: match.start("numbers")]
        rounding = (
            ROUND_FLOOR
            if _AT_MOST.search(before)
            else ROUND_CEILING
            if _AT_LEAST.search(before)
            else ROUND_HALF_EVEN
        )
        at = iter(range(len(values)))

        def number_in_unit(number: re.Match[str]) -> str:
            return significant(values[next(at)] * factor, _digits(number[0]), rounding)

        start, end = match.start("numbers") - match.start(), match.end("numbers") - match.start()
        shown = re.sub(_NUMBER, number_in_unit, match["numbers"])
        closing = match[0][end : match.start("blank") - match.start()]
        return f"{match[0][:start]}{shown}{closing}{match['blank']}{name}"

    return _QUANTITY.sub(converted, text)


def _digits(number: str) -> int:
    written = re.sub(r"e.*|\D", "", number).lstrip("0")
    return min(max(len(written), LEAST_DIGITS), MOST_DIGITS)


def is_example(template: str) -> bool:
    """Whether a template gives input examples, whose quantities must not be converted."""
    return _EXAMPLE.search(template) is not None


def put_values(template: str, values: Sequence[str], in_units: Callable[[str], str]) -> str:
    """Fill a template with its values and convert their quantities to other units.

    Parameters
    ----------
    template : str
        A template with numbered placeholders, as in `core.issues.Text`.
    values : sequence of str
        The values. Only numbers, units and coordinates are passed to `in_units`: other values may
        be names such as 'Plate 5 mm'.
    in_units : callable
        Converts the quantities in a text to other units.

    Returns
    -------
    str
        The filled template.
    """
    if is_example(template):
        return template.format(*values)
    hidden: dict[str, str] = {}
    seen = []
    for number, value in enumerate(values):
        if _ALONE.fullmatch(value) or value in UNITS:
            seen.append(value)
            continue
        sign = chr(_PRIVATE + number)
        is_place = _PLACE.fullmatch(value)
        hidden[sign] = in_units(f"{value} mm").removesuffix(" mm") if is_place else value
        seen.append(sign)
    text = in_units(template.format(*seen))
    return "".join(hidden.get(sign, sign) for sign in text)
