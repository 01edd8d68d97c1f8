# SPDX-License-Identifier: LGPL-2.1-or-later
"""A table of points as an object of the document: its curves to be seen, and the table itself to be planned."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App
import Part

from ..core.geometry import curve_table
from ..core.issues import InputError

ENDING = ".csv"
_PROPERTY = "Table"
_LARGEST = 200_000_000  # bytes


def open_table(document: Any, path: str) -> Any:
    """A table of points from a file as an object. InputError NO_FILE, BAD_FILE, and those of `curve_table.curves_of`."""
    name = os.path.basename(path)
    try:
        if os.path.getsize(path) > _LARGEST:
            raise InputError("BAD_FILE", name, f"it is larger than {_LARGEST // 1_000_000} MB; split it")
        with open(path, encoding="utf-8") as stream:
            text = stream.read()
    except UnicodeDecodeError:
        raise InputError("BAD_FILE", name, "it is not text; give a table of points as CSV") from None
    except OSError as error:
        raise InputError("NO_FILE", name, f"it cannot be read: {error.strerror}") from None
    curves = curve_table.curves_of(text, name)
    part = document.addObject("Part::Feature", "Table")
    part.Label = os.path.splitext(name)[0]
    part.addProperty("App::PropertyStringList", _PROPERTY, "Table", "The points as they were read.", 1)
    setattr(part, _PROPERTY, text.splitlines())
    part.Shape = Part.Compound([Part.makePolygon([App.Vector(*row) for row in one.points.tolist()]) for one in curves])
    return part


def table_of(source: Any) -> str | None:
    """The table that an object was made of; None for any other."""
    lines = getattr(source, _PROPERTY, None)
    return "\n".join(lines) if isinstance(lines, list) and lines else None
