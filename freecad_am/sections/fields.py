# SPDX-License-Identifier: LGPL-2.1-or-later
"""Builds the parameter dataclasses of the core from the plain values of a job file.

Nothing here knows a single parameter: kinds, choices and words come from the `Spec` of each field, so a parameter
added to the core can be written in a job file at once.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from typing import Any, TypeVar

from ..core.issues import InputError, Text, Word
from ..core.parameters import field as f
from ..core.parameters.records import Records
from ..objects.fields import pendants
from . import quantity

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
            quantity.quote(values),
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
    if spec.kind in quantity.WANTED:
        return _number(value, spec, key)
    return _plain(spec, value, key)


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
    raise InputError("BAD_VALUE", key, "{} is a list; give one value", quantity.quote(value))


def _number(value: Any, spec: f.Spec, key: str) -> float:
    if isinstance(value, str) and spec.words and not any(sign.isdigit() for sign in value):
        raise InputError(
            "BAD_VALUE",
            key,
            "{} is not known; give {} or {}",
            _quote(value),
            Text.joined(" or ", spec.words),
            quantity.WANTED[spec.kind][1],
        )
    return _finite(value, spec.kind, key)


def _finite(value: Any, kind: str, key: str) -> float:
    if value == {}:
        raise InputError(
            "BAD_VALUE", key, "the value is missing; give {}", quantity.WANTED[kind][1]
        )
    number = quantity.read(value, kind, key)
    if abs(number) > _BOUND:
        raise InputError(
            "BAD_VALUE", key, "{} is too large; give {}", _quote(value), quantity.WANTED[kind][1]
        )
    return number


def _quote(value: Any) -> str:
    return "nothing" if value == {} else quantity.quote(value)
