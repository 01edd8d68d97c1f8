# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters given to a stage as keywords or dataclasses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...core.issues import InputError
from ..stage import Stage
from . import properties, rows


def set_parameters(
    obj: Any, stage: Stage, dataclasses: Sequence[Any], values: dict[str, Any]
) -> None:
    """Set the parameters of a stage: whole dataclasses (None leaves the properties) and, over them, single values in
    outer units by row key, or expressions (`=Spreadsheet.height`) that they follow from now on.

    All are checked before the first is set. InputError names the bad value.
    """
    rows_by_key = {row.key: row for section in stage.sections for row in rows.rows(section.cls)}
    unknown = sorted(set(values) - set(rows_by_key))
    if unknown:
        raise InputError(
            "UNKNOWN_PARAMETER",
            obj.Label,
            "{} is not known; use one of {}",
            ", ".join(unknown),
            ", ".join(sorted(rows_by_key)),
        )
    by_class = {type(entry): entry for entry in dataclasses if entry is not None}
    for cls in by_class.keys() - {section.cls for section in stage.sections}:
        expected = ", ".join(section.cls.__name__ for section in stage.sections)
        raise InputError(
            "BAD_INPUT",
            obj.Label,
            "{} is not a valid parameter; use {}",
            cls.__name__,
            expected,
        )
    try:
        checked = _checked(obj, stage, by_class, values)
    except ReferenceError:  # an object that is gone cannot even be named
        raise InputError(
            "BAD_INPUT", obj.Label, "the value is a deleted object; give a number or a text"
        ) from None
    for parameters in checked:
        properties.write(obj, parameters)
    for key, value in values.items():
        rows.follow(obj, rows_by_key[key], value if rows.is_expression(value) else None)


def _checked(
    obj: Any, stage: Stage, by_class: dict[type, Any], values: dict[str, Any]
) -> list[Any]:
    """The dataclasses with given values, by class as a whole or by key."""
    checked = []
    for section in stage.sections:
        own_rows = {row.key: row for row in rows.rows(section.cls) if row.key in values}
        if section.cls not in by_class and not own_rows:
            continue
        base = by_class.get(section.cls)
        inner = rows.flat(base if base is not None else stage.parameters(obj, section.cls))
        for key, row in own_rows.items():
            inner[key] = row.inner(
                _plain(obj, row, values[key], f"{section.prefix}.{key}"), f"{section.prefix}.{key}"
            )
        checked.append(rows.build(section.cls, inner))
    return checked


def _plain(obj: Any, row: rows.Row, value: Any, where: str) -> Any:
    """The value, or what its expression gives now."""
    if not rows.is_expression(value):
        return value
    if row.form not in rows.FOLLOW:
        raise InputError(
            "BAD_EXPRESSION", where, "it cannot follow an expression; enter a plain value"
        )
    return rows.evaluated(value, obj, where)
