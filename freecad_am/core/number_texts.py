# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers and quantities in texts for people.

Texts of this package are in mm, mm/s, cm3 and kg. `in_other_units` rewrites such a text for a
window with other units; the caller chooses them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Decimal

# units of our texts: as they are written, and as FreeCAD reads them
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
# examples of input, and the formula of bead models, whose coefficients are in mm
_EXAMPLE = re.compile(r"such as|for instance|, as (?:in )?[\d{]|v\^\(-1/3\)")
_ALONE = re.compile(r"[-+]?\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?")
# of `core.geometry.formatting.place`
_PLACE = re.compile(r"\(-?[\d.]+(?:e-?\d+)?(?:, -?[\d.]+(?:e-?\d+)?){2}\)")
_PRIVATE = 0xE000  # code points without a meaning in any language
LARGEST_PLAIN, SMALLEST_PLAIN = 1e15, 1e-9  # beyond these an exponent is easier to read
LEAST_DIGITS, MOST_DIGITS = 3, 7  # significant ones of a converted number

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
    """A number in a form such as '.3g', without an exponent where it is of ordinary size: 190 for 1.9e+02."""
    text = format(value, form)
    if "e" not in text or not SMALLEST_PLAIN <= abs(value) < LARGEST_PLAIN:
        return text
    return format(Decimal(text), "f")


def expand_exponents(text: str) -> str:
    """A text with numbers such as 1.2e+04 written out where they are of ordinary size."""
    return _EXPONENT.sub(_written_out, text)


def _written_out(match: re.Match[str]) -> str:
    is_ordinary = SMALLEST_PLAIN <= abs(float(match[0])) < LARGEST_PLAIN
    return format(Decimal(match[0]), "f") if is_ordinary else match[0]


def significant(value: float, digits: int, rounding: str = ROUND_HALF_EVEN) -> str:
    """Return a number rounded to significant digits, without an exponent or zeros at its end.

    Parameters
    ----------
    value : float
        The number; not finite, very small and very large ones keep an exponent.
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
    """A number for a field: whole where it has few digits, else with three decimals and four digits at least."""
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
        `convert(value, unit)` returns the other unit's size in our unit, and its name; None to keep
        the quantity.

    Returns
    -------
    str
        The text; numbers after 'at most' or 'at least' are rounded to the allowed side.
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
    """Return whether a template gives examples of input, whose quantities must not change."""
    return _EXAMPLE.search(template) is not None


def put_values(template: str, values: Sequence[str], in_units: Callable[[str], str]) -> str:
    """Fill a template with its values and convert their quantities to other units.

    Parameters
    ----------
    template : str
        With numbered places, as in `core.issues.Text`.
    values : sequence of str
        `in_units` does not see values other than numbers, units and places: they may be names such
        as 'Plate 5 mm'.
    in_units : callable
        Returns a text of numbers with its quantities in other units.

    Returns
    -------
    str
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
