# SPDX-License-Identifier: LGPL-2.1-or-later
"""The triangles of an STL file, all accounted for.

FreeCAD's own reader drops triangles with a number that it cannot read, anything after the last one,
and the rest of a truncated file, without a message.
"""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from ...core.issues import NOTE, InputError, Issue, Text
from ...core.types import Array

CONTENT = "FILE_CONTENT"
HEAD, RECORD = 84, 50  # bytes of the head of a binary file, and of a triangle
TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
COMMENTS = ("#", ";", "//")
BETWEEN = ("outer", "endfacet", "end", "color")


def stl_triangles(file: Path, where: str) -> tuple[Array, tuple[Issue, ...]]:
    """Corners (m, 3, 3) of the triangles of every solid in an STL file, and a note on bytes after
    them.

    InputError BAD_FILE where it is cut off, or has anything else than triangles.
    """
    data = file.read_bytes()
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= HEAD else -1
    is_binary = count >= 0 and (len(data) == HEAD + RECORD * count or not _is_text(data))
    corners, issues = _binary(data, count, where) if is_binary else (_ascii(data, where), ())
    if not np.isfinite(corners).all():
        raise InputError(
            "BAD_FILE", where, "a vertex of a triangle is not a number; export the part again"
        )
    return corners, issues


def _is_text(data: bytes) -> bool:
    """Whether a file that is no sound binary one is text."""
    head = data[:4096].removeprefix(b"\xef\xbb\xbf").lstrip().lower()
    return b"\0" not in head and (head.startswith((b"solid", b"#", b"//")) or b"facet" in head)


def _binary(data: bytes, count: int, where: str) -> tuple[Array, tuple[Issue, ...]]:
    available = (len(data) - HEAD) // RECORD
    if available < count:
        raise InputError(
            "BAD_FILE",
            where,
            "it is truncated, or not an STL file: its header counts {:,} triangles, but its size "
            "holds {:,}; export the part again",
            count,
            available,
        )
    trailing = data[HEAD + RECORD * count :]
    if len(trailing.strip(b"\0 \t\r\n")) >= RECORD:
        raise InputError(
            "BAD_FILE",
            where,
            "{:,} bytes follow its {:,} triangles, possibly more triangles; export the part "
            "again, as one solid",
            len(trailing),
            count,
        )
    issues: tuple[Issue, ...] = ()
    if trailing.strip(b"\0 \t\r\n"):
        message = Text("{}: {} bytes after its triangles are not read", where, len(trailing))
        issues = (Issue(NOTE, CONTENT, message),)
    records = np.frombuffer(data, TRIANGLE, count, HEAD)
    return records["corners"].astype(np.float64), issues


def _ascii(data: bytes, where: str) -> Array:
    corners: list[tuple[float, float, float]] = []
    in_loop = -1  # corners of the current loop, -1 outside loops
    is_open = False  # a solid
    for number, line in enumerate(data.decode("latin-1").splitlines(), start=1):
        words = line.split()
        key = words[0].lower() if words else ""
        if not key or key.startswith(COMMENTS):
            continue
        if key == "vertex" and in_loop >= 0:
            corners.append(_corner(words, number, line, where))
            in_loop += 1
        elif key.startswith("facet") and is_open and in_loop < 0:
            in_loop = 0
        elif key == "endloop" and in_loop == 3:
            in_loop = -1
        elif key.removeprefix("ï»¿") == "solid" and in_loop < 0:
            is_open = True
        elif key.startswith("endsolid") and in_loop < 0:
            is_open = False
        elif key not in BETWEEN:
            raise _bad_line(number, line, where)
    if is_open or in_loop >= 0:
        raise InputError(
            "BAD_FILE", where, "it is truncated: the last solid has no end; export the part again"
        )
    return np.array(corners, dtype=np.float64).reshape(-1, 3, 3)


def _corner(words: list[str], number: int, line: str, where: str) -> tuple[float, float, float]:
    try:
        if len(words) != 4 or "_" in line:
            raise ValueError
        x, y, z = (float(word) for word in words[1:])
    except ValueError:
        raise _bad_line(number, line, where) from None
    return x, y, z


def _bad_line(number: int, line: str, where: str) -> InputError:
    return InputError(
        "BAD_FILE",
        where,
        "line {} cannot be read: {!r}; export the part again",
        number,
        line.strip()[:60],
    )
