# SPDX-License-Identifier: LGPL-2.1-or-later
"""One parameter, one place: a dataclass field that carries its kind, bounds and help.

The same field feeds the property of a document object, the row of a task panel and the key of a job
file. Values are kept in mm, s, rad and plain numbers; degrees and percent exist only outside.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..issues import InputError, Text, Word

if TYPE_CHECKING:
    from .records import Records, RecordTexts
    from .vectors import VectorText

LENGTH, ANGLE, SPEED, TIME = "length", "angle", "speed", "time"
RATIO, NUMBER, COUNT, FLAG, CHOICE, TEXT, POSE = (
    "ratio",
    "number",
    "count",
    "flag",
    "choice",
    "text",
    "pose",
)
ANGLE_RANGE, RATIO_RANGE, TURN_RATE = "angle range", "ratio range", "turn rate"
POINT, RECORDS, VECTOR = "point", "records", "vector"
GROUP = "group"

# the outer unit of a bare number, and its size in internal units
OUTER_UNIT = {
    LENGTH: "mm",
    ANGLE: "deg",
    SPEED: "mm/s",
    TIME: "s",
    RATIO: "%",
    RATIO_RANGE: "%",
    TURN_RATE: "deg/mm",
}
# mm, and mm/s: larger values are rejected everywhere. Their squares and cubes would overflow, and
# at such speeds moves would end before a controller begins the next one
UPPER_BOUNDS = {LENGTH: 1e9, SPEED: 1e4}
END_OF = {ANGLE_RANGE: ANGLE, RATIO_RANGE: RATIO}  # what either end of a range is
TO_INNER = {
    ANGLE: math.pi / 180.0,
    ANGLE_RANGE: math.pi / 180.0,
    TURN_RATE: math.pi / 180.0,
    RATIO: 0.01,
    RATIO_RANGE: 0.01,
}


@dataclass(frozen=True)
class Spec:
    """The properties of a parameter besides its name and default.

    `low` and `high` are in inner units and belong to the allowed range unless `open_low`.
    `optional` parameters may be None. `words` are texts allowed in place of a number (such as
    'auto'). `advanced` parameters are folded away in a panel. `unit` belongs to a NUMBER, or to a
    TEXT of numbers with one common unit; panels show it. `poses`: the text contains poses, which
    may be typed in the notation of a pendant. `records`: the notations of a field of RECORDS or
    VECTOR.
    """

    kind: str
    help: str
    low: float | None = None
    high: float | None = None
    open_low: bool = False
    choices: tuple[str, ...] = ()
    words: tuple[str, ...] = ()
    optional: bool = False
    advanced: bool = False
    unit: str = ""
    poses: bool = False
    records: Records | RecordTexts | VectorText | None = None


def parameter(default: Any, kind: str, help: str, **more: Any) -> Any:
    """Return a dataclass field with its `Spec` in the metadata.

    Parameters
    ----------
    default
        Default value in inner units.
    kind : str
        One of the kinds of this module, such as LENGTH.
    help : str
        Help text.
    **more
        Further fields of `Spec`.

    Returns
    -------
    dataclasses.Field
        The field, for the body of a dataclass.
    """
    return dataclasses.field(default=default, metadata={"spec": Spec(kind, help, **more)})


def group(factory: type, help: str) -> Any:
    """A nested group of parameters, itself a dataclass."""
    return dataclasses.field(default_factory=factory, metadata={"spec": Spec(GROUP, help)})


def spec_of(field: dataclasses.Field[Any]) -> Spec:
    """The `Spec` of a dataclass field made by `parameter` or `group`."""
    spec: Spec = field.metadata["spec"]
    return spec


def outer_text(spec: Spec, value: float) -> str:
    """A value with its outer unit, for messages."""
    unit = OUTER_UNIT.get(spec.kind, "")
    return f"{value / TO_INNER.get(spec.kind, 1.0):.9g} {unit}".strip()


def degrees(angle: float) -> float:
    """Degrees of an angle in rad, without the noise of the last digits where the round number means the same."""
    value = math.degrees(angle)
    short = float(f"{value:.13g}")
    return short if abs(math.radians(short) - angle) <= 4e-16 * max(1.0, abs(angle)) else value


def percent(ratio: float) -> float:
    """Percent of a ratio, without the noise of the last digits where the round number means the same."""
    value = ratio / TO_INNER[RATIO]
    short = float(f"{value:.13g}")
    inner = short * TO_INNER[RATIO]
    return short if abs(inner - ratio) <= 4e-16 * max(1.0, abs(ratio)) else value


def check(owner: Any, prefix: str, skip: frozenset[str] = frozenset()) -> None:
    """Check every field of a parameters dataclass against its `Spec`.

    Parameters
    ----------
    owner : dataclass instance
        The parameters.
    prefix : str
        Name of their section, for messages.
    skip : frozenset of str, optional
        Names of fields not to check.

    Raises
    ------
    InputError
        BAD_VALUE with `prefix.field`, the value and the allowed range.
    """
    for field in dataclasses.fields(owner):
        if field.name not in skip:
            check_value(spec_of(field), getattr(owner, field.name), f"{prefix}.{field.name}")


def unknown_choice(key: str, value: Any, choices: tuple[str, ...]) -> InputError:
    """Return the error for a word that is not one of `choices`.

    Parameters
    ----------
    key : str
        Name of the parameter, with its section.
    value
        The word.
    choices : tuple of str
        Allowed words.

    Returns
    -------
    InputError
        BAD_VALUE, not raised.
    """
    return InputError(
        "BAD_VALUE", key, "{!r} is not a valid choice; use one of {}", value, ", ".join(choices)
    )


def check_value(spec: Spec, value: Any, key: str) -> None:
    """Check one value against its `Spec`.

    Parameters
    ----------
    spec : Spec
        Kind, bounds and choices.
    value
        The value in inner units.
    key : str
        Name of the parameter with its section, for messages.

    Raises
    ------
    InputError
        BAD_VALUE with the key.
    """
    is_word = isinstance(value, str) and value in spec.words
    if is_word or (value is None and spec.optional) or spec.kind in _CHECKED_ELSEWHERE:
        return
    _CHECKS.get(spec.kind, _check_number)(spec, value, key)


def _check_choice(spec: Spec, value: Any, key: str) -> None:
    if value not in spec.choices:
        raise unknown_choice(key, value, spec.choices)


def _check_flag(spec: Spec, value: Any, key: str) -> None:
    if not isinstance(value, bool):
        raise InputError("BAD_VALUE", key, "{!r} is not true or false; use true or false", value)


def _check_text(spec: Spec, value: Any, key: str) -> None:
    if not isinstance(value, str):
        raise InputError("BAD_VALUE", key, "{!r} is not a text; write the text in quotes", value)


def _check_pose(spec: Spec, value: Any, key: str) -> None:
    if (
        isinstance(value, str)
        or len(value) != 6
        or not all(math.isfinite(number) for number in value)
    ):
        also = Text.joined(" or ", ("", *spec.words))
        raise InputError(
            "BAD_VALUE", key, "{!r} is not a pose; give six numbers x y z RX RY RZ{}", value, also
        )


def _check_angle_range(spec: Spec, value: Any, key: str) -> None:
    if len(value) != 2 or not value[0] < value[1]:
        raise InputError(
            "BAD_VALUE", key, "{!r} is not a range; give two angles, the smaller first", value
        )


def _check_ratio_range(spec: Spec, value: Any, key: str) -> None:
    if isinstance(value, (int, float, str)) or len(value) != 2:
        raise InputError(
            "BAD_VALUE", key, "{!r} is not a range; give two percentages, the smaller first", value
        )
    ratio = dataclasses.replace(spec, kind=RATIO)
    for end in value:
        _check_number(ratio, end, key)
    if value[0] > value[1]:
        ends = Text.joined(" to ", (outer_text(ratio, end) for end in value))
        raise InputError(
            "BAD_VALUE", key, "{} is not a range; give the smaller percentage first", ends
        )


def _check_number(spec: Spec, value: Any, key: str) -> None:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or math.isnan(value):
        also = Text(" or {}", ", ".join(spec.words)) if spec.words else ""
        raise InputError(
            "BAD_VALUE", key, "{!r} is not a number; give a number such as 2{}", value, Word(also)
        )
    if spec.kind == COUNT and (math.isinf(value) or value != int(value)):
        raise InputError(
            "BAD_VALUE", key, "{!r} is not a whole number; give a number such as 3", value
        )
    if spec.high is None and abs(value) > UPPER_BOUNDS.get(spec.kind, math.inf):
        most = UPPER_BOUNDS[spec.kind]  # no user needs this limit in a message
        spec = dataclasses.replace(spec, high=most, low=-most if spec.low is None else spec.low)
    too_low = spec.low is not None and (value <= spec.low if spec.open_low else value < spec.low)
    if too_low or (spec.high is not None and value > spec.high):
        raise InputError(
            "BAD_VALUE",
            key,
            "{} is out of range; give {}",
            outer_text(spec, value),
            range_text(spec),
        )


_CHECKED_ELSEWHERE = (GROUP, RECORDS, VECTOR)  # by their constructors
_CHECKS = {  # of kinds whose values are not single numbers
    CHOICE: _check_choice,
    FLAG: _check_flag,
    TEXT: _check_text,
    POSE: _check_pose,
    ANGLE_RANGE: _check_angle_range,
    RATIO_RANGE: _check_ratio_range,
}


def range_text(spec: Spec) -> str:
    """Return the allowed range in outer units, '' without one."""
    parts = []
    if spec.low is not None:
        parts.append(
            Text("more than {}" if spec.open_low else "at least {}", outer_text(spec, spec.low))
        )
    if spec.high is not None:
        parts.append(Text("at most {}", outer_text(spec, spec.high)))
    return Text.joined(" and ", parts)
