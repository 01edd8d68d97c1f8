# SPDX-License-Identifier: LGPL-2.1-or-later
"""The vertices of STL, OBJ and PLY files, as scanners write them; in the file's unit, which these formats do not name."""

from __future__ import annotations

import re

import numpy as np

from ..issues import InputError
from ..types import Array, Mask

_PLY_TYPES = {
    "char": "i1",
    "int8": "i1",
    "uchar": "u1",
    "uint8": "u1",
    "short": "i2",
    "int16": "i2",
    "ushort": "u2",
    "uint16": "u2",
    "int": "i4",
    "int32": "i4",
    "uint": "u4",
    "uint32": "u4",
    "float": "f4",
    "float32": "f4",
    "double": "f8",
    "float64": "f8",
}
_STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])


def stl(data: bytes, where: str) -> Array:
    """Vertices (n, 3) of an STL file, each once."""
    count = int(np.frombuffer(data[80:84], dtype="<u4")[0]) if len(data) >= 84 else 0
    if len(data) == 84 + 50 * count:
        corners = np.frombuffer(data, dtype=_STL_TRIANGLE, offset=84)["corners"].reshape(-1, 3)
    else:
        corners = _numbers(re.findall(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", data), where)
    points = corners.astype(np.float64)
    points = points[
        np.lexsort(points.T[::-1])
    ]  # as np.unique of rows has them, which holds up other threads meanwhile
    differs: Mask = np.ones(len(points), dtype=bool)
    differs[1:] = (points[1:] != points[:-1]).any(axis=1)
    unique: Array = points[differs]
    return unique


def obj(data: bytes, where: str) -> Array:
    """Vertices (n, 3) of an OBJ file."""
    return _numbers(re.findall(rb"^v[ \t]+(\S+)[ \t]+(\S+)[ \t]+(\S+)", data, re.MULTILINE), where)


def ply(data: bytes, where: str) -> Array:
    """Vertices (n, 3) of a PLY file, text or binary."""
    head, mark, body = data.partition(b"end_header")
    body = body.partition(b"\n")[2]
    lines = [line.split() for line in head.decode("latin-1").splitlines()]
    kind = next((line[1] for line in lines if line[:1] == ["format"] and len(line) > 1), "")
    element_lines = [number for number, line in enumerate(lines) if line[:1] == ["element"]]
    first_element = lines[element_lines[0]] if element_lines else []
    if (
        not mark
        or first_element[1:2] != ["vertex"]
        or not first_element[2:3]
        or not first_element[2].isdecimal()
    ):
        raise InputError(
            "BAD_FILE", where, "it is not a PLY file with vertices first; export it again"
        )
    end = element_lines[1] if len(element_lines) > 1 else len(lines)
    fields = [line for line in lines[element_lines[0] + 1 : end] if line[:1] == ["property"]]
    names = [line[-1] for line in fields]
    if not {"x", "y", "z"} <= set(names) or any(line[1] not in _PLY_TYPES for line in fields):
        raise InputError("BAD_FILE", where, "its vertices lack plain x, y and z; export it again")
    count = int(first_element[2])
    if kind == "ascii":
        rows = [line.split() for line in body.splitlines()[:count]]
        columns = [names.index(axis) for axis in "xyz"]
        vertices = _numbers(
            [[row[k] for k in columns] for row in rows if len(row) >= len(names)], where
        )
    else:
        order = ">" if kind == "binary_big_endian" else "<"
        row = np.dtype(
            [(name, order + _PLY_TYPES[line[1]]) for name, line in zip(names, fields, strict=True)]
        )
        row_count = min(count, len(body) // row.itemsize)
        table = np.frombuffer(body, dtype=row, count=row_count)
        vertices = np.column_stack([table[axis].astype(np.float64) for axis in "xyz"])
    if len(vertices) < count:
        raise InputError(
            "BAD_FILE",
            where,
            "it is truncated after {} of {} vertices; export it again",
            len(vertices),
            count,
        )
    return vertices


def _numbers(texts: list[list[bytes]], where: str) -> Array:
    try:
        return np.array(texts, dtype=np.float64).reshape(-1, 3)
    except ValueError:
        raise InputError(
            "BAD_FILE", where, "a vertex coordinate is not a number; export it again"
        ) from None
