# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes the files of the examples: the same bytes whoever runs it, without date and path. Finds FreeCAD when imported."""

from __future__ import annotations

import re
import struct
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent))

from freecad_am.batch import host  # noqa: E402

host.find_freecad()

Triangle = tuple[tuple[float, float, float], ...]


def write_step(path: Path, shape: Any) -> None:
    """Write one part under the file's own name, which FreeCAD shows."""
    shape.exportStep(str(path))
    text = path.read_text(
        encoding="latin-1"
    )  # the exporter writes the path in the system's own way
    name = _escaped(path.stem)
    text = re.sub(
        r"FILE_NAME\('[^']*','[^']*'", lambda _: f"FILE_NAME('{name}','2020-01-01T00:00:00'", text
    )
    text = re.sub(r"PRODUCT\('[^']*',\s*'[^']*'", lambda _: f"PRODUCT('{name}','{name}'", text)
    path.write_text(text, encoding="ascii")


def write_stl(path: Path, triangles: list[Triangle]) -> None:
    """Write triangles as a binary STL file, outside where they turn counter-clockwise."""
    records = [
        struct.pack("<12fH", 0.0, 0.0, 0.0, *(number for point in triangle for number in point), 0)
        for triangle in triangles
    ]
    path.write_bytes(
        b"part of an example".ljust(80) + struct.pack("<I", len(triangles)) + b"".join(records)
    )


def _escaped(name: str) -> str:
    """A name as STEP (ISO 10303-21) writes it: other letters than those of ASCII by their number."""
    return "".join(sign if sign.isascii() else f"\\X2\\{ord(sign):04X}\\X0\\" for sign in name)
