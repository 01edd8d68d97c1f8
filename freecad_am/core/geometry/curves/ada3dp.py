# SPDX-License-Identifier: LGPL-2.1-or-later
"""Toolpaths of AdaOne (.ada3dp) as curves: protocol buffers of the schema that its maker's users have published.

Schema: ada3dp.proto of https://github.com/CEAD-group/adaone-utils (959f212). Read are positions, directions, layers and
whether a segment deposits, and its type; speeds, axes, fans and events are the job's own matter here. Fields that the schema does
not have are noted, and toolpaths that remove material are rejected. Directions are those in which the
nozzle points: in the published cone, whose layers rise along Z by their height in mm, they are 0, 0, -1.
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
APART = 1e-6  # mm; points no farther apart are one
MAX_MM = 1e7  # mm
# the last field of each message of the schema
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
# strategies that deposit nothing, by their numbers
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
    """A segment that deposits: layer, points and unit directions (n, 3), type."""

    layer: int
    points: Array
    directions: Array | None
    role: str | None

    @property
    def length(self) -> float:
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())


@dataclass
class _Seen:
    """What of a file is not read: fields that the schema does not have, tools and materials."""

    unknown: dict[str, int]
    tools: set[int]
    materials: set[int]
    turns_part: bool = False


def curves_of(data: bytes, where: str, roles: str = roles_of.PART) -> tuple[BeadCurve, ...]:
    """A bead for each segment that deposits, in the coordinates of the file; directions where all of its points have one.
    InputError BAD_ADA3DP."""
    return read(data, where, roles).curves


def read(data: bytes, where: str, roles: str = roles_of.PART) -> ReadCurves:
    """Beads of the segments that deposit and are of these roles, as `gcode.read` has them, and what is not read.

    Raises InputError BAD_ADA3DP; BAD_VALUE for roles that the file does not have.
    """
    seen = _Seen({}, set(), set())
    try:
        runs = list(_beads(data, where, seen))
    except (ValueError, IndexError, struct.error) as error:
        raise InputError(
            CODE,
            where,
            "it is not a toolpath of AdaOne, or it is damaged ({}); export it again",
            error,
        ) from None
    if not runs:
        raise InputError(
            CODE,
            where,
            "no segment of it deposits, so there is no bead; export a toolpath that deposits",
        )
    for run in runs:
        if not (np.isfinite(run.points).all() and np.abs(run.points).max() <= MAX_MM):
            raise InputError(
                CODE,
                where,
                "a position is not a number of at most {:g} mm; export it again",
                MAX_MM,
            )
    runs, issues = roles_of.chosen(runs, roles, where, CODE)
    numbers = {layer: k for k, layer in enumerate(sorted({run.layer for run in runs}))}
    curves = tuple(BeadCurve(run.points, run.directions, numbers[run.layer]) for run in runs)
    return ReadCurves(curves, (*issues, *_notes(seen, where)))


def _notes(seen: _Seen, where: str) -> list[Issue]:
    messages = []
    if seen.unknown:
        names = ", ".join(f"{count} of a {name}" for name, count in seen.unknown.items())
        messages.append(
            Text(
                "{}: fields that the published schema does not have are not read: {}", where, names
            )
        )
    for what, numbers in (("tools", seen.tools), ("materials", seen.materials)):
        if len(numbers) > 1:
            found = ", ".join(map(str, sorted(numbers)))
            messages.append(
                Text("{}: {} {} are taken for the one of the cell", where, Text(what), found)
            )
    if seen.turns_part:
        messages.append(
            Text("{}: values of external axes are not read; the cell's own are planned anew", where)
        )
    return [Issue(NOTE, roles_of.NOT_READ, message) for message in messages]


def _known(data: bytes, name: str, seen: _Seen) -> list[tuple[int, Value]]:
    """The fields of a message; those that the schema does not have are counted."""
    fields = list(_fields(data))
    unknown = sum(number > LAST_FIELD[name] for number, _ in fields)
    if unknown:
        seen.unknown[name] = seen.unknown.get(name, 0) + unknown
    return fields


def _check_parameters(data: bytes, where: str, seen: _Seen) -> None:
    """InputError BAD_ADA3DP for a strategy that deposits nothing."""
    for number, value in _known(data, "parameters", seen):
        if number == STRATEGY and value in NO_DEPOSIT:
            raise InputError(
                CODE,
                where,
                "one of its operations is {}, which deposits nothing; export the operations that deposit alone",
                Text(NO_DEPOSIT[int(value)]),
            )
        seen.turns_part |= number in DYNAMIC_AXES and bool(value)


def _beads(data: bytes, where: str, seen: _Seen) -> Iterator[_Run]:
    """The segments that deposit."""
    for number, group in _known(data, "toolpath", seen):
        if number == PARAMETERS and isinstance(group, bytes):
            _check_parameters(group, where, seen)
        if number != GROUPS or not isinstance(group, bytes):
            continue
        entries = _known(group, "layer", seen)
        layer = next(
            (value for key, value in entries if key == LAYER and isinstance(value, int)), 0
        )
        layer -= (1 << 64) * (layer >= 1 << 63)
        for key, segment in entries:
            if key == SEGMENTS and isinstance(segment, bytes):
                run = _segment(layer, _known(segment, "segment", seen), seen)
                if run is not None:
                    yield run


def _segment(layer: int, parts: list[tuple[int, Value]], seen: _Seen) -> _Run | None:
    """A segment; None of one that does not deposit, or goes nowhere."""
    last = dict(parts)
    if not last.get(PROCESS_ON):
        return None
    rows = [
        _point(value, seen) for name, value in parts if name == POINTS and isinstance(value, bytes)
    ]
    if len(rows) < 2:
        return None
    points, directions = (np.array(column) for column in zip(*rows))
    kept = np.r_[True, ~(np.linalg.norm(np.diff(points, axis=0), axis=1) <= APART)]
    if kept.sum() < 2:
        return None
    seen.tools.add(int(last.get(TOOL, 0)))
    seen.materials.add(int(last.get(MATERIAL, 0)))
    kind = int(last.get(TYPE, 0))
    role = TYPES[kind] if kind < len(TYPES) else f"TYPE_{kind}"
    size = np.linalg.norm(directions[kept], axis=1)
    known = np.isfinite(size).all() and size.min() > 1e-9
    return _Run(
        layer,
        points[kept],
        -directions[kept] / size[:, None] + 0.0 if known else None,
        role if kind else None,
    )


def _point(data: bytes, seen: _Seen) -> tuple[list[float], list[float]]:
    """Position and direction; what is left out of a vector is 0."""
    fields = dict(_known(data, "point", seen))
    found = []
    for name in (POSITION, DIRECTION):
        vector = dict(_fields(value)) if isinstance(value := fields.get(name, b""), bytes) else {}
        found.append([float(vector.get(axis, 0.0)) for axis in (1, 2, 3)])
    return found[0], found[1]


def _fields(data: bytes) -> Iterator[tuple[int, Value]]:
    """Numbers and values of the fields of a message. ValueError for what is none."""
    at = 0
    while at < len(data):
        key, at = _varint(data, at)
        number, kind = key >> 3, key & 7
        if number == 0:
            raise ValueError(f"a field without a number at byte {at}")
        if kind == VARINT:
            value, at = _varint(data, at)
            yield number, value
        elif kind in (DOUBLE, FLOAT):
            size = 8 if kind == DOUBLE else 4
            yield number, struct.unpack_from("<d" if kind == DOUBLE else "<f", data, at)[0]
            at += size
        elif kind == BYTES:
            size, at = _varint(data, at)
            if at + size > len(data):
                raise ValueError(f"it ends within a field of {size} bytes")
            yield number, data[at : at + size]
            at += size
        else:
            raise ValueError(f"a field of an unknown kind at byte {at}")


def _varint(data: bytes, at: int) -> tuple[int, int]:
    """A number of any length at a byte, and where what follows begins."""
    value = shift = 0
    while True:
        if at >= len(data):
            raise ValueError("it ends within a number")
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, at
        shift += 7
        if shift > 63:
            raise ValueError("a number of too many bytes")
