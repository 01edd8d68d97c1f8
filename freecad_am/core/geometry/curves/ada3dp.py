# SPDX-License-Identifier: LGPL-2.1-or-later
"""Toolpaths of AdaOne (.ada3dp) as curves: protocol buffers of the schema that its maker's users have published.

Schema: ada3dp.proto of https://github.com/CEAD-group/adaone-utils (959f212). Read are positions, directions, layers and
whether a segment deposits; speeds, axes, fans and events are the job's own matter here. Directions are those in which the
nozzle points: in the published cone, whose layers rise along Z by their height in mm, they are 0, 0, -1.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

import numpy as np

from ...issues import InputError
from ...types import Array
from .bead_curves import BeadCurve

CODE = "BAD_ADA3DP"
VARINT, DOUBLE, BYTES, FLOAT = 0, 1, 2, 5  # wire types
GROUPS = 1  # ToolPathData
LAYER, SEGMENTS = 1, 2  # ToolPathGroup
POINTS, PROCESS_ON = 1, 2  # PathSegment
POSITION, DIRECTION = 1, 2  # Point
APART = 1e-6  # mm; points no farther apart are one
MAX_MM = 1e7  # mm
Value = int | float | bytes


def curves_of(data: bytes, where: str) -> tuple[BeadCurve, ...]:
    """A bead for each segment that deposits, in the coordinates of the file; directions where all of its points have one.
    InputError BAD_ADA3DP."""
    try:
        found = list(_beads(data))
    except (ValueError, IndexError, struct.error) as error:
        raise InputError(
            CODE,
            where,
            "it is not a toolpath of AdaOne, or it is damaged ({}); export it again",
            error,
        ) from None
    if not found:
        raise InputError(
            CODE,
            where,
            "no segment of it deposits, so there is no bead; export a toolpath that deposits",
        )
    for _, points, _ in found:
        if not (np.isfinite(points).all() and np.abs(points).max() <= MAX_MM):
            raise InputError(
                CODE,
                where,
                "a position is not a number of at most {:g} mm; export it again",
                MAX_MM,
            )
    numbers = {layer: k for k, layer in enumerate(sorted({layer for layer, _, _ in found}))}
    return tuple(
        BeadCurve(points, directions, numbers[layer]) for layer, points, directions in found
    )


def _beads(data: bytes) -> Iterator[tuple[int, Array, Array | None]]:
    """Layer, points (n, 3) and unit directions (n, 3) of each segment that deposits."""
    for number, group in _fields(data):
        if number != GROUPS or not isinstance(group, bytes):
            continue
        entries = list(_fields(group))
        layer = next(
            (value for key, value in entries if key == LAYER and isinstance(value, int)), 0
        )
        layer -= (1 << 64) * (layer >= 1 << 63)
        for key, segment in entries:
            if key != SEGMENTS or not isinstance(segment, bytes):
                continue
            parts = list(_fields(segment))
            if not any(value for name, value in parts if name == PROCESS_ON):
                continue
            rows = [
                _point(value)
                for name, value in parts
                if name == POINTS and isinstance(value, bytes)
            ]
            if len(rows) < 2:
                continue
            points, directions = (np.array(column) for column in zip(*rows))
            kept = np.r_[True, ~(np.linalg.norm(np.diff(points, axis=0), axis=1) <= APART)]
            if kept.sum() < 2:
                continue
            size = np.linalg.norm(directions[kept], axis=1)
            known = np.isfinite(size).all() and size.min() > 1e-9
            yield layer, points[kept], -directions[kept] / size[:, None] + 0.0 if known else None


def _point(data: bytes) -> tuple[list[float], list[float]]:
    """Position and direction; what is left out of a vector is 0."""
    fields = dict(_fields(data))
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
