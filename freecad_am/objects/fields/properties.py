# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameter dataclasses as properties of a document object: add, write and read.

Adding missing properties to an object also migrates old documents.
"""

from __future__ import annotations

from typing import Any

import FreeCAD as App

from ...core.issues import InputError
from ...core.parameters import field as f
from ...core.parameters.records import Records
from .pendants import placement_of
from .rows import LENGTH_OR_POSE, MIXED, TEXT_LIST, Row, build, flat, property_name, rows

READ_ONLY, HIDDEN, OUTPUT = 1, 4, 8

_TYPES = {
    f.ANGLE: "App::PropertyAngle",
    f.SPEED: "App::PropertySpeed",
    f.RATIO: "App::PropertyFloat",
    f.NUMBER: "App::PropertyFloat",
    f.TURN_RATE: "App::PropertyFloat",
    f.COUNT: "App::PropertyInteger",
    f.FLAG: "App::PropertyBool",
    f.CHOICE: "App::PropertyEnumeration",
    f.TEXT: "App::PropertyString",
    f.POSE: "App::PropertyPlacement",
    TEXT_LIST: "App::PropertyStringList",
    MIXED: "App::PropertyString",
    LENGTH_OR_POSE: "App::PropertyString",
}


def property_type(row: Row, obj: Any) -> str:
    """Return the FreeCAD property type of a row. In FreeCAD 0.20, times are plain numbers."""
    if row.form == f.LENGTH:
        signed = row.spec.low is None or row.spec.low < 0
        return "App::PropertyDistance" if signed else "App::PropertyLength"
    if row.form == f.TIME:
        return "App::PropertyTime" if _has_time(obj) else "App::PropertyFloat"
    return _TYPES[row.form]


def tooltip(row: Row, type_name: str) -> str:
    """Return the help of a row, with the unit if the property type has no unit."""
    bare = type_name in ("App::PropertyFloat", "App::PropertyString") and row.unit
    return f"{row.spec.help} ({row.unit})" if bare else row.spec.help


def add(obj: Any, cls: type, group: str) -> None:
    """Add the missing properties of a parameter dataclass to an object, with default values."""
    have = set(obj.PropertiesList)
    for row in rows(cls):
        if row.name not in have:
            type_name = property_type(row, obj)
            obj.addProperty(type_name, row.name, group, tooltip(row, type_name))
            if row.form == f.CHOICE:
                setattr(obj, row.name, list(row.spec.choices))
            _set(obj, row, row.default)
        elif (
            row.form == f.CHOICE
            and tuple(obj.getEnumerationsOfProperty(row.name) or ()) != row.spec.choices
        ):
            current = getattr(obj, row.name)
            setattr(obj, row.name, list(row.spec.choices))
            _set(obj, row, current if current in row.spec.choices else row.default)


def write(obj: Any, parameters: Any) -> None:
    """Set the changed properties of a parameter dataclass, so that FreeCAD touches no others."""
    values = flat(parameters)
    for row in rows(type(parameters)):
        if _differs(obj, row, values[row.key]):
            _set(obj, row, values[row.key])


def read(obj: Any, cls: type, section: str) -> Any:
    """Read a parameter dataclass from the properties of an object.

    section: prefix in the errors of the dataclass. Raises InputError, naming Label and property.
    """
    try:
        return build(cls, _inner_values(obj, cls))
    except InputError as error:
        if error.where.startswith(f"{obj.Label}."):
            raise
        key = (
            error.where[len(section) + 1 :]
            if error.where.startswith(f"{section}.")
            else error.where
        )
        raise InputError(error.code, f"{obj.Label}.{property_name(key)}", error.message) from None


def _inner_values(obj: Any, cls: type) -> dict[str, Any]:
    """Return inner values by row key.

    Raises InputError, naming Label and property, or the key of invalid records.
    """
    return {
        row.key: row.inner(getattr(obj, row.name), f"{obj.Label}.{row.name}") for row in rows(cls)
    }


def fingerprint(obj: Any, cls: type) -> list[str]:
    """Return the properties as text that does not change on saving.

    FreeCAD saves 16 decimals, so the last digits are ignored.
    """
    return [f"{row.name}={_canonical(getattr(obj, row.name))}" for row in rows(cls)]


def _canonical(value: Any) -> str:
    if isinstance(value, App.Placement):
        return " ".join(f"{number:.9f}" for number in (*value.Base, *value.Rotation.Q))
    if isinstance(value, (list, tuple)):
        return ",".join(str(entry) for entry in value)
    if isinstance(value, App.Units.Quantity):
        value = value.Value
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def _differs(obj: Any, row: Row, value: Any) -> bool:
    try:
        return bool(row.inner(getattr(obj, row.name), row.name) != value)
    except InputError:
        return True


def _set(obj: Any, row: Row, value: Any) -> None:
    if row.form == MIXED and obj.getTypeIdOfProperty(row.name) != _TYPES[MIXED]:
        _retype(obj, row)
    if row.form in (MIXED, LENGTH_OR_POSE):
        setattr(obj, row.name, row.text(value))
    elif isinstance(row.spec.records, Records):
        setattr(obj, row.name, row.spec.records.to_json(value))
    elif row.form == f.POSE:
        setattr(obj, row.name, placement_of(value))
    elif row.form == TEXT_LIST:
        setattr(obj, row.name, list(row.outer(value)))
    else:
        setattr(obj, row.name, row.outer(value))
        if row.form == f.ANGLE and abs(row.inner(getattr(obj, row.name), row.name) - value) > 1e-9:
            # FreeCAD silently reduces angles to one revolution
            outer_text = f.outer_text(row.spec, value)
            raise InputError(
                "BAD_VALUE",
                f"{obj.Label}.{row.name}",
                "{} is out of range; give -360 to 360 deg",
                outer_text,
            )


def _retype(obj: Any, row: Row) -> None:
    """Change a property of older documents from a quantity to a string, which can hold words.

    The property is changed when it is set, so that opening an old document changes nothing.
    """
    group = obj.getGroupOfProperty(row.name)
    obj.setExpression(row.name, None)
    obj.removeProperty(row.name)
    obj.addProperty(_TYPES[MIXED], row.name, group, tooltip(row, _TYPES[MIXED]))


def _has_time(obj: Any) -> bool:
    return "App::PropertyTime" in obj.supportedProperties()
