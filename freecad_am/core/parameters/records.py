# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters that are records: text in panels and macros, JSON in the properties of documents.

The JSON has the keys and units of a job file: mm, s, mm/s and degrees.
"""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from . import field as f

Pose = tuple[float, float, float, float, float, float]
Point = tuple[float, float, float]

NONE = "none"  # the text of no record
SEPARATOR = ";"  # separator of records in a text


def entry(kind: str, default: Any = dataclasses.MISSING) -> Any:
    """A field of a record, with its kind. A field without a default is required."""
    return dataclasses.field(default=default, metadata={"spec": f.Spec(kind, "")})


@dataclass(frozen=True)
class Records:
    """The notations of a parameter that holds records of one class.

    Parameters
    ----------
    record : type
        Frozen dataclass of a record. Every field has a `Spec`.
    parse : callable
        Reads the records of a text, the notation of panels, macros and older documents.
    format : callable
        Writes this text, in which angles are in degrees.
    single : bool
        The parameter is one record or None instead of a tuple of records.
    """

    record: type
    parse: Callable[[str], tuple[Any, ...]]
    format: Callable[[Sequence[Any]], str]
    single: bool = False

    def read(self, value: Any) -> Any:
        """Return the records of a text or of JSON; records are returned as they are.

        Returns
        -------
        tuple of records, or one record or None if `single`

        Raises
        ------
        InputError
            BAD_VALUE if the text is not in the notation.
        """
        if not isinstance(value, str):
            return value if self.single else tuple(value)
        text = value.strip()
        records = () if text in ("", NONE) else self._from_json(text)
        if records is None:
            records = self.parse(text)
        if self.single:
            return records[0] if records else None
        return records

    def text(self, records: Any) -> str:
        """Return the notation of panels and macros; `NONE` if there are no records."""
        return self.format(self._tuple(records)) or NONE

    def to_json(self, records: Any) -> str:
        """Return the JSON of a property; `NONE` if there are no records."""
        entries = [_outer_values(record) for record in self._tuple(records)]
        if not entries:
            return NONE
        return json.dumps(entries[0] if self.single else entries, ensure_ascii=False)

    def _tuple(self, records: Any) -> tuple[Any, ...]:
        if not self.single:
            return tuple(records)
        return () if records is None else (records,)

    def _from_json(self, text: str) -> tuple[Any, ...] | None:
        """Return the records of JSON; None for any other text."""
        if not text.startswith('{"' if self.single else '[{"'):
            return None
        try:
            values = json.loads(text)
            entries = [values] if self.single else values
            return tuple(_record(self.record, entry_values) for entry_values in entries)
        except (ValueError, TypeError, KeyError, AttributeError):
            return None


@dataclass(frozen=True)
class RecordTexts:
    """The notation of a parameter that is a list of texts, one for each record.

    Parameters
    ----------
    record : type
        Frozen dataclass of a record; `str` gives its text.
    parse : callable
        Reads the record of a text.
    """

    record: type
    parse: Callable[[str], Any]

    def read(self, values: Sequence[Any]) -> tuple[Any, ...]:
        """Return the records of texts; records are returned as they are. Raises InputError."""
        return tuple(
            value if isinstance(value, self.record) else self.parse(value) for value in values
        )

    def text(self, records: Sequence[Any]) -> tuple[str, ...]:
        """Return the texts of panels, macros and properties."""
        return tuple(map(str, records))


def convert_texts(owner: Any) -> None:
    """Replace texts by records in every field of a parameters dataclass that holds records."""
    for field in dataclasses.fields(owner):
        records = f.spec_of(field).records
        if records is not None:
            object.__setattr__(owner, field.name, records.read(getattr(owner, field.name)))


def split(text: str) -> list[str]:
    """Return the texts of the records in a text, without surrounding blanks."""
    return [part.strip() for part in text.split(SEPARATOR) if part.strip()]


def joined(records: Sequence[Any]) -> str:
    """Return the texts of records, separated."""
    return f"{SEPARATOR} ".join(map(str, records))


def numbers(values: Sequence[float]) -> str:
    """Return numbers as text, separated by blanks."""
    return " ".join(f"{value:.12g}" for value in values)


def pose_text(pose: Pose) -> str:
    """Return a pose as text: mm and degrees."""
    return numbers((*pose[:3], *(math.degrees(angle) for angle in pose[3:])))


def inner_pose(values: Sequence[float]) -> Pose:
    """Return a pose in mm and rad from six numbers in mm and degrees."""
    x, y, z, *angles = values
    a, b, c = (math.radians(angle) for angle in angles)
    return x, y, z, a, b, c


def _outer_values(record: Any) -> dict[str, Any]:
    """Return the values of a record in outer units, except defaults."""
    values = {}
    for field in dataclasses.fields(record):
        value = getattr(record, field.name)
        if value != field.default:
            values[field.name] = _outer(f.spec_of(field).kind, value)
    return values


def _outer(kind: str, value: Any) -> Any:
    if kind == f.POSE:
        return [*value[:3], *map(f.degrees, value[3:])]
    if kind == f.ANGLE:
        return f.degrees(value)
    return list(value) if isinstance(value, tuple) else value


def _record(cls: type, values: dict[str, Any]) -> Any:
    """Return the record of values in outer units. Raises TypeError or KeyError for invalid values."""
    kinds = {field.name: f.spec_of(field).kind for field in dataclasses.fields(cls)}
    return cls(**{name: _inner(kinds[name], value) for name, value in values.items()})


def _inner(kind: str, value: Any) -> Any:
    if kind == f.POSE:
        return inner_pose([float(number) for number in value])
    if kind == f.POINT:
        x, y, z = (float(number) for number in value)
        return x, y, z
    if kind == f.ANGLE:
        return math.radians(value)
    return value
