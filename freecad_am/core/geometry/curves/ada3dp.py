# SPDX-License-Identifier: LGPL-2.1-or-later
"""AdaOne toolpaths (.ada3dp) as curves: protocol buffers with a published schema.

Schema: ada3dp.proto of https://github.com/CEAD-group/adaone-utils (959f212), published by users of
AdaOne. This module reads positions, directions, layers, segment types and whether a segment
deposits. The job sets speeds, axes, fans and events. Fields outside the schema are reported, and
toolpaths that remove material are rejected. A direction is that in which the nozzle points: in the
published cone, whose layers rise along Z by the layer height in mm, directions are 0, 0, -1.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...issues import NOTE, InputError, Issue, Text
from ...types import Array
from . import gcode_roles as roles_of
from .bead_curves import BeadCurve, ReadCurves

CODE = "BAD_ADA3DP"
VARINT, DOUBLE, BYTES, FLOAT = 0, 1, 2, 5  # wire types
GROUPS, PARAMETERS = 1, 2  # ToolPathData
LAYER, SEGMENTS = 1, 2  # ToolPathGroup
POINTS, PROCESS_ON, TYPE = 1, 2, 3  # PathSegment
TOOL, MATERIAL = 10, 11
STRATEGY, DYNAMIC_AXES = 2, (5, 6)  # Parameters
POSITION, DIRECTION = 1, 2  # Point
MIN_STEP_MM = 1e-6  # mm; closer points coincide
MAX_MM = 1e7  # mm; maximum coordinate
# last field number of each message in the schema
LAST_FIELD = {"toolpath": 2, "parameters": 7, "layer": 2, "segment": 11, "point": 8}
TYPES = (
    *(
        "NONE",
        "WALL_OUTER",
        "WALL_INNER",
        "INFILL",
        "BRIM",
        "TRAVEL",
        "RAFT",
        "START_APPROACH",
        "END_RETRACT",
        "PREHEAT",
    ),
    *("DEPOSITION_START_ZONE", "DEPOSITION_END_ZONE", "PURGE"),
)
# numbers and names of strategies that deposit nothing
NO_DEPOSIT = {
    10: "heating",
    12: "drilling",
    13: "surface finishing",
    14: "cutting out",
    15: "raster scanning",
    16: "surface scanning",
    18: "facing",
    19: "clearing",
}
Value = int | float | bytes


@dataclass(frozen=True, eq=False)
class _Run:
    """A segment that deposits: layer, points (n, 3) mm, unit directions (n, 3), segment type."""

    layer: int
    points: Array
    directions: Array | None
    role: str | None

    @property
    def length(self) -> float:
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())


@dataclass
class _Seen:
    """Unread content of a file: fields outside the schema, tools and materials."""

    unknown: dict[str, int]
    tools: set[int]
    materials: set[int]
    turns_part: bool = False


def curves_of(data: bytes, where: str, roles: str = roles_of.PART) -> tuple[BeadCurve, ...]:
    """Read only the beads, as `read`.

    Parameters
    ----------
    data : bytes
        Content of the file.
    where : str
        Name of the file, for messages.
    roles : str, optional
        Roles to deposit.

    Returns
    -------
    tuple of BeadCurve
        Beads, with directions if all points of a segment have a direction.

    Raises
    ------
    InputError
        As `read`.
    """
    return read(data, where, roles).curves


def read(data: bytes, where: str, roles: str = roles_of.PART) -> ReadCurves:
    """Read the beads of an AdaOne toolpath: segments that deposit and have the requested roles.

    Parameters
    ----------
    data : bytes
        Content of the file.
    where : str
        Name of the file, for messages.
    roles : str, optional
        Roles to deposit, as in `gcode.read`.

    Returns
    -------
    ReadCurves
        Beads in file coordinates, and issues about unread content.

    Raises
    ------
    InputError
        BAD_ADA3DP; BAD_VALUE for roles that the file does not have.
    """
    unread = _Seen({}, set(), set())
    try:
        runs = list(_beads(data, where, unread))
    except (ValueError, IndexError, struct.error) as error:
        raise InputError(
            CODE,
            where,
            "the file is not an AdaOne toolpath, or is damaged ({}); export it again",
            error,
        ) from None
    if not runs:
        raise InputError(
            CODE,
            where,
            "none of the segments deposits material; export a toolpath that deposits",
        )
    for run in runs:
        if not (np.isfinite(run.points).all() and np.abs(run.points).max() <= MAX_MM):
            raise InputError(
                CODE,
                where,
                "a coordinate is not a number, or is larger than {:g} mm; export the toolpath "
                "again",
                MAX_MM,
            )
    runs, issues = roles_of.choose_runs(runs, roles, where, CODE)
    numbers = {layer: k for k, layer in enumerate(sorted({run.layer for run in runs}))}
    curves = tuple(BeadCurve(run.points, run.directions, numbers[run.layer]) for run in runs)
    return ReadCurves(curves, (*issues, *_notes(unread, where)))


def _notes(unread: _Seen, where: str) -> list[Issue]:
    messages = []
    if unread.unknown:
        names = ", ".join(f"{count} of a {name}" for name, count in unread.unknown.items())
        messages.append(
            Text("{}: fields outside the published schema are ignored: {}", where, names)
        )
    for what, numbers in (("tools", unread.tools), ("materials", unread.materials)):
        if len(numbers) > 1:
            listed = ", ".join(map(str, sorted(numbers)))
            messages.append(
                Text("{}: all {} {} are replaced by that of the cell", where, Text(what), listed)
            )
    if unread.turns_part:
        messages.append(
            Text(
                "{}: the values of external axes are ignored, because the cell plans its own "
                "external axes",
                where,
            )
        )
    return [Issue(NOTE, roles_of.NOT_READ, message) for message in messages]


def _counted_fields(data: bytes, name: str, unread: _Seen) -> list[tuple[int, Value]]:
    """Return the fields of a message and count the fields outside the schema."""
    fields = list(_fields(data))
    unknown = sum(number > LAST_FIELD[name] for number, _ in fields)
    if unknown:
        unread.unknown[name] = unread.unknown.get(name, 0) + unknown
    return fields


def _check_parameters(data: bytes, where: str, unread: _Seen) -> None:
    """Check the strategy. Raises InputError BAD_ADA3DP if it deposits nothing."""
    for number, value in _counted_fields(data, "parameters", unread):
        if number == STRATEGY and value in NO_DEPOSIT:
            raise InputError(
                CODE,
                where,
                "the operation {} deposits nothing; export only the operations that deposit",
                Text(NO_DEPOSIT[int(value)]),
            )
        unread.turns_part |= number in DYNAMIC_AXES and bool(value)


def _beads(data: bytes, where: str, unread: _Seen) -> Iterator[_Run]:
    """Yield the segments that deposit."""
    for number, group in _counted_fields(data, "toolpath", unread):
        if number == PARAMETERS and isinstance(group, bytes):
            _check_parameters(group, where, unread)
        if number != GROUPS or not isinstance(group, bytes):
            continue
        entries = _counted_fields(group, "layer", unread)
        layer = next(
            (value for key, value in entries if key == LAYER and isinstance(value, int)), 0
        )
        layer -= (1 << 64) * (layer >= 1 << 63)
        for key, segment in entries:
            if key == SEGMENTS and isinstance(segment, bytes):
                run = _segment(layer, _counted_fields(segment, "segment", unread), unread)
                if run is not None:
                    yield run


def _segment(layer: int, fields: list[tuple[int, Value]], unread: _Seen) -> _Run | None:
    """Read a segment; return None if it does not deposit or has no length."""
    values = dict(fields)
    if not values.get(PROCESS_ON):
        return None
    rows = [
        _point(value, unread)
        for name, value in fields
        if name == POINTS and isinstance(value, bytes)
    ]
    if len(rows) < 2:
        return None
    points, directions = (np.array(column) for column in zip(*rows))
    distinct = np.r_[True, ~(np.linalg.norm(np.diff(points, axis=0), axis=1) <= MIN_STEP_MM)]
    if distinct.sum() < 2:
        return None
    unread.tools.add(int(values.get(TOOL, 0)))
    unread.materials.add(int(values.get(MATERIAL, 0)))
    kind = int(values.get(TYPE, 0))
    role = TYPES[kind] if kind < len(TYPES) else f"TYPE_{kind}"
    size = np.linalg.norm(directions[distinct], axis=1)
    has_directions = np.isfinite(size).all() and size.min() > 1e-9
    return _Run(
        layer,
        points[distinct],
        -directions[distinct] / size[:, None] + 0.0 if has_directions else None,
        role if kind else None,
    )


def _point(data: bytes, unread: _Seen) -> tuple[list[float], list[float]]:
    """Read position and direction; missing components are 0."""
    fields = dict(_counted_fields(data, "point", unread))
    vectors = []
    for name in (POSITION, DIRECTION):
        vector = dict(_fields(value)) if isinstance(value := fields.get(name, b""), bytes) else {}
        vectors.append([float(vector.get(axis, 0.0)) for axis in (1, 2, 3)])
    return vectors[0], vectors[1]


def _fields(data: bytes) -> Iterator[tuple[int, Value]]:
    """Yield the numbers and values of a message's fields.

    Raises ValueError if the data is not a message.
    """
    position = 0
    while position < len(data):
        key, position = _varint(data, position)
        number, kind = key >> 3, key & 7
        if number == 0:
            raise ValueError(f"a field without a number at byte {position}")
        if kind == VARINT:
            value, position = _varint(data, position)
            yield number, value
        elif kind in (DOUBLE, FLOAT):
            size = 8 if kind == DOUBLE else 4
            yield number, struct.unpack_from("<d" if kind == DOUBLE else "<f", data, position)[0]
            position += size
        elif kind == BYTES:
            size, position = _varint(data, position)
            if position + size > len(data):
                raise ValueError(f"the data end within a field of {size} bytes")
            yield number, data[position : position + size]
            position += size
        else:
            raise ValueError(f"a field of an unknown kind at byte {position}")


def _varint(data: bytes, position: int) -> tuple[int, int]:
    """Read a variable-length number; return its value and the next position."""
    value = shift = 0
    while True:
        if position >= len(data):
            raise ValueError("the data end within a number")
        byte = data[position]
        position += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, position
        shift += 7
        if shift > 63:
            raise ValueError("a number of too many bytes")
