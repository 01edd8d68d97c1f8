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
from ..core.parameters.vectors import VectorText
from ..objects.fields import quantities
from ..objects.fields.quantities import WANTED, quote

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
    return InputError("UNKNOWN_KEY", dotted, "the key {!r} is unknown; {}", key, Word(hint))


def text(value: Any, key: str) -> str:
    """`value` if it is a text that is not empty. Raises InputError BAD_VALUE otherwise."""
    if not isinstance(value, str) or not value.strip():
        raise InputError(
            "BAD_VALUE",
            key,
            "{} is not a text; write numbers in quotes",
            quote(value),
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
    if spec.kind == f.POSE or (_takes_pose(spec, field) and quantities.is_pose(value)):
        return pose(value, key, spec.words)
    if isinstance(value, list):
        return _list(spec, field, value, key)
    if spec.kind in f.END_OF:
        also = Text.joined("", (Text(" or {}", word) for word in spec.words))
        raise InputError(
            "BAD_VALUE",
            key,
            "{} is not a list; give {}{}",
            quote(value),
            Word("[smallest, largest]"),
            also,
        )
    if spec.kind in WANTED:
        return _finite(value, spec.kind, key, spec.words)
    return _plain(spec, value, key)


def _vector(values: list[Any], key: str) -> list[float]:
    """The numbers of a direction, or of an axis: a list of a point and a direction."""
    is_axis = bool(values) and all(isinstance(entry, list) for entry in values)
    rows = values if is_axis else [values]
    numbers = [
        quantities.read(number, f.LENGTH if k == 0 and len(rows) == 2 else f.NUMBER, key)
        for k, row in enumerate(rows)
        for number in row
    ]
    return [float(f"{number:.15g}") for number in numbers]  # as exact as texts of documents were


def _takes_pose(spec: f.Spec, field: dataclasses.Field[Any]) -> bool:
    """Whether a field takes a pose as well as a length."""
    return spec.kind == f.LENGTH and "Pose" in str(field.type)


def _plain(spec: f.Spec, value: Any, key: str) -> Any:
    if spec.kind == f.CHOICE and value not in spec.choices:
        raise _unknown_choice(key, value, spec.choices)
    if spec.kind == f.FLAG and not isinstance(value, bool):
        raise InputError(
            "BAD_VALUE", key, "{} is neither true nor false; use true or false", quote(value)
        )
    if spec.kind == f.COUNT and (isinstance(value, bool) or not isinstance(value, int)):
        raise InputError(
            "BAD_VALUE", key, "{} is not a whole number; give a number such as 3", quote(value)
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
        quote(value),
        Word(hint),
        ", ".join(choices),
    )


def _list(spec: f.Spec, field: dataclasses.Field[Any], value: list[Any], key: str) -> Any:
    if spec.kind in f.END_OF:
        if len(value) != 2:
            what = "angles" if spec.kind == f.ANGLE_RANGE else "percentages"
            raise InputError(
                "BAD_VALUE",
                key,
                "a range needs two {}, not {}; give [smallest, largest]",
                Word(what),
                len(value),
            )
        return tuple(_finite(number, f.END_OF[spec.kind], key) for number in value)
    if spec.kind == f.TEXT and "tuple" in str(field.type):
        return tuple(text(word, key) for word in value)
    if spec.records is not None:
        return spec.records.read([text(word, key) for word in value])
    raise InputError("BAD_VALUE", key, "{} is a list; give a single value", quote(value))


def pose(value: Any, key: str, words: tuple[str, ...] = ()) -> tuple[float, ...]:
    """The pose of a job file, whose rotation is required. Raises InputError BAD_VALUE or BAD_UNIT."""
    result = quantities.pose(value, key, words)
    count = len(value.replace(",", " ").split() if isinstance(value, str) else value)
    if count == 3:
        raise InputError(
            "BAD_VALUE",
            key,
            "a pose needs six numbers, not {}; give [x, y, z, RX, RY, RZ]",
            count,
        )
    if max(map(abs, result)) > _BOUND:
        raise quantities.too_large(value, f.LENGTH, key)
    return result


def _finite(value: Any, kind: str, key: str, words: tuple[str, ...] = ()) -> float:
    if value == {}:
        raise InputError("BAD_VALUE", key, "the value is missing; give {}", WANTED[kind][1])
    is_word = isinstance(value, str) and words and not any(sign.isdigit() for sign in value)
    number = quantities.read(value, kind, key, words, "BAD_VALUE" if is_word else "BAD_UNIT")
    if abs(number) > _BOUND:
        raise quantities.too_large(value, kind, key)
    return number
